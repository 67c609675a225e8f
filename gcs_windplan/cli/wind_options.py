"""The options of `gcs-windplan wind`: places, heights, levels, members, as people write them."""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import dataclass
from typing import TypeVar

from gcs_windplan.errors import InputError, Problem
from gcs_windplan.geo.frame import GeoPoint
from gcs_windplan.jobs.missionfile.values import CLEARANCE, LATITUDE, LONGITUDE, SIGNED_LENGTH, Measure, Moment
from gcs_windplan.units import LENGTH
from gcs_windplan.wind.field_index import Level
from gcs_windplan.wind.inspect.sounding import HeightAsked
from gcs_windplan.wind.pairing import Members

T = TypeVar("T")

_PLACE = "write LAT,LON or LAT,LON,ALT, for example 46.81,9.84 or 46.81,9.84,2100 or 46.81,9.84,'80 m agl'"
_LEVEL = "write for example '100 m', '850 hPa', '2000 m amsl' or 'model level 60'"
_ABOVE_GROUND = {"agl": True, "amsl": False, "asl": False, "msl": False}
_PASCALS = {"hpa": 100.0, "mb": 100.0, "mbar": 100.0, "pa": 1.0}
_WITH_DATUM = re.compile(r"(.*?)\s*\b(agl|amsl|asl|msl)\s*", re.IGNORECASE | re.DOTALL)
_PRESSURE = re.compile(r"\s*([0-9]+(?:\.[0-9]*)?)\s*(hpa|mbar|mb|pa)\s*", re.IGNORECASE)
_MODEL = re.compile(r"\s*(?:model\s*level|model|level)\s*([0-9]+)\s*", re.IGNORECASE)
_HEIGHT = Measure(LENGTH, at_least=0, at_most=100_000.0)


@dataclass(frozen=True, slots=True)
class WindOptions:
    """A place and a height over it, a moment [s since 1970], members; the level and radius [m] of a picture."""

    place: GeoPoint | None = None
    height: HeightAsked | None = None
    moment: float | None = None
    members: Members = None
    level: Level | None = None
    radius: float | None = None


def read_options(
    at: str | None, time: str | None, level: str | None, around: str | None, member: str | None
) -> WindOptions:
    """The options as they were written. Raises `InputError`."""
    place, height = (None, None) if at is None else read_place(at)
    if around is not None and place is None:
        raise InputError(Problem("needs --at, the place to look around", "--around"))
    return WindOptions(
        place,
        height,
        None if time is None else _naming("--time", lambda: Moment().read(time)).timestamp(),
        None if member is None else _members(member),
        None if level is None else _level(level),
        None if around is None else _naming("--around", lambda: CLEARANCE.read(around)),
    )


def read_place(text: str) -> tuple[GeoPoint, HeightAsked | None]:
    """Latitude, longitude and perhaps a height. Raises `InputError`."""
    parts = text.split(",")
    if len(parts) not in (2, 3):
        raise InputError(Problem(f"{text!r} is no place; {_PLACE}", "--at"))
    latitude = _naming("--at", lambda: LATITUDE.read(parts[0]), "latitude: ")
    longitude = _naming("--at", lambda: LONGITUDE.read(parts[1]), "longitude: ")
    height = None
    if len(parts) == 3:
        number, above_ground = _with_datum(parts[2])
        measure = _HEIGHT if above_ground else SIGNED_LENGTH
        height = HeightAsked(_naming("--at", lambda: measure.read(number), "altitude: "), bool(above_ground))
    return GeoPoint(latitude, longitude), height


def _level(text: str) -> Level:
    if pressure := _PRESSURE.fullmatch(text):
        return Level("pressure", float(pressure[1]) * _PASCALS[pressure[2].lower()])
    if model := _MODEL.fullmatch(text):
        return Level("model", float(model[1]))
    number, above_ground = _with_datum(text)
    try:
        return Level("altitude" if above_ground is False else "height", _HEIGHT.read(number))
    except ValueError as error:
        raise InputError(Problem(f"{error}; {_LEVEL}", "--level")) from None


def _members(text: str) -> Members:
    """A member's number, or all of them."""
    if text.strip().lower() == "all":
        return "all"
    if not re.fullmatch(r"\s*[0-9]{1,9}\s*", text):
        raise InputError(Problem(f"{text!r} is no member: write its number, or all", "--member"))
    return (int(text),)


def _with_datum(text: str) -> tuple[str, bool | None]:
    """A number with its unit, and whether it counts from the ground, None where that is not said."""
    found = _WITH_DATUM.fullmatch(text)
    return (found[1], _ABOVE_GROUND[found[2].lower()]) if found else (text, None)


def _naming(option: str, read: Callable[[], T], what: str = "") -> T:
    """What is read, with the option's name in front of errors."""
    try:
        return read()
    except ValueError as error:
        raise InputError(Problem(f"{what}{error}", option)) from None
