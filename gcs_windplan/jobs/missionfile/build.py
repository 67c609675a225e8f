"""From a checked mission file to a request: terrain and wind are read, places come into the local frame."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from datetime import UTC, datetime
from functools import partial
from pathlib import Path
from typing import TypeVar

import numpy as np

from gcs_windplan.errors import InputError, MissionFileError, Problem
from gcs_windplan.geo.frame import GeoPoint, LocalFrame
from gcs_windplan.jobs.missionfile.airframe import read_airframe
from gcs_windplan.jobs.missionfile.areas import AreaModel
from gcs_windplan.jobs.missionfile.limits import LimitsModel
from gcs_windplan.jobs.missionfile.model import GraphModel, MissionModel
from gcs_windplan.jobs.missionfile.outlines import fence_area_of, prism_of
from gcs_windplan.jobs.missionfile.parsing import MissionDocument, read_document
from gcs_windplan.jobs.missionfile.places import place_of
from gcs_windplan.jobs.missionfile.terrain import build_obstacles, build_terrain
from gcs_windplan.jobs.missionfile.values import FREE
from gcs_windplan.jobs.missionfile.wind import DAY, Departure, build_wind
from gcs_windplan.jobs.missionfile.world import SiteModel
from gcs_windplan.paper.sampled import SampledTest
from gcs_windplan.planning.cost import CostChoice
from gcs_windplan.planning.request import Export, FenceArea, Limits, Request, Roadmap, Site, Uniform
from gcs_windplan.planning.sites import choose_margin
from gcs_windplan.scene import Airspace, Prism
from gcs_windplan.terrain import Extent
from gcs_windplan.vehicle import Airframe, Vehicle

_T = TypeVar("_T")
_FARTHEST = 300_000.0  # [m] the local frame's distances are good to some metres over it
_NEAREST_POLE = 89.0  # [deg]
_SPARE = 500.0  # [m] of terrain read beyond the veil, so that sites just outside of it get their own message


def read_mission(path: Path | str, departure: datetime | None = None, lasting: float = DAY) -> Request:
    """The request in a mission file, terrain and wind read.

    `departure`, with its time zone, takes the place of the file's; a forecast is read for `lasting` [s] from then on.

    Raises `MissionFileError` with every problem of the file, or the error of a terrain or wind that cannot be used,
    with the line that names it.
    """
    document = read_document(Path(path))
    model = document.model
    frame = _frame(model)
    sites = [_site(name, site, frame) for name, site in _route(model)]
    beside = [_site(name, site, frame) for name, site in _beside(model)]
    _refuse_far(document, sites + beside)
    area = _area(model, sites)
    ground = _with(area, beside)
    terrain = _placed(document, "terrain", lambda: build_terrain(document, frame, ground))
    problems: list[Problem] = []
    airframe = _collected(document, "vehicle.airframe", problems, lambda: _airframe(document))
    obstacles = _collected(document, "obstacles", problems, lambda: build_obstacles(document, frame, terrain))
    airspace = Airspace(
        _prisms(document, "keep_out", model.limits.keep_out, frame, problems),
        _prisms(document, "keep_in", model.limits.keep_in, frame, problems),
    )
    when = Departure(model.departure if departure is None else departure.astimezone(UTC), lasting)
    winds = _collected(document, "wind", problems, lambda: build_wind(document, frame, terrain, area, when))
    if problems or winds is None:
        raise MissionFileError(problems)
    graph = model.graph
    return Request(
        name=model.name,
        frame=frame,
        terrain=terrain,
        wind=winds.wind,
        vehicle=_vehicle(model, airframe),
        start=sites[0],
        goal=sites[-1],
        via=tuple(sites[1:-1]),
        order=model.order,
        clearance=model.clearance,
        max_height=model.limits.max_height,
        limits=_limits(model.limits),
        cost=CostChoice(**model.cost.model_dump()),
        graph=_graph(graph),
        layers=graph.layers or (),
        margin=graph.margin,
        obstacles=obstacles,
        airspace=airspace,
        collision_test=SampledTest() if model.collision_test == "paper" else None,
        departure=when.moment,
        finish=model.finish,
        return_height=model.return_height,
        export=Export(**model.export.model_dump()),
        fence=_fence(model, frame),
        fence_return=None if model.fence.return_point is None else beside[-1],
        rally=tuple(beside[: len(model.rally)]),
        members=winds.members,
        gusts=winds.gusts,
        robust=0.5 if model.robust is None else model.robust,
        airframe=airframe,
        free_airspeed=model.vehicle.airspeed == FREE,
        locate=partial(_located, document),
    )


def _airframe(document: MissionDocument) -> Airframe | None:
    """The airframe that the mission names."""
    name = document.model.vehicle.airframe
    return None if name is None else read_airframe(document.beside(name))


def _vehicle(model: MissionModel, airframe: Airframe | None) -> Vehicle:
    """The vehicle: the airframe's, but for what the mission file itself says."""
    written = model.vehicle.model_dump(exclude={"airframe"})
    if airframe is None:
        return Vehicle(**written)
    own = {name: written[name] for name in model.vehicle.model_fields_set if name in written}
    if own.get("airspeed") == FREE:
        del own["airspeed"]
    return replace(airframe.vehicle, **own)


def _graph(model: GraphModel) -> Uniform | Roadmap:
    """The kind of graph; the schema has seen to it that there is exactly one."""
    if model.prm is not None:
        return Roadmap(**model.prm.model_dump())
    assert model.uniform is not None
    return Uniform(**model.uniform.model_dump())


def _limits(model: LimitsModel) -> Limits:
    """The limits of wind and battery; heights and areas have their own places in the request."""
    return Limits(model.wind, model.gust, model.battery, model.reserve, model.way_home)


def _located(document: MissionDocument, problem: Problem) -> Problem:
    """A problem that names a field, with its file, line and column."""
    if problem.file is not None or problem.field is None:
        return problem
    return document.problem(problem.field, problem.message)


def _placed(document: MissionDocument, field: str, build: Callable[[], _T]) -> _T:
    """What `build` returns; its input errors get the field's file, line and column."""
    try:
        return build()
    except InputError as error:
        raise type(error)([_at(document, field, problem) for problem in error.problems]) from error


def _at(document: MissionDocument, field: str, problem: Problem) -> Problem:
    """A problem with the place of a field in the mission file, the other file named in the message."""
    if problem.file == document.file:
        return problem
    named = problem.field if problem.field is not None and problem.field.startswith(field) else field
    return document.problem(named, str(replace(problem, field=None)))


def _collected(document: MissionDocument, field: str, problems: list[Problem], build: Callable[[], _T]) -> _T | None:
    """What `build` returns; its input errors are added to the problems instead."""
    try:
        return _placed(document, field, build)
    except InputError as error:
        problems.extend(error.problems)
        return None


def _frame(model: MissionModel) -> LocalFrame:
    """The local frame: about the declared origin, or the middle of all sites."""
    origin = model.terrain.origin
    if origin is not None:
        return LocalFrame(GeoPoint(origin.latitude, origin.longitude))
    sites = (model.start, *model.via, model.goal)
    latitudes = [site.latitude for site in sites if site.latitude is not None]
    longitudes = [site.longitude for site in sites if site.longitude is not None]
    offsets = [(longitude - longitudes[0] + 180) % 360 - 180 for longitude in longitudes]
    middle = longitudes[0] + (min(offsets) + max(offsets)) / 2
    return LocalFrame(GeoPoint((min(latitudes) + max(latitudes)) / 2, (middle + 180) % 360 - 180))


def _route(model: MissionModel) -> list[tuple[str, SiteModel]]:
    """Start, vias and goal, by the names of their fields."""
    vias = [(f"via.{i}", via) for i, via in enumerate(model.via)]
    return [("start", model.start), *vias, ("goal", model.goal)]


def _beside(model: MissionModel) -> list[tuple[str, SiteModel]]:
    """Rally points and the fence's return point, by the names of their fields; the return point comes last."""
    back = model.fence.return_point
    rally = [(f"rally.{i}", point) for i, point in enumerate(model.rally)]
    return rally if back is None else [*rally, ("fence.return_point", back)]


def _site(name: str, model: SiteModel, frame: LocalFrame) -> Site:
    return Site(name, *place_of(model, frame), model.height, model.altitude)


def _refuse_far(document: MissionDocument, sites: list[Site]) -> None:
    """Raise for sites too near to a pole or too far from the start for a flat frame."""
    problems = []
    models = dict([*_route(document.model), *_beside(document.model)])
    for site in sites:
        latitude = models[site.field].latitude
        if latitude is not None and abs(latitude) > _NEAREST_POLE:
            problems.append(document.problem(site.field, f"lies within {90 - _NEAREST_POLE:g}° of a pole: move it"))
        distance = float(np.hypot(site.east - sites[0].east, site.north - sites[0].north))
        if distance > _FARTHEST:
            text = f"lies {distance / 1000:.0f} km from the start; a mission spans at most {_FARTHEST / 1000:.0f} km"
            problems.append(document.problem(site.field, text))
    margin = document.model.graph.margin
    if margin is not None and margin > _FARTHEST:
        problems.append(document.problem("graph.margin", f"is more than {_FARTHEST / 1000:.0f} km: lower it"))
    if problems:
        raise MissionFileError(problems)


def _area(model: MissionModel, sites: list[Site]) -> Extent:
    """The box that terrain and wind are read for: the sites with the veil's margin, and something to spare."""
    places = np.array([(site.east, site.north) for site in sites])
    margin = choose_margin(places, model.graph.margin) + _SPARE
    west, south = places.min(axis=0) - margin
    east, north = places.max(axis=0) + margin
    return Extent(float(west), float(south), float(east), float(north))


def _with(area: Extent, sites: list[Site]) -> Extent:
    """The box that terrain is read for: the area, and what lies beside it."""
    if not sites:
        return area
    east, north = [site.east for site in sites], [site.north for site in sites]
    return Extent(
        min(area.west, *(e - _SPARE for e in east)),
        min(area.south, *(n - _SPARE for n in north)),
        max(area.east, *(e + _SPARE for e in east)),
        max(area.north, *(n + _SPARE for n in north)),
    )


def _fence(model: MissionModel, frame: LocalFrame) -> tuple[FenceArea, ...]:
    """The areas that the autopilot's fence holds too."""
    limits = model.limits
    areas = [(area, True) for area in limits.keep_out] + [(area, False) for area in limits.keep_in]
    return tuple(fence_area_of(area, frame, keep_out) for area, keep_out in areas if area.fence)


def _prisms(
    document: MissionDocument,
    kind: str,
    areas: tuple[AreaModel, ...],
    frame: LocalFrame,
    problems: list[Problem],
) -> tuple[Prism, ...]:
    """Keep-out or keep-in areas in the local frame; those that are no simple polygon become problems."""
    prisms = []
    for i, area in enumerate(areas):
        shape = "polygon" if area.circle is None else "circle"
        prism = _collected(
            document, f"limits.{kind}.{i}.{shape}", problems, partial(prism_of, area, frame, kind == "keep_out")
        )
        if prism is not None:
            prisms.append(prism)
    return tuple(prisms)
