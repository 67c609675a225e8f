"""What each firmware keeps of a command's seven parameters.

By AP_Mission.cpp (mavlink_int_to_mission_cmd, mission_cmd_to_mavlink_int), the fence's and rally points' parts of
ArduPilot's mission protocol, and PX4's mavlink_mission.cpp (parse and format); ArduPilot's waypoints, speeds and
jumps were measured too. A command's parameters are written as a letter each; those not written are not kept:

    f  as a float of 32 bits     i  as a whole number, cut     c  in hundredths, cut
    w  whole, 0 to 65535         u  whole, 0 to 255            n  whole, -32768 to 32767
    g  whole, 65535 either way   q  whole, at most 255         a  as an altitude in hundredths, with its frame
    y  as a yaw, modulo 360°     s  its sign only, as 1 or -1  b  1 if above zero, else 0
    t  turns of a circle         r  a circle's radius          l  the yaw of a landing
    x  as a yaw or as b          h  as a float of 16 bits      -  not kept

A place (parameters 5 to 7 of a command that takes one) has rules of its own. Of a command that is not listed every
parameter counts: nobody knows what is kept of it.
"""

from __future__ import annotations

import math
import struct
from collections.abc import Callable
from typing import Literal, TypeAlias

from pymavlink.dialects.v20 import ardupilotmega as mavlink

from gcs_windplan.mission.commands import Command
from gcs_windplan.vehicle import Autopilot, VehicleType

Fate: TypeAlias = Literal["same", "trifle", "lost", "differs"]
"""What became of a number: it came back, or all of it that matters, or as little of it as the firmware keeps, or
another came back."""

Rule: TypeAlias = Callable[[float, float], Fate]
"""The fate of a number, from what was sent and what is held."""

CENTIMETRE = 0.01  # [m] ArduPilot's altitudes
_YAW = 1e-3  # [deg] of a float of 32 bits in radians
_TURN = 1 / 256  # ArduPilot's parts of a turn
_SMALL_RADIUS = 255.0  # [m] ArduPilot keeps the radius of turns in metres up to here, in steps of 10 m above
_LARGE_STEP = 10.0  # [m]
BYTE = 255  # AP_Mission.cpp: the most that half of an item's p1 holds

_ARDUPILOT: dict[int, str] = {
    Command.NAV_WAYPOINT: "w---",
    Command.NAV_LOITER_UNLIM: "--g-",
    Command.NAV_LOITER_TURNS: "t-rb",
    Command.NAV_LOITER_TIME: "w-sb",
    Command.NAV_RETURN_TO_LAUNCH: "----",
    Command.NAV_LAND: "w--l",
    Command.NAV_TAKEOFF: "w---",
    Command.NAV_CONTINUE_AND_CHANGE_ALT: "w---iia",
    Command.NAV_LOITER_TO_ALT: "-g-b",
    Command.NAV_SPLINE_WAYPOINT: "w---",
    Command.NAV_DELAY: "fnnn",
    Command.NAV_PAYLOAD_PLACE: "c---",
    Command.NAV_VTOL_TAKEOFF: "----",
    Command.NAV_VTOL_LAND: "w---",
    Command.CONDITION_DELAY: "f---",
    Command.CONDITION_DISTANCE: "f---",
    Command.CONDITION_YAW: "ffnu",
    Command.DO_JUMP: "wn--",
    Command.DO_CHANGE_SPEED: "uff-",
    Command.DO_SET_HOME: "w---",
    Command.DO_LAND_START: "----",
    Command.DO_SET_ROI_LOCATION: "----",
    Command.DO_SET_ROI_NONE: "----",
    Command.DO_SET_ROI: "w---",
    Command.DO_SET_CAM_TRIGG_DIST: "f-i-",
    Command.DO_VTOL_TRANSITION: "i---",
    Command.JUMP_TAG: "w---",
    Command.DO_JUMP_TAG: "wn--",
    Command.NAV_FENCE_RETURN_POINT: "----",
    Command.NAV_FENCE_POLYGON_VERTEX_INCLUSION: "i---",
    Command.NAV_FENCE_POLYGON_VERTEX_EXCLUSION: "i---",
    Command.NAV_FENCE_CIRCLE_INCLUSION: "f---",
    Command.NAV_FENCE_CIRCLE_EXCLUSION: "f---",
    Command.NAV_RALLY_POINT: "----",
    mavlink.MAV_CMD_NAV_ALTITUDE_WAIT: "ffi-",
    mavlink.MAV_CMD_NAV_GUIDED_ENABLE: "w---iia",
    mavlink.MAV_CMD_NAV_SET_YAW_SPEED: "ffi-",
    mavlink.MAV_CMD_NAV_SCRIPT_TIME: "iihhii-",
    mavlink.MAV_CMD_NAV_ATTITUDE_TIME: "iiiif--",
    mavlink.MAV_CMD_DO_SET_MODE: "w---",
    mavlink.MAV_CMD_DO_SET_RELAY: "uu--",
    mavlink.MAV_CMD_DO_REPEAT_RELAY: "unf-",
    mavlink.MAV_CMD_DO_SET_SERVO: "uw--",
    mavlink.MAV_CMD_DO_REPEAT_SERVO: "uwnf",
    mavlink.MAV_CMD_DO_RETURN_PATH_START: "----",
    mavlink.MAV_CMD_DO_GO_AROUND: "----iia",
    mavlink.MAV_CMD_DO_PAUSE_CONTINUE: "w---",
    mavlink.MAV_CMD_DO_SET_REVERSE: "w---",
    mavlink.MAV_CMD_DO_DIGICAM_CONFIGURE: "iiiiiif",
    mavlink.MAV_CMD_DO_DIGICAM_CONTROL: "iiiiii-",
    mavlink.MAV_CMD_DO_MOUNT_CONTROL: "fff-",
    mavlink.MAV_CMD_DO_FENCE_ENABLE: "w---",
    mavlink.MAV_CMD_DO_PARACHUTE: "w---",
    mavlink.MAV_CMD_DO_INVERTED_FLIGHT: "w---",
    mavlink.MAV_CMD_DO_GRIPPER: "uu--",
    mavlink.MAV_CMD_DO_AUTOTUNE_ENABLE: "w---",
    mavlink.MAV_CMD_DO_SET_RESUME_REPEAT_DIST: "w---",
    mavlink.MAV_CMD_DO_SPRAYER: "w---",
    mavlink.MAV_CMD_DO_SEND_SCRIPT_MESSAGE: "ifff",
    mavlink.MAV_CMD_DO_AUX_FUNCTION: "wu--",
    mavlink.MAV_CMD_DO_GUIDED_LIMITS: "wfff",
    mavlink.MAV_CMD_DO_ENGINE_CONTROL: "bbcb",
    mavlink.MAV_CMD_DO_GIMBAL_MANAGER_PITCHYAW: "iiiii-i",
    mavlink.MAV_CMD_IMAGE_START_CAPTURE: "ifii",
    mavlink.MAV_CMD_IMAGE_STOP_CAPTURE: "i---",
    mavlink.MAV_CMD_VIDEO_START_CAPTURE: "i---",
    mavlink.MAV_CMD_VIDEO_STOP_CAPTURE: "i---",
    mavlink.MAV_CMD_SET_CAMERA_ZOOM: "if--",
    mavlink.MAV_CMD_SET_CAMERA_FOCUS: "if--",
    mavlink.MAV_CMD_SET_CAMERA_SOURCE: "iii-",
    mavlink.MAV_CMD_DO_WINCH: "iiff",
}
_ARDUPLANE = {**_ARDUPILOT, Command.NAV_WAYPOINT: "-qq-"}
_PX4: dict[int, str] = {
    Command.NAV_WAYPOINT: "ff-y",
    Command.NAV_LOITER_UNLIM: "--fy",
    Command.NAV_LOITER_TIME: "fbfx",
    Command.NAV_LAND: "-i-y",
    Command.NAV_TAKEOFF: "---y",
    Command.NAV_LOITER_TO_ALT: "bf-b",
    Command.NAV_VTOL_TAKEOFF: "---y",
    Command.NAV_VTOL_LAND: "---y",
    Command.DO_JUMP: "iifffff",
    Command.DO_SET_ROI_LOCATION: "----",
    Command.NAV_FENCE_RETURN_POINT: "----",
    Command.NAV_FENCE_POLYGON_VERTEX_INCLUSION: "i---",
    Command.NAV_FENCE_POLYGON_VERTEX_EXCLUSION: "i---",
    Command.NAV_FENCE_CIRCLE_INCLUSION: "f---",
    Command.NAV_FENCE_CIRCLE_EXCLUSION: "f---",
    Command.NAV_RALLY_POINT: "----",
    mavlink.MAV_CMD_CONDITION_GATE: "----",
}
_LISTS: dict[Autopilot | None, dict[int, str]] = {"ardupilot": _ARDUPILOT, "px4": _PX4}
_EXACT = "fffffff"


def parameter_rules(command: int, autopilot: Autopilot | None, vehicle_type: VehicleType | None) -> tuple[Rule, ...]:
    """The rules of a command's seven parameters; an autopilot of None keeps all as floats of 32 bits."""
    return tuple(_RULES[letter] for letter in parameter_letters(command, autopilot, vehicle_type))


def is_listed(command: int, autopilot: Autopilot | None) -> bool:
    """Whether it is known what the firmware keeps of the command."""
    return command in _LISTS.get(autopilot, {})


def keeps_altitude(command: int, autopilot: Autopilot | None) -> bool:
    """Whether the firmware keeps an altitude and its frame with a command that takes no place."""
    return parameter_letters(command, autopilot, None).endswith("a")


def parameter_letters(command: int, autopilot: Autopilot | None, vehicle_type: VehicleType | None) -> str:
    """The letters of a command's seven parameters."""
    plane = autopilot == "ardupilot" and vehicle_type == "fixed-wing"
    letters = (_ARDUPLANE if plane else _LISTS.get(autopilot, {})).get(command, _EXACT)
    return letters.ljust(len(_EXACT), "-")


def cut_rule(step: float) -> Rule:
    """Kept in whole steps, cut towards zero; the float on the wire may lie just below a step."""

    def rule(sent: float, held: float) -> Fate:
        if same_float(sent, held):
            return "same"
        if not (math.isfinite(sent) and math.isfinite(held)):
            return "differs"
        noise = _float_step(sent)
        in_steps = abs(held - round(held / step) * step) <= noise
        gone = math.copysign(1.0, sent) * (sent - held)
        return "lost" if in_steps and sent * held >= 0 and -noise <= gone < step + noise else "differs"

    return rule


def _rule_altitude(sent: float, held: float) -> Fate:
    fate = cut_rule(CENTIMETRE)(sent, held)
    return "trifle" if fate == "lost" else fate


def _rule_float(sent: float, held: float) -> Fate:
    return "same" if same_float(sent, held) else "differs"


def _rule_half(sent: float, held: float) -> Fate:
    if same_float(sent, held):
        return "same"
    return "lost" if abs(sent - held) <= abs(sent) * 2.0**-10 else "differs"  # NaN compares false


def _rule_whole(sent: float, held: float) -> Fate:
    if same_float(sent, held):
        return "same"
    return "lost" if math.isfinite(sent) and held == math.trunc(sent) else "differs"


def _rule_capped(sent: float, held: float) -> Fate:
    fate = _rule_whole(sent, held)
    return "lost" if fate == "differs" and held == BYTE < sent else fate


def _rule_dropped(sent: float, held: float) -> Fate:
    if same_float(sent, held) or (math.isnan(sent) and held == 0):
        return "same"
    return "lost" if held == 0 else "differs"


def _rule_above_zero(sent: float, held: float) -> Fate:
    if same_float(sent, held):
        return "same"
    return "lost" if held == float(sent > 0) else "differs"


def _rule_sign(sent: float, held: float) -> Fate:
    if same_float(sent, held):
        return "same"
    return "lost" if held == (-1 if sent < 0 else 1) else "differs"


def _rule_turns(sent: float, held: float) -> Fate:
    return "lost" if _rule_whole(sent, held) == "differs" and abs(sent - held) <= _TURN else _rule_whole(sent, held)


def _rule_radius(sent: float, held: float) -> Fate:
    return cut_rule(1.0 if abs(sent) <= _SMALL_RADIUS else _LARGE_STEP)(sent, held)


def _rule_landing_yaw(sent: float, held: float) -> Fate:
    fate = _rule_sign(sent, held)
    return "lost" if fate == "differs" and held == 0 and not sent < 0 else fate  # ArduPilot once kept no sign


def _rule_yaw(sent: float, held: float) -> Fate:
    if same_float(sent, held):
        return "same"
    if not (math.isfinite(sent) and math.isfinite(held)):
        return "differs"
    return "same" if abs((sent - held + 180) % 360 - 180) < _YAW else "differs"


def _rule_yaw_or_above_zero(sent: float, held: float) -> Fate:
    return "same" if _rule_yaw(sent, held) == "same" else _rule_above_zero(sent, held)


_RULES: dict[str, Rule] = {
    "f": _rule_float,
    "h": _rule_half,
    **dict.fromkeys("iwung", _rule_whole),
    "q": _rule_capped,
    "c": cut_rule(CENTIMETRE),
    "a": _rule_altitude,
    "y": _rule_yaw,
    "x": _rule_yaw_or_above_zero,
    "s": _rule_sign,
    "b": _rule_above_zero,
    "t": _rule_turns,
    "r": _rule_radius,
    "l": _rule_landing_yaw,
    "-": _rule_dropped,
}


def single(number: float) -> float:
    """The number as a float of 32 bits; one too large for it is infinite."""
    try:
        return float(struct.unpack("<f", struct.pack("<f", number))[0])
    except OverflowError:
        return math.copysign(math.inf, number)


def _float_step(number: float) -> float:
    """Twice the distance of the floats of 32 bits around a number."""
    return math.ulp(number) * 2.0**30


def same_float(one: float, other: float) -> bool:
    """Whether both are the same float of 32 bits, or both NaN."""
    return (math.isnan(one) and math.isnan(other)) or single(one) == single(other)


def float_text(number: float) -> str:
    """The shortest decimal that is the same float of 32 bits."""
    texts = (f"{number:.{digits}g}" for digits in range(6, 10))
    return next((text for text in texts if same_float(float(text), number)), f"{number:.9g}")
