"""When to fly: a route for each of several departures, on one veil, on all cores."""

from __future__ import annotations

import time
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from datetime import datetime, timedelta

import numpy as np

from gcs_windplan.cores import available_cores
from gcs_windplan.errors import NoRouteError, WindError
from gcs_windplan.flight import Flight, fly
from gcs_windplan.planning.battery import battery_use
from gcs_windplan.planning.cost import CostChoice, rank_of
from gcs_windplan.planning.ensemble import Spread, spread_of
from gcs_windplan.planning.limits import Strongest, limited, strongest_along
from gcs_windplan.planning.order import put_in_order
from gcs_windplan.planning.planner import prepare
from gcs_windplan.planning.request import Request
from gcs_windplan.planning.returns import home_from_the_end
from gcs_windplan.planning.route import Ready, find_route
from gcs_windplan.planning.shaping import shape_quickly

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
    request: Request, moments: Sequence[datetime], choice: CostChoice | None = None, cores: int | None = None
) -> Iterator[Departure]:
    """The best route at each departure, in the order of the moments.

    The forecast has to reach over all of them. The sites stand, the veil is laid and the wind is sampled once; the
    routes are found on `cores` cores (all, if not said). Over an ensemble each route is planned in the members' mean
    and flown in all of them. Raises as `plan_route` does for what is wrong at every departure.
    """
    ready = prepare(replace(request, members=())) if request.members else prepare(request)
    request = limited(request, 0.0)
    if request.departure is not None and len(moments):
        begins = [(moment - request.departure).total_seconds() for moment in moments]
    else:
        begins = [0.0] * len(moments)
    ready.windy.cover(min(begins), max(begins))
    job = _Job(ready, request, request.cost if choice is None else choice)
    workers = min(available_cores() if cores is None else cores, max(len(moments), 1))
    if workers == 1:
        yield from (job.depart(moment, begin) for moment, begin in zip(moments, begins, strict=True))
        return
    import joblib

    yield from joblib.Parallel(n_jobs=workers, return_as="generator")(
        joblib.delayed(job.depart)(moment, begin) for moment, begin in zip(moments, begins, strict=True)
    )


@dataclass(frozen=True, slots=True, eq=False)
class _Job:
    """What the workers share: the veil in the mean wind, the request with all members, the cost."""

    ready: Ready
    request: Request
    choice: CostChoice

    def depart(self, moment: datetime, begin: float) -> Departure:
        """The best route that begins at `begin` [s after the request's departure]."""
        since, request = time.process_time(), self.request
        try:
            ready = put_in_order(self.ready, self.choice, begin)[0]
            found = find_route(ready, self.choice, begin, shape_quickly)
            flight = fly(
                found.points, request.frame, request.terrain, request.wind, request.vehicle, begin, request.power,
                found.airspeeds,
            )  # fmt: skip
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
        request, keeping = self.request, strongest.keeping(self.request.limits)
        members = len(strongest.winds)
        if spread is not None and not np.isfinite(spread.at(request.robust)):
            able = members - spread.unflyable
            if keeping < members:
                return f"{able}/{members}, wind limit"
            return f"{able}/{members} members{self._ending(flight, begin)}"
        if keeping <= rank_of(request.robust, members):
            return "wind limit" if spread is None else f"{keeping}/{members}, wind limit"
        en_route = spread.energy_at(request.robust) if spread is not None and spread.energies else None
        returns = request.finish == "return" and self.ready.power is not None
        home_again = home_from_the_end(self.ready, flight, begin) if returns else 0.0
        use = battery_use(request, flight, en_route, home_again)
        if use is None or use.missing == 0:
            return None
        return f"{use.total / 3600:.0f} of {use.allowed / 3600:.0f} Wh"

    def _ending(self, flight: Flight, begin: float) -> str:
        """Whether the forecast's end is near enough to be the reason, in words."""
        times = self.request.wind.times
        near = len(times) > 1 and begin + _NEAR_THE_END * flight.totals.seconds > times[-1]
        return ", forecast ends" if near else ""
