"""The invented ensemble forecast of a front over the Jacksboro terrain."""

from __future__ import annotations

import runpy
from collections.abc import Iterator
from datetime import UTC, datetime
from pathlib import Path

import netCDF4
import numpy as np
import pytest

from gcs_windplan.geo.frame import GeoPoint, LocalFrame
from gcs_windplan.wind import ForecastQuery, read_forecast

FOLDER = Path(__file__).resolve().parents[2] / "missions" / "wind"
PATH = FOLDER / "front_synthetic.nc"
HALF_A_CENTIMETRE_PER_SECOND = 0.005001
LARGEST = 300_000  # [bytes]
MARGIN = 0.025  # [deg]
HOURS = [6, 9, 12, 15, 18, 21, 24, 27, 30]
LEVELS = [10, 40, 80, 120, 200, 500]
GROUND, AT_80_METRES = 0, 2  # places among the levels


@pytest.fixture
def file() -> Iterator[netCDF4.Dataset]:
    with netCDF4.Dataset(PATH) as opened:
        yield opened


def speeds(file: netCDF4.Dataset, level: int) -> np.ndarray:
    """The winds at a level (members, times, ny, nx) [m/s]."""
    return np.hypot(file["u"][:, :, level], file["v"][:, :, level])


def directions(file: netCDF4.Dataset, level: int) -> np.ndarray:
    """Where they come from (members, times, ny, nx) [deg]."""
    return np.degrees(np.arctan2(-file["u"][:, :, level], -file["v"][:, :, level])) % 360


def turn(before: np.ndarray, after: np.ndarray) -> np.ndarray:
    """How far a wind has turned [deg], to the right is positive."""
    return (after - before + 180) % 360 - 180


def test_the_file_is_what_its_script_makes(file: netCDF4.Dataset, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.syspath_prepend(FOLDER)
    made = runpy.run_path(str(FOLDER / "synthetic_front.py"))["synthesize"]()
    np.testing.assert_allclose(file["latitude"][:], made.latitudes, atol=1e-9)
    np.testing.assert_allclose(file["longitude"][:], made.longitudes, atol=1e-9)
    for name, values in (("u", made.u), ("v", made.v), ("gust", made.gusts)):
        np.testing.assert_allclose(file[name][:], values, atol=HALF_A_CENTIMETRE_PER_SECOND)


def test_it_covers_the_terrain_with_a_margin_and_is_small(file: netCDF4.Dataset) -> None:
    latitudes, longitudes = file["latitude"][:], file["longitude"][:]
    _, south, north, west, east = runpy.run_path(str(FOLDER / "synthetic_jacksboro.py"))["terrain"]()
    assert min(south - latitudes.min(), latitudes.max() - north) > MARGIN
    assert min(west - longitudes.min(), longitudes.max() - east) > MARGIN
    assert list(file["height"][:]) == LEVELS
    assert list(file["time"][:]) == HOURS
    assert file["time"].units == "hours since 2026-05-01 00:00:00"
    assert "not a forecast" in file.title
    assert PATH.stat().st_size < LARGEST


def test_the_reader_finds_members_run_and_gusts() -> None:
    middle = LocalFrame(GeoPoint(36.59, -84.25))
    departure = datetime(2026, 5, 1, 12, tzinfo=UTC)
    forecast = read_forecast([PATH], ForecastQuery(middle, departure=departure, members="all"))
    assert forecast.members == tuple(range(10))
    assert forecast.runs == (datetime(2026, 5, 1, tzinfo=UTC).timestamp(),)
    assert len(forecast.gusts) == 10


def test_members_part_as_time_goes_on(file: netCDF4.Dataset) -> None:
    u = file["u"][:, :, AT_80_METRES]
    assert all(np.abs(u[i] - u[j]).max() > 1 for i in range(10) for j in range(i))
    direction = directions(file, AT_80_METRES)
    deviation = turn(direction[:1], direction).std(axis=0).mean(axis=(1, 2))
    assert deviation[0] < deviation[1] < deviation[2]  # before any front comes
    assert deviation[2] < deviation[-1]
    assert 2 < deviation[0] < 4  # of 8 degrees at 18:50 UTC about a third
    assert deviation[4] > 10  # the front is through in some


def test_the_control_is_the_middle_of_the_members(file: netCDF4.Dataset, monkeypatch: pytest.MonkeyPatch) -> None:
    """Nothing was added to it, and the others' draws cancel out."""
    monkeypatch.syspath_prepend(FOLDER)
    draws = np.array(runpy.run_path(str(FOLDER / "synthetic_front.py"))["draw"]())
    assert not draws[0].any()
    np.testing.assert_allclose(draws[1:].mean(axis=0), 0, atol=1e-12)
    np.testing.assert_allclose(draws[1:].std(axis=0), 1)
    assert list(file["number"][:]) == list(range(10))
    speed = speeds(file, AT_80_METRES)[:, 0].mean(axis=(1, 2))  # at first: each member's strength alone
    assert speed[1:].mean() == pytest.approx(speed[0], rel=0.01)
    np.testing.assert_allclose((speed[1:] / speed[0] - 1), 0.10 * 6 / (18 + 5 / 6) * draws[1:, 1], atol=0.02)


def test_winds_are_of_a_kind_that_is_seen(file: netCDF4.Dataset) -> None:
    control, every = speeds(file, AT_80_METRES)[0].mean(axis=(1, 2)), speeds(file, AT_80_METRES)
    assert control[0] == pytest.approx(5, abs=0.5)
    assert control[2] < control[3] == pytest.approx(9, abs=0.5)
    assert control[-1] == pytest.approx(3, abs=0.5)
    assert every.max() < 25
    assert file["gust"][:].max() < 35


def test_in_the_afternoon_it_is_too_strong_for_the_vehicle_in_parts(file: netCDF4.Dataset) -> None:
    """More than 14 m/s at 18 UTC over some of the area in most members, and never before noon or in the evening."""
    strong = speeds(file, AT_80_METRES) > 14
    part = strong.mean(axis=(2, 3))
    assert 0.1 < part[0, 4] < 0.5
    assert (part[:, 4] > 0.05).sum() >= 5
    assert not part[:, [0, 1, 2, 6, 7, 8]].any()


def test_the_front_passes(file: netCDF4.Dataset) -> None:
    """In the middle the control's wind veers by more than 60 degrees within 6 h, and everywhere within the day."""
    direction = directions(file, AT_80_METRES)[0]
    ny, nx = direction.shape[1:]
    assert turn(direction[3], direction[5])[ny // 2, nx // 2] > 60
    assert turn(direction[0], direction[-1]).min() > 60
    come = turn(direction[0], direction[4]) > 45  # at 18 UTC: in the north-west, not yet in the south-east
    assert come[-1, 0]
    assert not come[0, -1]


def test_gusts_are_above_the_wind_and_most_at_the_front(file: netCDF4.Dataset) -> None:
    factor = file["gust"][:] / speeds(file, GROUND)
    assert factor.min() > 1.38
    assert factor.max() < 1.82
    assert factor[0, 4].max() > 1.75
    assert factor[0, 0].max() < 1.45
