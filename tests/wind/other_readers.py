"""The real forecasts as eccodes, netCDF4 and json read them, without any of the package's readers."""

from __future__ import annotations

import json
from collections.abc import Iterator
from dataclasses import dataclass
from datetime import UTC, datetime, timedelta
from pathlib import Path
from typing import Any

import eccodes
import netCDF4
import numpy as np
import pytest

DATA = Path(__file__).resolve().parents[2].parent / "shared" / "data" / "wind"
NAMES = (
    "bella_lui_weather_data_ERA5.nc", "ecmwf_data_uv.grib", "ecmwf_ens_ztu_multi_dim.grib",
    "ecmwf_pl_regular_ll_10deg.grib", "ecmwf_uv_on_different_levels.grib", "gfs_height_above_ground_wrt.nc",
    "ndfd_20170603T1800.nc", "ndrt_2020_weather_data_ERA5_new.nc", "openmeteo_slc_hourly_pressure_levels.json",
)  # fmt: skip
_KNOT_OF_MILES = 1609.344 / 3600
_GFS = "-component_of_wind_height_above_ground"
_NDFD = ("Wind_speed_height_above_ground", "Wind_direction_from_which_blowing_height_above_ground")


@dataclass(frozen=True)
class Value:
    """One number of a file: of u, v, speed, direction or height, on a level ("850 hPa"), at a node."""

    quantity: str
    level: str
    time: datetime
    member: int | None
    latitude: float
    longitude: float
    value: float


def real(name: str) -> Path:
    """The path of one of the shared files; skips the test where it is absent."""
    if not (DATA / name).exists():
        pytest.skip(f"{name} is not on this machine: the shared test data are missing")
    return DATA / name


def whole_winds(path: Path, count: int) -> list[tuple[Value, Value]]:
    """Some nodes' u and v, or speed [m/s] and direction, chosen at random but always the same."""
    values = list(every_value(path))
    partners = {"u": "v", "speed": "direction"}
    table = {(v.quantity, v.level, v.time, v.member, v.latitude, v.longitude): v for v in values}
    found = [
        (one, other)
        for one in values
        if one.quantity in partners
        and (other := table.get((partners[one.quantity], one.level, one.time, one.member, one.latitude, one.longitude)))
    ]
    chosen = np.random.default_rng(4).choice(len(found), min(count, len(found)), replace=False) if found else []
    return [found[number] for number in chosen]


def every_value(path: Path) -> Iterator[Value]:
    """All numbers of wind and heights in a file."""
    if path.suffix == ".grib":
        return _of_grib(path)
    return _of_json(path) if path.suffix == ".json" else _of_netcdf(path)


def _of_grib(path: Path) -> Iterator[Value]:
    with path.open("rb") as file:
        while (message := eccodes.codes_grib_new_from_file(file)) is not None:
            yield from _of_message(message)
            eccodes.codes_release(message)


def _of_message(message: int) -> Iterator[Value]:
    quantity = {"u": "u", "v": "v", "z": "height"}.get(eccodes.codes_get(message, "shortName"))
    if quantity is None:
        return
    day, clock, level = (eccodes.codes_get(message, key) for key in ("validityDate", "validityTime", "level"))
    time = datetime.strptime(f"{day} {clock:04d}", "%Y%m%d %H%M").replace(tzinfo=UTC)
    member = eccodes.codes_get(message, "number") if eccodes.codes_get(message, "dataType") == "pf" else None
    nodes = [eccodes.codes_get_double_array(message, key) for key in ("latitudes", "longitudes", "values")]
    for latitude, longitude, value in zip(*nodes, strict=True):
        scaled = value / 9.80665 if quantity == "height" else value
        yield Value(quantity, f"{level} hPa", time, member, float(latitude), _turned(float(longitude)), scaled)


def _of_netcdf(path: Path) -> Iterator[Value]:
    with netCDF4.Dataset(path) as file:
        if path.name.startswith("ndfd"):
            yield from _of_ndfd(path, file)
            return
        gfs = path.name.startswith("gfs")
        levels = file["height_above_ground" if gfs else "level" if "level" in file.variables else "pressure_level"][:]
        clock = file["time" if "time" in file.variables else "valid_time"]
        names = {"u": f"u{_GFS}", "v": f"v{_GFS}"} if gfs else {"u": "u", "v": "v", "height": "z"}
        latitudes, longitudes = file["latitude"][:], file["longitude"][:]
        stride = 1 + len(latitudes) // 20  # of the large one every few nodes are enough
        for t, time in enumerate(_times(clock)):
            for k, level in enumerate(levels):
                text = f"{level:g} m above ground" if gfs else f"{level:g} hPa"
                for quantity, name in names.items():
                    plane = file[name][t, k]
                    for j in range(0, len(latitudes), stride):
                        for i in range(0, len(longitudes), stride):
                            value = float(plane[j, i]) / (9.80665 if quantity == "height" else 1.0)
                            yield Value(quantity, text, time, None, float(latitudes[j]), float(longitudes[i]), value)


def _of_ndfd(path: Path, file: Any) -> Iterator[Value]:
    """Its places by the reader's grid, which has tests of its own."""
    from gcs_windplan.wind.files.anyfile import open_index

    with open_index(path) as index:
        grid = index.fields[0].grid
    time = _times(file["time"])[0]
    for quantity, name in zip(("speed", "direction"), _NDFD, strict=True):
        plane = file[name][0, 0]
        for j, i in np.ndindex(*plane.shape):
            place = float(grid.latitudes[j, i]), float(grid.longitudes[j, i])
            yield Value(quantity, "10 m above ground", time, None, *place, float(plane[j, i]))


def _of_json(path: Path) -> Iterator[Value]:
    answer = json.loads(path.read_text())
    hourly, place = answer["hourly"], (answer["latitude"], answer["longitude"])
    offset = timedelta(seconds=answer["utc_offset_seconds"])
    times = [datetime.fromisoformat(time).replace(tzinfo=UTC) - offset for time in hourly["time"]]
    for name, values in hourly.items():
        kind, _, level = name.rpartition("_")
        quantity = {"windspeed": "speed", "winddirection": "direction", "geopotentialheight": "height"}.get(
            kind.replace("_", "")
        )
        if quantity is None:
            continue
        text = level.replace("hPa", " hPa") if level.endswith("hPa") else level.replace("m", " m above ground")
        scale = _KNOT_OF_MILES if quantity == "speed" else 1.0
        for time, value in zip(times, values, strict=True):
            yield Value(quantity, text, time, None, *place, value * scale)


def _times(clock: Any) -> list[datetime]:
    units = clock.units.replace("Hour since", "hours since")
    found = netCDF4.num2date(clock[:], units, only_use_cftime_datetimes=False, only_use_python_datetimes=True)
    return [time.replace(tzinfo=UTC) for time in np.atleast_1d(found)]


def _turned(longitude: float) -> float:
    return (longitude + 180.0) % 360.0 - 180.0
