"""Places as people write them: `46.81,9.84`, `46.81,9.84,2100`, `46.81,9.84,80 m agl`."""

from __future__ import annotations

import re
from dataclasses import dataclass
from typing import Final, NamedTuple, TypeAlias

from gcs_windplan.errors import InputError, Problem
from gcs_windplan.geo.frame import GeoPoint, LocalFrame
from gcs_windplan.jobs.missionfile.values import HEIGHT, LATITUDE, LONGITUDE, SIGNED_LENGTH, Measure

_ADVICE: Final = "write LAT,LON or LAT,LON,ALT, for example 46.81,9.84 or 46.81,9.84,2100 or 46.81,9.84,'80 m agl'"
_DATUMS: Final = {"agl": True, "amsl": False, "asl": False, "msl": False}
_WITH_DATUM: Final = re.compile(r"(.*?)\s*\b(agl|amsl|asl|msl)\s*", re.IGNORECASE | re.DOTALL)


class LocalPoint(NamedTuple):
    """A place in the local frame: `east` and `north` of its origin [m].

    >>> import gcs_windplan as gw
    >>> gw.LocalPoint(100.0, 250.0).north
    250.0
    """

    east: float
    north: float


@dataclass(frozen=True, slots=True)
class Place:
    """A place of a mission: where it is, and its `height` above ground or its `altitude` above mean sea level [m].

    With neither, the planner takes the lowest layer of its graph. A `LocalPoint` counts from the mission's `origin`.
    Raises `InputError` for both a height and an altitude.

    >>> import gcs_windplan as gw
    >>> gw.Place(gw.GeoPoint(46.81, 9.84), altitude=2100.0)
    Place(point=GeoPoint(latitude_deg=46.81, longitude_deg=9.84), height=None, altitude=2100.0)
    """

    point: GeoPoint | LocalPoint
    height: float | None = None
    altitude: float | None = None

    def __post_init__(self) -> None:
        if self.height is not None and self.altitude is not None:
            raise InputError(Problem("has a height above ground and an altitude; keep one of the two"))

    def east_north(self, frame: LocalFrame) -> tuple[float, float]:
        """Where it is in a local frame [m]."""
        if isinstance(self.point, LocalPoint):
            return self.point.east, self.point.north
        east, north = frame.to_local(self.point.latitude_deg, self.point.longitude_deg)[0]
        return float(east), float(north)


#: A place, or what says one: text, a point, (latitude, longitude) or (latitude, longitude, altitude) [deg, m AMSL].
PlaceWords: TypeAlias = Place | GeoPoint | LocalPoint | tuple[float, float] | tuple[float, float, float] | str


def as_place(words: PlaceWords) -> Place:
    """The place that words or a value say. Raises `ValueError`, or `InputError` for a latitude beyond the poles."""
    match words:
        case Place():
            return words
        case GeoPoint() | LocalPoint():
            return Place(words)
        case str():
            return read_place(words)
        case (latitude, longitude):
            return Place(GeoPoint(float(latitude), float(longitude)))
        case (latitude, longitude, altitude):
            return Place(GeoPoint(float(latitude), float(longitude)), altitude=float(altitude))
    raise ValueError(f"{words!r} is no place: give (latitude, longitude), a GeoPoint or a Place")


def read_place(text: str) -> Place:
    """The place in a text; a third number is an altitude, with `agl` a height above ground. Raises `ValueError`."""
    parts = text.split(",")
    if len(parts) not in (2, 3):
        raise ValueError(f"{text!r} is no place; {_ADVICE}")
    point = GeoPoint(_coordinate("latitude", LATITUDE, parts[0]), _coordinate("longitude", LONGITUDE, parts[1]))
    if len(parts) == 2:
        return Place(point)
    metres, above_ground = read_altitude(parts[2])
    return Place(point, height=metres) if above_ground else Place(point, altitude=metres)


def read_altitude(text: str) -> tuple[float, bool]:
    """A height [m], and whether it counts from the ground and not from mean sea level. Raises `ValueError`."""
    number, above_ground = split_datum(text)
    try:
        return (HEIGHT if above_ground else SIGNED_LENGTH).read(number), bool(above_ground)
    except ValueError as error:
        raise ValueError(f"altitude: {error}") from None


def split_datum(text: str) -> tuple[str, bool | None]:
    """A number with its unit, and whether it counts from the ground, None where that is not said."""
    found = _WITH_DATUM.fullmatch(text)
    return (found[1], _DATUMS[found[2].lower()]) if found else (text, None)


def _coordinate(name: str, measure: Measure, text: str) -> float:
    try:
        return measure.read(text)
    except ValueError as error:
        raise ValueError(f"{name}: {error}") from None
