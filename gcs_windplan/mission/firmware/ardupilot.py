"""ArduPilot: ArduCopter and ArduPlane, 4.5 to 4.7.

An item takes 15 bytes there, and not all of it fits in. Sources, where no other is named: AP_Mission.cpp
(mavlink_int_to_mission_cmd writes, mission_cmd_to_mavlink_int reads back) and, for the types, the structs of
AP_Mission.h. "Measured" is ArduCopter 4.7-dev in its own simulator. Not settled, for want of the newest source:
NAV_ARC_WAYPOINT, which ArduCopter takes from 4.7 on, is not listed; fractions of turns, DO_SET_ROI_LOCATION,
DO_SET_ROI_NONE, DO_RETURN_PATH_START and SET_CAMERA_SOURCE are taken from how 4.5 to 4.7 answered.
"""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Final

from pymavlink.dialects.v20 import ardupilotmega as mavlink

from gcs_windplan.mission.commands import Frame
from gcs_windplan.mission.firmware.firmware import CommandRule, Firmware, Jumps, Mode, Parameter, Transfers, stores
from gcs_windplan.mission.firmware.storage import BIT0, FLAG, FLOAT, HALF, LANDING_YAW, NONE, SIGN, Storage
from gcs_windplan.mission.firmware.whole_numbers import (
    ALTITUDE,
    CM,
    I8,
    I16,
    I32,
    U8,
    U16,
    Bounded,
    Capped,
    CircleRadius,
    Clamped,
    SignedWhole,
    Turns,
    WholeNumber,
)
from gcs_windplan.vehicle import MotionProfile

_RADIUS: Final = SignedWhole(0, 0xFFFF)  # p1 and loiter_ccw
_ROLL, _PITCH, _HEADING = Bounded(-180, 180), Bounded(-90, 90), Bounded(-180, 360)  # nav_attitude_time
_HALF_P1: Final = Capped(0, 0xFFFF)  # NAV_WAYPOINT on ArduPlane: two bytes of p1


def _place(*params: Storage, nan: tuple[int, ...] = ()) -> CommandRule:
    """Of a command in stored_in_location: latitude and longitude as they are, altitude in centimetres."""
    given = params + (NONE,) * (4 - len(params))
    return stores(*given, I32, I32, ALTITUDE, place=True, nan=nan)


#: ArduCopter's; `nan` by sanity_check_params.
COMMANDS: Final[dict[int, CommandRule]] = {
    mavlink.MAV_CMD_NAV_WAYPOINT: _place(U16, nan=(4,)),  # measured; p1 is the hold on all but ArduPlane
    mavlink.MAV_CMD_NAV_LOITER_UNLIM: _place(NONE, NONE, _RADIUS),
    mavlink.MAV_CMD_NAV_LOITER_TURNS: _place(Turns(0, 0xFF), NONE, CircleRadius(), FLAG),
    mavlink.MAV_CMD_NAV_LOITER_TIME: _place(U16, NONE, SIGN, FLAG),  # measured
    mavlink.MAV_CMD_NAV_LAND: _place(U16, NONE, NONE, LANDING_YAW, nan=(4,)),
    mavlink.MAV_CMD_NAV_TAKEOFF: _place(U16, nan=(4,)),
    mavlink.MAV_CMD_NAV_CONTINUE_AND_CHANGE_ALT: _place(U16),
    mavlink.MAV_CMD_NAV_LOITER_TO_ALT: _place(NONE, _RADIUS, NONE, FLAG),
    mavlink.MAV_CMD_NAV_SPLINE_WAYPOINT: _place(U16),
    mavlink.MAV_CMD_NAV_GUIDED_ENABLE: _place(U16),
    mavlink.MAV_CMD_NAV_VTOL_TAKEOFF: _place(nan=(4,)),
    mavlink.MAV_CMD_NAV_VTOL_LAND: _place(U16, nan=(3, 4)),  # NAV_VTOL_LAND_OPTIONS
    mavlink.MAV_CMD_NAV_PAYLOAD_PLACE: _place(CM),  # p1 = param1 · 100
    mavlink.MAV_CMD_DO_SET_HOME: _place(U16),
    mavlink.MAV_CMD_DO_LAND_START: _place(),
    mavlink.MAV_CMD_DO_RETURN_PATH_START: _place(),
    mavlink.MAV_CMD_DO_GO_AROUND: _place(),
    mavlink.MAV_CMD_DO_SET_ROI: _place(U16),
    mavlink.MAV_CMD_DO_SET_ROI_LOCATION: _place(),
    mavlink.MAV_CMD_NAV_RETURN_TO_LAUNCH: stores(),
    mavlink.MAV_CMD_NAV_DELAY: stores(FLOAT, I8, I8, I8),  # Navigation_Delay_Command
    mavlink.MAV_CMD_NAV_ALTITUDE_WAIT: stores(FLOAT, FLOAT, U8),  # Altitude_Wait
    mavlink.MAV_CMD_NAV_SET_YAW_SPEED: stores(FLOAT, FLOAT, U8),  # Set_Yaw_Speed
    mavlink.MAV_CMD_NAV_SCRIPT_TIME: stores(U8, U8, HALF, HALF, I16, I16),  # nav_script_time_Command
    # nav_attitude_time_Command; climb_rate was a float before it became an int16_t, of a whole x in both
    mavlink.MAV_CMD_NAV_ATTITUDE_TIME: stores(Clamped(0, 0xFFFF), _ROLL, _PITCH, _HEADING, I16),
    mavlink.MAV_CMD_CONDITION_DELAY: stores(FLOAT),
    mavlink.MAV_CMD_CONDITION_DISTANCE: stores(FLOAT),
    mavlink.MAV_CMD_CONDITION_YAW: stores(FLOAT, FLOAT, I8, U8),  # Yaw_Command
    mavlink.MAV_CMD_DO_JUMP: stores(U16, I16),  # Jump_Command, measured
    mavlink.MAV_CMD_JUMP_TAG: stores(U16),  # Jump_Command
    mavlink.MAV_CMD_DO_JUMP_TAG: stores(U16, I16),  # Jump_Command
    mavlink.MAV_CMD_DO_CHANGE_SPEED: stores(U8, FLOAT, FLOAT),  # Change_Speed_Command, measured
    mavlink.MAV_CMD_DO_SET_RELAY: stores(U8, U8),  # Set_Relay_Command
    mavlink.MAV_CMD_DO_REPEAT_RELAY: stores(U8, I16, FLOAT),  # Repeat_Relay_Command
    mavlink.MAV_CMD_DO_SET_SERVO: stores(U8, U16),  # Set_Servo_Command
    mavlink.MAV_CMD_DO_REPEAT_SERVO: stores(U8, U16, I16, FLOAT),  # Repeat_Servo_Command
    mavlink.MAV_CMD_DO_PAUSE_CONTINUE: stores(U16),
    mavlink.MAV_CMD_DO_SET_REVERSE: stores(U16),
    mavlink.MAV_CMD_DO_SET_ROI_NONE: stores(),
    mavlink.MAV_CMD_DO_DIGICAM_CONFIGURE: stores(U8, U16, U8, U16, U8, U8, FLOAT),  # Digicam_Configure
    mavlink.MAV_CMD_DO_DIGICAM_CONTROL: stores(U8, U8, I8, U8, U8, U8),  # Digicam_Control
    mavlink.MAV_CMD_DO_MOUNT_CONTROL: stores(FLOAT, FLOAT, FLOAT),  # Mount_Control
    mavlink.MAV_CMD_DO_SET_CAM_TRIGG_DIST: stores(FLOAT, NONE, U8),  # Cam_Trigg_Distance
    mavlink.MAV_CMD_DO_FENCE_ENABLE: stores(U16),
    mavlink.MAV_CMD_DO_PARACHUTE: stores(U16),
    mavlink.MAV_CMD_DO_INVERTED_FLIGHT: stores(U16),
    mavlink.MAV_CMD_DO_GRIPPER: stores(U8, U8),  # Gripper_Command
    mavlink.MAV_CMD_DO_AUTOTUNE_ENABLE: stores(U16),
    mavlink.MAV_CMD_DO_SET_RESUME_REPEAT_DIST: stores(U16),
    mavlink.MAV_CMD_DO_SPRAYER: stores(U16),
    mavlink.MAV_CMD_DO_SEND_SCRIPT_MESSAGE: stores(U16, FLOAT, FLOAT, FLOAT),  # p1 and scripting_Command
    mavlink.MAV_CMD_DO_AUX_FUNCTION: stores(U16, U8),  # AuxFunction
    mavlink.MAV_CMD_DO_GUIDED_LIMITS: stores(U16, FLOAT, FLOAT, FLOAT),  # p1 and Guided_Limits_Command
    mavlink.MAV_CMD_DO_ENGINE_CONTROL: stores(FLAG, FLAG, CM, BIT0),  # Do_Engine_Control
    mavlink.MAV_CMD_DO_VTOL_TRANSITION: stores(U8),  # Do_VTOL_Transition
    mavlink.MAV_CMD_DO_WINCH: stores(U8, U8, FLOAT, FLOAT),  # Winch_Command
    # gimbal_manager_pitchyaw_Command: flags from x, gimbal_id from z
    mavlink.MAV_CMD_DO_GIMBAL_MANAGER_PITCHYAW: stores(I8, I16, I8, I8, U8, NONE, U8),
    mavlink.MAV_CMD_IMAGE_START_CAPTURE: stores(U8, FLOAT, U16, U16),  # image_start_capture_Command
    mavlink.MAV_CMD_IMAGE_STOP_CAPTURE: stores(U16),  # p1
    mavlink.MAV_CMD_VIDEO_START_CAPTURE: stores(U8),  # video_start_capture_Command
    mavlink.MAV_CMD_VIDEO_STOP_CAPTURE: stores(U8),  # video_stop_capture_Command
    mavlink.MAV_CMD_SET_CAMERA_ZOOM: stores(U8, FLOAT),  # set_camera_zoom_Command
    mavlink.MAV_CMD_SET_CAMERA_FOCUS: stores(U8, FLOAT),  # set_camera_focus_Command
    mavlink.MAV_CMD_SET_CAMERA_SOURCE: stores(U8, U8, U8),  # set_camera_source_Command
}
_PLANE_COMMANDS: Final = {
    **{command: rule for command, rule in COMMANDS.items() if command != mavlink.MAV_CMD_NAV_SPLINE_WAYPOINT},
    mavlink.MAV_CMD_NAV_WAYPOINT: _place(NONE, _HALF_P1, _HALF_P1, nan=(4,)),
}
_FENCE: Final = {  # AC_PolyFence_loader.cpp: vertex_count is a byte, a radius a float, and there are no heights
    mavlink.MAV_CMD_NAV_FENCE_RETURN_POINT: stores(place=True),
    mavlink.MAV_CMD_NAV_FENCE_POLYGON_VERTEX_INCLUSION: stores(U8, place=True),
    mavlink.MAV_CMD_NAV_FENCE_POLYGON_VERTEX_EXCLUSION: stores(U8, place=True),
    mavlink.MAV_CMD_NAV_FENCE_CIRCLE_INCLUSION: stores(FLOAT, place=True),
    mavlink.MAV_CMD_NAV_FENCE_CIRCLE_EXCLUSION: stores(FLOAT, place=True),
}

#: is_nav_cmd: numbers up to MAV_CMD_NAV_LAST and three more.
_MORE_NAVIGATION: Final = (
    mavlink.MAV_CMD_NAV_SET_YAW_SPEED,
    mavlink.MAV_CMD_NAV_SCRIPT_TIME,
    mavlink.MAV_CMD_NAV_ATTITUDE_TIME,
)
_NAVIGATION: Final = frozenset(
    command for command in COMMANDS if command <= mavlink.MAV_CMD_NAV_LAST or command in _MORE_NAVIGATION
)
_CIRCLES: Final = {  # the index of the radius: Plane's do_loiter_*, Copter's do_circle
    mavlink.MAV_CMD_NAV_LOITER_TURNS: 2,
    mavlink.MAV_CMD_NAV_LOITER_TIME: 2,
    mavlink.MAV_CMD_NAV_LOITER_UNLIM: 2,
    mavlink.MAV_CMD_NAV_LOITER_TO_ALT: 1,
}
_WAYPOINTS: Final = (mavlink.MAV_CMD_NAV_WAYPOINT, mavlink.MAV_CMD_NAV_SPLINE_WAYPOINT)
_VTOL: Final = frozenset(
    (mavlink.MAV_CMD_NAV_VTOL_TAKEOFF, mavlink.MAV_CMD_NAV_VTOL_LAND, mavlink.MAV_CMD_DO_VTOL_TRANSITION)
)
#: What ModeAuto::start_command in ArduCopter's mode_auto.cpp does not name, nor AP_Mission's own start_command.
_COPTER_IGNORES: Final = frozenset(
    (
        mavlink.MAV_CMD_NAV_CONTINUE_AND_CHANGE_ALT,
        mavlink.MAV_CMD_DO_VTOL_TRANSITION,
        mavlink.MAV_CMD_NAV_ALTITUDE_WAIT,
        mavlink.MAV_CMD_NAV_SET_YAW_SPEED,
        mavlink.MAV_CMD_DO_INVERTED_FLIGHT,
        mavlink.MAV_CMD_DO_GO_AROUND,
        mavlink.MAV_CMD_DO_SET_REVERSE,
        mavlink.MAV_CMD_DO_AUTOTUNE_ENABLE,
    )
)
#: What Plane::start_command in ArduPlane's commands_logic.cpp does not name.
_PLANE_IGNORES: Final = frozenset(
    (
        mavlink.MAV_CMD_CONDITION_YAW,
        mavlink.MAV_CMD_NAV_GUIDED_ENABLE,
        mavlink.MAV_CMD_NAV_SET_YAW_SPEED,
        mavlink.MAV_CMD_NAV_ATTITUDE_TIME,
        mavlink.MAV_CMD_DO_GUIDED_LIMITS,
        mavlink.MAV_CMD_DO_GO_AROUND,
        mavlink.MAV_CMD_DO_SET_REVERSE,
        mavlink.MAV_CMD_DO_WINCH,
    )
)

#: ArduCopter 4.7's default parameters, as read from its simulator; what has no parameter was measured in it. The
#: airspeed is what the simulated airframe reaches at ANGLE_MAX 30° (config.h, DEFAULT_ANGLE_MAX); 15.0 at 45°.
MOTION: Final = MotionProfile(
    speed=10.0,  # WPNAV_SPEED
    climb=2.5,  # WPNAV_SPEED_UP
    descent=1.5,  # WPNAV_SPEED_DN
    acceleration=2.5,  # WPNAV_ACCEL
    vertical_acceleration=1.0,  # WPNAV_ACCEL_Z
    jerk=1.0,  # WPNAV_JERK
    rise=0.3,  # fitted: how long the jerk itself takes to rise
    settle=0.62,  # fitted: what a start from rest takes more
    radius=2.0,  # WPNAV_RADIUS
    airspeed=10.16,  # measured at 30°
    landing=0.5,  # LAND_SPEED
    landing_height=10.0,  # LAND_ALT_LOW
    landing_ramp=1.3,  # measured: what the changes of speed on the way down take more
    touch_down=1.95,  # measured: from touching the ground to disarmed
    return_height=15.0,  # RTL_ALT
    return_hover=6.0,  # measured: above home, RTL_LOIT_TIME of 5 s included
    spool_up=4.4,  # measured: from arming to lift-off
    takeoff_ramp=2.2,  # measured: what a take-off takes more than height / climb
    circle_rate=math.radians(20.0),  # CIRCLE_RATE
)

_CUSTOM: Final = mavlink.MAV_MODE_FLAG_CUSTOM_MODE_ENABLED | mavlink.MAV_MODE_FLAG_STABILIZE_ENABLED
_BY_ITSELF: Final = _CUSTOM | mavlink.MAV_MODE_FLAG_GUIDED_ENABLED
_BY_HAND: Final = _CUSTOM | mavlink.MAV_MODE_FLAG_MANUAL_INPUT_ENABLED
#: ArduCopter's mode.h.
_MODES: Final = (
    Mode("STABILIZE", 0, "hold", _BY_HAND),
    Mode("ALT_HOLD", 2, "hold", _BY_HAND),
    Mode("AUTO", 3, "mission", _BY_ITSELF),
    Mode("GUIDED", 4, "guided", _BY_ITSELF),
    Mode("LOITER", 5, "hold", _BY_HAND),
    Mode("RTL", 6, "return", _BY_ITSELF),
    Mode("LAND", 9, "land", _BY_ITSELF),
    Mode("POSHOLD", 16, "hold", _BY_HAND),
    Mode("BRAKE", 17, "hold", _BY_ITSELF),
    Mode("SMART_RTL", 21, "return", _BY_ITSELF),
)
#: ArduCopter's Parameters.cpp and the libraries' var_info. Those without a field change nothing of how it flies here.
_PARAMETERS: Final = {
    "WPNAV_SPEED": Parameter(1000, field="speed", unit=0.01),
    "WPNAV_SPEED_UP": Parameter(250, field="climb", unit=0.01),
    "WPNAV_SPEED_DN": Parameter(150, field="descent", unit=0.01),
    "WPNAV_ACCEL": Parameter(250, field="acceleration", unit=0.01),
    "WPNAV_ACCEL_Z": Parameter(100, field="vertical_acceleration", unit=0.01),
    "WPNAV_JERK": Parameter(1, field="jerk"),
    "WPNAV_RADIUS": Parameter(200, field="radius", unit=0.01),
    "RTL_ALT": Parameter(1500, field="return_height", unit=0.01),
    "LAND_SPEED": Parameter(50, field="landing", unit=0.01),
    "LAND_ALT_LOW": Parameter(1000, field="landing_height", unit=0.01),
    "SYSID_THISMAV": Parameter(1, "int16"),
    "SYSID_MYGCS": Parameter(255, "int16"),
    "FRAME_CLASS": Parameter(1, "int8"),
    "FRAME_TYPE": Parameter(1, "int8"),
    "ANGLE_MAX": Parameter(3000, "int16"),
    "ARMING_CHECK": Parameter(1, "int32"),
    "AUTO_OPTIONS": Parameter(3, "int32"),  # not the default 0: arming in AUTO with no throttle, as the stand-in does
    "BATT_CAPACITY": Parameter(5000, "int32"),
    "BATT_MONITOR": Parameter(4, "int8"),
    "CIRCLE_RADIUS": Parameter(1000),
    "CIRCLE_RATE": Parameter(20, field="circle_rate", unit=math.radians(1.0)),
    "FENCE_ACTION": Parameter(1, "int8"),
    "FENCE_ALT_MAX": Parameter(100),
    "FENCE_ENABLE": Parameter(0, "int8"),
    "FENCE_MARGIN": Parameter(2),
    "FENCE_RADIUS": Parameter(300),
    "FENCE_TOTAL": Parameter(0, "int8"),
    "FENCE_TYPE": Parameter(7, "int8"),
    "FS_GCS_ENABLE": Parameter(0, "int8"),
    "FS_THR_ENABLE": Parameter(0, "int8"),
    **{f"FLTMODE{i}": Parameter(number, "int8") for i, number in enumerate((7, 9, 6, 3, 5, 0), start=1)},
    "MIS_OPTIONS": Parameter(0, "int16"),
    "MIS_RESTART": Parameter(0, "int8"),
    "MIS_TOTAL": Parameter(0, "int16"),
    "RALLY_LIMIT_KM": Parameter(0.3),
    "RALLY_TOTAL": Parameter(0, "int8"),
    "RTL_ALT_FINAL": Parameter(0, "int16"),
    "RTL_LOIT_TIME": Parameter(5000, "int32"),
    "RTL_SPEED": Parameter(0, "int16"),
    "SIMPLE": Parameter(0, "int8"),
    "SUPER_SIMPLE": Parameter(0, "int8"),
    "WP_YAW_BEHAVIOR": Parameter(1, "int8"),
}

ARDUCOPTER: Final = Firmware(
    autopilot="ardupilot",
    name="ArduCopter",
    family="ArduPilot",
    vehicle_type="multicopter",
    mav_autopilot=mavlink.MAV_AUTOPILOT_ARDUPILOTMEGA,
    version=0x04070000,  # 4.7.0-dev
    commands=COMMANDS,
    placeless=None,
    fence=_FENCE,
    # mavlink_int_to_mission_cmd; MISSION counts as GLOBAL there
    frames=frozenset((Frame.GLOBAL, Frame.GLOBAL_RELATIVE_ALT, Frame.GLOBAL_TERRAIN_ALT, Frame.MISSION)),
    rally_frames=frozenset((Frame.GLOBAL_RELATIVE_ALT,)),  # MissionItemProtocol_Rally.cpp before 4.6
    rally=WholeNumber(-0x8000, 0x7FFF),  # AP_Rally.h, RallyLocation: whole metres in 16 bits
    altitude=ALTITUDE,  # measured: 61.999 comes back as 61.99
    highest=83_000.0,  # Location.h, LOCATION_ALT_MAX_M
    rally_highest=32_768.0,  # RallyLocation, 16 bits of whole metres
    # StorageManager.cpp, on boards with 16 kB: "718 waypoints, 46 rally points and 70 fence points"
    capacity={"mission": 718, "fence": 70, "rally": 46},
    checks_numbers=True,  # sanity_check_params, check_lat, check_lng
    stores_autocontinue=False,  # mission_cmd_to_mavlink_int: always 1
    jumps=Jumps(
        first=1,
        forever=-1,  # AP_Mission.h, AP_MISSION_JUMP_REPEAT_FOREVER
        in_a_row=64,  # get_next_cmd, max_loops
        tracked=15,  # AP_Mission.h, AP_MISSION_MAX_NUM_DO_JUMP_COMMANDS on boards with less than 500 kB of memory
    ),
    transfers=Transfers(
        home_item=True,
        whole=frozenset(("fence",)),  # MissionItemProtocol.cpp writes items in place; _Fence.cpp gathers them
        ask_again=1.0,  # MissionItemProtocol.cpp, wp_recv_timeout_ms
        give_up=8.0,  # MissionItemProtocol.h, upload_timeout_ms
        booting=2.0,  # measured
        repeats_acceptance=False,
        minds_sequence=True,  # measured
        frame_first=False,
        reads_back_int=False,  # measured: 6 becomes 3, 5 becomes 0, 11 becomes 10
    ),
    navigation=_NAVIGATION,
    takeoff="required",  # mode_auto.cpp, init: "Missing Takeoff Cmd"
    lowest_takeoff=1.0,  # takeoff.cpp and mode_auto.cpp, takeoff_start: 100 cm
    takeoff_goes_to_place=False,  # mode_auto.cpp, do_takeoff
    ends_over_home=True,  # Plane::exit_mission_callback changes to RTL
    lands_and_goes_on=True,  # mode_auto.cpp, verify_land and verify_RTL
    zero_place_is_here=True,  # mode_auto.cpp, loc_from_cmd
    circles={mavlink.MAV_CMD_NAV_LOITER_TURNS: 2},  # mode_auto.cpp, do_circle; it stays in place at all others
    circle_radius=10.0,  # CIRCLE_RADIUS
    motion=MOTION,
    motion_measured=True,
    modes=_MODES,
    own_modes={"hold": "LOITER", "mission": "AUTO", "guided": "GUIDED", "return": "RTL", "land": "LAND"},
    parameters=_PARAMETERS,
    integers_as_bytes=False,
    mode_parts=False,
    starts_armed=False,
    stream_groups=True,
    guided_takeoff=None,
    simulator_home=(-35.363262, 149.165237, 584.0),  # Tools/autotest/locations.txt, CMAC
    cruise=12.0,  # ArduPlane's AIRSPEED_CRUISE
    plane_return=100.0,  # ArduPlane's RTL_ALTITUDE
    zero_altitude=frozenset((*_CIRCLES, *_WAYPOINTS)),  # mode_auto.cpp, loc_from_cmd: 0 in any frame
    zero_frames=frozenset((Frame.GLOBAL, Frame.GLOBAL_RELATIVE_ALT, Frame.GLOBAL_TERRAIN_ALT, Frame.MISSION)),
    ignored=_COPTER_IGNORES,
    fence_corners=255,  # AC_PolyFence_loader.h, PolygonBoundary and its count on storage: one byte
)

ARDUPLANE: Final = replace(
    ARDUCOPTER,
    name="ArduPlane",
    vehicle_type="fixed-wing",
    commands=_PLANE_COMMANDS,  # mavlink_int_to_mission_cmd refuses a spline in ArduPlane's build
    capacity={"mission": 724, "fence": 84, "rally": 50},  # StorageManager.cpp: "724 waypoints, 50 rally points and 84"
    navigation=_NAVIGATION - {mavlink.MAV_CMD_NAV_SPLINE_WAYPOINT},
    takeoff="optional",
    lowest_takeoff=None,
    lands_and_goes_on=False,  # verify_land is never through but for an abort, an RTL leaves AUTO
    zero_altitude=frozenset(_CIRCLES),  # Location.cpp, sanitize: 0 above home
    zero_frames=frozenset((Frame.GLOBAL_RELATIVE_ALT,)),
    circles=_CIRCLES,
    circle_radius=60.0,  # WP_LOITER_RAD
    ignored=_PLANE_IGNORES,
    # quadplane.cpp, do_vtol_takeoff and do_vtol_land: false where no QuadPlane is set up
    quadplane_only=_VTOL | {mavlink.MAV_CMD_NAV_PAYLOAD_PLACE},
)

ARDUPILOT: Final = replace(
    ARDUCOPTER,
    name="ArduPilot",
    vehicle_type=None,
    ignored=_COPTER_IGNORES & _PLANE_IGNORES,
    variants=(ARDUCOPTER, ARDUPLANE),
)

FIRMWARES: Final = (ARDUCOPTER, ARDUPLANE, ARDUPILOT)
