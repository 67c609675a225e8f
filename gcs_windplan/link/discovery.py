"""Finding the vehicle: who sends heartbeats, which of them is meant, and whether it is ready."""

from __future__ import annotations

import math
from dataclasses import dataclass

from pymavlink.dialects.v20 import ardupilotmega as mavlink

from gcs_windplan.errors import InputError
from gcs_windplan.link.codec import Message, Version, wire_version
from gcs_windplan.link.outcome import Reason
from gcs_windplan.link.peer import VEHICLE_TYPES, Contact, Ident, Peer, sender
from gcs_windplan.mission.firmware import autopilot_of

LISTENING = 1.2  # [s] heartbeats come every second: whoever else shares the link is heard by then
_SWITCHING = 3.0  # [s] autopilots begin with MAVLink 1 and change when they hear MAVLink 2
_STARTING = 5.0  # [s] ArduPilot answers NO_SPACE before it is ready
_NO_VEHICLES = (mavlink.MAV_TYPE_GCS, mavlink.MAV_TYPE_ADSB, mavlink.MAV_TYPE_GIMBAL, mavlink.MAV_TYPE_CAMERA)


@dataclass(slots=True)
class _Sighting:
    """An autopilot as its heartbeats show it."""

    first: float
    autopilot: int
    kind: int
    status: int
    version: Version
    contact: Contact


class Discovery:
    """Listens until the vehicle meant is there and ready, or `patience` seconds are over.

    `system` and `component` are those wanted, None for any. More than one vehicle that fits is an error, so
    without both wishes it listens for a second after the first heartbeat.
    """

    def __init__(self, patience: float, system: int | None = None, component: int | None = None) -> None:
        self.wake = math.inf
        self.done = False
        self.lost = ""
        self._patience = patience
        self._wanted = (system, component)
        self._sightings: dict[Ident, _Sighting] = {}
        self._until = math.inf
        self._peer: Peer | None = None

    @property
    def progress(self) -> tuple[int, int]:
        """There are no items to count."""
        return 0, 0

    def begin(self, now: float) -> list[Message]:
        """Nothing is sent; the driver's own heartbeats wake the other side."""
        self._until = self.wake = now + self._patience
        return []

    def handle(self, message: Message, now: float) -> list[Message]:
        """Take in a message, anybody's."""
        ident = sender(message)
        if message.get_type() == "HEARTBEAT":
            self._sight(ident, message, now)
        sighting = self._sightings.get(ident)
        if sighting is not None:
            sighting.version = max(sighting.version, wire_version(message))
            sighting.contact.handle(message, now)
            self._look(now)
        return []

    def tick(self, now: float) -> list[Message]:
        """See whether enough time has passed."""
        if not self.done and now >= self.wake:
            self._look(now)
            self.done = self.done or now >= self._until
        return []

    def cancel(self, reason: Reason = "interrupted", message: str = "it was interrupted") -> list[Message]:
        """Stop looking; when time is over, what was heard so far counts."""
        self.done = True
        self.lost = "" if reason == "time-out" else message
        return []

    def peer(self) -> Peer | None:
        """The vehicle, None where there is none; raises InputError where several fit."""
        fitting = self._fitting()
        if len(fitting) > 1:
            names = ", ".join(str(_peer(ident, self._sightings[ident])) for ident in fitting)
            raise InputError(f"{len(fitting)} vehicles share the link ({names}): choose one with --sysid and --compid")
        return self._peer or (_peer(fitting[0], self._sightings[fitting[0]]) if fitting else None)

    def others(self) -> tuple[str, ...]:
        """The vehicles that were heard and are not the one wanted."""
        fitting = self._fitting()
        return tuple(str(_peer(*seen)) for seen in self._sightings.items() if seen[0] not in fitting)

    def contact(self, peer: Peer) -> Contact:
        """What was seen of a vehicle that was met."""
        return self._sightings[peer.ident].contact

    def _sight(self, ident: Ident, heartbeat: Message, now: float) -> None:
        if heartbeat.autopilot == mavlink.MAV_AUTOPILOT_INVALID or heartbeat.type in _NO_VEHICLES:
            return
        known = self._sightings.get(ident)
        if known is None:
            known = _Sighting(now, 0, 0, 0, wire_version(heartbeat), Contact(ident))
            self._sightings[ident] = known
        known.autopilot, known.kind, known.status = heartbeat.autopilot, heartbeat.type, heartbeat.system_status

    def _fitting(self) -> list[Ident]:
        system, component = self._wanted
        return [
            ident
            for ident in self._sightings
            if system in (None, ident.system) and component in (None, ident.component)
        ]

    def _look(self, now: float) -> None:
        """Decide whether it is over, or when to look again."""
        fitting = self._fitting()
        if self.done or not fitting:
            return
        ready = max(self._ready_at(self._sightings[ident]) for ident in fitting)
        if now >= ready:
            self.done = True
            self._peer = _peer(fitting[0], self._sightings[fitting[0]])
        else:
            self.wake = min(ready, max(self._until, now))

    def _ready_at(self, sighting: _Sighting) -> float:
        ready = sighting.first
        if None in self._wanted:
            ready = min(seen.first for seen in self._sightings.values()) + LISTENING
        if sighting.version == 1:
            ready = max(ready, sighting.first + _SWITCHING)
        starting = sighting.status < mavlink.MAV_STATE_STANDBY
        if starting and sighting.autopilot == mavlink.MAV_AUTOPILOT_ARDUPILOTMEGA:
            ready = max(ready, sighting.first + _STARTING)
        return ready


def _peer(ident: Ident, sighting: _Sighting) -> Peer:
    return Peer(ident, autopilot_of(sighting.autopilot), VEHICLE_TYPES.get(sighting.kind), sighting.version)
