"""Flying one case: search the graph by each cost, and time the path by (13)."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np

from gcs_windplan.arrays import FloatArray
from gcs_windplan.flight.sampling import integrate
from gcs_windplan.paper.cases import PaperCase, lift_to_veil
from gcs_windplan.paper.published import COSTS, TIME
from gcs_windplan.planning.cost import CostChoice, SectionCost
from gcs_windplan.planning.search import WindGraph, find_path, sample_wind
from gcs_windplan.planning.shaping import shape
from gcs_windplan.planning.veil import PrmVeil
from gcs_windplan.scene import Clearance
from gcs_windplan.vehicle import Vehicle
from gcs_windplan.wind.field import WindField

SHAPED: Final = "time, shaped"


@dataclass(frozen=True, slots=True, eq=False)
class Route:
    """A route: its points (n, 3), its flight time [s], and what the search took: nodes expanded, seconds."""

    points: FloatArray
    seconds: float
    expanded: int
    search_seconds: float


def seconds_of(points: FloatArray, wind: WindField, vehicle: Vehicle) -> float:
    """The flight time (13) of a polyline (n, 3), the wind integrated along each leg [s]."""
    return float(np.sum(integrate(wind, vehicle, points[:-1], points[1:]).seconds))


def seconds_on_the_slope(points: FloatArray, wind: WindField, vehicle: Vehicle) -> float:
    """The same with each leg as long as its slope, as (13) has it, instead of as its plan [s]."""
    vectors = np.diff(points, axis=0)
    stretch = np.linalg.norm(vectors, axis=1) / np.hypot(vectors[:, 0], vectors[:, 1])
    return float(np.sum(stretch * integrate(wind, vehicle, points[:-1], points[1:]).seconds))


def sites_of(rules: Clearance, cases: Sequence[PaperCase]) -> FloatArray:
    """All starts and goals of some cases at the veil's height (n, 3), each once."""
    return lift_to_veil(rules, np.array(sorted({place for case in cases for place in (case.start, case.goal)})))


def find_route(graph: WindGraph, choice: CostChoice, case: PaperCase, vehicle: Vehicle) -> Route:
    """The graph's path of least cost, as the search returns it: the paper shapes nothing."""
    start, goal = lift_to_veil(graph.veil.clearance, np.array([case.start, case.goal]))
    cost = SectionCost(choice, case.wind, vehicle, graph.veil.edge_length, float(np.linalg.norm(goal - start)))
    path = find_path(graph, cost, start, goal)
    return Route(path.points, seconds_of(path.points, case.wind, vehicle), path.expanded, path.seconds)


def shape_route(route: Route, rules: Clearance, wind: WindField, vehicle: Vehicle) -> Route:
    """A route with its waypoints moved to where the wind wants them; never slower."""
    cost = SectionCost(TIME, wind, vehicle, 1.0, 1.0)
    points = shape(route.points, cost, rules)
    return Route(points, seconds_of(points, wind, vehicle), route.expanded, route.search_seconds)


def fly_case(
    case: PaperCase,
    veil: PrmVeil,
    vehicle: Vehicle,
    exact: Clearance | None = None,
    choices: Sequence[CostChoice] = COSTS,
) -> dict[str, Route]:
    """The routes of a case by the costs' names; with the rules `exact` also that of `time`, shaped."""
    graph = sample_wind(veil, case.wind)
    routes = {str(choice): find_route(graph, choice, case, vehicle) for choice in choices}
    if exact is not None:
        routes[SHAPED] = shape_route(routes[str(TIME)], exact, case.wind, vehicle)
    return routes
