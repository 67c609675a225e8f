"""Legs against prisms: polygons in plan with a floor and a ceiling, exact."""

from __future__ import annotations

import numpy as np

from gcs_windplan.arrays import BoolArray, FloatArray
from gcs_windplan.kernels.compiled import compiled, piece


@compiled
def inside(corners: FloatArray, x: float, y: float) -> bool:
    """Whether a place lies in a polygon (k, 2), by the even-odd rule."""
    odd = False
    j = corners.shape[0] - 1
    for i in range(corners.shape[0]):
        xi, yi, xj, yj = corners[i, 0], corners[i, 1], corners[j, 0], corners[j, 1]
        if (yi > y) != (yj > y) and x < (xj - xi) * (y - yi) / (yj - yi) + xi:
            odd = not odd
        j = i
    return odd


@piece
def _crossings(corners: FloatArray, ax: float, ay: float, bx: float, by: float, cuts: FloatArray) -> int:
    """Where a leg crosses the polygon's border, as fractions of the leg between 0 and 1, sorted into `cuts`."""
    count = 0
    dx, dy = bx - ax, by - ay
    j = corners.shape[0] - 1
    for i in range(corners.shape[0]):
        ex, ey = corners[i, 0] - corners[j, 0], corners[i, 1] - corners[j, 1]
        px, py = corners[j, 0] - ax, corners[j, 1] - ay
        det = dx * ey - dy * ex
        if det != 0.0:
            along = (px * ey - py * ex) / det
            across = (px * dy - py * dx) / det
            if 0.0 < along < 1.0 and -1e-12 <= across <= 1.0 + 1e-12:
                cuts[count] = along
                count += 1
        j = i
    for i in range(1, count):  # few cuts: insertion sort
        value = cuts[i]
        k = i
        while k > 0 and cuts[k - 1] > value:
            cuts[k] = cuts[k - 1]
            k -= 1
        cuts[k] = value
    return count


@piece
def _beyond_box(box: FloatArray, ax: float, ay: float, bx: float, by: float) -> bool:
    """Whether a leg's box misses the polygon's box (west, south, east, north)."""
    west, south, east, north = box
    return bool(max(ax, bx) < west or min(ax, bx) > east or max(ay, by) < south or min(ay, by) > north)


@compiled
def legs_through(corners: FloatArray, floor: float, ceiling: float, starts: FloatArray, ends: FloatArray) -> BoolArray:
    """Which legs (n, 3) have a part inside the prism: in plan inside the polygon and between floor and ceiling [m]."""
    n = starts.shape[0]
    hit = np.zeros(n, dtype=np.bool_)
    cuts = np.empty(corners.shape[0] + 2)
    box = np.array([corners[:, 0].min(), corners[:, 1].min(), corners[:, 0].max(), corners[:, 1].max()])
    for i in range(n):
        ax, ay, az = starts[i, 0], starts[i, 1], starts[i, 2]
        bx, by, bz = ends[i, 0], ends[i, 1], ends[i, 2]
        if _beyond_box(box, ax, ay, bx, by):
            continue
        count = _crossings(corners, ax, ay, bx, by, cuts)
        before = 0.0
        for k in range(count + 1):
            after = cuts[k] if k < count else 1.0
            middle = 0.5 * (before + after)
            if inside(corners, ax + middle * (bx - ax), ay + middle * (by - ay)):
                low, high = az + before * (bz - az), az + after * (bz - az)
                if low > high:
                    low, high = high, low
                if high >= floor and low <= ceiling:
                    hit[i] = True
                    break
            before = after
    return hit


@compiled
def legs_leaving(corners: FloatArray, floor: float, ceiling: float, starts: FloatArray, ends: FloatArray) -> BoolArray:
    """Which legs (n, 3) have a part outside of the prism."""
    n = starts.shape[0]
    out = np.zeros(n, dtype=np.bool_)
    cuts = np.empty(corners.shape[0] + 2)
    for i in range(n):
        ax, ay, az = starts[i, 0], starts[i, 1], starts[i, 2]
        bx, by, bz = ends[i, 0], ends[i, 1], ends[i, 2]
        if not (floor <= min(az, bz) and max(az, bz) <= ceiling):
            out[i] = True
            continue
        count = _crossings(corners, ax, ay, bx, by, cuts)
        before = 0.0
        for k in range(count + 1):
            after = cuts[k] if k < count else 1.0
            middle = 0.5 * (before + after)
            counts = after - before > 1e-12 or count == 0
            if counts and not inside(corners, ax + middle * (bx - ax), ay + middle * (by - ay)):
                out[i] = True
                break
            before = after
    return out
