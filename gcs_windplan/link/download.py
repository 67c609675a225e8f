"""Download of what a vehicle holds, as a state machine.

PX4 ends a download in which it hears an old duplicate of a request; it is then begun again from the list.
"""

from __future__ import annotations

from typing import Literal, TypeAlias

from pymavlink.dialects.v20 import ardupilotmega as mavlink

from gcs_windplan.errors import InputError
from gcs_windplan.link.codec import Message
from gcs_windplan.link.exchange import FIRST_RETRY, SENDS, Ends, Exchange
from gcs_windplan.link.outcome import ACCEPTED, INVALID_SEQUENCE, UNSUPPORTED, Outcome, refusal
from gcs_windplan.link.peer import Contact
from gcs_windplan.link.wire import message_to_item
from gcs_windplan.mission import MissionItem

_Phase: TypeAlias = Literal["listing", "fetching"]

_ITEM_RETRY = 0.25  # [s] mavlink.io, Mission Protocol: timeout for items
_SLOWEST_RETRY = 1.0  # [s]
_SLACK = 1.5  # times the last answer's time, so that a slow link is not asked twice for everything
_SENDS_REFUSED = 8  # of the list: ArduPilot denies it while an upload is under way, and gives that up after 8 s
_FRUITLESS = 14  # requests for one item (at least 6.75 s), after which the list is asked for again
_LISTS = 5  # times that the list is asked for after an answer
_BASE, _PER_ITEM = 90.0, 3.0  # [s] bound of the whole


class Download(Exchange):
    """Reads all items, in the vehicle's own form: ArduPilot's item 0 is home. Then `items` has them."""

    def __init__(self, ends: Ends, contact: Contact | None = None) -> None:
        super().__init__(ends, _BASE, contact)
        self.items: tuple[MissionItem, ...] = ()
        self._phase: _Phase = "listing"
        self._messages: list[Message] = []
        self._count: int | None = None
        self._sends = 0
        self._lists = 0
        self._refusal: int | None = None
        self._retry = _ITEM_RETRY
        self._first_asked = 0.0
        self._handlers = {
            "MISSION_COUNT": self._handle_count,
            "MISSION_ITEM_INT": self._handle_item,
            "MISSION_ACK": self._handle_ack,
        }

    @property
    def progress(self) -> tuple[int, int]:
        """How many items of how many have come."""
        return len(self._messages), self._count or 0

    def _begin(self, now: float) -> list[Message]:
        self._sends = 0
        return self._list(now)

    def _list(self, now: float) -> list[Message]:
        self._phase = "listing"
        self._sends += 1
        self.wake = now + FIRST_RETRY
        return [mavlink.MAVLink_mission_request_list_message(*self.ends.peer.ident, self.ends.number)]

    def _fetch(self, now: float) -> list[Message]:
        self._sends += 1
        if self._sends == 1:
            self._first_asked = now
        self.wake = now + min(self._retry * 2 ** (self._sends - 1), max(self._retry, 2 * _ITEM_RETRY))
        seq = len(self._messages)
        return [mavlink.MAVLink_mission_request_int_message(*self.ends.peer.ident, seq, self.ends.number)]

    def _tick(self, now: float) -> list[Message]:
        if self._phase == "listing":
            if self._sends < (SENDS if self._refusal is None else _SENDS_REFUSED):
                return self._list(now)
            if self._refusal is not None:
                return self._finish(refusal(self._refusal))
            return self._quiet(now, "no-answer", f"the vehicle did not answer {SENDS} requests for its list")
        return self._fetch(now) if self._sends < _FRUITLESS else self._begin_again(now)

    def _begin_again(self, now: float) -> list[Message]:
        if self._lists < _LISTS:
            return self._begin(now)
        got, count = self.progress
        return self._quiet(now, "stalled", f"the vehicle stopped answering after {got} of {count} items")

    def _handle_count(self, message: Message, now: float) -> list[Message]:
        if self._count is not None and message.count != self._count:
            return self._fail("changed", f"the vehicle held {self._count} items, and now {message.count}")
        if self._phase != "listing":
            return []
        self._count = message.count
        self._limit = _BASE + _PER_ITEM * message.count
        self._lists += 1
        self._refusal = None
        self._messages.clear()
        self._phase = "fetching"
        return self._next(now)

    def _handle_item(self, message: Message, now: float) -> list[Message]:
        if self._phase != "fetching" or message.seq != len(self._messages):
            return []
        self._messages.append(message)
        self._retry = min(max(_ITEM_RETRY, _SLACK * (now - self._first_asked)), _SLOWEST_RETRY)
        return self._next(now)

    def _next(self, now: float) -> list[Message]:
        self._sends = 0
        return self._fetch(now) if len(self._messages) < (self._count or 0) else self._complete()

    def _complete(self) -> list[Message]:
        for seq, message in enumerate(self._messages):
            try:
                self.items += (message_to_item(message),)
            except InputError as error:
                return self._fail("unreadable", f"item {seq} of the vehicle cannot be: {error}")
        self._finish(Outcome("accepted", "done", f"the vehicle holds {len(self.items)} items"))
        return [self.ends.ack(ACCEPTED)]

    def _handle_ack(self, message: Message, now: float) -> list[Message]:
        if message.type in (ACCEPTED, INVALID_SEQUENCE):
            return []
        if message.type == UNSUPPORTED:
            return self._finish(refusal(message.type))
        # it may answer something older, or pass with an upload that the vehicle will soon give up
        self._refusal = message.type
        return self._begin_again(now) if self._phase == "fetching" else []
