"""The planner: the one place where terrain, wind, vehicle, veil, cost, search and shaping meet.

request ─▶ sites ─▶ veil ─▶ wind at its nodes ─▶ A* ─▶ shaping ─▶ flight ─▶ Plan
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import partial

import numpy as np

from gcs_windplan.arrays import FloatArray
from gcs_windplan.errors import BatteryError, NoRouteError, WindError
from gcs_windplan.flight import Flight, Leg, Totals, Waypoint, clock, fly
from gcs_windplan.planning.battery import BatteryUse, battery_use, check_reserve
from gcs_windplan.planning.budget import quickest_within
from gcs_windplan.planning.cost import CostChoice
from gcs_windplan.planning.ensemble import Spread, spread_of
from gcs_windplan.planning.limits import Strongest, strongest_along
from gcs_windplan.planning.order import optimise_order
from gcs_windplan.planning.problem import PlanningProblem, pose_problem
from gcs_windplan.planning.request import Request
from gcs_windplan.planning.returns import WaysHome, check_return, home_from_the_end, ways_home
from gcs_windplan.planning.route import FoundRoute, find_route, unshaped
from gcs_windplan.planning.search import NodeWinds
from gcs_windplan.planning.shaping import shape, shape_quickly
from gcs_windplan.planning.waiting import later_departure_note, next_feasible_departure
from gcs_windplan.progress import CancelToken, ProgressCallback, Tracker


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


def plan_route(
    request: Request, *, progress: ProgressCallback | None = None, cancel: CancelToken | None = None
) -> PlannedRoute:
    """Plan the request's route by its own cost.

    `progress` is called between the steps, and `cancel` is looked at: then `CancelledError` is raised.

    Raises `RequestError` where sites and limits contradict each other (all such problems at once), `WindError` or
    `TerrainError` where the data do not cover the place, `NoRouteError` where no route exists, and `BatteryError` where
    the best one breaks the battery's reserve, or leads to where the vehicle cannot come home from.
    """
    problem = pose_problem(request, progress=progress, cancel=cancel)
    plan = solve(problem, request.cost, progress=progress, cancel=cancel)
    try:
        refuse_unsafe(plan)
    except BatteryError as error:
        raise BatteryError(f"{error}{_lower_energy_hint(problem, Tracker(progress, cancel))}") from error
    return plan


def refuse_unsafe(plan: PlannedRoute) -> None:
    """Raise `BatteryError` for a plan that its battery does not carry through, or not home."""
    check_reserve(plan.battery)
    wanted = plan.request.limits.way_home
    if wanted or (wanted is None and plan.request.finish == "return"):
        check_return(plan.ways_home, plan.battery, plan.flight)


def plan_routes(
    request: Request,
    choices: Sequence[CostChoice],
    *,
    progress: ProgressCallback | None = None,
    cancel: CancelToken | None = None,
) -> list[PlannedRoute]:
    """Plan the request's route once for each cost, on one and the same veil; no battery is too small for it."""
    problem = pose_problem(request, progress=progress, cancel=cancel)
    return [solve(problem, choice, progress=progress, cancel=cancel) for choice in choices]


def solve(
    problem: PlanningProblem,
    choice: CostChoice,
    begin: float = 0.0,
    *,
    progress: ProgressCallback | None = None,
    cancel: CancelToken | None = None,
) -> PlannedRoute:
    """Plan a route that begins at `begin` [s after the request's departure]. Raises as `plan_route` does.

    By `time` with airspeeds that are free it is the quickest that the battery allows.
    """
    tracker = Tracker(progress, cancel)
    ordered, notes = optimise_order(problem, choice, begin, tracker)
    plan = _quickest(ordered, choice, begin, tracker)
    return replace(plan, notes=(*notes, *plan.notes))


def _quickest(problem: PlanningProblem, choice: CostChoice, begin: float, tracker: Tracker) -> PlannedRoute:
    """The plan, its sites in order; by `time` with free airspeeds the quickest that the battery allows."""
    weighs_time = math.isinf(choice.leg_cost.value_of_time(math.inf))
    if not weighs_time or not problem.request.free_airspeed or problem.request.airframe is None:
        return _planned(problem, choice, begin, tracker)
    power = problem.request.airframe.power
    quick, cost_index = quickest_within(
        lambda cost_index: _planned(problem, choice, begin, tracker, cost_index=cost_index, shaping=shape_quickly),
        lambda plan: math.inf if plan.battery is None else plan.battery.missing,
        0.0,
        float(power.watts(problem.request.vehicle.airspeed, 0.0)),
    )
    plan = _planned(problem, choice, begin, tracker, cost_index=cost_index)
    fits = plan.battery is not None and plan.battery.missing == 0
    return plan if fits or cost_index == 0.0 else quick


def _planned(
    problem: PlanningProblem,
    choice: CostChoice,
    begin: float,
    tracker: Tracker,
    *,
    cost_index: float = math.inf,
    shaping: Callable[..., FloatArray] = shape,
) -> PlannedRoute:
    """The plan for one cost index.

    Over an ensemble the best route for the quantile of its legs' cost need not be the best for the quantile of the
    whole: the one for the members' mean is flown in all members too, and the better one is taken.
    """
    request = problem.request
    try:
        found, spread = _best_route(problem, choice, begin, tracker, cost_index=cost_index, shaping=shaping)
    except NoRouteError as error:
        raise NoRouteError(
            f"{error}{next_feasible_departure(begin, problem.graph.ends, partial(_lasting, problem, tracker))}",
            error.cuts,
        ) from error
    flight = fly(found.points, request.scene, request.vehicle, begin, request.power, found.airspeeds)
    effort = Effort(
        problem.graph.veil.size, found.expanded, found.vertices, problem.seconds, found.search_seconds,
        found.shaping_seconds,
    )  # fmt: skip
    notes = _notes(request, problem.graph.winds_between(begin, found.arrival))
    if found.deferred:
        notes += later_departure_note(found.arrival - begin, begin, partial(_lasting, problem, tracker))
    en_route = spread.energy_at(request.robust) if spread is not None and spread.energies else None
    battery = battery_use(request, flight, en_route, _home_again(problem, flight, begin))
    ways, strongest = None, None
    if battery is not None and request.airframe is not None and shaping is shape:
        ways = ways_home(problem, flight, battery, request.airframe.battery.capacity, begin, tracker=tracker)
    if problem.graph.limits:
        strongest = strongest_along(request, found.points, begin, found.airspeeds)
        strongest.check_limits(request.limits, request.robust)
    return PlannedRoute(
        request, choice, flight, found.cost, found.graph_cost, effort, spread, battery, ways, notes, strongest
    )


def _home_again(problem: PlanningProblem, flight: Flight, begin: float) -> float:
    """What the return at the end takes [J]; nothing where there is none, or nobody knows."""
    returns = problem.request.finish == "return" and problem.power is not None
    return home_from_the_end(problem, flight, begin) if returns else 0.0


def _lower_energy_hint(problem: PlanningProblem, tracker: Tracker) -> str:
    """Whether the route of least energy would do, in words."""
    choice = CostChoice("energy")
    try:
        plan = solve(problem, choice, progress=tracker.progress, cancel=tracker.cancel)
        refuse_unsafe(plan)
    except (BatteryError, NoRouteError):
        return ""
    assert plan.battery is not None
    return (
        f" Planned by `energy` it takes {plan.battery.total / 3600:.0f} Wh in {clock(plan.totals.seconds)} min en route"
        " and keeps the reserve: `--cost energy`."
    )


def _best_route(
    problem: PlanningProblem,
    choice: CostChoice,
    begin: float,
    tracker: Tracker,
    *,
    cost_index: float,
    shaping: Callable[..., FloatArray],
) -> tuple[FoundRoute, Spread | None]:
    """The route, and over an ensemble how long it takes in each member. Raises `NoRouteError`."""
    request = problem.request
    if not request.scene.members:
        return find_route(problem, choice, begin, shaping=shaping, cost_index=cost_index, tracker=tracker), None
    ways = [problem, problem.in_the_mean()] if choice.leg_cost.of_air else [problem]
    candidates, error = [], None
    for way in ways:
        try:
            found = find_route(way, choice, begin, shaping=shaping, cost_index=cost_index, tracker=tracker)
        except NoRouteError as no_route:
            error = error or no_route
            continue
        spread = spread_of(problem.request, found.points, begin, found.airspeeds)
        assert spread is not None
        candidates.append((found, spread))
    if not candidates:
        assert error is not None
        raise error
    measure = Spread.energy_at if choice.leg_cost.needs_power else Spread.at
    found, spread = min(candidates, key=lambda candidate: measure(candidate[1], request.robust))
    if not np.isfinite(spread.at(request.robust)):
        able = len(spread.seconds) - spread.unflyable
        raise NoRouteError(
            f"the best route found can be flown in {able} of {len(spread.seconds)} members only, and `robust`"
            f" {request.robust:g} asks for more: another departure, more airspeed, or a lower `robust`.",
            {"wind": spread.unflyable},
        )
    return found, spread


def _notes(request: Request, air: NodeWinds) -> tuple[str, ...]:
    """What a pilot must know: models that flatter, tests that miss, what the vehicle does not hold."""
    notes = []
    strongest = float(np.nanmax(np.hypot(air.winds[..., 0], air.winds[..., 1]), initial=0.0))
    if request.vehicle.speed_model == "paper":
        text = "the speed model `paper` counters cross wind for free: its times are some percent too short"
        if strongest > request.vehicle.airspeed / 2:
            text += f"; and in wind above half of the airspeed (here up to {strongest:.1f} m/s) zig-zag seems to pay"
        notes.append(f"{text}. Plan with `triangle` to fly.")
    if request.collision_test is not None:
        notes.append(request.collision_test.note)
    lost = [f"'{area.name}'" for area in request.fence if area.heights_lost]
    if lost:
        text = f"the fence holds {', '.join(lost)} in plan only, without floor and ceiling"
        notes.append(f"{text}: set the vehicle's own limits of altitude.")
    if request.rally and request.finish == "return":
        notes.append("at the end the vehicle returns to the rally point nearest to it, or home if that is nearer.")
    return tuple(notes)


def _lasting(problem: PlanningProblem, tracker: Tracker, begin: float) -> float:
    """How long the graph's quickest path takes that begins at `begin` [s]; infinite where there is none."""
    try:
        found = find_route(problem, CostChoice("time"), begin, shaping=unshaped, tracker=tracker)
    except (NoRouteError, WindError):
        return float("inf")
    spread = spread_of(problem.request, found.points, begin, found.airspeeds)
    return found.arrival - begin if spread is None else spread.at(problem.request.robust)
