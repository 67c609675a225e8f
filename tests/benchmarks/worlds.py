"""The worlds that all competitors get: a wavy wind over wavy ground on a square grid, and Matplotlib's real ground."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from gcs_windplan.geo.frame import LocalFrame
from gcs_windplan.planning.veil.grid import grid_steps
from gcs_windplan.terrain import SAMPLE_CENTRE, Dem, Extent, sample_dem
from gcs_windplan.vehicle import Vehicle

SPACING = 14.0  # [m]
VEHICLE = Vehicle(12.0, climb=5.0, descent=5.0)


@dataclass(frozen=True)
class Square:
    """A grid of n x n nodes without obstacles: heights (n²,) [m], winds (n², 3) [m/s] of (6, 2) give or take 2."""

    n: int
    heights: np.ndarray
    winds: np.ndarray

    @property
    def points(self) -> np.ndarray:
        row, column = np.divmod(np.arange(self.n**2), self.n)
        return np.column_stack([column * SPACING, row * SPACING, self.heights])

    def ends(self, way: str) -> tuple[int, int]:
        """Start and goal near two corners: with the wind (down), against it (up) or across it."""
        inset = self.n // 20
        first = inset * self.n + inset
        if way == "across":
            return inset * self.n + self.n - 1 - inset, (self.n - 1 - inset) * self.n + inset
        ends = first, self.n**2 - 1 - first
        return ends if way == "down" else ends[::-1]


def square(n: int) -> Square:
    """The world of n x n nodes; all sizes look alike."""
    row, column = np.divmod(np.arange(n**2), n)
    u, v = column / n, row / n
    winds = np.zeros((n**2, 3))
    winds[:, 0] = 6 + 2 * np.sin(9 * u + 1) * np.cos(7 * v)
    winds[:, 1] = 2 + 2 * np.cos(5 * u + 8 * v)
    heights = 50 * np.sin(column * SPACING / 3000) * np.cos(row * SPACING / 2000)
    return Square(n, heights, winds)


def explicit_edges(world: Square, neighbours: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """The same graph for peers that need it written out: from, to, seconds. The wind triangle stands here once more."""
    n, points, winds = world.n, world.points, world.winds
    grid = np.arange(n**2).reshape(n, n)
    sources, targets, seconds = [], [], []
    for _, north, east in grid_steps(neighbours, layered=False):
        a = grid[max(0, -north) : n - max(0, north), max(0, -east) : n - max(0, east)].ravel()
        b = a + north * n + east
        vector = points[b] - points[a]
        level = np.hypot(vector[:, 0], vector[:, 1])
        track = vector[:, :2] / level[:, None]
        both = []
        for air in (winds[a], winds[b]):
            along = (air[:, :2] * track).sum(axis=1)
            across = air[:, 1] * track[:, 0] - air[:, 0] * track[:, 1]
            ground = np.sqrt(VEHICLE.airspeed**2 - across**2) + along
            both.append(np.maximum(level / ground, np.abs(vector[:, 2]) / VEHICLE.climb))
        sources.append(a)
        targets.append(b)
        seconds.append((both[0] + both[1]) / 2)
    return np.concatenate(sources), np.concatenate(targets), np.concatenate(seconds)


def real_ground() -> Dem:
    """The middle of the Jacksboro fault (USGS), about 300 x 300 cells: 0.18 million triangles."""
    return sample_dem(LocalFrame(SAMPLE_CENTRE), Extent(-11_000.0, -13_750.0, 11_000.0, 13_750.0))


def legs_over(dem: Dem, count: int, length: float) -> tuple[np.ndarray, np.ndarray]:
    """Random level-ish legs (count, 3) inside of the ground's middle, from 40 m below to 100 m above it."""
    rng = np.random.default_rng(1)
    box = dem.extent
    middle = np.array([(box.west + box.east) / 2, (box.south + box.north) / 2])
    half = np.array([box.east - box.west, box.north - box.south]) / 2 * 0.9 - length
    track = rng.uniform(0, 2 * np.pi, count)
    starts = np.zeros((count, 3))
    starts[:, :2] = middle + rng.uniform(-1, 1, (count, 2)) * half
    ends = starts.copy()
    ends[:, :2] += length * np.column_stack([np.cos(track), np.sin(track)])
    starts[:, 2] = dem.heights_at(starts) + rng.uniform(-40, 100, count)
    ends[:, 2] = starts[:, 2] + rng.uniform(-0.2, 0.2, count) * length
    return starts, ends
