"""Units of wind files."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from gcs_windplan.errors import WindError
from gcs_windplan.wind.field_index import Quantity
from gcs_windplan.wind.files.units import (
    BY_QUANTITY,
    UnitTable,
    check_units,
    compact,
    converted,
    is_something_else,
    unit_factor,
    unlogged,
)

QUANTITIES = sorted(BY_QUANTITY)


@pytest.mark.parametrize(
    ("quantity", "units", "value", "expected"),
    [
        ("u", "m s**-1", 3.0, 3.0),
        ("speed", "knots", 10.0, 5.14444),
        ("gust", "km h-1", 36.0, 10.0),
        ("v", "mp/h", 10.0, 4.4704),
        ("direction", "degree_true", 270.0, 270.0),
        ("direction", "°", 270.0, 270.0),
        ("direction", "radians", np.pi, 180.0),
        ("height", "m**2 s**-2", 9806.65, 1000.0),
        ("height", "m² s⁻²", 9806.65, 1000.0),
        ("terrain", "gpm", 7.0, 7.0),
        ("terrain", "ft", 10.0, 3.048),
        ("roughness", "cm", 3.0, 0.03),
        ("temperature", "degC", 0.0, 273.15),
        ("temperature", "K", 280.0, 280.0),
        ("humidity", "g kg-1", 5.0, 0.005),
        ("pressure", "hPa", 1013.25, 101325.0),
    ],
)
def test_units_in_common_use(quantity: Quantity, units: str, value: float, expected: float) -> None:
    assert converted(np.array([value]), quantity, "x", units)[0] == pytest.approx(expected, rel=1e-6)


@given(st.sampled_from(QUANTITIES), st.data(), st.floats(-1e6, 1e6), st.floats(-1e6, 1e6))
def test_conversion_is_a_straight_line_upwards(quantity: Quantity, data: st.DataObject, one: float, two: float) -> None:
    units = data.draw(st.sampled_from(sorted(BY_QUANTITY[quantity].factors)))
    a, middle, b = converted(np.array([one, (one + two) / 2, two]), quantity, "x", units)
    assert middle == pytest.approx((a + b) / 2, rel=1e-9, abs=1e-6)
    assert (b - a) * (two - one) >= 0


@given(st.sampled_from(QUANTITIES), st.data())
def test_case_and_blanks_do_not_matter(quantity: Quantity, data: st.DataObject) -> None:
    table: UnitTable = BY_QUANTITY[quantity]
    units = data.draw(st.sampled_from(sorted(table.factors)))
    assert unit_factor("x", f" {units.upper()} ", table) == table.factors[units]


@pytest.mark.parametrize(("units", "quantity", "logarithm"), [("m", "height", False), ("~", "pressure", True)])
def test_units_that_fit_raise_nothing(units: str, quantity: Quantity, logarithm: bool) -> None:
    check_units("x", units, quantity, logarithm)


@given(st.floats(1e3, 1.1e5))
def test_the_logarithm_of_a_pressure_is_undone(pressure: float) -> None:
    assert unlogged(np.log([pressure]), "lnsp")[0] == pytest.approx(pressure)


def test_missing_and_unknown_units_name_the_variable_and_what_to_set() -> None:
    with pytest.raises(WindError, match="gust has no units; set its attribute `units` to a speed: m/s, knots"):
        converted(np.zeros(1), "gust", "gust", " ")
    with pytest.raises(WindError, match="z is in 'bananas', which is not a geopotential"):
        converted(np.zeros(1), "height", "z", "bananas")
    with pytest.raises(WindError, match="lnsp is in 'Pa', but the logarithm"):
        check_units("lnsp", "Pa", "pressure", logarithm=True)
    with pytest.raises(WindError, match="lnsp goes up to 100000, which is the logarithm of no pressure"):
        unlogged(np.array([np.nan, 1e5]), "lnsp")


@pytest.mark.parametrize(
    ("units", "quantity", "expected"),
    [("%", "u", True), ("K", "u", True), ("1", "speed", True), ("m", "speed", True), ("kn", "speed", False),
     ("", "u", False), ("furlongs", "u", False), ("1", "humidity", False), ("%", "direction", True)],
)  # fmt: skip
def test_what_is_well_known_and_something_else(units: str, quantity: Quantity, expected: bool) -> None:
    assert is_something_else(units, quantity) is expected


@pytest.mark.parametrize("units", ["m s-1", "m s**-1", "m s^-1", "m.s-1", "M S-1", "m s⁻¹", "m s{-1}"])
def test_exponents_are_written_in_many_ways(units: str) -> None:
    assert compact(units) == "ms-1"
