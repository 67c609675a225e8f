"""Legs and places beside closed meshes, whose triangles (m, 3, 3) have owners and margins (m,) [m].

A tree of boxes finds the triangles near a leg, plan bins those above and around a place. Vectors are single
numbers here: an array of three would cost an allocation each time.
"""

from __future__ import annotations

import math

import numpy as np

from gcs_windplan.arrays import FloatArray, IntArray
from gcs_windplan.kernels.compiled import compiled, piece
from gcs_windplan.kernels.meshes import height_of, lies_over, turn_of
from gcs_windplan.kernels.plan_bins import bin_of

TOUCH = 1e-3  # [m] what a leg in touch with an obstacle is taken to lie inside of it


@piece
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


@piece
def _normal(tri: FloatArray) -> tuple[float, float, float]:
    a, b, c = tri[0], tri[1], tri[2]
    ux, uy, uz, vx, vy, vz = b[0] - a[0], b[1] - a[1], b[2] - a[2], c[0] - a[0], c[1] - a[1], c[2] - a[2]
    return uy * vz - uz * vy, uz * vx - ux * vz, ux * vy - uy * vx


@piece
def _foot_inside(tri: FloatArray, nx: float, ny: float, nz: float, x: float, y: float, z: float) -> bool:
    """Does the foot of a point on the triangle's plane, with this normal, lie inside of the triangle?"""
    for k in range(3):
        a, b = tri[k], tri[(k + 1) % 3]
        ex, ey, ez, wx, wy, wz = b[0] - a[0], b[1] - a[1], b[2] - a[2], x - a[0], y - a[1], z - a[2]
        if (ey * wz - ez * wy) * nx + (ez * wx - ex * wz) * ny + (ex * wy - ey * wx) * nz < 0.0:
            return False
    return True


@piece
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


@piece
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


@piece
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
    here = bin_of(grid, p[1], 1) * int(grid[3]) + bin_of(grid, p[0], 0)
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
        if crossed and turn_of(tri) != 0.0 and height_of(tri, p[0], p[1]) > p[2]:
            odd = not odd
        last = k + 1 == heads[here + 1] or owners[members[k + 1]] != owner
        if odd and last:
            margin = max(margin, margins[m])
    return margin


@compiled
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


@piece
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
        if lies_over(tri, turn, qx, qy):
            top = max(top, height_of(tri, qx, qy))
    return top


@compiled
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
        here = bin_of(grid, y, 1) * int(grid[3]) + bin_of(grid, x, 0)
        for k in range(heads[here], heads[here + 1]):
            m = members[k]
            top = _disc_top(triangles[m], turn_of(triangles[m]), x, y, margins[m])
            result[n] = max(result[n], top + lifts[m])
    return result
