"""What is made of fields: turned to true north, put at their heights, the right run, members and times."""

from __future__ import annotations

import math
from datetime import UTC, datetime
from pathlib import Path

import netCDF4
import numpy as np
import pytest

from gcs_windplan.errors import WindError
from gcs_windplan.geo.frame import GeoPoint, LocalFrame, rotate
from gcs_windplan.wind import Forecast, ForecastQuery, read_forecast
from gcs_windplan.wind.model_levels import heights_of_levels
from tests.wind.grib_files import box, message
from tests.wind.netcdf_maker import write_netcdf

ONE_CM_PER_SECOND = 0.01
FRAME = LocalFrame(GeoPoint(51.0, 9.5))
NOON = datetime(2026, 5, 1, 12, tzinfo=UTC)
DATA = Path(__file__).resolve().parents[2].parent / "shared" / "data" / "wind"
HERE = np.array([[0.0, 0.0, 50.0]])


def _flat(points):
    return np.zeros(len(points))


def _file(path: Path, *messages: bytes) -> Path:
    path.write_bytes(b"".join(messages))
    return path


def _level(u: float, v: float = 0.0, height: float | None = None, **keys) -> list[bytes]:
    """u and v, and the geopotential of a level at a height above sea level."""
    fields = [message("u", u, **keys), message("v", v, **keys)]
    return fields if height is None else [*fields, message("z", height * 9.80665, **keys)]


def _read(path: Path, ground=_flat, departure: datetime | None = NOON, **options) -> Forecast:
    return read_forecast([path], ForecastQuery(FRAME, ground, departure, **options))


def _east(forecast: Forecast, *heights: float, seconds: float = 0.0, member: int = 0):
    points = np.array([[0.0, 0.0, height] for height in heights])
    return forecast.fields[member].at(points, seconds)[:, 0]


def test_pressure_levels_from_grib_lie_at_their_geopotential_heights(tmp_path: Path) -> None:
    path = _file(tmp_path / "a.grib", *_level(20, height=1500, level=850), *_level(10, height=100, level=1000))
    np.testing.assert_allclose(_east(_read(path), 100, 800, 1500), [10, 15, 20], atol=ONE_CM_PER_SECOND)


def test_ten_metre_wind_and_pressure_levels_make_one_column(tmp_path: Path) -> None:
    """10 m above the ground, which the forecast puts at 300 m, then 1500 m; 1000 hPa lies under its ground."""
    path = _file(
        tmp_path / "a.grib",
        *_level(20, height=1500, level=850),
        *_level(99, height=100, level=1000),
        *(message(name, value, typeOfLevel="heightAboveGround", level=10) for name, value in (("10u", 6), ("10v", 0))),
        message("orog", 300.0, typeOfLevel="surface", level=0),
    )
    forecast = _read(path, lambda points: np.full(len(points), 200.0))
    expected = [6, 6 + 14 * 0.5, 20]
    np.testing.assert_allclose(_east(forecast, 210, (210 + 1500) / 2, 1500), expected, atol=ONE_CM_PER_SECOND)
    low = 6 * math.log(5 / 0.1) / math.log(10 / 0.1)
    np.testing.assert_allclose(_east(forecast, 205), [low], atol=ONE_CM_PER_SECOND)


def test_the_files_own_roughness_shapes_the_wind_below_the_lowest_level(tmp_path: Path) -> None:
    path = _file(
        tmp_path / "a.grib",
        *_level(20, height=1500, level=850),
        *_level(10, height=100, level=1000),
        message("fsr", 1.0, typeOfLevel="surface", level=0),
    )
    forecast = _read(path)
    assert "below by a log law (the file's roughness)" in forecast.name
    np.testing.assert_allclose(_east(forecast, 10), [10 * 0.5], atol=ONE_CM_PER_SECOND)
    own = _read(path, roughness=0.1)
    np.testing.assert_allclose(_east(own, 10), [10 * 2 / 3], atol=ONE_CM_PER_SECOND)


def test_values_masked_under_the_forecasts_ground_do_not_matter(tmp_path: Path) -> None:
    gaps = np.full(12, 99.0)
    gaps[3:] = -1.0
    path = _file(
        tmp_path / "a.grib",
        *_level(20, height=1500, level=850),
        message("u", gaps, level=1000, missing=-1.0),
        message("v", 0.0, level=1000),
        message("z", 100 * 9.80665, level=1000),
        message("orog", 300.0, typeOfLevel="surface", level=0),
    )
    low = 20 * math.log(120 / 0.1) / math.log(1200 / 0.1)
    np.testing.assert_allclose(_east(_read(path), 120.0), [low], atol=ONE_CM_PER_SECOND)


def test_of_several_runs_the_newest_counts_for_each_time(tmp_path: Path) -> None:
    """The run of 6 o'clock reaches to noon, that of 12 begins there; at 9 only the older one has a wind."""
    older = {"dataTime": 600}
    messages = [m for step, u in ((3, 5.0), (6, 7.0)) for m in _level(u, height=1500, endStep=step, **older)]
    newer = [m for step, u in ((0, 8.0), (3, 11.0)) for m in _level(u, height=1500, endStep=step)]
    path = _file(tmp_path / "a.grib", *messages, *newer)
    forecast = _read(path, departure=NOON.replace(hour=9))
    found = [_east(forecast, 1500.0, seconds=hours * 3600.0)[0] for hours in (0, 3, 4.5)]
    np.testing.assert_allclose(found, [5, 8, 9.5], atol=ONE_CM_PER_SECOND)
    assert "of several runs the newest for each time" in forecast.name


def test_only_the_times_that_the_flight_needs_are_read(tmp_path: Path) -> None:
    path = _file(
        tmp_path / "a.grib", *(m for step in range(0, 13, 3) for m in _level(5 + step, height=1500, endStep=step))
    )
    forecast = _read(path, departure=NOON.replace(hour=16), lasting=4000.0)
    np.testing.assert_allclose(forecast.fields[0].times, [-3600, 2 * 3600])
    with pytest.raises(WindError, match=r"after its last usable time"):
        _east(forecast, 1500.0, seconds=2.5 * 3600)


def test_two_files_belong_together(tmp_path: Path) -> None:
    first = _file(tmp_path / "a.grib", *_level(10, height=1500))
    second = _file(tmp_path / "b.grib", *_level(20, height=1500, endStep=6))
    forecast = read_forecast([first, second], ForecastQuery(FRAME, _flat, NOON))
    assert "a.grib and 1 more" in forecast.name
    np.testing.assert_allclose(_east(forecast, 1500.0, seconds=3 * 3600.0), [15], atol=ONE_CM_PER_SECOND)


def _ensemble(path: Path, members: int = 3) -> Path:
    keys = {"productDefinitionTemplateNumber": 1, "numberOfForecastsInEnsemble": members}
    messages = []
    for number in range(members):
        more = {**keys, "perturbationNumber": number, "typeOfEnsembleForecast": 3}
        messages += _level(10.0 + number, height=1500.0 + 100 * number, **more)
        messages += _level(5.0, height=100.0, level=1000, **more)
    return _file(path, *messages)


def test_each_member_has_its_own_winds_and_heights(tmp_path: Path) -> None:
    forecast = _read(_ensemble(tmp_path / "a.grib"), members="all")
    assert forecast.members == (0, 1, 2)
    for number in range(3):
        height = 1500.0 + 100 * number
        np.testing.assert_allclose(_east(forecast, height, member=number), [10 + number], atol=ONE_CM_PER_SECOND)
        assert np.isnan(_east(forecast, height + 1, member=number)).all()
    np.testing.assert_allclose(forecast.mean.at(np.array([[0.0, 0.0, 1600.0]]))[0, 0], 11, atol=ONE_CM_PER_SECOND)


def test_members_are_to_be_chosen(tmp_path: Path) -> None:
    path = _ensemble(tmp_path / "a.grib")
    with pytest.raises(WindError, match=r"ensemble of 3 members \(0 to 2\): say `members: all`"):
        _read(path)
    assert _read(path, members=(2,)).members == (2,)
    with pytest.raises(WindError, match="no member 7, but 0, 1, 2"):
        _read(path, members=(1, 7))
    with pytest.raises(WindError, match="no ensemble: leave `members` out"):
        _read(_file(tmp_path / "b.grib", *_level(10, height=1500)), members="all")


def _lambert(path: Path, along_grid: bool = True) -> Path:
    """A Lambert grid of 20 km about 52 N, 25 E with its axis at 10 E: there the grid is turned by some 12 degrees."""
    x, y = np.meshgrid(np.arange(-300e3, 301e3, 20e3), np.arange(-300e3, 301e3, 20e3))
    centre = np.array([1_028_000.0, 290_000.0])  # of 52 N, 25 E in that projection, roughly
    x, y = x[0] + centre[0], y[:, 0] + centre[1]
    names = ("x_wind", "y_wind") if along_grid else ("eastward_wind", "northward_wind")
    dimensions = "height y x"
    shape = (2, len(y), len(x))
    said = {"units": "m s-1", "grid_mapping": "lcc"}
    return write_netcdf(
        path,
        {
            "lcc": ("", np.array(0), {
                "grid_mapping_name": "lambert_conformal_conic", "standard_parallel": 50.0, "earth_radius": 6371229.0,
                "longitude_of_central_meridian": 10.0, "latitude_of_projection_origin": 50.0,
            }),
            "x": ("x", x, {"standard_name": "projection_x_coordinate", "units": "m"}),
            "y": ("y", y, {"standard_name": "projection_y_coordinate", "units": "m"}),
            "height": ("height", [10.0, 100.0], {"standard_name": "height", "units": "m"}),
            "a": (dimensions, np.full(shape, 10.0), {**said, "standard_name": names[0]}),
            "b": (dimensions, np.full(shape, 0.0), {**said, "standard_name": names[1]}),
        },
    )  # fmt: skip


def test_winds_along_a_lambert_grid_are_turned_to_true_north(tmp_path: Path) -> None:
    """At 25 E of an axis at 10 E the grid's x axis points n · 15 degrees south of east, n = sin(50): Snyder 1987."""
    frame = LocalFrame(GeoPoint(52.0, 25.0))
    query = ForecastQuery(frame, _flat, None, area=(-50e3, -50e3, 50e3, 50e3))
    found = read_forecast([_lambert(tmp_path / "a.nc")], query).mean.at(np.array([[0.0, 0.0, 50.0]]))[0]
    angle = math.sin(math.radians(50.0)) * math.radians(15.0)
    np.testing.assert_allclose(found[:2], [10 * math.cos(angle), -10 * math.sin(angle)], atol=ONE_CM_PER_SECOND)
    true = read_forecast([_lambert(tmp_path / "b.nc", along_grid=False)], query).mean
    np.testing.assert_allclose(true.at(np.array([[0.0, 0.0, 50.0]]))[0], [10, 0, 0], atol=ONE_CM_PER_SECOND)


def test_over_the_whole_area_of_a_lambert_grid_the_turn_follows_the_meridians(tmp_path: Path) -> None:
    frame = LocalFrame(GeoPoint(52.0, 25.0))
    query = ForecastQuery(frame, _flat, None, area=(-80e3, -80e3, 80e3, 80e3))
    wind = read_forecast([_lambert(tmp_path / "a.nc")], query).mean
    points = np.array([[x, y, 50.0] for x in (-80e3, 0.0, 80e3) for y in (-80e3, 0.0, 80e3)])
    _, longitudes = frame.to_geographic(points)
    angle = math.sin(math.radians(50.0)) * np.radians(longitudes - 10.0)
    true = np.column_stack([10 * np.cos(angle), -10 * np.sin(angle), np.zeros(9)])
    found = rotate(wind.at(points), frame.convergence(points))
    np.testing.assert_allclose(found, true, atol=ONE_CM_PER_SECOND)


def test_outside_of_a_lambert_grid_is_an_error(tmp_path: Path) -> None:
    frame = LocalFrame(GeoPoint(52.0, 35.0))
    with pytest.raises(WindError, match=r"ends \d+ km short of the area: it covers, within latitudes"):
        read_forecast([_lambert(tmp_path / "a.nc")], ForecastQuery(frame, _flat, None, area=(-5e3, -5e3, 5e3, 5e3)))


def test_model_levels_in_an_isothermal_atmosphere_lie_where_the_hypsometric_equation_has_them() -> None:
    """z = R T / g · ln(p_surface / p) at the half levels; full levels lie between them."""
    edges = np.array([0.0, 20000.0, 50000.0, 80000.0, 90000.0, 97000.0, 100000.0])
    pressure, terrain = np.full((2, 2), 100000.0), np.full((2, 2), 250.0)
    warm = {level: np.full((2, 2), 280.0) for level in range(1, 7)}
    found = heights_of_levels((edges, np.zeros(7)), pressure, terrain, warm, {})
    scale = 287.0597 * 280.0 / 9.80665
    for level in range(4, 7):
        lower, upper = (250 + scale * math.log(1e5 / edge) for edge in (edges[level], edges[level - 1]))
        assert lower < found[level][0, 0] < upper
        middle = 250 + scale * math.log(1e5 / math.sqrt(edges[level] * edges[level - 1]))
        assert found[level][0, 0] == pytest.approx(middle, rel=0.03)
    moist = heights_of_levels((edges, np.zeros(7)), pressure, terrain, warm, {6: np.full((2, 2), 0.02)})
    assert moist[5][0, 0] > found[5][0, 0]


def test_model_levels_with_a_gap_to_the_ground_are_refused() -> None:
    with pytest.raises(WindError, match="level 3 is missing"):
        heights_of_levels((np.zeros(4), np.linspace(0, 1, 4)), np.full(1, 1e5), np.zeros(1), {2: np.full(1, 280.0)}, {})


def test_model_levels_of_a_file_are_placed_by_temperature_and_pressure(tmp_path: Path) -> None:
    pv = [0.0, 50000.0, 30000.0, 0.0, 0.0, 0.0, 0.5, 1.0]  # 3 levels: p = 50000, 30000 + 0.5 ps, ps
    grid = box()
    messages = []
    for level in (1, 2, 3):
        keys = {"typeOfLevel": "hybrid", "level": level, "pv": pv, "grid": grid}
        messages += [message("u", 10.0 * level, **keys), message("v", 0.0, **keys), message("t", 280.0, **keys)]
    messages += [
        message("sp", 1e5, typeOfLevel="surface", level=0, grid=grid),
        message("orog", 0.0, typeOfLevel="surface", level=0, grid=grid),
    ]
    forecast = _read(_file(tmp_path / "a.grib", *messages))
    scale = 287.0597 * 280.0 / 9.80665
    share = 1 - 80000 / 20000 * math.log(1e5 / 8e4)
    np.testing.assert_allclose(_east(forecast, scale * share), [30], atol=ONE_CM_PER_SECOND)


def test_gusts_are_read_beside_the_wind() -> None:
    path = DATA / "openmeteo_slc_hourly_pressure_levels.json"
    if not path.exists():
        pytest.skip(f"{path.name} is not on this machine: the shared test data are missing")
    frame = LocalFrame(GeoPoint(40.764416, -111.981255))
    departure = datetime(2025, 9, 11, 18, tzinfo=UTC)  # 12:00 in the file's local time
    forecast = read_forecast([path], ForecastQuery(frame, lambda p: np.full(len(p), 1288.0), departure))
    gust = np.hypot(*forecast.gusts[0].at(np.array([[0.0, 0.0, 1400.0]]))[0, :2])
    assert gust == pytest.approx(23.5 * 0.44704, abs=ONE_CM_PER_SECOND)
    low = forecast.mean.at(np.array([[0.0, 0.0, 1298.0]]))[0]
    speed, towards = 13.0 * 0.44704, math.radians(191.0 + 180.0)
    np.testing.assert_allclose(low[:2], [speed * math.sin(towards), speed * math.cos(towards)], atol=ONE_CM_PER_SECOND)


def test_the_real_lambert_forecast_equals_the_file(shared_data: Path) -> None:
    """NDFD over the Big Butte: speed and direction at nodes, turned to true north by nobody but its authors."""
    path = shared_data / "wind" / "ndfd_20170603T1800.nc"
    frame = LocalFrame(GeoPoint(43.4, -113.02))
    wind = read_forecast([path], ForecastQuery(frame, _flat, None, area=(-20e3, -20e3, 20e3, 20e3))).mean
    with netCDF4.Dataset(path) as file:
        speed = file["Wind_speed_height_above_ground"][0, 0]
        direction = file["Wind_direction_from_which_blowing_height_above_ground"][0, 0]
        x, y = file["x"][:].data * 1e3, file["y"][:].data * 1e3
    latitudes, longitudes = _lambert_inverse(x[None, :], y[:, None])
    random = np.random.default_rng(2)
    near = np.argwhere((np.abs(latitudes - 43.4) < 0.12) & (np.abs(longitudes + 113.02) < 0.15))
    picks = near[random.choice(len(near), 10, replace=False)]
    for row, column in picks:
        place = frame.to_local(latitudes[row, column], longitudes[row, column])[0]
        point = np.array([[*place, 10.0]])
        found = rotate(wind.at(point), frame.convergence(point))[0, :2]
        towards = math.radians(float(direction[row, column]) + 180.0)
        expected = float(speed[row, column]) * np.array([math.sin(towards), math.cos(towards)])
        np.testing.assert_allclose(found, expected, atol=ONE_CM_PER_SECOND)


def _lambert_inverse(x, y):
    """Latitude and longitude of NDFD's Lambert grid: one standard parallel of 25 N, sphere (Snyder 1987, 15-10 ...)."""
    radius, n = 6371200.0, math.sin(math.radians(25.0))
    f = math.cos(math.radians(25.0)) * math.tan(math.pi / 4 + math.radians(12.5)) ** n / n
    rho0 = radius * f / math.tan(math.pi / 4 + math.radians(12.5)) ** n
    rho = np.hypot(x, rho0 - y)
    theta = np.arctan2(x, rho0 - y)
    latitudes = 2 * np.arctan((radius * f / rho) ** (1 / n)) - math.pi / 2
    return np.degrees(latitudes), np.degrees(theta) / n + 265.0 - 360.0


def test_a_forecast_with_u_and_v_on_different_levels_uses_the_common_ones(shared_data: Path) -> None:
    path = shared_data / "wind" / "ecmwf_uv_on_different_levels.grib"
    with pytest.raises(WindError, match="no geopotential"):
        read_forecast([path], ForecastQuery(FRAME, _flat, datetime(2017, 10, 18, 20, tzinfo=UTC)))


def test_an_ensemble_without_v_is_refused(shared_data: Path) -> None:
    with pytest.raises(WindError, match=r"it has u \(u\) but no v"):
        read_forecast(
            [shared_data / "wind" / "ecmwf_ens_ztu_multi_dim.grib"], ForecastQuery(FRAME, _flat, NOON, members="all")
        )


def test_a_gust_is_of_the_same_run_as_the_wind(tmp_path: Path) -> None:
    gust = {"typeOfLevel": "heightAboveGround", "level": 10}
    path = _file(
        tmp_path / "a.grib",
        *_level(5, height=1500, dataTime=0, endStep=12),
        message("gust", 99.0, dataTime=0, endStep=12, **gust),
        *_level(7, height=1500, dataTime=1200),
        message("gust", 12.0, dataTime=1200, **gust),
    )
    forecast = _read(path)
    np.testing.assert_allclose(_east(forecast, 1500.0), [7], atol=ONE_CM_PER_SECOND)
    assert np.hypot(*forecast.gusts[0].at(HERE)[0, :2]) == pytest.approx(12.0, abs=ONE_CM_PER_SECOND)
