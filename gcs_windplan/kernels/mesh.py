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
def lay_bins(boxes: FloatArray) -> tuple[FloatArray, IntArray, IntArray]:
    """Plan bins for boxes (m, 4) of west, south, east, north: grid, heads, members; about one bin a box."""
    count = boxes.shape[0]
    west, south = boxes[:, 0].min(), boxes[:, 1].min()
    width, height = boxes[:, 2].max() - west, boxes[:, 3].max() - south
    usual = 0.0
    for m in range(count):
        usual += 0.5 * (boxes[m, 2] - boxes[m, 0] + boxes[m, 3] - boxes[m, 1]) / count
    side = max(math.sqrt(width * height / count), usual, max(width, height) / 4096, 1e-6)
    columns, rows = math.floor(width / side) + 1, math.floor(height / side) + 1
    grid = np.array([west, south, side, float(columns), float(rows)])
    heads = np.zeros(columns * rows + 1, dtype=np.int64)
    members = np.empty(0, dtype=np.int64)
    for turn in range(2):  # first count, then fill from the back
        for m in range(count - 1, -1, -1):
            for j in range(_bin(grid, boxes[m, 1], 1), _bin(grid, boxes[m, 3], 1) + 1):
                for i in range(_bin(grid, boxes[m, 0], 0), _bin(grid, boxes[m, 2], 0) + 1):
                    if turn == 0:
                        heads[j * columns + i] += 1
                    else:
                        heads[j * columns + i] -= 1
                        members[heads[j * columns + i]] = m
        if turn == 0:
            heads = np.cumsum(heads)
            members = np.empty(heads[-1], dtype=np.int64)
    return grid, heads, members


@numba.njit(cache=True)
def _height(tri: FloatArray, x: float, y: float) -> float:
    """The height of a triangle that is no wall at a place over it."""
    a, b, c = tri[0], tri[1], tri[2]
    ux, uy, vx, vy, px, py = b[0] - a[0], b[1] - a[1], c[0] - a[0], c[1] - a[1], x - a[0], y - a[1]
    area = ux * vy - uy * vx
    f, g = (px * vy - py * vx) / area, (ux * py - uy * px) / area
    z = a[2] + f * (b[2] - a[2]) + g * (c[2] - a[2])
    return min(max(z, min(a[2], b[2], c[2])), max(a[2], b[2], c[2]))


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
def _top(
    triangles: FloatArray, grid: FloatArray, heads: IntArray, members: IntArray, x: float, y: float
) -> float:
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
def _sweep(spans: FloatArray, count: int, length: float) -> tuple[float, float]:
    """The extreme heights of a leg over the highest surface, NaN if there are holes on the way."""
    for k in range(1, count):  # by t0; few enough for an insertion sort
        row = spans[k].copy()
        j = k - 1
        while j >= 0 and spans[j, 0] > row[0]:
            spans[j + 1] = spans[j]
            j -= 1
        spans[j + 1] = row
    low, reach, hole = math.inf, 0.0, 0.0
    for k in range(count):
        hole = max(hole, spans[k, 0] - reach)
        reach = max(reach, spans[k, 1])
        low = min(low, spans[k, 2], spans[k, 3])
    if max(hole, 1.0 - reach) * length > _HOLE:
        return math.nan, math.nan
    cuts = np.sort(spans[:count, :2].copy().reshape(-1))
    high, first, last = low, 0, 0
    for c in range(len(cuts) - 1):
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
    spans, span, leg = np.empty((64, 4)), np.empty(4), np.empty(6)
    for n in range(starts.shape[0]):
        leg[:3], leg[3:] = starts[n], ends[n]
        length = math.hypot(leg[3] - leg[0], leg[4] - leg[1])
        if not math.isfinite(length + leg[2] + leg[5]):
            result[n] = math.nan
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
                        spans = np.concatenate((spans, np.empty_like(spans)))
                    turn = _turn(triangles[m])
                    if turn != 0.0:
                        if _span(triangles[m], turn, leg, span):
                            spans[count] = span
                            count += 1
                        continue
                    for side in range(3):
                        if _wall_span(triangles[m], side, leg, span):
                            spans[count] = span
                            count += 1
        result[n, 0], result[n, 1] = _sweep(spans, count, length)
    return result


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
    for n in range(starts.shape[0]):
        low, high = np.minimum(starts[n], ends[n]), np.maximum(starts[n], ends[n])
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
def _area(a: FloatArray, b: FloatArray, c: FloatArray) -> float:
    u, v = b - a, c - a
    x, y, z = u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]
    return 0.5 * math.sqrt(x * x + y * y + z * z)


@numba.njit(cache=True)
def _meets_sampled(
    tri: FloatArray, start: FloatArray, end: FloatArray, step: float, tolerance: float
) -> bool:
    area = _area(tri[0], tri[1], tri[2])
    length = math.sqrt(((end - start) ** 2).sum())
    for k in range(math.ceil(length / step) + 1):
        p = start + (end - start) * (min(k * step / length, 1.0) if length > 0.0 else 0.0)
        parts = _area(p, tri[0], tri[1]) + _area(p, tri[0], tri[2]) + _area(p, tri[1], tri[2])
        if parts - area <= tolerance * area:
            return True
    return False


@numba.njit(cache=True)
def _dot(a: FloatArray, b: FloatArray) -> float:
    product: float = a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
    return product


@numba.njit(cache=True)
def _side_distance2(p: FloatArray, u: FloatArray, a: FloatArray, b: FloatArray) -> float:
    """Squared distance of the segments p to p + u and a to b.

    Ericson 2005, Real-Time Collision Detection, section 5.1.9.
    """
    v, w = b - a, p - a
    uu, vv, uv, uw, vw = _dot(u, u), _dot(v, v), _dot(u, v), _dot(u, w), _dot(v, w)
    s, det = 0.0, uu * vv - uv * uv
    if det > 1e-12 * uu * vv:
        s = min(max((uv * vw - uw * vv) / det, 0.0), 1.0)
    t = (uv * s + vw) / vv if vv > 0.0 else 0.0
    if t < 0.0 or t > 1.0 or vv == 0.0:
        t = min(max(t, 0.0), 1.0)
        s = min(max((uv * t - uw) / uu, 0.0), 1.0) if uu > 0.0 else 0.0
    gap = w + s * u - t * v
    return _dot(gap, gap)


@numba.njit(cache=True)
def _normal(tri: FloatArray) -> FloatArray:
    u, v = tri[1] - tri[0], tri[2] - tri[0]
    return np.array([u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]])


@numba.njit(cache=True)
def _above(tri: FloatArray, normal: FloatArray, p: FloatArray) -> bool:
    """Does the foot of p on the triangle's plane lie inside of the triangle?"""
    for k in range(3):
        e, w = tri[(k + 1) % 3] - tri[k], p - tri[k]
        x, y, z = e[1] * w[2] - e[2] * w[1], e[2] * w[0] - e[0] * w[2], e[0] * w[1] - e[1] * w[0]
        if x * normal[0] + y * normal[1] + z * normal[2] < 0.0:
            return False
    return True


@numba.njit(cache=True)
def _leg_triangle_distance(tri: FloatArray, start: FloatArray, end: FloatArray) -> float:
    """The distance of a leg from a triangle [m], 0 where they meet.

    Either the leg pierces the triangle, or an end lies nearest to its inside, or the leg lies nearest to a
    side.
    """
    u = end - start
    least = math.inf
    for k in range(3):
        least = min(least, _side_distance2(start, u, tri[k], tri[(k + 1) % 3]))
    normal = _normal(tri)
    size2 = _dot(normal, normal)
    if size2 > 0.0:
        first, last = _dot(start - tri[0], normal), _dot(end - tri[0], normal)
        if first * last <= 0.0 and first != last and _above(tri, normal, start + first / (first - last) * u):
            return 0.0
        if first * first < least * size2 and _above(tri, normal, start):
            least = min(least, first * first / size2)
        if last * last < least * size2 and _above(tri, normal, end):
            least = min(least, last * last / size2)
    return math.sqrt(least)


@numba.njit(cache=True)
def lay_tree(boxes: FloatArray, margins: FloatArray, leaf: int) -> tuple[FloatArray, IntArray, IntArray]:
    """A tree of boxes over boxes (m, 6) of low and high corners, halved along the longest side.

    Returns bounds (k, 7): low, high, greatest margin; links (k, 2): the two children, or (-1 - first, count)
    for a leaf; and the order (m,) to which `first` and `count` refer.
    """
    count = boxes.shape[0]
    order = np.arange(count)
    bounds, links = np.empty((2 * count, 7)), np.empty((2 * count, 2), dtype=np.int64)
    todo = [(0, 0, count)]
    nodes = 1
    while len(todo) > 0:
        node, first, last = todo.pop()
        own = order[first:last]
        for axis in range(3):
            bounds[node, axis] = boxes[own, axis].min()
            bounds[node, 3 + axis] = boxes[own, 3 + axis].max()
        bounds[node, 6] = margins[own].max()
        if last - first <= leaf:
            links[node, 0], links[node, 1] = -1 - first, last - first
            continue
        axis = int(np.argmax(bounds[node, 3:6] - bounds[node, :3]))
        order[first:last] = own[np.argsort(boxes[own, axis] + boxes[own, 3 + axis])]
        middle = (first + last) // 2
        links[node, 0], links[node, 1] = nodes, nodes + 1
        todo.append((nodes, first, middle))
        todo.append((nodes + 1, middle, last))
        nodes += 2
    return bounds[:nodes].copy(), links[:nodes].copy(), order


@numba.njit(cache=True)
def _least_possible(bounds: FloatArray, node: int, low: FloatArray, high: FloatArray) -> float:
    """A lower bound of distance less margin between a leg's box and all that a node holds."""
    square = 0.0
    for axis in range(3):
        gap = max(bounds[node, axis] - high[axis], low[axis] - bounds[node, 3 + axis], 0.0)
        square += gap * gap
    return math.sqrt(square) - float(bounds[node, 6])


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
        if not math.isfinite((start + end).sum()):
            result[n] = math.nan
            continue
        low, high = np.minimum(start, end), np.maximum(start, end)
        best = -TOUCH - _inside(triangles, owners, margins, grid, heads, members, start)
        stack[0], waiting = 0, 1
        while waiting > 0:
            waiting -= 1
            node = stack[waiting]
            if _least_possible(bounds, node, low, high) >= best:
                continue
            one, other = links[node]
            if one >= 0:
                if _least_possible(bounds, one, low, high) < _least_possible(bounds, other, low, high):
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
        normal = _normal(tri)
        uphill = -math.copysign(1.0, normal[2]) * normal
        steep = math.hypot(uphill[0], uphill[1])
        f = radius / steep if steep > 0.0 else 0.0
        qx, qy = x + f * uphill[0], y + f * uphill[1]
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
