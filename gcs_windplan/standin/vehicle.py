"""The simulated vehicle behind a stand-in: flight, mode, mission server, parameters and telemetry."""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass, field, replace

from pymavlink.dialects.v20 import ardupilotmega as mavlink

from gcs_windplan.link.codec import Message
from gcs_windplan.link.peer import Ident
from gcs_windplan.mission.firmware import Activity, Firmware, Mode
from gcs_windplan.standin.flight import SimulatedFlight
from gcs_windplan.standin.items import MISSION, StoredItem
from gcs_windplan.standin.parameters import Parameters
from gcs_windplan.standin.rules import ServerOptions, text
from gcs_windplan.standin.servers import mission_server
from gcs_windplan.standin.snapshot import Observer, Snapshot
from gcs_windplan.standin.streams import Streams
from gcs_windplan.standin.telemetry import ENCODERS
from gcs_windplan.standin.world import World
from gcs_windplan.vehicle import MotionProfile, Vehicle

_BANNER = ("gcs-windplan stand-in, not a real vehicle", "It moves without dynamics; its battery is linear")
_CAPABILITIES = (
    mavlink.MAV_PROTOCOL_CAPABILITY_MISSION_INT
    | mavlink.MAV_PROTOCOL_CAPABILITY_COMMAND_INT
    | mavlink.MAV_PROTOCOL_CAPABILITY_MAVLINK2
    | mavlink.MAV_PROTOCOL_CAPABILITY_MISSION_FENCE
    | mavlink.MAV_PROTOCOL_CAPABILITY_MISSION_RALLY
)
_PARAMETER_CODING = {
    False: mavlink.MAV_PROTOCOL_CAPABILITY_PARAM_ENCODE_C_CAST,
    True: mavlink.MAV_PROTOCOL_CAPABILITY_PARAM_ENCODE_BYTEWISE,
}


@dataclass(frozen=True, slots=True)
class StandInOptions:
    """What a stand-in is told at its start.

    `speedup` is how many seconds of flight pass in one of the clock. With `fly` it arms and starts by itself when a
    mission was uploaded.
    """

    firmware: Firmware
    profile: MotionProfile
    world: World
    server: ServerOptions = field(default_factory=ServerOptions)
    speedup: float = 1.0
    fly: bool = False


def planned_profile(firmware: Firmware, vehicle: Vehicle | None = None) -> MotionProfile:
    """A firmware's default motion profile, with a planned vehicle's airspeed, climb and descent."""
    if vehicle is None:
        return firmware.motion
    return replace(firmware.motion, airspeed=vehicle.airspeed, climb=vehicle.climb, descent=vehicle.descent)


class SimulatedVehicle:
    """Its flight, mode, mission, parameters and telemetry. `say` takes what happens, a sentence each, for a log."""

    def __init__(
        self,
        options: StandInOptions,
        now: float,
        say: Callable[[str], None],
        calendar: Callable[[], float] = time.time,
    ) -> None:
        self.firmware = options.firmware
        self.flight = SimulatedFlight(options.firmware, options.profile, options.world, self._mission)
        self.server = mission_server(options.firmware, self.flight, options.server, now)
        self.streams = Streams(options.firmware, now)
        self.parameters = Parameters(options.firmware, options.profile, options.server.system)
        self.mode: Mode = options.firmware.modes[0]
        self.say = say
        self._options = options
        self._calendar = calendar
        self._observer = Observer(self.flight)
        self._booted = now
        self._flown = 0.0  # [s] since boot, on the vehicle's own faster clock
        self._greeted: set[Ident] = set()

    def snapshot(self, now: float) -> Snapshot:
        """The vehicle as it is."""
        booting = now - self._booted < self.firmware.transfers.booting
        unix = self._calendar()
        if self._options.world.departure is not None:
            state = self.flight.state
            unix = self._options.world.departure.timestamp() + (state.body.clock if state.armed else 0.0)
        return self._observer.look(
            self._flown, unix, self.mode, self.firmware.mav_autopilot, booting, len(self._mission())
        )

    def encode(self, kind: int, now: float) -> tuple[Message, ...]:
        """One message of telemetry or about the autopilot, by its number; none for one unknown here."""
        if kind == mavlink.MAVLINK_MSG_ID_AUTOPILOT_VERSION:
            return (self.version(),)
        encoder = ENCODERS.get(kind)
        return () if encoder is None else (encoder(self.snapshot(now)),)

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
        if not self.flight.state.armed:
            self._observer.reset()
        return self.flight.arm()

    def do(self, activity: Activity) -> str | None:
        """Change to the mode for something and do it; why not, if not."""
        return self.set_mode(self.firmware.mode_for(activity))

    def set_mode(self, mode: Mode) -> str | None:
        """Change the mode; why not, if not."""
        if mode.activity == "mission":
            fault = self.flight.fly_mission()
            if fault is not None:
                return fault
        elif mode.activity == "return":
            self.flight.return_home()
        elif mode.activity == "land":
            self.flight.land()
        else:
            self.flight.stay(mode.activity)
        self.mode = mode
        return None

    def reboot(self, now: float) -> None:
        """Start again, on the ground; missions, fence and rally points stay."""
        self._booted, self._flown = now, 0.0
        self.server.reboot(now)
        self.flight.run.forget()
        self.flight.stay()
        self.mode = self.firmware.modes[0]

    def version(self) -> Message:
        """AUTOPILOT_VERSION: what it can do, and whose rules it follows."""
        version = self.firmware.version
        return mavlink.MAVLink_autopilot_version_message(
            _CAPABILITIES | _PARAMETER_CODING[self.firmware.integers_as_bytes], version, 0, 0, 0,
            list(b"STANDIN\0"), [0] * 8, [0] * 8, 0, 0, self._options.server.system,
        )  # fmt: skip

    def _mission(self) -> list[StoredItem]:
        return list(self.server.items[MISSION])
