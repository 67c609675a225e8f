"""What ArduPilot refuses of an item, and what it keeps: an item takes 15 bytes there, and not all fits in.

By the numbers measured on ArduCopter 4.7, and by AP_Mission.cpp (mavlink_int_to_mission_cmd,
mission_cmd_to_mavlink_int, sanity_check_params), MissionItemProtocol_Fence.cpp and _Rally.cpp where nothing was
measured.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from typing import TypeAlias

from pymavlink.dialects.v20 import ardupilotmega as mavlink

from gcs_windplan.mission import Frame, command_name, frame_name, is_global, plain_frame
from gcs_windplan.mission.supported import ARDUCOPTER_CAPACITY, ARDUPILOT_HIGHEST
from gcs_windplan.standin.items import FENCE, MISSION, RALLY, Params, Refusal, StoredItem, single

#: StorageManager.cpp, copter's layout: "On Pixhawk this gives 718 waypoints, 46 rally points and 70 fence points".
CAPACITY = {MISSION: ARDUCOPTER_CAPACITY, FENCE: 70, RALLY: 46}

_RALLY_HIGHEST = 32_767.0  # [m] AP_Rally.h keeps whole metres in 16 bits
_Keep: TypeAlias = Callable[[float], float]


def _lost(number: float) -> float:
    return 0.0


def _whole(number: float) -> float:
    return float(int(number) & 0xFFFF)  # measured: -1 comes back as 65535


def _byte(number: float) -> float:
    return float(int(number) & 0xFF)


def _signed(number: float) -> float:
    return float((int(number) + 0x8000) % 0x10000 - 0x8000)


def _radius(number: float) -> float:
    return math.copysign(_whole(abs(number)), number)


def _turns(number: float) -> float:
    """Whole ones up to 255; less than one in parts of 256."""
    return int(number * 256) / 256 if 0 < number < 1 else _byte(min(number, 255.0))


def _circle_radius(number: float) -> float:
    """A byte of metres, or of tens of them above 255 m."""
    radius = abs(number)
    return math.copysign(_byte(radius) if radius <= 255 else 10 * float(min(255, int(radius * 0.1))), number)


def _turn(number: float) -> float:
    return -1.0 if number < 0 else 1.0


def _flag(number: float) -> float:
    return 1.0 if number > 0 else 0.0


def _centimetres(number: float) -> float:
    return int(number * 100) / 100


_as_is = single
_LOST = (_lost, _lost, _lost, _lost)
_FIRST = (_as_is, _lost, _lost, _lost)
_FIRST_WHOLE = (_whole, _lost, _lost, _lost)
_TWO = (_as_is, _as_is, _lost, _lost)
_THREE = (_as_is, _as_is, _as_is, _lost)
_ALL = (_as_is, _as_is, _as_is, _as_is)

#: What is left of parameters 1 to 4, for commands whose place is kept too.
_WITH_PLACE: dict[int, tuple[_Keep, _Keep, _Keep, _Keep]] = {
    mavlink.MAV_CMD_NAV_WAYPOINT: _FIRST_WHOLE,
    mavlink.MAV_CMD_NAV_LOITER_UNLIM: (_lost, _lost, _radius, _lost),
    mavlink.MAV_CMD_NAV_LOITER_TURNS: (_turns, _lost, _circle_radius, _flag),
    mavlink.MAV_CMD_NAV_LOITER_TIME: (_whole, _lost, _turn, _flag),
    mavlink.MAV_CMD_NAV_LAND: (_whole, _lost, _lost, _turn),
    mavlink.MAV_CMD_NAV_TAKEOFF: _FIRST_WHOLE,
    mavlink.MAV_CMD_NAV_CONTINUE_AND_CHANGE_ALT: _FIRST_WHOLE,
    mavlink.MAV_CMD_NAV_LOITER_TO_ALT: (_lost, _radius, _lost, _flag),
    mavlink.MAV_CMD_NAV_SPLINE_WAYPOINT: _FIRST_WHOLE,
    mavlink.MAV_CMD_NAV_VTOL_TAKEOFF: _LOST,
    mavlink.MAV_CMD_NAV_VTOL_LAND: _FIRST_WHOLE,
    mavlink.MAV_CMD_NAV_GUIDED_ENABLE: _FIRST_WHOLE,
    mavlink.MAV_CMD_NAV_PAYLOAD_PLACE: (_centimetres, _lost, _lost, _lost),
    mavlink.MAV_CMD_DO_SET_HOME: _FIRST_WHOLE,
    mavlink.MAV_CMD_DO_LAND_START: _LOST,
    mavlink.MAV_CMD_DO_RETURN_PATH_START: _LOST,
    mavlink.MAV_CMD_DO_GO_AROUND: _LOST,
    mavlink.MAV_CMD_DO_SET_ROI: _FIRST_WHOLE,
    mavlink.MAV_CMD_DO_SET_ROI_LOCATION: _LOST,
}
#: The same for commands without a place; x, y and z are lost except with those of `_ALL_SEVEN`.
_WITHOUT_PLACE: dict[int, tuple[_Keep, _Keep, _Keep, _Keep]] = {
    mavlink.MAV_CMD_NAV_RETURN_TO_LAUNCH: _LOST,
    mavlink.MAV_CMD_NAV_DELAY: (_as_is, _signed, _signed, _signed),
    mavlink.MAV_CMD_NAV_ALTITUDE_WAIT: _THREE,
    mavlink.MAV_CMD_NAV_SET_YAW_SPEED: _THREE,
    mavlink.MAV_CMD_NAV_SCRIPT_TIME: _ALL,
    mavlink.MAV_CMD_NAV_ATTITUDE_TIME: _ALL,
    mavlink.MAV_CMD_CONDITION_DELAY: _FIRST,
    mavlink.MAV_CMD_CONDITION_DISTANCE: _FIRST,
    mavlink.MAV_CMD_CONDITION_YAW: (_as_is, _as_is, _signed, _byte),
    mavlink.MAV_CMD_DO_SET_MODE: _FIRST_WHOLE,
    mavlink.MAV_CMD_DO_JUMP: (_whole, _signed, _lost, _lost),
    mavlink.MAV_CMD_JUMP_TAG: _FIRST_WHOLE,
    mavlink.MAV_CMD_DO_JUMP_TAG: (_whole, _signed, _lost, _lost),
    mavlink.MAV_CMD_DO_CHANGE_SPEED: (_byte, _as_is, _as_is, _lost),
    mavlink.MAV_CMD_DO_SET_RELAY: (_byte, _byte, _lost, _lost),
    mavlink.MAV_CMD_DO_REPEAT_RELAY: (_byte, _signed, _as_is, _lost),
    mavlink.MAV_CMD_DO_SET_SERVO: (_byte, _whole, _lost, _lost),
    mavlink.MAV_CMD_DO_REPEAT_SERVO: (_byte, _whole, _signed, _as_is),
    mavlink.MAV_CMD_DO_SET_ROI_NONE: _LOST,
    mavlink.MAV_CMD_DO_PAUSE_CONTINUE: _FIRST_WHOLE,
    mavlink.MAV_CMD_DO_DIGICAM_CONFIGURE: _ALL,
    mavlink.MAV_CMD_DO_DIGICAM_CONTROL: _ALL,
    mavlink.MAV_CMD_DO_MOUNT_CONTROL: _THREE,
    mavlink.MAV_CMD_DO_GIMBAL_MANAGER_PITCHYAW: _ALL,
    mavlink.MAV_CMD_DO_SET_CAM_TRIGG_DIST: (_as_is, _lost, _flag, _lost),
    mavlink.MAV_CMD_DO_FENCE_ENABLE: _FIRST_WHOLE,
    mavlink.MAV_CMD_DO_PARACHUTE: _FIRST_WHOLE,
    mavlink.MAV_CMD_DO_INVERTED_FLIGHT: _FIRST_WHOLE,
    mavlink.MAV_CMD_DO_GRIPPER: (_byte, _byte, _lost, _lost),
    mavlink.MAV_CMD_DO_SPRAYER: _FIRST_WHOLE,
    mavlink.MAV_CMD_DO_SEND_SCRIPT_MESSAGE: _ALL,
    mavlink.MAV_CMD_DO_AUX_FUNCTION: (_whole, _byte, _lost, _lost),
    mavlink.MAV_CMD_DO_GUIDED_LIMITS: (_whole, _as_is, _as_is, _as_is),
    mavlink.MAV_CMD_DO_AUTOTUNE_ENABLE: _FIRST_WHOLE,
    mavlink.MAV_CMD_DO_SET_REVERSE: _FIRST_WHOLE,
    mavlink.MAV_CMD_DO_SET_RESUME_REPEAT_DIST: _FIRST_WHOLE,
    mavlink.MAV_CMD_DO_ENGINE_CONTROL: (_flag, _flag, _centimetres, _flag),
    mavlink.MAV_CMD_DO_VTOL_TRANSITION: _FIRST,
    mavlink.MAV_CMD_DO_WINCH: _ALL,
    mavlink.MAV_CMD_IMAGE_START_CAPTURE: _ALL,
    mavlink.MAV_CMD_IMAGE_STOP_CAPTURE: _FIRST,
    mavlink.MAV_CMD_VIDEO_START_CAPTURE: _FIRST,
    mavlink.MAV_CMD_VIDEO_STOP_CAPTURE: _FIRST,
    mavlink.MAV_CMD_SET_CAMERA_ZOOM: _TWO,
    mavlink.MAV_CMD_SET_CAMERA_FOCUS: _TWO,
    mavlink.MAV_CMD_SET_CAMERA_SOURCE: _THREE,
}
_ALL_SEVEN = frozenset((mavlink.MAV_CMD_DO_DIGICAM_CONFIGURE, mavlink.MAV_CMD_DO_DIGICAM_CONTROL))
#: Parameters that may be NaN, counted from 0 (sanity_check_params; those of waypoint and take-off measured).
_NAN_ALLOWED = {
    mavlink.MAV_CMD_NAV_WAYPOINT: (3,),
    mavlink.MAV_CMD_NAV_LAND: (3,),
    mavlink.MAV_CMD_NAV_TAKEOFF: (3,),
    mavlink.MAV_CMD_NAV_VTOL_TAKEOFF: (3,),
    mavlink.MAV_CMD_NAV_VTOL_LAND: (2, 3),
}
_POLYGONS = (
    mavlink.MAV_CMD_NAV_FENCE_POLYGON_VERTEX_INCLUSION,
    mavlink.MAV_CMD_NAV_FENCE_POLYGON_VERTEX_EXCLUSION,
)
_CIRCLES = (mavlink.MAV_CMD_NAV_FENCE_CIRCLE_INCLUSION, mavlink.MAV_CMD_NAV_FENCE_CIRCLE_EXCLUSION)


def keep(item: StoredItem, mission_type: int) -> StoredItem | Refusal:
    """The item as ArduPilot gives it back when asked for it again, or its no."""
    if mission_type == MISSION:
        return _keep_mission_item(item)
    return _keep_fence_item(item) if mission_type == FENCE else _keep_rally_point(item)


def fence_fault(items: Sequence[StoredItem]) -> str | None:
    """Why a fence is refused when its last item has come, or None (AC_PolyFence_loader.cpp, validate_fence)."""
    left, polygon = 0, (0, 0.0)
    for seq, item in enumerate(items):
        if _misplaced(item) is not None:
            return f"item {seq} lies nowhere on Earth"
        if left and (item.command, item.params[0]) != polygon:
            return f"item {seq} begins something new while its polygon still lacks {left} corners"
        if item.command in _POLYGONS:
            if not left:
                left, polygon = int(item.params[0]), (item.command, item.params[0])
                if left < 3:
                    return f"the polygon that begins at item {seq} has {left} corners"
            left -= 1
        elif item.command in _CIRCLES and not item.params[0] > 0:
            return f"the circle at item {seq} has no radius"
    return f"the last polygon lacks {left} corners" if left else None


def _keep_mission_item(item: StoredItem) -> StoredItem | Refusal:
    with_place = item.command in _WITH_PLACE
    keeps = _WITH_PLACE.get(item.command) or _WITHOUT_PLACE.get(item.command)
    if item.command == 0:
        return Refusal(mavlink.MAV_MISSION_INVALID, "command 0 is none")
    refusal = _unusable_parameter(item)
    if refusal is not None:
        return refusal
    if keeps is None:
        return Refusal(mavlink.MAV_MISSION_UNSUPPORTED, f"{command_name(item.command)} is not known here")
    params = _kept(keeps, item.params)
    if with_place:
        return _refused_place(item) or StoredItem(
            _kept_frame(item.frame), item.command, params, item.x, item.y, _cut_to_centimetres(item.z)
        )
    if item.command in _ALL_SEVEN:
        return StoredItem(Frame.GLOBAL, item.command, params, item.x, item.y, single(item.z))
    return StoredItem(Frame.GLOBAL, item.command, params)


def _kept(keeps: tuple[_Keep, _Keep, _Keep, _Keep], params: Params) -> Params:
    p1, p2, p3, p4 = (
        # a NaN that passed stands in a parameter that is not kept, or whose sign alone is
        keep_it(0.0 if math.isnan(param) else param)
        for keep_it, param in zip(keeps, params, strict=True)
    )
    return p1, p2, p3, p4


def _unusable_parameter(item: StoredItem) -> Refusal | None:
    allowed = _NAN_ALLOWED.get(item.command, ())
    for i, param in enumerate(item.params):
        if math.isinf(param) or (math.isnan(param) and i not in allowed):
            return Refusal(mavlink.MAV_MISSION_INVALID_PARAM1 + i, f"parameter {i + 1} is {param}")
    return None


def _refused_place(item: StoredItem) -> Refusal | None:
    misplaced = _misplaced(item)
    if misplaced is not None:
        return misplaced
    if not abs(item.z) < ARDUPILOT_HIGHEST:
        return Refusal(mavlink.MAV_MISSION_INVALID_PARAM7, f"the altitude is {item.z} m")
    if not is_global(item.frame) and item.frame != Frame.MISSION:
        return Refusal(mavlink.MAV_MISSION_UNSUPPORTED_FRAME, f"{frame_name(item.frame)} is no frame for a place")
    return None


def _misplaced(item: StoredItem) -> Refusal | None:
    if abs(item.x) > 900_000_000:
        return Refusal(mavlink.MAV_MISSION_INVALID_PARAM5_X, f"the latitude is {item.latitude_deg}°")
    if abs(item.y) > 1_800_000_000:
        return Refusal(mavlink.MAV_MISSION_INVALID_PARAM6_Y, f"the longitude is {item.longitude_deg}°")
    return None


def _kept_frame(frame: int) -> int:
    """Measured: 6 becomes 3, 5 becomes 0, 11 becomes 10; a place in frame MISSION becomes one above sea level."""
    return int(Frame.GLOBAL) if frame == Frame.MISSION else plain_frame(frame)


def _cut_to_centimetres(z: float) -> float:
    """Measured: truncated, 61.999 becomes 61.99; the product is one of 32-bit floats."""
    return single(int(single(single(z) * 100)) / 100)


def _keep_fence_item(item: StoredItem) -> StoredItem | Refusal:
    if not is_global(item.frame):
        return Refusal(mavlink.MAV_MISSION_UNSUPPORTED_FRAME, f"{frame_name(item.frame)} is no frame for a fence")
    if item.command in _POLYGONS:
        first = _byte(item.params[0]) if math.isfinite(item.params[0]) else 0.0
    elif item.command in _CIRCLES:
        first = single(item.params[0])
    elif item.command == mavlink.MAV_CMD_NAV_FENCE_RETURN_POINT:
        first = 0.0
    else:
        return Refusal(mavlink.MAV_MISSION_UNSUPPORTED, f"{command_name(item.command)} belongs to no fence")
    return StoredItem(Frame.GLOBAL, item.command, (first, 0.0, 0.0, 0.0), item.x, item.y)


def _keep_rally_point(item: StoredItem) -> StoredItem | Refusal:
    if item.command != mavlink.MAV_CMD_NAV_RALLY_POINT:
        return Refusal(mavlink.MAV_MISSION_UNSUPPORTED, f"{command_name(item.command)} is no rally point")
    if plain_frame(item.frame) != Frame.GLOBAL_RELATIVE_ALT:
        return Refusal(mavlink.MAV_MISSION_UNSUPPORTED_FRAME, "rally points are above home, or refused")
    misplaced = _misplaced(item)
    if misplaced is not None:
        return misplaced
    if not abs(item.z) <= _RALLY_HIGHEST:
        return Refusal(mavlink.MAV_MISSION_INVALID_PARAM7, f"the altitude is {item.z} m")
    return StoredItem(Frame.GLOBAL_RELATIVE_ALT, item.command, x=item.x, y=item.y, z=float(int(item.z)))
