"""How long a multicopter takes for a polyline, as an autopilot flies it: ramps, corners, holds, take-off, landing.

The law was fitted to 217 legs flown by ArduCopter 4.7 in its simulator: 0.15 s rms, 0.9 s at worst. A leg is a
jerk-limited S-curve from rest to rest. At a waypoint that is passed, the next leg's ramp begins before this one's has
ended: for `overlap` seconds on either side of the waypoint, as long as the corner stays within the waypoint radius.

    speed │   ╭────────╮ ╭────────╮          a leg takes   length / speed + ramp − overlaps + hold
          │  ╱          ╳          ╲         and settles for 0.62 s after a full stop
          │_╱__________╱_╲__________╲__
               leg    corner  next leg
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, fields
from typing import Final

import numpy as np

from gcs_windplan.arrays import BoolArray, FloatArray
from gcs_windplan.errors import InputError, Problem

_STUCK = 0.01  # [m/s] slower than this it stands against the wind
_NO_SHARE = 1e-9  # a slope's part of its length that is rounding
_NO_LEG = 0.01  # [m] places nearer than this are one
_SAME_SPEED = 1e-9  # [m/s]
_HOP = 2.8  # [s] measured: the least that a return takes to come to rest above home


@dataclass(frozen=True, slots=True, kw_only=True)
class MotionProfile:
    """How an autopilot paces a multicopter: speeds [m/s], accelerations [m/s²], jerk [m/s³], lengths [m], times [s].

    Each firmware has its own (`mission.firmware`). `speed` is over ground, level; `airspeed` is the most that the lean
    angle allows. The jerk takes `rise` to come and to go, and a start from rest takes `settle` more; a corner is cut
    within `radius`. It lands with `landing` below the `landing_height` above ground, the changes of speed on the way
    take `landing_ramp` more, and from touching the ground to disarmed it takes `touch_down`. It returns at
    `return_height` above home at least, and hovers there for `return_hover`. From arming to lift-off it takes
    `spool_up`, and a take-off takes `takeoff_ramp` more than height / climb. It circles at `circle_rate` [rad/s] at
    most.

    Raises `InputError` for a value that is not above 0, or accelerations too small for the jerk.
    """

    speed: float
    climb: float
    descent: float
    acceleration: float
    vertical_acceleration: float
    jerk: float
    rise: float
    settle: float
    radius: float
    airspeed: float
    landing: float
    landing_height: float
    landing_ramp: float
    touch_down: float
    return_height: float
    return_hover: float
    spool_up: float
    takeoff_ramp: float
    circle_rate: float

    def __post_init__(self) -> None:
        for field in fields(self):
            value = getattr(self, field.name)
            if not value > 0 and not (value == 0 and field.name in _MAY_BE_NONE):
                raise InputError(Problem(f"must be above 0, not {value}", f"pace.{field.name}"))
        least = self.jerk * self.rise
        if min(self.acceleration, self.vertical_acceleration) < least:
            raise InputError(Problem(f"must be at least jerk · rise, {least:g} m/s²", "pace.acceleration"))


_MAY_BE_NONE: Final = frozenset(
    ("rise", "settle", "landing_ramp", "touch_down", "return_height", "return_hover", "spool_up", "takeoff_ramp")
)


@dataclass(frozen=True, slots=True)
class LegTimes:
    """What the n - 1 legs of a polyline take.

    `seconds` (n - 1,) [s] with the hold at each leg's end; infinite where the wind is too strong. `peaks` (n - 1,)
    [m/s]: the speed along its slope that each leg comes to. `losses` (n,) [s]: what slowing down at each point costs
    beyond passing it at those speeds, the start and the last stop included; a hair below 0 where a leg is entered
    faster than it goes on.
    """

    seconds: FloatArray
    peaks: FloatArray
    losses: FloatArray

    @property
    def total(self) -> float:
        """All legs with their holds [s]."""
        return math.fsum(self.seconds)


def as_flown(
    points: FloatArray,
    speeds: FloatArray | float | None = None,
    holds: FloatArray | float = 0.0,
    winds: FloatArray | None = None,
    *,
    pace: MotionProfile,
    climbs: FloatArray | float | None = None,
    descents: FloatArray | float | None = None,
    stops: Sequence[bool] | None = None,
) -> LegTimes:
    """What flying a polyline (n, 3) takes, from rest to rest; east, north, height [m].

    `speeds` (n - 1,) are the level ground speeds commanded for the legs, `climbs` and `descents` their rates [m/s], by
    default the pace's own. `holds` (n,) [s] and `stops` (n,) say where it comes to rest; a hold at the first point
    does not count. `winds` (n - 1, 2 or 3) [m/s] is each leg's mean wind, east and north.

    A command comes into force after the waypoint where its leg begins. On a leg that was begun at speed it is skipped,
    or done in part, where too little of the leg is straight. Raises `InputError` where shapes or speeds do not fit.
    """
    places = _checked_points(points)
    n = len(places)
    told = [
        _per_leg("speeds", speeds, pace.speed, n - 1),
        _per_leg("climbs", climbs, pace.climb, n - 1),
        _per_leg("descents", descents, pace.descent, n - 1),
    ]
    rests = _broadcast("holds", holds, (n,))
    if not np.all(rests >= 0):
        raise InputError(f"a hold of {float(np.min(rests))} s is not 0 or more")
    halts = (rests > 0) | (_broadcast("stops", False if stops is None else stops, (n,)) > 0)
    air = _broadcast("winds", np.zeros(2) if winds is None else np.asarray(winds)[..., :2], (n - 1, 2))
    legs = _legs(np.diff(places, axis=0), air, np.stack(told, axis=-1), halts, pace)
    return _in_sequence(legs, rests, halts, pace)


def ramp_seconds(speed: float, acceleration: float, jerk: float, rise: float) -> float:
    """How long it takes from rest to a speed [m/s] with limits on acceleration [m/s²] and jerk [m/s³].

    The jerk takes `rise` [s] to come and to go; the way is half of speed · time.
    """
    most = acceleration / jerk + rise
    if speed >= acceleration * most:
        return speed / acceleration + most
    if speed < 2 * jerk * rise**2:  # not even the jerk comes to its limit
        return 4 * math.cbrt(speed * rise / (2 * jerk))
    reached = jerk * (math.sqrt(rise**2 + 4 * speed / jerk) - rise) / 2  # the acceleration, before it falls again
    return 2 * (reached / jerk + rise)


def peak_speed(length: float, acceleration: float, jerk: float, rise: float) -> float:
    """The highest speed [m/s] on a leg [m] from rest to rest: its two ramps fill the leg."""
    most = acceleration / jerk + rise
    if length >= 2 * acceleration * most**2:
        return acceleration * (math.sqrt(most**2 + 4 * length / acceleration) - most) / 2
    if length < 8 * jerk * rise**3:
        return math.sqrt(math.sqrt(length)) ** 3 / (4 * math.sqrt(math.sqrt(rise / (8 * jerk))))
    reached = math.cbrt(length * jerk**2 / 2)  # were there no rise; from here Newton's method only comes down
    for _ in range(30):
        part = reached / jerk + rise
        step = (2 * reached * part**2 - length) / (2 * part * (part + 2 * reached / jerk))
        reached -= step
        if step < 1e-12:
            break
    return reached * (reached / jerk + rise)


def overlap_seconds(distance: float, acceleration: float, jerk: float, rise: float) -> float:
    """For how long [s] a ramp may go on so that it ends, or begins, within a distance [m] of the waypoint.

    For a corner of turn θ the distance is radius / (2 sin(θ / 2)); its ramps overlap so long on either side.
    """
    most = acceleration / jerk + rise
    near = jerk * (most - rise / 2) ** 3 / 6
    if distance <= near:
        return rise / 2 + math.cbrt(6 * distance / jerk)
    speed = acceleration * most / 2
    return most + (math.sqrt(speed**2 + 2 * acceleration * (distance - near)) - speed) / acceleration


def takeoff_seconds(height: float, pace: MotionProfile, climb: float | None = None) -> float:
    """From arming to a height above ground [m]; `climb` is the commanded rate [m/s].

    Measured on ArduCopter: 30.6 s to 60 m.
    """
    return pace.spool_up + max(height, 0.0) / (pace.climb if climb is None else climb) + pace.takeoff_ramp


def landing_seconds(height: float, pace: MotionProfile, descent: float | None = None) -> float:
    """From hovering at a height above ground [m] to disarmed. `descent` is the commanded rate [m/s]."""
    fast = max(height - pace.landing_height, 0.0) / (pace.descent if descent is None else descent)
    slow = min(max(height, 0.0), pace.landing_height) / pace.landing
    return fast + slow + pace.landing_ramp + pace.touch_down


def return_seconds(
    vector: tuple[float, float], height: float, pace: MotionProfile, wind: tuple[float, float] = (0.0, 0.0)
) -> float:
    """A return to launch from rest to disarmed [s]: up to the return height, home, down.

    `vector` [m] leads home, east and north; `height` [m] above it. Speeds commanded in the mission do not count.
    Measured on ArduCopter: d / 10 + (height - 10) / 1.5 + 36.7 s, 66 s from 60 m overhead. Infinite where the wind is
    too strong.
    """
    up = max(pace.return_height - height, 0.0)
    points = np.array([[0.0, 0.0, 0.0], [0.0, 0.0, up], [*vector, up]])
    climb, home = as_flown(points, winds=np.array([wind, wind]), stops=[True] * 3, pace=pace).seconds
    return float(climb) + max(float(home), _HOP) + pace.return_hover + landing_seconds(height + up, pace)


def _checked_points(points: FloatArray) -> FloatArray:
    places = np.asarray(points, dtype=np.float64)
    if places.ndim != 2 or places.shape[1] != 3 or len(places) < 2 or not np.all(np.isfinite(places)):
        raise InputError(f"a polyline is two or more finite points of three numbers, not an array {places.shape}")
    return places


def _per_leg(name: str, values: FloatArray | float | None, default: float, legs: int) -> FloatArray:
    speeds = _broadcast(name, default if values is None else values, (legs,))
    if not np.all(speeds > 0):
        raise InputError(f"{name}: {float(np.min(speeds))} m/s is no speed to fly at, give one above 0")
    return speeds


def _broadcast(name: str, values: FloatArray | Sequence[bool] | float, shape: tuple[int, ...]) -> FloatArray:
    given = np.asarray(values, dtype=np.float64)
    try:
        return np.broadcast_to(given, shape)
    except ValueError:
        raise InputError(f"{name} of shape {given.shape} do not fit {shape}") from None


@dataclass(frozen=True, slots=True)
class _Leg:
    """A leg's length [m], direction, acceleration along the slope [m/s²], and the speeds along it [m/s].

    `entered` is the speed that it was planned with at the waypoint before, `wanted` the one commanded since.
    """

    length: float
    direction: FloatArray
    acceleration: float
    entered: float
    wanted: float

    @property
    def flyable(self) -> bool:
        return min(self.entered, self.wanted) > _STUCK

    def ramp(self, speed: float, pace: MotionProfile) -> float:
        return ramp_seconds(speed, self.acceleration, pace.jerk, pace.rise)


def _legs(
    vectors: FloatArray, winds: FloatArray, told: FloatArray, halts: BoolArray, pace: MotionProfile
) -> list[_Leg | None]:
    """The legs; None where two points are one."""
    legs: list[_Leg | None] = []
    for i, vector in enumerate(vectors):
        length = float(np.linalg.norm(vector))
        if length < _NO_LEG:
            legs.append(None)
            continue
        direction = vector / length
        level, steep = math.hypot(direction[0], direction[1]), abs(float(direction[2]))
        acceleration = min(_over(pace.acceleration, level), _over(pace.vertical_acceleration, steep))
        fresh = i == 0 or halts[i] or legs[i - 1] is None
        entered, wanted = (_limit(direction, winds[i], told[j], pace) for j in (i if fresh else i - 1, i))
        legs.append(_Leg(length, direction, acceleration, entered, wanted))
    return legs


def _over(limit: float, share: float) -> float:
    """A limit on one component as a limit along the slope."""
    return limit / share if share > _NO_SHARE else math.inf


def _limit(direction: FloatArray, wind: FloatArray, told: FloatArray, pace: MotionProfile) -> float:
    """The highest speed along a slope [m/s] by what was commanded, and by what the lean angle leaves in the wind."""
    speed, climb, descent = told
    east, north, up = direction
    level = math.hypot(east, north)
    across, along = wind[1] * east - wind[0] * north, wind[0] * east + wind[1] * north
    vertical = _over(climb if up > 0 else descent, abs(up))
    if level <= _NO_SHARE:
        return float(vertical) if math.hypot(*wind) <= pace.airspeed else 0.0
    spare = pace.airspeed**2 - (across / level) ** 2
    carried = math.sqrt(spare) + along / level if spare >= 0 else 0.0
    return float(min(min(speed, max(carried, 0.0)) / level, vertical))


def _in_sequence(legs: Sequence[_Leg | None], rests: FloatArray, halts: BoolArray, pace: MotionProfile) -> LegTimes:
    seconds, peaks, losses = rests[1:].copy(), np.zeros(len(legs)), np.zeros(len(legs) + 1)
    overlap, settle = 0.0, pace.settle
    for i, leg in enumerate(legs):
        following = legs[i + 1] if i + 1 < len(legs) and not halts[i + 1] else None
        if leg is None or not leg.flyable:
            seconds[i] += 0.0 if leg is None else math.inf
            overlap, settle = 0.0, pace.settle
            continue
        first, last, change = _speeds(leg, overlap, pace)
        ramps = leg.ramp(first, pace), leg.ramp(last, pace)
        before, settling = overlap, settle
        overlap, settle = _corner(leg, last, following, pace)
        losses[i] += ramps[0] / 2 - before + settling
        losses[i + 1] += ramps[1] / 2 - overlap
        steady = leg.length - (first * ramps[0] + (first + last) * change + last * ramps[1]) / 2
        seconds[i] += ramps[0] + change + steady / last + ramps[1] - before - overlap + settling
        peaks[i] = last
    return LegTimes(seconds, peaks, losses)


def _corner(leg: _Leg, speed: float, following: _Leg | None, pace: MotionProfile) -> tuple[float, float]:
    """For how long the ramps of a leg that ends with a speed and of the next overlap, and what settling takes [s]."""
    if following is None or not following.flyable:
        return 0.0, pace.settle
    half_turn = float(np.linalg.norm(following.direction - leg.direction)) / 2  # its sine
    distance = pace.radius / (2 * half_turn) if half_turn > 1e-9 else math.inf
    entered = min(following.entered, peak_speed(following.length, following.acceleration, pace.jerk, pace.rise))
    overlap = min(
        overlap_seconds(distance, pace.acceleration, pace.jerk, pace.rise),
        _level_overlap(leg, following, pace),
        leg.ramp(speed, pace) / 2,
        following.ramp(entered, pace) / 2,
    )
    return overlap, pace.settle * half_turn**2


def _level_overlap(leg: _Leg, following: _Leg, pace: MotionProfile) -> float:
    """For how long two ramps may overlap before the slope's change takes more than the vertical acceleration [s].

    AP_Math's SCurve, advance_target_along_track, limits it so at the turn's middle.
    """
    allowed = _over(pace.vertical_acceleration, abs(float(following.direction[2] - leg.direction[2])))
    if allowed >= min(leg.acceleration, following.acceleration):
        return math.inf
    return allowed / pace.jerk + pace.rise / 2


def _speeds(leg: _Leg, elapsed: float, pace: MotionProfile) -> tuple[float, float, float]:
    """The speeds [m/s] that a leg ramps up to and ramps down from, and how long the change between them takes [s].

    A slower command first cuts the ramp short, as far as that still has constant acceleration ahead of it. The rest is
    done on the straight part, within its first half; it is skipped if that part is flown in less than 12 rises of the
    jerk (AP_Math's SCurve, set_speed_max).
    """
    entered = min(leg.entered, peak_speed(leg.length, leg.acceleration, pace.jerk, pace.rise))
    if abs(leg.wanted - leg.entered) < _SAME_SPEED:
        return entered, entered, 0.0
    first = max(min(leg.wanted, entered), _cut_short(leg, entered, elapsed, pace))
    straight, room = leg.length - first * leg.ramp(first, pace), 12 * pace.rise
    if abs(leg.wanted - first) < _SAME_SPEED or straight <= room * first:
        return first, first, 0.0
    wanted = leg.wanted if leg.wanted < first or room == 0 else min(leg.wanted, straight / room)
    return first, *_changed(leg, first, wanted, straight, pace)


def _cut_short(leg: _Leg, entered: float, elapsed: float, pace: MotionProfile) -> float:
    """The lowest speed [m/s] that a ramp to `entered` can still end at."""
    begins, ends = leg.acceleration / pace.jerk + pace.rise, entered / leg.acceleration
    return entered - leg.acceleration * max(0.0, ends - max(elapsed, begins))


def _changed(leg: _Leg, first: float, wanted: float, straight: float, pace: MotionProfile) -> tuple[float, float]:
    """The speed [m/s] that a change comes to on a straight part [m], and the time [s] that it takes."""

    def fits(speed: float) -> bool:
        way = (first + speed) / 2 * leg.ramp(abs(speed - first), pace)
        slowing = (speed * leg.ramp(speed, pace) - first * leg.ramp(first, pace)) / 2
        return way <= straight / 2 and way + slowing <= straight

    done, undone = first, wanted
    if fits(wanted):
        done = wanted
    else:
        for _ in range(40):
            middle = (done + undone) / 2
            done, undone = (middle, undone) if fits(middle) else (done, middle)
    return done, leg.ramp(abs(done - first), pace)
