"""The options of `gcs-windplan wind`: places, heights, levels, members, as people write them."""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import dataclass
from typing import NamedTuple, TypeVar

from gcs_windplan.errors import InputError, Problem
from gcs_windplan.geo.frame import GeoPoint
from gcs_windplan.jobs.missionfile.values import CLEARANCE, LATITUDE, LONGITUDE, SIGNED_LENGTH, Measure, Moment
from gcs_windplan.units import LENGTH
from gcs_windplan.wind.report.excerpt import Choice
from gcs_windplan.wind.report.sounding import Altitude
from gcs_windplan.wind.sheets import Level

T = TypeVar("T")

_PLACE = "write LAT,LON or LAT,LON,ALT, for example 46.81,9.84 or 46.81,9.84,2100 or 46.81,9.84,'80 m agl'"
_LEVEL = "write for example '100 m', '850 hPa', '2000 m amsl' or 'model level 60'"
_OVER = {"agl": True, "amsl": False, "asl": False, "msl": False}
_PASCALS = {"hpa": 100.0, "mb": 100.0, "mbar": 100.0, "pa": 1.0}
_WITH_BASE = re.compile(r"(.*?)\s*\b(agl|amsl|asl|msl)\s*", re.IGNORECASE | re.DOTALL)
_PRESSURE = re.compile(r"\s*([0-9]+(?:\.[0-9]*)?)\s*(hpa|mbar|mb|pa)\s*", re.IGNORECASE)
_MODEL = re.compile(r"\s*(?:model\s*level|model|level)\s*([0-9]+)\s*", re.IGNORECASE)
_HEIGHT = Measure(LENGTH, at_least=0, at_most=100_000.0)


class Asked(NamedTuple):
    """The moment [s since 1970] and the members asked for."""

    moment: float | None = None
    choice: Choice = None


@dataclass(frozen=True, slots=True)
class View:
    """What a picture is to show: a level, and how far around a place [m]."""

    level: Level | None = None
    place: GeoPoint | None = None
    radius: float | None = None


def read_view(level: str | None, around: str | None, place: GeoPoint | None) -> View:
    """What the picture is to show. Raises `InputError`."""
    if around is not None and place is None:
        raise InputError(Problem("needs --at, the place to look around", "--around"))
    return View(read_level(level), place, None if around is None else read_radius(around))


def read_place(text: str) -> tuple[GeoPoint, Altitude | None]:
    """Latitude, longitude and perhaps a height. Raises `InputError`."""
    parts = text.split(",")
    if len(parts) not in (2, 3):
        raise InputError(Problem(f"{text!r} is no place; {_PLACE}", "--at"))
    latitude = _told("--at", lambda: LATITUDE.read(parts[0]), "latitude")
    longitude = _told("--at", lambda: LONGITUDE.read(parts[1]), "longitude")
    return GeoPoint(latitude, longitude), read_altitude(parts[2]) if len(parts) == 3 else None


def read_altitude(text: str) -> Altitude:
    """A height above mean sea level, or with `agl` above the ground. Raises `InputError`."""
    number, above_ground = _based(text)
    measure = _HEIGHT if above_ground else SIGNED_LENGTH
    return Altitude(_told("--at", lambda: measure.read(number), "altitude"), bool(above_ground))


def read_level(text: str | None) -> Level | None:
    """A level. Raises `InputError`."""
    if text is None:
        return None
    if pressure := _PRESSURE.fullmatch(text):
        return Level("pressure", float(pressure[1]) * _PASCALS[pressure[2].lower()])
    if model := _MODEL.fullmatch(text):
        return Level("model", float(model[1]))
    number, above_ground = _based(text)
    try:
        return Level("altitude" if above_ground is False else "height", _HEIGHT.read(number))
    except ValueError as error:
        raise InputError(Problem(f"{error}; {_LEVEL}", "--level")) from None


def read_time(text: str | None) -> float | None:
    """A moment [s since 1970]. Raises `InputError`."""
    return None if text is None else _told("--time", lambda: Moment().read(text)).timestamp()


def read_radius(text: str) -> float:
    """A distance [m]. Raises `InputError`."""
    return _told("--around", lambda: CLEARANCE.read(text))


def read_member(text: str | None) -> Choice:
    """A member's number, or all of them. Raises `InputError`."""
    if text is None or text.strip().lower() == "all":
        return None if text is None else "all"
    if not re.fullmatch(r"\s*[0-9]{1,9}\s*", text):
        raise InputError(Problem(f"{text!r} is no member: write its number, or all", "--member"))
    return int(text)


def _based(text: str) -> tuple[str, bool | None]:
    """A number with its unit, and whether it counts from the ground, None where that is not said."""
    found = _WITH_BASE.fullmatch(text)
    return (found[1], _OVER[found[2].lower()]) if found else (text, None)


def _told(option: str, read: Callable[[], T], what: str = "") -> T:
    """What is read, with the option's name in front of errors."""
    try:
        return read()
    except ValueError as error:
        raise InputError(Problem(f"{what}: {error}" if what else str(error), option)) from None
