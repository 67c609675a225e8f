"""Numbers as they stand in mission files."""

from __future__ import annotations

import math
from decimal import Decimal

from gcs_windplan.mission import degrees_e7


def degrees_text(degrees: float) -> str:
    """Degrees with 8 decimals, from which every reader gets the same integer of 1e-7 degrees.

    Some readers round `degrees * 1e7` and some truncate it. Of coordinates with exactly 7 decimals, 6 % come
    out one unit short when truncated, for want of a binary fraction that reaches the decimal one; those get a
    1 as their eighth decimal (1 mm on the ground), which neither way of reading mistakes.
    """
    units = degrees_e7(degrees)
    sign, size = ("-" if units < 0 else ""), abs(units)
    text = f"{sign}{size // 10**7}.{size % 10**7:07d}"
    return f"{text}0" if int(float(text) * 1e7) == units else f"{text}1"


def number_text(value: float) -> str:
    """The shortest digits that give the number back, without an exponent; `nan` for NaN."""
    if math.isnan(value):
        return "nan"
    return str(int(value)) if value == int(value) else format(Decimal(repr(value)), "f")


def json_number(number: float) -> float:
    """The number as JSON shows it best: whole ones without a point."""
    return int(number) if number == int(number) else number


def json_degrees(latitude_deg: float, longitude_deg: float) -> list[float]:
    """A place with the digits of `degrees_text`."""
    return [json_number(float(degrees_text(degrees))) for degrees in (latitude_deg, longitude_deg)]


def json_place(latitude_deg: float, longitude_deg: float, altitude: float) -> list[float]:
    """A place with the digits of `degrees_text`, and its altitude [m] to the millimetre."""
    return [*json_degrees(latitude_deg, longitude_deg), json_number(round(altitude, 3))]


def metres_text(metres: float) -> str:
    """Metres with 3 decimals, never `-0.000`."""
    return f"{round(metres, 3) + 0.0:.3f}"
