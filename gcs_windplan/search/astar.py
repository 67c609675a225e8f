"""A* on a veil: the best sequence of nodes for a cost, or the reason why there is none."""

from __future__ import annotations

import math
import time
from dataclasses import dataclass

import numpy as np

from gcs_windplan.arrays import FlagArray, FloatArray, IntArray
from gcs_windplan.cores import spread
from gcs_windplan.cost import LegCost
from gcs_windplan.errors import NoRouteError
from gcs_windplan.kernels.best_first import Setting, edge_between, remaining, search_csr, search_grid
from gcs_windplan.veil import BREACHES, GridVeil, PrmVeil, breaches_around
from gcs_windplan.veil.clearance import AIRSPACE, OBSTACLE, OUTSIDE, TOO_HIGH, TOO_LOW, UNKNOWN_GROUND
from gcs_windplan.wind.field import WindField

_JOIN = 2.0  # a site joins the grid's nodes within this many spacings
_BATCH = 100_000  # nodes whose wind is sampled at a time
_MOST_EXPLAINED = 200_000  # reached nodes whose legs are judged again to explain a failure
_CUT_BY_WIND = "wind (too strong for the vehicle, or not known that high)"
_ADVICE = {
    BREACHES[TOO_LOW]: "Lower the clearance, add higher layers or a finer graph, or widen graph.margin.",
    BREACHES[UNKNOWN_GROUND]: "Add terrain around the sites, or move them.",
    BREACHES[TOO_HIGH]: "Raise max_height, lower the clearance, refine the graph, or widen graph.margin.",
    BREACHES[OBSTACLE]: "Move the site, lower the obstacle's margin, refine the graph or widen graph.margin.",
    BREACHES[OUTSIDE]: "Widen graph.margin.",
    BREACHES[AIRSPACE]: "Move the site, correct the areas, or widen graph.margin.",
    _CUT_BY_WIND: "More airspeed, another departure, or other layers.",
}


@dataclass(frozen=True, slots=True, eq=False)
class GraphPath:
    """A path through the veil: its points (n, 3) with the sites at both ends, its cost, and what finding it took."""

    points: FloatArray
    cost: float
    expanded: int
    seconds: float


@dataclass(frozen=True, slots=True, eq=False)
class WindyVeil:
    """A veil with the wind at its nodes: `points` and `winds` (n, 3) [m], [m/s]; no wind where the ground is
    unknown."""

    veil: GridVeil | PrmVeil
    points: FloatArray
    winds: FloatArray


def blow(veil: GridVeil | PrmVeil, wind: WindField) -> WindyVeil:
    """Sample the wind at all nodes of a veil."""
    points = veil.points
    winds = np.zeros_like(points)

    def sample(begin: int) -> None:
        part = slice(begin, begin + _BATCH)
        known = np.isfinite(points[part, 2])
        winds[part][known] = wind.at(points[part][known])

    for _ in spread(sample, range(0, len(points), _BATCH)):
        pass
    return WindyVeil(veil, points, winds)


def find_path(windy: WindyVeil, cost: LegCost, start: FloatArray, goal: FloatArray) -> GraphPath:
    """The path from start to goal, (3,) each. Raises `NoRouteError` that says what cuts the goal off."""
    begin = time.perf_counter()
    found = _search_grid if isinstance(windy.veil, GridVeil) else _search_prm
    points, total, expanded, reached = found(windy, cost, start, goal)
    seconds = time.perf_counter() - begin
    if len(points) == 0:
        raise no_route(windy.veil, np.flatnonzero(np.isfinite(reached)), start, goal)
    return GraphPath(points, total, expanded, seconds)


def _search_grid(
    windy: WindyVeil, cost: LegCost, start: FloatArray, goal: FloatArray
) -> tuple[FloatArray, float, int, FloatArray]:
    """A* on the grid; the sites are joined to the nodes around them."""
    veil = windy.veil
    assert isinstance(veil, GridVeil)
    ends = np.stack([start, goal])
    air = cost.wind.at(ends)
    setting = cost.setting(goal, np.concatenate([windy.winds, air]))
    seeds, seed_costs = _joins(windy, cost, setting, start, air[0], outward=True)
    targets, target_costs = _joins(windy, cost, setting, goal, air[1], outward=False)
    performance, estimates = cost.performance(), cost.estimates(windy.points, goal)
    if len(estimates):
        ahead = estimates[seeds]
    else:
        ahead = np.array([remaining(performance, setting, *windy.points[seed]) for seed in seeds], dtype=np.float64)
    nodes, total, expanded, reached = search_grid(
        np.array(veil.heights.shape, dtype=np.int64), veil.corner, veil.spacing, veil.steps,
        veil.heights.ravel(), veil.legal, windy.winds, estimates,
        performance, setting, seeds, seed_costs, seed_costs + ahead, targets, target_costs,
    )  # fmt: skip
    direct = math.inf
    if np.linalg.norm(goal - start) <= _JOIN * veil.spacing and not veil.clearance.breaches(ends[:1], ends[1:])[0]:
        direct = edge_between(cost.performance(), setting, *(goal - start), *air[0], *air[1])
    if direct <= total and math.isfinite(direct):
        return ends, direct, expanded, reached
    if len(nodes) == 0:
        return np.empty((0, 3)), total, expanded, reached
    points = np.concatenate([start[None], windy.points[nodes], goal[None]])
    moved = np.append(True, np.linalg.norm(np.diff(points, axis=0), axis=1) > 0)
    return points[moved], total, expanded, reached


def _joins(
    windy: WindyVeil, cost: LegCost, setting: Setting, site: FloatArray, air: FloatArray, outward: bool
) -> tuple[IntArray, FloatArray]:
    """The nodes around a site with a clear, flyable leg from it (outward) or to it, and what that leg costs."""
    veil = windy.veil
    assert isinstance(veil, GridVeil)
    nodes = veil.near(site, _JOIN * veil.spacing)
    sites = np.broadcast_to(site, (len(nodes), 3))
    nodes = nodes[veil.clearance.breaches(sites, windy.points[nodes]) == 0]
    performance = cost.performance()
    costs = np.empty(len(nodes))
    for i, node in enumerate(nodes):
        there, blows = windy.points[node], windy.winds[node]
        if outward:
            costs[i] = edge_between(performance, setting, *(there - site), *air, *blows)
        else:
            costs[i] = edge_between(performance, setting, *(site - there), *blows, *air)
    flyable = np.isfinite(costs)
    return nodes[flyable], costs[flyable]


def _search_prm(
    windy: WindyVeil, cost: LegCost, start: FloatArray, goal: FloatArray
) -> tuple[FloatArray, float, int, FloatArray]:
    """A* on the roadmap, in which the sites are nodes."""
    veil = windy.veil
    assert isinstance(veil, PrmVeil)
    ends = [int(np.argmin(np.linalg.norm(veil.points - site, axis=1))) for site in (start, goal)]
    nodes, total, expanded, reached = search_csr(
        veil.first, veil.neighbours, veil.points, windy.winds, cost.estimates(veil.points, goal),
        cost.performance(), cost.setting(goal, windy.winds), ends[0], ends[1],
    )  # fmt: skip
    return veil.points[nodes], total, expanded, reached


def no_route(veil: GridVeil | PrmVeil, reached: IntArray, start: FloatArray, goal: FloatArray) -> NoRouteError:
    """The error that says what cuts the goal off: the legs from reached nodes to others, by what they break."""
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
    cuts = _count(flags[~inner] if not inner.all() else flags)
    if not cuts:
        text = "no node lies near enough: use a finer graph, more nodes or a larger radius"
        return NoRouteError(f"no route: the search reached {len(reached)} of {veil.size} nodes; {text}.", cuts)
    listed = "; ".join(f"{name}: {count} legs" for name, count in cuts.items())
    advice = _ADVICE[next(iter(cuts))]
    return NoRouteError(
        f"no route: the search reached {len(reached)} of {veil.size} nodes, and what leads on is cut by {listed}."
        f" {advice}",
        cuts,
    )


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
