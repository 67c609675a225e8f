"""The wind at a place, beside the winds that planning has there."""

from __future__ import annotations

import re
from datetime import UTC, datetime
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from gcs_windplan.arrays import FloatArray
from gcs_windplan.errors import WindError
from gcs_windplan.geo.frame import GeoPoint, LocalFrame
from gcs_windplan.wind import ForecastQuery, read_forecast
from gcs_windplan.wind.field_index import Level
from gcs_windplan.wind.inspect.sounding import HeightAsked, HeightWind, Sounding, take_sounding
from gcs_windplan.wind.pairing import Members
from gcs_windplan.wind.reading import open_indexes
from tests.wind.grib_files import box, message
from tests.wind.netcdf_maker import AXES, HOURS, NOON, Content, wind, write_netcdf
from tests.wind.other_readers import NAMES, real
from tests.wind.trap_file import write_trap

ONE_CM_PER_SECOND = 0.01
ONE_METRE = 1.0
HOUR = 3600.0
NEAR_GREENWICH = GeoPoint(51.2, 0.3)
TEN_METRES = {"typeOfLevel": "heightAboveGround", "level": 10}


def _sounding(
    path: Path,
    place: GeoPoint = NEAR_GREENWICH,
    asked: float | None = None,
    members: Members = None,
    height: HeightAsked | None = None,
) -> Sounding:
    with open_indexes([path]) as indexes:
        return take_sounding(indexes, place, asked, members, height)


def _at(path: Path, height: HeightAsked, **options: Any) -> HeightWind:
    found = _sounding(path, height=height, **options).at_height
    assert found is not None
    return found


def _refused(path: Path, height: HeightAsked | None, **options: Any) -> str:
    with pytest.raises(WindError) as error:
        _sounding(path, height=height, **options)
    return str(error.value)


def _pressures(path: Path, terrain: float | None = None, **more: Content) -> Path:
    """Wind on 900 and 800 hPa, at 1000 and 2000 m, that grows by 10 m/s an hour."""
    level: Content = ("level", [900.0, 800.0], {"standard_name": "air_pressure", "units": "hPa"})
    time: Content = ("time", [0.0, 1.0], {"units": HOURS})
    u = np.ones((2, 2, 3, 4)) * np.array([10.0, 20.0])[None, :, None, None]
    u = u + 10.0 * np.arange(2.0)[:, None, None, None]
    z = np.ones((2, 2, 3, 4)) * np.array([1000.0, 2000.0])[None, :, None, None]
    variables: dict[str, Content] = {
        **AXES, "level": level, "time": time,
        "u": ("time level lat lon", u, {"units": "m s-1"}),
        "v": ("time level lat lon", 0 * u, {"units": "m s-1"}),
        "z": ("time level lat lon", z, {"units": "m", "standard_name": "geopotential_height"}),
        **more,
    }  # fmt: skip
    if terrain is not None:
        said = {"units": "m", "standard_name": "surface_altitude"}
        variables["orog"] = ("lat lon", np.full((3, 4), terrain), said)
    return write_netcdf(path, variables)


def test_a_level_between_nodes(tmp_path: Path) -> None:
    """The wind grows by a metre a second with every degree east and tenfold with every degree north of 50."""
    found = _sounding(write_trap(tmp_path / "slope.nc", slope=True))
    assert [str(row.level) for row in found.levels] == ["10 m above ground", "100 m above ground"]
    for row in found.levels:
        np.testing.assert_allclose(row.winds, [[10.3, 12.0]], atol=ONE_CM_PER_SECOND)
        assert np.isnan(row.height)
        assert row.above_ground == row.level.value
    assert found.members == (None,)


def test_heights_and_times_of_pressure_levels(tmp_path: Path) -> None:
    found = _sounding(_pressures(tmp_path / "p.nc"), asked=NOON + HOUR / 4)
    assert [row.level for row in found.levels] == [Level("pressure", 90000.0), Level("pressure", 80000.0)]
    np.testing.assert_allclose([row.height for row in found.levels], [1000, 2000], atol=ONE_METRE)
    np.testing.assert_allclose([row.winds[0, 0] for row in found.levels], [12.5, 22.5], atol=ONE_CM_PER_SECOND)
    assert found.times == (NOON, NOON + HOUR)
    assert np.isnan(found.ground)


def test_levels_below_the_forecasts_ground_do_not_count(tmp_path: Path) -> None:
    found = _sounding(_pressures(tmp_path / "p.nc", terrain=1500.0))
    assert [str(row.level) for row in found.levels] == ["800 hPa"]
    assert found.ground == pytest.approx(1500.0)
    assert found.levels[0].above_ground == pytest.approx(500.0, abs=ONE_METRE)


def test_a_forecast_whose_levels_are_all_below_its_ground_has_no_sounding(tmp_path: Path) -> None:
    path = _pressures(tmp_path / "p.nc", terrain=2500.0)
    for height in (None, HeightAsked(100.0, True)):
        assert "all its levels lie below its own ground there, 2500 m above mean sea level" in _refused(path, height)


def test_pressure_levels_without_heights_are_of_no_use_to_planning(tmp_path: Path) -> None:
    path = tmp_path / "p.grib2"
    path.write_bytes(b"".join(message(n, values=v, level=p) for n, v in (("u", 3.0), ("v", 4.0)) for p in (850, 500)))
    for height in (None, HeightAsked(1000.0)):
        assert "no geopotential" in _refused(path, height, place=GeoPoint(51.5, 9.2))


def test_the_levels_are_those_that_planning_uses(tmp_path: Path) -> None:
    """Planning takes one kind of level above sea level, that with the most; and of all what both times have."""
    path = tmp_path / "some.grib2"
    sea = {"typeOfLevel": "heightAboveSea", "level": 1500}
    fields = [
        message(n, stepRange=step, **keys)
        for keys, steps in ((TEN_METRES, (0, 3)), (sea, (0, 3)), ({**TEN_METRES, "level": 80}, (0,)))
        for step in steps
        for n in "uv"
    ]
    fields += [
        message(n, value, stepRange=step, level=level)
        for step in (0, 3)
        for level, height in ((850, 1500.0), (700, 3000.0))
        for n, value in (("u", 5.0), ("v", 5.0), ("gh", height))
    ]
    path.write_bytes(b"".join(fields))
    for moment in (None, NOON + HOUR, NOON + 3 * HOUR):
        found = _sounding(path, GeoPoint(51.5, 9.2), moment)
        assert {str(row.level) for row in found.levels} == {"10 m above ground", "850 hPa", "700 hPa"}


def test_a_missing_value_stops_the_sounding_as_it_stops_planning(tmp_path: Path) -> None:
    path = write_trap(tmp_path / "gap.nc", gap="nan")  # of u at 53 N, 2 E on the upper level
    assert np.isfinite(_sounding(path, GeoPoint(51.0, 0.0)).levels[1].winds).all()
    assert "missing at 1 of" in _refused(path, None, place=GeoPoint(52.1, 1.9))


@pytest.mark.parametrize("name", [name for name in NAMES if "ens" not in name])
def test_on_its_levels_a_node_has_the_wind_that_planning_has(name: str) -> None:
    """At the last time, at the node in the middle of each real file, on all levels whose height is known.

    Between nodes the levels' heights differ from node to node, and planning's wind is no longer that of the level. On
    the highest level it is not known where a neighbour, however small its share, has it a little lower.
    """
    path = real(name)
    with open_indexes([path]) as indexes:
        grid = indexes[0].fields[0].grid
        moment = max(s.time for s in indexes[0].fields if s.time is not None)
    row, column = grid.shape[0] // 2, grid.shape[1] // 2
    latitude = grid.latitudes[row] if grid.regular else grid.latitudes[row, column]
    longitude = grid.longitudes[column] if grid.regular else grid.longitudes[row, column]
    place = GeoPoint(float(latitude), float((longitude + 180) % 360 - 180))
    query = ForecastQuery(LocalFrame(place), ground=_flat, departure=datetime.fromtimestamp(moment, UTC))
    if "uv" in name:  # without heights
        assert "geopotential" in _refused(path, None, place=place, asked=moment)
        return
    found = _sounding(path, place, moment)
    field = read_forecast([path], query).mean
    for one in found.levels[:-1] or found.levels:
        z = one.level.value if one.level.kind == "height" else one.height
        wind = field.at(np.array([[0.0, 0.0, z]]))[0, :2]
        np.testing.assert_allclose(one.winds[0], wind, atol=ONE_CM_PER_SECOND)


def _flat(points: FloatArray) -> FloatArray:
    return np.zeros(len(points))


def test_a_height_above_sea_level(tmp_path: Path) -> None:
    found = _at(_pressures(tmp_path / "p.nc"), HeightAsked(1250.0), asked=NOON + HOUR / 2)
    np.testing.assert_allclose(found.winds, [[17.5, 0.0]], atol=ONE_CM_PER_SECOND)
    assert found.lower is not None
    assert (str(found.lower.level), str(found.upper.level)) == ("900 hPa", "800 hPa")
    assert (found.lower.height, found.upper.height) == (pytest.approx(1000.0), pytest.approx(2000.0))
    assert np.isnan(found.above_ground)


def test_a_height_above_the_forecasts_own_ground(tmp_path: Path) -> None:
    path = _pressures(tmp_path / "p.nc", terrain=700.0)
    found = _at(path, HeightAsked(800.0, True))
    np.testing.assert_allclose(found.winds, [[15.0, 0.0]], atol=ONE_CM_PER_SECOND)
    assert (found.height, found.above_ground) == (pytest.approx(1500.0), 800.0)
    below = _at(path, HeightAsked(150.0, True))
    expected = 10.0 * np.log(150.0 / 0.1) / np.log(300.0 / 0.1)
    np.testing.assert_allclose(below.winds, [[expected, 0.0]], atol=ONE_CM_PER_SECOND)
    assert below.lower is None


def test_below_the_forecasts_ground_there_is_no_wind(tmp_path: Path) -> None:
    found = _at(_pressures(tmp_path / "p.nc", terrain=700.0), HeightAsked(600.0))
    np.testing.assert_allclose(found.winds, 0.0)
    assert found.above_ground == pytest.approx(-100.0)


def test_levels_above_ground_need_no_terrain(tmp_path: Path) -> None:
    path = write_trap(tmp_path / "a.nc", shear=True)  # 20 m/s at 10 m, 10 m/s at 100 m
    found = _at(path, HeightAsked(55.0, True))
    np.testing.assert_allclose(found.winds, [[15.0, 0.0]], atol=ONE_CM_PER_SECOND)
    assert np.isnan(found.height)
    on_level = _at(path, HeightAsked(100.0, True))
    assert on_level.lower is on_level.upper
    low = _at(path, HeightAsked(1.0, True)).winds[0, 0]
    assert low == pytest.approx(20.0 * np.log(10.0) / np.log(100.0), abs=ONE_CM_PER_SECOND)


@pytest.mark.parametrize(
    ("write", "altitude", "said"),
    [
        (
            _pressures,
            HeightAsked(9000.0),
            "9000 m above mean sea level is above its highest level (800 hPa, there 2000 m",
        ),
        (_pressures, HeightAsked(900.0), "is below its lowest level (900 hPa, there 1000 m above mean sea level)"),
        (_pressures, HeightAsked(900.0), "no terrain that tells how far down to go"),
        (_pressures, HeightAsked(50.0, True), "no terrain, so that 50 m above ground cannot be told"),
        (
            write_trap,
            HeightAsked(50.0),
            "so that 50 m above mean sea level cannot be told: write the height above ground",
        ),
        (write_trap, HeightAsked(150.0, True), "150 m above ground is above its highest level above ground, 100 m"),
    ],
)
def test_heights_that_the_file_does_not_know(write: Any, altitude: HeightAsked, said: str, tmp_path: Path) -> None:
    assert said in _refused(write(tmp_path / "wind.nc"), altitude)


def test_places_and_times_outside_say_by_how_much(tmp_path: Path) -> None:
    path = write_trap(tmp_path / "a.nc", hours=(0.0, 6.0))
    far = _refused(path, None, place=GeoPoint(51.0, 3.0))
    assert "the wind ends 70 km short of the area: it covers" in far
    assert "longitudes -2.000 to 2.000" in far
    assert "the departure 2026-05-01 11:00 UTC lies 1.0 h outside of its times" in _refused(
        path, None, asked=NOON - HOUR
    )
    assert "lies 2.0 h outside of its times, 2026-05-01 12:00 UTC to" in _refused(
        path, HeightAsked(10.0, True), asked=NOON + 8 * HOUR
    )
    assert "short of the area" in _refused(path, None, place=GeoPoint(51.0, 179.0))


def test_a_single_time_holds_for_three_hours(tmp_path: Path) -> None:
    path = write_trap(tmp_path / "a.nc")
    assert _sounding(path, asked=NOON + 3 * HOUR).times == (NOON,)
    assert "is 4.0 h from the departure" in _refused(path, None, asked=NOON + 4 * HOUR)


@pytest.mark.parametrize("place", [GeoPoint(51.0, 10.0), GeoPoint(-40.0, 100.0), GeoPoint(49.2, -12.0)])
def test_places_outside_of_a_projected_grid(place: GeoPoint, tmp_path: Path) -> None:
    path = _bent(tmp_path / "bent.nc")
    assert re.search("short of the area|on the other side of the globe", _refused(path, None, place=place))


def test_a_projected_grid_is_turned_to_true_north(tmp_path: Path) -> None:
    """Its x axis runs 30 degrees to the north of east."""
    found = _sounding(_bent(tmp_path / "bent.nc"), GeoPoint(0.03, 0.02))
    np.testing.assert_allclose(found.levels[0].winds, [[8.66, 5.0]], atol=ONE_CM_PER_SECOND)


def _bent(path: Path) -> Path:
    """A grid of 1500 x 1600 nodes on the equator, turned by 30 degrees; 10 m/s along its rows."""
    j, i = np.mgrid[-750.0:750.0, -800.0:800.0] * 2e-3
    cos, sin = np.cos(np.radians(30.0)), np.sin(np.radians(30.0))
    said = {"units": "m s-1", "coordinates": "latitude longitude"}
    return write_netcdf(
        path,
        {
            "latitude": ("y x", i * sin + j * cos, {"units": "degrees_north"}),
            "longitude": ("y x", i * cos - j * sin, {"units": "degrees_east"}),
            "u10": ("y x", np.full(i.shape, 10.0, dtype="f4"), {**said, "standard_name": "x_wind"}),
            "v10": ("y x", np.zeros(i.shape, dtype="f4"), {**said, "standard_name": "y_wind"}),
        },
    )


def _ensemble(path: Path, members: int, alone: bool = False) -> Path:
    """Member n has a wind of n m/s to the east; with the forecast beside it one of 100 m/s."""
    keys = {**TEN_METRES, "productDefinitionTemplateNumber": 1, "numberOfForecastsInEnsemble": members}
    fields = [
        message(name, values=number * (name == "u"), **keys, perturbationNumber=number)
        for number in range(1, members + 1)
        for name in "uv"
    ]
    lone = [message(name, values=100.0 * (name == "u"), **TEN_METRES) for name in "uv"] if alone else []
    path.write_bytes(b"".join(fields + lone))
    return path


def test_members_of_an_ensemble(tmp_path: Path) -> None:
    path, place = _ensemble(tmp_path / "e.grib2", 3), GeoPoint(51.0, 9.5)
    assert _sounding(path, place).members == (1, 2, 3)
    found = _at(path, HeightAsked(10.0, True), place=place)
    np.testing.assert_allclose(found.winds[:, 0], [1, 2, 3], atol=ONE_CM_PER_SECOND)
    assert _sounding(path, place, members=(2,)).members == (2,)
    assert "it has no member 9, but 1, 2, 3" in _refused(path, None, place=place, members=(9,))


def test_a_forecast_beside_an_ensemble_is_what_planning_takes(tmp_path: Path) -> None:
    path, place = _ensemble(tmp_path / "e.grib2", 2, alone=True), GeoPoint(51.0, 9.5)
    assert _sounding(path, place).levels[0].winds[0, 0] == pytest.approx(100.0, abs=ONE_CM_PER_SECOND)
    assert _sounding(path, place, members="all").members == (1, 2)
    assert _sounding(path, place, members=(1,)).members == (1,)


def test_members_of_no_ensemble(tmp_path: Path) -> None:
    assert "it is no ensemble" in _refused(write_trap(tmp_path / "a.nc"), None, members=(1,))


def test_gusts(tmp_path: Path) -> None:
    gust = wind("lat lon", 3, 4, value=17.0, standard_name="wind_speed_of_gust")
    path = write_netcdf(
        tmp_path / "g.nc", {**AXES, "u10": wind("lat lon", 3, 4), "v10": wind("lat lon", 3, 4), "gust": gust}
    )
    assert _sounding(path).gusts.tolist() == [pytest.approx(17.0)]


def test_of_two_runs_gust_and_wind_are_of_the_newest(tmp_path: Path) -> None:
    path = tmp_path / "runs.grib2"
    path.write_bytes(
        b"".join(
            message(name, value, dataTime=time, stepRange=step, **keys)
            for time, step, speed, gust in ((0, 12, 5.0, 99.0), (1200, 0, 7.0, 12.0))
            for name, value, keys in (
                ("u", speed, TEN_METRES), ("v", 0.0, TEN_METRES),
                ("gust", gust, {"typeOfLevel": "surface", "level": 0}),
            )
        )
    )  # fmt: skip
    found = _sounding(path, GeoPoint(51.0, 9.0))
    assert found.levels[0].winds[0, 0] == pytest.approx(7.0, abs=ONE_CM_PER_SECOND)
    assert found.gusts[0] == pytest.approx(12.0, abs=ONE_CM_PER_SECOND)


@pytest.mark.parametrize(
    "place", [GeoPoint(90.0, 0.0), GeoPoint(-90.0, 77.0), GeoPoint(0.0, -180.0), GeoPoint(0.0, 179.9)]
)
def test_poles_and_the_date_line(place: GeoPoint, tmp_path: Path) -> None:
    path = tmp_path / "globe.grib2"
    globe = box(90.0, -90.0, 0.0, 330.0, 30.0)
    path.write_bytes(b"".join(message(name, values=5.0, grid=globe, **TEN_METRES) for name in "uv"))
    np.testing.assert_allclose(_sounding(path, place).levels[0].winds, [[5.0, 5.0]], atol=ONE_CM_PER_SECOND)


def test_files_without_wind(tmp_path: Path) -> None:
    assert "no v" in _refused(write_trap(tmp_path / "u.nc", without=("v",)), None)


def test_a_height_that_the_file_does_not_tell(tmp_path: Path) -> None:
    path = write_trap(tmp_path / "a.nc", levels=None, names=("ua", "va"), standard_names=None)
    assert "at what height" in _refused(path, None)
