"""What sections of a mission file say against each other, as far as no terrain is needed to tell.

The rules read the file's plain values, so that they speak even where other fields are wrong; a value that is
wrong by itself is ignored here.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from itertools import combinations, pairwise
from typing import Final

from gcs_windplan.errors import Problem
from gcs_windplan.jobs.missionfile.section import Fields, Path, SchemaProblem
from gcs_windplan.jobs.missionfile.values import CLEARANCE, HEIGHT, LATITUDE, LONGITUDE, SIGNED_LENGTH
from gcs_windplan.planning.contradictions import (
    height_problems,
    limits_without_airframe,
    outside_limits,
    too_many_to_order,
)

DEFAULT_CLEARANCE: Final = 30.0  # [m]
_SAME_DEGREES: Final = 1e-7  # about a centimetre, and MAVLink's resolution of a coordinate
_SAME_METRES: Final = 0.01
_LEAST_MARGIN: Final = 2.0  # [m] ArduPilot's FENCE_MARGIN; by as much ArduCopter cuts corners (measured)


def mission_contradictions(fields: Fields) -> Iterator[SchemaProblem]:
    """Everything that the sections of a mission say against each other."""
    clearance = CLEARANCE.read_or_none(fields.get("clearance", DEFAULT_CLEARANCE))
    max_height = CLEARANCE.read_or_none(_section(fields, "limits").get("max_height"))
    apart = clearance is not None and max_height is not None and clearance > max_height
    yield from _found(height_problems(clearance, max_height, list(_layers(fields))))
    if not apart:
        yield from _sites_outside(fields, clearance, max_height)
    yield from _local_without_origin(fields)
    yield from _equal_neighbours(fields)
    yield from fence_contradictions(fields)
    yield from _limits_without_measure(fields)
    if "robust" in fields and "members" not in _section(fields, "wind"):
        yield SchemaProblem(("robust",), "belongs only beside wind.members; leave it out", at_key=True)


def _found(problems: Iterable[Problem], at_key: bool = False) -> Iterator[SchemaProblem]:
    """Problems as findings."""
    for problem in problems:
        path = (int(part) if part.isdigit() else part for part in str(problem.field).split("."))
        yield SchemaProblem(tuple(path), problem.message, at_key)


def _limits_without_measure(fields: Fields) -> Iterator[SchemaProblem]:
    """Limits of what nobody would know: a battery without an airframe, gusts without a forecast."""
    limits, airframe = _section(fields, "limits"), "airframe" in _section(fields, "vehicle")
    unknown = limits_without_airframe(battery="battery" in limits, reserve="reserve" in limits, airframe=airframe)
    yield from _found(unknown, at_key=True)
    if "gust" in limits and "forecast" not in _section(fields, "wind"):
        yield SchemaProblem(("limits", "gust"), "needs wind.forecast; no other wind has gusts", at_key=True)


def _sites_outside(fields: Fields, clearance: float | None, max_height: float | None) -> Iterator[SchemaProblem]:
    for path, site in [*_sites(fields), *_beside(fields)]:
        height = HEIGHT.read_or_none(site.get("height"))
        if height is not None and (complaint := outside_limits(height, clearance, max_height)):
            yield SchemaProblem((*path, "height"), complaint)


def _local_without_origin(fields: Fields) -> Iterator[SchemaProblem]:
    """Local places mean nothing on a DEM whose file does not say where the local origin is.

    A mesh or a surface without an origin is a problem of the terrain's own.
    """
    terrain = _section(fields, "terrain")
    if "origin" in terrain or not any(name in terrain for name in ("dem", "sample", "flat")):
        return
    advice = "needs terrain.origin, which says where the local origin is"
    for path, place in [*_sites(fields), *_beside(fields)]:
        yield from _local_place(path, place, advice)
    for index, obstacle in _entries(fields, "obstacles"):
        if "at" in obstacle:
            yield from _local_place(("obstacles", index, "at"), _section(obstacle, "at"), advice)
        else:
            yield SchemaProblem(
                ("obstacles", index), f"an obstacle without 'at' stands at the local origin and {advice}"
            )
    for path, area in _areas(fields):
        if "east_north" in _section(area, "polygon"):
            yield SchemaProblem((*path, "polygon", "east_north"), advice, at_key=True)
        yield from _local_place((*path, "circle"), _section(area, "circle"), advice)


def _local_place(path: Path, place: Fields, advice: str) -> Iterator[SchemaProblem]:
    local = [name for name in ("east", "north") if name in place]
    if local and not ("latitude" in place or "longitude" in place):
        yield SchemaProblem((*path, local[0]), advice, at_key=True)


def _equal_neighbours(fields: Fields) -> Iterator[SchemaProblem]:
    """Sites at the same place that follow each other, or may do so in another order; the goal comes last."""
    sites = [(path, _position(site)) for path, site in _sites(fields)]
    if fields.get("order") == "free" and len(sites) > 3:
        yield from _found(too_many_to_order(len(sites) - 2))
        pairs = [pair for pair in combinations(sites, 2) if pair != (sites[0], sites[-1])]
    else:
        pairs = list(pairwise(sites))
    for (before, here), (path, there) in pairs:
        if here and there and _same(here, there):
            name = ".".join(str(part) for part in before)
            yield SchemaProblem(path, f"is the same place as {name}; there is nothing to fly in between")


def _same(here: tuple[str, float, float], there: tuple[str, float, float]) -> bool:
    tolerance = _SAME_METRES if here[0] == "local" else _SAME_DEGREES
    return here[0] == there[0] and all(abs(a - b) < tolerance for a, b in zip(here[1:], there[1:], strict=True))


def _position(site: Fields) -> tuple[str, float, float] | None:
    latitude, longitude = (
        LATITUDE.read_or_none(site.get("latitude")),
        LONGITUDE.read_or_none(site.get("longitude")),
    )
    if latitude is not None and longitude is not None:
        return "geographic", latitude, longitude
    east, north = (SIGNED_LENGTH.read_or_none(site.get(name)) for name in ("east", "north"))
    return None if east is None or north is None else ("local", east, north)


def _sites(fields: Fields) -> Iterator[tuple[Path, Fields]]:
    """Start, what is passed, goal, in this order; what is not there or no section is an empty one."""
    yield ("start",), _section(fields, "start")
    via = fields.get("via")
    for index in range(len(via) if isinstance(via, list | tuple) else 0):
        yield ("via", index), _section(dict(_entries(fields, "via")), index)
    yield ("goal",), _section(fields, "goal")


def _beside(fields: Fields) -> Iterator[tuple[Path, Fields]]:
    """Rally points and the fence's return point, as far as they are there."""
    for index, point in _entries(fields, "rally"):
        yield ("rally", index), point
    yield ("fence", "return_point"), _section(_section(fields, "fence"), "return_point")


def fence_contradictions(fields: Fields) -> Iterator[SchemaProblem]:
    """What the autopilot's fence cannot hold, and what would not reach the vehicle."""
    fenced = [(path, area) for path, area in _areas(fields) if area.get("fence") is True]
    for path, area in fenced:
        yield from _unfit_for_fence(path, area, fields)
    back = "return_point" in _section(fields, "fence")
    if back and not fenced:
        advice = "there is no fence to return from: mark an area in limits with 'fence: true'"
        yield SchemaProblem(("fence", "return_point"), advice, at_key=True)
    if (fenced or back or fields.get("rally")) and _section(fields, "export").get("plan") is False:
        yield SchemaProblem(("export", "plan"), "fence and rally points fit only into a .plan file: leave this out")


def _unfit_for_fence(path: Path, area: Fields, fields: Fields) -> Iterator[SchemaProblem]:
    """An area that the fence would hold otherwise than the file says."""
    for limit in ("floor", "ceiling") if "keep_out" in path else ():
        if limit in area:
            text = f"a fence has no heights and would forbid what lies beyond the {limit} too"
            yield SchemaProblem((*path, limit), f"{text}: leave out either this or 'fence: true'", at_key=True)
    margin = HEIGHT.read_or_none(area.get("margin"))
    if margin is not None and margin < _LEAST_MARGIN:
        text = (
            f"{margin:g} m is too little beside a fence that the vehicle must not touch: at least {_LEAST_MARGIN:g} m"
        )
        yield SchemaProblem((*path, "margin"), text)
    corners = _corners(area)
    if corners:
        yield from _too_many_corners(path, corners, _section(fields, "vehicle").get("autopilot", "ardupilot"))


def _too_many_corners(path: Path, corners: int, autopilot: object) -> Iterator[SchemaProblem]:
    """A polygon with more corners than its autopilot's fence can hold."""
    from gcs_windplan.mission.firmware import autopilots, firmware_of  # heavy, and few missions have a fence

    if not isinstance(autopilot, str) or autopilot not in autopilots():
        return  # which is said elsewhere
    firmware = firmware_of(autopilot)
    if firmware.fence_corners is not None and corners > firmware.fence_corners:
        most = f"the {firmware.fence_corners} of {firmware.name}'s fence polygons"
        yield SchemaProblem((*path, "polygon"), f"{corners} corners are more than {most}: simplify it")


def _corners(area: Fields) -> int:
    polygon = area.get("polygon")
    if isinstance(polygon, Mapping):
        polygon = next((polygon[name] for name in ("latitude_longitude", "east_north") if name in polygon), None)
    return len(polygon) if isinstance(polygon, list | tuple) else 0


def _areas(fields: Fields) -> Iterator[tuple[Path, Fields]]:
    """The areas to keep out of, then those to keep in."""
    for kind in ("keep_out", "keep_in"):
        for index, area in _entries(_section(fields, "limits"), kind):
            yield ("limits", kind, index), area


def _layers(fields: Fields) -> Iterator[float | None]:
    layers = _section(fields, "graph").get("layers")
    yield from (CLEARANCE.read_or_none(layer) for layer in (layers if isinstance(layers, list | tuple) else ()))


def _section(fields: Mapping[str, object] | Mapping[int, Fields], name: str | int) -> Fields:
    found = dict[object, object](fields).get(name)  # type: ignore[arg-type]
    return found if isinstance(found, Mapping) else {}


def _entries(fields: Fields, name: str) -> Iterator[tuple[int, Fields]]:
    found = fields.get(name)
    for index, entry in enumerate(found if isinstance(found, list | tuple) else ()):
        if isinstance(entry, Mapping):
            yield index, entry
