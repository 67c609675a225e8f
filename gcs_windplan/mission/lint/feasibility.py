"""What PX4 looks at before it flies a mission that it took, for every kind of vehicle.

By FeasibilityChecker.cpp, with the parameters' defaults (mission_params.c). A distance between waypoints of more
than 900 m (MIS_DIST_WPS) was once refused too; releases since 1.14 have no such limit.
"""

from __future__ import annotations

import itertools
import math

from pymavlink.dialects.v20 import ardupilotmega as mavlink

from gcs_windplan.geo.frame import GeoPoint, LocalFrame
from gcs_windplan.mission.commands import Command, Frame, plain_frame
from gcs_windplan.mission.items import MissionItem, MissionItems
from gcs_windplan.mission.kept import float_text
from gcs_windplan.mission.lint.finding import TAKEOFFS, Findings, Firmware, FirmwareFinding, named, numbered
from gcs_windplan.mission.supported import PX4_WITH_PLACE, PX4_WITHOUT_PLACE

#: MissionBlock::item_contains_position
POSITIONS = frozenset(
    (
        Command.NAV_WAYPOINT,
        Command.NAV_LOITER_UNLIM,
        Command.NAV_LOITER_TIME,
        Command.NAV_LAND,
        Command.NAV_TAKEOFF,
        Command.NAV_LOITER_TO_ALT,
        Command.NAV_VTOL_TAKEOFF,
        Command.NAV_VTOL_LAND,
    )
)
# checkTakeoff: what may stand before a take-off is written there as a list of what is no waypoint, which lacks these
_NO_LESS_THAN_WAYPOINTS = frozenset(
    (
        *POSITIONS,
        Command.NAV_RETURN_TO_LAUNCH,
        Command.CONDITION_DELAY,
        Command.CONDITION_DISTANCE,
        mavlink.MAV_CMD_CONDITION_GATE,
        mavlink.MAV_CMD_DO_WINCH,
        mavlink.MAV_CMD_DO_GRIPPER,
    )
)
_FIRST_FAR = 900.0  # [m] mission_params.c, MIS_DIST_1WP of older releases; 10 km and a warning only in newer ones
_GATE_APART = 0.05  # [m] checkDistancesBetweenWaypoints
_EPSILON = 1.1920929e-07  # [m] FLT_EPSILON


def feasibility(mission: MissionItems, firmware: Firmware) -> Findings:
    """Take-off first and above home, the first waypoint near home, nothing below home, gates apart."""
    if firmware.autopilot != "px4":
        return
    yield from _takeoffs(mission)
    yield from _first_waypoint(mission)
    yield from _gates(mission)
    for number, item in numbered(mission):
        height = above_home(item, mission)
        if item.command in POSITIONS and item.command not in TAKEOFFS and height is not None and height < 0:
            fact = "PX4 warns of waypoints below home"
            yield FirmwareFinding(
                "below-home", "warned", number, fact, f"{-height:.2f} m below", "compare it with the terrain"
            )


def above_home(item: MissionItem, mission: MissionItems) -> float | None:
    """An item's altitude above home [m], None where home is not known, or the frame another."""
    frame = plain_frame(item.frame)
    if frame == Frame.GLOBAL_RELATIVE_ALT:
        return item.altitude
    if frame != Frame.GLOBAL or mission.home is None:
        return None
    return item.altitude - mission.home.altitude


def apart(one: MissionItem, other: MissionItem) -> float:
    """How far two items are from each other [m], level."""
    frame = LocalFrame(GeoPoint(one.latitude_deg, one.longitude_deg))
    return math.hypot(*frame.to_local(other.latitude_deg, other.longitude_deg)[0])


def _takeoffs(mission: MissionItems) -> Findings:
    first: int | None = None
    for number, item in numbered(mission):
        if item.command in TAKEOFFS:
            if first is not None:
                before = f"item {first} is {named(mission.items[first - 1])}"
                fact = "PX4 flies no mission with a take-off behind another item to fly to"
                yield FirmwareFinding("takeoff-not-first", "rejected", number, fact, before, "put the take-off first")
            height = above_home(item, mission)
            if height is not None and height < _EPSILON:
                fact = "PX4 flies no mission whose take-off does not end above home"
                low = f"{float_text(height)} m above home"
                yield FirmwareFinding("takeoff-too-low", "rejected", number, fact, low, "raise it")
        if first is None and _counts_as_waypoint(item):
            first = number


def _counts_as_waypoint(item: MissionItem) -> bool:
    known = item.command in PX4_WITH_PLACE | PX4_WITHOUT_PLACE
    return known and item.command in _NO_LESS_THAN_WAYPOINTS


def _first_waypoint(mission: MissionItems) -> Findings:
    placed = [(number, item) for number, item in numbered(mission) if item.command in POSITIONS and item.has_place]
    if not placed or mission.home is None:
        return
    number, item = placed[0]
    east, north = LocalFrame(mission.home.point).to_local(item.latitude_deg, item.longitude_deg)[0]
    distance = math.hypot(east, north)
    if distance > _FIRST_FAR:
        fact = (
            "PX4 takes a first waypoint far from home for a mission of another place (MIS_DIST_1WP): beyond 900 m "
            "older releases do not fly it, beyond 10 km newer ones warn"
        )
        yield FirmwareFinding(
            "first-waypoint-far", "warned", number, fact, f"{distance:.0f} m", "raise MIS_DIST_1WP if that is meant"
        )


def _gates(mission: MissionItems) -> Findings:
    gate = mavlink.MAV_CMD_CONDITION_GATE
    placed = [pair for pair in numbered(mission) if pair[1].command in POSITIONS | {gate} and pair[1].has_place]
    for (_, before), (number, item) in itertools.pairwise(placed):
        if gate in (before.command, item.command) and apart(before, item) < _GATE_APART:
            fact = f"PX4 flies no mission with a gate nearer than {_GATE_APART} m to a waypoint"
            distance = f"{apart(before, item):.3f} m"
            yield FirmwareFinding("gate-too-close", "rejected", number, fact, distance, "move the gate")
