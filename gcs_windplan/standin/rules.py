"""What every mission server of a stand-in vehicle is asked, and what it is made of; it owns no socket and no clock."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Protocol

from pymavlink.dialects.v20 import ardupilotmega as mavlink

from gcs_windplan.link.codec import Message
from gcs_windplan.link.peer import Ident
from gcs_windplan.link.wire import MISSION_TYPES
from gcs_windplan.mission.firmware import Firmware
from gcs_windplan.standin.items import FENCE, MISSION, RALLY, TYPE_NAMES, StoredItem

#: The messages that a mission server answers.
MISSION_MESSAGES = frozenset(
    (
        "MISSION_COUNT",
        "MISSION_ITEM",
        "MISSION_ITEM_INT",
        "MISSION_REQUEST",
        "MISSION_REQUEST_INT",
        "MISSION_REQUEST_LIST",
        "MISSION_CLEAR_ALL",
        "MISSION_ACK",
        "MISSION_SET_CURRENT",
        "MISSION_WRITE_PARTIAL_LIST",
    )
)


class Pilot(Protocol):
    """What a mission server asks of the vehicle around it."""

    @property
    def flies_mission(self) -> bool:
        """Whether the mission is being flown right now."""

    @property
    def current(self) -> int:
        """The item that is flown, or would be flown next."""

    @property
    def home_item(self) -> StoredItem:
        """The vehicle's own home, as an item."""

    def jump(self, seq: int) -> bool:
        """Go on with another item; False where there is none."""

    def fly_there(self, item: StoredItem) -> bool:
        """Fly to a place at once, as ArduPilot does for an item with `current` 2; False where it cannot."""


@dataclass(slots=True)
class Parked:
    """A pilot that flies nowhere: for a server without a flight."""

    home_item: StoredItem = field(default_factory=lambda: StoredItem(0, mavlink.MAV_CMD_NAV_WAYPOINT))
    flies_mission: bool = False
    current: int = 0

    def jump(self, seq: int) -> bool:
        """Take the item as the one to begin with."""
        self.current = seq
        return True

    def fly_there(self, item: StoredItem) -> bool:
        """Stay where it is."""
        return False


class MissionServer(Protocol):
    """Answers mission messages by the rules of one autopilot.

    `arrived` are the types of which an upload was accepted since the set was last emptied; `notes` what
    happened, a sentence each, for a log.
    """

    arrived: set[int]
    notes: list[str]

    @property
    def wake(self) -> float:
        """When `tick` has something to do; infinite where nothing is on its way."""

    @property
    def items(self) -> Mapping[int, Sequence[StoredItem]]:
        """What the vehicle holds, by MAV_MISSION_TYPE."""

    @property
    def sent_home(self) -> StoredItem | None:
        """What was sent as ArduPilot's item 0, in whose place the vehicle gives its own home."""

    def handle(self, message: Message, now: float) -> list[Message]:
        """The answers to a mission message meant for this vehicle."""

    def tick(self, now: float) -> list[Message]:
        """What is due by the clock: requests again, and the end of an upload that fell silent."""

    def reboot(self, now: float) -> None:
        """Start again: what lay in the vehicle stays, what was on its way is lost."""


@dataclass(frozen=True, slots=True)
class ServerOptions:
    """What both servers need to know.

    `capacity` is the number of mission items, where it differs from the autopilot's own. A vehicle that speaks
    MAVLink 1 knows no fences and rally points.
    """

    system: int = 1
    component: int = mavlink.MAV_COMP_ID_AUTOPILOT1
    capacity: int | None = None
    mavlink1: bool = False


class Storekeeper:
    """What every server holds, and room for how much of it; see `MissionServer`."""

    def __init__(self, firmware: Firmware, pilot: Pilot, options: ServerOptions) -> None:
        self.arrived: set[int] = set()
        self.notes: list[str] = []
        self._firmware = firmware
        self._pilot = pilot
        self._options = options
        self._capacity = {MISSION_TYPES[kind]: most for kind, most in firmware.capacity.items()}
        if options.capacity is not None:
            self._capacity[MISSION] = options.capacity
        self._held: dict[int, list[StoredItem]] = {MISSION: [], FENCE: [], RALLY: []}


def acknowledge(to: Ident, code: int, mission_type: int) -> Message:
    """A MISSION_ACK."""
    return mavlink.MAVLink_mission_ack_message(to.system, to.component, code, mission_type)


def text(severity: int, words: str) -> Message:
    """A STATUSTEXT, cut to its 50 bytes."""
    return mavlink.MAVLink_statustext_message(severity, words.encode("ascii", "replace")[:50])


def result_name(code: int) -> str:
    """The name of a MAV_MISSION_RESULT with its number: INVALID_SEQUENCE (13)."""
    entry = mavlink.enums["MAV_MISSION_RESULT"].get(code)
    name = "unknown" if entry is None else str(entry.name).removeprefix("MAV_MISSION_")
    return f"{name} ({code})"


def type_name(mission_type: int) -> str:
    """What a MAV_MISSION_TYPE is called in the log."""
    return TYPE_NAMES.get(mission_type, f"mission type {mission_type}")
