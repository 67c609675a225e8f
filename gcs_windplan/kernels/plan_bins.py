"""Plan bins find the few triangles that matter: squares over the plan.

They come as three arrays: `grid` (5,): west, south, side [m], columns, rows; `heads` and `members`: the
triangles of bin b are members[heads[b]:heads[b + 1]].
"""

from __future__ import annotations

import math

import numpy as np

from gcs_windplan.arrays import FloatArray, IntArray
from gcs_windplan.kernels.compiled import compiled


@compiled
def bin_of(grid: FloatArray, value: float, axis: int) -> int:
    """The bin of an east (axis 0) or north (axis 1) coordinate, the nearest there is; 0 for NaN."""
    position = (value - grid[axis]) / grid[2]
    return int(min(position, grid[3 + axis] - 1)) if position > 0.0 else 0


@compiled
def fill_bins(boxes: FloatArray, grid: FloatArray) -> tuple[IntArray, IntArray]:
    """Heads and members of plan bins for boxes (m, 4) of west, south, east, north."""
    columns, bins = int(grid[3]), int(grid[3]) * int(grid[4])
    heads = np.zeros(bins + 1, dtype=np.int64)
    members = np.empty(0, dtype=np.int64)
    for turn in range(2):  # first count, then fill from the back
        for m in range(boxes.shape[0] - 1, -1, -1):
            for j in range(bin_of(grid, boxes[m, 1], 1), bin_of(grid, boxes[m, 3], 1) + 1):
                for i in range(bin_of(grid, boxes[m, 0], 0), bin_of(grid, boxes[m, 2], 0) + 1):
                    if turn == 0:
                        heads[j * columns + i] += 1
                    else:
                        heads[j * columns + i] -= 1
                        members[heads[j * columns + i]] = m
        if turn == 0:
            for b in range(bins):
                heads[b + 1] += heads[b]
            members = np.empty(heads[bins], dtype=np.int64)
    return heads, members


@compiled
def bins_along(grid: FloatArray, leg: FloatArray, i: int) -> tuple[int, int]:
    """The first and the last row of bins that a leg touches in column i of the bins."""
    x, y, dx, dy = leg[0], leg[1], leg[3] - leg[0], leg[4] - leg[1]
    slack = 1e-6 * grid[2]
    west, t0, t1 = grid[0] + i * grid[2], 0.0, 1.0
    if dx != 0.0:
        near, far = (west - slack - x) / dx, (west + grid[2] + slack - x) / dx
        # the outermost columns also stand for all that lies beyond them
        if i == 0:
            near = -math.inf if dx > 0.0 else math.inf
        if i == int(grid[3]) - 1:
            far = math.inf if dx > 0.0 else -math.inf
        t0, t1 = max(0.0, min(near, far)), min(1.0, max(near, far))
        if t0 > t1:
            return 1, 0
    ya, yb = y + t0 * dy, y + t1 * dy
    return bin_of(grid, min(ya, yb) - slack, 1), bin_of(grid, max(ya, yb) + slack, 1)
