"""From the graph's path to few waypoints: shortcuts along the line of sight.

The staircase of a grid is replaced by the cheapest polyline through a subset of its own vertices, found by dynamic
programming over all legs between two vertices of a window. A shortcut must be clear and flyable; each waypoint costs a
little extra, so that of two polylines about as good the one with fewer waypoints wins.
"""

from __future__ import annotations

import numpy as np

from gcs_windplan.arrays import FloatArray, IntArray
from gcs_windplan.planning.cost import SectionCost
from gcs_windplan.scene import Clearance

_MOST_LEGS = 8_000  # judged in one pass; the window narrows on long paths, and passes repeat
_PENALTY = 2e-4  # what a waypoint more must gain, as a share of the path's cost


def shorten(points: FloatArray, cost: SectionCost, clearance: Clearance) -> FloatArray:
    """The cheapest polyline through some of a path's vertices, shape (m, 3) with m at most the path's n.

    Never worse than the path in the chosen cost: if the penalty on waypoints would make it so, it is dropped.
    """
    limit = cost.of_polyline(points)
    if len(points) < 3 or not np.isfinite(limit):
        return points
    for penalty in (_PENALTY * limit, 0.0):
        shaped = points
        while True:
            kept = _best_subset(shaped, cost, clearance, penalty)
            if len(kept) == len(shaped):
                break
            shaped = shaped[kept]
        if cost.of_polyline(shaped) <= limit:
            return shaped
    return points


def _best_subset(points: FloatArray, cost: SectionCost, clearance: Clearance, penalty: float) -> IntArray:
    """The vertices of the cheapest polyline from first to last, each leg spanning at most a window of vertices."""
    n = len(points)
    window = max(2, min(n - 1, _MOST_LEGS // n))
    i, j = np.triu_indices(n, k=1)
    near = j - i <= window
    i, j = i[near], j[near]
    clear = (j - i == 1) | (clearance.breaches(points[i], points[j]) == 0)
    i, j = i[clear], j[clear]
    when = None
    if cost.changing:
        times = cost.priced(points)[1]
        when = np.column_stack([times[i], times[j]])
    legs = cost.of_legs(points[i], points[j], when) + penalty
    best = np.full(n, np.inf)
    best[0] = 0.0
    came_from = np.full(n, -1, dtype=np.int64)
    for k in np.argsort(i, kind="stable"):
        total = best[i[k]] + legs[k]
        if total < best[j[k]]:
            best[j[k]], came_from[j[k]] = total, i[k]
    kept = [n - 1]
    while kept[-1] > 0:
        kept.append(int(came_from[kept[-1]]))
    return np.array(kept[::-1])
