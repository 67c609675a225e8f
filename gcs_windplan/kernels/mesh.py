"""Places and legs over and beside triangles (m, 3, 3).

Plan bins find the few triangles that matter: squares over the plan, as `grid` (5,): west, south, side [m],
columns, rows; the triangles of bin b are members[heads[b]:heads[b + 1]].

Over a surface a leg becomes spans, rows of (t0, t1, h0, h1): between t0 and t1 of its way it lies over one
triangle, h0 and h1 above it. The ground is the highest surface, so the height above ground is the least of
the spans.
"""

from __future__ import annotations

import math

import numba
import numpy as np

from gcs_windplan.arrays import BoolArray, FloatArray, IntArray

_RIM = 1e-9  # [m] a place that far outside of a triangle is still over it: seams have no cracks
_HOLE = 1e-6  # [m] a stretch over no triangle that is longer is unknown ground
_FLAT = 1e-10  # plan area over squared longest side, below which a triangle is a wall
TOUCH = 1e-3  # [m] what a leg in touch with an obstacle is taken to lie inside of it


@numba.njit(cache=True)
def _bin(grid: FloatArray, value: float, axis: int) -> int:
    """The bin of an east (axis 0) or north (axis 1) coordinate, the nearest there is; 0 for NaN."""
    position = (value - grid[axis]) / grid[2]
    return int(min(position, grid[3 + axis] - 1)) if position > 0.0 else 0


@numba.njit(cache=True)
def fill_bins(boxes: FloatArray, grid: FloatArray) -> tuple[IntArray, IntArray]:
    """Heads and members of plan bins for boxes (m, 4) of west, south, east, north."""
    columns, bins = int(grid[3]), int(grid[3]) * int(grid[4])
    heads = np.zeros(bins + 1, dtype=np.int64)
    members = np.empty(0, dtype=np.int64)
    for turn in range(2):  # first count, then fill from the back
        for m in range(boxes.shape[0] - 1, -1, -1):
            for j in range(_bin(grid, boxes[m, 1], 1), _bin(grid, boxes[m, 3], 1) + 1):
                for i in range(_bin(grid, boxes[m, 0], 0), _bin(grid, boxes[m, 2], 0) + 1):
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


@numba.njit(cache=True)
def _height(tri: FloatArray, x: float, y: float) -> float:
    """The height of a triangle that is no wall at a place over it."""
    a, b, c = tri[0], tri[1], tri[2]
    ux, uy, vx, vy, px, py = b[0] - a[0], b[1] - a[1], c[0] - a[0], c[1] - a[1], x - a[0], y - a[1]
    area = ux * vy - uy * vx
    f, g = (px * vy - py * vx) / area, (ux * py - uy * px) / area
    z = a[2] + f * (b[2] - a[2]) + g * (c[2] - a[2])
    height: float = min(max(z, min(a[2], b[2], c[2])), max(a[2], b[2], c[2]))
    return height


@numba.njit(cache=True)
def _turn(tri: FloatArray) -> float:
    """+1 for a triangle that is counter-clockwise in plan, -1 for clockwise, 0 for a wall."""
    a, b, c = tri[0], tri[1], tri[2]
    ux, uy, vx, vy = b[0] - a[0], b[1] - a[1], c[0] - a[0], c[1] - a[1]
    area = ux * vy - uy * vx
    longest = max(ux * ux + uy * uy, vx * vx + vy * vy, (vx - ux) ** 2 + (vy - uy) ** 2)
    if abs(area) <= _FLAT * longest:
        return 0.0
    return 1.0 if area > 0.0 else -1.0


@numba.njit(cache=True)
def _outside(tri: FloatArray, k: int, turn: float, x: float, y: float) -> float:
    """How far a place lies outside of the k-th side in plan [m], negative inside."""
    ax, ay = tri[k, 0], tri[k, 1]
    ex, ey = tri[(k + 1) % 3, 0] - ax, tri[(k + 1) % 3, 1] - ay
    away: float = -turn * (ex * (y - ay) - ey * (x - ax)) / math.sqrt(ex * ex + ey * ey)
    return away


@numba.njit(cache=True)
def _over(tri: FloatArray, turn: float, x: float, y: float) -> bool:
    first, second = _outside(tri, 0, turn, x, y), _outside(tri, 1, turn, x, y)
    return first <= _RIM and second <= _RIM and _outside(tri, 2, turn, x, y) <= _RIM


@numba.njit(cache=True)
def _top(triangles: FloatArray, grid: FloatArray, heads: IntArray, members: IntArray, x: float, y: float) -> float:
    """The highest surface at a place, NaN where there is none."""
    top = -math.inf
    here = _bin(grid, y, 1) * int(grid[3]) + _bin(grid, x, 0)
    for k in range(heads[here], heads[here + 1]):
        tri = triangles[members[k]]
        turn = _turn(tri)
        if turn != 0.0 and _over(tri, turn, x, y):
            top = max(top, _height(tri, x, y))
    return top if top > -math.inf else math.nan


@numba.njit(cache=True)
def surface_heights(
    triangles: FloatArray, grid: FloatArray, heads: IntArray, members: IntArray, places: FloatArray
) -> FloatArray:
    """The height of the highest surface at places (n, 2 or more) [m]; NaN where there is none."""
    result = np.empty(places.shape[0])
    for n in range(places.shape[0]):
        result[n] = _top(triangles, grid, heads, members, places[n, 0], places[n, 1])
    return result


@numba.njit(cache=True)
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
        span[k], span[2 + k] = t, z - _height(tri, x, y)
    return True


@numba.njit(cache=True)
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


@numba.njit(cache=True)
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


@numba.njit(cache=True)
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


@numba.njit(cache=True)
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


@numba.njit(cache=True)
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


@numba.njit(cache=True)
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
        i0, i1 = _bin(grid, min(leg[0], leg[3]), 0), _bin(grid, max(leg[0], leg[3]), 0)
        for i in range(i0, i1 + 1):
            j0, j1 = _bins_along(grid, leg, i)
            for j in range(j0, j1 + 1):
                here = j * int(grid[3]) + i
                for k in range(heads[here], heads[here + 1]):
                    m = members[k]
                    if seen[m] == n:
                        continue
                    seen[m] = n
                    if count + 3 > spans.shape[0]:
                        spans = _doubled(spans)
                    turn = _turn(triangles[m])
                    if turn != 0.0:
                        count += _span(triangles[m], turn, leg, spans[count])
                        continue
                    for side in range(3):
                        count += _wall_span(triangles[m], side, leg, spans[count])
        result[n, 0], result[n, 1] = _sweep(spans, count, length)
    return result


@numba.njit(cache=True)
def _doubled(spans: FloatArray) -> FloatArray:
    larger = np.empty((2 * spans.shape[0], 4))
    for k in range(spans.shape[0]):
        for i in range(4):
            larger[k, i] = spans[k, i]
    return larger


@numba.njit(cache=True)
def _bins_along(grid: FloatArray, leg: FloatArray, i: int) -> tuple[int, int]:
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
    return _bin(grid, min(ya, yb) - slack, 1), _bin(grid, max(ya, yb) + slack, 1)


@numba.njit(cache=True)
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
        for j in range(_bin(grid, low[1], 1), _bin(grid, high[1], 1) + 1):
            for i in range(_bin(grid, low[0], 0), _bin(grid, high[0], 0) + 1):
                here = j * int(grid[3]) + i
                for k in range(heads[here], heads[here + 1]):
                    m = members[k]
                    if seen[m] == n or result[n]:
                        continue
                    seen[m] = n
                    if _boxes_meet(triangles[m], low, high):
                        result[n] = _meets_sampled(triangles[m], starts[n], ends[n], step, tolerance)
    return result


@numba.njit(cache=True)
def _boxes_meet(tri: FloatArray, low: FloatArray, high: FloatArray) -> bool:
    for axis in range(3):
        if max(tri[0, axis], tri[1, axis], tri[2, axis]) < low[axis]:
            return False
        if min(tri[0, axis], tri[1, axis], tri[2, axis]) > high[axis]:
            return False
    return True


@numba.njit(cache=True)
def _area(px: float, py: float, pz: float, a: FloatArray, b: FloatArray) -> float:
    """The area of the triangle of a point and two corners [m²]."""
    ux, uy, uz, vx, vy, vz = a[0] - px, a[1] - py, a[2] - pz, b[0] - px, b[1] - py, b[2] - pz
    x, y, z = uy * vz - uz * vy, uz * vx - ux * vz, ux * vy - uy * vx
    return 0.5 * math.sqrt(x * x + y * y + z * z)


@numba.njit(cache=True)
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


# From here on vectors are single numbers: an array of three would cost an allocation each time.


@numba.njit(cache=True)
def _side_distance2(start: FloatArray, end: FloatArray, a: FloatArray, b: FloatArray) -> float:
    """Squared distance of a leg and the side from a to b.

    Ericson 2005, Real-Time Collision Detection, section 5.1.9.
    """
    ux, uy, uz = end[0] - start[0], end[1] - start[1], end[2] - start[2]
    vx, vy, vz = b[0] - a[0], b[1] - a[1], b[2] - a[2]
    wx, wy, wz = start[0] - a[0], start[1] - a[1], start[2] - a[2]
    uu, vv, uv = ux * ux + uy * uy + uz * uz, vx * vx + vy * vy + vz * vz, ux * vx + uy * vy + uz * vz
    uw, vw = ux * wx + uy * wy + uz * wz, vx * wx + vy * wy + vz * wz
    s, det = 0.0, uu * vv - uv * uv
    if det > 1e-12 * uu * vv:
        s = min(max((uv * vw - uw * vv) / det, 0.0), 1.0)
    t = min(max((uv * s + vw) / vv, 0.0), 1.0) if vv > 0.0 else 0.0
    s = min(max((uv * t - uw) / uu, 0.0), 1.0) if uu > 0.0 else 0.0
    x, y, z = wx + s * ux - t * vx, wy + s * uy - t * vy, wz + s * uz - t * vz
    square: float = x * x + y * y + z * z
    return square


@numba.njit(cache=True)
def _normal(tri: FloatArray) -> tuple[float, float, float]:
    a, b, c = tri[0], tri[1], tri[2]
    ux, uy, uz, vx, vy, vz = b[0] - a[0], b[1] - a[1], b[2] - a[2], c[0] - a[0], c[1] - a[1], c[2] - a[2]
    return uy * vz - uz * vy, uz * vx - ux * vz, ux * vy - uy * vx


@numba.njit(cache=True)
def _foot_inside(tri: FloatArray, nx: float, ny: float, nz: float, x: float, y: float, z: float) -> bool:
    """Does the foot of a point on the triangle's plane, with this normal, lie inside of the triangle?"""
    for k in range(3):
        a, b = tri[k], tri[(k + 1) % 3]
        ex, ey, ez, wx, wy, wz = b[0] - a[0], b[1] - a[1], b[2] - a[2], x - a[0], y - a[1], z - a[2]
        if (ey * wz - ez * wy) * nx + (ez * wx - ex * wz) * ny + (ex * wy - ey * wx) * nz < 0.0:
            return False
    return True


@numba.njit(cache=True)
def _leg_triangle_distance(tri: FloatArray, p: FloatArray, q: FloatArray) -> float:
    """The distance of a leg from p to q and a triangle [m], 0 where they meet.

    Either the leg pierces the triangle, or an end lies nearest to its inside, or the leg lies nearest to a
    side.
    """
    least = min(_side_distance2(p, q, tri[0], tri[1]), _side_distance2(p, q, tri[1], tri[2]))
    least = min(least, _side_distance2(p, q, tri[2], tri[0]))
    a = tri[0]
    nx, ny, nz = _normal(tri)
    size2 = nx * nx + ny * ny + nz * nz
    if size2 > 0.0:
        first = (p[0] - a[0]) * nx + (p[1] - a[1]) * ny + (p[2] - a[2]) * nz
        last = (q[0] - a[0]) * nx + (q[1] - a[1]) * ny + (q[2] - a[2]) * nz
        if first * last <= 0.0 and first != last:
            t = first / (first - last)
            x, y, z = p[0] + t * (q[0] - p[0]), p[1] + t * (q[1] - p[1]), p[2] + t * (q[2] - p[2])
            if _foot_inside(tri, nx, ny, nz, x, y, z):
                return 0.0
        if first * first < least * size2 and _foot_inside(tri, nx, ny, nz, p[0], p[1], p[2]):
            least = first * first / size2
        if last * last < least * size2 and _foot_inside(tri, nx, ny, nz, q[0], q[1], q[2]):
            least = last * last / size2
    return math.sqrt(least)


@numba.njit(cache=True)
def _least_possible(bounds: FloatArray, node: int, p: FloatArray, q: FloatArray) -> float:
    """A lower bound of distance less margin between a leg from p to q and all that a node holds.

    The greater of two: from the leg's box to the node's box, and from the leg to the ball around the node's
    box.
    """
    square, half2, along, length2, away2 = 0.0, 0.0, 0.0, 0.0, 0.0
    for axis in range(3):
        low, high = bounds[node, axis], bounds[node, 3 + axis]
        gap = max(low - max(p[axis], q[axis]), min(p[axis], q[axis]) - high, 0.0)
        w, u = 0.5 * (low + high) - p[axis], q[axis] - p[axis]
        square += gap * gap
        half2 += 0.25 * (high - low) * (high - low)
        along += w * u
        length2 += u * u
        away2 += w * w
    t = min(max(along / length2, 0.0), 1.0) if length2 > 0.0 else 0.0
    centre2 = max(away2 - 2.0 * t * along + t * t * length2, 0.0)
    return max(math.sqrt(square), math.sqrt(centre2) - math.sqrt(half2)) - float(bounds[node, 6])


@numba.njit(cache=True)
def _inside(
    triangles: FloatArray,
    owners: IntArray,
    margins: FloatArray,
    grid: FloatArray,
    heads: IntArray,
    members: IntArray,
    p: FloatArray,
) -> float:
    """The greatest margin among the closed meshes that a point is inside of, -inf if there are none.

    A line straight up leaves a closed mesh it begins in through an odd number of faces. A side that two faces
    share is judged by the same arithmetic for both, so the line never slips between them.
    """
    margin, odd, owner = -math.inf, False, -1
    here = _bin(grid, p[1], 1) * int(grid[3]) + _bin(grid, p[0], 0)
    for k in range(heads[here], heads[here + 1]):
        m = members[k]
        if owners[m] != owner:
            odd, owner = False, owners[m]
        tri = triangles[m]
        crossed = False
        for i in range(3):
            a, b = tri[i], tri[(i + 1) % 3]
            if a[1] > b[1] or (a[1] == b[1] and a[0] > b[0]):
                a, b = b, a
            if a[1] <= p[1] < b[1] and (b[0] - a[0]) * (p[1] - a[1]) > (p[0] - a[0]) * (b[1] - a[1]):
                crossed = not crossed
        if crossed and _turn(tri) != 0.0 and _height(tri, p[0], p[1]) > p[2]:
            odd = not odd
        last = k + 1 == heads[here + 1] or owners[members[k + 1]] != owner
        if odd and last:
            margin = max(margin, margins[m])
    return margin


@numba.njit(cache=True)
def solid_leg_margins(
    triangles: FloatArray,
    owners: IntArray,
    margins: FloatArray,
    grid: FloatArray,
    heads: IntArray,
    members: IntArray,
    bounds: FloatArray,
    links: IntArray,
    order: IntArray,
    starts: FloatArray,
    ends: FloatArray,
) -> FloatArray:
    """The least distance less margin of legs (n, 3) from closed meshes [m], by branch and bound."""
    result = np.empty(starts.shape[0])
    stack = np.empty(256, dtype=np.int64)
    for n in range(starts.shape[0]):
        start, end = starts[n], ends[n]
        if not math.isfinite(start[0] + start[1] + start[2] + end[0] + end[1] + end[2]):
            result[n] = math.nan
            continue
        best = -TOUCH - _inside(triangles, owners, margins, grid, heads, members, start)
        stack[0], waiting = 0, 1
        while waiting > 0:
            waiting -= 1
            node = stack[waiting]
            if _least_possible(bounds, node, start, end) >= best:
                continue
            one, other = links[node]
            if one >= 0:
                if _least_possible(bounds, one, start, end) < _least_possible(bounds, other, start, end):
                    one, other = other, one
                stack[waiting], stack[waiting + 1] = one, other
                waiting += 2
                continue
            for k in range(-1 - one, -1 - one + other):
                m = order[k]
                distance = _leg_triangle_distance(triangles[m], start, end)
                best = min(best, (distance if distance > 0.0 else -TOUCH) - margins[m])
        result[n] = best
    return result


@numba.njit(cache=True)
def _disc_top(tri: FloatArray, turn: float, x: float, y: float, radius: float) -> float:
    """The highest point of a triangle within a horizontal distance of a place, -inf where it is farther away.

    It lies on a side, or where the steepest way up from the place meets the disc's rim.
    """
    top = -math.inf
    for k in range(3):
        a, b = tri[k], tri[(k + 1) % 3]
        ex, ey, px, py = b[0] - a[0], b[1] - a[1], x - a[0], y - a[1]
        side2, along, away2 = ex * ex + ey * ey, ex * px + ey * py, px * px + py * py
        if side2 == 0.0:
            if away2 <= radius * radius:
                top = max(top, a[2], b[2])
            continue
        half2 = along * along - side2 * (away2 - radius * radius)
        if half2 >= 0.0:
            half = math.sqrt(half2)
            t0, t1 = max((along - half) / side2, 0.0), min((along + half) / side2, 1.0)
            if t0 <= t1:
                top = max(top, a[2] + t0 * (b[2] - a[2]), a[2] + t1 * (b[2] - a[2]))
    if turn != 0.0:
        nx, ny, nz = _normal(tri)
        steep = math.hypot(nx, ny)
        f = -math.copysign(radius / steep, nz) if steep > 0.0 else 0.0  # uphill is against an upward normal
        qx, qy = x + f * nx, y + f * ny
        if _over(tri, turn, qx, qy):
            top = max(top, _height(tri, qx, qy))
    return top


@numba.njit(cache=True)
def solid_tops(
    triangles: FloatArray,
    margins: FloatArray,
    lifts: FloatArray,
    grid: FloatArray,
    heads: IntArray,
    members: IntArray,
    places: FloatArray,
) -> FloatArray:
    """The highest surface within its own margin of places [m], plus its lift; -inf where there is none."""
    result = np.full(places.shape[0], -math.inf)
    for n in range(places.shape[0]):
        x, y = places[n, 0], places[n, 1]
        here = _bin(grid, y, 1) * int(grid[3]) + _bin(grid, x, 0)
        for k in range(heads[here], heads[here + 1]):
            m = members[k]
            top = _disc_top(triangles[m], _turn(triangles[m]), x, y, margins[m])
            result[n] = max(result[n], top + lifts[m])
    return result
