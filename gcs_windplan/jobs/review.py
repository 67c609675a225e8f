"""Judging missions: planned ones in their own world, drawn ones in that of criteria or of a mission file."""

from __future__ import annotations

import os
from collections.abc import Sequence
from dataclasses import replace
from datetime import datetime
from pathlib import Path

from gcs_windplan.assessment import Assessment, Case, assess
from gcs_windplan.assessment.planned import case_of
from gcs_windplan.errors import InputError, Problem
from gcs_windplan.formats import ReadMission, read_items
from gcs_windplan.jobs.cases import case_by_criteria
from gcs_windplan.jobs.criteria import Criteria
from gcs_windplan.jobs.items import ItemsWords, file_of, is_mission_file
from gcs_windplan.jobs.mission import Mission
from gcs_windplan.jobs.missionfile import read_mission
from gcs_windplan.jobs.places import PlaceWords
from gcs_windplan.jobs.requests import request_of
from gcs_windplan.jobs.sources import software, source, sources_of_mission
from gcs_windplan.jobs.terrains import TerrainWords
from gcs_windplan.jobs.winds import WindProfile, WindWords
from gcs_windplan.mission import MissionItems
from gcs_windplan.planning import planner
from gcs_windplan.planning.export import mission_of
from gcs_windplan.planning.request import Request
from gcs_windplan.progress import CancelToken, ProgressCallback, Tracker
from gcs_windplan.vehicle import Airframe, Autopilot, VehicleType


def review(
    mission: ItemsWords,
    *,
    by: Mission | str | os.PathLike[str] | None = None,
    terrain: TerrainWords | None = None,
    wind: WindWords | None = None,
    profile: WindProfile | str | None = None,
    extend: bool = False,
    departure: datetime | str | None = None,
    vehicle: Airframe | Path | str | None = None,
    autopilot: Autopilot | None = None,
    vehicle_type: VehicleType | None = None,
    home: PlaceWords | None = None,
    clearance: float | str | None = None,
    max_height: float | str | None = None,
    max_wind: float | str | None = None,
    max_gust: float | str | None = None,
    min_battery: float | str | None = None,
    first_leg: float | str | None = None,
    progress: ProgressCallback | None = None,
    cancel: CancelToken | None = None,
) -> Assessment:
    """Judge a mission against terrain, wind and limits: its legs as flown, and what is wrong (`findings`).

    A mission file (.yaml), a `Mission` or a `Plan` is planned and judged in its own world. For a ground station's file
    (.plan, .waypoints) or `MissionItems` say the world, or take that of another mission with `by`: `terrain` (files of
    heights, `sample:jacksboro`, `flat:120`), `wind` (a forecast's files, `8 m/s from 270 deg`, `calm`; still air
    without), its `profile` over height, `extend` (outside the forecast's area the nearest values), the `departure`, an
    airframe or its file as `vehicle`. `autopilot`, `vehicle_type` and `home` take the place of the mission's own.

    Limits are numbers or words: `clearance` (30 m if not said), `max_height` and `first_leg` (500 m) [m], `max_wind`
    and `max_gust` [m/s], `min_battery`, the share that must be left.

    Raises `InputError` for what cannot be used, `NoRouteError` for a mission to be planned that has no route, and
    `CancelledError`.

    >>> import gcs_windplan as gw
    >>> plan = gw.plan(gw.Mission(
    ...     start=(36.55, -84.30), goal=(36.56, -84.28), vehicle=gw.Vehicle(12.0), terrain="flat:300",
    ... ))
    >>> assessment = gw.review(plan.items, terrain="flat:300", wind="8 m/s from 270 deg", max_wind="10 kt")
    >>> [finding.rule for finding in assessment.findings if finding.severity == "danger"]
    ['wind']
    """
    criteria = Criteria(
        terrain=terrain,
        wind=wind,
        profile=profile,
        extend=extend,
        departure=departure,
        vehicle=vehicle,
        autopilot=autopilot,
        vehicle_type=vehicle_type,
        home=home,
        clearance=clearance,
        max_height=max_height,
        max_wind=max_wind,
        max_gust=max_gust,
        min_battery=min_battery,
        first_leg=first_leg,
    )
    return judge([mission], by, criteria, progress=progress, cancel=cancel)[0]


def judge(
    missions: Sequence[ItemsWords],
    by: Mission | str | os.PathLike[str] | None,
    criteria: Criteria,
    *,
    progress: ProgressCallback | None = None,
    cancel: CancelToken | None = None,
) -> list[Assessment]:
    """Missions judged; one that is drawn in the world of `by`, of the first that is planned, or of the criteria."""
    tracker = Tracker(progress, cancel)
    read = [_read(words) for words in missions]
    world = _read(by) if by is not None else next((one for one in read if isinstance(one, Mission)), None)
    found = []
    for words, one in zip(missions, read, strict=True):
        case = _case(one, words, world, criteria, tracker)
        tracker.at("judging")
        found.append(assess(replace(case, sources=(*case.sources, software()))))
    tracker.at("done")
    return found


def _read(words: ItemsWords) -> Mission | Request | planner.PlannedRoute | ReadMission:
    """The mission to be planned, the plan, or the items that words say."""
    if isinstance(words, MissionItems):
        return ReadMission(words)
    if isinstance(words, str | os.PathLike):
        return read_mission(words) if is_mission_file(words) else read_items(words)
    return words


def _case(
    one: Mission | Request | planner.PlannedRoute | ReadMission,
    words: ItemsWords,
    world: object,
    criteria: Criteria,
    tracker: Tracker,
) -> Case:
    """What is judged, with what it is judged by."""
    file = file_of(words)
    if isinstance(one, ReadMission):
        return _drawn(one, file, world, criteria, tracker)
    return _planned(one, file, criteria, tracker)


def _planned(
    mission: Mission | Request | planner.PlannedRoute, file: Path | None, criteria: Criteria, tracker: Tracker
) -> Case:
    """The mission that planning comes to, in its own world."""
    _refuse_two_worlds(file or "a mission to be planned", criteria)
    sources = []
    if isinstance(mission, planner.PlannedRoute):
        plan = mission
    else:
        if isinstance(mission, Mission):
            tracker.at("reading terrain and wind")
            request = request_of(mission, criteria.moment)
            sources = list(sources_of_mission(mission, request.scene.wind.name))
        else:
            request = mission
        plan = planner.plan_routes(request, [request.cost], progress=tracker.progress, cancel=tracker.cancel)[0]
    case = case_of(plan.request, mission_of(plan), sources)
    return criteria.with_home(replace(case, remarks=plan.notes, limits=criteria.limits_with(case.limits)))


def _drawn(read: ReadMission, file: Path | None, world: object, criteria: Criteria, tracker: Tracker) -> Case:
    """The mission of a ground station's file."""
    if not read.mission.items:
        raise InputError(Problem("holds no items: there is nothing to judge", file=file))
    name = "mission" if file is None else file.stem
    said = tuple(f"{name if file is None else file.name}: {repair}" for repair in read.repairs)
    own = () if file is None else (source("mission", file, f"{len(read.mission.items)} items"),)
    tracker.at("reading terrain and wind")
    if isinstance(world, Mission):
        case = _in_world(world, criteria)
        items = replace(read.mission, autopilot=case.autopilot, vehicle_type=case.vehicle_type)
        case = criteria.with_home(replace(case, mission=items))
    else:
        case = case_by_criteria(read.mission, name, file, criteria)
    return replace(case, name=name, remarks=(*said, *case.remarks), sources=(*own, *case.sources))


def _in_world(world: Mission, criteria: Criteria) -> Case:
    """The case of a mission's world, to put another mission into."""
    named = world.name if world.document is None else world.document.file
    _refuse_two_worlds(named, criteria)
    request = request_of(world, criteria.moment)
    case = case_of(request, MissionItems(()), tuple(sources_of_mission(world, request.scene.wind.name, role=None)))
    said = f"judged by the terrain, wind, vehicle, limits and areas of {named}"
    limits = criteria.limits_with(replace(case.limits, first_leg=500.0))
    return replace(case, remarks=(said,), limits=limits)


def _refuse_two_worlds(named: object, criteria: Criteria) -> None:
    """A mission to be planned settles the world: criteria that say another one contradict it."""
    if criteria.world:
        first = criteria.world[0]
        raise criteria.error(first, f"cannot stand beside {named}, which says that itself: leave it out")
