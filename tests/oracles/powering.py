"""Naive twins of what a leg takes from the battery: one formula after the other, on a table read by SciPy."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
from scipy.interpolate import RegularGridInterpolator

from tests.oracles.flying import naive_slowness


def naive_table(grid):
    """The power [W] at (height, climb rate, airspeed) out of a `PowerGrid`, by SciPy."""
    heights, climbs, speeds = grid.watts.shape
    axes = (
        grid.lowest_height + grid.height_step * np.arange(heights),
        grid.lowest_climb + grid.climb_step * np.arange(climbs),
        grid.airspeed_step * np.arange(speeds),
    )
    table = RegularGridInterpolator(axes, grid.watts)

    def watts(height: float, climb_rate: float, airspeed: float) -> float:
        inside = [min(max(value, axis[0]), axis[-1]) for value, axis in zip((height, climb_rate), axes, strict=False)]
        return float(table((*inside, min(airspeed, axes[2][-1]))))

    return watts


def naive_price(vehicle, vector, height, wind, watts, cost_index=0.0) -> float:
    """Energy and worth of time [J] of a leg in one wind: the air sees the velocity over ground less the wind."""
    length = float(np.linalg.norm(vector))
    seconds = length * naive_slowness(vehicle, np.asarray(vector) / length, wind)
    if not math.isfinite(seconds):
        return math.inf
    through_air = np.asarray(vector) / seconds - np.asarray(wind)
    return seconds * (watts(height, float(through_air[2]), math.hypot(*through_air[:2])) + cost_index)


def naive_edge_price(vehicle, airspeeds, start, end, wind_a, wind_b, watts, cost_index=0.0) -> float:
    """The trapezoidal rule over both winds, at the best of the airspeeds."""
    vector = np.asarray(end) - np.asarray(start)
    prices = []
    for airspeed in airspeeds:
        flown = replace(vehicle, airspeed=float(airspeed))
        ends = ((start[2], wind_a), (end[2], wind_b))
        prices.append(sum(naive_price(flown, vector, height, wind, watts, cost_index) for height, wind in ends) / 2)
    return min(prices)
