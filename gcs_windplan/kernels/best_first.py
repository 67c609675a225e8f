"""A* over an implicit grid and over a CSR graph; edge costs are worked out on the fly from the nodes' winds.

Both kernels are one textbook A* with a closed list and a binary heap with lazy deletion. With a consistent lower bound
that is optimal; with the paper's heuristics, which are none, it is what the paper runs.

Edges take the wind as linear between their two nodes. Where both ends can be flown, so can all between: the winds in
which a track is flyable are a convex set.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numba
import numpy as np

from gcs_windplan.arrays import FloatArray, IntArray, MaskArray
from gcs_windplan.kernels.triangle import PAPER, Performance, leg_seconds, wind_angle

DISTANCE, ANGLE, HYBRID, TIME = 0.0, 1.0, 2.0, 3.0


class Setting(NamedTuple):
    """What a search minimises, and where to."""

    code: float  # one of the four above
    goal_e: float  # [m], as are the next two
    goal_n: float
    goal_z: float
    angle_weight: float = 0.0  # hybrid (11)
    distance_weight: float = 0.0
    straight: float = 1.0  # from start to goal [m]
    ball_e: float = 0.0  # all winds lie in a ball about this one [m/s]
    ball_n: float = 0.0
    ball_radius: float = 0.0
    ball_up: float = 0.0  # the strongest up-draught and down-draught [m/s]
    ball_down: float = 0.0


@numba.njit(error_model="numpy", forceinline=True)
def edge_cost(
    performance: Performance, setting: Setting,
    level: float, east: float, north: float, climb: float,
    ae: float, an: float, au: float,
    be: float, bn: float, bu: float,
) -> float:  # fmt: skip
    """The cost of an edge in the search; infinite where it cannot be flown.

    The edge goes `level` [m] along the unit track (east, north) and gains `climb` [m] in a wind from a to b [m/s]. Its
    time is the mean of the times in both winds (the trapezoidal rule). The angle is that at the arrival, (10).
    """
    outset: float = leg_seconds(performance, level, east, north, climb, ae, an, au)
    if outset == math.inf:
        return outset
    seconds: float = 0.5 * (outset + leg_seconds(performance, level, east, north, climb, be, bn, bu))
    code = setting.code
    if code == TIME or seconds == math.inf:
        return seconds
    if code == DISTANCE:
        return math.sqrt(level * level + climb * climb)
    angle: float = wind_angle(level * east, level * north, climb, be, bn, bu)
    if code == ANGLE:
        return angle
    weight: float = setting.angle_weight
    return weight * angle / math.pi


@numba.njit(cache=True, error_model="numpy")
def edge_between(
    performance: Performance, setting: Setting,
    de: float, dn: float, dz: float,
    ae: float, an: float, au: float,
    be: float, bn: float, bu: float,
) -> float:  # fmt: skip
    """`edge_cost` of an edge given by its vector (de, dn, dz) [m]."""
    level = math.sqrt(de * de + dn * dn)
    if level == 0.0:
        if dz == 0.0:
            return 0.0
        return edge_cost(performance, setting, 0.0, 0.0, 0.0, dz, ae, an, au, be, bn, bu)
    return edge_cost(performance, setting, level, de / level, dn / level, dz, ae, an, au, be, bn, bu)


@numba.njit(cache=True, error_model="numpy", forceinline=True)
def remaining(performance: Performance, setting: Setting, e: float, n: float, z: float) -> float:
    """The estimate from a place to the goal; for distance and time a consistent lower bound.

    Time: whatever the wind, it lies in a ball (centre c, radius r), so the vehicle is never faster than one with
    airspeed V + r in the constant wind c; times in a constant wind obey the triangle inequality. The paper's model
    does so only for c up to half of the airspeed (its indicatrix is dented beyond): then `search/` centres the ball
    on 0.
    """
    de, dn, dz = setting.goal_e - e, setting.goal_n - n, setting.goal_z - z
    level2 = de * de + dn * dn
    code = setting.code
    if code != TIME:
        distance = math.sqrt(level2 + dz * dz)
        if code == DISTANCE:
            return distance
        if code == HYBRID:
            share: float = setting.distance_weight * distance / max(distance, setting.straight)
            return share
        return 0.0
    vertical = 0.0
    if dz > 0.0:
        vertical = dz / (performance.climb + setting.ball_up)
    elif dz < 0.0:
        vertical = -dz / (performance.descent + setting.ball_down)
    if level2 == 0.0:
        return vertical
    level = math.sqrt(level2)
    airspeed = performance.airspeed + setting.ball_radius
    along = (setting.ball_e * de + setting.ball_n * dn) / level
    if performance.model == PAPER:
        speed = airspeed + along
    else:
        cross = (setting.ball_n * de - setting.ball_e * dn) / level
        rest = airspeed * airspeed - cross * cross
        if rest < 0.0:
            return math.inf
        speed = math.sqrt(rest) + along
    if speed <= 0.0:
        return math.inf
    seconds: float = max(vertical, level / speed)
    return seconds


@numba.njit(error_model="numpy", forceinline=True)
def _push(keys: FloatArray, nodes: IntArray, size: int, key: float, node: int) -> None:
    """Put a node into the 4-ary heap of `size` entries; there must be room for one more."""
    hole = size
    while hole > 0:
        above = (hole - 1) >> 2
        if keys[above] <= key:
            break
        keys[hole] = keys[above]
        nodes[hole] = nodes[above]
        hole = above
    keys[hole] = key
    nodes[hole] = node


@numba.njit(error_model="numpy", forceinline=True)
def _pop(keys: FloatArray, nodes: IntArray, size: int) -> None:
    """Drop the first of `size` entries; the last one sinks from the top."""
    last = size - 1
    key, node = keys[last], nodes[last]
    hole = 0
    while True:
        child = 4 * hole + 1
        if child >= last:
            break
        least, least_key = child, keys[child]
        for other in range(child + 1, min(child + 4, last)):
            if keys[other] < least_key:
                least, least_key = other, keys[other]
        if least_key >= key:
            break
        keys[hole] = least_key
        nodes[hole] = nodes[least]
        hole = least
    keys[hole] = key
    nodes[hole] = node


@numba.njit(error_model="numpy", forceinline=True)
def _room(keys: FloatArray, nodes: IntArray, needed: int) -> tuple[FloatArray, IntArray]:
    """The heap's arrays, twice as long if `needed` entries do not fit."""
    if needed <= keys.size:
        return keys, nodes
    longer_keys = np.empty(2 * keys.size)
    longer_nodes = np.empty(2 * keys.size, dtype=np.int64)
    for i in range(keys.size):  # slices would take 2 s more to compile
        longer_keys[i] = keys[i]
        longer_nodes[i] = nodes[i]
    return longer_keys, longer_nodes


@numba.njit(cache=True, error_model="numpy")
def search_grid(
    shape: IntArray, corner: FloatArray, spacing: float, steps: IntArray,
    heights: FloatArray, legal: MaskArray, winds: FloatArray, estimates: FloatArray,
    performance: Performance, setting: Setting,
    seeds: IntArray, seed_costs: FloatArray, seed_keys: FloatArray, targets: IntArray, target_costs: FloatArray,
) -> tuple[IntArray, float, int, FloatArray]:  # fmt: skip
    """A* on a grid of layers, rows (to the north) and columns (to the east).

    `shape` layers, rows, columns; `corner` east and north of the first node [m]; `steps` (2 m, 3) moves in layers,
    rows, columns, where step k + m undoes step k; `heights` (nodes,) [m]; `legal` (nodes,) bit k of a node: its step
    k < m is an edge; `winds` (nodes, 3) [m/s]; `estimates` (nodes,) in place of `remaining`, or empty. The search
    begins at `seeds` with their costs and keys (cost and estimate), and ends with the cheapest of `targets` plus its
    cost.

    Returns the nodes from seed to target (empty: none reached), the cost, how many nodes were expanded, and the cost of
    every node reached (infinite elsewhere).
    """
    layers, rows, columns = shape[0], shape[1], shape[2]
    half = steps.shape[0] // 2
    n = heights.size
    jumps = np.empty(2 * half, dtype=np.int64)
    reach = 0  # of the longest step, in rows or columns
    tracks = np.zeros((2 * half, 3))  # level length, unit track east and north
    for k in range(2 * half):
        up, north, east = steps[k, 0], steps[k, 1], steps[k, 2]
        reach = max(reach, abs(north), abs(east))
        jumps[k] = (up * rows + north) * columns + east
        cells = math.sqrt(north * north + east * east)
        if cells > 0.0:
            tracks[k, 0], tracks[k, 1], tracks[k, 2] = cells * spacing, east / cells, north / cells
    reached = np.empty(n)
    came_by = np.empty(n, dtype=np.int8)
    for node in range(n):
        reached[node] = math.inf
        came_by[node] = -1
    closed = np.zeros(n, dtype=np.uint8)  # 1: expanded, 2: a target
    keys = np.empty(max(1024, 4 * seeds.size))
    nodes = np.empty(keys.size, dtype=np.int64)
    size = 0
    for i in range(targets.size):
        closed[targets[i]] |= 2
    for i in range(seeds.size):
        node = seeds[i]
        if seed_costs[i] < reached[node]:
            reached[node] = seed_costs[i]
            _push(keys, nodes, size, seed_keys[i], node)
            size += 1
    best, arrival, expanded = math.inf, -1, 0
    while size > 0:
        key, node = keys[0], nodes[0]
        if key >= best:
            break
        _pop(keys, nodes, size)
        size -= 1
        if closed[node] & 1:
            continue
        if closed[node] & 2:
            for i in range(targets.size):
                if targets[i] == node and reached[node] + target_costs[i] < best:
                    best = reached[node] + target_costs[i]
                    arrival = node
        closed[node] |= 1
        expanded += 1
        layer, row, column = node // (rows * columns), (node // columns) % rows, node % columns
        ae, an, au = winds[node, 0], winds[node, 1], winds[node, 2]
        keys, nodes = _room(keys, nodes, size + 2 * half)
        inside = layers == 1 and reach <= row < rows - reach and reach <= column < columns - reach
        for k in range(2 * half):
            to_layer, to_row, to_column = layer + steps[k, 0], row + steps[k, 1], column + steps[k, 2]
            if not inside:
                if to_layer < 0 or to_layer >= layers or to_row < 0 or to_row >= rows:
                    continue
                if to_column < 0 or to_column >= columns:
                    continue
            to = node + jumps[k]
            if closed[to] & 1:
                continue
            mask = legal[node] >> k if k < half else legal[to] >> (k - half)
            if mask & 1 == 0:
                continue
            cost = reached[node] + edge_cost(
                performance, setting, tracks[k, 0], tracks[k, 1], tracks[k, 2], heights[to] - heights[node],
                ae, an, au, winds[to, 0], winds[to, 1], winds[to, 2],
            )  # fmt: skip
            if cost < reached[to]:
                reached[to] = cost
                came_by[to] = k
                if estimates.size > 0:
                    ahead = estimates[to]
                else:
                    ahead = remaining(
                        performance,
                        setting,
                        corner[0] + to_column * spacing,
                        corner[1] + to_row * spacing,
                        heights[to],
                    )
                _push(keys, nodes, size, cost + ahead, to)
                size += 1
    count = 0
    node = arrival
    while node >= 0:
        count += 1
        k = came_by[node]
        node = -1 if k < 0 else node - jumps[k]
    path = np.empty(count, dtype=np.int64)
    node = arrival
    for i in range(count):
        path[count - 1 - i] = node
        k = came_by[node]
        if k >= 0:
            node -= jumps[k]
    return path, best, expanded, reached


@numba.njit(cache=True, error_model="numpy")
def search_csr(
    first: IntArray, neighbours: IntArray, points: FloatArray, winds: FloatArray, estimates: FloatArray,
    performance: Performance, setting: Setting, start: int, goal: int,
) -> tuple[IntArray, float, int, FloatArray]:  # fmt: skip
    """A* on a graph whose node i has the neighbours first[i] .. first[i + 1] - 1.

    `points` (nodes, 3) [m], `winds` (nodes, 3) [m/s], `estimates` (nodes,) in place of `remaining`, or empty. Returns
    as `search_grid` does.
    """
    n = points.shape[0]
    reached = np.empty(n)
    came_from = np.empty(n, dtype=np.int64)
    for node in range(n):
        reached[node] = math.inf
        came_from[node] = -1
    closed = np.zeros(n, dtype=np.uint8)
    keys = np.empty(1024)
    nodes = np.empty(1024, dtype=np.int64)
    reached[start] = 0.0
    _push(keys, nodes, 0, 0.0, start)
    size, expanded = 1, 0
    while size > 0:
        node = nodes[0]
        _pop(keys, nodes, size)
        size -= 1
        if closed[node]:
            continue
        closed[node] = 1
        expanded += 1
        if node == goal:
            break
        keys, nodes = _room(keys, nodes, size + first[node + 1] - first[node])
        for k in range(first[node], first[node + 1]):
            to = neighbours[k]
            if closed[to]:
                continue
            cost = reached[node] + edge_between(
                performance, setting,
                points[to, 0] - points[node, 0], points[to, 1] - points[node, 1], points[to, 2] - points[node, 2],
                winds[node, 0], winds[node, 1], winds[node, 2], winds[to, 0], winds[to, 1], winds[to, 2],
            )  # fmt: skip
            if cost < reached[to]:
                reached[to] = cost
                came_from[to] = node
                if estimates.size > 0:
                    ahead = estimates[to]
                else:
                    ahead = remaining(performance, setting, points[to, 0], points[to, 1], points[to, 2])
                _push(keys, nodes, size, cost + ahead, to)
                size += 1
    count = 0
    if closed[goal]:
        node = goal
        while node >= 0:
            count += 1
            node = came_from[node]
    path = np.empty(count, dtype=np.int64)
    node = goal
    for i in range(count):
        path[count - 1 - i] = node
        node = came_from[node]
    return path, reached[goal], expanded, reached
