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

import numpy as np

from gcs_windplan.arrays import FloatArray
from gcs_windplan.kernels.compiled import compiled, piece

_EDGE = 1e-6  # [cells] a place that far outside counts as on the edge: rounding, no more
_BOX = 1 + 1e-9


@piece
def _to_grid(
    heights: FloatArray, coefficients: FloatArray, scaling: FloatArray, x: float, y: float
) -> tuple[float, float]:
    """Column and row of a local place, NaN outside of the grid.

    Horner's scheme in both variables; the total degree is the size of the matrices less one.
    """
    u, v = (x - scaling[0]) / scaling[2], (y - scaling[1]) / scaling[3]
    if not (abs(u) <= _BOX and abs(v) <= _BOX):
        return math.nan, math.nan
    degree = coefficients.shape[1] - 1
    column, row = 0.0, 0.0
    for i in range(degree + 1):
        inner_column, inner_row = 0.0, 0.0
        for j in range(i + 1):
            inner_column = inner_column * v + coefficients[0, degree - i, i - j]
            inner_row = inner_row * v + coefficients[1, degree - i, i - j]
        column, row = column * u + inner_column, row * u + inner_row
    last_column, last_row = heights.shape[1] - 1.0, heights.shape[0] - 1.0
    if not (-_EDGE <= column <= last_column + _EDGE and -_EDGE <= row <= last_row + _EDGE):
        return math.nan, math.nan
    return min(max(column, 0.0), last_column), min(max(row, 0.0), last_row)


@piece
def _ground(heights: FloatArray, column: float, row: float) -> float:
    """The ground's height at a place inside of the grid."""
    last_row, last_column = heights.shape[0] - 1, heights.shape[1] - 1
    j = math.floor(column) if column < last_column else last_column - 1
    i = math.floor(row) if row < last_row else last_row - 1
    f, g = column - j, row - i
    corner, opposite = heights[i, j], heights[i + 1, j + 1]
    side = heights[i, j + 1] if f >= g else heights[i + 1, j]
    return float(corner + max(f, g) * (side - corner) + min(f, g) * (opposite - side))


@piece
def _extremes(
    heights: FloatArray, c0: float, r0: float, z0: float, c1: float, r1: float, z1: float
) -> tuple[float, float]:
    """The extreme heights over the ground of a leg that is straight in the grid; NaN over a gap.

    It may reach them at its ends and where it crosses a column, a row or a diagonal: lines from sample to sample, by
    `down` rows and `right` columns. All along such a line down * column - right * row is the same whole number k.
    """
    last_row, last_column = heights.shape[0] - 1, heights.shape[1] - 1
    first = z0 - _ground(heights, c0, r0)
    last = z1 - _ground(heights, c1, r1)
    low, high = min(first, last), max(first, last)
    gap = first + last  # carries any NaN to the end
    for line in range(1, 4):
        down, right = line & 1, line >> 1
        d0, d1 = down * c0 - right * r0, down * c1 - right * r1
        if d0 == d1:
            continue
        for k in range(math.ceil(min(d0, d1)), math.floor(max(d0, d1)) + 1):
            least, most = 0, last_column if right else last_row
            if down and right:  # both the column and the row, k less, stay on the grid
                least = k if k > 0 else 0
                most = last_row + k if last_row + k < last_column else last_column
                if most <= least:  # the grid's two far corners, seen as crossings of their row and column
                    continue
            t = (k - d0) / (d1 - d0)
            along = c0 + t * (c1 - c0) if right else r0 + t * (r1 - r0)
            along = min(max(along, float(least)), float(most))
            n = math.floor(along) if along < most else most - 1
            i, j = n * down - k * right, n * right + k * (1 - right)
            here = heights[i, j]
            over = z0 + t * (z1 - z0) - (here + (along - n) * (heights[i + down, j + right] - here))
            low, high, gap = min(low, over), max(high, over), gap + over
    if math.isnan(gap):
        return math.nan, math.nan
    return low, high


@compiled
def heights_at(heights: FloatArray, coefficients: FloatArray, scaling: FloatArray, places: FloatArray) -> FloatArray:
    """The ground's height [m] at local places (n, 2 or more); NaN outside of the grid and in gaps."""
    result = np.empty(places.shape[0])
    for n in range(places.shape[0]):
        column, row = _to_grid(heights, coefficients, scaling, places[n, 0], places[n, 1])
        result[n] = math.nan if math.isnan(column) else _ground(heights, column, row)
    return result


@compiled
def leg_heights(
    heights: FloatArray, coefficients: FloatArray, scaling: FloatArray, starts: FloatArray, ends: FloatArray
) -> FloatArray:
    """The smallest and the largest height over the ground of legs (n, 3) to (n, 3) [m], shape (n, 2).

    A leg longer than `scaling[4]` is cut into pieces of at most that length, each straight in the grid.
    """
    result = np.empty((starts.shape[0], 2))
    farthest = 3.0 * (scaling[2] + scaling[3])  # a longer leg ends outside of the box
    for n in range(starts.shape[0]):
        x, y, z = starts[n, 0], starts[n, 1], starts[n, 2]
        dx, dy, dz = ends[n, 0] - x, ends[n, 1] - y, ends[n, 2] - z
        length = math.sqrt(dx * dx + dy * dy)
        pieces = math.ceil(length / scaling[4]) if scaling[4] < length < farthest else 1
        low, high, gap = math.inf, -math.inf, dz
        c0, r0, z0 = 0.0, 0.0, z
        for k in range(pieces + 1):
            t = k / pieces
            c1, r1 = _to_grid(heights, coefficients, scaling, x + t * dx, y + t * dy)
            z1 = z + t * dz
            gap += c1
            if math.isnan(gap):
                break
            if k > 0:
                least, most = _extremes(heights, c0, r0, z0, c1, r1, z1)
                low, high, gap = min(low, least), max(high, most), gap + least
            c0, r0, z0 = c1, r1, z1
        if math.isnan(gap):
            low = high = math.nan
        result[n, 0], result[n, 1] = low, high
    return result
