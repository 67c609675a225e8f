"""Where on the globe a forecast's grid lies, and how far apart its nodes are."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from gcs_windplan.arrays import FloatArray
from gcs_windplan.wind.placement import METRES_PER_DEGREE
from gcs_windplan.wind.sheets import Grid


@dataclass(frozen=True, slots=True)
class Extent:
    """Ranges [deg]; `west` in [-180, 180), `east` not before it, so that it may exceed 180 across the date line.

    `round`: all longitudes are there, and west is only where the file begins.
    """

    south: float
    north: float
    west: float
    east: float
    round: bool


@dataclass(frozen=True, slots=True)
class Spacing:
    """Steps from row to row and from column to column in the middle of a grid; None where there is one alone.

    `degrees` where rows and columns are parallels and meridians, `metres` always.
    """

    degrees: tuple[float | None, float | None] | None
    metres: tuple[float | None, float | None]


def extent_of(grid: Grid) -> Extent:
    """The ranges of latitude and longitude that hold all nodes of a grid."""
    west, east, closed = _longitudes(grid.longitudes)
    return Extent(float(grid.latitudes.min()), float(grid.latitudes.max()), west, east, closed)


def spacing_of(grid: Grid) -> Spacing:
    """How far apart the nodes of a grid are."""
    if not grid.regular:
        return Spacing(None, _between_nodes(grid))
    south_north = _step(np.diff(grid.latitudes))
    west_east = _step(_turned(np.diff(grid.longitudes)))
    narrow = float(np.cos(np.radians(np.median(grid.latitudes)))) * METRES_PER_DEGREE
    metres = (
        None if south_north is None else south_north * METRES_PER_DEGREE,
        None if west_east is None else west_east * narrow,
    )
    return Spacing((south_north, west_east), metres)


def ways_between(latitudes: FloatArray, longitudes: FloatArray, latitude: float, longitude: float) -> FloatArray:
    """Great-circle distances [m] of places [deg] from one place."""
    phi, phi0 = np.radians(latitudes), np.radians(latitude)
    half = np.sin((phi - phi0) / 2) ** 2
    half = half + np.cos(phi) * np.cos(phi0) * np.sin(np.radians(longitudes - longitude) / 2) ** 2
    arcs: FloatArray = np.degrees(2 * np.arcsin(np.sqrt(np.clip(half, 0.0, 1.0)))) * METRES_PER_DEGREE
    return arcs


def _longitudes(longitudes: FloatArray) -> tuple[float, float, bool]:
    """West, east, and whether they go round: the widest gap on the circle is what they leave out."""
    there = np.unique(np.round(longitudes % 360.0, 6) % 360.0)
    gaps = np.diff(there, append=there[0] + 360.0)
    widest = int(np.argmax(gaps))
    if len(there) > 1 and gaps[widest] <= 1.5 * np.abs(_turned(np.diff(longitudes, axis=-1))).max(initial=0.0):
        ordered = np.sort(_turned(there))
        return float(ordered[0]), float(ordered[-1]), True
    west = float(_turned(there[(widest + 1) % len(there)]))
    return west, west + 360.0 - float(gaps[widest]), False


def _turned(degrees: FloatArray) -> FloatArray:
    """Angles in [-180, 180)."""
    turned: FloatArray = (degrees + 180.0) % 360.0 - 180.0
    return turned


def _step(steps: FloatArray) -> float | None:
    """The usual one, free of the rounding errors of single precision."""
    return float(f"{np.median(np.abs(steps)):.5g}") if len(steps) else None


def _between_nodes(grid: Grid) -> tuple[float | None, float | None]:
    """From row to row and from column to column in the middle of a grid of any kind [m]."""
    row, column = grid.shape[0] // 2, grid.shape[1] // 2
    here = grid.latitudes[row, column], grid.longitudes[row, column]
    steps = []
    for other, there in (((row - 1, column), row > 0), ((row, column - 1), column > 0)):
        steps.append(float(ways_between(grid.latitudes[other], grid.longitudes[other], *here)) if there else None)
    return steps[0], steps[1]
