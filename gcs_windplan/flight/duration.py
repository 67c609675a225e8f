"""How long an autopilot takes for a mission: its moves timed as a multicopter flies them.

A plan counts what the wind lets the vehicle do; an autopilot takes longer, since it gains and loses speed at every
stop and corner. The pace is the vehicle's (`gcs_windplan.vehicle.pace`), the moves are the mission's (`course`).
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from itertools import groupby
from typing import Final, TypeAlias

import numpy as np

from gcs_windplan.arrays import FloatArray
from gcs_windplan.errors import InputError
from gcs_windplan.mission.items import MissionItems
from gcs_windplan.mission.path import Course, Move, Place, course_of
from gcs_windplan.vehicle import (
    ARDUCOPTER_PACE,
    PX4_PACE,
    Autopilot,
    Pace,
    as_flown,
    landing_seconds,
    return_seconds,
    takeoff_seconds,
)

#: The mean wind [m/s] (n, 3) along straight legs from places (n, 3) to places (n, 3): east, north of home and height
#: AMSL [m]. For a wind field in home's frame: `lambda starts, ends: field.at((starts + ends) / 2)`.
WindAlong: TypeAlias = Callable[[FloatArray, FloatArray], FloatArray]

_CIRCLE_RATE: Final = math.radians(20.0)  # [rad/s] CIRCLE_RATE, ArduCopter's default
_INWARDS: Final = 0.5  # of the acceleration that a circle may take: AC_Circle.cpp, calc_velocities


@dataclass(frozen=True, slots=True)
class FlownLeg:
    """A leg as flown, or a wait in place.

    `item` counts the mission's items from 1, home being 0. `start` and `end` are east, north of home and height AMSL
    [m]. `seconds` contain `hold` [s] at its end, circles there included, and are infinite where the wind is too strong.
    `commanded` is the level ground speed, `peak` the speed along the slope that it comes to [m/s].
    """

    item: int
    start: Place
    end: Place
    commanded: float
    peak: float
    hold: float
    seconds: float


@dataclass(frozen=True, slots=True)
class MissionDuration:
    """How long a mission takes [s], in parts.

    `takeoff` from arming to the height of the take-off item; then `legs`; `ending` from the end of the last leg to
    disarmed, on the way home or down. All take-offs and landings of the mission are in `takeoff` and `ending`.
    `losses` is how much of the legs' time goes into slowing at corners and stops. `remarks` name what is not modelled.
    """

    takeoff: float
    legs: tuple[FlownLeg, ...]
    ending: float
    losses: float
    remarks: tuple[str, ...] = ()

    @property
    def en_route(self) -> float:
        """All legs with their holds [s]."""
        return math.fsum(leg.seconds for leg in self.legs)

    @property
    def total(self) -> float:
        """From arming to disarmed, or to the last item [s]."""
        return self.takeoff + self.en_route + self.ending


def duration_of(mission: MissionItems, wind: WindAlong | None = None, pace: Pace | None = None) -> MissionDuration:
    """How long the mission's autopilot takes for it, from arming at home on.

    `pace` is by default that of the mission's autopilot with its default parameters, ArduPilot's where it names none.
    Without `wind` the air is still. Waypoints above terrain count as above home. Raises `InputError` where the
    mission names no home, or is a fixed-wing's, or repeats more than 20 000 items.
    """
    if mission.home is not None and mission.vehicle_type == "fixed-wing":
        raise InputError("how long a fixed-wing takes for a mission is not known, only a multicopter's time is")
    pace = pace_of(mission.autopilot) if pace is None else pace
    course = course_of(mission)
    times = time_course(course, _winds(course.moves, wind), pace)
    takeoff = math.fsum(s for move, s in zip(course.moves, times.seconds, strict=True) if move.kind == "take-off")
    ending = math.fsum(
        s for move, s in zip(course.moves, times.seconds, strict=True) if move.kind in ("landing", "return")
    )
    return MissionDuration(takeoff, tuple(_legs(course, times, pace)), ending, times.losses, course.remarks)


def pace_of(autopilot: Autopilot | None) -> Pace:
    """The pace of an autopilot with its default parameters, ArduPilot's where none is named."""
    return PX4_PACE if autopilot == "px4" else ARDUCOPTER_PACE


@dataclass(frozen=True, slots=True)
class CourseTimes:
    """What n moves take.

    `seconds` (n,) with holds, infinite where the wind is too strong; `peaks` (n,), the speed along its slope that a leg
    comes to [m/s]; `losses` [s] of the legs by slowing at corners and stops.
    """

    seconds: FloatArray
    peaks: FloatArray
    losses: float


def time_course(course: Course, winds: FloatArray, pace: Pace) -> CourseTimes:
    """Time the moves in their mean winds (n, 3) [m/s]; a return's is that on the way home."""
    seconds, peaks, losses, first = np.zeros(len(course.moves)), np.zeros(len(course.moves)), 0.0, 0
    for kind, group in groupby(course.moves, key=lambda move: move.kind):
        moves = list(group)
        part = slice(first, first + len(moves))
        if kind == "leg":
            times = _legs_flown(moves, winds[part], pace)
            seconds[part], peaks[part] = times.seconds, times.peaks
            losses += times.losses
        else:
            seconds[part] = [_upright(move, wind, pace) for move, wind in zip(moves, winds[part], strict=True)]
        first += len(moves)
    return CourseTimes(seconds, peaks, losses)


def circling_speed(move: Move, pace: Pace) -> float:
    """The speed [m/s] of a multicopter on its circles: AC_Circle.cpp, calc_velocities, with the default CIRCLE_RATE.

    As commanded, but at most CIRCLE_RATE round the middle, and with half of the acceleration towards it.
    """
    told = pace.speed if move.told.ground is None else move.told.ground
    return min(told, _CIRCLE_RATE * move.radius, math.sqrt(_INWARDS * pace.acceleration * move.radius))


def circling_seconds(move: Move, pace: Pace) -> float:
    """How long a multicopter flies in circles at the end of a move [s]."""
    return move.circling / circling_speed(move, pace) if move.circling > 0 else 0.0


def _legs_flown(moves: Sequence[Move], winds: FloatArray, pace: Pace) -> CourseTimes:
    """Legs one after the other, from rest to rest."""
    told = [move.told for move in moves]
    times = as_flown(
        np.array([moves[0].start, *(move.end for move in moves)]),
        np.array([pace.speed if one.ground is None else one.ground for one in told]),
        np.array([0.0, *(move.hold + circling_seconds(move, pace) for move in moves)]),
        winds,
        pace,
        climbs=np.array([pace.climb if one.climb is None else one.climb for one in told]),
        descents=np.array([pace.descent if one.descent is None else one.descent for one in told]),
        stops=[*(move.rests for move in moves), True],
    )
    return CourseTimes(times.seconds, times.peaks, math.fsum(times.losses))


def _upright(move: Move, wind: FloatArray, pace: Pace) -> float:
    """A take-off, a landing or a return [s]."""
    (e0, n0, z0), (e1, n1, z1) = move.start, move.end
    if move.kind == "take-off":
        return takeoff_seconds(z1 - z0, pace, move.told.climb)
    if move.kind == "landing":
        return landing_seconds(z0 - z1, pace, move.told.descent)
    return return_seconds((e1 - e0, n1 - n0), z0 - z1, pace, (float(wind[0]), float(wind[1])))


def _winds(moves: Sequence[Move], wind: WindAlong | None) -> FloatArray:
    """The mean wind along each move (n, 3); along a return's level way."""
    if wind is None or not moves:
        return np.zeros((len(moves), 3))
    starts = np.array([move.start for move in moves])
    ends = np.array([(*move.end[:2], move.start[2]) if move.kind == "return" else move.end for move in moves])
    return np.asarray(wind(starts, ends), dtype=np.float64)


def _legs(course: Course, times: CourseTimes, pace: Pace) -> Iterator[FlownLeg]:
    for move, seconds, peak in zip(course.moves, times.seconds, times.peaks, strict=True):
        if move.kind == "leg":
            commanded = pace.speed if move.told.ground is None else move.told.ground
            hold = move.hold + circling_seconds(move, pace)
            yield FlownLeg(move.item, move.start, move.end, commanded, float(peak), hold, float(seconds))
