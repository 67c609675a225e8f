"""The way home from every waypoint: over the terrain, in the wind that blows then, by least energy."""

from __future__ import annotations

import math
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from gcs_windplan.arrays import FloatArray
from gcs_windplan.errors import BatteryError, NoRouteError, WindError
from gcs_windplan.flight import Flight, clock
from gcs_windplan.planning.battery import BatteryUse
from gcs_windplan.planning.cost import CostChoice
from gcs_windplan.planning.problem import PlanningProblem
from gcs_windplan.planning.route import cost_between
from gcs_windplan.planning.search import find_open_path
from gcs_windplan.planning.sites import choose_layers, site_points
from gcs_windplan.progress import UNTRACKED, Tracker
from gcs_windplan.vehicle import air_density

_ENERGY = CostChoice("energy")


@dataclass(frozen=True, slots=True)
class PointOfNoReturn:
    """Where the way home becomes too long: [m] level along the route, [s] after its first waypoint, on which leg."""

    distance: float
    seconds: float
    leg: int


@dataclass(frozen=True, slots=True)
class WaysHome:
    """What flying home takes from each waypoint, landing included [J]; infinite where there is no way.

    `alternates` are to the rally point that takes least, infinite where there is none. `spare` [J] is what the battery
    holds above the reserve when the vehicle has flown from a waypoint to the nearer of both; negative where it cannot.
    `point_of_no_return` is where home itself comes out of reach, None where it never does.
    """

    energies: tuple[float, ...]
    alternates: tuple[float, ...]
    spare: tuple[float, ...]
    point_of_no_return: PointOfNoReturn | None

    @property
    def stranded(self) -> int | None:
        """The number of the first waypoint from which neither home nor a rally point is within reach."""
        return next((i + 1 for i, spare in enumerate(self.spare) if spare < 0), None)


def ways_home(
    problem: PlanningProblem,
    flight: Flight,
    use: BatteryUse,
    capacity: float,
    begin: float = 0.0,
    *,
    tracker: Tracker = UNTRACKED,
) -> WaysHome:
    """The ways home from each waypoint of a flight that begins at `begin` [s since departure].

    Found on the veil, so they keep all limits; paths are not shaped, so they err on the long side. Over an ensemble in
    the members' mean.
    """
    problem = problem.in_the_mean()
    points = np.array([(w.east, w.north, w.altitude) for w in flight.waypoints])
    times = begin + np.array([w.seconds for w in flight.waypoints])
    request = problem.request
    targets = [problem.sites[0], *site_points(request, request.rally, choose_layers(request))]
    table = np.array([_energies(problem, points, times, target, tracker) for target in targets])
    home, alternates = table[0], table[1:].min(axis=0, initial=math.inf)
    drawn = (1 - np.array(use.left)) * capacity
    spare = use.allowed - drawn - np.minimum(home, alternates)
    return WaysHome(
        tuple(home.tolist()),
        tuple(alternates.tolist()),
        tuple(spare.tolist()),
        _point_of_no_return(flight, use.allowed - drawn - home),
    )


def home_from_the_end(problem: PlanningProblem, flight: Flight, begin: float = 0.0) -> float:
    """What flying home from the last waypoint and landing there takes [J]; infinite where there is no way."""
    problem = problem.in_the_mean()
    last = flight.waypoints[-1]
    point = np.array([[last.east, last.north, last.altitude]])
    return float(_energies(problem, point, np.array([begin + last.seconds]), problem.sites[0], UNTRACKED)[0])


def check_return(ways: WaysHome | None, use: BatteryUse | None, flight: Flight) -> None:
    """Raise `BatteryError` for a flight from which home and all rally points come out of reach."""
    number = None if ways is None else ways.stranded
    if ways is None or use is None or number is None:
        return
    waypoint, spare = flight.waypoints[number - 1], ways.spare[number - 1]
    distance = math.fsum(leg.distance for leg in flight.legs[: number - 1])
    where = f"from waypoint {number} ({distance / 1000:.2f} km, {clock(waypoint.seconds)} min) neither home nor a rally"
    if math.isinf(spare):
        raise BatteryError(f"{where} point can be reached: the wind or the terrain closes every way back.")
    if ways.point_of_no_return is not None:
        passed = f"; the point of no return lies at {ways.point_of_no_return.distance / 1000:.2f} km"
    else:
        passed = ""
    raise BatteryError(
        f"{where} point can be reached with the reserve: {-spare / 3600:.0f} Wh are missing{passed}. Another departure,"
        " a shorter way, a rally point on the way, `limits.way_home: false`, or `plan --force`."
    )


def _energies(
    problem: PlanningProblem, points: FloatArray, times: FloatArray, target: FloatArray, tracker: Tracker
) -> FloatArray:
    """The energy [J] from points (n, 3) at times (n,) to a target (3,) and down to the ground there."""
    energies = np.empty(len(points))
    for i, (point, time) in enumerate(zip(points, times, strict=True)):
        tracker.at("returns from the waypoints", i, len(points))
        energies[i] = _energy(problem, point, target, time)
    return energies


def _energy(problem: PlanningProblem, point: FloatArray, target: FloatArray, time: float) -> float:
    """The same from one point; infinite where there is no way."""
    down = _landing(problem, target)
    if np.linalg.norm(target - point) < 1e-6:
        return down
    cost = cost_between(problem, _ENERGY, point, target, time)
    try:
        path = find_open_path(problem.graph, cost, point, target, time)
    except (NoRouteError, WindError):
        return math.inf
    aside = 0.0
    for end, node in ((path.points[0], point), (path.points[-1], target)):  # on a roadmap they are the nearest nodes
        if np.linalg.norm(end - node) > 1e-6:
            when = np.array([[time, time]])
            aside += float(cost.of_legs(node[None], end[None], when if cost.changing else None)[0])
    return path.cost + aside + down


def _landing(problem: PlanningProblem, target: FloatArray) -> float:
    """What sinking from a target (3,) to the ground under it takes [J]; a fixed-wing circles down as fast."""
    request = problem.request
    assert request.power is not None
    ground = float(request.scene.terrain.heights_at(target[None])[0])
    airspeed = 0.0 if request.vehicle.hovers else request.vehicle.airspeed
    watts = float(request.power.watts(airspeed, -request.vehicle.descent, air_density(float(target[2]))))
    return watts * max(float(target[2]) - ground, 0.0) / request.vehicle.descent


def _point_of_no_return(flight: Flight, spare: FloatArray) -> PointOfNoReturn | None:
    """Where what is spare on the way home (n,) [J] becomes negative, linear along each leg."""
    flown = np.append(0.0, np.cumsum([leg.distance for leg in flight.legs]))
    arrivals = [waypoint.seconds for waypoint in flight.waypoints]
    if spare[0] < 0:
        return PointOfNoReturn(0.0, 0.0, 1)
    for i, (before, after) in enumerate(pairwise(spare.tolist())):
        if after < 0:
            share = before / (before - after) if math.isfinite(after) else 0.0
            distance = flown[i] + share * (flown[i + 1] - flown[i])
            return PointOfNoReturn(float(distance), arrivals[i] + share * (arrivals[i + 1] - arrivals[i]), i + 1)
    return None
