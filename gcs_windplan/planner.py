"""The planner: the one place where terrain, wind, vehicle, veil, cost, search and shaping meet.

request ─▶ sites ─▶ veil ─▶ wind at its nodes ─▶ A* ─▶ shaping ─▶ flight ─▶ Plan
"""

from __future__ import annotations

import time
from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np

from gcs_windplan.arrays import FloatArray
from gcs_windplan.cost import CostChoice, LegCost
from gcs_windplan.errors import RequestError
from gcs_windplan.flight import Flight, Leg, Totals, Waypoint, clock, fly
from gcs_windplan.request import Request, Roadmap
from gcs_windplan.search import WindyVeil, blow, find_path
from gcs_windplan.shaping import shape
from gcs_windplan.siting import (
    choose_area,
    choose_layers,
    choose_nodes,
    choose_spacing,
    refuse_unwieldy,
    stand_sites,
    windless_sites,
)
from gcs_windplan.terrain import Extent
from gcs_windplan.veil import Clearance, GridVeil, PrmVeil, lay_grid, lay_prm


@dataclass(frozen=True, slots=True)
class Effort:
    """What finding the route took: nodes in the veil, nodes expanded, vertices of the graph's path, seconds."""

    nodes: int
    expanded: int
    vertices: int
    veil_seconds: float
    search_seconds: float
    shaping_seconds: float


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class Plan:
    """A route for a request: the polyline, its flight, and what it cost to find.

    `cost` is the route's cost by the chosen measure, `graph_cost` that of the graph's path before shaping; `notes` say
    what a pilot must know before flying it.
    """

    request: Request
    choice: CostChoice
    flight: Flight
    cost: float
    graph_cost: float
    effort: Effort
    notes: tuple[str, ...] = ()

    @property
    def waypoints(self) -> tuple[Waypoint, ...]:
        """The route's corners, from over the start to over the goal."""
        return self.flight.waypoints

    @property
    def legs(self) -> tuple[Leg, ...]:
        """The legs between them."""
        return self.flight.legs

    @property
    def totals(self) -> Totals:
        """Time, length, clearance of the whole route."""
        return self.flight.totals

    def __repr__(self) -> str:
        return (
            f"Plan({self.request.name!r}, {self.choice}: {len(self.waypoints)} waypoints,"
            f" {self.totals.length / 1000:.2f} km in {clock(self.totals.seconds)} min,"
            f" clearance {self.totals.clearance:.1f} m)"
        )


def plan_route(request: Request) -> Plan:
    """Plan the request's route by its own cost.

    Raises `RequestError` where sites and limits contradict each other (all such problems at once), `WindError` or
    `TerrainError` where the data do not cover the place, and `NoRouteError` where no route exists.
    """
    return plan_routes(request, [request.cost])[0]


def plan_routes(request: Request, choices: Sequence[CostChoice]) -> list[Plan]:
    """Plan the request's route once for each cost, on one and the same veil."""
    rules = Clearance(
        request.terrain,
        request.clearance,
        np.inf if request.max_height is None else request.max_height,
        request.obstacles,
        request.airspace,
        request.collision_test,
    )
    layers = choose_layers(request)
    sites, problems = stand_sites(request, rules, layers)
    problems = problems or windless_sites(request, sites)
    if problems:
        raise RequestError([request.locate(problem) for problem in problems])
    begin = time.perf_counter()
    area = choose_area(request, sites)
    rules = replace(rules, area=area)
    windy = blow(_lay_veil(request, rules, layers, sites, area), request.wind)
    veil_seconds = time.perf_counter() - begin
    return [_plan(request, choice, rules, windy, sites, veil_seconds) for choice in choices]


def _lay_veil(
    request: Request, rules: Clearance, layers: Sequence[float], sites: FloatArray, area: Extent
) -> GridVeil | PrmVeil:
    """The veil that the request asks for."""
    refuse_unwieldy(request, area, layers)
    graph = request.graph
    if isinstance(graph, Roadmap):
        return lay_prm(rules, area, choose_nodes(request, area), graph.seed, layers, sites, graph.radius)
    return lay_grid(rules, area, choose_spacing(request, area), layers, graph.neighbours)


def _plan(
    request: Request,
    choice: CostChoice,
    rules: Clearance,
    windy: WindyVeil,
    sites: FloatArray,
    veil_seconds: float,
) -> Plan:
    """Search and shape each section between two sites, then fly the whole."""
    route, vertices, expanded, total, graph_total = [sites[:1]], 1, 0, 0.0, 0.0
    search_seconds = shaping_seconds = 0.0
    for start, goal in pairwise(sites):
        straight = float(np.linalg.norm(goal - start))
        cost = LegCost(choice, request.wind, request.vehicle, windy.veil.edge_length, straight)
        path = find_path(windy, cost, start, goal)
        begin = time.perf_counter()
        shaped = shape(path.points, cost, rules)
        shaping_seconds += time.perf_counter() - begin
        search_seconds += path.seconds
        expanded += path.expanded
        vertices += len(path.points) - 1
        total += cost.of_polyline(shaped)
        graph_total += cost.of_polyline(path.points)
        route.append(shaped[1:])
    flight = fly(np.concatenate(route), request.frame, request.terrain, request.wind, request.vehicle)
    effort = Effort(windy.veil.size, expanded, vertices, veil_seconds, search_seconds, shaping_seconds)
    return Plan(request, choice, flight, total, graph_total, effort, _notes(request, windy))


def _notes(request: Request, windy: WindyVeil) -> tuple[str, ...]:
    """What a pilot must know: models that flatter, tests that miss, what the vehicle does not hold."""
    notes = []
    strongest = float(np.nanmax(np.hypot(windy.winds[:, 0], windy.winds[:, 1]), initial=0.0))
    if request.vehicle.speed_model == "paper":
        text = "the speed model `paper` counters cross wind for free: its times are some percent too short"
        if strongest > request.vehicle.airspeed / 2:
            text += f"; and in wind above half of the airspeed (here up to {strongest:.1f} m/s) zig-zag seems to pay"
        notes.append(f"{text}. Plan with `triangle` to fly.")
    if request.collision_test == "paper":
        notes.append("the collision test `paper` samples: a leg may pass through a thin ridge. Fly with `exact`.")
    lost = [f"'{area.name}'" for area in request.fence if area.heights_lost]
    if lost:
        text = f"the fence holds {', '.join(lost)} in plan only, without floor and ceiling"
        notes.append(f"{text}: set the vehicle's own limits of altitude.")
    if request.rally and request.finish == "return":
        notes.append("at the end the vehicle returns to the rally point nearest to it, or home if that is nearer.")
    return tuple(notes)
