"""The stand-in as it is at one moment, for its telemetry.

The battery is a plain linear one: full at arming, empty after half an hour in the air, whatever is flown.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from pymavlink.dialects.v20 import ardupilotmega as mavlink

from gcs_windplan.geo.frame import GeoPoint, rotate
from gcs_windplan.mission import Home
from gcs_windplan.mission.firmware import Mode
from gcs_windplan.standin.flight import SimulatedFlight

ENDURANCE = 1800.0  # [s]

_STILL = 0.2  # [m/s] slower through the air the nose stays where it points
_LEAN = math.radians(30.0) / 10.16  # [rad per m/s] measured: 10.16 m/s through the air at 30°, 15.0 at 45°
_MOST_LEAN = math.radians(60.0)


@dataclass(frozen=True, slots=True)
class Snapshot:
    """The vehicle at one moment. Velocities along true east, north and up [m/s], angles in rad from true north."""

    boot: float
    unix: float
    point: GeoPoint
    altitude: float
    home: Home
    local: tuple[float, float, float]
    velocity: tuple[float, float, float]
    wind: tuple[float, float]
    heading: float
    pitch: float
    armed: bool
    landed: bool
    booting: bool
    charge: float
    mode: Mode
    kind: int
    seq: int
    items: int
    mission_state: int
    target: tuple[float, float] | None

    @property
    def airspeed(self) -> float:
        """Speed through the air [m/s]."""
        return math.hypot(self.velocity[0] - self.wind[0], self.velocity[1] - self.wind[1], self.velocity[2])

    @property
    def ground_speed(self) -> float:
        """Level speed over ground [m/s]."""
        return math.hypot(self.velocity[0], self.velocity[1])

    @property
    def boot_ms(self) -> int:
        """Milliseconds since boot."""
        return int(self.boot * 1000) & 0xFFFFFFFF

    @property
    def heading_deg(self) -> float:
        """The heading [deg], 0 up to 360."""
        return math.degrees(self.heading) % 360


class Observer:
    """Takes snapshots of a flight; remembers the nose's direction and how long the battery was in use."""

    def __init__(self, flight: SimulatedFlight) -> None:
        self._flight = flight
        self._heading = 0.0
        self._used = 0.0

    def reset(self) -> None:
        """A fresh battery."""
        self._used = 0.0

    def advance(self, seconds: float) -> None:
        """Let the battery run for some seconds."""
        if self._flight.state.armed:
            self._used += seconds

    def look(self, boot: float, unix: float, mode: Mode, kind: int, booting: bool, items: int) -> Snapshot:
        """The vehicle as it is now."""
        state, run = self._flight.state, self._flight.run
        body = state.body
        turn = float(state.world.frame.convergence(np.array([[body.east, body.north]]))[0])
        velocity = (*_turned(body.velocity[:2], turn), body.velocity[2])
        wind = _turned(body.wind, turn)
        air = (velocity[0] - wind[0], velocity[1] - wind[1]) if not state.landed else (0.0, 0.0)
        airspeed = math.hypot(*air)
        if airspeed > _STILL:
            # the nose points into the air that it flies through: it crabs over ground, and hovers nose to the wind
            self._heading = math.atan2(air[0], air[1])
        home = state.home_place
        leg_end = self._flight.leg_end
        return Snapshot(
            boot=boot,
            unix=unix,
            point=state.point,
            altitude=body.altitude,
            home=state.home,
            local=(body.east - home[0], body.north - home[1], body.altitude - home[2]),
            velocity=velocity,
            wind=wind,
            heading=self._heading,
            pitch=-min(_LEAN * airspeed, _MOST_LEAN),
            armed=state.armed,
            landed=state.landed,
            booting=booting,
            charge=max(0.0, 1.0 - self._used / ENDURANCE),
            mode=mode,
            kind=kind,
            seq=run.current,
            items=items,
            mission_state=self._mission_state(items),
            target=None if leg_end is None else _bearing(body.place[:2], leg_end[:2], turn),
        )

    def _mission_state(self, items: int) -> int:
        if items == 0:
            return int(mavlink.MISSION_STATE_NO_MISSION)
        if self._flight.run.complete:
            return int(mavlink.MISSION_STATE_COMPLETE)
        if self._flight.flies_mission:
            return int(mavlink.MISSION_STATE_ACTIVE)
        begun = self._flight.state.armed and self._flight.run.current > 0
        return int(mavlink.MISSION_STATE_PAUSED if begun else mavlink.MISSION_STATE_NOT_STARTED)


def _turned(vector: tuple[float, ...], angle: float) -> tuple[float, float]:
    east, north = rotate(np.array([vector]), angle)[0]
    return float(east), float(north)


def _bearing(start: tuple[float, ...], end: tuple[float, ...], turn: float) -> tuple[float, float]:
    """The true bearing [rad] and the distance [m] from one local place to another."""
    east, north = end[0] - start[0], end[1] - start[1]
    return math.atan2(east, north) + turn, math.hypot(east, north)
