"""Which reader a file gets, and what is said of files that have none."""

from __future__ import annotations

import gzip
import json
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from subprocess import run
from types import ModuleType

import pytest

from gcs_windplan.errors import WindError
from gcs_windplan.wind.field_index import FieldIndex
from gcs_windplan.wind.files.anyfile import open_index
from tests.wind.netcdf_maker import AXES, wind, write_netcdf

ANSWER = {
    "latitude": 47.0, "longitude": 8.0, "utc_offset_seconds": 0,
    "hourly_units": {"time": "unixtime", "wind_speed_10m": "m/s", "wind_direction_10m": "°"},
    "hourly": {"time": [0], "wind_speed_10m": [1.0], "wind_direction_10m": [270]},
}  # fmt: skip


def _say(path: Path) -> str:
    with pytest.raises(WindError) as error:
        open_index(path)
    assert str(error.value).startswith(f"{path}: ")
    assert "NetCDF, GRIB and answers of Open-Meteo (JSON) are read" in str(error.value)
    return str(error.value)


@pytest.fixture
def path(tmp_path: Path) -> Path:
    return tmp_path / "wind"


def test_netcdf_of_both_kinds(path: Path) -> None:
    write_netcdf(path, {**AXES, "u10": wind("lat lon", 3, 4)})
    assert path.read_bytes()[:4] == b"\x89HDF"
    with open_index(path) as index:
        assert [field2d.name for field2d in index.fields] == ["u10"]
    write_netcdf(path, {**AXES, "v10": wind("lat lon", 3, 4)}, format="NETCDF3_CLASSIC")
    assert path.read_bytes()[:3] == b"CDF"
    with open_index(path) as index:
        assert [field2d.name for field2d in index.fields] == ["v10"]


@pytest.mark.parametrize("lead", [b"", b"\xef\xbb\xbf", b"\n  "])
def test_answers_of_open_meteo(path: Path, lead: bytes) -> None:
    """One place or a list of them; the word GRIB inside makes them no GRIB."""
    for answer in (ANSWER, [ANSWER]):
        path.write_bytes(lead + json.dumps(answer).replace("{", '{"from": "GRIB", ', 1).encode())
        with open_index(path) as index:
            assert {field2d.quantity for field2d in index.fields} == {"speed", "direction"}
    path.write_text(json.dumps(ANSWER), encoding="utf-16")
    with open_index(path) as index:
        assert index.title == "Open-Meteo"


@pytest.mark.parametrize("lead", [b"", b"\r\r\n001\r\r\nHTXX12 ECMF 011200\r\r\n", b"\0" * 990])
def test_grib_may_have_a_header_of_the_message_switch(path: Path, lead: bytes, monkeypatch: pytest.MonkeyPatch) -> None:
    @contextmanager
    def open_grib(path: Path) -> Iterator[FieldIndex]:
        yield FieldIndex("a GRIB file", ())

    stand_in = ModuleType("gcs_windplan.wind.files.grib")
    stand_in.open_grib = open_grib  # type: ignore[attr-defined]
    monkeypatch.setitem(sys.modules, "gcs_windplan.wind.files.grib", stand_in)
    path.write_bytes(lead + b"GRIB" + bytes(100))
    with open_index(path) as index:
        assert index.source == "a GRIB file"


@pytest.mark.parametrize(
    ("data", "hint"),
    [
        (b"", "is empty: download it again"),
        (bytes(50), "is empty: download it again"),
        (b"latitude,longitude,wind\n", "is of no format that is known here"),
        (b"\x7fELF", "is of no format that is known here"),
        (bytes([7]) * 1100 + b"GRIB", "is of no format that is known here"),
        (gzip.compress(b"CDF", mtime=0), "is packed with gzip: unpack it first (`gunzip`)"),
        (b"BZh91AY", "is packed with bzip2: unpack it first (`bunzip2`)"),
        (b"PK\x03\x04data.nc", "is packed with zip: unpack it first (`unzip`)"),
        (b"\xfd7zXZ\0", "is packed with xz"),
        (b"\x28\xb5\x2f\xfd", "is packed with zstd"),
        (b"<!DOCTYPE html><title>GRIB filter</title>", "is a web page: the download went wrong"),
        (b"\n <HTML>", "is a web page: the download went wrong"),
        (b'<?xml version="1.0"?><html xmlns="x">', "is a web page: the download went wrong"),
        (b'<?xml version="1.0"?><Error>', "is XML, often a server's error"),
    ],
)
def test_other_files_are_named_with_a_hint(path: Path, data: bytes, hint: str) -> None:
    path.write_bytes(data)
    assert hint in _say(path)


def test_folders_and_missing_files(tmp_path: Path) -> None:
    assert "is a folder; name one file" in _say(tmp_path)
    assert "no such file" in _say(tmp_path / "nowhere.nc")


def test_a_reader_is_imported_only_when_it_is_needed(tmp_path: Path) -> None:
    answer = tmp_path / "answer.json"
    answer.write_text(json.dumps(ANSWER))
    netcdf = write_netcdf(tmp_path / "wind.nc", {**AXES, "u10": wind("lat lon", 3, 4)})
    code = (
        "import sys; from pathlib import Path; from gcs_windplan.wind.files.anyfile import open_index\n"
        "with open_index(Path(sys.argv[1])): print(*sorted({'netCDF4', 'eccodes', 'rasterio'} & set(sys.modules)))"
    )
    for path, imported in ((answer, ""), (netcdf, "netCDF4")):
        done = run([sys.executable, "-c", code, str(path)], capture_output=True, check=True, text=True)
        assert done.stdout.strip() == imported
