"""How a multicopter paces its legs: how long it takes to reach a speed, and how fast it goes around a corner.

The law was fitted to 217 legs flown by ArduCopter 4.7 in its simulator (jerk-limited S-curves, corners rounded
within the waypoint radius). Here it is put as constant accelerations and corner speeds that take the same time: a
ramp to speed v takes `ramp_seconds(v)` in place of S-curves of that duration, and a corner is slowed down for by
just what the fitted law says that it costs.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TypeAlias

from gcs_windplan.vehicle import MotionProfile
from gcs_windplan.vehicle.pace import overlap_seconds, peak_speed, ramp_seconds

Vector: TypeAlias = tuple[float, float, float]

_STRAIGHT = 1e-3  # [rad] a turn smaller than this is none


@dataclass(frozen=True, slots=True)
class LegPace:
    """How fast a leg is flown along its slope [m/s], and with how much acceleration [m/s²]."""

    speed: float
    acceleration: float


def leg_pace(profile: MotionProfile, level: float, climb: float, ground_speed: float) -> LegPace:
    """The pace of a leg that goes `level` [m] over ground and gains `climb` [m] at a commanded ground speed [m/s].

    Climb and descent rates slow a steep leg; a short leg ends before the speed is reached.
    """
    length = math.hypot(level, climb)
    if length == 0.0:
        return LegPace(ground_speed, profile.acceleration)
    along, rate = level / length, profile.climb if climb > 0 else profile.descent
    steepness = abs(climb) / length
    speed = min(ground_speed / along if along > 0 else math.inf, rate / steepness if steepness > 0 else math.inf)
    acceleration = min(
        profile.acceleration / along if along > 0 else math.inf,
        profile.vertical_acceleration / steepness if steepness > 0 else math.inf,
    )
    speed = min(speed, peak_speed(length, acceleration, profile.jerk, profile.rise))
    return LegPace(speed, speed / ramp_seconds(speed, acceleration, profile.jerk, profile.rise))


def corner_speed(pace: LegPace, turn: float, profile: MotionProfile) -> float:
    """How fast a leg's pace goes around a corner [m/s] with a turn [rad], 0..π."""
    if turn < _STRAIGHT:
        return pace.speed
    ramp = pace.speed / pace.acceleration
    distance = profile.radius / (2 * math.sin(turn / 2))
    overlap = overlap_seconds(distance, profile.acceleration, profile.jerk, profile.rise)
    lost = max(0.0, ramp / 2 - overlap) + profile.settle / 2 * math.sin(turn / 2) ** 2
    return pace.speed * (1 - math.sqrt(min(1.0, 2 * lost / ramp)))


def exit_speed(vectors: Sequence[Vector], paces: Sequence[LegPace], profile: MotionProfile) -> float:
    """The speed [m/s] at which the first of some legs may end, so that the last of them can end at rest."""
    speed = 0.0
    for i in reversed(range(len(vectors) - 1)):
        turn = turn_between(vectors[i], vectors[i + 1])
        gained = math.sqrt(speed**2 + 2 * paces[i + 1].acceleration * math.hypot(*vectors[i + 1]))
        speed = min(gained, corner_speed(paces[i], turn, profile), corner_speed(paces[i + 1], turn, profile))
    return speed


def turn_between(before: Vector, after: Vector) -> float:
    """The turn from one direction to the next [rad], 0..π."""
    cosine = sum(a * b for a, b in zip(before, after, strict=True)) / (math.hypot(*before) * math.hypot(*after))
    return math.acos(max(-1.0, min(1.0, cosine)))
