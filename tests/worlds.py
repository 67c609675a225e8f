"""Small random worlds for tests: rough ground, changing wind."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache

import numpy as np

from gcs_windplan.scene import Clearance
from gcs_windplan.terrain import Dem, Extent
from gcs_windplan.wind.field import Steady


@cache
def waves(seed: int, strength: float, rising: float) -> list[tuple[int, float, np.ndarray, float]]:
    """Three waves along each axis: the axis, their size, their wave number and phase."""
    rng = np.random.default_rng(seed)
    sizes = ((0, strength), (1, strength), (2, rising))
    return [
        (axis, size, rng.uniform(-0.01, 0.01, 2), rng.uniform(0, 2 * np.pi)) for axis, size in sizes for _ in range(3)
    ]


@dataclass(frozen=True)
class WavyWind(Steady):
    """A smooth wind of random waves [m/s] over a few hundred metres."""

    seed: int
    strength: float = 5.0
    rising: float = 0.0
    name: str = "wavy"
    resolution: float = 25.0

    def at(self, points, seconds=0.0):
        rng = np.random.default_rng(self.seed)
        result = np.zeros((len(points), 3))
        for axis, size in ((0, self.strength), (1, self.strength), (2, self.rising)):
            for _ in range(3):
                wave, phase = rng.uniform(-0.01, 0.01, 2), rng.uniform(0, 2 * np.pi)
                result[:, axis] += size / 2 * np.sin(points[:, :2] @ wave + phase)
        return result


def rough_dem(seed: int, size: float = 1000.0, cell: float = 50.0, relief: float = 60.0) -> Dem:
    """Random heights around the origin, `relief` [m] from lowest to highest."""
    n = int(2 * size / cell) + 1
    heights = np.random.default_rng(seed).uniform(0, relief, (n, n))
    return Dem.local(heights, -size, size, cell)


def rules_over(dem: Dem, minimum: float = 20.0, maximum: float = np.inf) -> Clearance:
    return Clearance(dem, minimum, maximum)


def over_ground(dem: Dem, east: float, north: float, above: float) -> np.ndarray:
    """A point above the ground, (3,)."""
    return np.array([east, north, dem.heights_at(np.array([[east, north]]))[0] + above])


AREA = Extent(-900.0, -900.0, 900.0, 900.0)


@dataclass(frozen=True)
class ShiftingWind:
    """A wind that goes from one wavy field to the next, linear in time between `knots` [s since departure]."""

    seeds: tuple[int, ...] = (1, 2)
    knots: tuple[float, ...] = (-60.0, 400.0)
    strength: float = 5.0
    rising: float = 0.0
    name: str = "shifting"
    resolution: float = 25.0

    @property
    def times(self):
        return np.array(self.knots)

    def at(self, points, seconds=0.0):
        when = np.broadcast_to(np.asarray(seconds, dtype=float), len(points))
        assert (when >= self.knots[0]).all()
        assert (when <= self.knots[-1]).all(), "asked for wind beyond the forecast"
        fields = np.stack([WavyWind(seed, self.strength, self.rising).at(points) for seed in self.seeds])
        later = np.clip(np.searchsorted(self.knots, when, side="right"), 1, len(self.knots) - 1)
        knots = np.array(self.knots)
        share = (when - knots[later - 1]) / (knots[later] - knots[later - 1])
        rows = np.arange(len(points))
        return (1 - share)[:, None] * fields[later - 1, rows] + share[:, None] * fields[later, rows]
