"""Fences and rally points: what the autopilot keeps by itself, and where it may fly to in place of home.

A fence is areas in plan; MAVLink gives them no heights. The vehicle stays inside every inclusion area and outside
every exclusion area. ArduPilot can be told to be content with one inclusion area (FENCE_OPTIONS), and older PX4 was;
a vehicle inside all of them is inside for either.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass

from gcs_windplan.errors import InputError
from gcs_windplan.geo.frame import GeoPoint
from gcs_windplan.mission.commands import Command, Frame, command_name, frame_name, is_global, plain_frame
from gcs_windplan.mission.items import MissionItem, degrees_e7

_POLYGONS = {
    Command.NAV_FENCE_POLYGON_VERTEX_INCLUSION: True,
    Command.NAV_FENCE_POLYGON_VERTEX_EXCLUSION: False,
}
_CIRCLES = {Command.NAV_FENCE_CIRCLE_INCLUSION: True, Command.NAV_FENCE_CIRCLE_EXCLUSION: False}
_HALF_TURN = 1_800_000_000  # [1e-7 deg]


@dataclass(frozen=True, slots=True)
class FencePolygon:
    """An area with straight sides, straight in latitude and longitude: so ArduPilot and PX4 test it.

    Raises InputError for fewer than three corners and for a border that crosses or touches itself, of which the
    autopilots think differently.
    """

    corners: tuple[GeoPoint, ...]
    inclusion: bool = True

    def __post_init__(self) -> None:
        if len(self.corners) < 3:
            raise InputError(f"a fence polygon needs at least 3 corners, not {len(self.corners)}")
        _refuse_crossing(self.corners)


@dataclass(frozen=True, slots=True)
class FenceCircle:
    """A round area; `radius` [m]."""

    centre: GeoPoint
    radius: float
    inclusion: bool = True

    def __post_init__(self) -> None:
        if not 0 < self.radius < math.inf:
            raise InputError(f"the radius {self.radius:g} m of a fence circle is not a positive number")


@dataclass(frozen=True, slots=True)
class ReturnPoint:
    """Where a vehicle that broke its fence flies to; `altitude` above home [m].

    Only ArduPlane does so, and at FENCE_RET_ALT: ArduPilot does not store the altitude, ground stations do.
    """

    point: GeoPoint
    altitude: float = 0.0

    def __post_init__(self) -> None:
        if not math.isfinite(self.altitude):
            raise InputError(f"the altitude {self.altitude} of the fence's return point is not finite")


@dataclass(frozen=True, slots=True)
class Fence:
    """All areas of a fence; at least one, or a return point."""

    polygons: tuple[FencePolygon, ...] = ()
    circles: tuple[FenceCircle, ...] = ()
    return_point: ReturnPoint | None = None

    def __post_init__(self) -> None:
        if not (self.polygons or self.circles or self.return_point):
            raise InputError("the fence is empty: give it an area, or leave it out")


@dataclass(frozen=True, slots=True)
class RallyPoint:
    """A place to return to in place of home.

    `altitude` [m] is above home, AMSL or above ground, as `frame` says: GLOBAL_RELATIVE_ALT, GLOBAL or
    GLOBAL_TERRAIN_ALT. ArduPilot keeps whole metres, cut, and older ones take altitudes above home only
    (MissionItemProtocol_Rally.cpp); PX4 takes none above ground.
    """

    point: GeoPoint
    altitude: float
    frame: int = Frame.GLOBAL_RELATIVE_ALT

    def __post_init__(self) -> None:
        if not math.isfinite(self.altitude):
            raise InputError(f"the altitude {self.altitude} of the rally point at {self.point} is not finite")
        if not is_global(self.frame):
            raise InputError(
                f"the rally point at {self.point} is in {frame_name(self.frame)}, which is no place on Earth"
            )
        object.__setattr__(self, "frame", plain_frame(self.frame))


def fence_items(fence: Fence | None) -> tuple[MissionItem, ...]:
    """The items of MISSION_TYPE_FENCE, none without a fence; home is not among them on any autopilot.

    In QGroundControl's order and frames: polygons, circles, the return point. A vertex carries its polygon's number
    of corners, a circle its radius [m], both as parameter 1.
    """
    if fence is None:
        return ()
    items = [
        _item(_polygon_command(polygon), corner, float(len(polygon.corners)))
        for polygon in fence.polygons
        for corner in polygon.corners
    ]
    items += [_item(_circle_command(circle), circle.centre, circle.radius) for circle in fence.circles]
    if (back := fence.return_point) is not None:
        frame = Frame.GLOBAL_RELATIVE_ALT
        items.append(_item(Command.NAV_FENCE_RETURN_POINT, back.point, frame=frame, altitude=back.altitude))
    return tuple(items)


def fence_of(items: Sequence[MissionItem]) -> Fence | None:
    """The fence that items of MISSION_TYPE_FENCE describe, None where there are none; any order of areas.

    As ArduPilot checks them: the vertices of a polygon follow each other and agree on their number, there is at most
    one return point. Raises InputError that names the item, counted from 0.
    """
    if not items:
        return None
    polygons: list[FencePolygon] = []
    circles: list[FenceCircle] = []
    back: ReturnPoint | None = None
    index = 0
    while index < len(items):
        try:
            part, length = _part(items, index)
            if isinstance(part, FencePolygon):
                polygons.append(part)
            elif isinstance(part, FenceCircle):
                circles.append(part)
            elif back is None:
                back = part
            else:
                raise InputError("it is a second return point, and a fence has one at most")
        except InputError as error:
            raise InputError(f"fence item {index}: {error}") from error
        index += length
    return Fence(tuple(polygons), tuple(circles), back)


def rally_items(points: Iterable[RallyPoint]) -> tuple[MissionItem, ...]:
    """The items of MISSION_TYPE_RALLY; home is not among them on any autopilot."""
    return tuple(
        _item(Command.NAV_RALLY_POINT, rally.point, frame=rally.frame, altitude=rally.altitude) for rally in points
    )


def rally_of(items: Iterable[MissionItem]) -> tuple[RallyPoint, ...]:
    """The rally points of items of MISSION_TYPE_RALLY; raises InputError that names the item, counted from 0."""
    points = []
    for index, item in enumerate(items):
        try:
            if item.command != Command.NAV_RALLY_POINT:
                raise InputError(f"{command_name(item.command)} is no rally point")
            points.append(RallyPoint(_point(item), item.altitude, item.frame))
        except InputError as error:
            raise InputError(f"rally item {index}: {error}") from error
    return tuple(points)


def _polygon_command(polygon: FencePolygon) -> Command:
    return next(command for command, inclusion in _POLYGONS.items() if inclusion == polygon.inclusion)


def _circle_command(circle: FenceCircle) -> Command:
    return next(command for command, inclusion in _CIRCLES.items() if inclusion == circle.inclusion)


def _item(
    command: Command, point: GeoPoint, param1: float = 0.0, *, frame: int = Frame.GLOBAL, altitude: float = 0.0
) -> MissionItem:
    params = (param1, 0.0, 0.0, 0.0)
    return MissionItem(frame, command, params, point.latitude_deg, point.longitude_deg, altitude, autocontinue=False)


def _point(item: MissionItem) -> GeoPoint:
    return GeoPoint(item.latitude_deg, item.longitude_deg)


def _part(items: Sequence[MissionItem], index: int) -> tuple[FencePolygon | FenceCircle | ReturnPoint, int]:
    """The part of a fence that begins at an item, and how many items it takes."""
    item = items[index]
    _refuse_strange(item)
    if item.command in _POLYGONS:
        count = _corner_count(item)
        vertices = items[index : index + count]
        _refuse_broken(vertices, count)
        return FencePolygon(tuple(map(_point, vertices)), _POLYGONS[Command(item.command)]), count
    if item.command in _CIRCLES:
        return FenceCircle(_point(item), item.params[0], _CIRCLES[Command(item.command)]), 1
    if item.command == Command.NAV_FENCE_RETURN_POINT:
        return ReturnPoint(_point(item), item.altitude), 1
    raise InputError(f"{command_name(item.command)} does not belong to a fence")


def _refuse_strange(item: MissionItem) -> None:
    """Raise InputError for a place that is not on Earth, or a group of areas: the autopilots know only one."""
    if not is_global(item.frame):
        raise InputError(f"{frame_name(item.frame)} is not a frame of latitudes and longitudes")
    group = item.params[1]
    if item.command in (*_POLYGONS, *_CIRCLES) and group != 0 and not math.isnan(group):
        raise InputError(f"it belongs to the inclusion group {group:g}; neither ArduPilot nor PX4 knows groups")


def _corner_count(vertex: MissionItem) -> int:
    announced = vertex.params[0]
    if not announced >= 3 or announced != announced // 1:
        raise InputError(f"its number of corners, {announced:g}, is not a whole number of at least 3")
    return int(announced)


def _refuse_broken(vertices: Sequence[MissionItem], count: int) -> None:
    """Raise InputError unless all corners of a polygon are there and agree with the first."""
    first = vertices[0]
    for number, vertex in enumerate(vertices, start=1):
        if (vertex.command, vertex.params[0]) != (first.command, first.params[0]):
            found = f"{command_name(vertex.command)} ({vertex.params[0]:g})"
            raise InputError(f"corner {number} of {count} is missing; in its place is {found}")
        _refuse_strange(vertex)
    if len(vertices) < count:
        raise InputError(f"only {len(vertices)} of its polygon's {count} corners are there")


def _refuse_crossing(corners: Sequence[GeoPoint]) -> None:
    """Raise InputError unless the corners, in the integers that the autopilot gets, border one area."""
    from shapely.geometry import Polygon  # half a second of import, for missions with fences only
    from shapely.validation import explain_validity

    units = [(degrees_e7(corner.longitude_deg), degrees_e7(corner.latitude_deg)) for corner in corners]
    x0, y0 = units[0]
    # from the first corner the shorter way round the Earth, so that small areas are exact, also on the date line
    shape = Polygon([((x - x0 + _HALF_TURN) % (2 * _HALF_TURN) - _HALF_TURN, y - y0) for x, y in units])
    if not shape.is_valid:
        said, _, place = explain_validity(shape).rstrip("]").partition("[")
        x, y = (float(number) for number in place.split())
        where = f"{(y0 + y) / 1e7:.7f}, {(x0 + x) / 1e7:.7f}"
        raise InputError(f"a fence polygon of {len(corners)} corners is no simple polygon ({said} at {where})")
