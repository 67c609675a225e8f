"""What is said to be in forecast files, beside what eccodes, netCDF4 and json read in them."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Sequence
from datetime import UTC, datetime
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from gcs_windplan.errors import WindError
from gcs_windplan.wind.inspect import inventory as module
from gcs_windplan.wind.inspect.inventory import Inventory, TimeGap, gaps_in, take_inventory
from gcs_windplan.wind.reading import open_indexes
from tests.wind.grib_files import message
from tests.wind.netcdf_maker import AXES, HOURS, NOON, wind, write_netcdf
from tests.wind.other_readers import NAMES, every_value, real
from tests.wind.trap_file import write_trap

HOUR = 3600.0
TEN_METRES = {"typeOfLevel": "heightAboveGround", "level": 10}


def _inventory(*paths: Path) -> Inventory:
    with open_indexes(paths) as indexes:
        return take_inventory(paths, indexes)


def _grib(path: Path, *messages: bytes) -> Path:
    path.write_bytes(b"".join(messages))
    return path


def _levels(inventory: Inventory, quantity: str) -> list[str]:
    return [str(level) for one in inventory.quantities if one.quantity == quantity for level in one.levels]


@pytest.mark.parametrize("name", NAMES)
def test_times_levels_and_members_are_those_that_other_readers_find(name: str) -> None:
    path = real(name)
    times, members, levels = set(), set(), defaultdict(set)
    for value in every_value(path):
        times.add(value.time.timestamp())
        members.add(value.member)
        levels[value.quantity].add(value.level)
    found = _inventory(path)
    assert set(found.times) == times
    assert set(found.members) == members - {None}
    assert found.also_without_member == (None in members)
    for quantity, there in levels.items():
        assert set(_levels(found, quantity)) == there, quantity
    assert not any(one.missing for one in found.quantities)
    assert all(one.values for one in found.quantities)
    assert found.fields_read == found.files[0].fields
    assert not found.broken


#: Of each file: format, title, runs, units of the first quantity, rows and columns, area, what planning says.
EXPECTED: dict[str, tuple[Any, ...]] = {
    "bella_lui_weather_data_ERA5.nc": (
        "NetCDF classic", "", 0, "m s**-1", (9, 9), (46, 48, 8, 10), "u, v, 14 levels from 1000 hPa to 600 hPa",
    ),
    "ecmwf_data_uv.grib": (
        "GRIB", "European Centre for Medium-Range Weather Forecasts", 1, "m s**-1", (37, 72),
        (-90, 90, -180, 175), "it has no geopotential",
    ),
    "ecmwf_ens_ztu_multi_dim.grib": (
        "GRIB", "European Centre for Medium-Range Weather Forecasts", 1, "m s**-1", (3, 5),
        (-10, 50, -30, 50), "it has u (u) but no v: download it along",
    ),
    "ecmwf_pl_regular_ll_10deg.grib": (
        "GRIB", "European Centre for Medium-Range Weather Forecasts", 4, "m s**-1", (19, 36),
        (-90, 90, -180, 170), "u, v, 6 levels from 1000 hPa to 300 hPa",
    ),
    "ecmwf_uv_on_different_levels.grib": (
        "GRIB", "European Centre for Medium-Range Weather Forecasts", 1, "m s**-1", (37, 72),
        (-90, 90, -180, 175), "it has no geopotential",
    ),
    "gfs_height_above_ground_wrt.nc": (
        "NetCDF4", "", 0, "m/s", (12, 12), (54.079, 54.992, 13.079, 13.992), "7 levels from 10 m above ground to 100 m",
    ),
    "ndfd_20170603T1800.nc": (
        "NetCDF classic", "", 1, "m/s", (106, 83), (42.148, 44.631, -114.473, -111.642), "at 10 m above ground",
    ),
    "ndrt_2020_weather_data_ERA5_new.nc": (
        "NetCDF4", "", 0, "m s**-1", (97, 101), (30, 54, -100, -75), "u, v, 37 levels from 1000 hPa to 1 hPa",
    ),
    "openmeteo_slc_hourly_pressure_levels.json": (
        "JSON", "Open-Meteo", 0, "mp/h", (1, 1), (40.764, 40.764, -111.981, -111.981),
        "8 levels from 10 m above ground",
    ),
}  # fmt: skip


@pytest.mark.parametrize("name", NAMES)
def test_format_title_units_area_and_planning_of_real_files(name: str) -> None:
    """The area as `grib_ls` and `ncdump` show it, longitudes in [-180, 180)."""
    found = _inventory(real(name))
    kind, title, runs, units, shape, area, planning = EXPECTED[name]
    (file,), (grid,) = found.files, found.grids
    assert (file.format, file.title, len(found.runs)) == (kind, title, runs)
    assert found.quantities[0].units == units
    assert (grid.rows, grid.columns) == shape
    assert (grid.south, grid.north, grid.west, grid.east) == pytest.approx(area, abs=1e-3)
    assert grid.all_longitudes == (area[3] - area[2] > 300)
    assert planning in found.planning.obstacle + found.planning.uses
    assert bool(found.planning.obstacle) == planning.startswith("it has")
    assert not grid.turned


def test_levels_of_u_without_v_are_listed() -> None:
    found = _inventory(real("ecmwf_uv_on_different_levels.grib"))
    assert set(_levels(found, "u")) - set(_levels(found, "v")) == {"850 hPa", "400 hPa"}


def test_u_without_v_is_listed_and_planning_says_why_it_stops(tmp_path: Path) -> None:
    found = _inventory(write_trap(tmp_path / "u.nc", without=("v",), hours=(0.0, 1.0)))
    assert [one.quantity for one in found.quantities] == ["u"]
    assert found.planning.obstacle == "it has u (u) but no v: download it along"
    assert (len(found.times), found.with_whole_wind) == (2, 0)


def test_two_files_that_belong_together(tmp_path: Path) -> None:
    u = _grib(tmp_path / "u.grib2", message("u", **TEN_METRES), message("u", stepRange=3, **TEN_METRES))
    v = _grib(tmp_path / "v.grib2", message("v", **TEN_METRES), message("v", stepRange=3, **TEN_METRES))
    assert "no v" in _inventory(u).planning.obstacle
    found = _inventory(u, v)
    assert (found.planning.obstacle, found.with_whole_wind, len(found.files)) == ("", 2, 2)
    assert found.planning.departures == (NOON, NOON + 3 * HOUR)
    assert found.runs == (NOON,)


def test_an_ensemble_asks_for_members(tmp_path: Path) -> None:
    axes = {**AXES, "number": ("number", np.arange(5, 9), {"standard_name": "realization"})}
    shape = (4, 3, 4)
    path = write_netcdf(
        tmp_path / "ensemble.nc",
        {**axes, "u10": wind("number lat lon", *shape), "v10": wind("number lat lon", *shape)},
    )
    found = _inventory(path)
    assert (found.members, found.also_without_member, found.planning.members) == ((5, 6, 7, 8), False, (5, 6, 7, 8))
    assert found.planning.obstacle == ""
    assert found.quantities[0].members == 4


def test_missing_values_are_counted(tmp_path: Path) -> None:
    found = _inventory(write_trap(tmp_path / "gap.nc", gap="nan", hours=(0.0, 6.0)))
    assert [(one.quantity, one.values, one.missing) for one in found.quantities] == [("u", 100, 1), ("v", 100, 0)]
    assert found.planning.obstacle == ""  # it is missing at the edge, and planning was tried in the middle


def test_of_many_fields_a_sample_is_read(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    path = write_trap(tmp_path / "many.nc", hours=np.arange(30.0).tolist())
    monkeypatch.setattr(module, "_MOST_FIELDS", 100)
    monkeypatch.setattr(module, "_SAMPLED_FIELDS", 40)
    found = _inventory(path)
    assert (found.fields_read, found.files[0].fields) == (40, 120)
    assert sum(one.values for one in found.quantities) == 40 * 25
    assert not found.planning.all_tried
    monkeypatch.setattr(module, "_SAMPLED_VALUES", 110)
    assert _inventory(path).fields_read == 4  # of 25 values each
    monkeypatch.setattr(module, "_SAMPLED_VALUES", 3)
    assert _inventory(path).fields_read == 1


def test_gaps_between_times_are_named(tmp_path: Path) -> None:
    found = _inventory(write_trap(tmp_path / "gap.nc", hours=(0.0, 1.0, 2.0, 5.0, 6.0)))
    assert found.gaps == (TimeGap(NOON + 2 * HOUR, NOON + 5 * HOUR),)


@pytest.mark.parametrize(
    ("hours", "gaps"),
    [
        ([], []),
        ([5], []),
        ([0, 6], []),
        ([0, 1, 2, 3], []),
        ([0, 1, 2, 3, 6, 9, 12], []),  # longer steps after some days are no gaps
        ([0, 1, 3, 4, 5], [(1, 3)]),
        ([0, 1, 3, 4, 6, 7, 8], [(1, 3), (4, 6)]),
        ([0, 1, 2, 5, 8, 14, 17], [(8, 14)]),
        ([0.0, 1.00005, 1.9999, 3.00002], []),  # hours in single precision
    ],
)
def test_a_step_that_is_longer_than_those_around_it_is_a_gap(hours: list[float], gaps: list[tuple[int, int]]) -> None:
    found = gaps_in([hour * HOUR for hour in hours])
    assert [(gap.after / HOUR, gap.before / HOUR) for gap in found] == gaps


def test_projected_grids_tell_whether_u_and_v_are_turned(tmp_path: Path) -> None:
    y, x = np.mgrid[50.0:52.0:7j, 3.0:7.0:8j]
    said = {"units": "m s-1", "coordinates": "latitude longitude"}
    variables = {
        "latitude": ("y x", y + 0.05 * x, {"units": "degrees_north"}),
        "longitude": ("y x", x, {"units": "degrees_east"}),
        "u": ("y x", np.full((7, 8), 5.0), {**said, "standard_name": "x_wind"}),
        "v": ("y x", np.zeros((7, 8)), {**said, "standard_name": "y_wind"}),
    }
    assert _inventory(write_netcdf(tmp_path / "bent.nc", variables)).grids[0].turned


def test_winds_on_two_grids(tmp_path: Path) -> None:
    small, large = tmp_path / "small.nc", write_trap(tmp_path / "large.nc")
    write_netcdf(small, {**AXES, "u10": wind("lat lon", 3, 4), "v10": wind("lat lon", 3, 4)})
    found = _inventory(small, large)
    assert [(grid.rows, grid.columns) for grid in found.grids] == [(3, 4), (5, 5)]
    assert {(one.quantity, one.grid) for one in found.quantities} == {("u", 0), ("v", 0), ("u", 1), ("v", 1)}
    assert "on other grids left out" in found.planning.uses


def test_what_cannot_be_read_is_told_and_does_not_stop_the_rest(tmp_path: Path) -> None:
    good, bad = (bytearray(message(name, **TEN_METRES)) for name in ("u", "v"))
    position = 16
    while bad[position + 4] != 5:
        position += int.from_bytes(bad[position : position + 4])
    bad[position + 9 : position + 11] = (99).to_bytes(2)  # section 5: a way of packing that does not exist
    found = _inventory(_grib(tmp_path / "bad.grib2", bytes(good), bytes(bad)))
    assert [one.quantity for one in found.quantities if one.values] == ["u"]
    (broken,) = found.broken
    assert "cannot be decoded" in broken
    assert "cannot be decoded" in found.planning.obstacle


def test_a_file_without_any_wind_has_an_inventory(tmp_path: Path) -> None:
    path = _grib(tmp_path / "z.grib2", message("gh", values=1500.0))
    found = _inventory(path)
    assert "no wind that can be used" in found.planning.obstacle
    assert [one.quantity for one in found.quantities] == ["height"]
    assert found.times == (NOON,)


def test_a_missing_file_is_an_error(tmp_path: Path) -> None:
    with pytest.raises(WindError, match="no such file"):
        _inventory(tmp_path / "nowhere.nc")


def _times(numbers: Sequence[float]) -> list[datetime]:
    return [datetime.fromtimestamp(number, UTC) for number in numbers]


def test_times_without_wind_do_not_count(tmp_path: Path) -> None:
    """Heights at another time are no wind."""
    path = _grib(tmp_path / "a.grib2", message("u"), message("v"), message("gh", stepRange=6))
    assert _times(_inventory(path).times) == [datetime(2026, 5, 1, 12, tzinfo=UTC)]


def test_times_as_hours_since(tmp_path: Path) -> None:
    axes = {**AXES, "time": ("time", [0.0, 6.0], {"units": HOURS})}
    path = write_netcdf(
        tmp_path / "t.nc", {**axes, "u10": wind("time lat lon", 2, 3, 4), "v10": wind("time lat lon", 2, 3, 4)}
    )
    assert _inventory(path).times == (NOON, NOON + 6 * HOUR)
