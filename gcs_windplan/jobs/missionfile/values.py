"""The kinds of single values of a mission file: measures, whole numbers, texts, a moment.

Each checks what stands in the file, says what would be right, and describes itself for the reference and for
editors.
"""

from __future__ import annotations

import math
import re
from dataclasses import dataclass
from datetime import UTC, datetime
from typing import Annotated, Any, Final

from pydantic import BeforeValidator, Field, GetCoreSchemaHandler, GetJsonSchemaHandler, StrictBool, WithJsonSchema
from pydantic_core import CoreSchema, PydanticCustomError, core_schema

from gcs_windplan.units import (
    ACCELERATION,
    ANGLE,
    AREA,
    DENSITY,
    ENERGY,
    LENGTH,
    MASS,
    NUMBER,
    POWER,
    SHARE,
    SPEED,
    TIME,
    Quantity,
    read_quantity,
    shown,
)

_NUMBER_TEXT: Final = r"[-+]?([0-9]+(\.[0-9]*)?|\.[0-9]+)([eE][-+]?[0-9]+)?"


class Checked:
    """A kind of value with its own check: `read` returns the value or raises a `ValueError`."""

    __slots__ = ()

    def read(self, value: object) -> object:
        """The value of what stands in the file."""
        raise NotImplementedError

    def describe(self) -> str:
        """What may be written, for people."""
        raise NotImplementedError

    def json_schema(self) -> dict[str, Any]:
        """What may be written, as a JSON schema."""
        raise NotImplementedError

    def __get_pydantic_core_schema__(self, source: object, handler: GetCoreSchemaHandler) -> CoreSchema:
        return core_schema.no_info_plain_validator_function(self._check)

    def __get_pydantic_json_schema__(self, schema: CoreSchema, handler: GetJsonSchemaHandler) -> dict[str, Any]:
        return self.json_schema()

    def _check(self, value: object) -> object:
        try:
            return self.read(value)
        except ValueError as error:
            raise PydanticCustomError("plain", "{message}", {"message": str(error)}) from None


@dataclass(frozen=True, slots=True)
class Measure(Checked):
    """A number of a quantity, with or without its unit, within bounds in the quantity's own unit."""

    quantity: Quantity
    above: float | None = None
    at_least: float | None = None
    at_most: float | None = None

    def read(self, value: object) -> float:
        """The value in the quantity's own unit."""
        number = read_quantity(value, self.quantity)
        if (
            (self.above is not None and number <= self.above)
            or (self.at_least is not None and number < self.at_least)
            or (self.at_most is not None and number > self.at_most)
        ):
            raise ValueError(f"must be {self._bounds()}, not {shown(value)}{self._converted(value, number)}")
        return number

    def read_or_none(self, value: object) -> float | None:
        """The value, or None where it is not right."""
        try:
            return self.read(value)
        except ValueError:
            return None

    def describe(self) -> str:
        """The quantity, its unit and its bounds: `speed [m/s], above 0`."""
        name = self.quantity.name.split(" ", 1)[1]
        unit = f" [{self.quantity.unit}]" if self.quantity.unit else ""
        return ", ".join(part for part in (name + unit, self._bounds(unit=False)) if part)

    def json_schema(self) -> dict[str, Any]:
        """A number within the bounds, or a text with one of the units."""
        bounds = {"exclusiveMinimum": self.above, "minimum": self.at_least, "maximum": self.at_most}
        number = {"type": "number", **{key: bound for key, bound in bounds.items() if bound is not None}}
        if not self.quantity.units:
            return number
        units = "|".join(re.escape(unit) for unit in self.quantity.units)
        return {"anyOf": [number, {"type": "string", "pattern": rf"^\s*{_NUMBER_TEXT}\s*({units})?\s*$"}]}

    def _bounds(self, unit: bool = True) -> str:
        mark = f" {self.quantity.unit}" if unit and self.quantity.unit else ""
        if self.at_least is not None and self.at_most is not None:
            return f"between {self.at_least:g} and {self.at_most:g}{mark}"
        words = {"above": self.above, "at least": self.at_least, "at most": self.at_most}
        return " and ".join(f"{word} {bound:g}{mark}" for word, bound in words.items() if bound is not None)

    def _converted(self, value: object, number: float) -> str:
        if self.quantity is SHARE and isinstance(value, int | float) and 1 < value <= 100:
            return f"; a percentage is written {value:g} %"
        foreign = isinstance(value, str) and not value.strip().endswith(f" {self.quantity.unit}")
        return f" ({number:.6g} {self.quantity.unit})" if foreign and self.quantity.unit else ""


@dataclass(frozen=True, slots=True)
class MeasureOr(Checked):
    """A measure, or a word in its place."""

    measure: Measure
    word: str

    def read(self, value: object) -> float | str:
        """The measure's value, or the word."""
        return self.word if value == self.word else self.measure.read(value)

    def describe(self) -> str:
        """Both."""
        return f"{self.measure.describe()}; or `{self.word}`"

    def json_schema(self) -> dict[str, Any]:
        """Both."""
        return {"anyOf": [{"const": self.word}, *self.measure.json_schema()["anyOf"]]}


@dataclass(frozen=True, slots=True)
class Whole(Checked):
    """A whole number within bounds."""

    at_least: int
    at_most: int

    def read(self, value: object) -> int:
        """The number."""
        if isinstance(value, float) and math.isfinite(value) and value == int(value):
            value = int(value)
        if isinstance(value, bool) or not isinstance(value, int):
            raise ValueError(f"{shown(value)} is not a whole number; write for example {self.at_least}")
        if not self.at_least <= value <= self.at_most:
            raise ValueError(f"must be between {self.at_least} and {self.at_most}, not {shown(value)}")
        return value

    def describe(self) -> str:
        """The bounds."""
        return f"whole number, between {self.at_least} and {self.at_most}"

    def json_schema(self) -> dict[str, Any]:
        """A bounded integer."""
        return {"type": "integer", "minimum": self.at_least, "maximum": self.at_most}


@dataclass(frozen=True, slots=True)
class Text(Checked):
    """A text of at most `longest` characters that fits a pattern, which `rule` puts into words."""

    longest: int
    pattern: str
    rule: str

    def read(self, value: object) -> str:
        """The text."""
        if isinstance(value, int | float):
            written = shown(value)
            raise ValueError(f"text is expected, not {written}; put it in quotes: {written!r}")
        if not isinstance(value, str):
            raise ValueError(f"text is expected, not {shown(value)}")
        if not 1 <= len(value) <= self.longest:
            raise ValueError(f"must have 1 to {self.longest} characters, not {len(value)}")
        if re.fullmatch(self.pattern, value) is None:
            raise ValueError(f"must be {self.rule}, not {shown(value)}")
        return value

    def describe(self) -> str:
        """The rule."""
        return self.rule

    def json_schema(self) -> dict[str, Any]:
        """A bounded string."""
        return {"type": "string", "minLength": 1, "maxLength": self.longest}


@dataclass(frozen=True, slots=True)
class Moment(Checked):
    """A date and time with its offset from UTC."""

    def read(self, value: object) -> datetime:
        """The moment in UTC."""
        advice = "write for example 2026-05-01T08:00Z"
        if isinstance(value, str):
            try:  # YAML allows spaces before the offset, ISO 8601 does not
                value = datetime.fromisoformat(re.sub(r"\s+(?=[-+][0-9:]+$|Z$)", "", value.strip()))
            except ValueError:
                raise ValueError(f"{shown(value)} is not a date and time; {advice}") from None
        if not isinstance(value, datetime):
            raise ValueError(f"{shown(value)} is not a date and time; {advice}")
        if value.tzinfo is None:
            raise ValueError(
                f"the offset from UTC is missing; write for example {value:%Y-%m-%dT%H:%M}Z, "
                f"or {value:%Y-%m-%dT%H:%M}+02:00 for local time"
            )
        try:
            return value.astimezone(UTC)
        except OverflowError:
            raise ValueError(f"{value.isoformat()} lies outside of the years 1 to 9999") from None

    def describe(self) -> str:
        """The format."""
        return "date and time with `Z` or an offset such as `+02:00`"

    def json_schema(self) -> dict[str, Any]:
        """A date and time."""
        return {"type": "string", "format": "date-time"}


@dataclass(frozen=True, slots=True)
class OnlyTrue(Checked):
    """A switch that is on where it is written at all."""

    def read(self, value: object) -> bool:
        """True."""
        if value is not True:
            raise ValueError(f"write true or leave the field out, not {shown(value)}")
        return True

    def describe(self) -> str:
        """The one value."""
        return "`true`"

    def json_schema(self) -> dict[str, Any]:
        """The one value."""
        return {"const": True}


_FARTHEST: Final = 300_000.0  # [m] no length of a mission is longer, no mission spans more
CLEARANCE: Final = Measure(LENGTH, above=0, at_most=_FARTHEST)
HEIGHT: Final = Measure(LENGTH, at_least=0, at_most=_FARTHEST)
SIGNED_LENGTH: Final = Measure(LENGTH, at_least=-_FARTHEST, at_most=_FARTHEST)
AIRSPEED: Final = Measure(SPEED, at_least=0.1, at_most=150)
FREE: Final = "free"
AIRSPEED_OR_FREE: Final = MeasureOr(AIRSPEED, FREE)
LATITUDE: Final = Measure(ANGLE, at_least=-90, at_most=90)
LONGITUDE: Final = Measure(ANGLE, at_least=-180, at_most=180)
WEIGHT: Final = Measure(NUMBER, at_least=0)
_PRINTABLE: Final = r"[^\x00-\x1f\x7f]*[^\x00-\x20\x7f][^\x00-\x1f\x7f]*"
_MESH: Final = r"(?i)[^\x00]+\.(stl|obj|ply|glb)"

Flag = StrictBool
Calm = Annotated[bool, OnlyTrue()]
Length = Annotated[float, SIGNED_LENGTH]
Height = Annotated[float, HEIGHT]
PositiveLength = Annotated[float, CLEARANCE]
Speed = Annotated[float, Measure(SPEED, at_least=0)]
PositiveSpeed = Annotated[float, Measure(SPEED, above=0)]
Airspeed = Annotated[float, AIRSPEED]
AirspeedOrFree = Annotated[float | str, AIRSPEED_OR_FREE]
Latitude = Annotated[float, LATITUDE]
Longitude = Annotated[float, LONGITUDE]
LongTime = Annotated[float, Measure(TIME, at_least=60, at_most=86_400)]  # a plain 5 was meant in minutes
Direction = Annotated[float, Measure(ANGLE, at_least=0, at_most=360)]
Number = Annotated[float, Measure(NUMBER)]
Weight = Annotated[float, WEIGHT]
Exponent = Annotated[float, Measure(NUMBER, at_least=0, at_most=1)]
Share = Annotated[float, Measure(SHARE, above=0, at_most=1)]
Reserve = Annotated[float, Measure(SHARE, at_least=0, at_most=0.9)]
Coefficient = Annotated[float, Measure(NUMBER, at_least=0)]
PositiveNumber = Annotated[float, Measure(NUMBER, above=0)]
PositiveArea = Annotated[float, Measure(AREA, above=0)]
Mass = Annotated[float, Measure(MASS, above=0, at_most=1000)]
Capacity = Annotated[float, Measure(ENERGY, at_least=3600)]  # a plain number below 1 Wh was meant as Wh
PositivePower = Annotated[float, Measure(POWER, above=0)]
AirDensity = Annotated[float, Measure(DENSITY, at_least=0.1, at_most=2)]
Acceleration = Annotated[float, Measure(ACCELERATION, above=0)]
Quantile = Annotated[float, Measure(NUMBER, at_least=0.5, at_most=0.99)]
Member = Annotated[int, Whole(0, 100_000)]
NodeCount = Annotated[int, Whole(2, 10_000_000)]
Seed = Annotated[int, Whole(0, 2**32 - 1)]
FileStem = Annotated[
    str, Text(60, r"[\w-]([\w -]*[\w-])?", "letters, digits, spaces, - and _, with no space at the ends")
]
Label = Annotated[str, Text(60, _PRINTABLE, "text on one line")]
_FILE: Final = Text(1000, _PRINTABLE, "the name of a file")
FileName = Annotated[str, _FILE]
_FILES: Final = {"type": "array", "items": _FILE.json_schema(), "minItems": 1}
FileNames = Annotated[
    tuple[FileName, ...],
    Field(min_length=1),
    BeforeValidator(lambda value: value if isinstance(value, list | tuple) else [value]),  # a single one
    WithJsonSchema({"anyOf": [_FILE.json_schema(), _FILES]}),
]
MeshName = Annotated[str, Text(1000, _MESH, "the name of a .stl, .obj, .ply or .glb file")]
UtcTime = Annotated[datetime, Moment()]
