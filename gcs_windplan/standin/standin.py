"""The stand-in vehicle: what it answers to messages, and what it sends by itself.

It is no simulator of an autopilot. It keeps the autopilot's mission rules, moves along the mission kinematically,
and answers what ground stations ask, so that an upload can be tried and seen flying with nothing installed. It
owns no socket and no clock.
"""

from __future__ import annotations

import time
from collections.abc import Callable

from pymavlink.dialects.v20 import ardupilotmega as mavlink

from gcs_windplan.geo.frame import GeoPoint
from gcs_windplan.link.codec import Message
from gcs_windplan.link.peer import Ident
from gcs_windplan.link.peer import sender as sender_of
from gcs_windplan.mission import Frame, Home, command_name, plain_frame
from gcs_windplan.standin.handlers import HANDLERS
from gcs_windplan.standin.items import FENCE, MISSION, RALLY, StoredItem
from gcs_windplan.standin.rules import MISSION_MESSAGES, text
from gcs_windplan.standin.telemetry import ENCODERS
from gcs_windplan.standin.vehicle import SimulatedVehicle, StandInOptions
from gcs_windplan.standin.vehicle_state import Current, Event, Reached
from gcs_windplan.standin.world import world_at

_TICK = 0.1  # [s] so often it moves


class StandIn(SimulatedVehicle):
    """Takes messages, and sends what is due."""

    def __init__(
        self,
        options: StandInOptions,
        now: float,
        say: Callable[[str], None],
        calendar: Callable[[], float] = time.time,
    ) -> None:
        super().__init__(options, now, say, calendar)
        self._now = now
        self._stations: set[Ident] = set()
        self._troubled: str | None = None
        self._last_note = ""

    @property
    def wake(self) -> float:
        """When `tick` has something to do [s]."""
        return min(self.server.wake, self.streams.wake, self._now + _TICK)

    def handle(self, message: Message, now: float) -> list[Message]:
        """The answers to a message."""
        kind = message.get_type()
        self._meet(sender_of(message), kind)
        if kind in MISSION_MESSAGES:
            return self._handle_mission(message, now)
        answer = HANDLERS.get(kind)
        if answer is None or getattr(message, "target_system", 0) not in (0, self._options.server.system):
            return []
        return answer(self, message, now) + self._events()

    def tick(self, now: float) -> list[Message]:
        """Segment on, and say what is due."""
        self._move(now)
        said = self.server.tick(now)
        said += self._events()
        self._log_notes()
        due = self.streams.due(now)
        if due:
            snapshot = self.snapshot(now)
            said += [ENCODERS[kind](snapshot) for kind in due]
        return said

    def _handle_mission(self, message: Message, now: float) -> list[Message]:
        said = self.server.handle(message, now)
        arrived, self.server.arrived = self.server.arrived, set()
        self._log_notes()
        if arrived:
            held = {kind: len(items) for kind, items in self.server.items.items()}
            self.parameters.note(MIS_TOTAL=held[MISSION], FENCE_TOTAL=held[FENCE], RALLY_TOTAL=held[RALLY])
        if MISSION in arrived:
            self._take_mission()
        return said + self._events()

    def _take_mission(self) -> None:
        """A mission has come: stand where it begins, if nobody said where to stand, and fly if told to."""
        state = self.flight.state
        if not state.world.settled and not state.armed:
            home = _beginning(self.server.sent_home, self._mission())
            if home is not None:
                self.flight.settle(world_at(home, state.world.wind))
                where = f"{home.point}, {home.altitude:.1f} m"
                self.say(f"told no place to stand, it stands where the mission begins: {where}")
        self.flight.mission_changed()
        if self._options.fly and not state.armed:
            fault = self.do("mission") or self.arm()
            self.say("armed, flying the mission" if fault is None else f"it does not fly: {fault}")

    def _move(self, now: float) -> None:
        seconds = max(0.0, now - self._now) * self._options.speedup
        self._now = max(now, self._now)
        self._flown += seconds
        self._observer.advance(seconds)
        self.flight.advance(seconds)
        trouble = self.flight.state.body.air.trouble
        if trouble is not None and trouble != self._troubled:
            self.say(f"the wind stays as it was last known: {trouble}")
        self._troubled = trouble

    def _events(self) -> list[Message]:
        events, self.flight.state.events = self.flight.state.events, []
        return [self._message(event) for event in events]

    def _message(self, event: Event) -> Message:
        if isinstance(event, Reached):
            self.say(f"item {event.seq} is completed")
            return mavlink.MAVLink_mission_item_reached_message(event.seq)
        if isinstance(event, Current):
            items = self._mission()
            name = command_name(items[event.seq].command) if event.seq < len(items) else "none"
            self.say(f"item {event.seq} is the current one: {name}")
            return mavlink.MAVLink_mission_current_message(event.seq)
        self.say(event.words)
        return text(mavlink.MAV_SEVERITY_INFO, event.words)

    def _meet(self, station: Ident, kind: str) -> None:
        if station not in self._stations:
            self._stations.add(station)
            self.say(f"{station} is there; the first that it says is {kind}")

    def _log_notes(self) -> None:
        for note in self.server.notes:
            if note != self._last_note:
                self.say(note)
            self._last_note = note
        self.server.notes.clear()


def _beginning(sent_home: StoredItem | None, items: list[StoredItem]) -> Home | None:
    """Where a mission begins: at the home that was sent with it, or under its first place."""
    if sent_home is not None and sent_home.has_place:
        return Home(GeoPoint(sent_home.latitude_deg, sent_home.longitude_deg), sent_home.z)
    first = next((item for item in items if item.has_place), None)
    if first is None or not (abs(first.latitude_deg) <= 90 and abs(first.longitude_deg) <= 180):
        return None
    above_sea = plain_frame(first.frame) == Frame.GLOBAL
    return Home(GeoPoint(first.latitude_deg, first.longitude_deg), first.z if above_sea else 0.0)
