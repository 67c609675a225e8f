"""What a mission must keep to or away from, in the local frame: areas, obstacles, and the mission's own fence."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Final

import numpy as np

from gcs_windplan.arrays import FloatArray
from gcs_windplan.assessment.assessment import Outline
from gcs_windplan.assessment.case import Case
from gcs_windplan.geo.frame import LocalFrame
from gcs_windplan.mission import FencePolygon
from gcs_windplan.scene import Prism
from gcs_windplan.terrain import Obstacle

_SIDES: Final = 180  # of a circle
_LONGEST: Final = 500.0  # [m] of a side that is as good as straight in latitude and longitude: bent by 6 mm at 50°


def outlines_of(case: Case) -> tuple[Outline, ...]:
    """All areas, for maps and for judging."""
    outlines = [outline_of(prism, "keep-out") for prism in case.scene.airspace.keep_out]
    outlines += [outline_of(prism, "keep-in") for prism in case.scene.airspace.keep_in]
    if case.scene.obstacles is not None:
        outlines += [outline for obstacle in case.scene.obstacles.items for outline in _of_obstacle(obstacle)]
    fence = case.mission.fence
    if fence is None:
        return tuple(outlines)
    for number, polygon in enumerate(fence.polygons, start=1):
        corners = _sides(polygon, case.scene.frame)
        outlines.append(Outline(f"fence polygon {number}", _kind(polygon.inclusion), corners))
    for number, circle in enumerate(fence.circles, start=1):
        centre = case.scene.frame.to_local(circle.centre.latitude_deg, circle.centre.longitude_deg)[0]
        corners = centre + _ring(circle.radius, outer=not circle.inclusion)
        outlines.append(Outline(f"fence circle {number}", _kind(circle.inclusion), corners))
    return tuple(outlines)


def _kind(inclusion: bool) -> str:
    return "fence-in" if inclusion else "fence-out"


def outline_of(prism: Prism, kind: str) -> Outline:
    """An area of the airspace, for maps and for judging."""
    floor = prism.floor if math.isfinite(prism.floor) else None
    ceiling = prism.ceiling if math.isfinite(prism.ceiling) else None
    return Outline(prism.name, kind, prism.corners, floor, ceiling)


def _of_obstacle(obstacle: Obstacle) -> Iterator[Outline]:
    """The hulls of an obstacle's bodies seen from above, from foot to top."""
    import trimesh  # here, since most missions have no obstacles
    from scipy.spatial import ConvexHull

    for body in trimesh.Trimesh(obstacle.vertices, obstacle.faces).split(only_watertight=False):
        places = np.asarray(body.vertices)
        hull = places[ConvexHull(places[:, :2]).vertices, :2]
        yield Outline(obstacle.name, "obstacle", hull, float(places[:, 2].min()), float(places[:, 2].max()))


def _ring(radius: float, outer: bool) -> FloatArray:
    """A circle as a polygon (n, 2) to its safe side, off by less than 0.2 thousandths of the radius."""
    angles = np.arange(_SIDES) * (2 * math.pi / _SIDES)
    size = radius / math.cos(math.pi / _SIDES) if outer else radius
    return size * np.column_stack([np.cos(angles), np.sin(angles)])


def _sides(polygon: FencePolygon, frame: LocalFrame) -> FloatArray:
    """A fence's polygon with corners along its sides, which are straight in latitude and longitude."""
    places = np.array([(corner.latitude_deg, corner.longitude_deg) for corner in polygon.corners])
    places[:, 1] = places[0, 1] + (places[:, 1] - places[0, 1] + 180.0) % 360.0 - 180.0
    there = np.roll(places, -1, axis=0)
    corners = frame.to_local(places[:, 0], places[:, 1])
    sizes = np.hypot(*(np.roll(corners, -1, axis=0) - corners).T)
    parts = np.ceil(sizes / _LONGEST).astype(int).clip(1, 400)
    pieces = [a + np.arange(n)[:, None] / n * (b - a) for a, b, n in zip(places, there, parts, strict=True)]
    fine = np.concatenate(pieces)
    return frame.to_local(fine[:, 0], fine[:, 1])
