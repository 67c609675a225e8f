"""What a firmware looks at before it flies a mission that it took, for every kind of vehicle.

By PX4's FeasibilityChecker.cpp, the only one that looks so. A distance between waypoints of more than 900 m
(MIS_DIST_WPS) was once refused too; releases since 1.14 have no such limit.
"""

from __future__ import annotations

import itertools
import math

from pymavlink.dialects.v20 import ardupilotmega as mavlink

from gcs_windplan.geo.frame import GeoPoint, LocalFrame
from gcs_windplan.mission.commands import TAKEOFFS, Frame, plain_frame
from gcs_windplan.mission.firmware import Feasibility, Firmware
from gcs_windplan.mission.firmware.floats import float_text
from gcs_windplan.mission.items import MissionItem
from gcs_windplan.mission.lint.finding import Findings, FirmwareFinding, named, numbered
from gcs_windplan.mission.mission_items import MissionItems

_EPSILON = 1.1920929e-07  # [m] FLT_EPSILON


def feasibility(mission: MissionItems, firmware: Firmware) -> Findings:
    """Take-off first and above home, the first waypoint near home, nothing below home, gates apart."""
    rules = firmware.feasibility
    if rules is None:
        return
    yield from _takeoffs(mission, rules, firmware)
    yield from _first_waypoint(mission, rules, firmware)
    yield from _gates(mission, rules, firmware)
    for number, item in numbered(mission):
        height = above_home(item, mission)
        if item.command in rules.positions and item.command not in TAKEOFFS and height is not None and height < 0:
            fact = f"{firmware.name} warns of waypoints below home"
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


def _takeoffs(mission: MissionItems, rules: Feasibility, firmware: Firmware) -> Findings:
    first: int | None = None
    for number, item in numbered(mission):
        if item.command in TAKEOFFS:
            if first is not None:
                before = f"item {first} is {named(mission.items[first - 1])}"
                fact = f"{firmware.name} flies no mission with a take-off behind another item to fly to"
                yield FirmwareFinding("takeoff-not-first", "rejected", number, fact, before, "put the take-off first")
            height = above_home(item, mission)
            if height is not None and height < _EPSILON:
                fact = f"{firmware.name} flies no mission whose take-off does not end above home"
                low = f"{float_text(height)} m above home"
                yield FirmwareFinding("takeoff-too-low", "rejected", number, fact, low, "raise it")
        if first is None and item.command in rules.waypoints and firmware.takes(item.command):
            first = number


def _first_waypoint(mission: MissionItems, rules: Feasibility, firmware: Firmware) -> Findings:
    placed = [
        (number, item) for number, item in numbered(mission) if item.command in rules.positions and item.has_place
    ]
    if not placed or mission.home is None:
        return
    number, item = placed[0]
    east, north = LocalFrame(mission.home.point).to_local(item.latitude_deg, item.longitude_deg)[0]
    distance = math.hypot(east, north)
    if distance > rules.first_waypoint:
        fact = (
            f"{firmware.name} takes a first waypoint far from home for a mission of another place (MIS_DIST_1WP): "
            f"beyond {rules.first_waypoint:.0f} m older releases do not fly it, "
            f"beyond {rules.far_first_waypoint / 1000:.0f} km newer ones warn"
        )
        yield FirmwareFinding(
            "first-waypoint-far", "warned", number, fact, f"{distance:.0f} m", "raise MIS_DIST_1WP if that is meant"
        )


def _gates(mission: MissionItems, rules: Feasibility, firmware: Firmware) -> Findings:
    gate = mavlink.MAV_CMD_CONDITION_GATE
    placed = [pair for pair in numbered(mission) if pair[1].command in rules.positions | {gate} and pair[1].has_place]
    for (_, before), (number, item) in itertools.pairwise(placed):
        if gate in (before.command, item.command) and apart(before, item) < rules.gate_apart:
            fact = f"{firmware.name} flies no mission with a gate nearer than {rules.gate_apart} m to a waypoint"
            distance = f"{apart(before, item):.3f} m"
            yield FirmwareFinding("gate-too-close", "rejected", number, fact, distance, "move the gate")
