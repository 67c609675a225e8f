"""DO_JUMP: where it leads, and how often."""

from __future__ import annotations

import math

from gcs_windplan.mission.commands import Command
from gcs_windplan.mission.firmware import Firmware
from gcs_windplan.mission.items import MissionItem
from gcs_windplan.mission.lint.finding import Findings, FirmwareFinding, numbered
from gcs_windplan.mission.mission_items import MissionItems


def jumps(mission: MissionItems, firmware: Firmware) -> Findings:
    """Jumps that lead nowhere, are never or always taken, or count otherwise than the file does."""
    taken = [(number, item) for number, item in numbered(mission) if item.command == Command.DO_JUMP]
    for number, item in taken:
        yield from _target(number, item, len(mission.items), firmware)
        yield from _count(number, item, firmware)
    if firmware.jumps.tracked is not None:
        yield from _too_many(taken, firmware.jumps.tracked, firmware)


def target_of(item: MissionItem) -> int:
    """The item that a DO_JUMP leads to, as it is cut to a whole number; 0, which is none, for NaN."""
    return 0 if math.isnan(item.params[0]) else int(item.params[0])


def is_never_taken(item: MissionItem) -> bool:
    """Whether a DO_JUMP is ignored: its count is 0 (AP_Mission.cpp, get_next_cmd; PX4 mission_base.cpp)."""
    return math.isnan(item.params[1]) or int(item.params[1]) == 0


def repeats_forever(item: MissionItem, firmware: Firmware) -> bool:
    """Whether a DO_JUMP is always taken."""
    return not is_never_taken(item) and int(item.params[1]) == firmware.jumps.forever


def _target(number: int, item: MissionItem, last: int, firmware: Firmware) -> Findings:
    """MissionItemProtocol_Waypoints.cpp answers ERROR; PX4 takes such a mission and breaks it off at the jump."""
    target = target_of(item)
    if not 1 <= target <= last:
        where = "home" if target == 0 else f"item {item.params[0]:g} of {last}"
        fact = f"{firmware.name} takes no DO_JUMP that leads to home or beyond the last item"
        yield FirmwareFinding("jump-target", "rejected", number, fact, where, f"jump to one of items 1 to {last}")
    elif firmware.jumps.first == 0:
        fact = (
            f"{firmware.name} counts items from 0, and home is none: a DO_JUMP leads one item too far if sent as it is"
        )
        change = f"item {target} must be sent as {target - 1}"
        yield FirmwareFinding("jump-shift", "changed", number, fact, change, "push counts right")


def _count(number: int, item: MissionItem, firmware: Firmware) -> Findings:
    count = item.params[1]
    if is_never_taken(item):
        fact = f"{firmware.name} ignores a DO_JUMP with a count of 0"
        yield FirmwareFinding("jump-never", "ignored", number, fact, "", "give parameter 2 a count")
    elif firmware.jumps.forever is None and count < 0:  # an uint16_t
        fact = f"{firmware.name} has no endless count: below 0 it becomes 0 or 65535, by processor"
        yield FirmwareFinding("jump-count", "changed", number, fact, f"count {count:g}", "write a number")
    elif count < 0 and int(count) != firmware.jumps.forever:
        fact = f"{firmware.name} ignores a DO_JUMP with a count below {firmware.jumps.forever}"
        yield FirmwareFinding(
            "jump-never",
            "ignored",
            number,
            fact,
            f"count {count:g}",
            f"write {firmware.jumps.forever} for an endless one",
        )


def _too_many(taken: list[tuple[int, MissionItem]], tracked: int, firmware: Firmware) -> Findings:
    counted = [number for number, item in taken if not repeats_forever(item, firmware)]
    for number in counted[tracked:]:
        fact = f"{firmware.name} ignores DO_JUMPs after the first {tracked} on boards with less than 500 kB of memory"
        yield FirmwareFinding("jump-too-many", "ignored", number, fact, f"{len(counted)} of them", "split the mission")
