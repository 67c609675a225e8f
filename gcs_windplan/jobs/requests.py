"""From a mission in words and values to the planner's request: terrain and wind are read, places become local."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from datetime import datetime
from functools import partial
from typing import TypeVar

import numpy as np

from gcs_windplan.errors import InputError, MissionFileError, Problem
from gcs_windplan.geo.frame import GeoPoint, LocalFrame
from gcs_windplan.jobs.areas import Area, fence_area_of, prism_of
from gcs_windplan.jobs.mission import Marked, Mission, as_cost, as_moment
from gcs_windplan.jobs.missionfile import read_mission
from gcs_windplan.jobs.obstacles import load_obstacles
from gcs_windplan.jobs.places import LocalPoint, Place, as_place
from gcs_windplan.jobs.terrains import GivenTerrain, Hills, MeshFile, as_terrain
from gcs_windplan.jobs.vehicles import load_vehicle
from gcs_windplan.jobs.winds import DAY, Surroundings, as_profile, as_wind
from gcs_windplan.jobs.words import read_as
from gcs_windplan.planning.request import FenceArea, Request, Site
from gcs_windplan.planning.sites import choose_margin
from gcs_windplan.scene import Airspace, Prism, Scene
from gcs_windplan.terrain import Extent

_T = TypeVar("_T")
_FARTHEST = 300_000.0  # [m] the local frame's distances are good to some metres over it
_NEAREST_POLE = 89.0  # [deg]
_SPARE = 500.0  # [m] of terrain read beyond the veil, so that sites just outside of it get their own message


def request_of(mission: Mission, departure: datetime | str | None = None, lasting: float = DAY) -> Request:
    """The request that a mission makes, terrain and wind read.

    `departure`, with its time zone, takes the place of the mission's; a forecast is read for `lasting` [s] from then.

    Raises `InputError` (`MissionFileError` where it is from a file) with every problem, or the error of a terrain or
    wind that cannot be used, with the line that names it.
    """
    builder = _Builder(mission.document)
    places = dict(_places(mission))
    frame = _frame(mission)
    every = [Site(name, *place.east_north(frame), place.height, place.altitude) for name, place in places.items()]
    builder.check_distances(every, places, mission.margin)
    count = 2 + len(mission.via)
    sites, beside = every[:count], every[count:]
    area = _area(sites, mission.margin)
    ground = _with(area, beside)
    terrain = builder.placed("terrain", lambda: as_terrain(mission.terrain).load(frame, ground))
    loaded = builder.collected("vehicle.airframe", lambda: load_vehicle(mission.vehicle))
    obstacles = builder.collected("obstacles", lambda: load_obstacles(mission.obstacles, frame, terrain))
    airspace = Airspace(
        builder.prisms("keep_out", mission.keep_out, frame), builder.prisms("keep_in", mission.keep_in, frame)
    )
    when = read_as("departure", lambda: as_moment(mission.departure if departure is None else departure))
    where = Surroundings(frame, terrain, area, when, lasting)
    winds = builder.collected("wind", lambda: as_wind(mission.wind).load(where, as_profile(mission.profile)))
    if builder.problems or winds is None or loaded is None:
        raise builder.error(builder.problems)
    vehicle, airframe = loaded
    free = mission.airspeed == "free"
    if mission.airspeed is not None and not free:
        vehicle = replace(vehicle, airspeed=float(mission.airspeed))
    return Request(
        name=mission.name,
        scene=Scene(frame, terrain, winds.wind, winds.members, winds.gusts, obstacles, airspace, when),
        vehicle=vehicle,
        start=sites[0],
        goal=sites[-1],
        via=tuple(sites[1:-1]),
        order=mission.order,
        clearance=mission.clearance,
        max_height=mission.max_height,
        limits=mission.limits,
        cost=as_cost(mission.cost),
        graph=mission.graph,
        layers=tuple(mission.layers),
        margin=mission.margin,
        collision_test=mission.collision_test,
        finish=mission.finish,
        return_height=mission.return_height,
        export=mission.export,
        fence=tuple(_fence(mission, frame)),
        fence_return=None if mission.fence_return is None else beside[-1],
        rally=tuple(beside[: len(mission.rally)]),
        robust=mission.robust,
        airframe=airframe,
        free_airspeed=free,
        locate=Locator(mission.document),
    )


def read_request(
    path: str | os.PathLike[str], departure: datetime | str | None = None, lasting: float = DAY
) -> Request:
    """The request in a mission file; raises as `read_mission` and `request_of` do."""
    return request_of(read_mission(path), departure, lasting)


@dataclass(frozen=True, slots=True)
class Locator:
    """Puts file, line and column to a problem that names a field of a mission file."""

    document: Marked | None

    def __call__(self, problem: Problem) -> Problem:
        """The problem with its place, where that is known."""
        if self.document is None or problem.file is not None or problem.field is None:
            return problem
        return self.document.problem(problem.field, problem.message)


class _Builder:
    """Collects what is wrong while a request is made."""

    def __init__(self, document: Marked | None) -> None:
        self.document = document
        self.problems: list[Problem] = []

    def problem(self, field: str, message: str) -> Problem:
        """A problem with a field, with its place in the mission file if it has one."""
        return Problem(message, field) if self.document is None else self.document.problem(field, message)

    def error(self, problems: Sequence[Problem]) -> InputError:
        """The error that tells the problems."""
        return (InputError if self.document is None else MissionFileError)(problems)

    def placed(self, field: str, build: Callable[[], _T]) -> _T:
        """What `build` returns; its input errors get the field's file, line and column."""
        try:
            return build()
        except InputError as error:
            raise error.told_as([self._at(field, problem) for problem in error.problems]) from error

    def collected(self, field: str, build: Callable[[], _T]) -> _T | None:
        """What `build` returns; its input errors are added to the problems instead."""
        try:
            return self.placed(field, build)
        except InputError as error:
            self.problems.extend(error.problems)
            return None

    def prisms(self, kind: str, areas: Sequence[Area], frame: LocalFrame) -> tuple[Prism, ...]:
        """Keep-out or keep-in areas in the local frame; those that are no simple polygon become problems."""
        shapes = (
            (f"limits.{kind}.{i}.{'polygon' if area.radius is None else 'circle'}", area)
            for i, area in enumerate(areas)
        )
        made = [self.collected(field, partial(prism_of, area, frame, kind == "keep_out")) for field, area in shapes]
        return tuple(prism for prism in made if prism is not None)

    def check_distances(self, sites: Sequence[Site], places: dict[str, Place], margin: float | None) -> None:
        """Raise for sites too near to a pole or too far from the start for a flat frame."""
        problems = []
        for site in sites:
            point = places[site.field].point
            if isinstance(point, GeoPoint) and abs(point.latitude_deg) > _NEAREST_POLE:
                problems.append(self.problem(site.field, f"lies within {90 - _NEAREST_POLE:g}° of a pole: move it"))
            distance = float(np.hypot(site.east - sites[0].east, site.north - sites[0].north))
            if distance > _FARTHEST:
                text = f"lies {distance / 1000:.0f} km from the start; a mission spans at most"
                problems.append(self.problem(site.field, f"{text} {_FARTHEST / 1000:.0f} km"))
        if margin is not None and margin > _FARTHEST:
            problems.append(self.problem("graph.margin", f"is more than {_FARTHEST / 1000:.0f} km: lower it"))
        if problems:
            raise self.error(problems)

    def _at(self, field: str, problem: Problem) -> Problem:
        """A problem with the place of a field in the mission file, the other file named in the message."""
        if self.document is not None and problem.file == self.document.file:
            return problem
        named = problem.field if problem.field is not None and problem.field.startswith(field) else field
        return self.problem(named, str(replace(problem, field=None)))


def _places(mission: Mission) -> Iterator[tuple[str, Place]]:
    """Start, vias, goal, rally points and the fence's return point, by the names of their fields."""
    yield "start", as_place(mission.start)
    yield from ((f"via.{i}", as_place(via)) for i, via in enumerate(mission.via))
    yield "goal", as_place(mission.goal)
    yield from ((f"rally.{i}", as_place(point)) for i, point in enumerate(mission.rally))
    if mission.fence_return is not None:
        yield "fence.return_point", as_place(mission.fence_return)


def _frame(mission: Mission) -> LocalFrame:
    """The local frame: about the declared origin, or the middle of all sites. Raises `InputError` without either."""
    if mission.origin is not None:
        return LocalFrame(mission.origin)
    places = {name: place.point for name, place in _places(mission)}
    local = [name for name, point in places.items() if isinstance(point, LocalPoint)]
    if isinstance(as_terrain(mission.terrain), MeshFile | Hills | GivenTerrain):
        local.insert(0, "terrain")
    if local:
        raise InputError(Problem("needs the mission's origin, which says where the local origin is", local[0]))
    names = ["start", *(f"via.{i}" for i in range(len(mission.via))), "goal"]
    sites = [point for name in names if isinstance(point := places[name], GeoPoint)]
    latitudes, longitudes = [p.latitude_deg for p in sites], [p.longitude_deg for p in sites]
    offsets = [(longitude - longitudes[0] + 180) % 360 - 180 for longitude in longitudes]
    middle = longitudes[0] + (min(offsets) + max(offsets)) / 2
    return LocalFrame(GeoPoint((min(latitudes) + max(latitudes)) / 2, (middle + 180) % 360 - 180))


def _area(sites: Sequence[Site], margin: float | None) -> Extent:
    """The box that terrain and wind are read for: the sites with the veil's margin, and something to spare."""
    places = np.array([(site.east, site.north) for site in sites])
    reach = choose_margin(places, margin) + _SPARE
    west, south = places.min(axis=0) - reach
    east, north = places.max(axis=0) + reach
    return Extent(float(west), float(south), float(east), float(north))


def _with(area: Extent, sites: Sequence[Site]) -> Extent:
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


def _fence(mission: Mission, frame: LocalFrame) -> Iterator[FenceArea]:
    """The areas that the autopilot's fence holds too."""
    for areas, keep_out in ((mission.keep_out, True), (mission.keep_in, False)):
        yield from (fence_area_of(area, frame, keep_out) for area in areas if area.fence)
