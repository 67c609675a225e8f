"""Rules of the ends: home on the ground, the first place near home, an end at all, and at the ground's height."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import replace
from functools import partial
from typing import Final

import numpy as np

from gcs_windplan.assessment.assessment import Fact, Finding
from gcs_windplan.assessment.case import Case
from gcs_windplan.assessment.figures import AssessedMission
from gcs_windplan.assessment.home import APART, first_place
from gcs_windplan.assessment.rules.places import Found, at_stop
from gcs_windplan.mission import Command, command_name
from gcs_windplan.mission.firmware import firmware_of

_LANDING_APART: Final = 5.0  # [m] the autopilot feels for the ground, but from another height

_at_home = partial(Finding, item=0, distance=0.0, unit="m")


def home(mission: AssessedMission) -> Iterator[Found]:
    """A home that is not on the terrain's ground: another datum, or another place."""
    terrain = mission.case.scene.terrain
    east, north, altitude = mission.track.course.home
    place = np.array(mission.track.course.home)
    under = float(terrain.heights_at(np.array([[east, north]]))[0])
    if math.isnan(under):
        far = terrain.extent.misses(east, north)
        facts: dict[str, Fact] = {"terrain": terrain.name}
        yield _at_home("terrain", "danger", value=far, limit=0.0, facts=facts), place
    elif abs(altitude - under) > APART:
        facts = {"altitude": altitude, "ground": under, "datum": terrain.vertical_datum}
        yield _at_home("home", "warning", value=altitude - under, limit=APART, facts=facts), place


def first_leg(mission: AssessedMission) -> Iterator[Found]:
    """A first place far from home: a mission for another site."""
    limit, case = mission.case.limits.first_leg, mission.case
    point = first_place(case.mission)
    if limit is None or point is None:
        return
    east, north = case.scene.frame.to_local(point.latitude_deg, point.longitude_deg)[0]
    far = math.hypot(east - mission.track.course.home[0], north - mission.track.course.home[1])
    if far > limit:
        item = next(number for number, item in enumerate(case.mission.items, start=1) if item.has_place)
        first = 1 if mission.legs else None
        finding = Finding("first-leg", "warning", item=item, leg=first, value=far, limit=limit, unit="m")
        yield finding, np.array((east, north, 0.0))


def landing(mission: AssessedMission) -> Iterator[Found]:
    """Landings whose items name another height than the ground has there."""
    hovers = mission.case.hovers
    for item, place in dict(mission.track.course.landings).items():
        under = float(mission.case.scene.terrain.heights_at(np.array([place]))[0])
        named = place[2]
        if math.isnan(under) or abs(named - under) <= _LANDING_APART:
            continue
        number = next((stop.number for stop in mission.stops if stop.item == item), None)
        distance = None if number is None else mission.stops[number].distance
        finding = Finding(
            "landing", "warning" if hovers else "danger", item=item, leg=number or None, distance=distance,
            value=named - under, limit=_LANDING_APART, unit="m",
            facts={"altitude": named, "ground": under, "hovers": hovers},
        )  # fmt: skip
        yield finding, np.array(place)


def ending(mission: AssessedMission) -> Iterator[Found]:
    """A mission that never ends, or ends in the air."""
    course, stop, items = mission.track.course, mission.stops[-1].number, mission.case.mission.items
    if course.endless is not None:
        command = items[course.endless - 1].command
        finding, place = at_stop(
            mission, stop, "endless", "danger", command=command_name(command),
            loiters=command == Command.NAV_LOITER_UNLIM, unreachable=len(items) > course.endless,
        )  # fmt: skip
        yield replace(finding, item=course.endless), place
    elif course.aloft:
        yield at_stop(mission, stop, "ending", "warning", last_item=len(items), then=_aloft(mission.case))


def _aloft(case: Case) -> str:
    """What a vehicle does whose mission ends in the air."""
    if case.hovers:
        return "hovers there"
    if firmware_of(case.autopilot, case.vehicle_type).ends_over_home:
        return "circles over home"
    return "circles there"
