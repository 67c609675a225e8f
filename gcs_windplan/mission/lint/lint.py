"""All rules of a firmware on one mission."""

from __future__ import annotations

from collections.abc import Callable
from typing import TypeAlias

from gcs_windplan.mission.items import MissionItems
from gcs_windplan.mission.lint.carrying_out import carrying_out
from gcs_windplan.mission.lint.course import course
from gcs_windplan.mission.lint.feasibility import feasibility
from gcs_windplan.mission.lint.finding import EFFECTS, Findings, Firmware, FirmwareFinding
from gcs_windplan.mission.lint.jumps import jumps
from gcs_windplan.mission.lint.landing import landing
from gcs_windplan.mission.lint.parameters import parameters
from gcs_windplan.mission.lint.places import places
from gcs_windplan.mission.lint.upload import upload
from gcs_windplan.vehicle import Autopilot, VehicleType

_Rules: TypeAlias = Callable[[MissionItems, Firmware], Findings]
_AT_UPLOAD: tuple[_Rules, ...] = (upload, jumps)
_AFTERWARDS: tuple[_Rules, ...] = (parameters, places, carrying_out, course, feasibility, landing)
_NUMBERS = ("dropped", "rounded", "changed")
_MENDED = "frame-mission-needed"  # what is sent with the right frame, as `push` does, is kept


def lint(
    mission: MissionItems, autopilot: Autopilot, vehicle_type: VehicleType | None = None
) -> tuple[FirmwareFinding, ...]:
    """What the firmware does to the mission, in the order of its items, the whole mission first.

    Without a vehicle type only what both kinds of vehicles do. Of an item whose upload is refused nothing is said about
    numbers, as none is kept. Rules are those of ArduPilot 4.5 to 4.7 and PX4 1.14 to 1.16, with their default
    parameters.
    """
    if vehicle_type is None:
        return _shared(mission, autopilot)
    return _found(mission, Firmware(autopilot, vehicle_type))


def _found(mission: MissionItems, firmware: Firmware) -> tuple[FirmwareFinding, ...]:
    found = [finding for rules in _AT_UPLOAD for finding in rules(mission, firmware)]
    refused = {one.item for one in found if one.effect == "rejected" and one.rule != _MENDED} - {None}
    found += [finding for rules in _AFTERWARDS for finding in rules(mission, firmware)]
    told = (finding for finding in found if finding.item not in refused or finding.effect not in _NUMBERS)
    return tuple(sorted(told, key=lambda finding: (finding.item or 0, EFFECTS.index(finding.effect))))


def _shared(mission: MissionItems, autopilot: Autopilot) -> tuple[FirmwareFinding, ...]:
    """What multicopters and fixed-wings have in common."""
    types: tuple[VehicleType, VehicleType] = ("multicopter", "fixed-wing")
    kinds = ({_key(found) for found in _found(mission, Firmware(autopilot, kind))} for kind in types)
    common = set.intersection(*kinds)
    return tuple(found for found in _found(mission, Firmware(autopilot)) if _key(found) in common)


def _key(finding: FirmwareFinding) -> tuple[str, str, int | None]:
    return finding.rule, finding.effect, finding.item
