"""What each firmware takes into a mission: commands, frames, NaN, and how many items fit.

By ArduPilot's AP_Mission.cpp (mavlink_int_to_mission_cmd, stored_in_location, sanity_check_params) and
StorageManager.cpp, and by PX4's mavlink_mission.cpp (parse_mavlink_mission_item) and navigation.h.
"""

from __future__ import annotations

from pymavlink.dialects.v20 import ardupilotmega as mavlink

from gcs_windplan.mission.commands import Command, Frame, plain_frame
from gcs_windplan.mission.kept import is_listed

#: Commands of fences and rally points, which belong into no mission.
NO_MISSION_COMMANDS = frozenset(
    (
        Command.NAV_FENCE_RETURN_POINT,
        Command.NAV_FENCE_POLYGON_VERTEX_INCLUSION,
        Command.NAV_FENCE_POLYGON_VERTEX_EXCLUSION,
        Command.NAV_FENCE_CIRCLE_INCLUSION,
        Command.NAV_FENCE_CIRCLE_EXCLUSION,
        Command.NAV_RALLY_POINT,
    )
)

#: Commands that PX4 takes with a place in a global frame.
PX4_WITH_PLACE = frozenset(
    (
        Command.NAV_WAYPOINT,
        Command.NAV_LOITER_UNLIM,
        Command.NAV_LOITER_TIME,
        Command.NAV_LAND,
        Command.NAV_TAKEOFF,
        Command.NAV_LOITER_TO_ALT,
        Command.NAV_VTOL_TAKEOFF,
        Command.NAV_VTOL_LAND,
        Command.DO_SET_ROI,
        Command.DO_SET_ROI_LOCATION,
        mavlink.MAV_CMD_CONDITION_GATE,
    )
)

#: Commands that PX4 takes in frame MISSION, which has no place.
PX4_WITHOUT_PLACE = frozenset(
    (
        Command.DO_JUMP,
        Command.DO_SET_ROI,
        Command.DO_CHANGE_SPEED,
        Command.DO_SET_HOME,
        Command.DO_LAND_START,
        Command.DO_SET_CAM_TRIGG_DIST,
        Command.DO_VTOL_TRANSITION,
        Command.NAV_DELAY,
        Command.NAV_RETURN_TO_LAUNCH,
        Command.DO_SET_ROI_NONE,
        Command.CONDITION_DELAY,
        Command.CONDITION_DISTANCE,
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
        mavlink.MAV_CMD_DO_SET_CAM_TRIGG_INTERVAL,
        mavlink.MAV_CMD_SET_CAMERA_MODE,
        mavlink.MAV_CMD_SET_CAMERA_FOCUS,
        mavlink.MAV_CMD_SET_CAMERA_SOURCE,
        mavlink.MAV_CMD_DO_SET_ROI_WPNEXT_OFFSET,
        mavlink.MAV_CMD_DO_SET_ACTUATOR,
        mavlink.MAV_CMD_DO_AUTOTUNE_ENABLE,
        mavlink.MAV_CMD_COMPONENT_ARM_DISARM,
    )
)

#: Commands of which ArduPilot stores a place, and therefore looks at frame and altitude (stored_in_location).
ARDUPILOT_STORES_PLACE = frozenset(
    (
        Command.NAV_WAYPOINT,
        Command.NAV_LOITER_UNLIM,
        Command.NAV_LOITER_TURNS,
        Command.NAV_LOITER_TIME,
        Command.NAV_LAND,
        Command.NAV_TAKEOFF,
        Command.NAV_CONTINUE_AND_CHANGE_ALT,
        Command.NAV_LOITER_TO_ALT,
        Command.NAV_SPLINE_WAYPOINT,
        Command.NAV_VTOL_TAKEOFF,
        Command.NAV_VTOL_LAND,
        Command.NAV_PAYLOAD_PLACE,
        Command.DO_SET_HOME,
        Command.DO_LAND_START,
        Command.DO_SET_ROI,
        Command.DO_SET_ROI_LOCATION,
        mavlink.MAV_CMD_NAV_GUIDED_ENABLE,
        mavlink.MAV_CMD_DO_RETURN_PATH_START,
        mavlink.MAV_CMD_DO_GO_AROUND,
    )
)

#: Parameters, counted from 1, that ArduPilot lets be NaN (sanity_check_params); no others.
ARDUPILOT_NAN_ALLOWED: dict[int, tuple[int, ...]] = {
    Command.NAV_WAYPOINT: (4,),
    Command.NAV_LAND: (4,),
    Command.NAV_TAKEOFF: (4,),
    Command.NAV_VTOL_TAKEOFF: (4,),
    Command.NAV_VTOL_LAND: (3, 4),
}

ARDUPILOT_HIGHEST = 83_000.0  # [m] Location.h, LOCATION_ALT_MAX_M: altitudes of this and above are refused

#: StorageManager.cpp, on boards with 16 kB: "718 waypoints" on copters, "724" on planes; home is one of them.
ARDUCOPTER_CAPACITY, ARDUPLANE_CAPACITY = 718, 724
PX4_CAPACITY = 2000  # navigation.h, NUM_MISSIONS_SUPPORTED on flight controllers; 500 in some releases

_PX4_FRAMES = frozenset((Frame.GLOBAL, Frame.GLOBAL_RELATIVE_ALT, Frame.MISSION))
_ARDUPILOT_FRAMES = _PX4_FRAMES | {Frame.GLOBAL_TERRAIN_ALT}


def ardupilot_takes(command: int) -> bool:
    """Whether ArduPilot takes the command into a mission; whether it does anything there is another question."""
    return is_listed(command, "ardupilot") and command not in NO_MISSION_COMMANDS


def ardupilot_takes_frame(command: int, frame: int) -> bool:
    """Whether ArduPilot takes the command in this frame; without a place it does not look at it."""
    return command not in ARDUPILOT_STORES_PLACE or plain_frame(frame) in _ARDUPILOT_FRAMES


def px4_takes_frame(frame: int) -> bool:
    """Whether PX4 takes anything at all in this frame."""
    return plain_frame(frame) in _PX4_FRAMES
