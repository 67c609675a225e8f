"""Rules of the way back: from every stop home or to a rally point, over the ground and within the battery.

They are for what may happen on the way, so they warn; a return that is part of the mission is judged as its legs.
"""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np

from gcs_windplan.arrays import FloatArray
from gcs_windplan.assessment.figures import Judged
from gcs_windplan.assessment.rules.battery import reserve_of
from gcs_windplan.assessment.rules.saying import Found, at_stop, runs


def returns(mission: Judged) -> Iterator[Found]:
    """Stops from which the straight way back meets the ground, or is beyond what wind and battery allow."""
    yield from _over_ground(mission)
    yield from _in_reach(mission)


def _over_ground(mission: Judged) -> Iterator[Found]:
    """Ways home that pass through a hill, one finding for all stops in a row."""
    back, stops = mission.back, mission.stops
    home = mission.track.course.home[2]
    low = back.clearance
    for first, last in runs([bool(value < 0) for value in low]):
        worst = first + int(np.argmin(low[first : last + 1]))
        needed = math.ceil(back.altitudes[worst] - home - low[worst] + (mission.case.limits.clearance or 0.0))
        yield at_stop(
            mission, worst, "return", "warning",
            f"from {_stops(first, last)} the straight way home at {back.altitudes[worst] - home:.0f} m above home runs"
            f" {-low[worst]:.0f} m below the ground (worst from item {stops[worst].item}): set the return altitude to"
            f" {needed} m, or give a rally point",
            value=float(low[worst]), limit=0.0, unit="m",
        )  # fmt: skip


def _in_reach(mission: Judged) -> Iterator[Found]:
    """Stops from which neither home nor a rally point is in reach, at the first of all in a row."""
    lacks = _missing(mission)
    places = "home and the rally points are" if mission.case.mission.rally else "home is"
    for first, last in runs([bool(lack > 0) for lack in lacks]):
        value = limit = None
        if math.isinf(lacks[first]):
            said = "the wind on the way is too strong"
        else:
            value = _least(mission, first) / 3600
            limit = max(value - float(lacks[first]) / 3600, 0.0)
            said = f"the way takes {value:.0f} Wh, and {limit:.0f} Wh may be drawn"
        yield at_stop(
            mission, first, "reach", "warning",
            f"from {_stops(first, last)} {places} out of reach: {said} at item {mission.stops[first].item}; a rally"
            " point there, or another departure", value=value, limit=limit, unit="" if value is None else "Wh",
        )  # fmt: skip


def _missing(mission: Judged) -> FloatArray:
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


def _least(mission: Judged, stop: int) -> float:
    """What the cheaper one of the ways back takes [J]."""
    ways = (way for way in (mission.back, mission.aside) if way is not None and way.energies is not None)
    return min(float(way.energies[stop]) for way in ways if way.energies is not None)


def _stops(first: int, last: int) -> str:
    return f"stop {first}" if first == last else f"stops {first} to {last}"
