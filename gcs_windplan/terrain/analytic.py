"""Terrain from formulas: a plain, and hills on it. For tests, examples and the paper's cases."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from gcs_windplan.errors import TerrainError
from gcs_windplan.terrain.dem import Dem
from gcs_windplan.terrain.gridmap import GridMap
from gcs_windplan.terrain.surface import Extent

LARGEST = 20_000  # [samples] on a side


@dataclass(frozen=True, slots=True)
class Hill:
    """A Gaussian hill: its top at (east, north), `height` [m] over its surroundings (negative for a hollow).

    `radius` [m] is the standard deviation: at that distance the hill is 61 % as high as at its top.
    """

    east: float
    north: float
    height: float
    radius: float

    def __post_init__(self) -> None:
        if not self.radius > 0:
            raise TerrainError(f"a hill with a radius of {self.radius} m; it must be positive")


def hills(
    size: float | tuple[float, float],
    cell: float,
    hills: Sequence[Hill],
    altitude: float = 0.0,
    name: str = "hills",
    vertical_datum: str = "local",
) -> Dem:
    """Hills on flat ground, their heights added up, as a Dem in the local frame, the origin in its middle.

    `size` [m] is the side, or east-west and north-south sides; `cell` [m] the distance of samples, of which a
    whole number fits: the ground reaches up to half a cell farther or less far than asked. `altitude` [m] is
    the plain's. Raises TerrainError for sizes that are not positive or give more than 20 000 samples on a
    side.
    """
    width, height = (size, size) if isinstance(size, int | float) else size
    if not (cell > 0 and width >= cell and height >= cell and max(width, height) / cell < LARGEST):
        raise TerrainError(f"{name}: {width} x {height} m in cells of {cell} m make no grid")
    columns, rows = round(width / cell) + 1, round(height / cell) + 1
    west, north = -(columns - 1) * cell / 2, (rows - 1) * cell / 2
    x, y = west + np.arange(columns) * cell, north - np.arange(rows)[:, None] * cell
    heights = np.full((rows, columns), float(altitude))
    for hill in hills:
        heights += hill.height * np.exp(-((x - hill.east) ** 2 + (y - hill.north) ** 2) / (2 * hill.radius**2))
    return Dem.local(heights, west, north, cell, name, vertical_datum)


def flat(size: float | tuple[float, float], altitude: float = 0.0, vertical_datum: str = "local") -> Dem:
    """A plain around the origin: `size` [m] is the side, or east-west and north-south sides; height `altitude` [m].

    Raises TerrainError for a size that is not positive.
    """
    width, height = (size, size) if isinstance(size, int | float) else size
    if not (width > 0 and height > 0):
        raise TerrainError(f"plain: a size of {width} x {height} m; it must be positive")
    extent = Extent(-width / 2, -height / 2, width / 2, height / 2)
    return Dem(np.full((2, 2), float(altitude)), GridMap.affine(extent, (2, 2)), "plain", vertical_datum)
