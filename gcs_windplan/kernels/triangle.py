"""Speed over ground in wind, and the time that a leg takes.

The functions that the search calls for every edge are inlined by order: as calls they would cost it a third more.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from gcs_windplan.arrays import FloatArray, IntArray
from gcs_windplan.kernels.compiled import compiled, inlined

TRIANGLE, PAPER = 0.0, 1.0


class Performance(NamedTuple):
    """A vehicle as the kernels take it: plain floats, since arrays would be read from memory again for each edge."""

    model: float  # TRIANGLE or PAPER
    airspeed: float  # [m/s], as are the next two
    climb: float
    descent: float
    hovers: float  # 1 or 0


@inlined
def flown_at(performance: Performance, airspeed: float) -> Performance:
    """The same vehicle at another airspeed."""
    return Performance(performance.model, airspeed, performance.climb, performance.descent, performance.hovers)


@inlined
def ground_speed(model: float, airspeed: float, along: float, cross: float) -> float:
    """Speed along the track [m/s] with the wind's components along and across it; 0 where it cannot be flown.

    Wind triangle: sqrt(V² − cross²) + along. Paper (12): V + along, refused in wind of V and more, where its speeds
    around the circle no longer make sense.
    """
    if model == PAPER:
        if along * along + cross * cross >= airspeed * airspeed:
            return 0.0
        return airspeed + along
    rest = airspeed * airspeed - cross * cross
    if rest < 0.0:
        return 0.0
    return max(0.0, math.sqrt(rest) + along)


@inlined
def leg_seconds(
    performance: Performance,
    level: float, east: float, north: float, climb: float,
    wind_e: float, wind_n: float, wind_u: float,
) -> float:  # fmt: skip
    """Seconds for a leg in one wind; infinite where it cannot be flown or the wind is not known (NaN).

    The leg goes `level` [m] along the level unit track (east, north) and gains `climb` [m]. It takes the longer of two
    times: the level way at the ground speed, the climb at the climb or descent rate in air that itself rises or
    sinks. A vehicle that hovers slows down for a steep leg, as far as a tail wind lets it.
    """
    airspeed = performance.airspeed
    upward = performance.climb + wind_u
    downward = performance.descent - wind_u
    if not (upward >= 0.0 and downward >= 0.0):  # it cannot even hold its height
        return math.inf
    rise = abs(climb)
    rate = upward if climb > 0.0 else downward
    if level < 1e-6:
        calm_enough = wind_e * wind_e + wind_n * wind_n <= airspeed * airspeed
        if performance.hovers == 0.0 or not calm_enough or (rise > 0.0 and rate == 0.0):
            return math.inf
        return rise / rate if rise > 0.0 else 0.0
    along = wind_e * east + wind_n * north
    cross = wind_n * east - wind_e * north
    speed = ground_speed(performance.model, airspeed, along, cross)
    if not speed > 0.0:
        return math.inf
    if rise * speed <= rate * level:
        return level / speed
    if performance.hovers == 0.0 or rate == 0.0:
        return math.inf
    vertical = rise / rate
    if performance.model == TRIANGLE and along - math.sqrt(airspeed * airspeed - cross * cross) > level / vertical:
        return math.inf  # the tail wind pushes it faster than it can climb
    return vertical


@inlined
def beyond_limit(winds: FloatArray, k: int) -> bool:
    """Whether the wind k of (n, 3 or 4) is beyond what is allowed: then its fourth component is more than 1."""
    return bool(winds.shape[1] > 3 and winds[k, 3] > 1.0)


@inlined
def wind_angle(east: float, north: float, up: float, wind_e: float, wind_n: float, wind_u: float) -> float:
    """The angle between a direction and the wind [rad], 0..π: equation (10) with atan2 for the printed arctan.

    In still air the angle has no meaning; π/2 is returned, since like a cross wind in (12) it neither helps nor
    hinders.
    """
    if wind_e == 0.0 and wind_n == 0.0 and wind_u == 0.0:
        return 0.5 * math.pi
    ce = north * wind_u - up * wind_n
    cn = up * wind_e - east * wind_u
    cu = east * wind_n - north * wind_e
    dot = east * wind_e + north * wind_n + up * wind_u
    return math.atan2(math.sqrt(ce * ce + cn * cn + cu * cu), dot)


@compiled
def integrate_legs(
    performance: Performance, airspeeds: FloatArray,
    vectors: FloatArray, first: IntArray, weights: FloatArray, winds: FloatArray,
) -> FloatArray:  # fmt: skip
    """Integrals along n legs, shape (n, 4): time [s], ∫angle ds [rad m], mean wind along and across [m/s].

    `airspeeds` (n,) [m/s] of the legs, `vectors` (n, 3) from start to end [m]; leg i owns the samples first[i] ..
    first[i + 1] - 1, whose `weights` sum to 1 and whose `winds` (k, 3 or 4) [m/s] lie at the quadrature's points. A leg
    of no length takes no time. Across is positive from left to right. Time is infinite where the wind is too strong,
    not known (NaN), or beyond a limit: a fourth component is its share of what is allowed.
    """
    n = vectors.shape[0]
    result = np.zeros((n, 4))
    for i in range(n):
        de, dn, du = vectors[i, 0], vectors[i, 1], vectors[i, 2]
        length = math.sqrt(de * de + dn * dn + du * du)
        level = math.hypot(de, dn)
        east = de / level if level > 0.0 else 0.0
        north = dn / level if level > 0.0 else 0.0
        if length == 0.0:
            continue
        flown = flown_at(performance, airspeeds[i])
        for k in range(first[i], first[i + 1]):
            we, wn, wu, share = winds[k, 0], winds[k, 1], winds[k, 2], weights[k]
            if beyond_limit(winds, k):
                result[i, 0] = math.inf
            result[i, 0] += share * leg_seconds(flown, level, east, north, du, we, wn, wu)
            result[i, 1] += share * length * wind_angle(de, dn, du, we, wn, wu)
            result[i, 2] += share * (we * east + wn * north)
            result[i, 3] += share * (we * north - wn * east)
    return result


@compiled
def mean_angles(vectors: FloatArray, winds: FloatArray) -> FloatArray:
    """The mean angle [rad] between each direction (n, 3) and its share of the winds (n k, 3), shape (n,)."""
    n = vectors.shape[0]
    each = winds.shape[0] // max(n, 1)
    means = np.zeros(n)
    for i in range(n):
        for k in range(i * each, (i + 1) * each):
            means[i] += wind_angle(vectors[i, 0], vectors[i, 1], vectors[i, 2], winds[k, 0], winds[k, 1], winds[k, 2])
        means[i] /= max(each, 1)
    return means
