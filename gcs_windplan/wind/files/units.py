"""Units that wind files are written in, turned into those of `field_index.Quantity`.

Source: UDUNITS-2, as CF 1.11 section 3.1 asks for, and the spellings that weather services use besides.
"""

from __future__ import annotations

import math
import re
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from gcs_windplan.arrays import FloatArray
from gcs_windplan.constants import STANDARD_GRAVITY
from gcs_windplan.errors import WindError
from gcs_windplan.units import INTERNATIONAL_FOOT, KNOT, STATUTE_MILE
from gcs_windplan.wind.field_index import Quantity


@dataclass(frozen=True, slots=True)
class UnitTable:
    """What can be measured: its units, in lower case without blanks, in SI units, and what a file may say, for people.

    `zero` [SI units] of those units whose 0 is elsewhere.
    """

    expected: str
    factors: Mapping[str, float]
    offsets: Mapping[str, float]


SPEED = UnitTable(
    "a speed: m/s, knots, km/h or mph",
    {
        "m/s": 1.0, "ms-1": 1.0, "m/sec": 1.0, "meter/second": 1.0, "metre/second": 1.0, "meters/second": 1.0,
        "metres/second": 1.0, "meterspersecond": 1.0, "metrespersecond": 1.0, "meterpersecond": 1.0,
        "metersecond-1": 1.0, "metresecond-1": 1.0, "ms^-1": 1.0, "mps": 1.0,
        "kt": KNOT, "kts": KNOT, "kn": KNOT, "knot": KNOT, "knots": KNOT,
        "km/h": 1 / 3.6, "kmh-1": 1 / 3.6, "kph": 1 / 3.6, "kmph": 1 / 3.6, "km/hr": 1 / 3.6, "kmhr-1": 1 / 3.6,
        "mph": STATUTE_MILE / 3600, "mp/h": STATUTE_MILE / 3600, "mi/h": STATUTE_MILE / 3600,
        "mih-1": STATUTE_MILE / 3600, "miles/hour": STATUTE_MILE / 3600, "mile/hour": STATUTE_MILE / 3600,
    },
    {},
)  # fmt: skip
LENGTH = UnitTable(
    "a height: m, km or ft",
    {
        "m": 1.0, "meter": 1.0, "meters": 1.0, "metre": 1.0, "metres": 1.0, "gpm": 1.0, "km": 1000.0, "cm": 0.01,
        "ft": INTERNATIONAL_FOOT, "foot": INTERNATIONAL_FOOT, "feet": INTERNATIONAL_FOOT,
    },
    {},
)  # fmt: skip
PRESSURE = UnitTable(
    "a pressure: Pa, hPa or millibars",
    {
        "pa": 1.0, "pascal": 1.0, "pascals": 1.0, "hpa": 100.0, "hectopascal": 100.0, "hectopascals": 100.0,
        "mb": 100.0, "mbar": 100.0, "millibar": 100.0, "millibars": 100.0, "kpa": 1000.0, "bar": 1e5,
    },
    {},
)  # fmt: skip
GEOPOTENTIAL = UnitTable(
    "a geopotential, m2 s-2, or a height: m, km or ft",
    dict.fromkeys(("m2s-2", "m2/s2", "j/kg", "jkg-1"), 1 / STANDARD_GRAVITY) | dict(LENGTH.factors),
    {},
)
ANGLE = UnitTable(
    "an angle: degrees or radians",
    dict.fromkeys(("degree", "degrees", "deg", "°", "degt", "degreetrue", "degreestrue", "truedegrees"), 1.0)
    | {unit: math.degrees(1.0) for unit in ("radian", "radians", "rad")},
    {},
)  # [degrees], the SI of fields
TEMPERATURE = UnitTable(
    "a temperature: K or degC",
    {"k": 1.0, "kelvin": 1.0, "degk": 1.0, "c": 1.0, "degc": 1.0, "°c": 1.0, "celsius": 1.0, "degreescelsius": 1.0},
    dict.fromkeys(("c", "degc", "°c", "celsius", "degreescelsius"), 273.15),
)
HUMIDITY = UnitTable(
    "a mass mixing ratio: kg/kg or g/kg",
    {"1": 1.0, "kg/kg": 1.0, "kgkg-1": 1.0, "g/kg": 1e-3, "gkg-1": 1e-3},
    {},
)
PERIOD = UnitTable(
    "a span of time: hours, minutes, seconds or days",
    dict.fromkeys(("s", "sec", "second", "seconds"), 1.0)
    | {"nanoseconds": 1e-9, "microseconds": 1e-6, "milliseconds": 1e-3}
    | dict.fromkeys(("min", "minute", "minutes"), 60.0)
    | dict.fromkeys(("h", "hr", "hrs", "hour", "hours"), 3600.0)
    | dict.fromkeys(("d", "day", "days"), 86400.0),
    {},
)

BY_QUANTITY: Mapping[Quantity, UnitTable] = {
    "u": SPEED, "v": SPEED, "speed": SPEED, "gust": SPEED, "direction": ANGLE, "height": GEOPOTENTIAL,
    "terrain": GEOPOTENTIAL, "roughness": LENGTH, "temperature": TEMPERATURE, "humidity": HUMIDITY,
    "pressure": PRESSURE,
}  # fmt: skip
_LOG_OF_ANY_PRESSURE = 12.0  # 1628 hPa
_SHARES = ("%", "percent", "1", "-", "dimensionless", "probability", "count")
_TABLES = (SPEED, LENGTH, PRESSURE, GEOPOTENTIAL, ANGLE, TEMPERATURE, HUMIDITY)
_SUPERSCRIPTS = str.maketrans("²³⁻¹", "23-1")


def unit_factor(name: str, units: str, table: UnitTable) -> float:
    """How many SI units a unit holds. Raises `WindError` that names the variable if it is missing or unknown."""
    if not units.strip():
        raise WindError(f"{name} has no units; set its attribute `units` to {table.expected}")
    factor = table.factors.get(units.strip().lower(), table.factors.get(compact(units)))
    if factor is None:
        raise WindError(f"{name} is in {units!r}, which is not {table.expected}; correct its attribute `units`")
    return factor


def converted(values: FloatArray, quantity: Quantity, name: str, units: str) -> FloatArray:
    """Values in the unit that `field_index.Quantity` promises. Raises `WindError` if theirs is missing or unknown."""
    table = BY_QUANTITY[quantity]
    scaled: FloatArray = values * unit_factor(name, units, table)
    return scaled + table.offsets.get(compact(units), 0.0)


def is_something_else(units: str, quantity: Quantity) -> bool:
    """Whether a unit is well known and yet none of the quantity's: a wind in % or K is none."""
    unit = compact(units)
    if not unit or unit in BY_QUANTITY[quantity].factors:
        return False
    return unit in _SHARES or any(unit in table.factors for table in _TABLES)


def compact(units: str) -> str:
    """`m s**-1`, `m s^-1`, `m.s-1`, `m s⁻¹` and `m s-1` written in one way, in lower case."""
    return re.sub(r"[\s*^._{}()]", "", units.lower().translate(_SUPERSCRIPTS))


def check_units(name: str, units: str, quantity: Quantity, logarithm: bool = False) -> None:
    """Raise `WindError` if values in such units cannot be turned into those of a quantity."""
    if not logarithm:
        unit_factor(name, units, BY_QUANTITY[quantity])
    elif compact(units) not in {"", "~", "1", "-", "numeric", "dimensionless", "none", "lnpa", "logpa"}:
        raise WindError(f"{name} is in {units!r}, but the logarithm of a pressure has no unit: set `units` to 1")


def unlogged(values: FloatArray, name: str) -> FloatArray:
    """Pressures [Pa] of their natural logarithms. Raises `WindError` if they cannot be those."""
    if (values > _LOG_OF_ANY_PRESSURE).any():
        raise WindError(f"{name} goes up to {np.nanmax(values):g}, which is the logarithm of no pressure")
    pressures: FloatArray = np.exp(values)
    return pressures
