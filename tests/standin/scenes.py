"""Flights to look at: missions drawn in metres east and north of home, and what happens in them."""

from __future__ import annotations

import itertools
from collections.abc import Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from gcs_windplan.geo.frame import GeoPoint, LocalFrame
from gcs_windplan.mission import Home
from gcs_windplan.mission.firmware import firmware_of
from gcs_windplan.standin.flight import SimulatedFlight
from gcs_windplan.standin.items import StoredItem
from gcs_windplan.standin.vehicle_state import Current, Reached, Said
from gcs_windplan.standin.world import World
from gcs_windplan.vehicle import MotionProfile
from gcs_windplan.wind.analytic import Calm, ConstantWind

from .speaking import RTL, SPEED, TAKEOFF, WAYPOINT

HOME = Home(GeoPoint(36.5, -84.3), 300.0)
FRAME = LocalFrame(HOME.point)
COPTER = firmware_of("ardupilot", "multicopter")
SWIFT = replace(COPTER.motion, airspeed=15.0)  # leans to 45°
HOME_ITEM = StoredItem(0, WAYPOINT, x=365_000_000, y=-843_000_000, z=300.0)

#: A mission file: over a hill, in wind.
HILL = """\
name: hill
vehicle: {{airspeed: 12 m/s, climb: 3, descent: 2, autopilot: {autopilot}}}
terrain:
  surface: {{size: 3 km, cell: 25 m, hills: [{{east: 0, north: 0, height: 60, radius: 200}}]}}
  origin: {{latitude: 46.8, longitude: 9.8, altitude: 500 m}}
wind: {{constant: {{speed: 6 m/s, from: 250 deg}}}}
start: {{east: -900, north: 0}}
goal: {{east: 900, north: 50}}
clearance: 30 m
limits: {{max_height: 120 m}}
graph: {{uniform: {{spacing: 50 m}}}}
"""


def at(east: float, north: float, z: float = 80.0, command: int = WAYPOINT, params=(0, 0, 0, 0), frame: int = 3):
    """An item at a place [m] from home; `z` above home unless the frame says otherwise."""
    latitude, longitude = FRAME.to_geographic(np.array([[east, north]]))
    return StoredItem(frame, command, tuple(map(float, params)), round(latitude[0] * 1e7), round(longitude[0] * 1e7), z)


def takeoff(z: float = 80.0) -> StoredItem:
    return StoredItem(3, TAKEOFF, z=z)


def speed(value: float, kind: float = 1.0) -> StoredItem:
    return StoredItem(2, SPEED, (kind, value, -1.0, 0.0))


def free(command: int, *params: float) -> StoredItem:
    return StoredItem(2, command, (*map(float, params), *([0.0] * (4 - len(params)))))


def home_again() -> StoredItem:
    return free(RTL)


def wind_from(speed: float, from_deg: float) -> ConstantWind:
    return ConstantWind.from_direction(speed, from_deg)


@dataclass
class Scene:
    """A flight of a mission and what was seen of it. Item 0 is home, as on ArduPilot, unless it is PX4's."""

    items: list[StoredItem]
    flight: SimulatedFlight
    time: float = 0.0
    begins: list[tuple[int, float]] = field(default_factory=list)
    reached: list[int] = field(default_factory=list)
    words: list[tuple[str, float]] = field(default_factory=list)

    def start(self) -> Scene:
        assert self.flight.fly_mission() is None
        assert self.flight.arm() is None
        self.collect()
        return self

    def advance(self, seconds: float) -> None:
        self.flight.advance(seconds)
        self.time += seconds
        self.collect()

    def collect(self) -> None:
        for event in self.flight.state.events:
            if isinstance(event, Current):
                self.begins.append((event.seq, self.time))
            elif isinstance(event, Reached):
                self.reached.append(event.seq)
            elif isinstance(event, Said):
                self.words.append((event.words, self.time))
        self.flight.state.events.clear()

    def until_over(self, step: float = 0.02, longest: float = 5000.0) -> Scene:
        """Fly until the mission is complete or the motors stop."""
        while self.time < longest and self.flight.state.armed and not self.flight.run.complete:
            self.advance(step)
        assert self.time < longest, f"still on item {self.flight.current} after {longest} s"
        return self

    @property
    def seconds(self) -> dict[int, float]:
        """How long each item took, the first time."""
        begins = [*self.begins, (-1, self.time)]
        taken: dict[int, float] = {}
        for (seq, begin), (_, end) in itertools.pairwise(begins):
            taken.setdefault(seq, end - begin)
        return taken

    @property
    def order(self) -> list[int]:
        return [seq for seq, _ in self.begins]

    def when(self, words: str) -> float:
        return next(time for said, time in self.words if said == words)


def scene(
    items: Sequence[StoredItem], *, wind=None, profile: MotionProfile | None = None, autopilot="ardupilot", terrain=None
) -> Scene:
    """A flight of these items, ready on the ground."""
    firmware = firmware_of(autopilot, "multicopter")
    held = [HOME_ITEM, *items] if autopilot == "ardupilot" else list(items)
    frame = profile or (SWIFT if autopilot == "ardupilot" else firmware.motion)
    world = World(HOME, FRAME, wind if wind is not None else Calm(), terrain)
    return Scene(held, SimulatedFlight(firmware, frame, world, lambda: held))


def fly(items: Sequence[StoredItem], step: float = 0.02, **changes) -> Scene:
    """Fly these items to their end."""
    return scene(items, **changes).start().until_over(step)
