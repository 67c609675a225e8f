"""Levels and times of variables, as all sorts of files tell them."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

from gcs_windplan.errors import WindError
from gcs_windplan.wind.field_index import SURFACE, Level, LevelKind
from tests.wind.netcdf_maker import AXES, HOURS, MS, NOON, Content, everything, wind, write_netcdf

HOUR = 3600.0
TEN, HUNDRED = Level("height", 10.0), Level("height", 100.0)
UNKNOWN = Level("unknown")


@pytest.fixture
def path(tmp_path: Path) -> Path:
    return tmp_path / "trap.nc"


def _levels(path: Path, content: dict[str, Content]) -> list[Level]:
    return [field2d.level for field2d, _ in everything(write_netcdf(path, {**AXES, **content}))[1]]


def _times(path: Path, content: dict[str, Content]) -> list[tuple[float | None, float | None]]:
    """Hours since noon and since the run's noon."""
    fields = everything(write_netcdf(path, {**AXES, **content}))[1]
    return [
        tuple(None if moment is None else (moment - NOON) / HOUR for moment in (field2d.time, field2d.run))  # type: ignore[misc]
        for field2d, _ in fields
    ]


@pytest.mark.parametrize(
    ("said", "values", "kind", "expected"),
    [
        ({"units": "m", "standard_name": "height"}, [10, 100], "height", [10, 100]),
        ({"units": "km", "standard_name": "height"}, [0.01, 0.1], "height", [10, 100]),
        ({"units": "ft", "standard_name": "altitude"}, [1000, 2000], "altitude", [304.8, 609.6]),
        ({"units": "m", "long_name": "height above mean sea level"}, [5, 6], "altitude", [5, 6]),
        ({"units": "hPa"}, [1000, 850], "pressure", [100000, 85000]),
        ({"units": "Pa", "standard_name": "air_pressure"}, [1e5, 99510], "pressure", [100000, 99510]),
        ({"units": "1", "long_name": "hybrid level"}, [136, 137], "model", [136, 137]),
        ({"long_name": "model_level_number"}, [136, 137], "model", [136, 137]),
        ({"standard_name": "height", "long_name": "generalized_height"}, [89, 90], "model", [89, 90]),
    ],
)
def test_level_axes(
    path: Path, said: dict[str, str], values: list[float], kind: LevelKind, expected: list[float]
) -> None:
    """ICON's levels are called height and yet are numbers: `generalized_height`."""
    axis = np.array(values, np.float32)
    levels = _levels(path, {"lev": ("lev", axis, said), "u": wind("lev lat lon", 2, 3, 4)})
    assert levels == [Level(kind, value) for value in expected]


def test_each_variable_has_its_own_axis_as_netcdf_java_writes_them(path: Path) -> None:
    content = {
        "height_above_ground": ("height_above_ground", [2.0], {"units": "m"}),
        "height_above_ground1": ("height_above_ground1", [10.0, 80.0], {"units": "m"}),
        "isobaric3": ("isobaric3", [85000.0, 1e5], {"units": "Pa"}),
        "altitude_above_msl": ("altitude_above_msl", [1829.0], {"units": "m"}),
        "u-component_of_wind_height_above_ground": wind("height_above_ground1 lat lon", 2, 3, 4),
        "u-component_of_wind_isobaric": wind("isobaric3 lat lon", 2, 3, 4),
        "u-component_of_wind_altitude_above_msl": wind("altitude_above_msl lat lon", 1, 3, 4),
        "Wind_speed_gust_surface": wind("lat lon", 3, 4, coordinates="height_above_ground lat lon"),
    }
    assert _levels(path, content) == [
        TEN, Level("height", 80), Level("pressure", 85000), Level("pressure", 1e5), Level("altitude", 1829), SURFACE,
    ]  # fmt: skip


@pytest.mark.parametrize(
    ("name", "said", "expected"),
    [
        ("u", {"coordinates": "height"}, TEN),
        ("u", {"coordinates": "height plev"}, UNKNOWN),
        ("u850", {"coordinates": "plev"}, Level("pressure", 92500)),
        ("u100", {"coordinates": "height"}, HUNDRED),
        ("UGRD_80maboveground", {"coordinates": "plev"}, Level("height", 80)),
        ("u", {"coordinates": "layer"}, UNKNOWN),
        ("u", {}, UNKNOWN),
        ("gust", {"coordinates": "surface"}, SURFACE),
        ("gust", {"GRIB_typeOfLevel": "surface"}, SURFACE),
        ("u10", {"GRIB_typeOfLevel": "surface"}, TEN),
    ],
)
def test_a_level_of_one_value(path: Path, name: str, said: dict[str, str], expected: Level) -> None:
    content = {
        "height": ("", 10.0, {"units": "m", "standard_name": "height"}),
        "plev": ("", 925.0, {"units": "hPa"}),
        "layer": ("", 15.0, {"units": "m", "standard_name": "height", "bounds": "layer_bounds"}),
        name: wind("lat lon", 3, 4, **said),
    }
    assert _levels(path, content) == [expected]


def test_fields_of_the_ground_ignore_a_height_of_zero(path: Path) -> None:
    """Met Norway gives the axis height0, 0 m, to them."""
    content = {
        "height0": ("height0", [0.0], {"units": "m", "standard_name": "height"}),
        "ps": wind("height0 lat lon", 1, 3, 4, value=1e5, units="Pa", standard_name="surface_air_pressure"),
        "HSURF": wind("lat lon", 3, 4, units="m", standard_name="surface_altitude"),
    }
    assert _levels(path, content) == [SURFACE, SURFACE]


def test_a_geopotential_on_no_level_is_the_terrains(path: Path) -> None:
    geopotential = {"standard_name": "geopotential", "units": "m**2 s**-2"}
    content = {
        "plev": ("", 500.0, {"units": "hPa"}),
        "z": wind("lat lon", 3, 4, **geopotential),
        "zz": wind("lat lon", 3, 4, **geopotential, coordinates="plev"),
        "HGT_surface": wind("lat lon", 3, 4, units="gpm"),
        "HGT_500mb": wind("lat lon", 3, 4, units="gpm"),
    }
    fields = everything(write_netcdf(path, {**AXES, **content}))[1]
    assert [(field2d.quantity, field2d.level) for field2d, _ in fields] == [
        ("terrain", SURFACE), ("height", Level("pressure", 5e4)), ("terrain", SURFACE),
        ("height", Level("pressure", 5e4)),
    ]  # fmt: skip


def test_times_and_runs_of_their_own(path: Path) -> None:
    content = {
        "time": ("time", [0.0, 3.0], {"units": HOURS}),
        "time1": ("time1", [1.0], {"units": "Hour since 2026-05-01T12:00:00Z"}),
        "reftime": ("time", [-6.0, -6.0], {"units": HOURS, "standard_name": "forecast_reference_time"}),
        "u10": wind("time lat lon", 2, 3, 4),
        "v10": wind("time1 lat lon", 1, 3, 4),
    }
    assert _times(path, content) == [(0, -6), (3, -6), (1, None)]


def test_runs_times_leads_are_added(path: Path) -> None:
    """As the new Climate Data Store and cfgrib write them: with the valid time, or with leads alone."""
    run: Content = ("run", [-12.0, 0.0], {"units": HOURS, "standard_name": "forecast_reference_time"})
    step: Content = ("step", [0.0, 6.0, 12.0], {"units": "hours", "standard_name": "forecast_period"})
    valid: Content = ("run step", [[-12.0, -6.0, 0.0], [0.0, 6.0, 12.0]], {"units": HOURS, "standard_name": "time"})
    expected = [(-12, -12), (-6, -12), (0, -12), (0, 0), (6, 0), (12, 0)]
    content = {"run": run, "step": step, "u10": wind("run step lat lon", 2, 3, 3, 4)}
    assert _times(path, content) == expected
    assert _times(path, {**content, "valid_time": valid}) == expected
    plain = {"time": ("time", run[1], {"units": HOURS}), "step": ("step", step[1], {"units": "hours"})}
    assert _times(path, {**plain, "u10": wind("time step lat lon", 2, 3, 3, 4)}) == expected
    two = {"valid_time": ("time step", valid[1], {"units": HOURS})}
    assert _times(path, {**plain, **two, "u10": wind("time step lat lon", 2, 3, 3, 4)}) == expected


@pytest.mark.parametrize(
    ("content", "expected"),
    [
        ({"run": ("", 0.0, "run"), "step": ("step", [3.0], "step")}, [(3, 0)]),  # leads alone
        ({"time": ("", 0.0, "time"), "step": ("step", [3.0], "step")}, [(3, 0)]),
        ({"step": ("step", [3.0], "step"), "valid_time": ("step", [3.0], "time"), "time": ("", 0.0, "run")}, [(3, 0)]),
        ({"run": ("run", [0.0], "run"), "step": ("", 3.0, "step")}, [(3, 0)]),
        ({"time": ("time", [4.0], "time"), "lead": ("time", [3.0], "step")}, [(4, 1)]),
        ({"time": ("", 4.0, "time")}, [(4, None)]),
        ({"time": ("", 4.0, "time"), "run": ("", 1.0, "run")}, [(4, 1)]),
        ({"run": ("", 1.0, "run"), "step": ("", 2.0, "step")}, [(3, 1)]),
        ({"time": ("time", [4.0], "time"), "run": ("", 1.0, "run")}, [(4, 1)]),
        ({}, [(None, None)]),
    ],
)
def test_single_times_and_runs(
    path: Path, content: dict[str, tuple[str, Any, str]], expected: list[tuple[float | None, float | None]]
) -> None:
    said = {
        "time": {"units": HOURS, "standard_name": "time"},
        "run": {"units": HOURS, "standard_name": "forecast_reference_time"},
        "step": {"units": "hours", "standard_name": "forecast_period"},
    }
    along = next((dimensions for dimensions, _, _ in content.values() if dimensions), "")
    shape = (1, 3, 4) if along else (3, 4)
    variables = {name: (text, values, said[kind]) for name, (text, values, kind) in content.items()}
    assert _times(path, {**variables, "u10": wind(f"{along} lat lon", *shape)}) == expected


def test_a_field_of_times_is_no_time_axis(path: Path) -> None:
    content = {
        "time": ("time", [1.0, 2.0], {"units": HOURS}),
        "time_of_maximum": ("lat lon", np.zeros((3, 4)), {"units": HOURS, "standard_name": "time"}),
        "u10": wind("time lat lon", 2, 3, 4),
    }
    assert _times(path, content) == [(1, None), (2, None)]


def test_a_lead_in_unknown_units_is_not_missed_where_the_time_is_told(path: Path) -> None:
    said = {"standard_name": "forecast_period", "units": "model steps"}
    content = {"time": ("", 4.0, {"units": HOURS}), "step": ("", 2.0, said), "u10": wind("lat lon", 3, 4)}
    assert _times(path, content) == [(4, None)]
    content = {
        "time": ("time", [4.0], {"units": HOURS}),
        "step": ("time", [2.0], said),
        "u10": wind("time lat lon", 1, 3, 4),
    }
    assert _times(path, content) == [(4, None)]


def test_terrain_holds_always_though_the_file_has_one_time(path: Path) -> None:
    content = {
        "time": ("", 0.0, {"units": HOURS}),
        "orog": wind("lat lon", 3, 4, units="m"),
        "u10": wind("lat lon", 3, 4),
    }
    assert _times(path, content) == [(None, None), (0, None)]


@pytest.mark.parametrize("calendar", ["noleap", "365_day", "360_day", "all_leap"])
def test_calendars_of_climate_models_are_refused(path: Path, calendar: str) -> None:
    time: Content = ("time", [0.0], {"units": HOURS, "calendar": calendar})
    write_netcdf(path, {**AXES, "time": time, "u10": wind("time lat lon", 1, 3, 4)})
    with pytest.raises(WindError, match=rf"trap.nc: u10: the times time are in the calendar {calendar}, which is no"):
        everything(path)


def test_leads_without_a_run_and_runs_without_leads_are_refused(path: Path) -> None:
    step: Content = ("step", [0.0, 6.0], {"units": "hours"})
    write_netcdf(path, {**AXES, "step": step, "u10": wind("step lat lon", 2, 3, 4)})
    with pytest.raises(WindError, match="u10: it tells leads but not when the forecast began"):
        everything(path)
    run: Content = ("time", [0.0, 6.0], {"units": HOURS, "standard_name": "forecast_reference_time"})
    write_netcdf(path, {**AXES, "time": run, "u10": wind("time lat lon", 2, 3, 4)})
    with pytest.raises(WindError, match="u10: it tells when forecasts began but no leads"):
        everything(path)


def test_times_with_gaps_are_refused(path: Path) -> None:
    write_netcdf(
        path, {**AXES, "time": ("time", [0.0, np.nan], {"units": HOURS}), "u10": wind("time lat lon", 2, 3, 4)}
    )
    with pytest.raises(WindError, match="its coordinate time has missing values"):
        everything(path)


def test_wrf_tells_times_as_text(path: Path) -> None:
    letters = np.array([list("2026-05-01_13:00:00"), list("2026-05-01_14:30:00")], dtype="S1")
    content = {"Times": ("Time DateStrLen", letters, {}), "U10": wind("Time lat lon", 2, 3, 4, description="U at 10 M")}
    assert _times(path, content) == [(1, None), (2.5, None)]
    assert _levels(path, content) == [TEN, TEN]


def test_units_that_u_and_v_keep_in_different_precision_make_equal_levels(path: Path) -> None:
    content = {
        "a": ("a", np.array([0.1, 995.1], np.float32), {"units": "hPa"}),
        "b": ("b", np.array([0.1, 995.1], np.float64), {"units": "hPa"}),
        "u": wind("a lat lon", 2, 3, 4),
        "v": ("b lat lon", np.zeros((2, 3, 4)), MS),
    }
    levels = _levels(path, content)
    assert levels[:2] == levels[2:]
