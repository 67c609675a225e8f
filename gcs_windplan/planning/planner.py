"""The planner: the one place where terrain, wind, vehicle, veil, cost, search and shaping meet.

request ─▶ sites ─▶ veil ─▶ wind at its nodes ─▶ A* ─▶ shaping ─▶ flight ─▶ Plan
"""

from __future__ import annotations

import math
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import partial

import numpy as np

from gcs_windplan.arrays import FloatArray
from gcs_windplan.errors import BatteryError, NoRouteError, RequestError, WindError
from gcs_windplan.flight import Flight, Leg, Totals, Waypoint, clock, fly
from gcs_windplan.planning.battery import BatteryUse, battery_use, refuse_overdrawn
from gcs_windplan.planning.budget import quickest_within
from gcs_windplan.planning.cost import CostChoice
from gcs_windplan.planning.ensemble import Spread, spread_of
from gcs_windplan.planning.limits import Strongest, limited, limits_broken_at_sites, strongest_along
from gcs_windplan.planning.order import put_in_order, too_many_or_equal
from gcs_windplan.planning.request import Request, Roadmap
from gcs_windplan.planning.returns import WaysHome, home_from_the_end, refuse_stranded, ways_home
from gcs_windplan.planning.route import FoundRoute, Ready, find_route, power_of, unshaped
from gcs_windplan.planning.search import WindyVeil, blow
from gcs_windplan.planning.shaping import shape, shape_quickly
from gcs_windplan.planning.sites import (
    choose_area,
    choose_layers,
    choose_nodes,
    choose_spacing,
    refuse_unwieldy,
    stand_sites,
    windless_sites,
)
from gcs_windplan.planning.veil import GridVeil, PrmVeil, lay_grid, lay_prm
from gcs_windplan.planning.waiting import until_it_opens, where_it_pays
from gcs_windplan.scene import Clearance
from gcs_windplan.terrain import Extent


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
class PlannedRoute:
    """A route for a request: the polyline, its flight, and what it cost to find.

    `cost` is the route's cost by the chosen measure, `graph_cost` that of the graph's path before shaping; `spread` is
    the same route in every member of an ensemble, where there is one (the flight itself is in their mean); `battery`
    and `ways_home` from each waypoint are known where the airframe is; `notes` say what a pilot must know before flying
    it; `strongest` wind and gust are known where there is a limit.
    """

    request: Request
    choice: CostChoice
    flight: Flight
    cost: float
    graph_cost: float
    effort: Effort
    spread: Spread | None = None
    battery: BatteryUse | None = None
    ways_home: WaysHome | None = None
    notes: tuple[str, ...] = ()
    strongest: Strongest | None = None

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
            f"{type(self).__name__}({self.request.name!r}, {self.choice}: {len(self.waypoints)} waypoints,"
            f" {self.totals.length / 1000:.2f} km in {clock(self.totals.seconds)} min,"
            f" clearance {self.totals.clearance:.1f} m)"
        )


def plan_route(request: Request) -> PlannedRoute:
    """Plan the request's route by its own cost.

    Raises `RequestError` where sites and limits contradict each other (all such problems at once), `WindError` or
    `TerrainError` where the data do not cover the place, `NoRouteError` where no route exists, and `BatteryError` where
    the best one breaks the battery's reserve, or leads to where the vehicle cannot come home from.
    """
    ready = prepare(request)
    plan = plan_ready(ready, request.cost)
    try:
        refuse_unsafe(plan)
    except BatteryError as error:
        raise BatteryError(f"{error}{_thriftier(ready)}") from error
    return plan


def refuse_unsafe(plan: PlannedRoute) -> None:
    """Raise `BatteryError` for a plan that its battery does not carry through, or not home."""
    refuse_overdrawn(plan.battery)
    wanted = plan.request.limits.way_home
    if wanted or (wanted is None and plan.request.finish == "return"):
        refuse_stranded(plan.ways_home, plan.battery, plan.flight)


def plan_routes(request: Request, choices: Sequence[CostChoice]) -> list[PlannedRoute]:
    """Plan the request's route once for each cost, on one and the same veil; no battery is too small for it."""
    ready = prepare(request)
    return [plan_ready(ready, choice) for choice in choices]


def prepare(request: Request) -> Ready:
    """Stand the sites, lay the veil, and let the wind blow on it. Raises as `plan_route` does."""
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
    problems = problems or windless_sites(request, sites) or limits_broken_at_sites(request, sites)
    problems = problems or too_many_or_equal(request, sites)
    if problems:
        raise RequestError([request.locate(problem) for problem in problems])
    begin = time.perf_counter()
    area = choose_area(request, sites)
    rules = replace(rules, area=area)
    bound = limited(request)
    windy = blow(_lay_veil(request, rules, layers, sites, area), bound.wind, bound.members)
    seconds = time.perf_counter() - begin
    return Ready(bound, request, rules, sites, windy, seconds, power_of(request, windy, sites))


def plan_ready(ready: Ready, choice: CostChoice, begin: float = 0.0) -> PlannedRoute:
    """Plan a route that begins at `begin` [s after the request's departure]. Raises as `plan_route` does.

    By `time` with airspeeds that are free it is the quickest that the battery allows.
    """
    ordered, notes = put_in_order(ready, choice, begin)
    plan = _quickest(ordered, choice, begin)
    return replace(plan, notes=(*notes, *plan.notes))


def _quickest(ready: Ready, choice: CostChoice, begin: float) -> PlannedRoute:
    """The plan, its sites in order; by `time` with free airspeeds the quickest that the battery allows."""
    if choice.name != "time" or not ready.request.free_airspeed or ready.request.airframe is None:
        return _planned(ready, choice, begin)
    power = ready.request.airframe.power
    quick, worth = quickest_within(
        lambda worth: _planned(ready, choice, begin, worth, shape_quickly),
        lambda plan: math.inf if plan.battery is None else plan.battery.missing,
        0.0,
        float(power.watts(ready.request.vehicle.airspeed, 0.0)),
    )
    plan = _planned(ready, choice, begin, worth)
    fits = plan.battery is not None and plan.battery.missing == 0
    return plan if fits or worth == 0.0 else quick


def _planned(
    ready: Ready,
    choice: CostChoice,
    begin: float,
    worth: float = math.inf,
    shaping: Callable[..., FloatArray] = shape,
) -> PlannedRoute:
    """The plan for one worth of time.

    Over an ensemble the best route for the quantile of its legs' cost need not be the best for the quantile of the
    whole: the one for the members' mean is flown in all members too, and the better one is taken.
    """
    request = ready.request
    try:
        found, spread = _best_route(ready, choice, begin, worth, shaping)
    except NoRouteError as error:
        raise NoRouteError(
            f"{error}{until_it_opens(begin, ready.windy.ends, partial(_lasting, ready))}", error.cuts
        ) from error
    flight = fly(
        found.points, request.frame, request.terrain, ready.flown.wind, request.vehicle, begin, request.power,
        found.airspeeds,
    )  # fmt: skip
    effort = Effort(
        ready.windy.veil.size, found.expanded, found.vertices, ready.seconds, found.search_seconds,
        found.shaping_seconds,
    )  # fmt: skip
    notes = _notes(request, ready.windy)
    if found.deferred:
        notes += where_it_pays(found.arrival - begin, begin, partial(_lasting, ready))
    en_route = spread.energy_at(request.robust) if spread is not None and spread.energies else None
    battery = battery_use(request, flight, en_route, _home_again(ready, flight, begin))
    ways, strongest = None, None
    if battery is not None and request.airframe is not None and shaping is shape:
        ways = ways_home(ready, flight, battery, request.airframe.battery.capacity, begin)
    if ready.flown is not ready.asked:
        strongest = strongest_along(ready.asked, found.points, begin, found.airspeeds)
        strongest.refuse_over(request.limits, request.robust)
    return PlannedRoute(
        ready.asked, choice, flight, found.cost, found.graph_cost, effort, spread, battery, ways, notes, strongest
    )


def _home_again(ready: Ready, flight: Flight, begin: float) -> float:
    """What the return at the end takes [J]; nothing where there is none, or nobody knows."""
    returns = ready.request.finish == "return" and ready.power is not None
    return home_from_the_end(ready, flight, begin) if returns else 0.0


def _thriftier(ready: Ready) -> str:
    """Whether the route of least energy would do, in words."""
    choice = CostChoice("energy")
    try:
        plan = plan_ready(ready, choice)
        refuse_unsafe(plan)
    except (BatteryError, NoRouteError):
        return ""
    assert plan.battery is not None
    return (
        f" Planned by `energy` it takes {plan.battery.total / 3600:.0f} Wh in {clock(plan.totals.seconds)} min en route"
        " and keeps the reserve: `--cost energy`."
    )


def _best_route(
    ready: Ready, choice: CostChoice, begin: float, worth: float, shaping: Callable[..., FloatArray]
) -> tuple[FoundRoute, Spread | None]:
    """The route, and over an ensemble how long it takes in each member. Raises `NoRouteError`."""
    request = ready.request
    if not request.members:
        return find_route(ready, choice, begin, shaping, worth), None
    ways = [ready, ready.in_the_mean()] if choice.name in ("time", "energy") else [ready]
    candidates, error = [], None
    for way in ways:
        try:
            found = find_route(way, choice, begin, shaping, worth)
        except NoRouteError as no_route:
            error = error or no_route
            continue
        spread = spread_of(ready.flown, found.points, begin, found.airspeeds)
        assert spread is not None
        candidates.append((found, spread))
    if not candidates:
        assert error is not None
        raise error
    measure = Spread.energy_at if choice.name == "energy" else Spread.at
    found, spread = min(candidates, key=lambda candidate: measure(candidate[1], request.robust))
    if not np.isfinite(spread.at(request.robust)):
        able = len(spread.seconds) - spread.unflyable
        raise NoRouteError(
            f"the best route found can be flown in {able} of {len(spread.seconds)} members only, and `robust`"
            f" {request.robust:g} asks for more: another departure, more airspeed, or a lower `robust`.",
            {"wind": spread.unflyable},
        )
    return found, spread


def _lay_veil(
    request: Request, rules: Clearance, layers: Sequence[float], sites: FloatArray, area: Extent
) -> GridVeil | PrmVeil:
    """The veil that the request asks for."""
    refuse_unwieldy(request, area, layers)
    graph = request.graph
    if isinstance(graph, Roadmap):
        return lay_prm(rules, area, choose_nodes(request, area), graph.seed, layers, sites, graph.radius)
    return lay_grid(rules, area, choose_spacing(request, area), layers, graph.neighbours)


def _notes(request: Request, windy: WindyVeil) -> tuple[str, ...]:
    """What a pilot must know: models that flatter, tests that miss, what the vehicle does not hold."""
    notes = []
    strongest = float(np.nanmax(np.hypot(windy.winds[..., 0], windy.winds[..., 1]), initial=0.0))
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


def _lasting(ready: Ready, begin: float) -> float:
    """How long the graph's quickest path takes that begins at `begin` [s]; infinite where there is none."""
    try:
        found = find_route(ready, CostChoice("time"), begin, unshaped)
    except (NoRouteError, WindError):
        return float("inf")
    spread = spread_of(ready.flown, found.points, begin, found.airspeeds)
    return found.arrival - begin if spread is None else spread.at(ready.request.robust)
