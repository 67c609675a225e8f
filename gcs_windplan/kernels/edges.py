"""What an edge of the graph costs: in steady wind, in changing wind, and over the members of an ensemble.

Edges take the wind as linear between their two nodes. Where both ends can be flown, so can all between: the winds in
which a track is flyable are a convex set.

A fourth component of a wind is how strong it and its gusts are, as a share of what is allowed; beyond 1 nothing flies.

A search tells by what it hands over which world it is:

    winds (nodes, 3), times None                     steady
    winds (times, nodes, 3), each None               changing: linear in time between `times`
    winds (members, times, nodes, 3), each given     several members: the cost is a quantile over them
    grid None                                        the cost does not ask for power, and the airspeed is the vehicle's
    grid given                                       it is a price of energy, at the best of several airspeeds

Numba compiles only the branches that the winds' dimensions and the grid ask for.
"""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np

from gcs_windplan.arrays import FloatArray, IntArray
from gcs_windplan.kernels.compiled import compiled, inlined, piece
from gcs_windplan.kernels.power import leg_price
from gcs_windplan.kernels.triangle import PAPER, Performance, beyond_limit, flown_at, leg_seconds, wind_angle

_ROUNDS = (
    20  # of the iteration for an edge's time in changing wind, two or three as a rule: each gains L · ∂v/∂t / 2 v²
)
_SAME = 1e-6  # [s]

DISTANCE, ANGLE, HYBRID, TIME, ENERGY = 0.0, 1.0, 2.0, 3.0, 4.0


class Setting(NamedTuple):
    """What a search minimises, and where to."""

    code: float  # one of the five above
    goal_e: float  # [m], as are the next two
    goal_n: float
    goal_z: float
    angle_weight: float = 0.0  # hybrid (11)
    distance_weight: float = 0.0
    straight: float = 1.0  # from start to goal [m]
    ball_e: float = 0.0  # all winds lie in a ball about this one [m/s]
    ball_n: float = 0.0
    ball_radius: float = 0.0
    ball_up: float = 0.0  # the strongest up-draught and down-draught [m/s]
    ball_down: float = 0.0


@inlined
def cost_of(
    setting: Setting, seconds: float,
    level: float, east: float, north: float, climb: float,
    wind_e: float, wind_n: float, wind_u: float,
) -> float:  # fmt: skip
    """The cost of an edge that takes so many seconds and ends in a wind: the angle is that at the arrival, (10)."""
    code = setting.code
    if code == TIME or seconds == math.inf:
        return seconds
    if code == DISTANCE:
        return math.sqrt(level * level + climb * climb)
    angle: float = wind_angle(level * east, level * north, climb, wind_e, wind_n, wind_u)
    if code == ANGLE:
        return angle
    weight: float = setting.angle_weight
    return weight * angle / math.pi


@inlined
def edge_cost(
    performance: Performance, setting: Setting, grid: Any,
    level: float, east: float, north: float, climb: float, height: float,
    ae: float, an: float, au: float,
    be: float, bn: float, bu: float,
) -> float:  # fmt: skip
    """The cost of an edge in the search; infinite where it cannot be flown.

    The edge goes `level` [m] along the unit track (east, north) from a `height` and gains `climb` [m] in a wind from a
    to b [m/s]. Its time is the mean of the times in both winds (the trapezoidal rule), and so is its price in energy.
    """
    outset: float = leg_seconds(performance, level, east, north, climb, ae, an, au)
    if outset == math.inf:
        return outset
    arriving: float = leg_seconds(performance, level, east, north, climb, be, bn, bu)
    if grid is not None:
        price: float = 0.5 * (
            leg_price(grid, outset, level, east, north, climb, height, ae, an, au)
            + leg_price(grid, arriving, level, east, north, climb, height + climb, be, bn, bu)
        )
        return price
    seconds: float = 0.5 * (outset + arriving)
    cost: float = cost_of(setting, seconds, level, east, north, climb, be, bn, bu)
    return cost


@compiled
def edge_between(
    performance: Performance, setting: Setting, grid: Any,
    de: float, dn: float, dz: float, height: float,
    ae: float, an: float, au: float,
    be: float, bn: float, bu: float,
) -> float:  # fmt: skip
    """`edge_cost` of an edge given by its vector (de, dn, dz) [m]."""
    level = math.sqrt(de * de + dn * dn)
    if level == 0.0:
        if dz == 0.0:
            return 0.0
        return edge_cost(performance, setting, grid, 0.0, 0.0, 0.0, dz, height, ae, an, au, be, bn, bu)
    return edge_cost(performance, setting, grid, level, de / level, dn / level, dz, height, ae, an, au, be, bn, bu)


@inlined
def remaining(performance: Performance, setting: Setting, e: float, n: float, z: float) -> float:
    """The estimate from a place to the goal; for distance and time a consistent lower bound.

    Time: whatever the wind, it lies in a ball (centre c, radius r), so the vehicle is never faster than one with
    airspeed V + r in the constant wind c; times in a constant wind obey the triangle inequality. The paper's model
    does so only for c up to half of the airspeed (its indicatrix is dented beyond): then `search/` centres the ball
    on 0.
    """
    de, dn, dz = setting.goal_e - e, setting.goal_n - n, setting.goal_z - z
    level2 = de * de + dn * dn
    code = setting.code
    if code != TIME:
        distance = math.sqrt(level2 + dz * dz)
        if code == DISTANCE:
            return distance
        if code == HYBRID:
            share: float = setting.distance_weight * distance / max(distance, setting.straight)
            return share
        return 0.0
    vertical = 0.0
    if dz > 0.0:
        vertical = dz / (performance.climb + setting.ball_up)
    elif dz < 0.0:
        vertical = -dz / (performance.descent + setting.ball_down)
    if level2 == 0.0:
        return vertical
    level = math.sqrt(level2)
    airspeed = performance.airspeed + setting.ball_radius
    along = (setting.ball_e * de + setting.ball_n * dn) / level
    if performance.model == PAPER:
        speed = airspeed + along
    else:
        cross = (setting.ball_n * de - setting.ball_e * dn) / level
        rest = airspeed * airspeed - cross * cross
        if rest < 0.0:
            return math.inf
        speed = math.sqrt(rest) + along
    if speed <= 0.0:
        return math.inf
    seconds: float = max(vertical, level / speed)
    return seconds


@compiled
def remaining_at(performance: Performance, setting: Setting, points: FloatArray) -> FloatArray:
    """`remaining` at some points (n, 3), shape (n,)."""
    result = np.empty(points.shape[0])
    for i in range(points.shape[0]):
        result[i] = remaining(performance, setting, points[i, 0], points[i, 1], points[i, 2])
    return result


@inlined
def _moment(times: FloatArray, clock: float) -> tuple[int, int, float]:
    """The last time not after the clock, the next one, and the share of the way to it."""
    low, high = 0, times.size - 1
    if high == 0 or clock <= times[0]:
        return 0, 0, 0.0
    while high - low > 1:
        middle = (low + high) // 2
        if times[middle] <= clock:
            low = middle
        else:
            high = middle
    return low, low + 1, min((clock - times[low]) / (times[low + 1] - times[low]), 1.0)


@piece
def edge_in_time(
    performance: Performance, setting: Setting, grid: Any, times: FloatArray, tally: IntArray,
    from_winds: FloatArray, node: int, to_winds: FloatArray, to: int,
    level: float, east: float, north: float, climb: float, height: float, clock: float,
) -> tuple[float, float]:  # fmt: skip
    """Cost and seconds of an edge that begins at `clock` [s] in winds (times, nodes, 3), linear between `times`.

    The time is the mean of the times in the wind at the outset and in that at the end when it is reached: the
    trapezoidal rule for ds/dt = v(s, t), solved by iteration. Infinite where it cannot be flown, and beyond the last
    time. `tally` counts edges that lasted beyond, and those that could not be flown then but can be later.
    """
    k, k1, late = _moment(times, clock)
    ae = (1.0 - late) * from_winds[k, node, 0] + late * from_winds[k1, node, 0]
    an = (1.0 - late) * from_winds[k, node, 1] + late * from_winds[k1, node, 1]
    au = (1.0 - late) * from_winds[k, node, 2] + late * from_winds[k1, node, 2]
    limited = from_winds.shape[2] > 3
    outset: float = leg_seconds(performance, level, east, north, climb, ae, an, au)
    if limited and (1.0 - late) * from_winds[k, node, 3] + late * from_winds[k1, node, 3] > 1.0:
        outset = math.inf
    seconds, be, bn, bu = outset, ae, an, au
    for _ in range(_ROUNDS):
        if not seconds < math.inf:
            break
        if clock + seconds > times[times.size - 1] and times.size > 1:
            tally[0] += 1
            return math.inf, math.inf
        i, i1, share = _moment(times, clock + seconds)
        be = (1.0 - share) * to_winds[i, to, 0] + share * to_winds[i1, to, 0]
        bn = (1.0 - share) * to_winds[i, to, 1] + share * to_winds[i1, to, 1]
        bu = (1.0 - share) * to_winds[i, to, 2] + share * to_winds[i1, to, 2]
        if limited and (1.0 - share) * to_winds[i, to, 3] + share * to_winds[i1, to, 3] > 1.0:
            seconds = math.inf
            break
        before = seconds
        seconds = 0.5 * (outset + leg_seconds(performance, level, east, north, climb, be, bn, bu))
        if abs(seconds - before) < _SAME:
            break
    if seconds < math.inf:
        if grid is not None:
            arriving = 2.0 * seconds - outset  # what it takes in the wind at its end
            price: float = 0.5 * (
                leg_price(grid, outset, level, east, north, climb, height, ae, an, au)
                + leg_price(grid, arriving, level, east, north, climb, height + climb, be, bn, bu)
            )
            return price, seconds
        return cost_of(setting, seconds, level, east, north, climb, be, bn, bu), seconds
    for later in range(k1, times.size):
        we, wn, wu = from_winds[later, node, 0], from_winds[later, node, 1], from_winds[later, node, 2]
        allowed = not limited or from_winds[later, node, 3] <= 1.0
        if allowed and leg_seconds(performance, level, east, north, climb, we, wn, wu) < math.inf:
            tally[1] += 1
            break
    return math.inf, math.inf


@piece
def edge_of_members(
    performance: Performance, setting: Setting, grid: Any, times: FloatArray, tally: IntArray, rank: int,
    each: FloatArray, from_winds: FloatArray, node: int, to_winds: FloatArray, to: int,
    level: float, east: float, north: float, climb: float, height: float, clock: float,
) -> tuple[float, float]:  # fmt: skip
    """Cost and seconds of an edge in the member that `rank` others undercut, those that cannot fly it last.

    `each` (2, members) is scratch.
    """
    for member in range(each.shape[1]):
        cost, seconds = edge_in_time(
            performance, setting, grid, times, tally, from_winds[member], node, to_winds[member], to,
            level, east, north, climb, height, clock,
        )  # fmt: skip
        place = member
        while place > 0 and each[0, place - 1] > cost:  # few members: insertion sort
            each[0, place], each[1, place] = each[0, place - 1], each[1, place - 1]
            place -= 1
        each[0, place], each[1, place] = cost, seconds
    return each[0, rank], each[1, rank]


@inlined
def _travel_at(
    performance: Performance, setting: Setting, grid: Any, times: Any, tally: IntArray, rank: int,
    each: Any, from_winds: FloatArray, node: int, to_winds: FloatArray, to: int,
    level: float, east: float, north: float, climb: float, height: float, clock: float,
) -> tuple[float, float]:  # fmt: skip
    """`travel` at the airspeed of the performance."""
    if from_winds.ndim == 2:
        steady: float = edge_cost(
            performance, setting, grid, level, east, north, climb, height,
            from_winds[node, 0], from_winds[node, 1], from_winds[node, 2],
            to_winds[to, 0], to_winds[to, 1], to_winds[to, 2],
        )  # fmt: skip
        return steady, 0.0
    if from_winds.ndim == 3:
        cost, seconds = edge_in_time(
            performance, setting, grid, times, tally, from_winds, node, to_winds, to,
            level, east, north, climb, height, clock,
        )  # fmt: skip
        return cost, seconds
    cost, seconds = edge_of_members(
        performance, setting, grid, times, tally, rank, each, from_winds, node, to_winds, to,
        level, east, north, climb, height, clock,
    )  # fmt: skip
    return cost, seconds


@inlined
def travel(
    performance: Performance, setting: Setting, grid: Any, times: Any, tally: IntArray, rank: int,
    each: Any, from_winds: FloatArray, node: int, to_winds: FloatArray, to: int,
    level: float, east: float, north: float, climb: float, height: float, clock: float,
) -> tuple[float, float]:  # fmt: skip
    """Cost and seconds of an edge between two nodes in whichever world; no seconds are told in a steady one.

    The edge begins at a `height` above mean sea level [m]. In a steady world its ends have to be within the limits.
    """
    if grid is None:
        cost, seconds = _travel_at(
            performance, setting, grid, times, tally, rank, each, from_winds, node, to_winds, to,
            level, east, north, climb, height, clock,
        )  # fmt: skip
        return cost, seconds
    best, best_seconds = math.inf, math.inf
    for k in range(grid.airspeeds.size):
        cost, seconds = _travel_at(
            flown_at(performance, grid.airspeeds[k]), setting, grid, times, tally, rank, each, from_winds, node,
            to_winds, to, level, east, north, climb, height, clock,
        )  # fmt: skip
        if cost < best:
            best, best_seconds = cost, seconds
    return best, best_seconds


@piece
def travel_between(
    performance: Performance, setting: Setting, grid: Any, times: Any, tally: IntArray, rank: int,
    each: Any, from_winds: FloatArray, node: int, to_winds: FloatArray, to: int,
    de: float, dn: float, dz: float, height: float, clock: float,
) -> tuple[float, float]:  # fmt: skip
    """`travel` along an edge given by its vector (de, dn, dz) [m]; infinite where an end is beyond a limit."""
    if from_winds.ndim == 2 and (beyond_limit(from_winds, node) or beyond_limit(to_winds, to)):
        return math.inf, math.inf
    level = math.sqrt(de * de + dn * dn)
    if level == 0.0 and dz == 0.0:
        return 0.0, 0.0
    east, north = (de / level, dn / level) if level > 0.0 else (0.0, 0.0)
    cost, seconds = travel(
        performance, setting, grid, times, tally, rank, each, from_winds, node, to_winds, to,
        level, east, north, dz, height, clock,
    )  # fmt: skip
    return cost, seconds


@compiled
def joins(
    performance: Performance, setting: Setting, grid: Any, times: Any, tally: IntArray, rank: int,
    each: Any, site_winds: FloatArray, winds: FloatArray, nodes: IntArray, vectors: FloatArray,
    height: float, clock: float,
) -> FloatArray:  # fmt: skip
    """Cost and seconds (n, 2) of the edges from a site at a height [m] to some nodes, along vectors (n, 3) [m]."""
    result = np.empty((nodes.size, 2))
    for i in range(nodes.size):
        result[i, 0], result[i, 1] = travel_between(
            performance, setting, grid, times, tally, rank, each, site_winds, 0, winds, nodes[i],
            vectors[i, 0], vectors[i, 1], vectors[i, 2], height, clock,
        )  # fmt: skip
    return result
