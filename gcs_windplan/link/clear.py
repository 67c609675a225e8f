"""Deletion of what a vehicle holds, as a state machine."""

from __future__ import annotations

from pymavlink.dialects.v20 import ardupilotmega as mavlink

from gcs_windplan.link.codec import Message
from gcs_windplan.link.exchange import FIRST_RETRY, SENDS, Ends, Exchange
from gcs_windplan.link.outcome import ACCEPTED, Outcome, refusal
from gcs_windplan.link.peer import Contact

_LIMIT = 30.0  # [s]


class Clear(Exchange):
    """Asks the vehicle to delete its mission, fence or rally points until it answers.

    ArduPilot keeps home as item 0 of an empty mission.
    """

    def __init__(self, ends: Ends, contact: Contact | None = None) -> None:
        super().__init__(ends, _LIMIT, contact)
        self._sends = 0
        self._handlers = {"MISSION_ACK": self._handle_ack}

    @property
    def progress(self) -> tuple[int, int]:
        """There are no items to count."""
        return 0, 0

    def _begin(self, now: float) -> list[Message]:
        self._sends += 1
        self.wake = now + FIRST_RETRY
        return [mavlink.MAVLink_mission_clear_all_message(*self.ends.peer.ident, self.ends.number)]

    def _tick(self, now: float) -> list[Message]:
        if self._sends < SENDS:
            return self._begin(now)
        return self._quiet(now, "no-answer", f"the vehicle did not answer {SENDS} requests to clear")

    def _handle_ack(self, message: Message, now: float) -> list[Message]:
        if message.type == ACCEPTED:
            return self._finish(Outcome("accepted", "done", "the vehicle accepted"))
        return self._finish(refusal(message.type))
