"""Rules of the ends: home on the ground, the first place near home, an end at all, and at the ground's height."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import replace
from typing import Final

import numpy as np

from gcs_windplan.assessment.assessment import Finding, Severity
from gcs_windplan.assessment.figures import Judged
from gcs_windplan.assessment.home import APART, first_place
from gcs_windplan.assessment.rules.saying import Found, at_stop, metres
from gcs_windplan.mission import Command, command_name
from gcs_windplan.mission.firmware import firmware_of

_LANDING_APART: Final = 5.0  # [m] the autopilot feels for the ground, but from another height


def home(mission: Judged) -> Iterator[Found]:
    """A home that is not on the terrain's ground: another datum, or another place."""
    east, north, altitude = mission.track.course.home
    place = np.array(mission.track.course.home)
    under = float(mission.case.terrain.heights_at(np.array([[east, north]]))[0])
    if math.isnan(under):
        far = mission.case.terrain.extent.misses(east, north)
        said = (
            f"home lies {metres(far)} outside of the terrain ({mission.case.terrain.name}): add a tile, or correct home"
        )
        yield Finding("terrain", "danger", said, 0, None, 0.0, value=far, limit=0.0, unit="m"), place
    elif abs(altitude - under) > APART:
        said = (
            f"home is {abs(altitude - under):.1f} m {'above' if altitude > under else 'below'} the ground"
            f" ({altitude:.1f} m against {under:.1f} m {mission.case.terrain.vertical_datum}); where the vehicle is"
            " armed on the ground all heights above home are off by that: correct its altitude, or compare the datums"
        )
        yield Finding("home", "warning", said, 0, None, 0.0, value=altitude - under, limit=APART, unit="m"), place


def first_leg(mission: Judged) -> Iterator[Found]:
    """A first place far from home: a mission for another site."""
    limit, case = mission.case.limits.first_leg, mission.case
    point = first_place(case.mission)
    if limit is None or point is None:
        return
    east, north = case.frame.to_local(point.latitude_deg, point.longitude_deg)[0]
    far = math.hypot(east - mission.track.course.home[0], north - mission.track.course.home[1])
    if far > limit:
        item = next(number for number, item in enumerate(case.mission.items, start=1) if item.has_place)
        said = (
            f"the first place (item {item}) lies {metres(far)} from home, more than {limit:g} m: is it this site's"
            " mission, and this home?"
        )
        first = 1 if mission.legs else None
        place = np.array((east, north, 0.0))
        yield Finding("first-leg", "warning", said, item, first, value=far, limit=limit, unit="m"), place


def landing(mission: Judged) -> Iterator[Found]:
    """Landings whose items name another height than the ground has there."""
    winged = not mission.case.hovers
    for item, place in dict(mission.track.course.landings).items():
        under = float(mission.case.terrain.heights_at(np.array([place]))[0])
        named = place[2]
        if math.isnan(under) or abs(named - under) <= _LANDING_APART:
            continue
        side = "above" if named > under else "below"
        matters = "it flares at that height" if winged else "it comes down fast on higher ground, slowly on lower"
        said = (
            f"item {item} lands at {named:.1f} m above sea level, {abs(named - under):.1f} m {side} the ground there"
            f" ({under:.1f} m); {matters}: correct its altitude"
        )
        severity: Severity = "danger" if winged else "warning"
        number = next((stop.number for stop in mission.stops if stop.item == item), None)
        distance = None if number is None else mission.stops[number].distance
        finding = Finding(
            "landing", severity, said, item, number or None, distance, value=named - under, limit=_LANDING_APART,
            unit="m",
        )  # fmt: skip
        yield finding, np.array(place)


def ending(mission: Judged) -> Iterator[Found]:
    """A mission that never ends, or ends in the air."""
    course, stop = mission.track.course, mission.stops[-1].number
    if course.endless is not None:
        finding, place = at_stop(mission, stop, "endless", "danger", _endless(mission, course.endless))
        yield replace(finding, item=course.endless), place
    elif course.aloft:
        yield at_stop(mission, stop, "ending", "warning", f"{_aloft(mission)}: add a LAND or RTL")


def _endless(mission: Judged, number: int) -> str:
    """What is said of an item that has no end."""
    command = mission.case.mission.items[number - 1].command
    loiters = command == Command.NAV_LOITER_UNLIM
    does = "" if loiters else " for ever"
    do = "use NAV_LOITER_TIME, and land or return behind it" if loiters else "give it a count, and an end behind it"
    return (
        f"item {number}, {command_name(command)}{does}, has no end: it flies until the battery is empty, and time and"
        f" battery are counted up to there only; {do}"
    )


def _aloft(mission: Judged) -> str:
    """What a vehicle does whose mission ends in the air."""
    if mission.case.hovers:
        does = "hovers there"
    elif firmware_of(mission.case.autopilot, mission.case.vehicle_type).ends_over_home:
        does = "circles over home"
    else:
        does = "circles there"
    last = len(mission.case.mission.items)
    said = f"the mission ends in the air, with item {last}: it {does} until the battery is empty"
    return f"{said}; landing or return is not counted"
