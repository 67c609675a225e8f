"""The fence and the rally points of a .plan file.

    geoFence: version 2
      polygons: each {polygon [[latitude, longitude], ...], inclusion, version 1}
      circles: each {circle {center [latitude, longitude], radius}, inclusion, version 1}
      breachReturn [latitude, longitude, altitude above home], or absent
    rallyPoints: version 2
      points [[latitude, longitude, altitude above home], ...]

So QGroundControl writes and uploads them (GeoFenceController.cc, RallyPointManager.cc), and so MAVSDK imports them.
QGroundControl ignores version 1, and so does this reader, with a note.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence
from typing import Any, TypeVar

from gcs_windplan.errors import FormatError, InputError
from gcs_windplan.formats.digits import json_degrees, json_number, json_place
from gcs_windplan.formats.document import Node
from gcs_windplan.formats.reading import Repairs
from gcs_windplan.geo.frame import GeoPoint
from gcs_windplan.mission import Fence, FenceCircle, FencePolygon, Frame, Home, RallyPoint, ReturnPoint

_T = TypeVar("_T")
_VERSION = 2
_AREA_VERSION = 1


def fence_object(fence: Fence | None) -> dict[str, Any]:
    """The fence as `geoFence`; without one its lists are empty."""
    polygons, circles = ((), ()) if fence is None else (fence.polygons, fence.circles)
    written: dict[str, Any] = {
        "circles": [
            {
                "circle": {"center": _degrees(circle.centre), "radius": json_number(circle.radius)},
                "inclusion": circle.inclusion,
                "version": _AREA_VERSION,
            }
            for circle in circles
        ],
        "polygons": [
            {
                "inclusion": polygon.inclusion,
                "polygon": [_degrees(corner) for corner in polygon.corners],
                "version": _AREA_VERSION,
            }
            for polygon in polygons
        ],
        "version": _VERSION,
    }
    if fence is not None and (back := fence.return_point) is not None:
        written["breachReturn"] = json_place(back.point.latitude_deg, back.point.longitude_deg, back.altitude)
    return written


def rally_object(points: Sequence[RallyPoint], home: Home) -> dict[str, Any]:
    """The rally points as `rallyPoints`; raises FormatError for one above ground, which has no place there."""
    return {"points": [_rally_place(rally, home) for rally in points], "version": _VERSION}


def _rally_place(rally: RallyPoint, home: Home) -> list[float]:
    if rally.frame == Frame.GLOBAL_TERRAIN_ALT:
        raise FormatError(
            f"the rally point at {rally.point} is {rally.altitude:g} m above ground, and a .plan file holds heights "
            "above home only: give it one"
        )
    above_home = rally.altitude - (home.altitude if rally.frame == Frame.GLOBAL else 0.0)
    return json_place(rally.point.latitude_deg, rally.point.longitude_deg, above_home)


def _degrees(point: GeoPoint) -> list[float]:
    return json_degrees(point.latitude_deg, point.longitude_deg)


def read_fence(root: Node, repairs: Repairs) -> Fence | None:
    """The fence of a .plan file, None where it has none; every part that cannot be used is left out and noted."""
    node = _part(root, "geoFence", ("circles", "polygons", "polygon", "breachReturn"), repairs)
    if node is None:
        return None
    polygons = tuple(_usable(node, "polygons", _polygon, repairs))
    circles = tuple(_usable(node, "circles", _circle, repairs))
    back = None
    if (written := node.at("breachReturn")).present and written.value is not None:
        back = _used(written, _return_point, repairs)
    return Fence(polygons, circles, back) if polygons or circles or back else None


def read_rally(root: Node, repairs: Repairs) -> tuple[RallyPoint, ...]:
    """The rally points of a .plan file, altitudes above home; those that cannot be used are left out and noted."""
    node = _part(root, "rallyPoints", ("points",), repairs)
    return () if node is None else tuple(_usable(node, "points", _rally_point, repairs))


def _part(root: Node, key: str, contents: Sequence[str], repairs: Repairs) -> Node | None:
    """The part of the file, or None where it is absent or of another version."""
    node = root.at(key)
    if not node.present or node.value is None:
        return None
    if not isinstance(node.value, dict):
        repairs.leave_out(f"{key} is not an object; it was left out")
        return None
    version = node.value.get("version")
    if version == _VERSION:
        return node
    held = [name for name in contents if node.value.get(name)]
    if held:
        found = "has no version" if version is None else f"is of version {version}"
        repairs.leave_out(f"{key} {found}, and only {_VERSION} is known; its {' and '.join(held)} were left out")
    return None


def _usable(node: Node, key: str, read: Callable[[Node, Repairs], _T], repairs: Repairs) -> Iterator[_T]:
    array = node.at(key)
    if not array.present or array.value is None:
        return
    if not isinstance(array.value, list):
        repairs.leave_out(f"{array.path} is not an array; it was left out")
        return
    for element in array.elements():
        found = _used(element, read, repairs)
        if found is not None:
            yield found


def _used(node: Node, read: Callable[[Node, Repairs], _T], repairs: Repairs) -> _T | None:
    """What `read` makes of a place in the document, or None and a repair that says why not."""
    try:
        return read(node, repairs)
    except FormatError as error:
        problem = error.problems[0]
        inner = (problem.field or "").removeprefix(node.path).lstrip(".")
        repairs.leave_out(f"{node.path} was left out: {' '.join(part for part in (inner, problem.message) if part)}")
    except InputError as error:
        repairs.leave_out(f"{node.path} was left out: {error}")
    return None


def _polygon(node: Node, repairs: Repairs) -> FencePolygon:
    inclusion = _inclusion(node)
    return FencePolygon(tuple(_corner(corner, repairs) for corner in node.at("polygon").elements()), inclusion)


def _circle(node: Node, repairs: Repairs) -> FenceCircle:
    inclusion = _inclusion(node)
    circle = node.at("circle")
    return FenceCircle(_corner(circle.at("center"), repairs), circle.at("radius").number(), inclusion)


def _inclusion(node: Node) -> bool:
    """Whether the vehicle stays inside of an area; nothing to guess at where the file does not say it."""
    version, inclusion = node.at("version"), node.at("inclusion")
    if version.present and version.value != _AREA_VERSION:
        version.refuse(f"is {version.value}, and only {_AREA_VERSION} is known")
    if not isinstance(inclusion.value, bool):
        inclusion.refuse("is neither true nor false")
    return inclusion.value


def _corner(node: Node, repairs: Repairs) -> GeoPoint:
    latitude, longitude, *height = _numbers(node, least=2)
    if height:
        repairs.add("heights in the fence were dropped: its areas have none")
    return GeoPoint(latitude, longitude)


def _return_point(node: Node, repairs: Repairs) -> ReturnPoint:
    latitude, longitude, *altitude = _numbers(node, least=2)
    if not altitude or math.isnan(altitude[0]):
        repairs.add(f"{node.path} has no altitude; it was read as 0 m above home")
        altitude = [0.0]
    return ReturnPoint(GeoPoint(latitude, longitude), altitude[0])


def _rally_point(node: Node, repairs: Repairs) -> RallyPoint:
    latitude, longitude, altitude = _numbers(node, least=3)
    return RallyPoint(GeoPoint(latitude, longitude), altitude)


def _numbers(node: Node, least: int) -> list[float]:
    numbers = [element.number_or_nan() for element in node.elements()]
    if not least <= len(numbers) <= 3:
        wanted = "latitude and longitude" if least == 2 else "latitude, longitude and altitude"
        node.refuse(f"has {len(numbers)} numbers, not {wanted}")
    return numbers
