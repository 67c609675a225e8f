"""What variables are taken for."""

from __future__ import annotations

import pytest

from gcs_windplan.wind.cf import Variable, axis_kind, coordinate_of, find_winds

GRID = ("latitude", "longitude")


def _file(*variables: Variable) -> dict[str, Variable]:
    return {variable.name: variable for variable in variables}


def _on_grid(*names: str, **attributes: str) -> list[Variable]:
    return [Variable(name, GRID, (3, 3), attributes) for name in names]


def test_of_two_heights_in_the_name_the_greater_is_taken_whole() -> None:
    u, v = find_winds(_file(*_on_grid("u10", "u100", "v10", "v100")))
    assert (u.name, v.name) == ("u100", "v100")


def test_the_pair_with_the_most_levels_is_taken() -> None:
    levels = [Variable(name, ("level", *GRID), (5, 3, 3), {}) for name in ("ua", "va")]
    u, v = find_winds(_file(*_on_grid("u10", "v10"), *levels))
    assert (u.name, v.name) == ("ua", "va")


def test_standard_names_are_paired_though_the_names_are_not() -> None:
    east = Variable("first", GRID, (3, 3), {"standard_name": "x_wind"})
    north = Variable("second", GRID, (3, 3), {"standard_name": "y_wind"})
    assert find_winds(_file(north, east)) == (east, north)


@pytest.mark.parametrize(
    ("name", "attributes", "kind"),
    [
        ("lat", {}, "latitude"),
        ("y", {"units": "degrees_north"}, "latitude"),
        ("x", {"units": "degree_east"}, "longitude"),
        ("rlat", {"standard_name": "grid_latitude", "units": "degrees"}, None),
        ("t", {"units": "hours since 1900-01-01"}, "time"),
        ("base", {"standard_name": "forecast_reference_time", "units": "hours since 1900-01-01"}, None),
        ("level", {"units": "millibars"}, "pressure"),
        ("isobaricInhPa", {"units": "hPa"}, "pressure"),
        ("height_above_ground2", {"units": "m"}, "height"),
        ("h", {"standard_name": "altitude", "units": "m"}, "altitude"),
        ("h", {"long_name": "Height above mean sea level", "units": "m"}, "altitude"),
        ("height", {"standard_name": "height_above_reference_ellipsoid", "units": "m"}, None),
        ("hybrid", {"units": "1"}, None),
        ("level", {}, None),
    ],
)
def test_axes_are_known_by_standard_name_then_units_then_name(
    name: str, attributes: dict[str, str], kind: str | None
) -> None:
    assert axis_kind(Variable(name, (name,), (3,), attributes)) == kind


def test_lead_times_are_read_from_the_valid_time_along_them() -> None:
    since = {"standard_name": "time", "units": "seconds since 1970-01-01"}
    file = _file(
        Variable("step", ("step",), (4,), {"units": "hours", "standard_name": "forecast_period"}),
        Variable("valid_time", ("time", "step"), (1, 4), since),
    )
    found = coordinate_of(file, "step")
    assert found is not None
    assert (found[0], found[1].name) == ("time", "valid_time")
