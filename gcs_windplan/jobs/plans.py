"""Planning a mission: one route, one for each cost, or one for each departure."""

from __future__ import annotations

import base64
import html
import os
from collections.abc import Sequence
from dataclasses import dataclass, fields, replace
from datetime import datetime, timedelta
from typing import TYPE_CHECKING, Any, TypeAlias

from gcs_windplan.errors import InputError, Problem
from gcs_windplan.jobs.mission import Mission, as_cost, as_moment
from gcs_windplan.jobs.missionfile import read_mission
from gcs_windplan.jobs.requests import request_of
from gcs_windplan.jobs.winds import DAY
from gcs_windplan.jobs.words import Naming
from gcs_windplan.planning import planner
from gcs_windplan.planning.cost import COSTS, CostChoice
from gcs_windplan.planning.request import Request
from gcs_windplan.progress import UNTRACKED, CancelToken, ProgressCallback, Tracker

if TYPE_CHECKING:
    from gcs_windplan.mission import MissionItems
    from gcs_windplan.planning.departures import Departure

#: A mission to be planned: a value, a mission file, or the planner's own request.
MissionWords: TypeAlias = "Mission | Request | str | os.PathLike[str]"


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class Plan(planner.PlannedRoute):
    """A route for a mission, with its flight, its totals and what a pilot must know (`notes`).

    `waypoints`, `legs` and `totals` are those of the flight; `battery` and `ways_home` are known where the airframe is.
    Notebooks show its map, its profile and its totals.

    >>> import gcs_windplan as gw
    >>> mission = gw.Mission(
    ...     start=(36.55, -84.30), goal=(36.56, -84.28), vehicle=gw.Vehicle(12.0), terrain="flat:300",
    ... )
    >>> plan = gw.plan(mission)
    >>> plan.waypoints[0].altitude
    348.0
    >>> plan.to_dict()["finish"], plan.to_geojson()["type"]
    ('land', 'FeatureCollection')
    """

    @property
    def items(self) -> MissionItems:
        """The mission that flies it: its items, home, fence and rally points."""
        from gcs_windplan.planning.export import mission_of

        return mission_of(self)

    def to_dict(self) -> dict[str, Any]:
        """Its figures as JSON takes them: SI units, angles in degrees from true north, wind towards where it blows."""
        from gcs_windplan.formats.summary import summary_of

        return summary_of(self)

    def to_geojson(self) -> dict[str, Any]:
        """A FeatureCollection (RFC 7946) of its legs as flown, its stops, findings, areas and rally points."""
        from gcs_windplan.assessment import assess_plan
        from gcs_windplan.formats.geojson import geojson_of

        return geojson_of(assess_plan(self))

    def _repr_html_(self) -> str:
        """What a notebook shows: totals, map and profile."""
        from gcs_windplan.report import draw_map, draw_profile

        pictures = [base64.b64encode(png).decode() for png in (draw_map([self]), draw_profile(self))]
        shown = "".join(f'<img style="max-width:100%" src="data:image/png;base64,{png}">' for png in pictures)
        notes = "".join(f"<p>{html.escape(note)}</p>" for note in self.notes)
        return f"<p>{html.escape(repr(self))}</p>{shown}{notes}"


def plan(
    mission: MissionWords,
    *,
    cost: CostChoice | str | None = None,
    keep_reserve: bool = True,
    progress: ProgressCallback | None = None,
    cancel: CancelToken | None = None,
) -> Plan:
    """Plan a mission's route.

    `cost` takes the place of the mission's: distance, angle, hybrid, time or energy. Without `keep_reserve` a route
    that breaks the battery's reserve is given all the same. `progress` is called with each stage (`print` will do), and
    `cancel` stops the work.

    Raises `InputError` (`RequestError`, `TerrainError`, `WindError`, ...) for what cannot be used, all such problems at
    once; `NoRouteError` where no route exists, `BatteryError` where the best one breaks the battery's reserve, and
    `CancelledError`.

    >>> import gcs_windplan as gw
    >>> mission = gw.Mission(
    ...     start=(36.55, -84.30), goal=(36.56, -84.28), vehicle=gw.Vehicle(12.0), terrain="flat:300",
    ... )
    >>> gw.plan(mission)
    Plan('mission', time: 2 waypoints, 2.11 km in 2:56 min, clearance 48.0 m)
    """
    tracker = Tracker(progress, cancel)
    request = as_request(mission, tracker)
    choice = request.cost if cost is None else as_cost(cost)
    request = replace(request, cost=choice)
    if keep_reserve:
        found = planner.plan_route(request, progress=progress, cancel=cancel)
    else:
        found = planner.plan_routes(request, [choice], progress=progress, cancel=cancel)[0]
    tracker.at("done")
    return _public(found)


def compare(
    mission: MissionWords,
    costs: Sequence[CostChoice | str] | None = None,
    *,
    progress: ProgressCallback | None = None,
    cancel: CancelToken | None = None,
) -> list[Plan]:
    """Plan a mission by several costs on one graph, so that they can be compared; no battery is too small for it.

    Without `costs` by all of them: energy where the airframe is known, hybrid with the mission's own weights. Raises as
    `plan` does, but no `BatteryError`.

    >>> import gcs_windplan as gw
    >>> mission = gw.Mission(
    ...     start=(36.55, -84.30), goal=(36.56, -84.28), vehicle=gw.Vehicle(12.0), terrain="flat:300",
    ... )
    >>> [plan.choice.name for plan in gw.compare(mission)]
    ['distance', 'angle', 'hybrid', 'time']
    """
    tracker = Tracker(progress, cancel)
    request = as_request(mission, tracker)
    found = planner.plan_routes(request, _choices(request, costs), progress=progress, cancel=cancel)
    tracker.at("done")
    return [_public(one) for one in found]


def departures(
    mission: MissionWords,
    first: datetime | str,
    last: datetime | str,
    every: timedelta | str = "30min",
    *,
    cores: int | None = None,
    progress: ProgressCallback | None = None,
    cancel: CancelToken | None = None,
) -> list[Departure]:
    """The best route at each departure from `first` to `last` in the mission's forecast, in the order of their times.

    Times are values with their time zone, texts such as `2026-05-01T06:00Z`, or times of day in UTC such as `06:00` on
    the day of the mission's departure; steps are values, or texts such as `30min` or `1h`. They are planned on `cores`
    cores, all if not said. Raises as `plan` does for what is wrong at every departure; one
    that cannot be flown says so in its `reason`.

    >>> import gcs_windplan as gw
    >>> mission = gw.Mission(
    ...     start=(36.55, -84.30), goal=(36.56, -84.28), vehicle=gw.Vehicle(12.0), terrain="flat:300",
    ... )
    >>> found = gw.departures(mission, "2026-05-01T06:00Z", "2026-05-01T07:00Z", cores=1)
    >>> [round(one.seconds) for one in found]
    [176, 176, 176]
    """
    from gcs_windplan.planning.departures import sweep

    request, moments = departures_request(mission, first, last, every, tracker=Tracker(progress, cancel))
    return list(sweep(request, moments, cores=cores, progress=progress, cancel=cancel))


def departures_request(
    mission: MissionWords,
    first: datetime | str,
    last: datetime | str,
    every: timedelta | str,
    *,
    most: int | None = None,
    named: Naming = str,
    tracker: Tracker = UNTRACKED,
) -> tuple[Request, list[datetime]]:
    """The request at the first of so many departures, and all of them; raises `InputError` for more than `most`."""
    from gcs_windplan.jobs.moments import moments_of

    if not isinstance(mission, Mission | Request):
        mission = read_mission(mission)
    own = mission.scene.departure if isinstance(mission, Request) else as_moment(mission.departure)
    moments = moments_of(first, last, every, own, named)
    if most is not None and len(moments) > most:
        text = f"makes {len(moments)} departures; at most {most}: a longer step"
        raise InputError(Problem(text, named("every")))
    lasting = (moments[-1] - moments[0]).total_seconds() + DAY
    return as_request(mission, tracker, moments[0], lasting), moments


def as_request(
    mission: MissionWords,
    tracker: Tracker = UNTRACKED,
    departure: datetime | None = None,
    lasting: float = DAY,
) -> Request:
    """The planner's request for a mission; a request stays as it is."""
    if isinstance(mission, Request):
        return mission
    if not isinstance(mission, Mission):
        mission = read_mission(mission)
    tracker.at("reading terrain and wind")
    return request_of(mission, departure, lasting)


def _choices(request: Request, costs: Sequence[CostChoice | str] | None) -> list[CostChoice]:
    """The costs that are asked for, or all that can be."""
    own = request.cost if request.cost.name == "hybrid" else CostChoice("hybrid")
    if costs is None:
        costs = [name for name, cost in COSTS.items() if request.airframe is not None or not cost.needs_power]
    return [one if isinstance(one, CostChoice) else own if one == "hybrid" else CostChoice(one) for one in costs]


def _public(found: planner.PlannedRoute) -> Plan:
    """The planner's route with what notebooks and scripts want of it."""
    return Plan(**{field.name: getattr(found, field.name) for field in fields(found)})
