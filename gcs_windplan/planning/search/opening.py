"""Paths in air that a limit closes here and there: between two open nodes too.

The search looks at the wind at nodes only. An edge between two of them may lead through air that is too strong: over a
dip, where it is higher above the ground, or past the corner of a jet. So the path that is found is looked at closely,
and where an edge of it is closed, so are all such edges around it; then the search begins anew.
"""

from __future__ import annotations

import time
from dataclasses import dataclass, replace
from typing import Final

import numpy as np

from gcs_windplan.arrays import BoolArray, FloatArray, IntArray
from gcs_windplan.errors import NoRouteError
from gcs_windplan.planning.cost import LegCost
from gcs_windplan.planning.search.astar import GraphPath, find_path
from gcs_windplan.planning.search.wind_graph import WindGraph
from gcs_windplan.planning.veil import GridVeil, without_legs, without_pairs
from gcs_windplan.wind.field import WindField
from gcs_windplan.wind.limited import LimitedWind, unlimited

_ROUNDS: Final = 100  # of searching anew
_AROUND: Final = 4.0  # edges, within which others are closed as well
_CLOSER: Final = 256  # times the wind's own sampling: as closely as a shaped route is looked at in the end
_FINER: Final = 4.0  # samples of another edge on the wind's own resolution
_FEWEST, _MOST = 5, 64  # samples of an edge


def find_open_path(
    graph: WindGraph, cost: LegCost, start: FloatArray, goal: FloatArray, clock: float = 0.0
) -> GraphPath:
    """`find_path` with every edge open along its whole length. Raises `NoRouteError`."""
    if not isinstance(cost.wind, LimitedWind):
        return find_path(graph, cost, start, goal, clock)
    free = replace(cost, wind=cost.wind.field, members=tuple(map(unlimited, cost.members)))
    air = _Air(cost, graph.veil.edge_length)
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
            graph = _closed_around(graph, air, path.points[leg : leg + 2], float(times[leg]))
        last = len(path.points) - 2
        if last == 0:
            break
        for end, node in ((0, 1), (last, last)):
            if end in closed:
                graph = _without_node(graph, path.points[node])
        seconds += time.perf_counter() - begin
    raise NoRouteError(
        f"wind limit ({cost.wind}): every path that was tried is closed between two nodes. A finer graph, lower layers,"
        " another departure, or a higher limit.",
        {"wind limit": 1},
    )


def _closed_legs(cost: LegCost, free: LegCost, points: FloatArray, times: FloatArray) -> IntArray:
    """The legs of a path (n, 3), passed at `times` (n,), that could be flown if there were no limits, and cannot."""
    spans = np.column_stack([times[:-1], times[1:]])
    when = spans if cost.changing and np.isfinite(times).all() else None
    bound, unbound = (one.closer(_CLOSER).of_legs(points[:-1], points[1:], when) for one in (cost, free))
    return np.flatnonzero(~np.isfinite(bound) & np.isfinite(unbound))


@dataclass(frozen=True, slots=True)
class _Air:
    """What judges edges of a veil, in the winds of a cost."""

    cost: LegCost
    edge_length: float

    def closed(self, starts: FloatArray, ends: FloatArray, begins: FloatArray | float) -> BoolArray:
        """Which legs (n, 3) that begin at `begins` [s since departure] are closed along them, in too many members."""
        winds: tuple[WindField, ...] = self.cost.members or (self.cost.wind,)
        share = np.linspace(0.0, 1.0, self._samples(winds))
        places = (starts[:, None] + share[None, :, None] * (ends - starts)[:, None]).reshape(-1, 3)
        lasting = np.linalg.norm(ends - starts, axis=1) / self.cost.vehicle.airspeed  # edges are short: near enough
        since = np.where(np.isfinite(begins), begins, self.cost.begin) * np.ones(len(starts))
        last = min((float(wind.times[-1]) for wind in winds if len(wind.times) > 1), default=np.inf)
        when = np.minimum(since[:, None] + share[None] * lasting[:, None], last)
        closed = np.zeros((len(winds), len(starts)), dtype=np.bool_)
        for member, wind in enumerate(winds):
            if isinstance(wind, LimitedWind):
                closed[member] = wind.closed(places, when.ravel()).reshape(when.shape).any(axis=1)
        many: BoolArray = closed.sum(axis=0) > len(winds) - 1 - self.cost.rank
        return many

    def _samples(self, winds: tuple[WindField, ...]) -> int:
        """How many samples an edge gets."""
        finest = min(wind.resolution for wind in winds)
        return int(np.clip(np.ceil(_FINER * self.edge_length / finest), _FEWEST, _MOST))


def _closed_around(graph: WindGraph, air: _Air, leg: FloatArray, begin: float) -> WindGraph:
    """The veil without a leg (2, 3) that begins at `begin` [s], and without edges around it that are closed then."""
    veil, middle = graph.veil, leg.mean(axis=0)
    reach = 0.5 * float(np.linalg.norm(leg[1] - leg[0])) + _AROUND * veil.edge_length

    def closed(starts: FloatArray, ends: FloatArray) -> BoolArray:
        itself = ((starts == leg[0]) & (ends == leg[1])) | ((starts == leg[1]) & (ends == leg[0]))
        shut: BoolArray = air.closed(starts, ends, begin) | itself.all(axis=1)
        return shut

    if isinstance(veil, GridVeil):
        return replace(graph, veil=without_legs(veil, veil.near(middle, reach), closed))
    near = np.flatnonzero(np.linalg.norm(veil.points[:, :2] - middle[:2], axis=1) <= reach)
    return replace(graph, veil=without_pairs(veil, near, closed))


def _without_node(graph: WindGraph, place: FloatArray) -> WindGraph:
    """The veil without the node at a place, to which the way from a site is closed; a roadmap's sites are nodes."""
    veil = graph.veil
    if not isinstance(veil, GridVeil):
        return graph
    node = np.nanargmin(np.linalg.norm(graph.points - place, axis=1))
    return replace(graph, closed=np.append(graph.closed, node))
