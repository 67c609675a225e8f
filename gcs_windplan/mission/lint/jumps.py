"""DO_JUMP: where it leads, and how often."""

from __future__ import annotations

import math

from gcs_windplan.mission.commands import Command
from gcs_windplan.mission.items import MissionItem, MissionItems
from gcs_windplan.mission.lint.finding import Findings, Firmware, FirmwareFinding, numbered

_TRACKED = 15  # AP_Mission.h, AP_MISSION_MAX_NUM_DO_JUMP_COMMANDS on boards with less than 500 kB of memory
_FOREVER = -1.0  # AP_Mission.h, AP_MISSION_JUMP_REPEAT_FOREVER


def jumps(mission: MissionItems, firmware: Firmware) -> Findings:
    """Jumps that lead nowhere, are never or always taken, or count otherwise than the file does."""
    taken = [(number, item) for number, item in numbered(mission) if item.command == Command.DO_JUMP]
    for number, item in taken:
        yield from _target(number, item, len(mission.items), firmware)
        yield from _count(number, item, firmware)
    if firmware.autopilot == "ardupilot":
        yield from _too_many(taken, firmware)


def target_of(item: MissionItem) -> int:
    """The item that a DO_JUMP leads to, as it is cut to a whole number; 0, which is none, for NaN."""
    return 0 if math.isnan(item.params[0]) else int(item.params[0])


def is_never_taken(item: MissionItem) -> bool:
    """Whether a DO_JUMP is passed over: its count is 0 (AP_Mission.cpp, get_next_cmd; PX4 mission_base.cpp)."""
    return math.isnan(item.params[1]) or int(item.params[1]) == 0


def repeats_forever(item: MissionItem, firmware: Firmware) -> bool:
    """Whether a DO_JUMP is always taken; PX4 knows no such count."""
    return firmware.autopilot == "ardupilot" and not is_never_taken(item) and int(item.params[1]) == _FOREVER


def _target(number: int, item: MissionItem, last: int, firmware: Firmware) -> Findings:
    """MissionItemProtocol_Waypoints.cpp answers ERROR; PX4 takes such a mission and breaks it off at the jump."""
    target = target_of(item)
    if not 1 <= target <= last:
        where = "home" if target == 0 else f"item {item.params[0]:g} of {last}"
        fact = f"{firmware.name} takes no DO_JUMP that leads to home or beyond the last item"
        yield FirmwareFinding("jump-target", "rejected", number, fact, where, f"jump to one of items 1 to {last}")
    elif firmware.autopilot == "px4":
        fact = "PX4 counts items from 0, and home is none: a DO_JUMP leads one item too far if sent as it is"
        change = f"item {target} must be sent as {target - 1}"
        yield FirmwareFinding("jump-shift", "changed", number, fact, change, "push counts right")


def _count(number: int, item: MissionItem, firmware: Firmware) -> Findings:
    count = item.params[1]
    if is_never_taken(item):
        fact = f"{firmware.name} passes over a DO_JUMP with a count of 0"
        yield FirmwareFinding("jump-never", "ignored", number, fact, "", "give parameter 2 a count")
    elif firmware.autopilot == "px4" and count < 0:  # navigation.h: uint16_t do_jump_repeat_count
        fact = "PX4 has no count for ever: below 0 it becomes 0 or 65535, by processor"
        yield FirmwareFinding("jump-count", "changed", number, fact, f"count {count:g}", "write a number")
    elif firmware.autopilot == "ardupilot" and count < 0 and int(count) != _FOREVER:
        fact = f"{firmware.name} passes over a DO_JUMP with a count below -1"
        yield FirmwareFinding("jump-never", "ignored", number, fact, f"count {count:g}", "write -1 for: for ever")


def _too_many(taken: list[tuple[int, MissionItem]], firmware: Firmware) -> Findings:
    counted = [number for number, item in taken if not repeats_forever(item, firmware)]
    for number in counted[_TRACKED:]:
        fact = (
            f"{firmware.name} passes over DO_JUMPs after the first {_TRACKED} on boards with less than 500 kB of memory"
        )
        yield FirmwareFinding("jump-too-many", "ignored", number, fact, f"{len(counted)} of them", "split the mission")
