"""How a transfer ended, and what a vehicle's refusal means."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Literal, TypeAlias

from pymavlink.dialects.v20 import ardupilotmega as mavlink

from gcs_windplan.mission import MissionItem, command_name, frame_name

Verdict: TypeAlias = Literal["accepted", "rejected", "unknown"]

Reason: TypeAlias = Literal[
    "done",  # what was asked is done
    "refused",  # the vehicle sent a refusal; `code` says which
    "mavlink1",  # the vehicle speaks MAVLink 1 only, which knows missions and nothing else
    "busy",  # the vehicle refused because of another transfer, twice
    "no-answer",  # the vehicle is there and answered nothing
    "stalled",  # the vehicle is there and stopped asking or answering half-way
    "lost",  # nothing at all was heard from the vehicle
    "restarted",  # the vehicle rebooted during the transfer
    "protocol",  # the vehicle broke the protocol: it asked for what is not there, or accepted too early
    "unconfirmed",  # everything was sent, the last word was not heard
    "differs",  # what was read back is not what was sent
    "changed",  # what was being read changed meanwhile
    "unreadable",  # the vehicle sent an item that cannot be
    "interrupted",  # by the user
    "time-out",  # it took longer than the time given for everything
]


@dataclass(frozen=True, slots=True)
class Outcome:
    """The end of a transfer.

    `accepted`: the vehicle said so. `rejected`: it said no, or is proved to hold something else. `unknown`:
    neither is certain. `code` is MAVLink's MAV_MISSION_RESULT, `seq` the item that was refused (home is 0 on
    ArduPilot), `parameter` what of it. `notes` are oddities on the way, a sentence each.
    """

    verdict: Verdict
    reason: Reason
    message: str
    code: int | None = None
    seq: int | None = None
    parameter: str | None = None
    notes: tuple[str, ...] = ()

    def noted(self, *notes: str) -> Outcome:
        """The same with more notes."""
        return replace(self, notes=(*self.notes, *notes))


ACCEPTED = int(mavlink.MAV_MISSION_ACCEPTED)
ERROR = int(mavlink.MAV_MISSION_ERROR)
UNSUPPORTED_FRAME = int(mavlink.MAV_MISSION_UNSUPPORTED_FRAME)
UNSUPPORTED = int(mavlink.MAV_MISSION_UNSUPPORTED)
NO_SPACE = int(mavlink.MAV_MISSION_NO_SPACE)
INVALID_SEQUENCE = int(mavlink.MAV_MISSION_INVALID_SEQUENCE)
DENIED = int(mavlink.MAV_MISSION_DENIED)
CANCELLED = int(mavlink.MAV_MISSION_OPERATION_CANCELLED)
_FIRST_PARAMETER = int(mavlink.MAV_MISSION_INVALID_PARAM1)
_LAST_PARAMETER = int(mavlink.MAV_MISSION_INVALID_PARAM7)

_MEANINGS = {
    NO_SPACE: "the vehicle has no room for so many items",
    DENIED: "the vehicle takes none from here now; another ground station may be sending to it",
    CANCELLED: "the vehicle broke the transfer off",
}


def code_name(code: int) -> str:
    """The refusal's name without MAV_MISSION_, with its number."""
    entry = mavlink.enums["MAV_MISSION_RESULT"].get(code)
    return f"unknown code {code}" if entry is None else f"{str(entry.name).removeprefix('MAV_MISSION_')} ({code})"


def refusal(code: int, seq: int | None = None, item: MissionItem | None = None) -> Outcome:
    """The outcome of a refusal by the vehicle; `seq` and `item` are what it answered, if it was an item."""
    parameter = None if item is None else _offence(code, item)
    place = "" if seq is None or item is None else f" at item {seq} ({command_name(item.command)})"
    details = [part for part in (parameter, _MEANINGS.get(code)) if part is not None]
    message = f"the vehicle refused with {code_name(code)}{place}{': ' if details else ''}{'; '.join(details)}"
    return Outcome("rejected", "refused", message, code, seq, parameter)


def _offence(code: int, item: MissionItem) -> str | None:
    """What of an item a refusal names, with its value."""
    if code == UNSUPPORTED_FRAME:
        return f"frame {frame_name(item.frame)}"
    if code == UNSUPPORTED:
        return f"command {command_name(item.command)}"
    if not _FIRST_PARAMETER <= code <= _LAST_PARAMETER:
        return None
    number = code - _FIRST_PARAMETER
    values = (*item.params, item.latitude_deg, item.longitude_deg, item.altitude)
    return f"parameter {number + 1} is {values[number]:.10g}"
