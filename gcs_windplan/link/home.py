"""A vehicle's home: asking for it where it is not item 0, and its distance from the planned one."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

from pymavlink.dialects.v20 import ardupilotmega as mavlink

from gcs_windplan.errors import InputError
from gcs_windplan.geo.frame import GeoPoint, LocalFrame
from gcs_windplan.link.codec import Message
from gcs_windplan.link.outcome import Reason
from gcs_windplan.link.peer import Peer, sender
from gcs_windplan.mission import Frame, Home, MissionItem, plain_frame, takes_place

_RETRY = 0.5  # [s]
_SENDS = 4
_APART = 30.0  # [m] a vehicle stands where it was planned to, up to GNSS and a pilot's choice of the spot
_HIGHER = 5.0  # [m]


@dataclass(frozen=True, slots=True)
class Homes:
    """The home that a mission was planned from, and the vehicle's."""

    planned: Home
    held: Home

    @property
    def distance(self) -> float:
        """How far they are from each other [m], level."""
        point = self.held.point
        return math.hypot(*LocalFrame(self.planned.point).to_local(point.latitude_deg, point.longitude_deg)[0])

    @property
    def higher(self) -> float:
        """How much higher the vehicle's is [m]."""
        return self.held.altitude - self.planned.altitude

    @property
    def apart(self) -> bool:
        """Whether they are too far from each other for altitudes above home to be those that were planned."""
        return self.distance > _APART or abs(self.higher) > _HIGHER

    def __str__(self) -> str:
        side = "higher" if self.higher >= 0 else "lower"
        return (
            f"the vehicle's home is {self.distance:.0f} m away from the file's and {abs(self.higher):.1f} m {side}: "
            "it flies altitudes above home from its own; set its home, or plan from there"
        )

    def described(self) -> dict[str, Any]:
        """The same, for JSON."""
        places = {
            name: {
                "latitude": home.point.latitude_deg,
                "longitude": home.point.longitude_deg,
                "altitude": home.altitude,
            }
            for name, home in (("file", self.planned), ("vehicle", self.held))
        }
        return {**places, "distance": round(self.distance, 1), "higher": round(self.higher, 2), "apart": self.apart}


def counts_from_home(item: MissionItem) -> bool:
    """Whether an item's altitude is one above home."""
    return plain_frame(item.frame) == Frame.GLOBAL_RELATIVE_ALT and takes_place(item.command)


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

    def handle(self, message: Message, now: float) -> list[Message]:
        """Take in a message, anybody's."""
        if message.get_type() == "HOME_POSITION" and sender(message) == self._peer.ident:
            self.done = True
            if not message.latitude and not message.longitude:
                return []  # it has none yet
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
