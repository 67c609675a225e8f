"""The MAVLink numbers of mission commands and frames, by name (pymavlink's `common` dialect).

Files and vehicles may use others: a command or a frame is a plain int everywhere, and the enums here only
name those that this package writes or reasons about. The dialect is imported directly; pymavlink's `mavutil`
changes the process's environment when imported.
"""

from __future__ import annotations

from enum import IntEnum

from pymavlink.dialects.v20 import common as mavlink


class Command(IntEnum):
    """A command of missions, fences and rally points (MAV_CMD without its prefix)."""

    NAV_WAYPOINT = mavlink.MAV_CMD_NAV_WAYPOINT
    NAV_LOITER_UNLIM = mavlink.MAV_CMD_NAV_LOITER_UNLIM
    NAV_LOITER_TURNS = mavlink.MAV_CMD_NAV_LOITER_TURNS
    NAV_LOITER_TIME = mavlink.MAV_CMD_NAV_LOITER_TIME
    NAV_RETURN_TO_LAUNCH = mavlink.MAV_CMD_NAV_RETURN_TO_LAUNCH
    NAV_LAND = mavlink.MAV_CMD_NAV_LAND
    NAV_TAKEOFF = mavlink.MAV_CMD_NAV_TAKEOFF
    NAV_CONTINUE_AND_CHANGE_ALT = mavlink.MAV_CMD_NAV_CONTINUE_AND_CHANGE_ALT
    NAV_LOITER_TO_ALT = mavlink.MAV_CMD_NAV_LOITER_TO_ALT
    NAV_SPLINE_WAYPOINT = mavlink.MAV_CMD_NAV_SPLINE_WAYPOINT
    NAV_VTOL_TAKEOFF = mavlink.MAV_CMD_NAV_VTOL_TAKEOFF
    NAV_VTOL_LAND = mavlink.MAV_CMD_NAV_VTOL_LAND
    NAV_DELAY = mavlink.MAV_CMD_NAV_DELAY
    NAV_PAYLOAD_PLACE = mavlink.MAV_CMD_NAV_PAYLOAD_PLACE
    CONDITION_DELAY = mavlink.MAV_CMD_CONDITION_DELAY
    CONDITION_DISTANCE = mavlink.MAV_CMD_CONDITION_DISTANCE
    CONDITION_YAW = mavlink.MAV_CMD_CONDITION_YAW
    DO_JUMP = mavlink.MAV_CMD_DO_JUMP
    DO_CHANGE_SPEED = mavlink.MAV_CMD_DO_CHANGE_SPEED
    DO_SET_HOME = mavlink.MAV_CMD_DO_SET_HOME
    DO_LAND_START = mavlink.MAV_CMD_DO_LAND_START
    DO_SET_ROI_LOCATION = mavlink.MAV_CMD_DO_SET_ROI_LOCATION
    DO_SET_ROI_NONE = mavlink.MAV_CMD_DO_SET_ROI_NONE
    DO_SET_ROI = mavlink.MAV_CMD_DO_SET_ROI
    DO_SET_CAM_TRIGG_DIST = mavlink.MAV_CMD_DO_SET_CAM_TRIGG_DIST
    DO_VTOL_TRANSITION = mavlink.MAV_CMD_DO_VTOL_TRANSITION
    DO_JUMP_TAG = mavlink.MAV_CMD_DO_JUMP_TAG
    JUMP_TAG = mavlink.MAV_CMD_JUMP_TAG
    NAV_FENCE_RETURN_POINT = mavlink.MAV_CMD_NAV_FENCE_RETURN_POINT
    NAV_FENCE_POLYGON_VERTEX_INCLUSION = mavlink.MAV_CMD_NAV_FENCE_POLYGON_VERTEX_INCLUSION
    NAV_FENCE_POLYGON_VERTEX_EXCLUSION = mavlink.MAV_CMD_NAV_FENCE_POLYGON_VERTEX_EXCLUSION
    NAV_FENCE_CIRCLE_INCLUSION = mavlink.MAV_CMD_NAV_FENCE_CIRCLE_INCLUSION
    NAV_FENCE_CIRCLE_EXCLUSION = mavlink.MAV_CMD_NAV_FENCE_CIRCLE_EXCLUSION
    NAV_RALLY_POINT = mavlink.MAV_CMD_NAV_RALLY_POINT


TAKEOFFS = frozenset((Command.NAV_TAKEOFF, Command.NAV_VTOL_TAKEOFF))
LANDINGS = frozenset((Command.NAV_LAND, Command.NAV_VTOL_LAND))


class Frame(IntEnum):
    """What an item's place and altitude refer to (MAV_FRAME without its prefix)."""

    GLOBAL = mavlink.MAV_FRAME_GLOBAL  # AMSL
    MISSION = mavlink.MAV_FRAME_MISSION  # no place at all
    GLOBAL_RELATIVE_ALT = mavlink.MAV_FRAME_GLOBAL_RELATIVE_ALT  # above home
    GLOBAL_INT = mavlink.MAV_FRAME_GLOBAL_INT
    GLOBAL_RELATIVE_ALT_INT = mavlink.MAV_FRAME_GLOBAL_RELATIVE_ALT_INT
    GLOBAL_TERRAIN_ALT = mavlink.MAV_FRAME_GLOBAL_TERRAIN_ALT  # above the ground below
    GLOBAL_TERRAIN_ALT_INT = mavlink.MAV_FRAME_GLOBAL_TERRAIN_ALT_INT


# The _INT frames are deprecated and mean the same as the plain ones (MAVLink common.xml, MAV_FRAME).
_PLAIN_FRAMES: dict[int, Frame] = {
    Frame.GLOBAL_INT: Frame.GLOBAL,
    Frame.GLOBAL_RELATIVE_ALT_INT: Frame.GLOBAL_RELATIVE_ALT,
    Frame.GLOBAL_TERRAIN_ALT_INT: Frame.GLOBAL_TERRAIN_ALT,
}
_GLOBAL_FRAMES = frozenset((Frame.GLOBAL, Frame.GLOBAL_RELATIVE_ALT, Frame.GLOBAL_TERRAIN_ALT))


def plain_frame(frame: int) -> int:
    """The frame without the deprecated _INT: 5 becomes 0, 6 becomes 3, 11 becomes 10, all others stay."""
    return int(_PLAIN_FRAMES.get(frame, frame))


def is_global(frame: int) -> bool:
    """Whether the frame's places are latitudes and longitudes."""
    return plain_frame(frame) in _GLOBAL_FRAMES


def takes_place(command: int) -> bool:
    """Whether the command has a latitude, a longitude and an altitude; a command unknown here has none."""
    entry = mavlink.enums["MAV_CMD"].get(command)
    return entry is not None and bool(entry.has_location)


def scales_place(command: int, frame: int) -> bool:
    """Whether parameters 5 and 6 travel in 1e-7 degrees; else MISSION_ITEM_INT carries them as they are.

    Not in frame MISSION, as QGroundControl and MAVSDK have it, nor for a command known to have no place, as
    ArduPilot has it (DO_DIGICAM_CONTROL's shot is x = 1).
    """
    entry = mavlink.enums["MAV_CMD"].get(command)
    return is_global(frame) and (entry is None or bool(entry.has_location))


def command_name(command: int) -> str:
    """The command's name without MAV_CMD_, or `command 12345` for one unknown here."""
    entry = mavlink.enums["MAV_CMD"].get(command)
    return f"command {command}" if entry is None else str(entry.name).removeprefix("MAV_CMD_")


def frame_name(frame: int) -> str:
    """The frame's name without MAV_FRAME_, or `frame 77` for one unknown here."""
    entry = mavlink.enums["MAV_FRAME"].get(frame)
    return f"frame {frame}" if entry is None else str(entry.name).removeprefix("MAV_FRAME_")
