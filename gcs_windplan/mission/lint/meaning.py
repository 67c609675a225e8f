"""What a command's parameter stands for, in two or three words, for those that people set."""

from __future__ import annotations

from pymavlink.dialects.v20 import ardupilotmega as mavlink

from gcs_windplan.mission.commands import Command

_HOLD, _YAW, _RADIUS, _COUNT = "hold [s]", "yaw [deg]", "radius [m]", "count"
_EXIT = "where to leave the circle, or yaw"

_MEANINGS: dict[tuple[int, int], str] = {
    (Command.NAV_WAYPOINT, 1): _HOLD,
    (Command.NAV_WAYPOINT, 2): "acceptance radius [m]",
    (Command.NAV_WAYPOINT, 3): "distance to pass by [m]",
    (Command.NAV_WAYPOINT, 4): _YAW,
    (Command.NAV_SPLINE_WAYPOINT, 1): _HOLD,
    (Command.NAV_LOITER_UNLIM, 3): _RADIUS,
    (Command.NAV_LOITER_UNLIM, 4): _YAW,
    (Command.NAV_LOITER_TURNS, 1): "turns",
    (Command.NAV_LOITER_TURNS, 3): _RADIUS,
    (Command.NAV_LOITER_TURNS, 4): _EXIT,
    (Command.NAV_LOITER_TIME, 1): "time [s]",
    (Command.NAV_LOITER_TIME, 3): _RADIUS,
    (Command.NAV_LOITER_TIME, 4): _EXIT,
    (Command.NAV_LOITER_TO_ALT, 2): _RADIUS,
    (Command.NAV_LOITER_TO_ALT, 4): _EXIT,
    (Command.NAV_LAND, 1): "altitude to abort to [m]",
    (Command.NAV_LAND, 2): "precision landing",
    (Command.NAV_LAND, 4): _YAW,
    (Command.NAV_TAKEOFF, 1): "pitch [deg]",
    (Command.NAV_TAKEOFF, 4): _YAW,
    (Command.NAV_VTOL_TAKEOFF, 4): _YAW,
    (Command.NAV_VTOL_LAND, 4): _YAW,
    (Command.CONDITION_YAW, 3): "way round",
    (Command.DO_JUMP, 1): "item to jump to",
    (Command.DO_JUMP, 2): _COUNT,
    (mavlink.MAV_CMD_DO_SET_SERVO, 1): "servo",
    (mavlink.MAV_CMD_DO_SET_SERVO, 2): "PWM [us]",
}


def meaning(command: int, position: int) -> str:
    """` (hold [s])`, or nothing where no words are known."""
    words = _MEANINGS.get((command, position))
    return f" ({words})" if words else ""
