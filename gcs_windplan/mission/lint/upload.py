"""What a firmware refuses while a mission is uploaded: commands, frames, parameters, the number of items."""

from __future__ import annotations

import math

from pymavlink.dialects.v20 import ardupilotmega as mavlink

from gcs_windplan.mission.commands import Command, Frame, frame_name, is_global, plain_frame, takes_place
from gcs_windplan.mission.firmware import CommandRule, Firmware
from gcs_windplan.mission.firmware.floats import float_text
from gcs_windplan.mission.items import MissionItem
from gcs_windplan.mission.lint.finding import Findings, FirmwareFinding, named, numbered
from gcs_windplan.mission.mission_items import MissionItems

_REMOVE = "remove the item"
_INSTEAD: dict[int, str] = {
    Command.NAV_SPLINE_WAYPOINT: "make it a NAV_WAYPOINT",
    Command.NAV_LOITER_TURNS: "make it a NAV_LOITER_TIME",
    Command.CONDITION_YAW: "give the heading as parameter 4 of the waypoint",
    mavlink.MAV_CMD_DO_SET_SERVO: "make it a DO_SET_ACTUATOR",
    Command.NAV_RALLY_POINT: "rally points travel apart from the mission",
}
_LARGEST_FLOAT = 3.4028235e38  # IEEE 754 binary32


def upload(mission: MissionItems, firmware: Firmware) -> Findings:
    """Everything that makes the vehicle answer an upload with a no."""
    yield from _capacity(mission, firmware)
    for number, item in numbered(mission):
        refused = list(_refused(number, item, firmware))
        yield from refused
        rule = firmware.rule(item.command, item.frame)
        if rule is not None and not refused:
            yield from _numbers(number, item, rule, firmware)


def _capacity(mission: MissionItems, firmware: Firmware) -> Findings:
    home = firmware.transfers.home_item
    most, what = firmware.capacity["mission"] - home, "items beside home" if home else "items"
    if len(mission.items) > most:
        fact = f"{firmware.name} has room for {most} {what} on common boards and refuses more"
        yield FirmwareFinding("capacity", "rejected", None, fact, f"{len(mission.items)} items", "split the mission")


def _refused(number: int, item: MissionItem, firmware: Firmware) -> Findings:
    """Whether command and frame are taken; PX4 looks at the frame first, then for the command in it."""
    name, frame = firmware.name, frame_name(item.frame)
    takes_frame = firmware.takes_frame(item.command, item.frame)
    if firmware.transfers.frame_first and not takes_frame:
        fact = f"{name} takes no item in frame {frame} ({item.frame})"
        terrain = plain_frame(item.frame) == Frame.GLOBAL_TERRAIN_ALT
        advice = "give altitudes above home (frame 3) or sea level (0)" if terrain else "use frame 0, 2 or 3"
        yield FirmwareFinding("frame-unsupported", "rejected", number, fact, "", advice)
    elif not firmware.takes(item.command):
        fact, advice = f"{name} takes no {named(item)} ({item.command})", _INSTEAD.get(item.command, _REMOVE)
        yield FirmwareFinding("command-unsupported", "rejected", number, fact, "", advice)
    elif firmware.placeless is not None and is_global(item.frame) and item.command not in firmware.commands:
        by_push = "" if takes_place(item.command) else ", as push does by itself"
        fact, where = f"{name} takes {named(item)} in frame MISSION (2) only", f"it is in {frame}"
        yield FirmwareFinding("frame-mission-needed", "rejected", number, fact, where, f"give it frame 2{by_push}")
    elif firmware.rule(item.command, item.frame) is None:
        fact = f"{name} takes no {named(item)} in frame MISSION (2), which has no place"
        yield FirmwareFinding("place-frame-needed", "rejected", number, fact, "", "give it frame 0 or 3")
    elif not takes_frame:
        fact = f"{name} takes no place in frame {frame} ({item.frame})"
        yield FirmwareFinding("frame-unsupported", "rejected", number, fact, "", "use frame 0, 3 or 10")


def _numbers(number: int, item: MissionItem, rule: CommandRule, firmware: Firmware) -> Findings:
    """Parameters and altitudes that are refused."""
    kind = item.params[0]
    if rule.choices and (math.isnan(kind) or int(kind) not in rule.choices):
        choices = ", ".join(map(str, rule.choices))
        fact = (
            f"{firmware.name} takes {named(item)} in frame {frame_name(item.frame)} with parameter 1 of {choices} only"
        )
        advice = "make it a DO_SET_ROI_LOCATION"
        yield FirmwareFinding("interest-kind", "rejected", number, fact, f"it is {kind:g}", advice)
    if not firmware.checks_numbers:
        return
    empty = [str(i) for i, param in enumerate(item.params, start=1) if math.isnan(param) and i not in rule.nan]
    if empty:
        fact = f"{firmware.name} takes no NaN in {named(item)}"
        numbers = f"parameter{'s' if len(empty) > 1 else ''} {', '.join(empty)}"
        yield FirmwareFinding("parameter-nan", "rejected", number, fact, numbers, "write 0")
    if any(abs(param) > _LARGEST_FLOAT for param in item.params):
        fact = "a parameter is too large for MAVLink's floats, which makes it infinite"
        yield FirmwareFinding("parameter-infinite", "rejected", number, fact, "", "write a smaller number")
    if rule.place and firmware.highest is not None and not abs(item.altitude) < firmware.highest:
        fact = f"{firmware.name} takes altitudes below {firmware.highest:.0f} m only"
        where = f"{float_text(item.altitude)} m"
        yield FirmwareFinding("altitude-too-large", "rejected", number, fact, where, "write metres")
