"""Power out of a table, and what a leg takes of it.

Power models are Python (`vehicle/power*.py`); the search asks for millions of legs. So a model is tabulated once over
height, climb rate and airspeed, and here the table is read.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from gcs_windplan.arrays import FloatArray, IntArray
from gcs_windplan.kernels.compiled import compiled, inlined, piece
from gcs_windplan.kernels.triangle import Performance, beyond_limit, flown_at, leg_seconds

_ROUNDING = 1e-9  # of the table's steps, by which a value may lie beyond its ends


class PowerGrid(NamedTuple):
    """Power [W] (heights, climb rates, airspeeds), linear in between, and the airspeeds that a leg may choose from.

    Airspeeds count from 0. `cost_index` [W] is the value of a second: a leg's price is its energy and that of its time.
    """

    watts: FloatArray
    lowest_height: float  # [m] above mean sea level
    height_step: float
    lowest_climb: float  # [m/s] through the air
    climb_step: float
    airspeed_step: float
    airspeeds: FloatArray  # (k,) [m/s]
    cost_index: float = 0.0


@inlined
def _place(value: float, low: float, step: float, count: int) -> tuple[int, float]:
    """The knot below a value, and how far it is to the next; the first or the last interval beyond the ends."""
    steps = (value - low) / step
    knot = min(max(int(steps), 0), count - 2)
    return knot, min(max(steps - knot, 0.0), 1.0)


@compiled
def watts_at(grid: PowerGrid, airspeed: float, climb_rate: float, height: float) -> float:
    """The power [W] at an airspeed, climbing through the air [m/s] at a height [m]; infinite beyond the airspeeds.

    Heights and climb rates beyond the table count as its ends.
    """
    heights, climbs, speeds = grid.watts.shape
    if not airspeed <= grid.airspeed_step * (speeds - 1) * (1.0 + _ROUNDING):
        return math.inf
    i, up = _place(height, grid.lowest_height, grid.height_step, heights)
    j, rising = _place(climb_rate, grid.lowest_climb, grid.climb_step, climbs)
    k, faster = _place(airspeed, 0.0, grid.airspeed_step, speeds)
    total = 0.0
    for di in range(2):
        for dj in range(2):
            share = (up if di else 1.0 - up) * (rising if dj else 1.0 - rising)
            if share == 0.0:  # what is not asked for may be infinite
                continue
            if faster < 1.0:
                total += share * (1.0 - faster) * grid.watts[i + di, j + dj, k]
            if faster > 0.0:
                total += share * faster * grid.watts[i + di, j + dj, k + 1]
    return total


@piece
def leg_price(
    grid: PowerGrid, seconds: float,
    level: float, east: float, north: float, climb: float, height: float,
    wind_e: float, wind_n: float, wind_u: float,
) -> float:  # fmt: skip
    """What a leg that takes so many seconds in one wind costs [J]: the energy, and its time at the cost index.

    The leg goes `level` [m] along the unit track (east, north) and gains `climb` [m]. Its power is that of the airspeed
    it is really flown at: less than the commanded one where the climb rate holds it back, the wind itself where it
    goes straight up.
    """
    if not 0.0 < seconds < math.inf:
        return seconds
    along = wind_e * east + wind_n * north
    cross = wind_n * east - wind_e * north
    if level < 1e-6:
        airspeed = math.sqrt(wind_e * wind_e + wind_n * wind_n)
    else:
        forward = level / seconds - along
        airspeed = math.sqrt(forward * forward + cross * cross)
    return seconds * (watts_at(grid, airspeed, climb / seconds - wind_u, height) + grid.cost_index)


@compiled
def integrate_prices(
    performance: Performance, grid: PowerGrid, airspeeds: FloatArray,
    vectors: FloatArray, heights: FloatArray, first: IntArray, weights: FloatArray, shares: FloatArray,
    winds: FloatArray,
) -> FloatArray:  # fmt: skip
    """Price [J] and seconds (n, k, 2) of n legs at each of k airspeeds of its own (n, k) [m/s].

    `vectors` (n, 3) from start to end and `heights` (n,) of the starts above mean sea level [m]; leg i owns the samples
    first[i] .. first[i + 1] - 1, which lie at `shares` of the leg, have `weights` that sum to 1, and `winds`
    (m, 3), or (m, 4) as in `integrate_legs`.
    """
    n, choices = airspeeds.shape
    result = np.zeros((n, choices, 2))
    for i in range(n):
        de, dn, climb = vectors[i, 0], vectors[i, 1], vectors[i, 2]
        level = math.hypot(de, dn)
        if level == 0.0 and climb == 0.0:
            continue
        east = de / level if level > 0.0 else 0.0
        north = dn / level if level > 0.0 else 0.0
        for k in range(choices):
            flown = flown_at(performance, airspeeds[i, k])
            for m in range(first[i], first[i + 1]):
                we, wn, wu = winds[m, 0], winds[m, 1], winds[m, 2]
                seconds = leg_seconds(flown, level, east, north, climb, we, wn, wu)
                if beyond_limit(winds, m):
                    seconds = math.inf
                height = heights[i] + shares[m] * climb
                price = leg_price(grid, seconds, level, east, north, climb, height, we, wn, wu)
                result[i, k, 0] += weights[m] * price
                result[i, k, 1] += weights[m] * seconds
    return result
