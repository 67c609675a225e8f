"""A* on a veil: the best sequence of nodes for a cost, or the reason why there is none."""

from __future__ import annotations

import math
import time
from dataclasses import dataclass

import numpy as np

from gcs_windplan.arrays import BoolArray, FlagArray, FloatArray, IntArray
from gcs_windplan.errors import NoRouteError
from gcs_windplan.kernels.best_first import search_csr, search_grid
from gcs_windplan.kernels.edges import Setting, joins, remaining_at
from gcs_windplan.planning.cost import SectionCost
from gcs_windplan.planning.search.wind_graph import NodeWinds, WindGraph
from gcs_windplan.planning.veil import GridVeil, PrmVeil, breaches_around
from gcs_windplan.scene import BREACHES
from gcs_windplan.scene.clearance import AIRSPACE, OBSTACLE, OUTSIDE, TOO_HIGH, TOO_LOW, TOO_WINDY, UNKNOWN_GROUND

_JOIN = 2.0  # a site joins the grid's nodes within this many spacings
_LONG = 3.0  # times the straight way in still air: for so long the wind is sampled at first
_MOST_EXPLAINED = 200_000  # reached nodes whose legs are judged again to explain a failure
_CUT_BY_WIND = "wind (too strong for the vehicle, or not known that high)"
_ADVICE = {
    BREACHES[TOO_LOW]: "Lower the clearance, add higher layers or a finer graph, or widen graph.margin.",
    BREACHES[UNKNOWN_GROUND]: "Add terrain around the sites, or move them.",
    BREACHES[TOO_HIGH]: "Raise limits.max_height, lower the clearance, refine the graph, or widen graph.margin.",
    BREACHES[OBSTACLE]: "Move the site, lower the obstacle's margin, refine the graph or widen graph.margin.",
    BREACHES[OUTSIDE]: "Widen graph.margin.",
    BREACHES[AIRSPACE]: "Move the site, correct the areas, or widen graph.margin.",
    BREACHES[TOO_WINDY]: "A higher limit, another departure, other layers, or widen graph.margin.",
    _CUT_BY_WIND: "More airspeed, another departure, or other layers.",
}


@dataclass(frozen=True, slots=True, eq=False)
class GraphPath:
    """A path through the veil: its points (n, 3) with the sites at both ends, its cost, and what finding it took.

    `deferred` edges could not be flown when the search came to them, but can be later: waiting might pay.
    """

    points: FloatArray
    cost: float
    expanded: int
    seconds: float
    deferred: int = 0


def find_path(
    graph: WindGraph, cost: SectionCost, start: FloatArray, goal: FloatArray, clock: float = 0.0
) -> GraphPath:
    """The path from start to goal, (3,) each, that begins at `clock` [s since departure].

    Raises `NoRouteError` that says what cuts the goal off.
    """
    begin, ends = time.perf_counter(), np.stack([start, goal])
    find = _search_grid if isinstance(graph.veil, GridVeil) else _search_prm
    horizon = _LONG * float(np.linalg.norm(goal - start)) / cost.vehicle.airspeed
    while True:
        winds = graph.winds_between(clock, clock + horizon)
        found = find(graph, winds, cost, ends, clock)
        complete = len(found.points) > 0 and found.cost <= cost.least_in(horizon)
        reaches = winds.times is None or clock + horizon >= graph.ends
        if complete or reaches or found.outlasted == 0:
            break
        horizon *= 3
    seconds = time.perf_counter() - begin
    if len(found.points) == 0:
        reached = np.flatnonzero(np.isfinite(found.reached))
        raise no_route(graph, winds, reached, ends, cost, outlasted=found.outlasted > 0)
    return GraphPath(found.points, found.cost, found.expanded, seconds, found.deferred)


@dataclass(frozen=True, slots=True, eq=False)
class _Found:
    """What a kernel has found: a path (n, 3), its cost, the cost of each node reached, and what it counted."""

    points: FloatArray
    cost: float
    expanded: int
    reached: FloatArray
    outlasted: int
    deferred: int


def _search_grid(graph: WindGraph, node_winds: NodeWinds, cost: SectionCost, ends: FloatArray, clock: float) -> _Found:
    """A* on the grid; the sites are joined to the nodes around them."""
    veil = graph.veil
    assert isinstance(veil, GridVeil)
    start, goal = ends
    blows, times = node_winds.winds, node_winds.times
    air = graph.winds_at(ends, times)
    site_winds, goal_winds = (np.ascontiguousarray(air[..., i : i + 1, :]) for i in (0, 1))
    setting = cost.setting(goal, np.concatenate([blows, air], axis=-2))
    world = times, cost.rank, cost.scratch(), np.zeros(2, dtype=np.int64)
    performance, estimates = cost.performance(), _estimates(cost, graph.points, start, goal, setting)

    def leave(nodes: IntArray, winds: FloatArray, vectors: FloatArray) -> FloatArray:
        times, rank, each, tally = world
        return joins(
            performance, setting, cost.power, times, tally, rank, each, site_winds, winds, nodes, vectors,
            float(start[2]), clock,
        )  # fmt: skip

    near = _clear_nodes(graph, start)
    costs = leave(near, blows, graph.points[near] - start)
    flyable = np.isfinite(costs[:, 0])
    seeds, costs = near[flyable], costs[flyable]
    ahead = estimates[seeds] if len(estimates) else remaining_at(performance, setting, graph.points[seeds])
    nodes, total, expanded, reached = search_grid(
        np.array(veil.heights.shape, dtype=np.int64), veil.corner, veil.spacing, veil.steps,
        veil.heights.ravel(), veil.legal, blows, estimates, performance, setting, cost.power,
        seeds, costs[:, 0], costs[:, 0] + ahead, clock + costs[:, 1], _clear_nodes(graph, goal), goal_winds, *world,
    )  # fmt: skip
    direct = math.inf
    if np.linalg.norm(goal - start) <= _JOIN * veil.spacing and not veil.clearance.breaches(ends[:1], ends[1:])[0]:
        direct = float(leave(np.zeros(1, dtype=np.int64), goal_winds, (goal - start)[None])[0, 0])
    points = ends if direct <= total and math.isfinite(direct) else np.empty((0, 3))
    if len(nodes) and not len(points):
        points = np.concatenate([start[None], graph.points[nodes], goal[None]])
        points = points[np.append(True, np.linalg.norm(np.diff(points, axis=0), axis=1) > 0)]
    outlasted, deferred = (int(count) for count in world[3])
    return _Found(points, min(direct, total), expanded, reached, outlasted, deferred)


def _estimates(
    cost: SectionCost, points: FloatArray, start: FloatArray, goal: FloatArray, setting: Setting
) -> FloatArray:
    """The cost's estimates; none (0) where the wind on the way to the goal is not known."""
    estimates = cost.estimates(points, start, goal, setting)
    return np.where(np.isnan(estimates), 0.0, estimates)


def _clear_nodes(graph: WindGraph, site: FloatArray) -> IntArray:
    """The nodes around a site with a clear leg between the two."""
    veil = graph.veil
    assert isinstance(veil, GridVeil)
    nodes = np.setdiff1d(veil.near(site, _JOIN * veil.spacing), graph.closed)
    sites = np.broadcast_to(site, (len(nodes), 3))
    clear: IntArray = nodes[veil.clearance.breaches(sites, graph.points[nodes]) == 0]
    return clear


def _search_prm(graph: WindGraph, node_winds: NodeWinds, cost: SectionCost, ends: FloatArray, clock: float) -> _Found:
    """A* on the roadmap, in which the sites are nodes."""
    veil = graph.veil
    assert isinstance(veil, PrmVeil)
    start, goal = ends
    first, last = (int(np.argmin(np.linalg.norm(veil.points - site, axis=1))) for site in ends)
    tally = np.zeros(2, dtype=np.int64)
    setting = cost.setting(goal, node_winds.winds)
    nodes, total, expanded, reached = search_csr(
        veil.first, veil.neighbours, veil.points, node_winds.winds, _estimates(cost, veil.points, start, goal, setting),
        cost.performance(), setting, cost.power, first, last,
        node_winds.times, clock, cost.rank, cost.scratch(), tally,
    )  # fmt: skip
    return _Found(veil.points[nodes], total, expanded, reached, int(tally[0]), int(tally[1]))


def no_route(
    graph: WindGraph,
    winds: NodeWinds,
    reached: IntArray,
    ends: FloatArray,
    cost: SectionCost,
    *,
    outlasted: bool,
) -> NoRouteError:
    """The error that says what cuts the goal off: the legs from reached nodes to others, by what they break."""
    start, goal = ends
    veil = graph.veil
    if isinstance(veil, PrmVeil):
        led, flags = _prm_border(veil, reached)
    elif len(reached) == 0:
        around = veil.near(start, _JOIN * veil.spacing)
        led = around
        flags = veil.clearance.breaches(np.broadcast_to(start, (len(around), 3)), veil.points_of(around))
    else:
        led, flags = breaches_around(veil, reached[:: 1 + len(reached) // _MOST_EXPLAINED])
        if len(reached) == veil.size or not len(led):
            around = veil.near(goal, _JOIN * veil.spacing)
            flags = veil.clearance.breaches(veil.points_of(around), np.broadcast_to(goal, (len(around), 3)))
            led = np.full(len(around), -1)
    inner = np.isin(led, reached)
    flags = np.where((flags == 0) & _too_windy(graph, winds, led, goal, cost), TOO_WINDY, flags).astype(np.uint8)
    cuts = _count(flags[~inner] if not inner.all() else flags)
    if not cuts:
        text = "no node lies near enough: use a finer graph, more nodes or a larger radius"
        brief = f"the search reached {len(reached)} of {veil.size} nodes; {text}"
        return NoRouteError(f"no route: {brief}.", cuts, brief)
    limit = f"wind limit ({graph.limits})"
    told = {limit if name == BREACHES[TOO_WINDY] else name: count for name, count in cuts.items()}
    listed = "; ".join(f"{name}: {count} legs" for name, count in told.items())
    advice = _ADVICE[next(iter(cuts))]
    if outlasted:
        advice += " Some ways last longer than the forecast reaches: take a later end, or depart earlier."
    return NoRouteError(
        f"no route: the search reached {len(reached)} of {veil.size} nodes, blocked by {listed}. {advice}",
        cuts,
        "; ".join(f"{name}: {count} legs" for name, count in cuts.items()),
    )


def _too_windy(graph: WindGraph, winds: NodeWinds, nodes: IntArray, goal: FloatArray, cost: SectionCost) -> BoolArray:
    """Which nodes (-1: the goal) limits of wind close at some time, in more members than may be left out."""
    if not graph.limits:
        return np.zeros(len(nodes), dtype=np.bool_)
    there = graph.winds_at(goal[None], winds.times)
    shares = np.where(nodes < 0, there[..., 0:1, 3], winds.winds[..., np.maximum(nodes, 0), 3])
    closed = (shares > 1.0).reshape(len(graph.fields), -1, len(nodes))
    return cost.too_many(np.asarray(np.any(closed, axis=1)))


def _prm_border(veil: PrmVeil, reached: IntArray) -> tuple[IntArray, FlagArray]:
    """The roadmap's legs that leave the reached nodes: where they lead, what they break."""
    inside = np.zeros(veil.size, dtype=np.bool_)
    inside[reached] = True
    a, b = veil.pairs[:, 0], veil.pairs[:, 1]
    leaving = inside[a] != inside[b]
    return np.where(inside[a], b, a)[leaving], veil.flags[leaving]


def _count(flags: FlagArray) -> dict[str, int]:
    """How many legs break what, most first; a leg that is clear and yet not taken is blocked by the wind."""
    counts = {name: int(np.count_nonzero(flags & flag)) for flag, name in BREACHES.items()}
    counts[_CUT_BY_WIND] = int(np.count_nonzero(flags == 0))
    return {name: count for name, count in sorted(counts.items(), key=lambda item: -item[1]) if count}
