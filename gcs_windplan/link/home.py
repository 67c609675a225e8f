"""Asking a vehicle where its home is, for vehicles that do not keep it as item 0."""

from __future__ import annotations

import math

from pymavlink.dialects.v20 import ardupilotmega as mavlink

from gcs_windplan.errors import InputError
from gcs_windplan.geodesy import GeoPoint
from gcs_windplan.link.codec import Message
from gcs_windplan.link.outcome import Reason
from gcs_windplan.link.peer import Peer, sender
from gcs_windplan.mission import Home

_RETRY = 0.5  # [s]
_SENDS = 4


class AskHome:
    """Asks for HOME_POSITION; `home` stays None where the vehicle has none or does not say."""

    def __init__(self, peer: Peer) -> None:
        self.wake = math.inf
        self.done = False
        self.home: Home | None = None
        self._peer = peer
        self._sends = 0

    @property
    def progress(self) -> tuple[int, int]:
        """There are no items to count."""
        return 0, 0

    def begin(self, now: float) -> list[Message]:
        """The request."""
        self._sends += 1
        self.wake = now + _RETRY
        wish = (mavlink.MAVLINK_MSG_ID_HOME_POSITION, 0, 0, 0, 0, 0, 0)
        command = mavlink.MAV_CMD_REQUEST_MESSAGE
        return [mavlink.MAVLink_command_long_message(*self._peer.ident, command, 0, *wish)]

    def hear(self, message: Message, now: float) -> list[Message]:
        """Take in a message, anybody's."""
        if message.get_type() == "HOME_POSITION" and sender(message) == self._peer.ident:
            self.done = True
            try:
                point = GeoPoint(message.latitude / 1e7, message.longitude / 1e7)
                self.home = Home(point, message.altitude / 1e3)
            except InputError:
                self.home = None
        return []

    def tick(self, now: float) -> list[Message]:
        """Ask again, a few times."""
        if self.done or now < self.wake:
            return []
        if self._sends < _SENDS:
            return self.begin(now)
        self.done = True
        return []

    def cancel(self, reason: Reason = "interrupted", message: str = "it was interrupted") -> list[Message]:
        """Stop asking."""
        self.done = True
        return []
