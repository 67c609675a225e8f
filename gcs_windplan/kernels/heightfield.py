"""Places and legs over a triangulated grid of heights.

Every cell is cut along the diagonal from (row, column) to (row + 1, column + 1):

    (r, c) ──── (r, c+1)
       │ ╲  upper  │
       │   ╲       │
       │     ╲     │
       │ lower  ╲  │
    (r+1, c) ── (r+1, c+1)

Along a leg that is straight in the grid the ground is piecewise linear. It breaks where the leg crosses a
column, a row or a diagonal, so the leg's extreme heights over the ground lie at those crossings or at its
ends, and the order in which they are met does not matter.

A grid map comes as two arrays: `coefficients` (2, d+1, d+1), where [0, i, j] multiplies u^i v^j in the column
and [1, i, j] in the row; and `scaling` (5,): centre east, centre north, half width, half height of the box in
which the polynomial holds [m], and the greatest length of a leg that is as good as straight in the grid [m].
"""

from __future__ import annotations

import math

import numba
import numpy as np

from gcs_windplan.arrays import FloatArray

_EDGE = 1e-6  # [cells] a place that far outside counts as on the edge: rounding, no more
_BOX = 1 + 1e-9


@numba.njit(cache=True)
def _polynomial(coefficients: FloatArray, which: int, u: float, v: float) -> float:
    """Horner's scheme in both variables; the total degree is the size of the matrix less one."""
    size = coefficients.shape[1]
    value = 0.0
    for i in range(size - 1, -1, -1):
        inner = 0.0
        for j in range(size - 1 - i, -1, -1):
            inner = inner * v + coefficients[which, i, j]
        value = value * u + inner
    return value


@numba.njit(cache=True)
def _to_grid(
    heights: FloatArray, coefficients: FloatArray, scaling: FloatArray, x: float, y: float
) -> tuple[float, float]:
    """Column and row of a local place, NaN outside of the grid."""
    u = (x - scaling[0]) / scaling[2]
    v = (y - scaling[1]) / scaling[3]
    if not (abs(u) <= _BOX and abs(v) <= _BOX):
        return math.nan, math.nan
    last_row, last_column = heights.shape[0] - 1.0, heights.shape[1] - 1.0
    column = _polynomial(coefficients, 0, u, v)
    row = _polynomial(coefficients, 1, u, v)
    if not (-_EDGE <= column <= last_column + _EDGE and -_EDGE <= row <= last_row + _EDGE):
        return math.nan, math.nan
    return min(max(column, 0.0), last_column), min(max(row, 0.0), last_row)


@numba.njit(cache=True)
def _ground(heights: FloatArray, column: float, row: float) -> float:
    """The ground's height at a place inside of the grid."""
    j = min(int(column), heights.shape[1] - 2)
    i = min(int(row), heights.shape[0] - 2)
    f, g = column - j, row - i
    corner, opposite = heights[i, j], heights[i + 1, j + 1]
    side = heights[i, j + 1] if f >= g else heights[i + 1, j]
    if f >= g:
        return float(corner + f * (side - corner) + g * (opposite - side))
    return float(corner + g * (side - corner) + f * (opposite - side))


@numba.njit(cache=True)
def _extremes(
    heights: FloatArray, c0: float, r0: float, z0: float, c1: float, r1: float, z1: float
) -> tuple[float, float]:
    """The extreme heights over the ground of a leg that is straight in the grid; NaN over a gap."""
    rows, columns = heights.shape
    dc, dr, dz = c1 - c0, r1 - r0, z1 - z0
    first = z0 - _ground(heights, c0, r0)
    last = z1 - _ground(heights, c1, r1)
    low, high = min(first, last), max(first, last)
    gap = first + last  # carries any NaN to the end
    if dc != 0.0:
        for k in range(math.ceil(min(c0, c1)), math.floor(max(c0, c1)) + 1):
            t = (k - c0) / dc
            row = min(max(r0 + t * dr, 0.0), rows - 1.0)
            i = min(int(row), rows - 2)
            over = z0 + t * dz - (heights[i, k] + (row - i) * (heights[i + 1, k] - heights[i, k]))
            low, high, gap = min(low, over), max(high, over), gap + over
    if dr != 0.0:
        for k in range(math.ceil(min(r0, r1)), math.floor(max(r0, r1)) + 1):
            t = (k - r0) / dr
            column = min(max(c0 + t * dc, 0.0), columns - 1.0)
            j = min(int(column), columns - 2)
            over = z0 + t * dz - (heights[k, j] + (column - j) * (heights[k, j + 1] - heights[k, j]))
            low, high, gap = min(low, over), max(high, over), gap + over
    d0, d1 = c0 - r0, c1 - r1
    if d0 != d1:
        for k in range(math.ceil(min(d0, d1)), math.floor(max(d0, d1)) + 1):
            t = (k - d0) / (d1 - d0)
            # along this diagonal the column runs where both column and row = column - k stay on the grid
            least, most = max(0, k), min(columns - 1, rows - 1 + k)
            if most <= least:  # the grid's two far corners, seen as crossings of their row and column
                continue
            column = min(max(c0 + t * dc, float(least)), float(most))
            j = min(int(column), most - 1)
            here, there = heights[j - k, j], heights[j - k + 1, j + 1]
            over = z0 + t * dz - (here + (column - j) * (there - here))
            low, high, gap = min(low, over), max(high, over), gap + over
    if math.isnan(gap):
        return math.nan, math.nan
    return low, high


@numba.njit(cache=True)
def heights_at(heights: FloatArray, coefficients: FloatArray, scaling: FloatArray, places: FloatArray) -> FloatArray:
    """The ground's height [m] at local places (n, 2 or more); NaN outside of the grid and in gaps."""
    result = np.empty(places.shape[0])
    for n in range(places.shape[0]):
        column, row = _to_grid(heights, coefficients, scaling, places[n, 0], places[n, 1])
        result[n] = math.nan if math.isnan(column) else _ground(heights, column, row)
    return result


@numba.njit(cache=True)
def leg_heights(
    heights: FloatArray, coefficients: FloatArray, scaling: FloatArray, starts: FloatArray, ends: FloatArray
) -> FloatArray:
    """The smallest and the largest height over the ground of legs (n, 3) to (n, 3) [m], shape (n, 2).

    A leg longer than `scaling[4]` is cut into pieces of at most that length, each straight in the grid.
    """
    result = np.empty((starts.shape[0], 2))
    for n in range(starts.shape[0]):
        x, y, z = starts[n, 0], starts[n, 1], starts[n, 2]
        dx, dy, dz = ends[n, 0] - x, ends[n, 1] - y, ends[n, 2] - z
        result[n, 0] = result[n, 1] = math.nan
        c1, r1 = _to_grid(heights, coefficients, scaling, x + dx, y + dy)
        c0, r0 = _to_grid(heights, coefficients, scaling, x, y)
        if math.isnan(c0) or math.isnan(c1) or math.isnan(dz):
            continue
        length = math.sqrt(dx * dx + dy * dy)
        if length <= scaling[4]:
            result[n, 0], result[n, 1] = _extremes(heights, c0, r0, z, c1, r1, z + dz)
            continue
        pieces = math.ceil(length / scaling[4])
        low, high, gap = math.inf, -math.inf, 0.0
        for k in range(pieces):
            t0, t1 = k / pieces, (k + 1) / pieces
            c1, r1 = _to_grid(heights, coefficients, scaling, x + t1 * dx, y + t1 * dy)
            if math.isnan(c1):
                gap = math.nan
                break
            least, most = _extremes(heights, c0, r0, z + t0 * dz, c1, r1, z + t1 * dz)
            low, high, gap = min(low, least), max(high, most), gap + least
            c0, r0 = c1, r1
        if not math.isnan(gap):
            result[n, 0], result[n, 1] = low, high
    return result
