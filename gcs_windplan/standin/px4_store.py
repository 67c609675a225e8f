"""What PX4 refuses of an item, and what it keeps.

By mavlink_mission.cpp (parse_mavlink_mission_item, format_mavlink_mission_item) and the mission feasibility
checker.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

from pymavlink.dialects.v20 import ardupilotmega as mavlink

from gcs_windplan.mission import Command, Frame, command_name, frame_name, is_global, plain_frame, takes_place
from gcs_windplan.mission.supported import PX4_CAPACITY, PX4_WITHOUT_PLACE
from gcs_windplan.standin.items import FENCE, MISSION, RALLY, Params, Refusal, StoredItem, single

#: dataman.h: 64 fence points, 32 safe points.
CAPACITY = {MISSION: PX4_CAPACITY, FENCE: 64, RALLY: 32}

_VERTICES = (
    mavlink.MAV_CMD_NAV_FENCE_POLYGON_VERTEX_INCLUSION,
    mavlink.MAV_CMD_NAV_FENCE_POLYGON_VERTEX_EXCLUSION,
)
_CIRCLES = (mavlink.MAV_CMD_NAV_FENCE_CIRCLE_INCLUSION, mavlink.MAV_CMD_NAV_FENCE_CIRCLE_EXCLUSION)
_NO_MISSION_ITEMS = (*_VERTICES, *_CIRCLES, mavlink.MAV_CMD_NAV_RALLY_POINT)

#: Which of parameters 1 to 4 are kept in a global frame; the fourth is a yaw where it says so.
_IN_GLOBAL_FRAME: dict[int, tuple[int, ...]] = {
    Command.NAV_WAYPOINT: (0, 1, 3),
    Command.NAV_LOITER_UNLIM: (2, 3),
    Command.NAV_LOITER_TIME: (0, 1, 2, 3),
    Command.NAV_LAND: (1, 3),
    Command.NAV_TAKEOFF: (3,),
    Command.NAV_LOITER_TO_ALT: (0, 1, 3),
    Command.NAV_VTOL_TAKEOFF: (3,),
    Command.NAV_VTOL_LAND: (3,),
    Command.DO_SET_ROI: (0,),
    Command.DO_SET_ROI_LOCATION: (),
    mavlink.MAV_CMD_CONDITION_GATE: (),
    mavlink.MAV_CMD_NAV_FENCE_RETURN_POINT: (),
    **dict.fromkeys((*_VERTICES, *_CIRCLES), (0,)),
    mavlink.MAV_CMD_NAV_RALLY_POINT: (),
}
_YAW = (
    Command.NAV_WAYPOINT,
    Command.NAV_LOITER_UNLIM,
    Command.NAV_LAND,
    Command.NAV_TAKEOFF,
    Command.NAV_VTOL_TAKEOFF,
    Command.NAV_VTOL_LAND,
)
_FLAGS: dict[int, tuple[int, ...]] = {Command.NAV_LOITER_TIME: (1, 3), Command.NAV_LOITER_TO_ALT: (0, 3)}
_GLOBAL_FRAMES = {Frame.GLOBAL: Frame.GLOBAL_INT, Frame.GLOBAL_RELATIVE_ALT: Frame.GLOBAL_RELATIVE_ALT_INT}


def keep(item: StoredItem, mission_type: int) -> StoredItem | Refusal:
    """The item as PX4 gives it back when asked for it as MISSION_ITEM_INT (whose frames are 5 and 6), or its no."""
    frame = plain_frame(item.frame)
    if frame in _GLOBAL_FRAMES:
        kept = _keep_place(item, _GLOBAL_FRAMES[Frame(frame)])
    elif frame == Frame.MISSION:
        kept = _keep_without_place(item)
    else:
        return Refusal(mavlink.MAV_MISSION_UNSUPPORTED_FRAME, f"{frame_name(item.frame)} is not supported")
    if isinstance(kept, Refusal):
        return kept
    return _refused_for_its_type(kept, mission_type) or kept


def infeasible(items: Sequence[StoredItem]) -> str | None:
    """Why PX4 would not fly a mission that it took, or None."""
    positions = [item.command for item in items if _is_position(item)]
    if any(command in (Command.NAV_TAKEOFF, Command.NAV_VTOL_TAKEOFF) for command in positions[1:]):
        return "takeoff is not the first waypoint item"
    for seq, item in enumerate(items):
        if item.has_place and not math.isfinite(item.z):
            return f"item {seq} has no altitude"
        if item.command == Command.DO_JUMP and not 0 <= item.params[0] < len(items):
            return f"a jump leads to item {item.params[0]:.0f}, and there is none"
    return None


def _keep_place(item: StoredItem, frame: Frame) -> StoredItem | Refusal:
    kept = _IN_GLOBAL_FRAME.get(item.command)
    if kept is None:
        where = "only without a place" if item.command in PX4_WITHOUT_PLACE else "not"
        return Refusal(mavlink.MAV_MISSION_UNSUPPORTED, f"{command_name(item.command)} is {where} supported")
    if item.command == Command.DO_SET_ROI and int(_finite(item.params[0])) not in (0, 3):  # none, a location
        return Refusal(mavlink.MAV_MISSION_INVALID_PARAM1, "this region of interest takes no place")
    params = [single(param) if i in kept else 0.0 for i, param in enumerate(item.params)]
    if item.command in _YAW:
        params[3] = single(item.params[3] % 360.0) if math.isfinite(item.params[3]) else math.nan
    for i in _FLAGS.get(item.command, ()):
        params[i] = 1.0 if item.params[i] > 0 else 0.0
    if item.command in _VERTICES:
        params[0] = float(int(_finite(item.params[0]) + 0.5))
    return StoredItem(frame, item.command, _four(params), item.x, item.y, single(item.z), item.autocontinue)


def _keep_without_place(item: StoredItem) -> StoredItem | Refusal:
    if item.command not in PX4_WITHOUT_PLACE:
        return Refusal(
            mavlink.MAV_MISSION_UNSUPPORTED, f"{command_name(item.command)} is not supported without a place"
        )
    if item.command == Command.DO_SET_ROI and int(_finite(item.params[0])) not in (0, 1, 2):
        return Refusal(mavlink.MAV_MISSION_INVALID_PARAM1, "this region of interest needs a place")
    params = [single(param) for param in item.params]
    if item.command == Command.DO_JUMP:
        params[:2] = (float(int(_finite(param))) for param in item.params[:2])
    return StoredItem(Frame.MISSION, item.command, _four(params), item.x, item.y, single(item.z), item.autocontinue)


def _refused_for_its_type(item: StoredItem, mission_type: int) -> Refusal | None:
    name = command_name(item.command)
    if mission_type == MISSION and item.command in _NO_MISSION_ITEMS:
        return Refusal(mavlink.MAV_MISSION_ERROR, f"{name} belongs to no mission")
    if mission_type == FENCE and item.command in _VERTICES and item.params[0] < 3:
        return Refusal(mavlink.MAV_MISSION_ERROR, f"a polygon of {item.params[0]:.0f} corners")
    return None


def _is_position(item: StoredItem) -> bool:
    interest = item.command in (Command.DO_SET_ROI, Command.DO_SET_ROI_LOCATION)
    return is_global(item.frame) and takes_place(item.command) and not interest


def _finite(number: float) -> float:
    return number if math.isfinite(number) else -1.0


def _four(params: Sequence[float]) -> Params:
    p1, p2, p3, p4 = params
    return p1, p2, p3, p4
