"""Speed over ground in wind, and the time that a leg takes.

A vehicle reaches its kernels as an array `performance` of 5 floats, made by `performance_of` in `cost/`:
speed model (0 wind triangle, 1 the paper's (12)), airspeed, climb, descent [m/s], hovers (1 or 0).
"""

from __future__ import annotations

import math

import numba
import numpy as np

from gcs_windplan.arrays import FloatArray, IntArray

TRIANGLE, PAPER = 0, 1


@numba.njit(cache=True)
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


@numba.njit(cache=True)
def slowness(
    performance: FloatArray, east: float, north: float, up: float, wind_e: float, wind_n: float, wind_u: float
) -> float:
    """Seconds per metre along a unit direction (east, north, up); infinite where it cannot be flown.

    The slower of two: the horizontal part at the ground speed, the vertical part at the climb or descent rate in air
    that itself rises or sinks. A vehicle that hovers slows down for a steep leg, as far as a tail wind lets it.
    """
    model, airspeed, climb, descent, hovers = performance
    if wind_u < -climb or wind_u > descent:  # it cannot even hold its height
        return math.inf
    vertical = 0.0
    if up > 0.0:
        rate = climb + wind_u
        if rate <= 0.0:
            return math.inf
        vertical = up / rate
    elif up < 0.0:
        rate = descent - wind_u
        if rate <= 0.0:
            return math.inf
        vertical = -up / rate
    level = math.hypot(east, north)
    if level < 1e-9:
        calm_enough = wind_e * wind_e + wind_n * wind_n <= airspeed * airspeed
        return vertical if hovers > 0.0 and calm_enough else math.inf
    along = (wind_e * east + wind_n * north) / level
    cross = (wind_n * east - wind_e * north) / level
    speed = ground_speed(model, airspeed, along, cross)
    if speed <= 0.0:
        return math.inf
    horizontal = level / speed
    if vertical <= horizontal:
        return horizontal
    if hovers == 0.0:
        return math.inf
    if model == TRIANGLE and along - math.sqrt(airspeed * airspeed - cross * cross) > level / vertical:
        return math.inf  # the tail wind pushes it faster than it can climb
    return vertical


@numba.njit(cache=True)
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


@numba.njit(cache=True)
def integrate_legs(
    performance: FloatArray, vectors: FloatArray, first: IntArray, weights: FloatArray, winds: FloatArray
) -> FloatArray:
    """Integrals along n legs, shape (n, 4): time [s], ∫angle ds [rad m], mean wind along and across [m/s].

    `vectors` (n, 3) from start to end [m]; leg i owns the samples first[i] .. first[i + 1] - 1, whose `weights` sum
    to 1 and whose `winds` (k, 3) [m/s] lie at the quadrature's points. A leg of no length takes no time. Across is
    positive from left to right. Time is infinite where the wind is too strong, or not known (NaN).
    """
    n = vectors.shape[0]
    result = np.zeros((n, 4))
    for i in range(n):
        de, dn, du = vectors[i, 0], vectors[i, 1], vectors[i, 2]
        length = math.sqrt(de * de + dn * dn + du * du)
        if length == 0.0:
            continue
        e, u_n, u = de / length, dn / length, du / length
        level = math.hypot(e, u_n)
        for k in range(first[i], first[i + 1]):
            we, wn, wu = winds[k, 0], winds[k, 1], winds[k, 2]
            if math.isnan(we):
                result[i, 0] = math.inf
                break
            share = weights[k]
            result[i, 0] += share * length * slowness(performance, e, u_n, u, we, wn, wu)
            result[i, 1] += share * length * wind_angle(e, u_n, u, we, wn, wu)
            if level > 1e-9:
                result[i, 2] += share * (we * e + wn * u_n) / level
                result[i, 3] += share * (we * u_n - wn * e) / level
    return result


@numba.njit(cache=True)
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
