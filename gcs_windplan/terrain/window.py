"""Which part of a height grid covers an area."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from gcs_windplan.arrays import FloatArray
from gcs_windplan.errors import TerrainError
from gcs_windplan.geo.frame import LocalFrame
from gcs_windplan.terrain.gridmap import Georeference
from gcs_windplan.terrain.surface import Extent

MARGIN = 3  # [cells] read beyond the area, so that its rim has a whole triangle around it
COMPASS = ("north", "north-east", "east", "south-east", "south", "south-west", "west", "north-west")


@dataclass(frozen=True, slots=True)
class Window:
    """A block of a grid: its first row and column, and its size."""

    row: int
    column: int
    rows: int
    columns: int

    @property
    def slices(self) -> tuple[slice, slice]:
        """Rows and columns, to cut an array with."""
        return slice(self.row, self.row + self.rows), slice(self.column, self.column + self.columns)


def covering_window(grid: Georeference, frame: LocalFrame, area: Extent, shape: tuple[int, ...], name: str) -> Window:
    """The block of a grid of `shape` (rows, columns) that covers `area` and a few cells around it.

    Raises TerrainError that says how far away the grid lies if they do not overlap.
    """
    cells = grid.to_grid(*frame.to_geographic(_sample_points(area)))
    if not np.isfinite(cells).all():
        raise TerrainError(f"{name}: {_how_far(grid, frame, area, shape)}")
    first = np.maximum(np.floor(cells.min(axis=0)).astype(int) - MARGIN, 0)
    last = np.minimum(np.ceil(cells.max(axis=0)).astype(int) + MARGIN, np.array([shape[1], shape[0]]) - 1)
    outside = (cells.max(axis=0) < 0) | (cells.min(axis=0) > np.array([shape[1], shape[0]]) - 1)
    if outside.any() or (last - first < 1).any():
        raise TerrainError(f"{name}: {_how_far(grid, frame, area, shape)}")
    return Window(int(first[1]), int(first[0]), int(last[1] - first[1]) + 1, int(last[0] - first[0]) + 1)


def _sample_points(area: Extent) -> FloatArray:
    """A net of places over a box: what is extreme in one projection need not be a corner in another."""
    x, y = np.meshgrid(np.linspace(area.west, area.east, 21), np.linspace(area.south, area.north, 21))
    return np.stack([x.ravel(), y.ravel()], axis=-1)


def _how_far(grid: Georeference, frame: LocalFrame, area: Extent, shape: tuple[int, ...]) -> str:
    """Where the grid lies as seen from the middle of the area."""
    columns, rows = np.meshgrid(np.linspace(0, shape[1] - 1, 21), np.linspace(0, shape[0] - 1, 21))
    latitude, longitude = grid.to_geographic(np.stack([columns.ravel(), rows.ravel()], axis=-1))
    places = frame.to_local(latitude, longitude)
    middle = np.array([area.west + area.east, area.south + area.north]) / 2
    away = np.hypot(*(places - middle).T)
    nearest = places[int(np.argmin(away))] - middle
    bearing = math.degrees(math.atan2(nearest[0], nearest[1])) % 360
    return (
        f"covers latitude {latitude.min():.3f} to {latitude.max():.3f}, longitude {longitude.min():.3f} to "
        f"{longitude.max():.3f}, and so nothing of the area; seen from the area's middle it begins "
        f"{away.min() / 1000:.1f} km to the {COMPASS[round(bearing / 45) % 8]}"
    )
