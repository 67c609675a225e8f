"""Small random worlds for tests: rough ground, changing wind."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from gcs_windplan.terrain import Dem, Extent
from gcs_windplan.veil import Clearance


@dataclass(frozen=True)
class WavyWind:
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
