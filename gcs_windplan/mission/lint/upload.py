"""What a firmware refuses while a mission is uploaded: commands, frames, parameters, the number of items."""

from __future__ import annotations

import math

from pymavlink.dialects.v20 import ardupilotmega as mavlink

from gcs_windplan.mission.commands import Command, Frame, frame_name, is_global, plain_frame, takes_place
from gcs_windplan.mission.items import MissionItem, MissionItems
from gcs_windplan.mission.kept import float_text
from gcs_windplan.mission.lint.finding import Findings, Firmware, FirmwareFinding, named, numbered
from gcs_windplan.mission.supported import (
    ARDUCOPTER_CAPACITY,
    ARDUPILOT_HIGHEST,
    ARDUPILOT_NAN_ALLOWED,
    ARDUPILOT_STORES_PLACE,
    ARDUPLANE_CAPACITY,
    PX4_CAPACITY,
    PX4_WITH_PLACE,
    PX4_WITHOUT_PLACE,
    ardupilot_takes,
    ardupilot_takes_frame,
    px4_takes_frame,
)

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
        yield from _px4(number, item) if firmware.autopilot == "px4" else _ardupilot(number, item, firmware)


def _capacity(mission: MissionItems, firmware: Firmware) -> Findings:
    if firmware.autopilot == "px4":
        most, what = PX4_CAPACITY, "items"  # navigation.h
    else:  # StorageManager.cpp; AP_Mission.cpp, num_commands_max
        plane = firmware.vehicle_type == "fixed-wing"
        most, what = (ARDUPLANE_CAPACITY if plane else ARDUCOPTER_CAPACITY) - 1, "items beside home"
    if len(mission.items) > most:
        fact = f"{firmware.name} has room for {most} {what} on common boards and refuses more"
        yield FirmwareFinding("capacity", "rejected", None, fact, f"{len(mission.items)} items", "split the mission")


def _unsupported(number: int, item: MissionItem, firmware: str) -> FirmwareFinding:
    advice = _INSTEAD.get(item.command, _REMOVE)
    return FirmwareFinding(
        "command-unsupported", "rejected", number, f"{firmware} takes no {named(item)} ({item.command})", "", advice
    )


def _px4(number: int, item: MissionItem) -> Findings:
    """mavlink_mission.cpp, parse_mavlink_mission_item: the frame first, then what is known in it."""
    if not px4_takes_frame(item.frame):
        fact = f"PX4 takes no item in frame {frame_name(item.frame)} ({item.frame})"
        terrain = plain_frame(item.frame) == Frame.GLOBAL_TERRAIN_ALT
        advice = "give altitudes above home (frame 3) or sea level (0)" if terrain else "use frame 0, 2 or 3"
        yield FirmwareFinding("frame-unsupported", "rejected", number, fact, "", advice)
        return
    if item.command not in PX4_WITH_PLACE | PX4_WITHOUT_PLACE:
        yield _unsupported(number, item, "PX4")
    elif is_global(item.frame) and item.command not in PX4_WITH_PLACE:
        fact = f"PX4 takes {named(item)} in frame MISSION (2) only"
        by_push = "" if takes_place(item.command) else ", as push does by itself"
        where = f"it is in {frame_name(item.frame)}"
        yield FirmwareFinding("frame-mission-needed", "rejected", number, fact, where, f"give it frame 2{by_push}")
    elif item.frame == Frame.MISSION and item.command not in PX4_WITHOUT_PLACE:
        fact = f"PX4 takes no {named(item)} in frame MISSION (2), which has no place"
        yield FirmwareFinding("place-frame-needed", "rejected", number, fact, "", "give it frame 0 or 3")
    elif item.command == Command.DO_SET_ROI:
        yield from _px4_interest(number, item)


def _px4_interest(number: int, item: MissionItem) -> Findings:
    kinds = (0, 3) if is_global(item.frame) else (0, 1, 2)  # MAV_ROI: none, location; none, next, by index
    kind = item.params[0]
    if math.isnan(kind) or int(kind) not in kinds:
        frame = frame_name(item.frame)
        fact = f"PX4 takes DO_SET_ROI in frame {frame} with parameter 1 of {', '.join(map(str, kinds))} only"
        yield FirmwareFinding(
            "interest-kind", "rejected", number, fact, f"it is {kind:g}", "make it a DO_SET_ROI_LOCATION"
        )


def _ardupilot(number: int, item: MissionItem, firmware: Firmware) -> Findings:
    """AP_Mission.cpp, mavlink_int_to_mission_cmd and sanity_check_params."""
    if not ardupilot_takes(item.command):
        yield _unsupported(number, item, firmware.name)
        return
    allowed = ARDUPILOT_NAN_ALLOWED.get(item.command, ())
    empty = [str(i) for i, param in enumerate(item.params, start=1) if math.isnan(param) and i not in allowed]
    if empty:
        fact = f"{firmware.name} takes no NaN in {named(item)}"
        numbers = f"parameter{'s' if len(empty) > 1 else ''} {', '.join(empty)}"
        yield FirmwareFinding("parameter-nan", "rejected", number, fact, numbers, "write 0")
    if any(abs(param) > _LARGEST_FLOAT for param in item.params):
        fact = "a parameter is too large for MAVLink's floats, which makes it infinite"
        yield FirmwareFinding("parameter-infinite", "rejected", number, fact, "", "write a smaller number")
    if not ardupilot_takes_frame(item.command, item.frame):
        fact = f"{firmware.name} takes no place in frame {frame_name(item.frame)} ({item.frame})"
        yield FirmwareFinding("frame-unsupported", "rejected", number, fact, "", "use frame 0, 3 or 10")
    if item.command in ARDUPILOT_STORES_PLACE and not abs(item.altitude) < ARDUPILOT_HIGHEST:
        fact = f"{firmware.name} takes altitudes below {ARDUPILOT_HIGHEST:.0f} m only"
        number_text = f"{float_text(item.altitude)} m"
        yield FirmwareFinding("altitude-too-large", "rejected", number, fact, number_text, "write metres")
