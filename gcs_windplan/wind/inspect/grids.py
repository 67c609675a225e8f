"""Where on the globe a forecast's grid lies, and how far apart its nodes are."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from gcs_windplan.arrays import FloatArray
from gcs_windplan.wind.field_index import Grid
from gcs_windplan.wind.placement import METRES_PER_DEGREE

#: From row to row and from column to column; None where there is one alone.
Steps = tuple[float | None, float | None]


@dataclass(frozen=True, slots=True)
class GridSummary:
    """A grid: its name and size, where it lies [deg], and its steps in the middle.

    `west` in [-180, 180), `east` not before it, so that it may exceed 180 across the date line. `all_longitudes`: west
    is only where the file begins. `turned`: u and v follow rows and columns and are turned to true north when read.
    """

    name: str
    rows: int
    columns: int
    south: float
    north: float
    west: float
    east: float
    all_longitudes: bool
    spacing_metres: Steps
    turned: bool = False


def summary_of(grid: Grid, turned: bool = False) -> GridSummary:
    """What and where a grid is."""
    west, east, closed = _longitudes(grid.longitudes)
    south, north = float(grid.latitudes.min()), float(grid.latitudes.max())
    return GridSummary(grid.name, *grid.shape, south, north, west, east, closed, _spacing(grid), turned)


def unit_vectors(latitudes: FloatArray, longitudes: FloatArray) -> FloatArray:
    """Places [deg] on a sphere of radius 1, shape (..., 3)."""
    phi, lam = np.radians(latitudes), np.radians(longitudes)
    return np.stack([np.cos(phi) * np.cos(lam), np.cos(phi) * np.sin(lam), np.sin(phi) + 0.0 * lam], axis=-1)


def great_circle(chords: FloatArray) -> FloatArray:
    """Distances on the globe [m] of chords between unit vectors."""
    arcs: FloatArray = np.degrees(2 * np.arcsin(np.clip(chords / 2, 0.0, 1.0))) * METRES_PER_DEGREE
    return arcs


def _longitudes(longitudes: FloatArray) -> tuple[float, float, bool]:
    """West, east, and whether they go round: the widest gap on the circle is what they leave out."""
    there = np.unique(np.round(longitudes % 360.0, 6) % 360.0)
    gaps = np.diff(there, append=there[0] + 360.0)
    widest = int(np.argmax(gaps))
    if len(there) > 1 and gaps[widest] <= 1.5 * np.abs(wrapped(np.diff(longitudes, axis=-1))).max(initial=0.0):
        ordered = np.sort(wrapped(there))
        return float(ordered[0]), float(ordered[-1]), True
    west = float(wrapped(there[(widest + 1) % len(there)]))
    return west, west + 360.0 - float(gaps[widest]), False


def wrapped(degrees: FloatArray) -> FloatArray:
    """Angles in [-180, 180)."""
    angles: FloatArray = (degrees + 180.0) % 360.0 - 180.0
    return angles


def _spacing(grid: Grid) -> Steps:
    """The steps in the middle of a grid [m]."""
    row, column = grid.shape[0] // 2, grid.shape[1] // 2
    rows, columns = slice(max(row - 1, 0), row + 1), slice(max(column - 1, 0), column + 1)
    if grid.regular:
        nodes = unit_vectors(grid.latitudes[rows, np.newaxis], grid.longitudes[columns])
    else:
        nodes = unit_vectors(grid.latitudes[rows, columns], grid.longitudes[rows, columns])
    steps = [great_circle(np.linalg.norm(np.diff(nodes, axis=axis), axis=-1)).ravel() for axis in (0, 1)]
    along_rows, along_columns = (float(step[-1]) if len(step) else None for step in steps)
    return along_rows, along_columns
