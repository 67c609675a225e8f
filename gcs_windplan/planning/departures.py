"""When to fly: a route for each of several departures, on one veil, on all cores."""

from __future__ import annotations

import time
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from datetime import datetime, timedelta

import numpy as np

from gcs_windplan.cores import available_cores
from gcs_windplan.errors import NoRouteError, WindError
from gcs_windplan.flight import Flight, fly
from gcs_windplan.planning.battery import battery_use
from gcs_windplan.planning.cost import CostChoice, rank_of
from gcs_windplan.planning.ensemble import Spread, spread_of
from gcs_windplan.planning.limits import Strongest, strongest_along
from gcs_windplan.planning.order import optimise_order
from gcs_windplan.planning.problem import PlanningProblem, pose_problem
from gcs_windplan.planning.request import Request
from gcs_windplan.planning.returns import home_from_the_end
from gcs_windplan.planning.route import find_route
from gcs_windplan.planning.shaping import shape_quickly
from gcs_windplan.progress import CancelToken, ProgressCallback, Tracker

_NEAR_THE_END = 2.0  # durations of the flight


@dataclass(frozen=True, slots=True)
class Departure:
    """One departure: how long the best route takes, and what wind it meets.

    `seconds`, `length` [m] and `energy` [J] (where the vehicle's power is known) of the route, None where there is
    none. `spread` is the same route in every member of an ensemble. `reason` says why it cannot be flown, or not in as
    many members as the request's `robust` asks for, or not with the battery; `brief` the same in a few words. `wind`
    and `gust` are the strongest along the route in any member [m/s]; the gust is None where the forecast tells none.
    `worked` is the processor's time that it took [s]. `robust` is the request's quantile.

    >>> import gcs_windplan as gw
    >>> from datetime import datetime, timezone
    >>> gw.Departure(datetime(2026, 5, 1, 8, tzinfo=timezone.utc), seconds=1134.0).feasible
    True
    """

    moment: datetime
    seconds: float | None = None
    length: float | None = None
    energy: float | None = None
    spread: Spread | None = None
    wind: float | None = None
    gust: float | None = None
    reason: str | None = None
    worked: float = 0.0
    robust: float = 0.5
    brief: str | None = None

    @property
    def key(self) -> float:
        """What departures are compared by [s]: over an ensemble the time at the quantile, else the time."""
        if self.seconds is None:
            return float("inf")
        return self.seconds if self.spread is None else self.spread.at(self.robust)

    @property
    def feasible(self) -> bool:
        """Whether it can be flown, over an ensemble in as many members as were asked for."""
        return self.reason is None


def moments_between(first: datetime, last: datetime, every: timedelta) -> list[datetime]:
    """The departures from the first to the last one."""
    return [first + k * every for k in range(int((last - first) / every) + 1)]


def sweep(
    request: Request,
    moments: Sequence[datetime],
    choice: CostChoice | None = None,
    cores: int | None = None,
    *,
    progress: ProgressCallback | None = None,
    cancel: CancelToken | None = None,
) -> Iterator[Departure]:
    """The best route at each departure, in the order of the moments.

    The forecast has to reach over all of them. The sites stand, the veil is laid and the wind is sampled once; the
    routes are found on `cores` cores (all, if not said). Over an ensemble each route is planned in the members' mean
    and flown in all of them. `progress` is called, and `cancel` looked at, between the departures. Raises as
    `plan_route` does for what is wrong at every departure.
    """
    tracker = Tracker(progress, cancel)
    problem = pose_problem(request.in_the_mean(), progress=progress, cancel=cancel)
    if request.scene.departure is not None and len(moments):
        begins = [(moment - request.scene.departure).total_seconds() for moment in moments]
    else:
        begins = [0.0] * len(moments)
    problem.graph.winds_between(min(begins), max(begins))
    job = _Job(problem, request, request.cost if choice is None else choice)
    workers = min(available_cores() if cores is None else cores, max(len(moments), 1))
    found = _departures(job, list(zip(moments, begins, strict=True)), workers)
    for done in range(len(moments)):
        tracker.at("departures", done, len(moments))
        yield next(found)


def _departures(job: _Job, departures: Sequence[tuple[datetime, float]], workers: int) -> Iterator[Departure]:
    """One after the other, by some workers."""
    if workers == 1:
        yield from (job.depart(*departure) for departure in departures)
        return
    import joblib

    yield from joblib.Parallel(n_jobs=workers, return_as="generator")(
        joblib.delayed(job.depart)(*departure) for departure in departures
    )


@dataclass(frozen=True, slots=True, eq=False)
class _Job:
    """What the workers share: the veil in the mean wind, the request with all members, the cost."""

    problem: PlanningProblem
    request: Request
    choice: CostChoice

    def depart(self, moment: datetime, begin: float) -> Departure:
        """The best route that begins at `begin` [s after the request's departure]."""
        since, request = time.process_time(), self.request
        try:
            problem = optimise_order(self.problem, self.choice, begin)[0]
            found = find_route(problem, self.choice, begin, shaping=shape_quickly)
            flight = fly(found.points, request.scene, request.vehicle, begin, request.power, found.airspeeds)
        except (NoRouteError, WindError) as error:
            brief = error.brief if isinstance(error, NoRouteError) else str(error)
            return Departure(moment, reason=str(error), brief=brief, worked=time.process_time() - since)
        spread = spread_of(request, found.points, begin, found.airspeeds)
        strongest = strongest_along(request, found.points, begin, found.airspeeds)
        return Departure(
            moment, flight.totals.seconds, flight.totals.length, flight.totals.energy, spread, strongest.wind,
            strongest.gust, self._reason(flight, spread, strongest, begin), time.process_time() - since,
            request.robust,
        )  # fmt: skip

    def _reason(self, flight: Flight, spread: Spread | None, strongest: Strongest, begin: float) -> str | None:
        """Why it is not to be flown: too few members can, a limit of the wind or the battery's reserve is broken."""
        request, keeping = self.request, strongest.within_limits(self.request.limits)
        members = len(strongest.winds)
        if spread is not None and not np.isfinite(spread.at(request.robust)):
            able = members - spread.unflyable
            if keeping < members:
                return f"{able}/{members}, wind limit"
            return f"{able}/{members} members{self._ending(flight, begin)}"
        if keeping <= rank_of(request.robust, members):
            return "wind limit" if spread is None else f"{keeping}/{members}, wind limit"
        en_route = spread.energy_at(request.robust) if spread is not None and spread.energies else None
        returns = request.finish == "return" and self.problem.power is not None
        home_again = home_from_the_end(self.problem, flight, begin) if returns else 0.0
        use = battery_use(request, flight, en_route, home_again)
        if use is None or use.missing == 0:
            return None
        return f"{use.total / 3600:.0f} of {use.allowed / 3600:.0f} Wh"

    def _ending(self, flight: Flight, begin: float) -> str:
        """Whether the forecast's end is near enough to be the reason, in words."""
        times = self.request.scene.wind.times
        near = len(times) > 1 and begin + _NEAR_THE_END * flight.totals.seconds > times[-1]
        return ", forecast ends" if near else ""
