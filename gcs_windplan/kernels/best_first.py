"""A* over an implicit grid and over a CSR graph; edge costs are worked out on the fly from the nodes' winds.

Both kernels are one textbook A* with a closed list and a binary heap with lazy deletion. With a consistent lower bound
that is optimal; with the paper's heuristics, which are none, it is what the paper runs. In changing wind a node's label
carries the time of arrival; least time is optimal there too, as long as who leaves later does not arrive earlier.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from gcs_windplan.arrays import FloatArray, IntArray, MaskArray
from gcs_windplan.kernels.compiled import compiled, inlined
from gcs_windplan.kernels.edges import Setting, remaining, travel, travel_between
from gcs_windplan.kernels.triangle import Performance, beyond_limit


@inlined
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


@inlined
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


@inlined
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


@compiled
def search_grid(
    shape: IntArray, corner: FloatArray, spacing: float, steps: IntArray,
    heights: FloatArray, legal: MaskArray, winds: FloatArray, estimates: FloatArray,
    performance: Performance, setting: Setting, grid: Any,
    seeds: IntArray, seed_costs: FloatArray, seed_keys: FloatArray, seed_clocks: FloatArray,
    targets: IntArray, goal_winds: FloatArray,
    times: FloatArray | None, rank: int, each: FloatArray | None, tally: IntArray,
) -> tuple[IntArray, float, int, FloatArray]:  # fmt: skip
    """A* on a grid of layers, rows (to the north) and columns (to the east).

    `shape` layers, rows, columns; `corner` east and north of the first node [m]; `steps` (2 m, 3) moves in layers,
    rows, columns, where step k + m undoes step k; `heights` (nodes,) [m]; `legal` (nodes,) bit k of a node: its step
    k < m is an edge; `winds`, `grid`, `times`, `rank`, `each` and `tally` as in `edges`; `estimates` (nodes,) in place
    of `remaining`, or empty. The search begins at `seeds` with their costs, keys (cost and estimate) and clocks [s],
    and ends with the cheapest of `targets` plus the edge from there to the goal, whose winds are shaped as a single
    node's.

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
    clocks = np.empty(0 if times is None else n)
    closed = np.zeros(n, dtype=np.uint8)  # 1: expanded, or beyond a limit; 2: a target
    if winds.ndim == 2 and winds.shape[1] > 3:
        for node in range(n):
            if beyond_limit(winds, node):
                closed[node] = 1
    keys = np.empty(max(1024, 4 * seeds.size))
    nodes = np.empty(keys.size, dtype=np.int64)
    size = 0
    for i in range(targets.size):
        closed[targets[i]] |= 2
    for i in range(seeds.size):
        node = seeds[i]
        if seed_costs[i] < reached[node]:
            reached[node] = seed_costs[i]
            if times is not None:
                clocks[node] = seed_clocks[i]
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
        clock = 0.0 if times is None else clocks[node]
        layer, row, column = node // (rows * columns), (node // columns) % rows, node % columns
        if closed[node] & 2:
            cost, _ = travel_between(
                performance, setting, grid, times, tally, rank, each, winds, node, goal_winds, 0,
                setting.goal_e - (corner[0] + column * spacing), setting.goal_n - (corner[1] + row * spacing),
                setting.goal_z - heights[node], heights[node], clock,
            )  # fmt: skip
            if reached[node] + cost < best:
                best = reached[node] + cost
                arrival = node
        closed[node] |= 1
        expanded += 1
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
            cost, seconds = travel(
                performance, setting, grid, times, tally, rank, each, winds, node, winds, to,
                tracks[k, 0], tracks[k, 1], tracks[k, 2], heights[to] - heights[node], heights[node], clock,
            )  # fmt: skip
            cost += reached[node]
            if cost < reached[to]:
                reached[to] = cost
                came_by[to] = k
                if times is not None:
                    clocks[to] = clock + seconds
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


@compiled
def search_csr(
    first: IntArray, neighbours: IntArray, points: FloatArray, winds: FloatArray, estimates: FloatArray,
    performance: Performance, setting: Setting, grid: Any, start: int, goal: int,
    times: FloatArray | None, begin: float, rank: int, each: FloatArray | None, tally: IntArray,
) -> tuple[IntArray, float, int, FloatArray]:  # fmt: skip
    """A* on a graph whose node i has the neighbours first[i] .. first[i + 1] - 1.

    `points` (nodes, 3) [m]; `winds`, `grid`, `times`, `rank`, `each` and `tally` as in `edges`, `begin` the clock at
    the start [s]; `estimates` (nodes,) in place of `remaining`, or empty. Returns as `search_grid` does.
    """
    n = points.shape[0]
    reached = np.empty(n)
    came_from = np.empty(n, dtype=np.int64)
    for node in range(n):
        reached[node] = math.inf
        came_from[node] = -1
    clocks = np.empty(0 if times is None else n)
    if times is not None:
        clocks[start] = begin
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
        clock = 0.0 if times is None else clocks[node]
        keys, nodes = _room(keys, nodes, size + first[node + 1] - first[node])
        for k in range(first[node], first[node + 1]):
            to = neighbours[k]
            if closed[to]:
                continue
            cost, seconds = travel_between(
                performance, setting, grid, times, tally, rank, each, winds, node, winds, to,
                points[to, 0] - points[node, 0], points[to, 1] - points[node, 1], points[to, 2] - points[node, 2],
                points[node, 2], clock,
            )  # fmt: skip
            cost += reached[node]
            if cost < reached[to]:
                reached[to] = cost
                came_from[to] = node
                if times is not None:
                    clocks[to] = clock + seconds
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
