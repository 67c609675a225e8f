"""Mission items as they lie in a vehicle: the plain numbers of MISSION_ITEM_INT, good or bad.

`MissionItem` refuses what no vehicle should fly; a vehicle must be able to look at such an item before it
refuses it.
"""

from __future__ import annotations

import struct
from dataclasses import dataclass, replace
from typing import TypeAlias

from pymavlink.dialects.v20 import ardupilotmega as mavlink

from gcs_windplan.link.codec import Message
from gcs_windplan.link.peer import Ident
from gcs_windplan.mission import is_global, plain_frame, scales_place, takes_place

Params: TypeAlias = tuple[float, float, float, float]

MISSION, FENCE, RALLY = 0, 1, 2  # MAV_MISSION_TYPE
TYPE_NAMES = {MISSION: "mission", FENCE: "fence", RALLY: "rally points"}


@dataclass(frozen=True, slots=True)
class StoredItem:
    """One item. `x` and `y` are 1e-7 degrees where the command has a place, and as they are elsewhere; `z` [m]."""

    frame: int
    command: int
    params: Params = (0.0, 0.0, 0.0, 0.0)
    x: int = 0
    y: int = 0
    z: float = 0.0
    autocontinue: bool = True
    current: int = 0

    @property
    def has_place(self) -> bool:
        """Whether the item names a place on Earth; latitude and longitude both zero mean "here"."""
        return takes_place(self.command) and is_global(self.frame) and not self.x == self.y == 0

    @property
    def latitude_deg(self) -> float:
        """The latitude [deg]."""
        return self.x / 1e7

    @property
    def longitude_deg(self) -> float:
        """The longitude [deg]."""
        return self.y / 1e7


@dataclass(frozen=True, slots=True)
class Refusal:
    """A vehicle's no to an item: the MAV_MISSION_RESULT and the reason in words."""

    code: int
    reason: str


def single(number: float) -> float:
    """The number as a 32-bit float has it."""
    return float(struct.unpack("<f", struct.pack("<f", number))[0])


def read_item(message: Message) -> StoredItem:
    """The item of a MISSION_ITEM_INT or a MISSION_ITEM (whose degrees are 32-bit floats, good to a metre)."""
    params = (message.param1, message.param2, message.param3, message.param4)
    x, y = message.x, message.y
    if message.get_type() == "MISSION_ITEM":
        scale = 1e7 if scales_place(message.command, message.frame) else 1.0
        x, y = _whole(x * scale), _whole(y * scale)
    return StoredItem(
        message.frame, message.command, params, x, y, message.z, bool(message.autocontinue), message.current
    )


def item_message(item: StoredItem, seq: int, to: Ident, mission_type: int, current: bool, as_int: bool) -> Message:
    """The item as MISSION_ITEM_INT, or as MISSION_ITEM for those who ask for that."""
    x: float = item.x
    y: float = item.y
    if not as_int and scales_place(item.command, item.frame):
        x, y = item.x / 1e7, item.y / 1e7
    make = mavlink.MAVLink_mission_item_int_message if as_int else mavlink.MAVLink_mission_item_message
    return make(
        to.system, to.component, seq, item.frame, item.command, int(current), int(item.autocontinue),
        *item.params, x, y, item.z, mission_type,
    )  # fmt: skip


def plain(item: StoredItem) -> StoredItem:
    """The item in the frame without _INT, as MISSION_ITEM wants it."""
    return replace(item, frame=plain_frame(item.frame))


def _whole(number: float) -> int:
    """The nearest 32-bit integer; the farthest one for numbers beyond it and for NaN."""
    if not abs(number) < 2**31:
        return 2**31 - 1
    return round(number)
