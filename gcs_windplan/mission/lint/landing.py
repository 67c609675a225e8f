"""What a firmware asks of the landing of a fixed-wing before it flies a mission.

By PX4's FeasibilityChecker.cpp (checkLandPatternValidity, checkFixedWindLandApproach, checkTakeoffLandAvailable).
"""

from __future__ import annotations

import math

from gcs_windplan.mission.commands import LANDINGS, Command
from gcs_windplan.mission.firmware import Feasibility, Firmware
from gcs_windplan.mission.items import MissionItem
from gcs_windplan.mission.lint.feasibility import above_home, apart
from gcs_windplan.mission.lint.finding import Findings, FirmwareFinding, any_of, named, numbered
from gcs_windplan.mission.mission_items import MissionItems

_APPROACHES = (Command.NAV_WAYPOINT, Command.NAV_LOITER_TO_ALT)


def landing(mission: MissionItems, firmware: Firmware) -> Findings:
    """Landings that are refused in flight, most of them of fixed-wings."""
    rules = firmware.feasibility
    if rules is None:
        return
    if mission.items and mission.items[0].command in LANDINGS:  # on the ground, multicopters too
        fact = f"{firmware.name} flies no mission that begins with a landing"
        yield FirmwareFinding("landing-first", "rejected", 1, fact, "", "begin with a take-off")
    if firmware.vehicle_type == "fixed-wing":
        yield from _pattern(mission, rules, firmware)
        for number, item in numbered(mission):
            if item.command == Command.NAV_LAND and number > 1:
                yield from _approach(number, mission, rules, firmware)


def _pattern(mission: MissionItems, rules: Feasibility, firmware: Firmware) -> Findings:
    starts = [number for number, item in numbered(mission) if item.command == Command.DO_LAND_START]
    landings = [number for number, item in numbered(mission) if item.command in LANDINGS]
    if rules.landing_required and mission.items and not any_of(mission.items, LANDINGS):
        fact = (
            f"{firmware.name} flies no fixed-wing mission without a landing (MIS_TKO_LAND_REQ 2, the default of planes)"
        )
        yield FirmwareFinding("landing-missing", "rejected", None, fact, "", "add a landing, or set the parameter to 0")
    for number in starts[1:]:
        fact = f"{firmware.name} flies no mission with more than one DO_LAND_START"
        yield FirmwareFinding("land-start-twice", "rejected", number, fact, f"{len(starts)} of them", "keep one")
    if starts and starts[0] >= max(landings, default=0):
        fact = f"{firmware.name} flies no mission whose DO_LAND_START has no landing behind it"
        yield FirmwareFinding(
            "land-start-alone", "rejected", starts[0], fact, "", "put it before the landing's approach"
        )
    for number, item in numbered(mission):
        if item.command == Command.NAV_RETURN_TO_LAUNCH and starts and starts[0] < number:
            fact = f"{firmware.name} flies no mission with NAV_RETURN_TO_LAUNCH behind DO_LAND_START"
            before = f"DO_LAND_START is item {starts[0]}"
            yield FirmwareFinding("land-start-before-return", "rejected", number, fact, before, "remove one of them")


def _approach(number: int, mission: MissionItems, rules: Feasibility, firmware: Firmware) -> Findings:
    before, item = mission.items[number - 2], mission.items[number - 1]
    if before.command not in rules.positions:
        return
    if before.command not in _APPROACHES:
        fact = f"{firmware.name} flies no fixed-wing landing whose approach is no NAV_WAYPOINT or NAV_LOITER_TO_ALT"
        yield FirmwareFinding("approach-kind", "rejected", number, fact, named(before), "put a waypoint between")
        return
    top, ground = above_home(before, mission), above_home(item, mission)
    if before.frame == item.frame:
        top, ground = before.altitude, item.altitude
    if top is None or ground is None:
        return  # home is not known
    if top <= ground:
        fact = f"{firmware.name} flies no fixed-wing landing whose approach is not above it"
        low = f"{ground - top:.1f} m below" if top < ground else "as high as it"
        yield FirmwareFinding("approach-below", "rejected", number, fact, low, f"raise item {number - 1}")
        return
    yield from _slope(number, (before, item), top - ground, rules, firmware)


def _slope(
    number: int, ends: tuple[MissionItem, MissionItem], height: float, rules: Feasibility, firmware: Firmware
) -> Findings:
    before, item = ends
    distance = apart(before, item)
    if before.command == Command.NAV_LOITER_TO_ALT:
        radius = abs(before.params[1])
        if distance <= radius:
            fact = f"{firmware.name} flies no fixed-wing landing inside the circle of its approach"
            inside = f"{distance:.0f} m from the middle, radius {radius:g} m"
            yield FirmwareFinding("approach-circle", "rejected", number, fact, inside, "move the landing out")
            return
        distance = math.sqrt(distance**2 - radius**2)
    steepest = math.tan(math.radians(rules.steepest_approach + rules.approach_lenience))
    if height > steepest * distance:
        slope = math.degrees(math.atan2(height, distance))
        allowed = f"{rules.steepest_approach:g}° (FW_LND_ANG, by default)"
        fact = f"{firmware.name} flies no fixed-wing landing steeper than {allowed}"
        number_text = f"{slope:.1f}°, {height:.0f} m in {distance:.0f} m"
        advice = f"approach from {math.ceil(height / steepest)} m away, or {steepest * distance:.0f} m above it"
        yield FirmwareFinding("approach-steep", "rejected", number, fact, number_text, advice)
