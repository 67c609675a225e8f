"""Rules of the battery: what must be left at the end."""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np

from gcs_windplan.assessment.assessment import Stop
from gcs_windplan.assessment.case import Case
from gcs_windplan.assessment.figures import AssessedMission, share_used
from gcs_windplan.assessment.motion import density_at
from gcs_windplan.assessment.rules.places import Found, at_stop

_SLACK = 1e-6


class Reserve(NamedTuple):
    """A share of the capacity that must be left, and the rule that wants it."""

    rule: str
    share: float


def battery(mission: AssessedMission) -> Iterator[Found]:
    """A battery that does not keep a reserve; at the stop where that first shows."""
    used, airframe = share_used(mission.flown, mission.case), mission.case.airframe
    if used is None or airframe is None:
        return
    left, capacity = float(1 - used[-1]), airframe.battery.capacity
    if not np.isfinite(left):
        return  # below the stall, which a rule of its own tells
    for rule, least in reserves(mission.case, mission.stops):
        if left >= least - _SLACK:
            continue
        broken = (stop.number for stop in mission.stops if stop.left is not None and stop.left < least)
        where = next(broken, mission.stops[-1].number)
        yield at_stop(
            mission, where, rule, "danger", value=100 * left, limit=100 * least, unit="%",
            missing=(least - left) * capacity, stop=where, reserve_seconds=mission.case.limits.reserve_seconds or 0.0,
        )  # fmt: skip


def reserves(case: Case, stops: tuple[Stop, ...]) -> tuple[Reserve, ...]:
    """All that must be left; none where no airframe is known. A reserve in time comes upon what is not usable."""
    airframe, limits = case.airframe, case.limits
    if airframe is None:
        return ()
    cell = airframe.battery
    found = [Reserve("reserve", 1 - cell.energy_to_plan_with / cell.capacity)]
    if limits.battery is not None:
        found.append(Reserve("battery", limits.battery))
    if limits.reserve_seconds is not None:
        density = density_at(float(np.mean([stop.altitude for stop in stops])))
        watts = float(airframe.power.watts(case.cruise, 0.0, density))
        share = 1 - (cell.usable_energy - limits.reserve_seconds * watts) / cell.capacity
        found.append(Reserve("reserve-time", share))
    return tuple(found)


def reserve_of(mission: AssessedMission) -> float | None:
    """What must be left as a share of the capacity by the strictest rule, None where no airframe is known."""
    return max((one.share for one in reserves(mission.case, mission.stops)), default=None)
