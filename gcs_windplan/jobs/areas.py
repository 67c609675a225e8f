"""Areas of a mission in the local frame: what the planner keeps to, and what the autopilot's fence holds."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from gcs_windplan.arrays import FloatArray
from gcs_windplan.errors import InputError, Problem
from gcs_windplan.geo.frame import GeoPoint, LocalFrame
from gcs_windplan.jobs.places import LocalPoint, PlaceWords, as_place
from gcs_windplan.planning.request import FenceArea
from gcs_windplan.scene import Prism

_SAGITTA = 0.5  # [m] how far a circle's polygon strays from it, to the safe side
_FEWEST_SIDES, _MOST_SIDES = 16, 180
_STRAY = 0.1  # [m] how far a straight side in the local frame strays from one in latitude and longitude
#: How wrongly autopilots measure the distance to a circle's centre, as a share: ArduPilot with 111 318.8 m a degree
#: (LOCATION_SCALING_FACTOR), PX4 on a sphere of 6 371 000 m (CONSTANTS_RADIUS_OF_EARTH); worst on the equator.
_MEASURED_WRONG = 0.007


@dataclass(frozen=True, slots=True)
class Area:
    """An area that the route keeps out of, or in: a polygon of 3 `corners` or more, or a circle about one.

    The circle's `radius` [m]; `floor` and `ceiling` above mean sea level [m], None without; `margin` [m] is kept from
    its border in plan. `fence`: whether the autopilot's own fence holds it too, which has no heights.

    >>> import gcs_windplan as gw
    >>> gw.Area("school", [(46.81, 9.84)], radius=300.0).margin
    5.0
    """

    name: str
    corners: Sequence[PlaceWords]
    radius: float | None = None
    floor: float | None = None
    ceiling: float | None = None
    margin: float = 5.0
    fence: bool = False

    def __post_init__(self) -> None:
        corners = len(self.corners)
        if corners != 1 if self.radius is not None else corners < 3:
            raise InputError(Problem(f"area '{self.name}' has {corners} corners: 3 or more, or one and a radius"))
        if self.floor is not None and self.ceiling is not None and self.ceiling <= self.floor:
            text = f"area '{self.name}': {self.ceiling:g} m is not above the floor, {self.floor:g} m"
            raise InputError(Problem(text))


def prism_of(area: Area, frame: LocalFrame, keep_out: bool) -> Prism:
    """An area with its margin: a keep-out grows by it, a keep-in shrinks. Raises InputError for no simple polygon.

    The border of one that the fence holds is where the autopilot sees it, so that the route keeps to the fence too.
    """
    floor = -np.inf if area.floor is None else area.floor
    ceiling = np.inf if area.ceiling is None else area.ceiling
    corners = _corners(area, frame)
    if area.radius is not None:
        return Prism(area.name, _ring(area, corners[0], area.radius, keep_out), floor, ceiling)
    sides = _sides_as_flown(area.name, corners, frame) if area.fence else corners
    return Prism(area.name, sides, floor, ceiling).widened(area.margin if keep_out else -area.margin)


def fence_area_of(area: Area, frame: LocalFrame, keep_out: bool) -> FenceArea:
    """An area as the fence holds it: no margin, no heights."""
    heights_lost = area.floor is not None or area.ceiling is not None
    return FenceArea(area.name, _corners(area, frame), area.radius, not keep_out, heights_lost)


def _corners(area: Area, frame: LocalFrame) -> FloatArray:
    """A polygon's corners, or a circle's centre (n, 2) [m]."""
    points = [as_place(corner).point for corner in area.corners]
    corners = np.array([point if isinstance(point, LocalPoint) else (np.nan, np.nan) for point in points])
    places = np.array([(p.latitude_deg, p.longitude_deg) for p in points if isinstance(p, GeoPoint)]).reshape(-1, 2)
    corners[np.isnan(corners[:, 0])] = frame.to_local(places[:, 0], places[:, 1])
    return corners


def _ring(area: Area, centre: FloatArray, reach: float, keep_out: bool) -> FloatArray:
    """A circle with its margin as a regular polygon (n, 2): around it to keep out, inside of it to keep in."""
    margin = area.margin + (_MEASURED_WRONG * reach if area.fence else 0.0)
    radius = reach + (margin if keep_out else -margin)
    if radius <= 0:
        raise InputError(f"area '{area.name}' is too narrow for a margin of {area.margin:g} m: lower it")
    bend = math.acos(max(1 - _SAGITTA / radius, -1.0))
    sides = min(max(math.ceil(math.pi / bend), _FEWEST_SIDES), _MOST_SIDES)
    if keep_out:
        radius /= math.cos(math.pi / sides)
    angles = np.arange(sides) * (2 * math.pi / sides)
    return centre + radius * np.column_stack([np.cos(angles), np.sin(angles)])


def _sides_as_flown(name: str, corners: FloatArray, frame: LocalFrame) -> FloatArray:
    """Corners with more of them along the sides: the autopilots' sides are straight in latitude and longitude.

    In the local frame such a side is bent: at 50° latitude one of 10 km by 2.3 m, one of 50 km by 58 m.
    """
    latitudes, longitudes = frame.to_geographic(corners)
    if np.ptp(longitudes) > 180:
        raise InputError(f"area '{name}' lies across the date line, where no autopilot's fence works: no fence there")
    here = np.column_stack([latitudes, longitudes])
    there = np.roll(here, -1, axis=0)
    middle = (here + there) / 2
    bent = frame.to_local(middle[:, 0], middle[:, 1]) - (corners + np.roll(corners, -1, axis=0)) / 2
    parts = np.ceil(np.sqrt(np.hypot(bent[:, 0], bent[:, 1]) / _STRAY)).astype(int).clip(min=1)
    pieces = [a + np.arange(n)[:, None] / n * (b - a) for a, b, n in zip(here, there, parts, strict=True)]
    places = np.concatenate(pieces)
    return frame.to_local(places[:, 0], places[:, 1])
