"""A planning problem: a request whose sites are placed, and the graph with the wind that all its routes share."""

from __future__ import annotations

import time
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from gcs_windplan.arrays import FloatArray
from gcs_windplan.errors import Problem, RequestError
from gcs_windplan.kernels.power import PowerGrid
from gcs_windplan.planning.limits import limits_broken_at_sites, wind_limits
from gcs_windplan.planning.request import Request, Roadmap
from gcs_windplan.planning.search import WindGraph, sample_wind
from gcs_windplan.planning.sites import (
    check_graph_size,
    choose_area,
    choose_layers,
    choose_nodes,
    choose_spacing,
    place_sites,
    too_many_or_equal,
    windless_sites,
)
from gcs_windplan.planning.veil import GridVeil, PrmVeil, lay_grid, lay_prm
from gcs_windplan.progress import CancelToken, ProgressCallback, Tracker
from gcs_windplan.scene import Clearance
from gcs_windplan.vehicle import Vehicle
from gcs_windplan.vehicle.power_grid import airspeed_choices, tabulate


@dataclass(frozen=True, slots=True, eq=False)
class PlanningProblem:
    """A request whose sites stand and whose veil is laid: all that routes by any cost, at any departure, share.

    `power` is there
    where the airframe is known, `mean_graph` with the members' mean where there is an ensemble. Threads may share it.
    """

    request: Request
    rules: Clearance
    sites: FloatArray
    graph: WindGraph
    seconds: float
    power: PowerGrid | None = None
    mean_graph: WindGraph | None = None

    def in_the_mean(self) -> PlanningProblem:
        """The same without the members of an ensemble: only their mean blows."""
        if self.mean_graph is None:
            return self
        return replace(self, request=self.request.in_the_mean(), graph=self.mean_graph, mean_graph=None)

    @property
    def vehicle(self) -> Vehicle:
        """The vehicle, at the largest airspeed if it is free to choose: so fast it goes where time is all."""
        request = self.request
        if not request.free_airspeed or request.airframe is None:
            return request.vehicle
        return replace(request.vehicle, airspeed=request.airframe.maximum_airspeed)


def pose_problem(
    request: Request, *, progress: ProgressCallback | None = None, cancel: CancelToken | None = None
) -> PlanningProblem:
    """Place the sites, lay the graph, and sample the wind at its nodes. Raises as `plan_route` does."""
    tracker = Tracker(progress, cancel)
    tracker.at("placing the sites")
    rules = Clearance(
        request.scene.terrain,
        request.clearance,
        np.inf if request.max_height is None else request.max_height,
        request.scene.obstacles,
        request.scene.airspace,
        request.collision_test,
    )
    layers = choose_layers(request)
    sites, problems = place_sites(request, rules, layers)
    problems = problems or windless_sites(request, sites) or limits_broken_at_sites(request, sites)
    problems = problems or too_many_or_equal(request, sites)
    if problems:
        raise RequestError([request.locate(problem) for problem in problems])
    begin = time.perf_counter()
    area = choose_area(request, sites)
    rules = replace(rules, area=area)
    veil = _lay_veil(request, rules, layers, sites, tracker)
    tracker.at("sampling the wind")
    graph = sample_wind(veil, request.scene.wind, request.scene.members, wind_limits(request))
    mean = request.in_the_mean()
    mean_graph = sample_wind(veil, mean.scene.wind, limits=wind_limits(mean)) if request.scene.members else None
    seconds = time.perf_counter() - begin
    return PlanningProblem(request, rules, sites, graph, seconds, power_of(request, graph, sites), mean_graph)


def power_of(request: Request, graph: WindGraph, sites: FloatArray) -> PowerGrid | None:
    """The vehicle's power between the lowest and the highest place of the veil; None where no airframe tells it.

    Raises `RequestError` where a cost or free airspeeds ask for it.
    """
    airframe = request.airframe
    if airframe is None:
        if request.cost.leg_cost.needs_power:
            problem = Problem(
                f"{request.cost} asks for the vehicle's power: name its airframe in vehicle.airframe", "cost"
            )
            raise RequestError([request.locate(problem)])
        return None
    if request.vehicle.speed_model == "paper" and (request.cost.leg_cost.needs_power or request.free_airspeed):
        problem = Problem("the paper's speed model has no airspeed to draw power at: `triangle`", "vehicle.speed_model")
        raise RequestError([request.locate(problem)])
    heights = np.concatenate([graph.points[:, 2], sites[:, 2]])
    between = float(np.nanmin(heights)), float(np.nanmax(heights))
    if request.free_airspeed:
        airspeeds = airspeed_choices(airframe, sum(between) / 2)
    else:
        airspeeds = np.array([request.vehicle.airspeed])
    return tabulate(airframe.power, request.vehicle, airspeeds, between)


def _lay_veil(
    request: Request, rules: Clearance, layers: Sequence[float], sites: FloatArray, tracker: Tracker
) -> GridVeil | PrmVeil:
    """The veil that the request asks for, over the area of the rules."""
    area = rules.area
    assert area is not None
    check_graph_size(request, area, layers)
    graph = request.graph
    if isinstance(graph, Roadmap):
        tracker.at("laying the graph")
        return lay_prm(rules, area, choose_nodes(request, area), graph.seed, layers, sites, graph.radius)
    return lay_grid(rules, area, choose_spacing(request, area), layers, graph.neighbours, tracker=tracker)
