"""The options of `gcs-windplan wind`: places, heights, levels, members, as people write them."""

from __future__ import annotations

import re
from dataclasses import dataclass

from gcs_windplan.errors import InputError, Problem
from gcs_windplan.geo.frame import GeoPoint
from gcs_windplan.jobs.missionfile.values import CLEARANCE, Measure, Moment
from gcs_windplan.jobs.places import read_place, split_datum
from gcs_windplan.jobs.words import read_as
from gcs_windplan.units import LENGTH
from gcs_windplan.wind.field_index import Level
from gcs_windplan.wind.inspect.sounding import HeightAsked
from gcs_windplan.wind.pairing import Members

_LEVEL = "write for example '100 m', '850 hPa', '2000 m amsl' or 'model level 60'"
_PASCALS = {"hpa": 100.0, "mb": 100.0, "mbar": 100.0, "pa": 1.0}
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
    place, height = (None, None) if at is None else _place_and_height(at)
    if around is not None and place is None:
        raise InputError(Problem("needs --at, the place to look around", "--around"))
    return WindOptions(
        place,
        height,
        None if time is None else read_as("--time", lambda: Moment().read(time)).timestamp(),
        None if member is None else _members(member),
        None if level is None else _level(level),
        None if around is None else read_as("--around", lambda: CLEARANCE.read(around)),
    )


def _place_and_height(text: str) -> tuple[GeoPoint, HeightAsked | None]:
    """Latitude, longitude and perhaps a height. Raises `InputError`."""
    place = read_as("--at", lambda: read_place(text))
    assert isinstance(place.point, GeoPoint)
    if place.height is not None:
        return place.point, HeightAsked(place.height, above_ground=True)
    return place.point, None if place.altitude is None else HeightAsked(place.altitude, above_ground=False)


def _level(text: str) -> Level:
    if pressure := _PRESSURE.fullmatch(text):
        return Level("pressure", float(pressure[1]) * _PASCALS[pressure[2].lower()])
    if model := _MODEL.fullmatch(text):
        return Level("model", float(model[1]))
    number, above_ground = split_datum(text)
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
