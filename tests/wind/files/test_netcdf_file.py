"""Numbers out of NetCDF files: blocks, chunks, packed and missing values, broken files."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import netCDF4
import numpy as np
import pytest

from gcs_windplan.errors import WindError
from gcs_windplan.wind.files.netcdf import open_netcdf
from gcs_windplan.wind.files.netcdf_file import NetcdfFile
from tests.wind.netcdf_maker import AXES, HOURS, LAT, LON, MS, NOON, Content, everything, whole, wind, write_netcdf

TIMES: Content = ("time", [0.0, 3.0], {"units": HOURS})
U = {"standard_name": "eastward_wind"}


@pytest.fixture
def path(tmp_path: Path) -> Path:
    return tmp_path / "trap.nc"


def test_rows_and_columns_are_read_in_any_order_and_around_the_globe(path: Path) -> None:
    values = np.arange(2 * 36 * 5).reshape(2, 36, 5).astype(float)
    lon: Content = ("lon", np.arange(0.0, 360.0, 10.0), {"units": "degrees_east"})
    lat: Content = ("lat", [80.0, 40.0, 0.0, -40.0, -80.0], {"units": "degrees_north"})
    write_netcdf(path, {"time": TIMES, "lon": lon, "lat": lat, "u": ("time lon lat", values, {**MS, **U})})
    with open_netcdf(path) as index:
        field2d = index.fields[1]
        assert (field2d.grid.shape, field2d.grid.regular, field2d.time) == ((5, 36), True, NOON + 3 * 3600)
        rows, columns = np.array([3, 0, 1]), np.array([34, 35, 0, 1, 2])
        np.testing.assert_array_equal(field2d.read(rows, columns), values[1].T[np.ix_(rows, columns)])
        np.testing.assert_array_equal(whole(field2d), values[1].T)


def test_compressed_files_are_read_chunk_by_chunk_and_each_once(path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    values = np.random.default_rng(1).normal(size=(6, 4, 30, 40))
    chunks = {"+chunksizes": (3, 4, 10, 40), "+zlib": True}
    times: Content = ("time", np.arange(6.0), {"units": HOURS})
    levels: Content = ("height", [10.0, 20.0, 30.0, 40.0], {"units": "m"})
    lat: Content = ("lat", np.arange(30.0), {"units": "degrees_north"})
    lon: Content = ("lon", np.arange(40.0), {"units": "degrees_east"})
    winds = {name: ("time height lat lon", values, {**MS, **chunks}) for name in ("u", "v")}
    write_netcdf(path, {"time": times, "height": levels, "lat": lat, "lon": lon, **winds})
    blocks, read = [], NetcdfFile._read

    def counted(self: NetcdfFile, *args: Any) -> Any:
        blocks.append(args)
        return read(self, *args)

    monkeypatch.setattr(NetcdfFile, "_read", counted)
    with open_netcdf(path) as index:
        for field2d in sorted(index.fields, key=lambda field2d: (field2d.level, field2d.time)):  # against their order
            number = int(field2d.level.value / 10 - 1)
            place = values[int(((field2d.time or 0) - NOON) // 3600), number, 5:9, 3:20]
            np.testing.assert_array_equal(field2d.read(np.arange(5, 9), np.arange(3, 20)), place)
    assert len(index.fields) == 48
    assert len(blocks) == 4  # two variables, twice three times


def test_packed_filled_and_impossible_values_become_what_they_mean(path: Path) -> None:
    raw = np.array([[1000, -1000, -32767, 3000], [0, 0, 0, 0], [0, 0, 0, 0]], dtype=np.int16)
    said = {"scale_factor": 0.01, "add_offset": 3.0, "valid_range": np.array([-2000, 2000], np.int16)}
    write_netcdf(path, {**AXES, "u": wind("lat lon", 3, 4, **U, **{"+dtype": "i2", "+fill_value": -32767})})
    with netCDF4.Dataset(path, "a") as file:
        file["u"].set_auto_maskandscale(False)
        file["u"].setncatts(said)
        file["u"][:] = raw
    np.testing.assert_allclose(everything(path)[1][0][1][0], [13.0, -7.0, np.nan, np.nan])


def test_files_that_are_none_or_broken_are_named(tmp_path: Path, path: Path) -> None:
    path.write_bytes(b"\x89HDF\r\n\x1a\nnothing more")
    with pytest.raises(WindError, match=r"trap\.nc: cannot be read as NetCDF"):
        everything(path)
    values = np.random.default_rng(2).normal(size=(300, 400))
    lat: Content = ("lat", np.linspace(0, 80, 300), LAT[2])
    lon: Content = ("lon", np.linspace(0, 80, 400), LON[2])
    whole_file = write_netcdf(
        tmp_path / "whole.nc", {"lat": lat, "lon": lon, "u10": ("lat lon", values, {**MS, "+zlib": True})}
    )
    data = bytearray(whole_file.read_bytes())
    data[len(data) // 2 : len(data) // 2 + 4000] = bytes(4000)
    path.write_bytes(data)
    with pytest.raises(WindError, match=r"trap\.nc: u10 cannot be read .*: it is damaged"):
        everything(path)
