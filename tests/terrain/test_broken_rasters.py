"""Raster files that cannot be used: each says why, and which it is."""

from __future__ import annotations

import zipfile
from pathlib import Path

import numpy as np
import pytest

from gcs_windplan.errors import TerrainError
from gcs_windplan.terrain import read_dem
from tests.terrain.rasters import FRAME, UTM, from_origin, relief, utm_corner, write, write_hgt


def broken(tmp_path: Path, what: str) -> Path:
    (x, y), heights = utm_corner(), relief(30, 30)
    path, place = tmp_path / "dem.tif", from_origin(*utm_corner(), 40, 40)
    match what:
        case "missing":
            return path
        case "empty":
            path.write_bytes(b"")
        case "garbage":
            path.write_bytes(b"not a raster at all" * 100)
        case "cut":
            write(path, relief(300, 300), UTM, from_origin(x, y, 4, 4), compress="deflate")
            path.write_bytes(path.read_bytes()[:-150_000])
        case "no projection":
            write(path, heights, None, place)
        case "picture":
            write(path, np.zeros((3, 30, 30), dtype=np.uint8), UTM, place, photometric="RGB")
        case "all unknown":
            write(path, np.full((30, 30), -9999, dtype=np.float32), UTM, place, nodata=-9999)
        case "hgt name":
            return write_hgt(tmp_path / "davos.hgt", np.zeros((1201, 1201)))
        case "hgt size":
            return write_hgt(tmp_path / "N47E009.hgt", np.zeros((1000, 1201)))
        case "zip":
            path = tmp_path / "N47E009.hgt.zip"
            path.write_bytes(b"PK broken")
        case "zip of another":
            path = tmp_path / "N47E009.hgt.zip"
            with zipfile.ZipFile(path, "w") as archive:
                archive.writestr("N48E009.hgt", np.zeros((1201, 1201), dtype=">i2").tobytes())
        case "zip of two":
            path = tmp_path / "both.zip"
            with zipfile.ZipFile(path, "w") as archive:
                archive.writestr("N48E009.hgt", b"")
                archive.writestr("N47E009.hgt", b"")
    return path


@pytest.mark.parametrize(
    ("what", "message"),
    [
        ("missing", "there is no such file"),
        ("empty", "empty file"),
        ("garbage", "not a raster"),
        ("cut", "damaged"),
        ("no projection", "no projection"),
        ("picture", "picture"),
        ("all unknown", "not one known height"),
        ("hgt name", "named after its corner"),
        ("hgt size", "not a raster"),
        ("zip", "not a zip file"),
        ("zip of another", "another tile"),
        ("zip of two", "2 rasters"),
    ],
)
def test_a_file_that_cannot_be_used_is_named(tmp_path, what, message):
    path = broken(tmp_path, what)
    with pytest.raises(TerrainError, match=message) as caught:
        read_dem(path, FRAME)
    assert path.name in str(caught.value)


def test_no_file_at_all_is_refused():
    with pytest.raises(TerrainError, match="no DEM file"):
        read_dem([], FRAME)
