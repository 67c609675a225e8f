"""The paper's equations (5) to (8): points along a leg against triangles (m, 3, 3), by comparing areas."""

from __future__ import annotations

import math

import numpy as np

from gcs_windplan.arrays import BoolArray, FloatArray, IntArray
from gcs_windplan.kernels.compiled import compiled, piece
from gcs_windplan.kernels.plan_bins import bin_of


@compiled
def sampled_collisions(
    triangles: FloatArray,
    grid: FloatArray,
    heads: IntArray,
    members: IntArray,
    starts: FloatArray,
    ends: FloatArray,
    step: float,
    tolerance: float,
) -> BoolArray:
    """The paper's equations (5) to (8): is any point, `step` apart along a leg, in a triangle? Shape (n,)."""
    result = np.zeros(starts.shape[0], dtype=np.bool_)
    seen = np.full(triangles.shape[0], -1)
    low, high = np.empty(3), np.empty(3)
    for n in range(starts.shape[0]):
        for axis in range(3):
            low[axis] = min(starts[n, axis], ends[n, axis])
            high[axis] = max(starts[n, axis], ends[n, axis])
        for j in range(bin_of(grid, low[1], 1), bin_of(grid, high[1], 1) + 1):
            for i in range(bin_of(grid, low[0], 0), bin_of(grid, high[0], 0) + 1):
                here = j * int(grid[3]) + i
                for k in range(heads[here], heads[here + 1]):
                    m = members[k]
                    if seen[m] == n or result[n]:
                        continue
                    seen[m] = n
                    if _boxes_meet(triangles[m], low, high):
                        result[n] = _meets_sampled(triangles[m], starts[n], ends[n], step, tolerance)
    return result


@piece
def _boxes_meet(tri: FloatArray, low: FloatArray, high: FloatArray) -> bool:
    for axis in range(3):
        if max(tri[0, axis], tri[1, axis], tri[2, axis]) < low[axis]:
            return False
        if min(tri[0, axis], tri[1, axis], tri[2, axis]) > high[axis]:
            return False
    return True


@piece
def _area(px: float, py: float, pz: float, a: FloatArray, b: FloatArray) -> float:
    """The area of the triangle of a point and two corners [m²]."""
    ux, uy, uz, vx, vy, vz = a[0] - px, a[1] - py, a[2] - pz, b[0] - px, b[1] - py, b[2] - pz
    x, y, z = uy * vz - uz * vy, uz * vx - ux * vz, ux * vy - uy * vx
    return 0.5 * math.sqrt(x * x + y * y + z * z)


@piece
def _meets_sampled(tri: FloatArray, start: FloatArray, end: FloatArray, step: float, tolerance: float) -> bool:
    a, b, c = tri[0], tri[1], tri[2]
    dx, dy, dz = end[0] - start[0], end[1] - start[1], end[2] - start[2]
    area = _area(a[0], a[1], a[2], b, c)
    length = math.sqrt(dx * dx + dy * dy + dz * dz)
    for k in range(math.ceil(length / step) + 1):
        t = min(k * step / length, 1.0) if length > 0.0 else 0.0
        x, y, z = start[0] + t * dx, start[1] + t * dy, start[2] + t * dz
        parts = _area(x, y, z, a, b) + _area(x, y, z, a, c) + _area(x, y, z, b, c)
        if parts - area <= tolerance * area:
            return True
    return False
