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

    def watts(height, climb_rate, airspeed):
        inside = [np.clip(value, axis[0], axis[-1]) for value, axis in zip((height, climb_rate), axes, strict=False)]
        return table(np.stack(np.broadcast_arrays(*inside, np.minimum(airspeed, axes[2][-1])), axis=-1))

    return watts


def naive_flight(vehicle, vector, wind) -> tuple[float, float, float]:
    """Seconds, climb rate and airspeed of a leg in one wind: the air sees the velocity over ground less the wind."""
    length = float(np.linalg.norm(vector))
    seconds = length * naive_slowness(vehicle, np.asarray(vector) / length, wind)
    if not math.isfinite(seconds):
        return math.inf, 0.0, 0.0
    through_air = np.asarray(vector) / seconds - np.asarray(wind)
    return seconds, float(through_air[2]), math.hypot(*through_air[:2])


def naive_edge_prices(vehicle, airspeeds, starts, ends, winds_a, winds_b, watts, cost_index=0.0) -> np.ndarray:
    """The trapezoidal rule over the winds at both ends of edges (n,), each at the best of the airspeeds."""
    prices = []
    for airspeed in airspeeds:
        flown = replace(vehicle, airspeed=float(airspeed))
        at_both = []
        for places, winds in ((starts, winds_a), (ends, winds_b)):
            flights = [naive_flight(flown, b - a, wind) for a, b, wind in zip(starts, ends, winds, strict=True)]
            seconds, *air = np.array(flights).T
            at_both.append(seconds * (watts(places[:, 2], *air) + cost_index))
        prices.append(np.mean(at_both, axis=0))
    return np.min(prices, axis=0)
