"""A mission item as MISSION_ITEM_INT and back."""

from __future__ import annotations

import math

from pymavlink.dialects.v20 import ardupilotmega as mavlink

from gcs_windplan.errors import InputError
from gcs_windplan.link.codec import Message
from gcs_windplan.mission import MissionItem, command_name, frame_name, plain_frame, scales_place, takes_place
from gcs_windplan.mission.firmware import MissionType

MISSION_TYPES: dict[MissionType, int] = {
    "mission": mavlink.MAV_MISSION_TYPE_MISSION,
    "fence": mavlink.MAV_MISSION_TYPE_FENCE,
    "rally": mavlink.MAV_MISSION_TYPE_RALLY,
}
"""MAVLink's numbers (MAV_MISSION_TYPE)."""

_LARGEST_FLOAT = 3.4028235e38  # IEEE 754 binary32
_LARGEST_INT = 2**31 - 1


def item_to_message(
    item: MissionItem,
    seq: int,
    target_system: int,
    target_component: int,
    mission_type: int,
    current: int = 0,
) -> Message:
    """The item as MISSION_ITEM_INT, latitude and longitude rounded to 1e-7 degrees.

    `mission_type` is MAVLink's number. `current` is 0 or 1 (the vehicle's next item); 2 and 3, which make
    ArduPilot fly there at once, raise ValueError. Deprecated _INT frames become plain ones. Raises InputError
    for numbers that MAVLink's fields cannot hold, and for a place in a frame that has none.
    """
    if current not in (0, 1):
        raise ValueError(f"current {current} would command the vehicle, not fill its mission")
    _refuse_too_large(item, seq)
    _refuse_parts(item, seq)
    return mavlink.MAVLink_mission_item_int_message(
        target_system,
        target_component,
        seq,
        plain_frame(item.frame),
        int(item.command),
        current,
        int(item.autocontinue),
        *item.params,
        item.x,
        item.y,
        item.altitude,
        mission_type,
    )


def message_to_item(message: Message) -> MissionItem:
    """The item of a MISSION_ITEM_INT. Raises InputError for one that cannot be: no place on Earth, infinite.

    A NaN altitude of an item without a place is its unset seventh parameter, and becomes 0.
    """
    params = (message.param1, message.param2, message.param3, message.param4)
    scale = 1e-7 if scales_place(message.command, message.frame) else 1.0
    unset = scale == 1.0 and math.isnan(message.z)
    return MissionItem(
        message.frame,
        message.command,
        params,
        _scaled(message.x, scale),
        _scaled(message.y, scale),
        0.0 if unset else message.z,
        bool(message.autocontinue),
    )


def _refuse_too_large(item: MissionItem, seq: int) -> None:
    floats = (*item.params, item.altitude)
    if any(abs(number) > _LARGEST_FLOAT for number in floats) or any(abs(n) > _LARGEST_INT for n in (item.x, item.y)):
        raise InputError(f"item {seq} ({command_name(item.command)}) has a number too large for MAVLink: {item}")


def _refuse_parts(item: MissionItem, seq: int) -> None:
    """Refuse what would be rounded: parameters 5 and 6 are whole numbers on the wire where they are no degrees."""
    if scales_place(item.command, item.frame):
        return
    which = f"item {seq} ({command_name(item.command)})"
    for number, value in ((5, item.latitude_deg), (6, item.longitude_deg)):
        if value == round(value):
            continue
        if takes_place(item.command):
            name = "latitude" if number == 5 else "longitude"
            frame = f"frame {frame_name(item.frame)}, which has no degrees"
            raise InputError(f"{which} has the {name} {value:.10g} in {frame}: give it a global frame, such as 0 or 3")
        raise InputError(
            f"{which} has {value:.10g} as parameter {number}, which MAVLink carries as a whole number only"
        )


def _scaled(number: int, scale: float) -> float:
    # dividing gives the nearest double to the decimal, multiplying by 1e-7 does not
    return number / 1e7 if scale != 1.0 else float(number)
