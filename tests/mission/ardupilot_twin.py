"""What ArduPilot's C++ makes of an item's numbers, written from its sources once more, apart from the package's table.

Each command's line says which parameter goes into which type, as AP_Mission.cpp assigns it to the fields of
AP_Mission.h; x, y and z are the packet's. What no line names is not stored.
"""

from __future__ import annotations

import ctypes
import math
import struct

from pymavlink.dialects.v20 import ardupilotmega as mavlink

_TYPES = {
    "uint8": ctypes.c_uint8,
    "int8": ctypes.c_int8,
    "uint16": ctypes.c_uint16,
    "int16": ctypes.c_int16,
    "float": ctypes.c_float,
}
#: Commands that are not in stored_in_location.
_FIELDS = """
NAV_RETURN_TO_LAUNCH
NAV_DELAY                  1:float 2:int8 3:int8 4:int8
NAV_ALTITUDE_WAIT          1:float 2:float 3:uint8
NAV_SET_YAW_SPEED          1:float 2:float 3:uint8
NAV_SCRIPT_TIME            1:uint8 2:uint8 3:half 4:half x:int16 y:int16
NAV_ATTITUDE_TIME          1:seconds 2:roll 3:pitch 4:yaw x:int16
CONDITION_DELAY            1:float
CONDITION_DISTANCE         1:float
CONDITION_YAW              1:float 2:float 3:int8 4:uint8
DO_JUMP                    1:uint16 2:int16
JUMP_TAG                   1:uint16
DO_JUMP_TAG                1:uint16 2:int16
DO_CHANGE_SPEED            1:uint8 2:float 3:float
DO_SET_RELAY               1:uint8 2:uint8
DO_REPEAT_RELAY            1:uint8 2:int16 3:float
DO_SET_SERVO               1:uint8 2:uint16
DO_REPEAT_SERVO            1:uint8 2:uint16 3:int16 4:float
DO_PAUSE_CONTINUE          1:uint16
DO_SET_REVERSE             1:uint16
DO_SET_ROI_NONE
DO_DIGICAM_CONFIGURE       1:uint8 2:uint16 3:uint8 4:uint16 x:uint8 y:uint8 z:float
DO_DIGICAM_CONTROL         1:uint8 2:uint8 3:int8 4:uint8 x:uint8 y:uint8
DO_MOUNT_CONTROL           1:float 2:float 3:float
DO_SET_CAM_TRIGG_DIST      1:float 3:uint8
DO_FENCE_ENABLE            1:uint16
DO_PARACHUTE               1:uint16
DO_INVERTED_FLIGHT         1:uint16
DO_GRIPPER                 1:uint8 2:uint8
DO_AUTOTUNE_ENABLE         1:uint16
DO_SET_RESUME_REPEAT_DIST  1:uint16
DO_SPRAYER                 1:uint16
DO_SEND_SCRIPT_MESSAGE     1:uint16 2:float 3:float 4:float
DO_AUX_FUNCTION            1:uint16 2:uint8
DO_GUIDED_LIMITS           1:uint16 2:float 3:float 4:float
DO_ENGINE_CONTROL          1:positive 2:positive 3:hundredths 4:odd
DO_VTOL_TRANSITION         1:uint8
DO_WINCH                   1:uint8 2:uint8 3:float 4:float
DO_GIMBAL_MANAGER_PITCHYAW 1:int8 2:int16 3:int8 4:int8 x:uint8 z:uint8
IMAGE_START_CAPTURE        1:uint8 2:float 3:uint16 4:uint16
IMAGE_STOP_CAPTURE         1:uint16
VIDEO_START_CAPTURE        1:uint8
VIDEO_STOP_CAPTURE         1:uint8
SET_CAMERA_ZOOM            1:uint8 2:float
SET_CAMERA_FOCUS           1:uint8 2:float
SET_CAMERA_SOURCE          1:uint8 2:uint8 3:uint8
"""
#: Those that are: latitude, longitude and centimetres of altitude come back beside these.
_PLACES = """
NAV_WAYPOINT               1:uint16
NAV_LOITER_UNLIM           3:radius
NAV_LOITER_TURNS           1:turns 3:circle 4:positive
NAV_LOITER_TIME            1:uint16 3:sign 4:positive
NAV_LAND                   1:uint16 4:sign
NAV_TAKEOFF                1:uint16
NAV_CONTINUE_AND_CHANGE_ALT 1:uint16
NAV_LOITER_TO_ALT          2:radius 4:positive
NAV_SPLINE_WAYPOINT        1:uint16
NAV_GUIDED_ENABLE          1:uint16
NAV_VTOL_TAKEOFF
NAV_VTOL_LAND              1:uint16
NAV_PAYLOAD_PLACE          1:hundredths
DO_SET_HOME                1:uint16
DO_LAND_START
DO_RETURN_PATH_START
DO_GO_AROUND
DO_SET_ROI                 1:uint16
DO_SET_ROI_LOCATION
"""


def _lines(text: str) -> dict[int, dict[str, str]]:
    rows = (line.split() for line in text.strip().splitlines())
    return {getattr(mavlink, f"MAV_CMD_{name}"): dict(field.split(":") for field in fields) for name, *fields in rows}


FIELDS, PLACES = _lines(_FIELDS), _lines(_PLACES)


def _float(number: float) -> float:
    return ctypes.c_float(number).value


def _circle(number: float) -> float:
    size = abs(_float(number))
    held = ctypes.c_uint8(int(size)).value if size <= 255 else 10.0 * min(255, int(size * 0.1))
    return -held if number < 0 else float(held)


def _turns(number: float) -> float:
    return math.floor(number * 256) / 256 if 0 < number < 1 else float(ctypes.c_uint8(int(min(255, number))).value)


def cast(kind: str, number: float) -> float:
    """A parameter as it is held in a field."""
    special = {
        "half": lambda: math.inf if number >= 65_520 else struct.unpack("<e", struct.pack("<e", number))[0],
        "seconds": lambda: float(int(min(max(number, 0), 65535))),
        "roll": lambda: float(int(number)) if abs(number) <= 180 else 0.0,
        "pitch": lambda: float(int(number)) if abs(number) <= 90 else 0.0,
        "yaw": lambda: float(int(number)) if -180 <= number <= 360 else 0.0,
        "positive": lambda: float(number > 0),
        "odd": lambda: float(ctypes.c_uint32(int(number)).value & 1),
        "sign": lambda: -1.0 if number < 0 else 1.0,
        "radius": lambda: math.copysign(ctypes.c_uint16(int(abs(number))).value, number),
        "hundredths": lambda: _float(ctypes.c_uint16(int(_float(number * 100))).value / 100),
        "circle": lambda: _circle(number),
        "turns": lambda: _turns(number),
    }
    if kind in special:
        return special[kind]()
    if kind == "float":
        return _float(number)
    return float(_TYPES[kind](int(number)).value)


def read_back(command: int, params: tuple[float, ...], place: tuple[int, int, float]) -> tuple[float, ...]:
    """The seven numbers that come back of an item: parameters 1 to 4, x, y and z."""
    fields = PLACES.get(command, FIELDS.get(command, {}))
    sent = dict(zip("1234xyz", (*params, *place), strict=True))
    held = {name: cast(kind, sent[name]) for name, kind in fields.items()}
    if command in PLACES:
        centimetres = int(_float(_float(place[2]) * 100))
        held |= {"x": place[0], "y": place[1], "z": _float(centimetres / 100)}
    return tuple(float(held.get(name, 0.0)) for name in "1234xyz")
