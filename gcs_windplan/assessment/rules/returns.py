"""Rules of the way back: from every stop home or to a rally point, over the ground and within the battery.

They are for what may happen on the way, so they warn; a return that is part of the mission is judged as its legs.
"""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np

from gcs_windplan.arrays import FloatArray
from gcs_windplan.assessment.figures import AssessedMission
from gcs_windplan.assessment.rules.battery import reserve_of
from gcs_windplan.assessment.rules.places import Found, at_stop, runs


def returns(mission: AssessedMission) -> Iterator[Found]:
    """Stops from which the straight way back meets the ground, or is beyond what wind and battery allow."""
    yield from _over_ground(mission)
    yield from _in_reach(mission)


def _over_ground(mission: AssessedMission) -> Iterator[Found]:
    """Ways home that pass through a hill, one finding for all stops in a row."""
    back = mission.back
    home = mission.track.course.home[2]
    low = back.clearance
    for first, last in runs([bool(value < 0) for value in low]):
        worst = first + int(np.argmin(low[first : last + 1]))
        needed = math.ceil(back.altitudes[worst] - home - low[worst] + (mission.case.limits.clearance or 0.0))
        yield at_stop(
            mission, worst, "return", "warning", value=float(low[worst]), limit=0.0, unit="m", first_stop=first,
            last_stop=last, height=float(back.altitudes[worst] - home), needed=needed,
        )  # fmt: skip


def _in_reach(mission: AssessedMission) -> Iterator[Found]:
    """Stops from which neither home nor a rally point is in reach, at the first of all in a row."""
    lacks = _missing(mission)
    for first, last in runs([bool(lack > 0) for lack in lacks]):
        value = limit = None
        if not math.isinf(lacks[first]):
            value = _least(mission, first) / 3600
            limit = max(value - float(lacks[first]) / 3600, 0.0)
        yield at_stop(
            mission, first, "reach", "warning", value=value, limit=limit, unit="" if value is None else "Wh",
            first_stop=first, last_stop=last, rally=bool(mission.case.mission.rally),
        )  # fmt: skip


def _missing(mission: AssessedMission) -> FloatArray:
    """By how much the energy for the way back breaks the reserve at each stop [J]; infinite where wind forbids it."""
    case, reserve, found = mission.case, reserve_of(mission), []
    for i, stop in enumerate(mission.stops):
        ways = [way for way in (mission.back, mission.aside) if way is not None]
        if all(math.isinf(way.seconds[i]) for way in ways):
            found.append(math.inf)
        elif stop.left is None or case.airframe is None or reserve is None:
            found.append(0.0)
        else:
            found.append(max(_least(mission, i) - (stop.left - reserve) * case.airframe.battery.capacity, 0.0))
    return np.array(found)


def _least(mission: AssessedMission, stop: int) -> float:
    """What the cheaper one of the ways back takes [J]."""
    ways = (way for way in (mission.back, mission.aside) if way is not None and way.energies is not None)
    return min(float(way.energies[stop]) for way in ways if way.energies is not None)
