"""Naive twins of judging: the wind triangle by its definition, energy by tiny steps, clearance by dense samples."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np

from gcs_windplan.arrays import FloatArray
from gcs_windplan.terrain import Dem
from tests.oracles.terrain import grid_height

Wind = Callable[[FloatArray, float], FloatArray]


def grid_heights(dem: Dem, places: FloatArray) -> FloatArray:
    """The ground by hand, of a DEM that was made by `Dem.local`."""
    edge = dem.extent
    rows, columns = dem.heights.shape
    cell = (edge.east - edge.west) / (columns - 1)
    assert math.isclose((edge.north - edge.south) / (rows - 1), cell)
    return np.array([grid_height(dem.heights, (x - edge.west) / cell, (edge.north - y) / cell) for x, y, *_ in places])


def sampled_heights(dem: Dem, start: FloatArray, end: FloatArray, count: int = 4001) -> tuple[float, float]:
    """The smallest and the largest height of a leg above ground at many places: never beyond the exact ones."""
    places = start + np.linspace(0, 1, count)[:, None] * (end - start)
    above = places[:, 2] - grid_heights(dem, places)
    return float(above.min()), float(above.max())


def airspeed_for(ground_speed: float, track_deg: float, wind: FloatArray) -> float:
    """The airspeed that a ground velocity takes: the length of what the air must add to the wind."""
    angle = math.radians(track_deg)
    east, north = ground_speed * math.sin(angle), ground_speed * math.cos(angle)
    return math.hypot(east - wind[0], north - wind[1])


def ground_speed_at(airspeed: float, track_deg: float, wind: FloatArray) -> float:
    """The ground speed along a track at an airspeed, by bisection over the definition; 0 where there is none."""
    low, high = 0.0, airspeed + math.hypot(wind[0], wind[1]) + 1.0
    if min(airspeed_for(v, track_deg, wind) for v in np.linspace(low, high, 2001)) > airspeed:
        return 0.0
    best = max(v for v in np.linspace(low, high, 2001) if airspeed_for(v, track_deg, wind) <= airspeed)
    high = best + (high - low) / 2000
    low = best
    for _ in range(60):
        middle = (low + high) / 2
        low, high = (middle, high) if airspeed_for(middle, track_deg, wind) <= airspeed else (low, middle)
    return low


def energy_of(
    start: FloatArray, end: FloatArray, seconds: float, begin: float, wind: Wind, watts: Callable[..., float],
    steps: int = 2000,
) -> float:  # fmt: skip
    """What a leg flown at a constant ground velocity takes, step by step [J]; `watts` of airspeed, climb and height."""
    velocity, total = (end - start) / seconds, 0.0
    for k in range(steps):
        share = (k + 0.5) / steps
        place = start + share * (end - start)
        blows = wind(place, begin + share * seconds)
        airspeed = math.hypot(velocity[0] - blows[0], velocity[1] - blows[1])
        total += watts(airspeed, velocity[2] - blows[2], place[2]) * seconds / steps
    return total
