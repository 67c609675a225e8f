"""The stand-in vehicle: mission server, flight, commands, parameters and telemetry behind one pair of ears.

It is no simulator of an autopilot. It keeps the autopilot's mission rules, moves along the mission kinematically,
and answers what ground stations ask, so that an upload can be tried and seen flying with nothing installed. It
owns no socket and no clock.
"""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass, field

from pymavlink.dialects.v20 import ardupilotmega as mavlink

from gcs_windplan.geo.frame import GeoPoint
from gcs_windplan.link.codec import Message
from gcs_windplan.link.peer import Ident
from gcs_windplan.link.peer import sender as sender_of
from gcs_windplan.mission import Frame, Home, command_name, plain_frame
from gcs_windplan.standin.airframe import Airframe
from gcs_windplan.standin.craft import Current, Event, Reached
from gcs_windplan.standin.ears import EARS
from gcs_windplan.standin.flight import Doing, Flight
from gcs_windplan.standin.items import FENCE, MISSION, RALLY, StoredItem
from gcs_windplan.standin.modes import MODES, Mode, mode_for
from gcs_windplan.standin.parameters import Parameters
from gcs_windplan.standin.rules import MISSION_MESSAGES, ServerOptions, mission_server, text
from gcs_windplan.standin.snapshot import Observer, Snapshot
from gcs_windplan.standin.streams import Streams
from gcs_windplan.standin.telemetry import TELLERS
from gcs_windplan.standin.world import World, world_at
from gcs_windplan.vehicle import Autopilot

_BOOTING = {"ardupilot": 2.0, "px4": 0.0}  # [s] measured on ArduCopter
_TICK = 0.1  # [s] so often it moves
_BANNER = ("gcs-windplan stand-in, not a real vehicle", "It moves without dynamics; its battery is linear")
_CAPABILITIES = (
    mavlink.MAV_PROTOCOL_CAPABILITY_MISSION_INT
    | mavlink.MAV_PROTOCOL_CAPABILITY_COMMAND_INT
    | mavlink.MAV_PROTOCOL_CAPABILITY_MAVLINK2
    | mavlink.MAV_PROTOCOL_CAPABILITY_MISSION_FENCE
    | mavlink.MAV_PROTOCOL_CAPABILITY_MISSION_RALLY
)
_KINDS = {"ardupilot": mavlink.MAV_AUTOPILOT_ARDUPILOTMEGA, "px4": mavlink.MAV_AUTOPILOT_PX4}
_PARAMETER_CODING = {
    "ardupilot": mavlink.MAV_PROTOCOL_CAPABILITY_PARAM_ENCODE_C_CAST,
    "px4": mavlink.MAV_PROTOCOL_CAPABILITY_PARAM_ENCODE_BYTEWISE,
}
_VERSIONS = {"ardupilot": 0x04070000, "px4": 0x010F00FF}  # whose rules are followed: 4.7.0-dev, 1.15.0


@dataclass(frozen=True, slots=True)
class StandInOptions:
    """What a stand-in is told at its start.

    `speedup` is how many seconds of flight pass in one of the clock. With `fly` it arms and starts by itself when a
    mission was uploaded.
    """

    autopilot: Autopilot
    airframe: Airframe
    world: World
    server: ServerOptions = field(default_factory=ServerOptions)
    speedup: float = 1.0
    fly: bool = False


class StandIn:
    """Hears messages, and says what is due. `say` takes what happens, a sentence each, for a log."""

    def __init__(
        self,
        options: StandInOptions,
        now: float,
        say: Callable[[str], None],
        calendar: Callable[[], float] = time.time,
    ) -> None:
        self.autopilot = options.autopilot
        self.flight = Flight(options.autopilot, options.airframe, options.world, self._mission)
        self.server = mission_server(options.autopilot, self.flight, options.server, now)
        self.streams = Streams(options.autopilot, now)
        self.parameters = Parameters(options.autopilot, options.airframe, options.server.system)
        self.mode: Mode = MODES[options.autopilot][0]
        self.say = say
        self._options = options
        self._calendar = calendar
        self._observer = Observer(self.flight)
        self._now = self._booted = now
        self._flown = 0.0  # [s] since boot, on the vehicle's own faster clock
        self._stations: set[Ident] = set()
        self._greeted: set[Ident] = set()
        self._troubled: str | None = None
        self._last_note = ""

    @property
    def wake(self) -> float:
        """When `tick` has something to do [s]."""
        return min(self.server.wake, self.streams.wake, self._now + _TICK)

    def hear(self, message: Message, now: float) -> list[Message]:
        """The answers to a message."""
        kind = message.get_type()
        self._meet(sender_of(message), kind)
        if kind in MISSION_MESSAGES:
            return self._hear_mission(message, now)
        answer = EARS.get(kind)
        if answer is None or getattr(message, "target_system", 0) not in (0, self._options.server.system):
            return []
        return answer(self, message, now) + self._events()

    def tick(self, now: float) -> list[Message]:
        """Move on, and say what is due."""
        self._move(now)
        said = self.server.tick(now)
        said += self._events()
        self._log_notes()
        due = self.streams.due(now)
        if due:
            snapshot = self.snapshot(now)
            said += [TELLERS[kind](snapshot) for kind in due]
        return said

    def snapshot(self, now: float) -> Snapshot:
        """The vehicle as it is."""
        booting = now - self._booted < _BOOTING[self.autopilot]
        unix = self._calendar()
        if self._options.world.departure is not None:
            craft = self.flight.craft
            unix = self._options.world.departure.timestamp() + (craft.body.clock if craft.armed else 0.0)
        return self._observer.look(self._flown, unix, self.mode, _KINDS[self.autopilot], booting, len(self._mission()))

    def tell(self, kind: int, now: float) -> tuple[Message, ...]:
        """One message of telemetry or about the autopilot, by its number; none for one unknown here."""
        if kind == mavlink.MAVLINK_MSG_ID_AUTOPILOT_VERSION:
            return (self.version(),)
        teller = TELLERS.get(kind)
        return () if teller is None else (teller(self.snapshot(now)),)

    def banner(self) -> tuple[Message, ...]:
        """What it says of itself."""
        return tuple(text(mavlink.MAV_SEVERITY_NOTICE, words) for words in _BANNER)

    def greet(self, station: Ident) -> tuple[Message, ...]:
        """The banner, for a ground station that has not seen it yet."""
        if station in self._greeted:
            return ()
        self._greeted.add(station)
        return self.banner()

    @property
    def clock(self) -> float:
        """Seconds since boot on the vehicle's own, faster clock."""
        return self._flown

    @property
    def component(self) -> int:
        """Its MAVLink component."""
        return self._options.server.component

    def arm(self) -> str | None:
        """Start the motors, with a fresh battery; why not, if not."""
        if not self.flight.craft.armed:
            self._observer.reset()
        return self.flight.arm()

    def do(self, doing: Doing) -> str | None:
        """Change to the mode for something and do it; why not, if not."""
        return self.set_mode(mode_for(self.autopilot, doing))

    def set_mode(self, mode: Mode) -> str | None:
        """Change the mode; why not, if not."""
        if mode.doing == "mission":
            fault = self.flight.fly_mission()
            if fault is not None:
                return fault
        elif mode.doing == "return":
            self.flight.return_home()
        elif mode.doing == "land":
            self.flight.land()
        else:
            self.flight.stay(mode.doing)
        self.mode = mode
        return None

    def reboot(self, now: float) -> None:
        """Start again, on the ground; missions, fence and rally points stay."""
        self._booted, self._flown = now, 0.0
        self.server.reboot(now)
        self.flight.run.forget()
        self.flight.stay()
        self.mode = MODES[self.autopilot][0]

    def _mission(self) -> list[StoredItem]:
        return list(self.server.items[MISSION])

    def _hear_mission(self, message: Message, now: float) -> list[Message]:
        said = self.server.hear(message, now)
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
        craft = self.flight.craft
        if not craft.world.settled and not craft.armed:
            home = _beginning(self.server.sent_home, self._mission())
            if home is not None:
                self.flight.settle(world_at(home, craft.world.wind))
                where = f"{home.point}, {home.altitude:.1f} m"
                self.say(f"told no place to stand, it stands where the mission begins: {where}")
        self.flight.mission_changed()
        if self._options.fly and not craft.armed:
            fault = self.do("mission") or self.arm()
            self.say("armed, flying the mission" if fault is None else f"it does not fly: {fault}")

    def _move(self, now: float) -> None:
        seconds = max(0.0, now - self._now) * self._options.speedup
        self._now = max(now, self._now)
        self._flown += seconds
        self._observer.advance(seconds)
        self.flight.advance(seconds)
        trouble = self.flight.craft.body.air.trouble
        if trouble is not None and trouble != self._troubled:
            self.say(f"the wind stays as it was last known: {trouble}")
        self._troubled = trouble

    def _events(self) -> list[Message]:
        events, self.flight.craft.events = self.flight.craft.events, []
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

    def version(self) -> Message:
        """AUTOPILOT_VERSION: what it can do, and whose rules it follows."""
        version = _VERSIONS[self.autopilot]
        return mavlink.MAVLink_autopilot_version_message(
            _CAPABILITIES | _PARAMETER_CODING[self.autopilot], version, 0, 0, 0,
            list(b"STANDIN\0"), [0] * 8, [0] * 8, 0, 0, self._options.server.system,
        )  # fmt: skip


def _beginning(sent_home: StoredItem | None, items: list[StoredItem]) -> Home | None:
    """Where a mission begins: at the home that was sent with it, or under its first place."""
    if sent_home is not None and sent_home.has_place:
        return Home(GeoPoint(sent_home.latitude_deg, sent_home.longitude_deg), sent_home.z)
    first = next((item for item in items if item.has_place), None)
    if first is None or not (abs(first.latitude_deg) <= 90 and abs(first.longitude_deg) <= 180):
        return None
    above_sea = plain_frame(first.frame) == Frame.GLOBAL
    return Home(GeoPoint(first.latitude_deg, first.longitude_deg), first.z if above_sea else 0.0)
