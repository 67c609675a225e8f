"""The stand-in's body and its moves: straight legs, circles, waits. Each moves the body on for a stretch of time.

Speeds change at constant acceleration, and each phase of a leg (faster, steady, slower) is taken in one exact
step, so that a leg's time does not depend on how often the clock is asked.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Protocol

from gcs_windplan.standin.local_wind import LocalWind, speed_over_ground
from gcs_windplan.standin.pace import LegPace

_LOOK = 1.0  # [s] after so long the wind is looked at again
_THERE = 1e-4  # [m]
_NO_WAY = 1e-6  # [m] nearer than this to where it must slow down, it does
_STUCK = 0.01  # [m/s] slower than this it stands against the wind


@dataclass(slots=True)
class Body:
    """Where the vehicle is and how it moves: east, north, altitude AMSL [m], `speed` along its move [m/s].

    `velocity` is over ground, east, north and up [m/s]; `clock` the seconds since departure.
    """

    east: float
    north: float
    altitude: float
    air: LocalWind
    airspeed: float
    speed: float = 0.0
    velocity: tuple[float, float, float] = (0.0, 0.0, 0.0)
    clock: float = 0.0

    @property
    def place(self) -> tuple[float, float, float]:
        """East, north and altitude."""
        return self.east, self.north, self.altitude

    @property
    def wind(self) -> tuple[float, float]:
        """The wind here and now, towards east and north [m/s]."""
        return self.air.at(self.east, self.north, self.altitude, self.clock)

    def stand(self) -> None:
        """Have no speed."""
        self.speed, self.velocity = 0.0, (0.0, 0.0, 0.0)


class Segment(Protocol):
    """A part of a flight."""

    @property
    def done(self) -> bool:
        """Whether it has come to its end."""

    def advance(self, body: Body, seconds: float) -> float:
        """Segment the body on for at most `seconds`; what is left of them is returned, more than 0 only when done."""


@dataclass(slots=True)
class StraightSegment:
    """A straight way to `end` (east, north, altitude) at a pace, ending at a speed.

    It begins where the body is, at the body's speed, and after `settling` seconds at rest.
    """

    end: tuple[float, float, float]
    pace: LegPace
    exit_speed: float = 0.0
    settling: float = 0.0
    done: bool = False

    def advance(self, body: Body, seconds: float) -> float:
        """See `Segment`."""
        if self.settling > 0 and body.speed == 0:
            rest = min(self.settling, seconds)
            self.settling -= rest
            body.clock += rest
            seconds -= rest
            if self.settling > 0:
                return seconds
        self.settling = 0.0
        while seconds > 0 and not self.done:
            seconds -= self._phase(body, seconds)
        return seconds

    def _phase(self, body: Body, seconds: float) -> float:
        """One stretch of constant acceleration, and how long it took."""
        vector = (self.end[0] - body.east, self.end[1] - body.north, self.end[2] - body.altitude)
        length = math.hypot(*vector)
        if length < _THERE:
            self._arrive(body)
            return 0.0
        track = (vector[0] / length, vector[1] / length, vector[2] / length)
        limit = min(self.pace.speed, _limit_by_wind(body, track))
        if limit < _STUCK:
            body.stand()
            body.clock += min(seconds, _LOOK)
            return min(seconds, _LOOK)
        distance, speed, time = _stretch(
            body.speed, length, limit, self.exit_speed, self.pace.acceleration, min(seconds, _LOOK)
        )
        body.clock += time
        body.speed = speed
        if length - distance < _THERE:
            self._arrive(body)
        else:
            body.east += track[0] * distance
            body.north += track[1] * distance
            body.altitude += track[2] * distance
        body.velocity = (track[0] * speed, track[1] * speed, track[2] * speed)
        return time

    def _arrive(self, body: Body) -> None:
        body.east, body.north, body.altitude = self.end
        self.done = True
        if self.exit_speed == 0:
            body.stand()


def _limit_by_wind(body: Body, track: tuple[float, float, float]) -> float:
    """The highest speed along a track [m/s] that the airspeed allows in this wind."""
    level = math.hypot(track[0], track[1])
    if level < 1e-9:
        return math.inf
    return speed_over_ground(body.airspeed, body.wind, track[0] / level, track[1] / level) / level


def _stretch(
    speed: float, length: float, limit: float, exit_speed: float, acceleration: float, seconds: float
) -> tuple[float, float, float]:
    """The next phase on a length [m]: how far it goes, the speed at its end, and how long it takes.

    Slower to the limit where it was faster; faster until the limit or until it must slow down; steady; slower to the
    exit speed.
    """
    braking = max(0.0, (speed**2 - exit_speed**2) / (2 * acceleration))
    if braking > 0 and length <= braking + _NO_WAY:
        slowing = (speed**2 - exit_speed**2) / (2 * length)
        time = (speed - exit_speed) / slowing
        if time <= seconds:
            return length, exit_speed, time
        return (speed - slowing * seconds / 2) * seconds, speed - slowing * seconds, seconds
    if speed > limit + 1e-9:
        slowest = max(limit, math.sqrt(max(0.0, speed**2 - 2 * acceleration * length)))
        time = min(seconds, (speed - slowest) / acceleration)
        return min(length, (speed - acceleration * time / 2) * time), speed - acceleration * time, time
    peak = min(limit, math.sqrt(acceleration * length + (speed**2 + exit_speed**2) / 2))
    if exit_speed > peak:  # it will still be gaining speed at the end
        peak = min(limit, math.sqrt(speed**2 + 2 * acceleration * length))
    if peak - speed > 1e-9:
        time = min(seconds, (peak - speed) / acceleration)
        return min(length, (speed + acceleration * time / 2) * time), speed + acceleration * time, time
    time = min(seconds, (length - braking) / speed)
    return speed * time, speed, time


@dataclass(slots=True)
class Circle:
    """Turns around a centre (east, north) from where the body is; clockwise where `turns` is positive."""

    centre: tuple[float, float]
    turns: float
    speed: float
    done: bool = False
    _turned: float = 0.0

    def advance(self, body: Body, seconds: float) -> float:
        """See `Segment`."""
        east, north = body.east - self.centre[0], body.north - self.centre[1]
        radius = math.hypot(east, north)
        whole = abs(self.turns) * 2 * math.pi
        if radius < _THERE or whole == 0:
            self.done = True
            return seconds
        rate = self.speed / radius
        time = min(seconds, (whole - self._turned) / rate)
        self._turned += rate * time
        direction = math.copysign(1.0, self.turns)
        angle = math.atan2(east, north) + direction * rate * time
        body.east, body.north = self.centre[0] + radius * math.sin(angle), self.centre[1] + radius * math.cos(angle)
        body.speed = self.speed
        body.velocity = (
            direction * self.speed * math.cos(angle),
            -direction * self.speed * math.sin(angle),
            0.0,
        )
        body.clock += time
        if self._turned >= whole * (1 - 1e-12):
            self.done = True
            body.stand()
        return seconds - time


@dataclass(slots=True)
class Wait:
    """Stay for some seconds, or indefinitely."""

    seconds: float = math.inf
    done: bool = False

    def advance(self, body: Body, seconds: float) -> float:
        """See `Segment`."""
        body.stand()
        time = min(seconds, self.seconds)
        self.seconds -= time
        body.clock += time
        self.done = self.seconds <= 0
        return seconds - time


@dataclass(slots=True)
class Mark:
    """Something that happens between moves and takes no time."""

    action: Callable[[], None] = field(repr=False)
    done: bool = False

    def advance(self, body: Body, seconds: float) -> float:
        """See `Segment`."""
        self.done = True
        self.action()
        return seconds
