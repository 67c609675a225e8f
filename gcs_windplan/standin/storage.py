"""What a vehicle refuses of an item, what it stores, and what it thinks of a whole list, by its firmware's table."""

from __future__ import annotations

import math
from collections.abc import Sequence

from pymavlink.dialects.v20 import ardupilotmega as mavlink

from gcs_windplan.mission.commands import TAKEOFFS, Frame, command_name, frame_name, is_global, plain_frame
from gcs_windplan.mission.firmware import CommandRule, Firmware, stores
from gcs_windplan.mission.firmware.storage import FLOAT
from gcs_windplan.standin.items import FENCE, MISSION, TYPE_NAMES, Refusal, StoredItem

_RALLY_POINT = mavlink.MAV_CMD_NAV_RALLY_POINT
_RALLY_RULE = stores(place=True)
_POLYGONS = (
    mavlink.MAV_CMD_NAV_FENCE_POLYGON_VERTEX_INCLUSION,
    mavlink.MAV_CMD_NAV_FENCE_POLYGON_VERTEX_EXCLUSION,
)
_CIRCLES = (mavlink.MAV_CMD_NAV_FENCE_CIRCLE_INCLUSION, mavlink.MAV_CMD_NAV_FENCE_CIRCLE_EXCLUSION)
_INT_FRAMES = {
    Frame.GLOBAL: Frame.GLOBAL_INT,
    Frame.GLOBAL_RELATIVE_ALT: Frame.GLOBAL_RELATIVE_ALT_INT,
    Frame.GLOBAL_TERRAIN_ALT: Frame.GLOBAL_TERRAIN_ALT_INT,
}


def store(item: StoredItem, mission_type: int, firmware: Firmware) -> StoredItem | Refusal:
    """The item as the vehicle gives it back when asked for it again, or its no."""
    if item.command == 0:
        return Refusal(mavlink.MAV_MISSION_INVALID, "command 0 is none")
    rule = _rule(item, mission_type, firmware)
    frame_refused = _refused_frame(item, mission_type, rule, firmware)
    if firmware.transfers.frame_first and frame_refused is not None:
        return frame_refused
    if rule is None:
        return _refused_number(item, stores(), firmware) or _unknown(item, mission_type, firmware)
    refusal = _refused_number(item, rule, firmware) if mission_type == MISSION else None
    refusal = refusal or _refused_place(item, mission_type, rule, firmware) or frame_refused
    return refusal or _stored(item, mission_type, rule, firmware)


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


def infeasible(items: Sequence[StoredItem], firmware: Firmware) -> str | None:
    """Why a mission that was taken would not be flown, or None; for a firmware that looks at it."""
    if firmware.feasibility is None:
        return None
    positions = [item.command for item in items if item.command in firmware.feasibility.positions]
    if any(command in TAKEOFFS for command in positions[1:]):
        return "takeoff is not the first waypoint item"
    for seq, item in enumerate(items):
        if item.has_place and not math.isfinite(item.z):
            return f"item {seq} has no altitude"
        if item.command == mavlink.MAV_CMD_DO_JUMP and not 0 <= item.params[0] < len(items):
            return f"a jump leads to item {item.params[0]:.0f}, and there is none"
    return None


def _rule(item: StoredItem, mission_type: int, firmware: Firmware) -> CommandRule | None:
    if mission_type == MISSION:
        return firmware.rule(item.command, item.frame)
    if mission_type == FENCE:
        return firmware.fence.get(item.command)
    return _RALLY_RULE if item.command == _RALLY_POINT else None


def _unknown(item: StoredItem, mission_type: int, firmware: Firmware) -> Refusal:
    name = command_name(item.command)
    if mission_type == MISSION and firmware.placeless is not None and firmware.takes(item.command):
        elsewhere = "without a place" if is_global(item.frame) else "with a place"
        return Refusal(mavlink.MAV_MISSION_UNSUPPORTED, f"{name} is only supported {elsewhere}")
    known = mission_type == MISSION and (item.command in firmware.fence or item.command == _RALLY_POINT)
    if known and firmware.transfers.frame_first:  # it looks for the list only when it stores the item
        return Refusal(mavlink.MAV_MISSION_ERROR, f"{name} belongs to no mission")
    return Refusal(mavlink.MAV_MISSION_UNSUPPORTED, f"{name} is not known in a list of {TYPE_NAMES[mission_type]}")


def _refused_frame(item: StoredItem, mission_type: int, rule: CommandRule | None, firmware: Firmware) -> Refusal | None:
    frame, name = plain_frame(item.frame), frame_name(item.frame)
    if mission_type == MISSION:
        taken = firmware.takes_frame(item.command, item.frame)
    elif mission_type == FENCE:
        taken = is_global(frame) and (not firmware.transfers.frame_first or frame in firmware.frames)
    else:
        taken = rule is None or frame in firmware.rally_frames
    return None if taken else Refusal(mavlink.MAV_MISSION_UNSUPPORTED_FRAME, f"{name} is not supported")


def _refused_number(item: StoredItem, rule: CommandRule, firmware: Firmware) -> Refusal | None:
    """NaN, infinity, and values that parameter 1 must not have."""
    kind = item.params[0]
    if rule.choices and (int(kind) if math.isfinite(kind) else -1) not in rule.choices:
        return Refusal(mavlink.MAV_MISSION_INVALID_PARAM1, f"parameter 1 is {kind} and none of {rule.choices}")
    for i, param in enumerate(item.params) if firmware.checks_numbers else ():
        if math.isinf(param) or (math.isnan(param) and i + 1 not in rule.nan):
            return Refusal(mavlink.MAV_MISSION_INVALID_PARAM1 + i, f"parameter {i + 1} is {param}")
    return None


def _refused_place(item: StoredItem, mission_type: int, rule: CommandRule, firmware: Firmware) -> Refusal | None:
    if not rule.place or not firmware.checks_numbers or mission_type == FENCE:  # a fence is looked at as a whole
        return None
    misplaced = _misplaced(item)
    if misplaced is not None:
        return misplaced
    highest = firmware.highest if mission_type == MISSION else firmware.rally_highest
    if highest is not None and not abs(item.z) < highest:
        return Refusal(mavlink.MAV_MISSION_INVALID_PARAM7, f"the altitude is {item.z} m")
    return None


def _misplaced(item: StoredItem) -> Refusal | None:
    if abs(item.x) > 900_000_000:
        return Refusal(mavlink.MAV_MISSION_INVALID_PARAM5_X, f"the latitude is {item.latitude_deg}°")
    if abs(item.y) > 1_800_000_000:
        return Refusal(mavlink.MAV_MISSION_INVALID_PARAM6_Y, f"the longitude is {item.longitude_deg}°")
    return None


def _stored(item: StoredItem, mission_type: int, rule: CommandRule, firmware: Firmware) -> StoredItem | Refusal:
    p1, p2, p3, p4 = (way.held(param) for way, param in zip(rule.params, item.params, strict=False))
    if mission_type == FENCE and item.command in _POLYGONS and firmware.transfers.frame_first and p1 < 3:
        return Refusal(mavlink.MAV_MISSION_ERROR, f"a polygon of {p1:.0f} corners")
    if rule.place:
        way = firmware.rally if mission_type not in (MISSION, FENCE) else firmware.altitude
        x, y, z = item.x, item.y, rule.params[6].held(item.z) if mission_type == FENCE else way.held(item.z)
    else:
        x, y = (int(way.held(number)) for way, number in zip(rule.params[4:6], (item.x, item.y), strict=True))
        x, y = (item.x, item.y) if rule.params[4] == FLOAT else (x, y)
        z = rule.params[6].held(item.z)
    autocontinue = item.autocontinue or not firmware.stores_autocontinue
    return StoredItem(_frame_back(item, rule, firmware), item.command, (p1, p2, p3, p4), x, y, z, autocontinue)


def _frame_back(item: StoredItem, rule: CommandRule, firmware: Firmware) -> int:
    """The frame that comes back: where no frame has a table of its own, that of a placeless item is GLOBAL."""
    frame = plain_frame(item.frame)
    if firmware.placeless is None and (not rule.place or frame == Frame.MISSION or item.command in firmware.fence):
        return int(Frame.GLOBAL)
    return int(_INT_FRAMES.get(Frame(frame), frame)) if firmware.transfers.reads_back_int else frame
