"""Upload of a mission, fence or rally points, as a state machine.

    announcing ──REQUEST──▶ sending ──all asked for──▶ finishing ──ACCEPTED──▶ accepted
       │    ▲                  │                           │
     ERROR  └───── resting ◀─ERROR                      silence ─▶ unconfirmed: to be read back
       └──────────────▲

It answers requests by their number and pushes nothing by itself, which would desynchronise ArduPilot; the one
exception is PX4's last item, which PX4 acknowledges again when its acknowledgement was lost.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Literal, TypeAlias

from pymavlink.dialects.v20 import ardupilotmega as mavlink

from gcs_windplan.errors import InputError
from gcs_windplan.link.codec import Message
from gcs_windplan.link.exchange import FIRST_RETRY, SENDS, SILENCE, Ends, Exchange
from gcs_windplan.link.outcome import ACCEPTED, CANCELLED, ERROR, INVALID_SEQUENCE, Outcome, code_name, refusal
from gcs_windplan.link.peer import Contact
from gcs_windplan.link.wire import item_to_message
from gcs_windplan.mission import MissionItem

_Phase: TypeAlias = Literal["announcing", "sending", "finishing", "resting"]

_LAST_WORD = 5.0  # [s] waited for the final ACK; vehicles are known to take 2
_PROGRESS = 30.0  # [s] without an item asked for the first time
_REST = 5.5  # [s] PX4 forgets a broken transfer after 5
_BASE, _PER_ITEM = 90.0, 3.0  # [s] bound of the whole; a slow, lossy radio link takes less
_MOST = 65_535  # items that MISSION_COUNT can announce


class Upload(Exchange):
    """Sends items until the vehicle acknowledges them all.

    The outcome `unconfirmed` says that all were asked for and sent, and the last word was not heard or not to
    be trusted: reading back decides. Raises InputError for more items than MAVLink can count.
    """

    def __init__(self, ends: Ends, items: Sequence[MissionItem], contact: Contact | None = None) -> None:
        if len(items) > _MOST:
            raise InputError(f"{len(items)} items are more than the {_MOST} that MAVLink can announce")
        super().__init__(ends, _BASE + _PER_ITEM * len(items), contact)
        self._items = tuple(items)
        self._messages = tuple(map(self._message, range(len(items)), items))
        self._phase: _Phase = "announcing"
        self._restarts = 0
        self._counts = 0
        self._asked: set[int] = set()
        self._highest = -1
        self._last_sent: int | None = None
        self._doubt = ""
        self._last_progress = 0.0
        self._repeated = False
        self._handlers = {
            "MISSION_REQUEST": self._handle_request,
            "MISSION_REQUEST_INT": self._handle_request,
            "MISSION_ACK": self._handle_ack,
        }

    @property
    def progress(self) -> tuple[int, int]:
        """How many items of how many were asked for."""
        return len(self._asked), len(self._items)

    def _begin(self, now: float) -> list[Message]:
        self._phase = "announcing"
        self._counts = 0
        self._asked.clear()
        self._highest = -1
        self._last_sent = None
        self._doubt = ""
        self._repeated = False
        return self._announce(now)

    def _announce(self, now: float) -> list[Message]:
        self._counts += 1
        self.wake = now + FIRST_RETRY
        return [mavlink.MAVLink_mission_count_message(*self.ends.peer.ident, len(self._items), self.ends.number)]

    def _tick(self, now: float) -> list[Message]:
        if self._phase == "resting":
            return self._begin(now)
        if self._phase == "announcing":
            if self._counts < SENDS:
                return self._announce(now)
            return self._quiet(now, "no-answer", f"the vehicle did not answer {SENDS} announcements of the upload")
        if self._phase == "sending":
            asked, count = self.progress
            return self._quiet(now, "stalled", f"the vehicle stopped asking after {asked} of {count} items")
        return self._press(now)

    def _press(self, now: float) -> list[Message]:
        """Everything is sent, the last word is missing."""
        if self._may_repeat():
            self._repeated = True
            self.wake = now + _LAST_WORD - FIRST_RETRY
            return [self._messages[-1]]
        return self._unconfirmed(self._doubt or "the vehicle's last word was not heard")

    def _may_repeat(self) -> bool:
        # after an error the repeated item would be accepted all the same
        firmware = self.ends.peer.firmware
        accepts = firmware is not None and firmware.transfers.repeats_acceptance
        return accepts and not self._repeated and not self._doubt

    @property
    def _minds_sequence(self) -> bool:
        firmware = self.ends.peer.firmware
        return firmware is not None and firmware.transfers.minds_sequence

    def _unconfirmed(self, message: str) -> list[Message]:
        return self._finish(Outcome("unknown", "unconfirmed", f"all items were sent, but {message}"))

    def _handle_request(self, message: Message, now: float) -> list[Message]:
        seq, count = message.seq, len(self._items)
        if self._phase == "resting":
            return []
        if seq >= count:
            return self._fail("protocol", f"the vehicle asked for item {seq} of {count} (0 to {count - 1})")
        if seq not in self._asked:
            self._note_progress(seq, now)
        elif now - self._last_progress > _PROGRESS:
            return self._fail("stalled", f"the vehicle asks for item {seq} again and again")
        self._last_sent = seq
        if len(self._asked) < count:
            self._phase, self.wake = "sending", now + SILENCE
        else:
            self._phase, self.wake = "finishing", now + (FIRST_RETRY if self._may_repeat() else _LAST_WORD)
        return [self._messages[seq]]

    def _note_progress(self, seq: int, now: float) -> None:
        if seq > self._highest + 1:
            self.notes.append(f"item {seq} was asked for before item {self._highest + 1}")
        self._asked.add(seq)
        self._highest = max(self._highest, seq)
        self._last_progress = now

    def _message(self, seq: int, item: MissionItem) -> Message:
        first = int(seq == 0 and self.ends.mission_type == "mission")
        return item_to_message(item, seq, *self.ends.peer.ident, self.ends.number, first)

    def _handle_ack(self, message: Message, now: float) -> list[Message]:
        code = message.type
        if self._phase == "resting":
            return []
        if code == ACCEPTED:
            return self._handle_accepted()
        if code == INVALID_SEQUENCE and self._minds_sequence:
            return []  # it says so to every duplicate, and goes on
        if code == ERROR and self._phase == "finishing":
            # a duplicate that came after the end gets this too, and then all is well
            self._doubt = f"the vehicle answered {code_name(code)}"
            return []
        if code == ERROR and self._may_be_busy():
            return self._rest(now)
        return self._handle_refusal(code)

    def _handle_accepted(self) -> list[Message]:
        asked, count = self.progress
        if asked < count:
            return self._fail("protocol", f"the vehicle accepted after asking for {asked} of {count} items")
        if self._doubt:
            return self._unconfirmed(f"{self._doubt} and then ACCEPTED")
        return self._finish(Outcome("accepted", "done", f"the vehicle accepted {count} items"))

    def _handle_refusal(self, code: int) -> list[Message]:
        item = None if self._last_sent is None else self._items[self._last_sent]
        if code == ERROR and self._phase == "announcing":
            message = f"the vehicle refused with {code_name(code)}: it may be busy with another transfer"
            self._finish(Outcome("rejected", "busy", message, code))
        elif code == CANCELLED:
            self._finish(refusal(code))
        else:
            self._finish(refusal(code, self._last_sent, item))
        return [self.ends.ack(CANCELLED)]

    def _may_be_busy(self) -> bool:
        """Whether ERROR may mean another transfer, a former one or a second announcement, and not an item."""
        unasked = self._phase == "announcing" or self._counts > 1 or not self._minds_sequence
        return unasked and self._restarts == 0

    def _rest(self, now: float) -> list[Message]:
        self._restarts += 1
        self._phase = "resting"
        self.wake = now + _REST
        self.notes.append("the vehicle was busy; the upload was cancelled and started again")
        return [self.ends.ack(CANCELLED)]
