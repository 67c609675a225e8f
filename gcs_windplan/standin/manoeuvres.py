"""What the stand-in does, in moves: take off, fly to a place, circle, land, return."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

from gcs_windplan.standin.motion import Body, Circle, Mark, Segment, StraightSegment, Wait
from gcs_windplan.standin.pace import LegPace, Vector, leg_pace
from gcs_windplan.vehicle import MotionProfile

_SAME_HEIGHT = 0.05  # [m]


@dataclass(slots=True)
class Manoeuvres:
    """Builds moves for a body. `ground` gives the ground's height AMSL [m] at a place (east, north).

    `circle_radius` [m] is that of circles for which none is named.
    """

    profile: MotionProfile
    body: Body
    ground: Callable[[float, float], float]
    circle_radius: float

    def leg(
        self, end: Vector, ground_speed: float, exit_speed: float = 0.0, start: Vector | None = None
    ) -> StraightSegment:
        """A straight leg from where the body is, or will be, at a commanded ground speed [m/s]."""
        return StraightSegment(
            end, self.pace(start or self.body.place, end, ground_speed), exit_speed, self.profile.settle
        )

    def pace(self, start: Vector, end: Vector, ground_speed: float) -> LegPace:
        """The pace of a leg between two places."""
        level = math.hypot(end[0] - start[0], end[1] - start[1])
        return leg_pace(self.profile, level, end[2] - start[2], ground_speed)

    def take_off(self, altitude: float, lifted: Callable[[], None]) -> list[Segment]:
        """Straight up to an altitude [m], after the motors have run up where it stands on the ground."""
        east, north, _ = self.body.place
        rate = self.profile.climb
        ramp = self.profile.takeoff_ramp
        pace = LegPace(rate, rate / ramp if ramp > 0 else self.profile.vertical_acceleration)
        return [Wait(self.profile.spool_up), Mark(lifted), StraightSegment((east, north, altitude), pace)]

    def change_height(self, start: Vector, altitude: float) -> list[Segment]:
        """Straight up or down to an altitude [m]."""
        if abs(altitude - start[2]) < _SAME_HEIGHT:
            return []
        return [self.leg((start[0], start[1], altitude), self.profile.speed, start=start)]

    def land(self, start: Vector, touched: Callable[[], None]) -> list[Segment]:
        """Straight down to the ground, slowly at the end."""
        east, north, altitude = start
        bottom, slow = self.ground(east, north), self.profile.landing
        slow_from = bottom + self.profile.landing_height
        moves: list[Segment] = []
        if altitude > slow_from:
            moves.append(self.leg((east, north, slow_from), self.profile.speed, slow, start))
        moves.append(StraightSegment((east, north, bottom), LegPace(slow, self.profile.vertical_acceleration), slow))
        return [*moves, Wait(self.profile.touch_down), Mark(touched)]

    def return_to(self, home: Vector, touched: Callable[[], None]) -> list[Segment]:
        """Up to the return height, over home, and down; commanded speeds do not count."""
        east, north, altitude = self.body.place
        height = max(altitude, home[2] + self.profile.return_height)
        above = (home[0], home[1], height)
        moves = self.change_height(self.body.place, height)
        if math.hypot(home[0] - east, home[1] - north) > 0:
            moves.append(self.leg(above, self.profile.speed, start=(east, north, height)))
        moves.append(Wait(self.profile.return_hover))
        return [*moves, *self.land(above, touched)]

    def circle(self, centre: Vector, turns: float, radius: float, ground_speed: float) -> list[Segment]:
        """To the nearest point of a circle and around; clockwise for a radius [m] of 0 and more."""
        size = abs(radius) or self.circle_radius
        east, north = self.body.east - centre[0], self.body.north - centre[1]
        away = math.hypot(east, north)
        direction = (east / away, north / away) if away > 0 else (0.0, 1.0)
        edge = (centre[0] + direction[0] * size, centre[1] + direction[1] * size, centre[2])
        speed = min(ground_speed, size * self.profile.circle_rate)
        signed = -abs(turns) if radius < 0 else abs(turns)
        return [self.leg(edge, ground_speed), Circle(centre[:2], signed, speed)]

    def stop(self) -> list[Segment]:
        """Slow down and stay."""
        speed, velocity = self.body.speed, self.body.velocity
        if speed == 0:
            return [Wait()]
        acceleration = self.profile.acceleration
        share = speed / (2 * acceleration)  # of a second of flight
        end = tuple(at + v * share for at, v in zip(self.body.place, velocity, strict=True))
        return [StraightSegment((end[0], end[1], end[2]), LegPace(speed, acceleration)), Wait()]
