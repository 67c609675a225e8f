"""Units against exact definitions (BIPM SI brochure, NIST SP 811) and as round trips."""

import math
import re

import pytest
from hypothesis import given
from hypothesis import strategies as st

from gcs_windplan.units import ANGLE, LENGTH, NUMBER, QUANTITIES, SPEED, TIME, Quantity, read_quantity

FINITE = st.floats(allow_nan=False, allow_infinity=False, min_value=-1e12, max_value=1e12)


@pytest.mark.parametrize(
    ("text", "quantity", "expected"),
    [
        ("12 m/s", SPEED, 12.0),
        ("45 km/h", SPEED, 12.5),
        ("20 kt", SPEED, 10.288888888888889),  # 20 · 1852 / 3600
        ("27 mph", SPEED, 12.07008),  # 1 mph = 0.447 04 m/s
        ("500 ft/min", SPEED, 2.54),
        ("10 ft/s", SPEED, 3.048),
        ("400 ft", LENGTH, 121.92),
        ("1.5 km", LENGTH, 1500.0),
        ("2 nmi", LENGTH, 3704.0),
        ("3 mi", LENGTH, 4828.032),
        ("90 deg", ANGLE, 90.0),
        ("90°", ANGLE, 90.0),
        ("3.141592653589793 rad", ANGLE, 180.0),
        ("15 min", TIME, 900.0),
        ("1.5 h", TIME, 5400.0),
        ("30 s", TIME, 30.0),
        ("12", SPEED, 12.0),
        (" -1.5e2m ", LENGTH, -150.0),
        (".5 km", LENGTH, 500.0),
        (7, NUMBER, 7.0),
    ],
)
def test_known_conversions(text: object, quantity: Quantity, expected: float) -> None:
    assert read_quantity(text, quantity) == pytest.approx(expected, rel=1e-14)


@pytest.mark.parametrize(
    ("value", "quantity", "message"),
    [
        ("12 m", SPEED, "'12 m' is a length, but a speed belongs here; write for example 12 m/s"),
        ("12 kn", SPEED, "unknown unit 'kn' for a speed; known units: m/s, km/h, kt, mph, ft/s, ft/min"),
        ("1 NM", LENGTH, "unknown unit 'NM' for a length; known units: m, km, ft, mi, nmi"),
        ("12,5 m/s", SPEED, "'12,5 m/s' has a decimal comma; write a point, as in '12.5 m/s'"),
        ("0.5 m", NUMBER, "'0.5 m' has a unit, but a plain number belongs here"),
        ("fast", SPEED, "'fast' is not a speed; write for example 12 m/s, or a plain number in m/s"),
        ("12:30", ANGLE, "'12:30' is not an angle"),
        ("", SPEED, "'' is not a speed"),
        (True, SPEED, "true is not a speed"),
        (None, SPEED, "an empty value is not a speed"),
        ([], SPEED, "a list is not a speed"),
        ({}, SPEED, "a section is not a speed"),
        (math.nan, SPEED, "nan is not a finite number"),
        (-math.inf, SPEED, "-inf is not a finite number"),
        (10**400, LENGTH, "is not a finite number"),
        ("1e999 m", LENGTH, "'1e999 m' is not a finite number"),
        ("٣ m", LENGTH, "is not a length"),
    ],
)
def test_what_is_wrong_and_what_would_be_right(value: object, quantity: Quantity, message: str) -> None:
    with pytest.raises(ValueError, match=re.escape(message)):
        read_quantity(value, quantity)


@given(FINITE, st.sampled_from([(quantity, unit) for quantity in QUANTITIES for unit in quantity.units]))
def test_a_value_survives_being_written_in_any_unit(value: float, kind: tuple[Quantity, str]) -> None:
    quantity, unit = kind
    written = f"{value / quantity.units[unit]!r} {unit}"
    assert read_quantity(written, quantity) == pytest.approx(value, rel=1e-14, abs=1e-300)


@given(FINITE, st.sampled_from(QUANTITIES))
def test_a_plain_number_is_in_the_quantitys_own_unit(value: float, quantity: Quantity) -> None:
    assert read_quantity(value, quantity) == read_quantity(f"{value!r} {quantity.unit}", quantity) == value
