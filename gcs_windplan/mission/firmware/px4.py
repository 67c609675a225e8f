"""PX4, 1.14 to 1.16, with its default parameters.

Sources, where no other is named: mavlink_mission.cpp (parse_mavlink_mission_item takes, format_mavlink_mission_item
reads back; what the second does not name comes back as 0, for its error is not looked at), navigation.h for the types
(mission_item_s), FeasibilityChecker.cpp for what is not flown. "Measured" is PX4 main of August 2025 in its own SIH
simulator. Not settled: main also takes COMPONENT_ARM_DISARM and DO_AUTOTUNE_ENABLE in global frames, from which release
on is not known; NAV_ROI, which becomes DO_SET_ROI, is not listed.
"""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Final

from pymavlink.dialects.v20 import ardupilotmega as mavlink

from gcs_windplan.mission.commands import Frame
from gcs_windplan.mission.firmware.firmware import (
    CommandRule,
    Feasibility,
    Firmware,
    Jumps,
    Mode,
    Parameter,
    Transfers,
    stores,
)
from gcs_windplan.mission.firmware.storage import FLAG, FLAG_OR_YAW, FLOAT, NONE, UNREAD, YAW, Storage
from gcs_windplan.mission.firmware.whole_numbers import I16, U16, Nearest
from gcs_windplan.vehicle import MotionProfile


def _place(*params: Storage, choices: tuple[int, ...] = ()) -> CommandRule:
    """Of a command with a place: doubles for latitude and longitude, a float for the altitude."""
    given = params + (NONE,) * (4 - len(params))
    return stores(*given, FLOAT, FLOAT, FLOAT, place=True, choices=choices)


def _plain(choices: tuple[int, ...] = ()) -> CommandRule:
    """Of a command in frame MISSION: params[7], floats, as they are."""
    return stores(*[FLOAT] * 7, choices=choices)


#: Taken in global frames. MAV_ROI: 0 none, 3 a location.
_COMMANDS: Final[dict[int, CommandRule]] = {
    mavlink.MAV_CMD_NAV_WAYPOINT: _place(FLOAT, FLOAT, NONE, YAW),  # time_inside, acceptance_radius, yaw
    mavlink.MAV_CMD_NAV_LOITER_UNLIM: _place(NONE, NONE, FLOAT, YAW),  # loiter_radius, yaw
    # time_inside, force_heading, loiter_radius; what comes back of the yaw is loiter_exit_xtrack, of older PX4 the yaw
    mavlink.MAV_CMD_NAV_LOITER_TIME: _place(FLOAT, FLAG, FLOAT, FLAG_OR_YAW),
    mavlink.MAV_CMD_NAV_LAND: _place(NONE, U16, NONE, YAW),  # land_precision
    mavlink.MAV_CMD_NAV_TAKEOFF: _place(NONE, NONE, NONE, YAW),
    mavlink.MAV_CMD_NAV_LOITER_TO_ALT: _place(FLAG, FLOAT, NONE, FLAG),
    mavlink.MAV_CMD_NAV_VTOL_TAKEOFF: _place(NONE, NONE, NONE, YAW),
    mavlink.MAV_CMD_NAV_VTOL_LAND: _place(NONE, NONE, NONE, YAW),
    mavlink.MAV_CMD_DO_SET_ROI: _place(UNREAD, choices=(0, 3)),
    mavlink.MAV_CMD_DO_SET_ROI_LOCATION: _place(),
    mavlink.MAV_CMD_CONDITION_GATE: _place(),
}
#: Taken in frame MISSION. MAV_ROI: 0 none, 1 the next waypoint, 2 one by its index.
_PLACELESS: Final[dict[int, CommandRule]] = {
    mavlink.MAV_CMD_DO_JUMP: stores(I16, U16, *[FLOAT] * 5),  # do_jump_mission_index, do_jump_repeat_count
    mavlink.MAV_CMD_DO_SET_ROI: _plain(choices=(0, 1, 2)),
    **dict.fromkeys(
        (
            mavlink.MAV_CMD_DO_CHANGE_SPEED,
            mavlink.MAV_CMD_DO_SET_HOME,
            mavlink.MAV_CMD_DO_LAND_START,
            mavlink.MAV_CMD_DO_SET_CAM_TRIGG_DIST,
            mavlink.MAV_CMD_DO_SET_CAM_TRIGG_INTERVAL,
            mavlink.MAV_CMD_DO_VTOL_TRANSITION,
            mavlink.MAV_CMD_NAV_DELAY,
            mavlink.MAV_CMD_NAV_RETURN_TO_LAUNCH,
            mavlink.MAV_CMD_DO_SET_ROI_NONE,
            mavlink.MAV_CMD_DO_SET_ROI_WPNEXT_OFFSET,
            mavlink.MAV_CMD_CONDITION_DELAY,
            mavlink.MAV_CMD_CONDITION_DISTANCE,
            mavlink.MAV_CMD_DO_WINCH,
            mavlink.MAV_CMD_DO_GRIPPER,
            mavlink.MAV_CMD_DO_TRIGGER_CONTROL,
            mavlink.MAV_CMD_DO_DIGICAM_CONTROL,
            mavlink.MAV_CMD_DO_MOUNT_CONFIGURE,
            mavlink.MAV_CMD_DO_MOUNT_CONTROL,
            mavlink.MAV_CMD_DO_GIMBAL_MANAGER_PITCHYAW,
            mavlink.MAV_CMD_DO_GIMBAL_MANAGER_CONFIGURE,
            mavlink.MAV_CMD_IMAGE_START_CAPTURE,
            mavlink.MAV_CMD_IMAGE_STOP_CAPTURE,
            mavlink.MAV_CMD_VIDEO_START_CAPTURE,
            mavlink.MAV_CMD_VIDEO_STOP_CAPTURE,
            mavlink.MAV_CMD_DO_CONTROL_VIDEO,
            mavlink.MAV_CMD_OBLIQUE_SURVEY,
            mavlink.MAV_CMD_SET_CAMERA_MODE,
            mavlink.MAV_CMD_SET_CAMERA_FOCUS,
            mavlink.MAV_CMD_SET_CAMERA_SOURCE,
            mavlink.MAV_CMD_DO_SET_ACTUATOR,
            mavlink.MAV_CMD_DO_AUTOTUNE_ENABLE,
            mavlink.MAV_CMD_COMPONENT_ARM_DISARM,
        ),
        _plain(),
    ),
}
_VERTICES: Final = Nearest(0, 0xFFFF)  # vertex_count = param1 + 0.5
_FENCE: Final = {
    mavlink.MAV_CMD_NAV_FENCE_RETURN_POINT: _place(),
    mavlink.MAV_CMD_NAV_FENCE_POLYGON_VERTEX_INCLUSION: _place(_VERTICES),
    mavlink.MAV_CMD_NAV_FENCE_POLYGON_VERTEX_EXCLUSION: _place(_VERTICES),
    mavlink.MAV_CMD_NAV_FENCE_CIRCLE_INCLUSION: _place(FLOAT),
    mavlink.MAV_CMD_NAV_FENCE_CIRCLE_EXCLUSION: _place(FLOAT),
}

_POSITIONS: Final = frozenset(  # MissionBlock::item_contains_position
    (
        mavlink.MAV_CMD_NAV_WAYPOINT,
        mavlink.MAV_CMD_NAV_LOITER_UNLIM,
        mavlink.MAV_CMD_NAV_LOITER_TIME,
        mavlink.MAV_CMD_NAV_LAND,
        mavlink.MAV_CMD_NAV_TAKEOFF,
        mavlink.MAV_CMD_NAV_LOITER_TO_ALT,
        mavlink.MAV_CMD_NAV_VTOL_TAKEOFF,
        mavlink.MAV_CMD_NAV_VTOL_LAND,
    )
)
_WAITS: Final = frozenset((mavlink.MAV_CMD_NAV_RETURN_TO_LAUNCH, mavlink.MAV_CMD_NAV_DELAY))
_CONDITIONS: Final = frozenset((mavlink.MAV_CMD_CONDITION_DELAY, mavlink.MAV_CMD_CONDITION_DISTANCE))
_VTOL: Final = frozenset(
    (mavlink.MAV_CMD_NAV_VTOL_TAKEOFF, mavlink.MAV_CMD_NAV_VTOL_LAND, mavlink.MAV_CMD_DO_VTOL_TRANSITION)
)
_FEASIBILITY: Final = Feasibility(
    positions=_POSITIONS,
    # checkTakeoff has a list of what is no waypoint, and these are not on it
    waypoints=_POSITIONS
    | _CONDITIONS
    | {
        mavlink.MAV_CMD_NAV_RETURN_TO_LAUNCH,
        mavlink.MAV_CMD_CONDITION_GATE,
        mavlink.MAV_CMD_DO_WINCH,
        mavlink.MAV_CMD_DO_GRIPPER,
    },
    first_waypoint=900.0,  # MIS_DIST_1WP of older releases (mission_params.c)
    far_first_waypoint=10_000.0,  # MIS_DIST_1WP, measured; a warning only
    gate_apart=0.05,  # checkDistancesBetweenWaypoints
    landing_required=False,
    steepest_approach=5.0,  # FW_LND_ANG
    approach_lenience=0.1,  # checkFixedWindLandApproach
)

#: Default parameters of multicopters, as read from the simulator; NAV_ACC_RAD and RTL_RETURN_ALT are 10 m and 60 m in
#: the modules, and the multicopters' start script (rc.mc_defaults) sets 2 m and 30 m. Measured: the take-off's ramp,
#: 20.5 to 23.3 s to 30 m and 15.7 to 17.4 s to 15 m with MPC_TKO_SPEED and MPC_TKO_RAMP_T in it. Only supposed: that
#: corners follow ArduCopter's law, that nothing is lost besides, and the airspeed.
MOTION: Final = MotionProfile(
    speed=5.0,  # MPC_XY_CRUISE
    climb=3.0,  # MPC_Z_V_AUTO_UP
    descent=1.5,  # MPC_Z_V_AUTO_DN
    acceleration=3.0,  # MPC_ACC_HOR
    vertical_acceleration=3.0,  # MPC_ACC_DOWN_MAX; MPC_ACC_UP_MAX is 4, and the smaller one counts both ways
    jerk=4.0,  # MPC_JERK_AUTO
    rise=0.0,
    settle=0.0,
    radius=2.0,  # NAV_ACC_RAD
    airspeed=15.0,
    landing=0.7,  # MPC_LAND_SPEED
    landing_height=5.0,  # MPC_LAND_ALT2
    landing_ramp=0.0,
    touch_down=2.0,  # COM_DISARM_LAND
    return_height=30.0,  # RTL_RETURN_ALT
    return_hover=0.0,  # RTL_LAND_DELAY
    spool_up=1.0,  # COM_SPOOLUP_TIME
    takeoff_ramp=10.4,  # measured
    circle_rate=math.inf,  # no item of its multicopters circles
)

_CUSTOM: Final = mavlink.MAV_MODE_FLAG_CUSTOM_MODE_ENABLED | mavlink.MAV_MODE_FLAG_STABILIZE_ENABLED
_AUTO: Final = _CUSTOM | mavlink.MAV_MODE_FLAG_GUIDED_ENABLED | mavlink.MAV_MODE_FLAG_AUTO_ENABLED
_BY_HAND: Final = _CUSTOM | mavlink.MAV_MODE_FLAG_MANUAL_INPUT_ENABLED


def _mode_number(main: int, sub: int = 0) -> int:
    """px4_custom_mode.h."""
    return main << 16 | sub << 24


#: px4_custom_mode.h.
_MODES: Final = (
    Mode("Hold", _mode_number(4, 3), "guided", _AUTO),
    Mode("Mission", _mode_number(4, 4), "mission", _AUTO),
    Mode("Return", _mode_number(4, 5), "return", _AUTO),
    Mode("Land", _mode_number(4, 6), "land", _AUTO),
    Mode("Takeoff", _mode_number(4, 2), "guided", _AUTO),
    Mode("Manual", _mode_number(1), "hold", _BY_HAND),
    Mode("Altitude", _mode_number(2), "hold", _BY_HAND),
    Mode("Position", _mode_number(3), "hold", _BY_HAND),
    Mode("Stabilized", _mode_number(7), "hold", _BY_HAND),
)
#: The modules' parameters, and rc.mc_defaults; those that the simulator was asked for are as it said.
_PARAMETERS: Final = {
    "MPC_XY_CRUISE": Parameter(5, field="speed"),
    "MPC_Z_V_AUTO_UP": Parameter(3, field="climb"),
    "MPC_Z_V_AUTO_DN": Parameter(1.5, field="descent"),
    "MPC_ACC_HOR": Parameter(3, field="acceleration"),
    "MPC_ACC_DOWN_MAX": Parameter(3, field="vertical_acceleration"),
    "MPC_JERK_AUTO": Parameter(4, field="jerk"),
    "NAV_ACC_RAD": Parameter(2, field="radius"),
    "RTL_RETURN_ALT": Parameter(30, field="return_height"),
    "MPC_LAND_SPEED": Parameter(0.7, field="landing"),
    "MPC_LAND_ALT2": Parameter(5, field="landing_height"),
    "BAT1_CAPACITY": Parameter(5000),
    "BAT1_N_CELLS": Parameter(4, "int32"),
    "COM_DISARM_LAND": Parameter(2),
    "COM_RC_IN_MODE": Parameter(4, "int32"),
    "GF_ACTION": Parameter(2, "int32"),
    "GF_MAX_HOR_DIST": Parameter(0),
    "GF_MAX_VER_DIST": Parameter(0),
    "MAV_COMP_ID": Parameter(1, "int32"),
    "MAV_SYS_ID": Parameter(1, "int32"),
    "MAV_TYPE": Parameter(2, "int32"),
    "MIS_DIST_1WP": Parameter(10_000),
    "MIS_TAKEOFF_ALT": Parameter(2.5),
    "MPC_ACC_UP_MAX": Parameter(4),
    "NAV_DLL_ACT": Parameter(0, "int32"),
    "NAV_RCL_ACT": Parameter(2, "int32"),
    "RTL_DESCEND_ALT": Parameter(10),
    "RTL_LAND_DELAY": Parameter(0),
    "RTL_TYPE": Parameter(0, "int32"),
    "SYS_AUTOSTART": Parameter(4001, "int32"),
}

MULTICOPTER: Final = Firmware(
    autopilot="px4",
    name="PX4",
    family="PX4",
    vehicle_type="multicopter",
    mav_autopilot=mavlink.MAV_AUTOPILOT_PX4,
    version=0x010F00FF,  # 1.15.0
    commands=_COMMANDS,
    placeless=_PLACELESS,
    fence=_FENCE,
    frames=frozenset((Frame.GLOBAL, Frame.GLOBAL_RELATIVE_ALT, Frame.MISSION)),
    rally_frames=frozenset((Frame.GLOBAL, Frame.GLOBAL_RELATIVE_ALT)),
    rally=FLOAT,
    altitude=FLOAT,
    highest=None,
    rally_highest=None,
    # navigation.h, NUM_MISSIONS_SUPPORTED on flight controllers, 500 in some releases; dataman.h: 64 and 32
    capacity={"mission": 2000, "fence": 64, "rally": 32},
    checks_numbers=False,
    stores_autocontinue=True,
    jumps=Jumps(first=0, forever=None, in_a_row=10),  # mission_base.h, MAX_JUMP_ITERATION
    transfers=Transfers(
        home_item=False,
        whole=frozenset(("mission", "fence", "rally")),  # two halves of the data manager, in turn
        ask_again=0.25,  # mavlink_mission.h, MAVLINK_MISSION_RETRY_TIMEOUT_DEFAULT
        give_up=5.0,  # mavlink_mission.h, MAVLINK_MISSION_PROTOCOL_TIMEOUT_DEFAULT
        booting=0.0,
        repeats_acceptance=True,  # handle_mission_item_both
        minds_sequence=False,
        frame_first=True,
        reads_back_int=True,  # format_mavlink_mission_item, in _int_mode
    ),
    navigation=_POSITIONS | _WAITS,  # MissionBlock::is_mission_item_reached_or_completed
    takeoff="climbs first",  # mission.cpp, do_need_vertical_takeoff
    lowest_takeoff=None,
    takeoff_goes_to_place=True,
    ends_over_home=False,
    lands_and_goes_on=False,  # it disarms
    zero_place_is_here=False,
    circles={},  # multicopters have no such item
    circle_radius=80.0,  # NAV_LOITER_RAD
    motion=MOTION,
    motion_measured=False,
    modes=_MODES,
    own_modes={"hold": "Hold", "mission": "Mission", "guided": "Hold", "return": "Return", "land": "Land"},
    parameters=_PARAMETERS,
    integers_as_bytes=True,
    mode_parts=True,
    starts_armed=True,
    stream_groups=False,
    guided_takeoff=2.5,  # MIS_TAKEOFF_ALT
    simulator_home=(47.397742, 8.545594, 488.0),  # px4_sitl, Zurich
    cruise=15.0,  # FW_AIRSPD_TRIM
    plane_return=None,
    not_flown=_CONDITIONS,  # checkMissionItemValidity does not have them
    vtol_only=_VTOL,  # checkItemsFitToVehicleType
    feasibility=_FEASIBILITY,
)

FIXED_WING: Final = replace(
    MULTICOPTER,
    vehicle_type="fixed-wing",
    takeoff="optional",
    circles={
        mavlink.MAV_CMD_NAV_LOITER_TIME: 2,
        mavlink.MAV_CMD_NAV_LOITER_UNLIM: 2,
        mavlink.MAV_CMD_NAV_LOITER_TO_ALT: 1,
    },
    feasibility=replace(_FEASIBILITY, landing_required=True),  # MIS_TKO_LAND_REQ 2, set by rc.fw_defaults
)

PX4: Final = replace(MULTICOPTER, vehicle_type=None, vtol_only=frozenset(), variants=(MULTICOPTER, FIXED_WING))

FIRMWARES: Final = (MULTICOPTER, FIXED_WING, PX4)
