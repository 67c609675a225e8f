"""One route: search and shape each section between two sites, one after the other in time, then choose airspeeds."""

from __future__ import annotations

import math
import time
from collections.abc import Callable
from dataclasses import dataclass
from itertools import pairwise
from typing import Final, NoReturn

import numpy as np

from gcs_windplan.arrays import FloatArray
from gcs_windplan.errors import NoRouteError
from gcs_windplan.flight import fly
from gcs_windplan.planning.airspeeds import best_airspeeds
from gcs_windplan.planning.cost import CostChoice, SectionCost
from gcs_windplan.planning.limits import strongest_along
from gcs_windplan.planning.problem import PlanningProblem
from gcs_windplan.planning.search import find_open_path
from gcs_windplan.planning.shaping import shape
from gcs_windplan.progress import UNTRACKED, Tracker
from gcs_windplan.scene import Clearance

#: [s] what a multicopter loses at a slight corner: over rough ground ArduCopter was quickest, by its own law, when
#: waypoints that gain less were left out (0.5 and 1 s were alike, 0 and 2 s half a percent and more slower).
_CORNER: Final = 0.7
_SHORT_LEG: Final = 1.0  # [m] legs so short are none: half of ArduCopter's default waypoint radius


@dataclass(slots=True, eq=False)
class FoundRoute:
    """A route: its points (n, 3), when it arrives [s since departure], what it costs, and what finding it took.

    `airspeeds` (n - 1,) [m/s] of the legs where they are chosen, None where all are flown at the vehicle's.
    """

    points: FloatArray
    arrival: float
    cost: float = 0.0
    graph_cost: float = 0.0
    vertices: int = 1
    expanded: int = 0
    deferred: int = 0
    search_seconds: float = 0.0
    shaping_seconds: float = 0.0
    airspeeds: FloatArray | None = None


def find_route(
    problem: PlanningProblem,
    choice: CostChoice,
    begin: float,
    *,
    shaping: Callable[..., FloatArray] = shape,
    cost_index: float = math.inf,
    tracker: Tracker = UNTRACKED,
) -> FoundRoute:
    """The route by a cost that begins at `begin` [s since departure]. Raises `NoRouteError`.

    By `time` a finite `cost_index` [W] weighs seconds against energy; all other costs ignore it.
    """
    found = FoundRoute(problem.sites[:1], begin)
    sections = len(problem.sites) - 1
    for section, (start, goal) in enumerate(pairwise(problem.sites)):
        tracker.at(f"searching by {choice.name}", section, sections)
        cost = cost_between(problem, choice, start, goal, found.arrival, cost_index=cost_index)
        path = find_open_path(problem.graph, cost, start, goal, found.arrival)
        tracker.at(f"shaping the route by {choice.name}", section, sections)
        since = time.perf_counter()
        shaped = shaping(path.points, cost, problem.rules)
        found.shaping_seconds += time.perf_counter() - since
        found.search_seconds += path.seconds
        found.expanded += path.expanded
        found.deferred += path.deferred
        found.vertices += len(path.points) - 1
        prices, times = cost.with_spare(0.0).priced(shaped)
        found.cost += float(np.sum(prices))
        found.graph_cost += cost.of_polyline(path.points)
        found.points = np.concatenate([found.points, shaped[1:]])
        if not np.isfinite(times[-1]):
            _refuse(problem, found.points, begin)
        found.arrival = float(times[-1])
    found.points = _merge_short_legs(found.points, problem.rules)
    found.airspeeds = _airspeeds(problem, choice, found.points, begin, cost_index)
    return found


def cost_between(
    problem: PlanningProblem,
    choice: CostChoice,
    start: FloatArray,
    goal: FloatArray,
    begin: float,
    *,
    cost_index: float = math.inf,
) -> SectionCost:
    """The cost at work between two sites, the first of which is left at `begin` [s since departure]."""
    request, scene = problem.request, problem.request.scene
    straight = float(np.linalg.norm(goal - start))
    edge = problem.graph.veil.edge_length
    power = choice.leg_cost.power(problem.power, cost_index)
    return SectionCost(
        choice, scene.wind, problem.vehicle, edge, straight, begin, scene.members, request.robust, power=power,
        waypoint_seconds=_CORNER if request.vehicle.hovers else 0.0, limits=problem.graph.limits,
    )  # fmt: skip


def unshaped(points: FloatArray, cost: SectionCost, rules: Clearance) -> FloatArray:
    """The graph's path as it is: a shaping that shapes nothing."""
    return points


def _merge_short_legs(points: FloatArray, rules: Clearance) -> FloatArray:
    """The polyline (n, 3) without one end of each leg shorter than a metre, where the legs that are left stay clear.

    Shaping leaves such legs at vias that stand just at the clearance. A via is passed at less than a metre then, which
    is half of an autopilot's acceptance radius.
    """
    i = 1
    while i < len(points) - 2:
        if np.linalg.norm(points[i + 1] - points[i]) < _SHORT_LEG:
            for gone in (i, i + 1):
                left = np.delete(points, gone, axis=0)
                around = slice(gone - 1, gone), slice(gone, gone + 1)
                if not rules.breaches(left[around[0]], left[around[1]])[0]:
                    points = left
                    break
        i += 1
    return points


def _airspeeds(
    problem: PlanningProblem, choice: CostChoice, points: FloatArray, begin: float, cost_index: float
) -> FloatArray | None:
    """The airspeed of each leg where it is free: the fastest for least time alone, else the cheapest."""
    request = problem.request
    if not request.free_airspeed or request.airframe is None or problem.power is None:
        return None
    slowest, fastest = float(problem.power.airspeeds[0]), float(problem.power.airspeeds[-1])
    value = choice.leg_cost.value_of_time(cost_index)
    if math.isinf(value):
        return np.full(len(points) - 1, fastest)
    return best_airspeeds(
        points,
        request.scene.wind,
        request.vehicle,
        request.airframe.power,
        (slowest, fastest),
        begin=begin,
        cost_index=value,
    )


def _refuse(problem: PlanningProblem, points: FloatArray, begin: float) -> NoReturn:
    """Raise `NoRouteError` for a route (n, 3) on which the wind, looked at closely, is worse than at the nodes."""
    request = problem.request
    if problem.graph.limits:
        strongest_along(request, points, begin).check_limits(request.limits, request.robust)
    fly(points, request.scene, problem.vehicle, begin)  # says on which leg, if on one
    raise NoRouteError(
        "the route found can be flown in the members' mean, but in too few of the members where their wind is looked at"
        " closely: a finer graph, more airspeed, another departure, or a lower `robust`.",
        {"wind": 1},
    )
