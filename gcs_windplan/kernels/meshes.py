"""Places and legs over a surface of triangles (m, 3, 3), found through their plan bins.

Over a surface a leg becomes spans, rows of (t0, t1, h0, h1): between t0 and t1 of its way it lies over one
triangle, h0 and h1 above it. The ground is the highest surface, so the height above ground is the least of
the spans.
"""

from __future__ import annotations

import math

import numpy as np

from gcs_windplan.arrays import FloatArray, IntArray
from gcs_windplan.kernels.compiled import compiled, piece
from gcs_windplan.kernels.plan_bins import bin_of, bins_along

_RIM = 1e-9  # [m] a place that far outside of a triangle is still over it: seams have no cracks
_HOLE = 1e-6  # [m] a stretch over no triangle that is longer is unknown ground
_FLAT = 1e-10  # plan area over squared longest side, below which a triangle is a wall


@compiled
def height_of(tri: FloatArray, x: float, y: float) -> float:
    """The height of a triangle that is no wall at a place over it."""
    a, b, c = tri[0], tri[1], tri[2]
    ux, uy, vx, vy, px, py = b[0] - a[0], b[1] - a[1], c[0] - a[0], c[1] - a[1], x - a[0], y - a[1]
    area = ux * vy - uy * vx
    f, g = (px * vy - py * vx) / area, (ux * py - uy * px) / area
    z = a[2] + f * (b[2] - a[2]) + g * (c[2] - a[2])
    height: float = min(max(z, min(a[2], b[2], c[2])), max(a[2], b[2], c[2]))
    return height


@compiled
def turn_of(tri: FloatArray) -> float:
    """+1 for a triangle that is counter-clockwise in plan, -1 for clockwise, 0 for a wall."""
    a, b, c = tri[0], tri[1], tri[2]
    ux, uy, vx, vy = b[0] - a[0], b[1] - a[1], c[0] - a[0], c[1] - a[1]
    area = ux * vy - uy * vx
    longest = max(ux * ux + uy * uy, vx * vx + vy * vy, (vx - ux) ** 2 + (vy - uy) ** 2)
    if abs(area) <= _FLAT * longest:
        return 0.0
    return 1.0 if area > 0.0 else -1.0


@piece
def _outside(tri: FloatArray, k: int, turn: float, x: float, y: float) -> float:
    """How far a place lies outside of the k-th side in plan [m], negative inside."""
    ax, ay = tri[k, 0], tri[k, 1]
    ex, ey = tri[(k + 1) % 3, 0] - ax, tri[(k + 1) % 3, 1] - ay
    away: float = -turn * (ex * (y - ay) - ey * (x - ax)) / math.sqrt(ex * ex + ey * ey)
    return away


@compiled
def lies_over(tri: FloatArray, turn: float, x: float, y: float) -> bool:
    """Does a place lie over a triangle that is no wall, or on its rim?"""
    first, second = _outside(tri, 0, turn, x, y), _outside(tri, 1, turn, x, y)
    return first <= _RIM and second <= _RIM and _outside(tri, 2, turn, x, y) <= _RIM


@piece
def _top(triangles: FloatArray, grid: FloatArray, heads: IntArray, members: IntArray, x: float, y: float) -> float:
    """The highest surface at a place, NaN where there is none."""
    top = -math.inf
    here = bin_of(grid, y, 1) * int(grid[3]) + bin_of(grid, x, 0)
    for k in range(heads[here], heads[here + 1]):
        tri = triangles[members[k]]
        turn = turn_of(tri)
        if turn != 0.0 and lies_over(tri, turn, x, y):
            top = max(top, height_of(tri, x, y))
    return top if top > -math.inf else math.nan


@compiled
def surface_heights(
    triangles: FloatArray, grid: FloatArray, heads: IntArray, members: IntArray, places: FloatArray
) -> FloatArray:
    """The height of the highest surface at places (n, 2 or more) [m]; NaN where there is none."""
    result = np.empty(places.shape[0])
    for n in range(places.shape[0]):
        result[n] = _top(triangles, grid, heads, members, places[n, 0], places[n, 1])
    return result


@piece
def _span(tri: FloatArray, turn: float, leg: FloatArray, span: FloatArray) -> bool:
    """Fill in the span of a leg (6,) over a triangle that is no wall; False if they do not meet in plan."""
    t0, t1 = 0.0, 1.0
    for k in range(3):
        first = _outside(tri, k, turn, leg[0], leg[1]) - _RIM
        last = _outside(tri, k, turn, leg[3], leg[4]) - _RIM
        if first > 0.0 and last > 0.0:
            return False
        if first > 0.0:
            t0 = max(t0, first / (first - last))
        elif last > 0.0:
            t1 = min(t1, first / (first - last))
    if t0 > t1:
        return False
    for k, t in enumerate((t0, t1)):
        x, y, z = (
            leg[0] + t * (leg[3] - leg[0]),
            leg[1] + t * (leg[4] - leg[1]),
            leg[2] + t * (leg[5] - leg[2]),
        )
        span[k], span[2 + k] = t, z - height_of(tri, x, y)
    return True


@piece
def _wall_span(tri: FloatArray, k: int, leg: FloatArray, span: FloatArray) -> bool:
    """Fill in the span of a leg over the k-th side of a wall: a point, or a stretch along it."""
    dx, dy = leg[3] - leg[0], leg[4] - leg[1]
    ax, ay, az = tri[k, 0] - leg[0], tri[k, 1] - leg[1], tri[k, 2]
    j = (k + 1) % 3
    ex, ey, ez = tri[j, 0] - tri[k, 0], tri[j, 1] - tri[k, 1], tri[j, 2] - az
    side, length2 = math.sqrt(ex * ex + ey * ey), dx * dx + dy * dy
    across = dx * ey - dy * ex
    if abs(across) > 1e-9 * side * math.sqrt(length2):
        t, s = (ax * ey - ay * ex) / across, (ax * dy - ay * dx) / across
        if not (-1e-12 <= t <= 1 + 1e-12 and -_RIM <= s * side <= side + _RIM):
            return False
        t = min(max(t, 0.0), 1.0)
        span[0] = span[1] = t
        span[2] = span[3] = leg[2] + t * (leg[5] - leg[2]) - (az + min(max(s, 0.0), 1.0) * ez)
        return True
    if abs(ax * dy - ay * dx) > _RIM * math.sqrt(length2):
        return False
    ta, tb = (ax * dx + ay * dy) / length2, ((ax + ex) * dx + (ay + ey) * dy) / length2
    za, zb = az, az + ez
    if ta > tb:
        ta, tb, za, zb = tb, ta, zb, za
    if ta > 1.0 or tb < 0.0:
        return False
    for i, t in enumerate((max(ta, 0.0), min(tb, 1.0))):
        f = (t - ta) / (tb - ta) if tb > ta else 0.0
        span[i], span[2 + i] = t, leg[2] + t * (leg[5] - leg[2]) - (za + f * (zb - za))
    if tb <= ta:
        span[2] = span[3] = min(span[2], leg[2] + ta * (leg[5] - leg[2]) - max(za, zb))
    return True


@piece
def _least(spans: FloatArray, first: int, last: int, middle: float, t: float) -> tuple[float, float]:
    """The least height at t among the spans that reach over `middle`, and how fast it grows there."""
    low, slope = math.inf, 0.0
    for k in range(first, last):
        t0, t1 = spans[k, 0], spans[k, 1]
        if t0 <= middle <= t1 and t1 > t0:
            rate = (spans[k, 3] - spans[k, 2]) / (t1 - t0)
            height = spans[k, 2] + rate * (t - t0)
            if height < low:
                low, slope = height, rate
    return low, slope


@piece
def _peak(spans: FloatArray, first: int, last: int, a: float, b: float) -> float:
    """The largest of the least heights between a and b, where no span begins or ends.

    The least of straight lines is concave. Two lines enclose its peak, one rising and one falling; the line
    that lies below their crossing takes the place of one of them, until there is none.
    """
    middle = 0.5 * (a + b)
    left, rise = _least(spans, first, last, middle, a)
    right, fall = _least(spans, first, last, middle, b)
    if not (rise > 0.0 > fall):
        return max(left, right)
    ta, tb = a, b
    for _ in range(last - first):
        t = (right - fall * tb - left + rise * ta) / (rise - fall)
        height, slope = _least(spans, first, last, middle, t)
        if height >= left + rise * (t - ta) - 1e-9 or slope == 0.0:
            return height
        if slope > 0.0:
            left, rise, ta = height, slope, t
        else:
            right, fall, tb = height, slope, t
    return left + rise * (t - ta)


@piece
def _sort(spans: FloatArray, count: int) -> FloatArray:
    """Put spans in order of where they begin; all their ends (2 count,), in order. Both are nearly sorted."""
    for k in range(1, count):
        t0, t1, h0, h1 = spans[k, 0], spans[k, 1], spans[k, 2], spans[k, 3]
        j = k
        while j > 0 and spans[j - 1, 0] > t0:
            for i in range(4):
                spans[j, i] = spans[j - 1, i]
            j -= 1
        spans[j, 0], spans[j, 1], spans[j, 2], spans[j, 3] = t0, t1, h0, h1
    cuts = np.empty(2 * count)
    for k in range(2 * count):
        t = spans[k // 2, k % 2]
        j = k
        while j > 0 and cuts[j - 1] > t:
            cuts[j] = cuts[j - 1]
            j -= 1
        cuts[j] = t
    return cuts


@piece
def _sweep(spans: FloatArray, count: int, length: float) -> tuple[float, float]:
    """The extreme heights of a leg over the highest surface, NaN if there are holes on the way."""
    cuts = _sort(spans, count)
    low, reach, hole = math.inf, 0.0, 0.0
    for k in range(count):
        hole = max(hole, spans[k, 0] - reach)
        reach = max(reach, spans[k, 1])
        low = min(low, min(spans[k, 2], spans[k, 3]))
    if max(hole, 1.0 - reach) * length > _HOLE:
        return math.nan, math.nan
    high, first, last = low, 0, 0
    for c in range(2 * count - 1):
        if cuts[c + 1] - cuts[c] < 1e-12:
            continue
        while first < count and spans[first, 1] <= cuts[c]:
            first += 1
        while last < count and spans[last, 0] <= cuts[c]:
            last += 1
        peak = _peak(spans, first, last, cuts[c], cuts[c + 1])
        if peak < math.inf:  # else a crack narrower than _HOLE
            high = max(high, peak)
    return low, high


@compiled
def surface_leg_heights(
    triangles: FloatArray,
    grid: FloatArray,
    heads: IntArray,
    members: IntArray,
    starts: FloatArray,
    ends: FloatArray,
) -> FloatArray:
    """The smallest and the largest height of legs (n, 3) over the highest surface, shape (n, 2) [m].

    NaN where a leg leaves the triangles.
    """
    result = np.empty((starts.shape[0], 2))
    seen = np.full(triangles.shape[0], -1)
    spans, leg = np.empty((64, 4)), np.empty(6)
    for n in range(starts.shape[0]):
        for axis in range(3):
            leg[axis], leg[3 + axis] = starts[n, axis], ends[n, axis]
        length = math.hypot(leg[3] - leg[0], leg[4] - leg[1])
        if not math.isfinite(length + leg[2] + leg[5]):
            result[n, 0] = result[n, 1] = math.nan
            continue
        if length <= _RIM:
            top = _top(triangles, grid, heads, members, leg[0], leg[1])
            result[n, 0], result[n, 1] = min(leg[2], leg[5]) - top, max(leg[2], leg[5]) - top
            continue
        count = 0
        i0, i1 = bin_of(grid, min(leg[0], leg[3]), 0), bin_of(grid, max(leg[0], leg[3]), 0)
        for i in range(i0, i1 + 1):
            j0, j1 = bins_along(grid, leg, i)
            for j in range(j0, j1 + 1):
                here = j * int(grid[3]) + i
                for k in range(heads[here], heads[here + 1]):
                    m = members[k]
                    if seen[m] == n:
                        continue
                    seen[m] = n
                    if count + 3 > spans.shape[0]:
                        spans = _doubled(spans)
                    turn = turn_of(triangles[m])
                    if turn != 0.0:
                        count += _span(triangles[m], turn, leg, spans[count])
                        continue
                    for side in range(3):
                        count += _wall_span(triangles[m], side, leg, spans[count])
        result[n, 0], result[n, 1] = _sweep(spans, count, length)
    return result


@piece
def _doubled(spans: FloatArray) -> FloatArray:
    larger = np.empty((2 * spans.shape[0], 4))
    for k in range(spans.shape[0]):
        for i in range(4):
            larger[k, i] = spans[k, i]
    return larger
