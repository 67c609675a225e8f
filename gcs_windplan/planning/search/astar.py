"""A* on a veil: the best sequence of nodes for a cost, or the reason why there is none."""

from __future__ import annotations

import math
import time
from dataclasses import dataclass

import numpy as np

from gcs_windplan.arrays import BoolArray, FlagArray, FloatArray, IntArray
from gcs_windplan.errors import NoRouteError
from gcs_windplan.kernels.best_first import search_csr, search_grid
from gcs_windplan.kernels.edges import Setting, joins, remaining
from gcs_windplan.planning.cost import LegCost
from gcs_windplan.planning.search.windy import WindyVeil
from gcs_windplan.planning.veil import GridVeil, PrmVeil, breaches_around
from gcs_windplan.scene import BREACHES
from gcs_windplan.scene.clearance import AIRSPACE, OBSTACLE, OUTSIDE, TOO_HIGH, TOO_LOW, TOO_WINDY, UNKNOWN_GROUND
from gcs_windplan.wind.limited import LimitedWind

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


def find_path(windy: WindyVeil, cost: LegCost, start: FloatArray, goal: FloatArray, clock: float = 0.0) -> GraphPath:
    """The path from start to goal, (3,) each, that begins at `clock` [s since departure].

    Raises `NoRouteError` that says what cuts the goal off.
    """
    begin = time.perf_counter()
    find = _search_grid if isinstance(windy.veil, GridVeil) else _search_prm
    horizon = _LONG * float(np.linalg.norm(goal - start)) / cost.vehicle.airspeed
    while True:
        windy.cover(clock, clock + horizon)
        found = find(windy, cost, start, goal, clock)
        complete = len(found.points) > 0 and found.cost <= cost.least_in(horizon)
        reaches = windy.times is None or clock + horizon >= windy.ends
        if complete or reaches or found.outlasted == 0:
            break
        horizon *= 3
    seconds = time.perf_counter() - begin
    if len(found.points) == 0:
        reached = np.flatnonzero(np.isfinite(found.reached))
        raise no_route(windy, reached, start, goal, found.outlasted > 0, cost.rank)
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


def _search_grid(windy: WindyVeil, cost: LegCost, start: FloatArray, goal: FloatArray, clock: float) -> _Found:
    """A* on the grid; the sites are joined to the nodes around them."""
    veil = windy.veil
    assert isinstance(veil, GridVeil)
    ends = np.stack([start, goal])
    air = windy.at(ends)
    site_winds, goal_winds = (np.ascontiguousarray(air[..., i : i + 1, :]) for i in (0, 1))
    setting = cost.setting(goal, np.concatenate([windy.winds, air], axis=-2))
    world = windy.times, cost.rank, cost.scratch(), np.zeros(2, dtype=np.int64)
    performance, estimates = cost.performance(), _estimates(cost, windy.points, start, goal, setting)

    def leave(nodes: IntArray, winds: FloatArray, vectors: FloatArray) -> FloatArray:
        times, rank, each, tally = world
        return joins(
            performance, setting, cost.power, times, tally, rank, each, site_winds, winds, nodes, vectors,
            float(start[2]), clock,
        )  # fmt: skip

    near = _clear_nodes(windy, start)
    costs = leave(near, windy.winds, windy.points[near] - start)
    flyable = np.isfinite(costs[:, 0])
    seeds, costs = near[flyable], costs[flyable]
    if len(estimates):
        ahead = estimates[seeds]
    else:
        ahead = np.array([remaining(performance, setting, *windy.points[seed]) for seed in seeds], dtype=np.float64)
    nodes, total, expanded, reached = search_grid(
        np.array(veil.heights.shape, dtype=np.int64), veil.corner, veil.spacing, veil.steps,
        veil.heights.ravel(), veil.legal, windy.winds, estimates, performance, setting, cost.power,
        seeds, costs[:, 0], costs[:, 0] + ahead, clock + costs[:, 1], _clear_nodes(windy, goal), goal_winds, *world,
    )  # fmt: skip
    direct = math.inf
    if np.linalg.norm(goal - start) <= _JOIN * veil.spacing and not veil.clearance.breaches(ends[:1], ends[1:])[0]:
        direct = float(leave(np.zeros(1, dtype=np.int64), goal_winds, (goal - start)[None])[0, 0])
    points = ends if direct <= total and math.isfinite(direct) else np.empty((0, 3))
    if len(nodes) and not len(points):
        points = np.concatenate([start[None], windy.points[nodes], goal[None]])
        points = points[np.append(True, np.linalg.norm(np.diff(points, axis=0), axis=1) > 0)]
    outlasted, deferred = (int(count) for count in world[3])
    return _Found(points, min(direct, total), expanded, reached, outlasted, deferred)


def _estimates(cost: LegCost, points: FloatArray, start: FloatArray, goal: FloatArray, setting: Setting) -> FloatArray:
    """The cost's estimates; none (0) where the wind on the way to the goal is not known, or closed."""
    estimates = cost.estimates(points, start, goal, setting)
    return np.where(np.isnan(estimates), 0.0, estimates)


def _clear_nodes(windy: WindyVeil, site: FloatArray) -> IntArray:
    """The nodes around a site with a clear leg between the two."""
    veil = windy.veil
    assert isinstance(veil, GridVeil)
    nodes = veil.near(site, _JOIN * veil.spacing)
    sites = np.broadcast_to(site, (len(nodes), 3))
    clear: IntArray = nodes[veil.clearance.breaches(sites, windy.points[nodes]) == 0]
    return clear


def _search_prm(windy: WindyVeil, cost: LegCost, start: FloatArray, goal: FloatArray, clock: float) -> _Found:
    """A* on the roadmap, in which the sites are nodes."""
    veil = windy.veil
    assert isinstance(veil, PrmVeil)
    ends = [int(np.argmin(np.linalg.norm(veil.points - site, axis=1))) for site in (start, goal)]
    tally = np.zeros(2, dtype=np.int64)
    setting = cost.setting(goal, windy.winds)
    nodes, total, expanded, reached = search_csr(
        veil.first, veil.neighbours, veil.points, windy.winds, _estimates(cost, veil.points, start, goal, setting),
        cost.performance(), setting, cost.power, ends[0], ends[1],
        windy.times, clock, cost.rank, cost.scratch(), tally,
    )  # fmt: skip
    return _Found(veil.points[nodes], total, expanded, reached, int(tally[0]), int(tally[1]))


def no_route(
    windy: WindyVeil, reached: IntArray, start: FloatArray, goal: FloatArray, outlasted: bool = False, rank: int = 0
) -> NoRouteError:
    """The error that says what cuts the goal off: the legs from reached nodes to others, by what they break."""
    veil = windy.veil
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
    flags = np.where((flags == 0) & _too_windy(windy, led, goal, rank), TOO_WINDY, flags).astype(np.uint8)
    cuts = _count(flags[~inner] if not inner.all() else flags)
    if not cuts:
        text = "no node lies near enough: use a finer graph, more nodes or a larger radius"
        brief = f"the search reached {len(reached)} of {veil.size} nodes; {text}"
        return NoRouteError(f"no route: {brief}.", cuts, brief)
    limit = f"wind limit ({windy.fields[0]})"
    told = {limit if name == BREACHES[TOO_WINDY] else name: count for name, count in cuts.items()}
    listed = "; ".join(f"{name}: {count} legs" for name, count in told.items())
    advice = _ADVICE[next(iter(cuts))]
    if outlasted:
        advice += " Some ways last longer than the forecast reaches: take a later end, or depart earlier."
    return NoRouteError(
        f"no route: the search reached {len(reached)} of {veil.size} nodes, and what leads on is cut by {listed}."
        f" {advice}",
        cuts,
        "; ".join(f"{name}: {count} legs" for name, count in cuts.items()),
    )


def _too_windy(windy: WindyVeil, nodes: IntArray, goal: FloatArray, rank: int) -> BoolArray:
    """Which nodes (-1: the goal) limits of wind close at some time, in more members than may be left out."""
    closed = np.zeros((len(windy.fields), len(nodes)), dtype=np.bool_)
    places = np.where(nodes[:, None] < 0, goal, windy.points[nodes])
    known = np.isfinite(places).all(axis=1)
    for member, wind in enumerate(windy.fields):
        if isinstance(wind, LimitedWind):
            for moment in np.zeros(1) if windy.times is None else windy.times:
                closed[member, known] |= wind.closed(places[known], float(moment))
    many: BoolArray = closed.sum(axis=0) > len(windy.fields) - 1 - rank
    return many


def _prm_border(veil: PrmVeil, reached: IntArray) -> tuple[IntArray, FlagArray]:
    """The roadmap's legs that leave the reached nodes: where they lead, what they break."""
    inside = np.zeros(veil.size, dtype=np.bool_)
    inside[reached] = True
    a, b = veil.pairs[:, 0], veil.pairs[:, 1]
    leaving = inside[a] != inside[b]
    return np.where(inside[a], b, a)[leaving], veil.flags[leaving]


def _count(flags: FlagArray) -> dict[str, int]:
    """How many legs break what, most first; a leg that is clear and yet not taken is cut by the wind."""
    counts = {name: int(np.count_nonzero(flags & flag)) for flag, name in BREACHES.items()}
    counts[_CUT_BY_WIND] = int(np.count_nonzero(flags == 0))
    return {name: count for name, count in sorted(counts.items(), key=lambda item: -item[1]) if count}
