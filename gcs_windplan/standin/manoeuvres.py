"""What the stand-in does, in moves: take off, fly to a place, circle, land, return."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

from gcs_windplan.standin.airframe import Airframe
from gcs_windplan.standin.motion import Body, Circle, Leg, Mark, Move, Wait
from gcs_windplan.standin.pace import SETTLE, Pace, Vector, leg_pace

_SAME_HEIGHT = 0.05  # [m]
_CIRCLE_RADIUS = 10.0  # [m] CIRCLE_RADIUS, ArduCopter's default
_CIRCLE_RATE = math.radians(20.0)  # [rad/s] CIRCLE_RATE, ArduCopter's default


@dataclass(slots=True)
class Manoeuvres:
    """Builds moves for a body. `ground` gives the ground's height AMSL [m] at a place (east, north)."""

    airframe: Airframe
    body: Body
    ground: Callable[[float, float], float]

    def leg(self, end: Vector, ground_speed: float, exit_speed: float = 0.0, start: Vector | None = None) -> Leg:
        """A straight leg from where the body is, or will be, at a commanded ground speed [m/s]."""
        return Leg(end, self.pace(start or self.body.place, end, ground_speed), exit_speed, SETTLE)

    def pace(self, start: Vector, end: Vector, ground_speed: float) -> Pace:
        """The pace of a leg between two places."""
        level = math.hypot(end[0] - start[0], end[1] - start[1])
        return leg_pace(self.airframe, level, end[2] - start[2], ground_speed)

    def take_off(self, altitude: float, lifted: Callable[[], None]) -> list[Move]:
        """Straight up to an altitude [m], after the motors have run up where it stands on the ground."""
        east, north, _ = self.body.place
        rate = self.airframe.climb
        pace = Pace(rate, rate / self.airframe.takeoff_ramp)
        return [Wait(self.airframe.spool_up), Mark(lifted), Leg((east, north, altitude), pace)]

    def change_height(self, start: Vector, altitude: float) -> list[Move]:
        """Straight up or down to an altitude [m]."""
        if abs(altitude - start[2]) < _SAME_HEIGHT:
            return []
        return [self.leg((start[0], start[1], altitude), self.airframe.cruise, start=start)]

    def land(self, start: Vector, touched: Callable[[], None]) -> list[Move]:
        """Straight down to the ground, slowly at the end."""
        east, north, altitude = start
        bottom, slow = self.ground(east, north), self.airframe.landing
        slow_from = bottom + self.airframe.landing_height
        moves: list[Move] = []
        if altitude > slow_from:
            moves.append(self.leg((east, north, slow_from), self.airframe.cruise, slow, start))
        moves.append(Leg((east, north, bottom), Pace(slow, self.airframe.vertical_acceleration), slow))
        return [*moves, Wait(self.airframe.touch_down), Mark(touched)]

    def return_to(self, home: Vector, touched: Callable[[], None]) -> list[Move]:
        """Up to the return height, over home, and down; commanded speeds do not count."""
        east, north, altitude = self.body.place
        height = max(altitude, home[2] + self.airframe.return_height)
        above = (home[0], home[1], height)
        moves = self.change_height(self.body.place, height)
        if math.hypot(home[0] - east, home[1] - north) > 0:
            moves.append(self.leg(above, self.airframe.cruise, start=(east, north, height)))
        moves.append(Wait(self.airframe.return_hover))
        return [*moves, *self.land(above, touched)]

    def circle(self, centre: Vector, turns: float, radius: float, ground_speed: float) -> list[Move]:
        """To the nearest point of a circle and around; clockwise for a radius [m] of 0 and more."""
        size = abs(radius) or _CIRCLE_RADIUS
        east, north = self.body.east - centre[0], self.body.north - centre[1]
        away = math.hypot(east, north)
        direction = (east / away, north / away) if away > 0 else (0.0, 1.0)
        edge = (centre[0] + direction[0] * size, centre[1] + direction[1] * size, centre[2])
        speed = min(ground_speed, size * _CIRCLE_RATE)
        signed = -abs(turns) if radius < 0 else abs(turns)
        return [self.leg(edge, ground_speed), Circle(centre[:2], signed, speed)]

    def stop(self) -> list[Move]:
        """Slow down and stay."""
        speed, velocity = self.body.speed, self.body.velocity
        if speed == 0:
            return [Wait()]
        acceleration = self.airframe.acceleration
        share = speed / (2 * acceleration)  # of a second of flight
        end = tuple(at + v * share for at, v in zip(self.body.place, velocity, strict=True))
        return [Leg((end[0], end[1], end[2]), Pace(speed, acceleration)), Wait()]
