"""What each firmware keeps of a command's four parameters.

By AP_Mission.cpp (mission_cmd_to_mavlink_int), the fence's and rally points' parts of ArduPilot's mission protocol,
and PX4's mavlink_mission.cpp (parse and format); ArduPilot's waypoints, speeds and jumps were measured too.
A command's parameters are written as four letters, one each:

    f  as a float of 32 bits     i  as a whole number, cut
    y  as a yaw, modulo 360°     s  its sign only              b  above zero or not
    -  not kept                  ?  as something like it
    u  in one of the ways above: the command is not listed
"""

from __future__ import annotations

import math
import struct
from collections.abc import Callable
from typing import Literal, TypeAlias

from gcs_windplan.mission import Command, takes_place
from gcs_windplan.vehicle import Autopilot, VehicleType

Fate: TypeAlias = Literal["same", "lost", "differs"]
"""What became of a number: it came back, or as little of it as the firmware keeps, or another came back."""

Rule: TypeAlias = Callable[[float, float], Fate]
"""The fate of a number, from what was sent and what is held."""

_YAW = 1e-3  # [deg] of a float of 32 bits in radians

_ARDUPILOT: dict[int, str] = {
    Command.NAV_WAYPOINT: "i---",
    Command.NAV_LOITER_UNLIM: "--i-",
    Command.NAV_LOITER_TURNS: "?-?b",
    Command.NAV_LOITER_TIME: "i-sb",
    Command.NAV_RETURN_TO_LAUNCH: "----",
    Command.NAV_LAND: "i--?",
    Command.NAV_TAKEOFF: "i---",
    Command.NAV_CONTINUE_AND_CHANGE_ALT: "i---",
    Command.NAV_LOITER_TO_ALT: "-i-b",
    Command.NAV_SPLINE_WAYPOINT: "i---",
    Command.NAV_DELAY: "fiii",
    Command.NAV_PAYLOAD_PLACE: "?---",
    Command.NAV_VTOL_TAKEOFF: "----",
    Command.NAV_VTOL_LAND: "?-?-",
    Command.CONDITION_DELAY: "f---",
    Command.CONDITION_DISTANCE: "f---",
    Command.CONDITION_YAW: "ffib",
    Command.DO_JUMP: "ii--",
    Command.DO_CHANGE_SPEED: "iff-",
    Command.DO_SET_HOME: "i---",
    Command.DO_LAND_START: "----",
    Command.DO_SET_ROI_LOCATION: "----",
    Command.DO_SET_ROI_NONE: "----",
    Command.DO_SET_ROI: "i---",
    Command.DO_SET_CAM_TRIGG_DIST: "f-?-",
    Command.DO_VTOL_TRANSITION: "i---",
    Command.JUMP_TAG: "i---",
    Command.DO_JUMP_TAG: "ii--",
    Command.NAV_FENCE_RETURN_POINT: "----",
    Command.NAV_FENCE_POLYGON_VERTEX_INCLUSION: "i---",
    Command.NAV_FENCE_POLYGON_VERTEX_EXCLUSION: "i---",
    Command.NAV_FENCE_CIRCLE_INCLUSION: "f---",
    Command.NAV_FENCE_CIRCLE_EXCLUSION: "f---",
    Command.NAV_RALLY_POINT: "----",
}
_ARDUPLANE = {**_ARDUPILOT, Command.NAV_WAYPOINT: "-ii-"}
_PX4: dict[int, str] = {
    Command.NAV_WAYPOINT: "ff-y",
    Command.NAV_LOITER_UNLIM: "--fy",
    Command.NAV_LOITER_TIME: "fbf?",
    Command.NAV_LAND: "-i-y",
    Command.NAV_TAKEOFF: "---y",
    Command.NAV_LOITER_TO_ALT: "bf-b",
    Command.NAV_VTOL_TAKEOFF: "---y",
    Command.NAV_VTOL_LAND: "---y",
    Command.DO_SET_ROI_LOCATION: "----",
    Command.NAV_FENCE_RETURN_POINT: "----",
    Command.NAV_FENCE_POLYGON_VERTEX_INCLUSION: "i---",
    Command.NAV_FENCE_POLYGON_VERTEX_EXCLUSION: "i---",
    Command.NAV_FENCE_CIRCLE_INCLUSION: "f---",
    Command.NAV_FENCE_CIRCLE_EXCLUSION: "f---",
    Command.NAV_RALLY_POINT: "----",
}


def parameter_rules(command: int, autopilot: Autopilot | None, vehicle_type: VehicleType | None) -> tuple[Rule, ...]:
    """The rules of a command's four parameters; an autopilot of None keeps all as floats of 32 bits."""
    return tuple(_RULES[letter] for letter in _letters(command, autopilot, vehicle_type))


def _letters(command: int, autopilot: Autopilot | None, vehicle_type: VehicleType | None) -> str:
    if autopilot == "ardupilot":
        return (_ARDUPLANE if vehicle_type == "fixed-wing" else _ARDUPILOT).get(command, "uuuu")
    if autopilot == "px4":
        return _PX4.get(command, "uuuu" if takes_place(command) else "ffff")
    return "ffff"


def float_rule(sent: float, held: float) -> Fate:
    """Kept as a float of 32 bits."""
    return "same" if same_float(sent, held) else "differs"


def _rule_whole(sent: float, held: float) -> Fate:
    if same_float(sent, held):
        return "same"
    return "lost" if math.isfinite(sent) and held == math.trunc(sent) else "differs"


def _rule_dropped(sent: float, held: float) -> Fate:
    if same_float(sent, held) or (math.isnan(sent) and held == 0):
        return "same"
    return "lost" if held == 0 else "differs"


def unlisted_rule(sent: float, held: float) -> Fate:
    """Kept, cut to a whole number or not kept: nobody knows."""
    whole = _rule_whole(sent, held)
    return whole if whole != "differs" else _rule_dropped(sent, held)


def _rule_about(sent: float, held: float) -> Fate:
    return "same" if same_float(sent, held) else "lost"


def _rule_above_zero(sent: float, held: float) -> Fate:
    if same_float(sent, held):
        return "same"
    return "lost" if (sent > 0) == (held > 0) else "differs"


def _rule_sign(sent: float, held: float) -> Fate:
    if same_float(sent, held):
        return "same"
    return "lost" if sent == 0 or (sent < 0) == (held < 0) else "differs"


def _rule_yaw(sent: float, held: float) -> Fate:
    if same_float(sent, held):
        return "same"
    apart = abs((sent - held + 180) % 360 - 180)  # NaN stays NaN
    return "same" if apart < _YAW else "differs"


_RULES: dict[str, Rule] = {
    "f": float_rule,
    "i": _rule_whole,
    "y": _rule_yaw,
    "s": _rule_sign,
    "b": _rule_above_zero,
    "-": _rule_dropped,
    "?": _rule_about,
    "u": unlisted_rule,
}


def _single(number: float) -> float:
    """The number as a float of 32 bits."""
    return float(struct.unpack("<f", struct.pack("<f", number))[0])


def same_float(one: float, other: float) -> bool:
    """Whether both are the same float of 32 bits, or both NaN."""
    return (math.isnan(one) and math.isnan(other)) or _single(one) == _single(other)
