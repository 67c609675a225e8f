"""Who is on the link, and whether the vehicle there is still the one that it was."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import NamedTuple

from pymavlink.dialects.v20 import ardupilotmega as mavlink

from gcs_windplan.link.codec import Message, Version
from gcs_windplan.mission.firmware import Firmware, known_firmware
from gcs_windplan.vehicle import Autopilot, VehicleType

_ROTORS = "QUADROTOR COAXIAL HELICOPTER TRICOPTER HEXAROTOR OCTOROTOR DECAROTOR DODECAROTOR"
VTOL_TYPES = range(19, 26)  # MAV_TYPE_VTOL_*, whose names change from version to version
VEHICLE_TYPES: dict[int, VehicleType] = {
    mavlink.MAV_TYPE_FIXED_WING: "fixed-wing",
    **dict.fromkeys(VTOL_TYPES, "fixed-wing"),  # they run the firmware of planes
    **{getattr(mavlink, f"MAV_TYPE_{name}"): "multicopter" for name in _ROTORS.split()},
}
_STARTING = (mavlink.MAV_STATE_UNINIT, mavlink.MAV_STATE_BOOT)
_REORDERING = 3_000  # [ms] a message may be older than the one before it by that much, and no more


class Ident(NamedTuple):
    """MAVLink's name of a sender or receiver."""

    system: int
    component: int

    def __str__(self) -> str:
        return f"{self.system}/{self.component}"


@dataclass(frozen=True, slots=True)
class Peer:
    """The autopilot at the other end; `autopilot` and `vehicle_type` are None for kinds unknown here."""

    ident: Ident
    autopilot: Autopilot | None = None
    vehicle_type: VehicleType | None = None
    version: Version = 2

    def __str__(self) -> str:
        kind = "autopilot of a kind unknown here" if self.firmware is None else self.firmware.family
        return f"{kind} {self.ident}"

    @property
    def firmware(self) -> Firmware | None:
        """What is known of its firmware, None for an autopilot unknown here."""
        return known_firmware(self.autopilot, self.vehicle_type)


def sender(message: Message) -> Ident:
    """Who sent a decoded message."""
    return Ident(message.get_srcSystem(), message.get_srcComponent())


@dataclass(slots=True)
class Contact:
    """Watches the messages of one vehicle: when it was last heard, and whether it restarted meanwhile."""

    ident: Ident
    last_heard: float = -math.inf
    restarted: bool = False
    _boot_time: int = -1
    _ran: bool = False

    def handle(self, message: Message, now: float) -> None:
        """Take note of a message, if it is the vehicle's."""
        if sender(message) != self.ident:
            return
        self.last_heard = now
        if message.get_type() == "HEARTBEAT":
            starting = message.system_status in _STARTING
            self.restarted |= starting and self._ran
            self._ran = not starting
        boot_time = getattr(message, "time_boot_ms", None)
        if boot_time is not None:
            back = boot_time < self._boot_time - _REORDERING
            self.restarted |= back
            self._boot_time = boot_time if back else max(self._boot_time, boot_time)
