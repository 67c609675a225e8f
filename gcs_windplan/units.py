"""Quantities as people write them: `12 m/s`, `400 ft`, `90°`. A plain number is SI, or degrees."""

from __future__ import annotations

import math
import re
from dataclasses import dataclass
from types import MappingProxyType
from typing import Final

NAUTICAL_MILE: Final = 1852.0  # [m] BIPM SI brochure, 8th edition, table 8
KNOT: Final = NAUTICAL_MILE / 3600  # [m/s] BIPM SI brochure, 8th edition, table 8
INTERNATIONAL_FOOT: Final = 0.3048  # [m] NIST SP 811, B.6
US_SURVEY_FOOT: Final = 1200 / 3937  # [m] NIST SP 811, B.6
STATUTE_MILE: Final = 1609.344  # [m] NIST SP 811, B.6


@dataclass(frozen=True, slots=True, eq=False)
class Quantity:
    """A kind of quantity: name with article, the unit kept inside, an example and what each unit is worth.

    A number or a share has no unit of its own (`unit` empty).
    """

    name: str
    unit: str
    example: str
    units: MappingProxyType[str, float]


_HOUR: Final = 3600.0
_MINUTE: Final = 60.0
_POUND: Final = 0.45359237  # [kg] NIST SP 811, B.6

NUMBER: Final = Quantity("a number", "", "0.5", MappingProxyType({}))
SHARE: Final = Quantity("a share", "", "0.3 or 30 %", MappingProxyType({"%": 0.01}))
SPEED: Final = Quantity(
    "a speed",
    "m/s",
    "12 m/s",
    MappingProxyType(
        {
            "m/s": 1.0,
            "km/h": 1000 / _HOUR,
            "kt": KNOT,
            "mph": STATUTE_MILE / _HOUR,
            "ft/s": INTERNATIONAL_FOOT,
            "ft/min": INTERNATIONAL_FOOT / _MINUTE,
        }
    ),
)
LENGTH: Final = Quantity(
    "a length",
    "m",
    "120 m",
    MappingProxyType(
        {
            "m": 1.0,
            "km": 1000.0,
            "ft": INTERNATIONAL_FOOT,
            "mi": STATUTE_MILE,
            "nmi": NAUTICAL_MILE,
        }
    ),
)
ANGLE: Final = Quantity(
    "an angle", "deg", "270 deg", MappingProxyType({"deg": 1.0, "°": 1.0, "rad": math.degrees(1.0)})
)
TIME: Final = Quantity("a time", "s", "15 min", MappingProxyType({"s": 1.0, "min": _MINUTE, "h": _HOUR}))
AREA: Final = Quantity("an area", "m2", "0.5 m2", MappingProxyType({"m2": 1.0, "m²": 1.0, "cm2": 1e-4, "cm²": 1e-4}))
MASS: Final = Quantity("a mass", "kg", "4.2 kg", MappingProxyType({"kg": 1.0, "g": 1e-3, "lb": _POUND}))
ENERGY: Final = Quantity(
    "an energy", "J", "130 Wh", MappingProxyType({"J": 1.0, "kJ": 1e3, "MJ": 1e6, "Wh": _HOUR, "kWh": 1e3 * _HOUR})
)
POWER: Final = Quantity("a power", "W", "450 W", MappingProxyType({"W": 1.0, "kW": 1e3}))
DENSITY: Final = Quantity("a density", "kg/m3", "1.225 kg/m3", MappingProxyType({"kg/m3": 1.0, "kg/m³": 1.0}))
ACCELERATION: Final = Quantity("an acceleration", "m/s2", "2.5 m/s2", MappingProxyType({"m/s2": 1.0, "m/s²": 1.0}))
QUANTITIES: Final = (SHARE, SPEED, LENGTH, ANGLE, TIME, AREA, MASS, ENERGY, POWER, DENSITY, ACCELERATION)

_WRITTEN: Final = re.compile(
    r"\s*([-+]?(?:[0-9]+(?:\.[0-9]*)?|\.[0-9]+)(?:[eE][-+]?[0-9]+)?)\s*(|[A-Za-z°%,].*?)\s*", re.DOTALL
)
_DECIMAL_COMMA: Final = re.compile(r"\s*[-+]?[0-9]+,[0-9]+(?![0-9,])")


def read_quantity(value: object, quantity: Quantity) -> float:
    """The value of a number or of a text with a unit, in the quantity's own unit.

    A `ValueError` says what would be right.
    """
    if isinstance(value, str):
        number = _read_text(value, quantity)
    elif isinstance(value, int | float) and not isinstance(value, bool):
        number = _as_float(value)
    else:
        raise ValueError(f"{shown(value)} is not {quantity.name}; {_advice(quantity)}")
    if not math.isfinite(number):
        raise ValueError(f"{shown(value)} is not a finite number; {_advice(quantity)}")
    return number


def shown(value: object) -> str:
    """A value as a message quotes it: short, and in the words of YAML."""
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, str):
        return repr(value if len(value) <= 40 else value[:37] + "...")
    if isinstance(value, int | float):
        return f"{value:g}" if isinstance(value, float) else str(value)
    if value is None:
        return "an empty value"
    return "a section" if isinstance(value, dict) else "a list"


def _read_text(text: str, quantity: Quantity) -> float:
    match = _WRITTEN.fullmatch(text)
    if match is None:
        raise ValueError(f"{shown(text)} is not {quantity.name}; {_advice(quantity)}")
    number, unit = float(match[1]), match[2]
    if not unit:
        return number
    if unit not in quantity.units:
        raise ValueError(_unit_problem(text, unit, quantity))
    return number * quantity.units[unit]


def _unit_problem(text: str, unit: str, wanted: Quantity) -> str:
    if _DECIMAL_COMMA.match(text):
        return f"{shown(text)} has a decimal comma; write a point, as in {text.strip().replace(',', '.', 1)!r}"
    other = next((kind for kind in QUANTITIES if unit in kind.units), None)
    if not wanted.units:
        return f"{shown(text)} has a unit, but a plain number belongs here; {_advice(wanted)}"
    if other is not None:
        return f"{shown(text)} is {other.name}, but {wanted.name} belongs here; {_advice(wanted)}"
    return f"unknown unit {shown(unit)} for {wanted.name}; known units: {', '.join(wanted.units)}"


def _advice(quantity: Quantity) -> str:
    if not quantity.unit:
        return f"write for example {quantity.example}"
    return f"write for example {quantity.example}, or a plain number in {quantity.unit}"


def _as_float(value: int | float) -> float:
    try:
        return float(value)
    except OverflowError:
        return math.inf
