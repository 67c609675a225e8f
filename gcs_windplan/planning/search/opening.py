"""Paths in air that a limit of wind closes here and there: between two open nodes too.

The search looks at the wind at nodes only. An edge between two of them may lead through air that is too strong: over a
dip, where it is higher above the ground, or past the corner of a jet. So the path that is found is looked at closely,
and where an edge of it is closed, so are all such edges around it; then the search begins anew.
"""

from __future__ import annotations

import time
from dataclasses import replace
from typing import Final

import numpy as np

from gcs_windplan.arrays import BoolArray, FloatArray, IntArray
from gcs_windplan.errors import NoRouteError
from gcs_windplan.flight.wind_limits import NO_LIMITS
from gcs_windplan.planning.cost import SectionCost
from gcs_windplan.planning.search.astar import GraphPath, find_path
from gcs_windplan.planning.search.wind_graph import WindGraph
from gcs_windplan.planning.veil import GridVeil, without_legs, without_pairs

_ROUNDS: Final = 100  # of searching anew
_AROUND: Final = 4.0  # edges, within which others are closed as well
_CLOSER: Final = 256  # times the wind's own sampling: as closely as a shaped route is looked at in the end
_FINER: Final = 4.0  # samples of another edge on the wind's own resolution
_FEWEST, _MOST = 5, 64  # samples of an edge


def find_open_path(
    graph: WindGraph, cost: SectionCost, start: FloatArray, goal: FloatArray, clock: float = 0.0
) -> GraphPath:
    """`find_path` with every edge within the limits along its whole length. Raises `NoRouteError`."""
    if not cost.limits:
        return find_path(graph, cost, start, goal, clock)
    free = replace(cost, limits=NO_LIMITS)
    expanded, seconds = 0, 0.0
    for _ in range(_ROUNDS):
        path = find_path(graph, cost, start, goal, clock)
        expanded, seconds = expanded + path.expanded, seconds + path.seconds
        times = free.priced(path.points)[1]
        closed = _closed_legs(cost, free, path.points, times)
        if not len(closed):
            return replace(path, expanded=expanded, seconds=seconds)
        begin = time.perf_counter()
        for leg in closed:
            graph = _without_leg(graph, cost, path.points[leg : leg + 2], float(times[leg]))
        last = len(path.points) - 2
        if last == 0:
            break
        nodes = [path.points[node] for end, node in ((0, 1), (last, last)) if end in closed]
        graph = _without_joins(graph, nodes)
        seconds += time.perf_counter() - begin
    raise NoRouteError(
        f"wind limit ({cost.limits}): every path that was tried is closed between two nodes. A finer graph, lower"
        " layers, another departure, or a higher limit.",
        {"wind limit": 1},
    )


def _closed_legs(cost: SectionCost, free: SectionCost, points: FloatArray, times: FloatArray) -> IntArray:
    """The legs of a path (n, 3), passed at `times` (n,), that could be flown if there were no limits, and cannot."""
    spans = np.column_stack([times[:-1], times[1:]])
    when = spans if cost.changing and np.isfinite(times).all() else None
    bound, unbound = (one.closer(_CLOSER).of_legs(points[:-1], points[1:], when) for one in (cost, free))
    return np.flatnonzero(~np.isfinite(bound) & np.isfinite(unbound))


def _edges_closed(cost: SectionCost, starts: FloatArray, ends: FloatArray, begin: float) -> BoolArray:
    """Which edges (n, 3) that begin at a moment [s since departure] are closed along them, in too many members."""
    winds = cost.members or (cost.wind,)
    edge = float(np.linalg.norm(ends - starts, axis=1).max(initial=0.0))
    finest = min(cost.limits.resolution_beside(wind, k) for k, wind in enumerate(winds))
    share = np.linspace(0.0, 1.0, int(np.clip(np.ceil(_FINER * edge / finest), _FEWEST, _MOST)))
    places = (starts[:, None] + share[None, :, None] * (ends - starts)[:, None]).reshape(-1, 3)
    lasting = np.linalg.norm(ends - starts, axis=1) / cost.vehicle.airspeed  # edges are short: near enough
    last = min((float(wind.times[-1]) for wind in winds if len(wind.times) > 1), default=np.inf)
    since = begin if np.isfinite(begin) else cost.begin
    when = np.minimum(since + share[None] * lasting[:, None], last)
    closed = np.zeros((len(winds), len(starts)), dtype=np.bool_)
    for k, wind in enumerate(winds):
        shares = cost.limits.shares(k, wind.at(places, when.ravel()), places, when.ravel())
        closed[k] = (shares > 1.0).reshape(when.shape).any(axis=1)
    return cost.too_many(closed)


def _without_leg(graph: WindGraph, cost: SectionCost, leg: FloatArray, begin: float) -> WindGraph:
    """The graph without a leg (2, 3) that begins at `begin` [s], and without edges around it that are closed then."""
    veil, middle = graph.veil, leg.mean(axis=0)
    reach = 0.5 * float(np.linalg.norm(leg[1] - leg[0])) + _AROUND * veil.edge_length

    def closed(starts: FloatArray, ends: FloatArray) -> BoolArray:
        itself = ((starts == leg[0]) & (ends == leg[1])) | ((starts == leg[1]) & (ends == leg[0]))
        shut: BoolArray = _edges_closed(cost, starts, ends, begin) | itself.all(axis=1)
        return shut

    if isinstance(veil, GridVeil):
        return replace(graph, veil=without_legs(veil, veil.near(middle, reach), closed))
    near = np.flatnonzero(np.linalg.norm(veil.points[:, :2] - middle[:2], axis=1) <= reach)
    return replace(graph, veil=without_pairs(veil, near, closed))


def _without_joins(graph: WindGraph, places: list[FloatArray]) -> WindGraph:
    """The grid whose nodes at some places no site joins; a roadmap's sites are nodes themselves."""
    if not isinstance(graph.veil, GridVeil):
        return graph
    nodes = [int(np.nanargmin(np.linalg.norm(graph.points - place, axis=1))) for place in places]
    return replace(graph, closed=np.append(graph.closed, nodes).astype(np.int64))
