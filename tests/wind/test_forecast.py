"""From files to winds: real forecasts and reanalyses, and files with traps."""

from __future__ import annotations

import doctest
import math
import re
from collections.abc import Callable
from datetime import UTC, datetime, timedelta
from pathlib import Path
from typing import Any

import netCDF4
import numpy as np
import pytest

from gcs_windplan.arrays import FloatArray
from gcs_windplan.errors import WindError
from gcs_windplan.geo.frame import GeoPoint, LocalFrame, rotate
from gcs_windplan.wind import ForecastQuery, GriddedWind, Ground, read_forecast, reading
from tests.wind.trap_file import FROM_WEST, write_trap

ONE_CM_PER_SECOND = 0.01
DATA = Path(__file__).resolve().parents[2].parent / "shared" / "data" / "wind"
DAVOS = LocalFrame(GeoPoint(46.82, 9.83))
JACKSBORO = LocalFrame(GeoPoint(36.59, -84.25))
BALTIC = LocalFrame(GeoPoint(54.5, 13.5))
GREENWICH = LocalFrame(GeoPoint(51.0, 0.0))
NOON = datetime(2026, 5, 1, 12, tzinfo=UTC)

Trap = Callable[..., Path]


@pytest.fixture
def trap(tmp_path: Path) -> Trap:
    return lambda **changes: write_trap(tmp_path / "trap.nc", **changes)


def read(
    path: Path, frame: LocalFrame, ground: Ground | None = None, departure: datetime | None = None, **options: Any
) -> GriddedWind:
    """The wind of one file, the mean where there are members."""
    return read_forecast([path], ForecastQuery(frame, ground, departure, **options)).mean


def _flat(points: FloatArray) -> FloatArray:
    return np.zeros(len(points))


def _real(name: str) -> Path:
    if not (DATA / name).exists():
        pytest.skip(f"{name} is not on this machine: the shared test data are missing")
    return DATA / name


def _true(frame: LocalFrame, points: FloatArray, wind: FloatArray) -> FloatArray:
    """True east and north of a wind in the local grid."""
    return rotate(wind, frame.convergence(points))[:, :2]


def _say(path: Path, frame: LocalFrame = GREENWICH, **options: Any) -> str:
    with pytest.raises(WindError) as error:
        read(path, frame, **options)
    assert str(path) in str(error.value)
    return str(error.value)


@pytest.mark.parametrize(
    ("name", "frame", "time", "level_axis", "component"),
    [
        ("bella_lui_weather_data_ERA5.nc", DAVOS, 2, "level", "{}"),
        ("ndrt_2020_weather_data_ERA5_new.nc", JACKSBORO, 0, "pressure_level", "{}"),
        (
            "gfs_height_above_ground_wrt.nc",
            BALTIC,
            4,
            "height_above_ground",
            "{}-component_of_wind_height_above_ground",
        ),
    ],
)
def test_at_ten_grid_points_it_gives_the_values_that_netcdf4_reads(
    name: str, frame: LocalFrame, time: int, level_axis: str, component: str
) -> None:
    path = _real(name)
    random = np.random.default_rng(10)
    with netCDF4.Dataset(path) as file:
        u, v = file[component.format("u")], file[component.format("v")]
        clock = file["valid_time" if "valid_time" in file.variables else "time"]
        departure = netCDF4.num2date(
            clock[time], clock.units, only_use_cftime_datetimes=False, only_use_python_datetimes=True
        ).replace(tzinfo=UTC)
        latitudes, longitudes = file["latitude"][:].data, file["longitude"][:].data
        near = frame.origin
        rows = np.argsort(np.abs(latitudes - near.latitude_deg))[:5]
        columns = np.argsort(np.abs(longitudes - near.longitude_deg))[:5]
        picks = [
            (
                time,
                int(random.integers(len(file[level_axis]))),
                int(random.choice(rows)),
                int(random.choice(columns)),
            )
            for _ in range(10)
        ]
        expected = np.array([[u[pick], v[pick]] for pick in picks])
        heights = [file[level_axis][p[1]] if "height" in level_axis else file["z"][p] / 9.80665 for p in picks]
    places = frame.to_local(latitudes[[p[2] for p in picks]], longitudes[[p[3] for p in picks]])
    points = np.column_stack([places, heights])
    area = (places[:, 0].min(), places[:, 1].min(), places[:, 0].max(), places[:, 1].max())
    for options in ({}, {"area": area}):
        wind = read(path, frame, _flat, departure, **options)
        np.testing.assert_allclose(_true(frame, points, wind.at(points)), expected, atol=ONE_CM_PER_SECOND)


def test_between_two_times_of_era5_the_wind_is_their_mean() -> None:
    path = _real("bella_lui_weather_data_ERA5.nc")
    wind = read(path, DAVOS, departure=datetime(2020, 2, 22, 6, tzinfo=UTC))
    points = np.array([[0.0, 0.0, 1600.0]])
    early, mean, late = (wind.at(points, hours * 3600.0) for hours in (0, 3, 6))
    np.testing.assert_allclose(mean, (early + late) / 2, atol=ONE_CM_PER_SECOND)
    assert np.abs(late - early).max() > 0.5


def test_a_missing_file_is_named(tmp_path: Path) -> None:
    assert "no such file" in _say(tmp_path / "nowhere.nc")


def test_a_west_wind_in_the_file_moves_east_in_the_frame(trap: Trap) -> None:
    wind = read(trap(), GREENWICH, _flat)
    np.testing.assert_allclose(wind.at(np.array([[0.0, 0.0, 10.0]])), FROM_WEST, atol=ONE_CM_PER_SECOND)


@pytest.mark.parametrize(
    ("units", "speed"),
    [
        ("m s**-1", 10),
        ("m s-1", 10),
        ("meters/second", 10),
        ("knots", 5.1444),
        ("km/h", 2.7778),
        ("mph", 4.4704),
    ],
)
def test_speeds_are_converted(trap: Trap, units: str, speed: float) -> None:
    wind = read(trap(units=units), GREENWICH, _flat)
    np.testing.assert_allclose(wind.at(np.array([[0.0, 0.0, 10.0]])), [[speed, 0, 0]], atol=ONE_CM_PER_SECOND)


@pytest.mark.parametrize("descending", [False, True])
@pytest.mark.parametrize("whole_circle", [False, True])
def test_axes_may_descend_and_cross_greenwich_in_0_to_360(trap: Trap, descending: bool, whole_circle: bool) -> None:
    """The wind grows by a metre a second with every degree east and tenfold with every degree north."""
    path = trap(descending=descending, whole_circle=whole_circle, slope=True)
    latitude, longitude = np.array([51.3, 50.2, 51.9, 50.0]), np.array([-1.7, 1.6, -0.2, 0.4])
    points = np.column_stack([GREENWICH.to_local(latitude, longitude), np.full(4, 10.0)])
    for options in ({}, {"area": (-150_000, -130_000, 150_000, 130_000)}):
        wind = read(path, GREENWICH, _flat, **options)
        expected = np.column_stack([10 + longitude, 10 * (latitude - 50)])
        np.testing.assert_allclose(_true(GREENWICH, points, wind.at(points)), expected, atol=ONE_CM_PER_SECOND)


def test_packed_values_are_unpacked(trap: Trap) -> None:
    wind = read(trap(packed=True), GREENWICH, _flat)
    np.testing.assert_allclose(wind.at(np.array([[0.0, 0.0, 10.0]])), FROM_WEST, atol=ONE_CM_PER_SECOND)


@pytest.mark.parametrize("how", ["masked", "nan"])
def test_a_gap_inside_the_part_used_is_an_error_that_says_where(trap: Trap, how: str) -> None:
    path = trap(gap=how)
    message = _say(path, ground=_flat)
    for part in ("missing at 1 of 50 nodes", "2026-05-01 12:00 UTC", "100 m above ground", "latitude 53, longitude 2"):
        assert part in message
    read(path, GREENWICH, _flat, area=(-60e3, -60e3, -50e3, -50e3))  # the gap lies outside


def test_u_without_v_is_an_error(trap: Trap) -> None:
    assert "has u (u) but no v" in _say(trap(without=("v",)))
    assert "has v (v) but no u" in _say(trap(without=("u",)))
    assert "holds no wind that can be used" in _say(trap(without=("u", "v")))


@pytest.mark.parametrize("names", [("u10", "v10"), ("UGRD", "VGRD"), ("10u", "10v"), ("ua", "va"), ("U", "V")])
def test_usual_names_are_found_without_a_standard_name(trap: Trap, names: tuple[str, str]) -> None:
    wind = read(trap(names=names, standard_names=None), GREENWICH, _flat)
    np.testing.assert_allclose(wind.at(np.array([[0.0, 0.0, 10.0]])), FROM_WEST, atol=ONE_CM_PER_SECOND)
    assert names[0] in wind.name


def test_ocean_currents_called_u_and_v_are_no_wind(trap: Trap) -> None:
    currents = ("eastward_sea_water_velocity", "northward_sea_water_velocity")
    assert "holds no wind that can be used" in _say(trap(standard_names=currents))


def test_missing_or_strange_units_are_errors(trap: Trap) -> None:
    assert "u has no units" in _say(trap(units=None), ground=_flat)
    assert "u is in 'furlongs per fortnight'" in _say(trap(units="furlongs per fortnight"), ground=_flat)


def test_levels_that_only_u_has_are_left_out_and_named(trap: Trap) -> None:
    wind = read(trap(v_levels=[10.0, 50.0, 200.0], levels=[10.0, 50.0, 100.0]), GREENWICH, _flat)
    assert "2 levels from 10 m above ground to 50 m above ground" in wind.name
    assert np.isnan(wind.at(np.array([[0.0, 0.0, 80.0]]))[0, 0])
    assert "share no level" in _say(trap(v_levels=[20.0, 200.0]), ground=_flat)


def test_levels_above_ground_are_not_known_without_any_ground(trap: Trap) -> None:
    assert np.isnan(read(trap(), GREENWICH).at(np.array([[0.0, 0.0, 50.0]]))[0, :2]).all()


def test_a_wind_at_no_known_height_asks_for_it(trap: Trap) -> None:
    path = trap(levels=None)
    assert "does not say at what height" in _say(path)
    wind = read(path, GREENWICH, _flat, known_height=10.0, exponent=0.2, carried=True)
    np.testing.assert_allclose(
        wind.at(np.array([[0.0, 0.0, 10.0], [0.0, 0.0, 80.0]]))[:, 0], [10, 10 * 8**0.2], atol=ONE_CM_PER_SECOND
    )


def test_a_wind_at_one_height_is_carried_up_only_by_a_law_that_is_asked_for(trap: Trap) -> None:
    path, points = trap(levels=[10.0]), np.array([[0.0, 0.0, 10.0], [0.0, 0.0, 80.0], [0.0, 0.0, 301.0]])
    assert np.isnan(read(path, GREENWICH, _flat).at(points)[1:, 0]).all()
    carried = read(path, GREENWICH, _flat, roughness=0.1, carried=True)
    expected = [10.0, 10.0 * math.log(800) / math.log(100)]
    np.testing.assert_allclose(carried.at(points)[:2, 0], expected, atol=ONE_CM_PER_SECOND)
    assert np.isnan(carried.at(points)[2, 0])
    assert "below by a log law (roughness 0.1 m), and above up to 300 m" in carried.name


def test_altitudes_need_no_terrain(trap: Trap) -> None:
    wind = read(trap(level_name="altitude"), GREENWICH)
    assert "10 m above mean sea level" in wind.name


@pytest.mark.parametrize(("geopotential", "units"), [("z", "m2 s-2"), ("gh", "gpm")])
def test_pressure_levels_lie_at_their_geopotential_heights(trap: Trap, geopotential: str, units: str) -> None:
    """1000 hPa at 100 m with 10 m/s, 900 hPa at 1000 m with 20 m/s."""
    path = trap(level_name="pressure", levels=[900.0, 1000.0], geopotential=(geopotential, units), shear=True)
    wind = read(path, GREENWICH)
    points = np.array([[0.0, 0.0, 100.0], [0.0, 0.0, 550.0], [0.0, 0.0, 1000.0]])
    np.testing.assert_allclose(wind.at(points)[:, 0], [10, 15, 20], atol=ONE_CM_PER_SECOND)


def test_pressure_levels_without_geopotential_are_refused(trap: Trap) -> None:
    assert "no geopotential" in _say(trap(level_name="pressure", levels=[900.0, 1000.0]))


def test_model_levels_without_heights_and_unknown_projections_are_refused(trap: Trap) -> None:
    assert "no geopotential" in _say(trap(level_name="hybrid"))
    assert "holds no wind that can be used" in _say(trap(projected=True))


def test_several_times_need_a_departure(trap: Trap) -> None:
    path = trap(hours=[0.0, 1.0, 3.0], gusty=True)
    assert "3 times, 2026-05-01 12:00 UTC to 2026-05-01 15:00 UTC: give `departure`" in _say(path, ground=_flat)
    wind = read(path, GREENWICH, _flat, NOON + timedelta(hours=1.5))
    points = np.array([[0.0, 0.0, 10.0]])
    np.testing.assert_allclose(wind.at(points), [[17.5, 0, 0]], atol=ONE_CM_PER_SECOND)  # 15 at one, 25 at three
    np.testing.assert_allclose(wind.at(points, 3600.0), [[22.5, 0, 0]], atol=ONE_CM_PER_SECOND)
    with pytest.raises(WindError, match=r"0\.50 h after its last"):
        wind.at(points, 2 * 3600.0)


def test_a_departure_outside_of_the_times_is_an_error_that_says_by_how_much(trap: Trap) -> None:
    path = trap(hours=[0.0, 3.0])
    assert "lies 2.0 h outside" in _say(path, ground=_flat, departure=NOON + timedelta(hours=5))
    with pytest.raises(WindError, match="no time zone"):
        read(path, GREENWICH, departure=datetime(2026, 5, 1, 12))


def test_one_time_is_steady_but_only_for_three_hours_about_it(trap: Trap) -> None:
    path, points = trap(), np.array([[0.0, 0.0, 10.0]])
    np.testing.assert_allclose(read(path, GREENWICH, _flat).at(points, 9e9), FROM_WEST, atol=ONE_CM_PER_SECOND)
    wind = read(path, GREENWICH, _flat, NOON + timedelta(hours=2))
    np.testing.assert_allclose(wind.at(points, 3600.0), FROM_WEST, atol=ONE_CM_PER_SECOND)
    with pytest.raises(WindError, match=r"1\.00 h after its last usable"):
        wind.at(points, 7200.0)
    assert "is 4.0 h from the departure" in _say(path, ground=_flat, departure=NOON + timedelta(hours=4))


def test_an_area_elsewhere_is_an_error_unless_it_is_near_and_extended(trap: Trap) -> None:
    """The file reaches 53° north, in steps of 70 km and more; a box about 53.5° begins 46 km further north."""
    frame, box = LocalFrame(GeoPoint(53.5, 0.0)), (-10_000.0, -10_000.0, 10_000.0, 10_000.0)
    message = _say(trap(), frame, ground=_flat, area=box)
    assert re.search(r"ends 4[56] km short of the area", message)
    assert "extend: nearest" in message
    wind = read(trap(), frame, _flat, area=box, extend=True)
    assert wind.name.endswith("extended")
    np.testing.assert_allclose(wind.at(np.array([[0.0, 0.0, 10.0]])), FROM_WEST, atol=ONE_CM_PER_SECOND)
    far = LocalFrame(GeoPoint(56.0, 0.0))
    for options in ({}, {"extend": True}):
        message = _say(trap(), far, ground=_flat, area=box, **options)
        assert "km short of the area" in message
        assert "extend" not in message


def test_the_title_of_the_file_is_told() -> None:
    path = Path(__file__).resolve().parents[2] / "missions" / "wind" / "jacksboro_synthetic.nc"
    wind = read(path, JACKSBORO, _flat, NOON, area=(-15e3, -16e3, 15e3, 16e3))
    assert "synthetic wind made by gcs_windplan, not a forecast" in wind.name
    corners = np.array([[x, y, z] for x in (-15e3, 15e3) for y in (-16e3, 16e3) for z in (10.0, 80.0, 200.0)])
    speed = np.linalg.norm(wind.at(corners), axis=1)
    assert speed.min() > 2
    assert speed.max() < 12


@pytest.mark.parametrize("length", [20_000, 30_000, 40_000])
def test_a_classic_file_that_was_cut_short_is_an_error(tmp_path: Path, length: int) -> None:
    """netCDF4 itself reads zeros for what is missing, which unpack to some wind."""
    whole = _real("bella_lui_weather_data_ERA5.nc").read_bytes()
    cut = tmp_path / "cut.nc"
    cut.write_bytes(whole[:length])
    assert "cut short" in _say(cut, DAVOS, departure=datetime(2020, 2, 22, 14, tzinfo=UTC))


def test_missing_values_that_nobody_marked_are_no_wind(trap: Trap) -> None:
    path = trap()
    with netCDF4.Dataset(path, "a") as file:
        file.set_auto_mask(False)
        file["u"][0, 0, 2, 2] = -9998.0
    assert "a wind of 9998 m/s, which is none" in _say(path, ground=_flat)


def test_the_last_time_is_not_taken_for_a_steady_wind(trap: Trap) -> None:
    wind = read(trap(hours=[0.0, 3.0, 6.0]), GREENWICH, _flat, NOON + timedelta(hours=6))
    assert list(wind.times) == [-3 * 3600.0, 0.0]
    with pytest.raises(WindError, match="after its last usable"):
        wind.at(np.array([[0.0, 0.0, 10.0]]), 60.0)


def test_a_gap_between_its_times_is_said(trap: Trap) -> None:
    wind = read(trap(hours=[0.0, 1.0, 2.0, 13.0]), GREENWICH, _flat, NOON + timedelta(hours=0.5))
    assert "with a gap of 11 h" in wind.name
    assert "gap" not in read(trap(hours=[0.0, 3.0, 6.0]), GREENWICH, _flat, NOON).name


def test_the_example_of_the_docstring(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(Path(__file__).parents[2])
    done = doctest.testmod(reading)
    assert (done.failed, done.attempted > 5) == (0, True)


@pytest.mark.parametrize(
    ("frame", "departure", "reason"),
    [(GREENWICH, NOON - timedelta(hours=2), "time"), (DAVOS, NOON, "area"), (GREENWICH, NOON, None)],
)
def test_an_error_tells_its_reason_and_its_file(
    trap: Trap, frame: LocalFrame, departure: datetime, reason: str | None
) -> None:
    """Too early, too far away, or without a wind at all."""
    path = trap(hours=(0.0, 6.0), without=() if reason else ("v",))
    with pytest.raises(WindError) as error:
        read_forecast([path], ForecastQuery(frame, departure=departure, area=(0.0, 0.0, 1000.0, 1000.0)))
    assert error.value.reason == reason
    assert [problem.file for problem in error.value.problems] == [path]


def test_an_error_names_the_members_to_choose_from() -> None:
    front = Path(__file__).parents[2] / "missions" / "wind" / "front_synthetic.nc"
    with pytest.raises(WindError) as error:
        read_forecast([front], ForecastQuery(JACKSBORO, departure=datetime(2026, 5, 1, 15, tzinfo=UTC)))
    assert (error.value.reason, error.value.members) == ("members", tuple(range(10)))
