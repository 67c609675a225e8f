"""What upload, download and clear have in common: who talks to whom about what, for how long, and how it ends.

An exchange owns no socket and no clock. Its driver hands it every message heard and the time, and sends what it
returns; `wake` says when `tick` is due.
"""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from collections.abc import Callable
from dataclasses import dataclass

from pymavlink.dialects.v20 import ardupilotmega as mavlink

from gcs_windplan.link.codec import Message
from gcs_windplan.link.outcome import CANCELLED, Outcome, Reason
from gcs_windplan.link.peer import Contact, Ident, Peer, sender
from gcs_windplan.link.wire import MISSION_TYPES
from gcs_windplan.mission.firmware import MissionType

FIRST_RETRY = 1.5  # [s] mavlink.io, Mission Protocol: timeout
SENDS = 6  # mavlink.io, Mission Protocol: 5 retries
SILENCE = 10.0  # [s] ArduPilot itself gives up after 8, PX4 after 5
STILL_HERE = 5.0  # [s] a vehicle sends a heartbeat a second
INTERRUPTED = "it was interrupted, and the vehicle was told so"
_ALL_COMPONENTS = 0
_EVERYBODY = 0
_ASKS_FOR_ITEMS = ("MISSION_REQUEST", "MISSION_REQUEST_INT")


@dataclass(frozen=True, slots=True)
class Ends:
    """The two ends of an exchange, and what it is about."""

    own: Ident
    peer: Peer
    mission_type: MissionType = "mission"

    @property
    def number(self) -> int:
        """MAVLink's number of the mission type."""
        return MISSION_TYPES[self.mission_type]

    def concerns(self, message: Message) -> bool:
        """Whether a message of the mission protocol is the peer's, to this side, about this type."""
        return (
            sender(message) == self.peer.ident
            and message.target_system == self.own.system
            and message.target_component in (self.own.component, _ALL_COMPONENTS)
            and message.mission_type == self.number
        )

    def ack(self, code: int) -> Message:
        """MISSION_ACK to the peer."""
        return mavlink.MAVLink_mission_ack_message(*self.peer.ident, code, self.number)


class Exchange(ABC):
    """One exchange with a vehicle, from `begin` to `done`; then `outcome` says how it ended.

    It ends by itself, whatever the vehicle does: after `SILENCE` without an answer, or `limit` seconds in all.
    `contact` is what earlier exchanges saw of the vehicle.
    """

    def __init__(self, ends: Ends, limit: float, contact: Contact | None = None) -> None:
        self.ends = ends
        self.wake = math.inf
        self.notes: list[str] = []
        self.overheard: set[Ident] = set()
        self._outcome: Outcome | None = None
        self._limit = limit
        self._started = math.inf
        self._contact = contact or Contact(ends.peer.ident)
        self._handlers: dict[str, Callable[[Message, float], list[Message]]] = {}

    @property
    def done(self) -> bool:
        """Whether it has ended."""
        return self._outcome is not None

    @property
    def outcome(self) -> Outcome:
        """How it ended; only to be asked when `done`."""
        assert self._outcome is not None
        return self._outcome

    @property
    @abstractmethod
    def progress(self) -> tuple[int, int]:
        """How many items of how many are through."""

    def begin(self, now: float) -> list[Message]:
        """The first messages to send."""
        self._contact.last_heard = self._started = now
        self._contact.restarted = False
        return self._begin(now)

    def handle(self, message: Message, now: float) -> list[Message]:
        """Take in a message, anybody's; gives what to send in answer."""
        if self.done:
            return []
        self._contact.handle(message, now)
        if self._contact.restarted:
            return self._fail("restarted", "the vehicle restarted during the transfer")
        if now >= self._started + self._limit:
            return self._too_long()
        kind = message.get_type()
        handler = self._handlers.get(kind)
        if handler is not None and self.ends.concerns(message):
            return handler(message, now)
        if kind in _ASKS_FOR_ITEMS:
            self._overhear(message)
        return []

    def tick(self, now: float) -> list[Message]:
        """What to send because time has passed; called at `wake` or whenever."""
        if self.done or now < self.wake:
            return []
        return self._tick(now) if now < self._started + self._limit else self._too_long()

    def cancel(self, reason: Reason = "interrupted", message: str = INTERRUPTED) -> list[Message]:
        """End it from this side; what is returned tells the vehicle."""
        return [] if self.done else self._fail(reason, message)

    @abstractmethod
    def _begin(self, now: float) -> list[Message]: ...

    @abstractmethod
    def _tick(self, now: float) -> list[Message]: ...

    def _finish(self, outcome: Outcome) -> list[Message]:
        self._outcome = outcome.noted(*self.notes)
        self.wake = math.inf
        return []

    def _fail(self, reason: Reason, message: str) -> list[Message]:
        """End it with an unknown outcome; the vehicle is told, as PX4 would stay busy."""
        self._finish(Outcome("unknown", reason, message))
        return [self.ends.ack(CANCELLED)]

    def _quiet(self, now: float, reason: Reason, message: str) -> list[Message]:
        """End it after a silence: lost, if nothing else was heard from the vehicle either."""
        silent = now - self._contact.last_heard
        if silent >= STILL_HERE:
            return self._fail("lost", f"nothing was heard from the vehicle for {silent:.0f} s")
        return self._fail(reason, message)

    def _too_long(self) -> list[Message]:
        return self._fail("stalled", f"the transfer did not end within {self._limit:.0f} s")

    def _overhear(self, message: Message) -> None:
        """Note another ground station that sends the same to the vehicle meanwhile."""
        other = Ident(message.target_system, message.target_component)
        same = sender(message) == self.ends.peer.ident and message.mission_type == self.ends.number
        strange = other.system != _EVERYBODY and other != self.ends.own
        if same and strange and other not in self.overheard:
            self.overheard.add(other)
            self.notes.append(f"another ground station ({other}) was sending its {self.ends.mission_type} meanwhile")
