"""The shaping that a cost asks for."""

from __future__ import annotations

from typing import Final

from gcs_windplan.arrays import FloatArray
from gcs_windplan.flight.wind_limits import SPARE
from gcs_windplan.planning.cost import SectionCost
from gcs_windplan.planning.shaping.relax import relax, settle
from gcs_windplan.planning.shaping.shorten import shorten
from gcs_windplan.scene import Clearance

_CLOSER: Final = (1, 4, 16)  # times the wind's own sampling, one after the other, where that has missed something
_CLOSEST: Final = 256  # times the same, for the comparison: finer than what vertices have moved under
_ROUNDING: Final = 1e-9


def shape(points: FloatArray, cost: SectionCost, clearance: Clearance) -> FloatArray:
    """Few and good waypoints (m, 3) out of a graph's path (n, 3), never dearer than it in the chosen cost.

    Time, distance and energy are measured along any route, so vertices may leave the graph. The paper's angle and
    hybrid are made for the graph's edges: a vertex that is free to follow them would stroll along the wind, away from
    the goal. Their routes are shortened only.

    Where the wind jumps, a leg may pass through the bad side of the jump between two samples, and relaxing would
    collect such legs. So the result is compared with the path under closer sampling, and relaxed under that if need be.
    """
    if not cost.choice.leg_cost.leaves_graph:
        return shorten(points, cost, clearance)
    closest = cost.with_spare(SPARE / 2).closer(_CLOSEST)  # what is found between samples goes there
    limit = closest.of_polyline(points) * (1 + _ROUNDING)
    for times in _CLOSER:
        closer = cost.closer(times)
        shortened = shorten(points, closer, clearance)
        for shaped in (relax(shortened, closer, clearance), shortened):
            if closest.of_polyline(shaped) <= limit:
                return shaped
    return points


def shape_quickly(points: FloatArray, cost: SectionCost, clearance: Clearance) -> FloatArray:
    """Few waypoints (m, 3) in a quarter of the time that `shape` takes: good enough to compare routes by.

    Shortened, and the waypoints that are left moved once; no more of them are tried, and the wind is not looked at more
    closely. Over the Jacksboro fault that is 0.4 % above what `shape` finds. Never dearer than the path.
    """
    shortened = shorten(points, cost, clearance)
    if not cost.choice.leg_cost.leaves_graph:
        return shortened
    settled, price = settle(shortened, cost, clearance)
    return settled if price <= cost.of_polyline(shortened) else shortened
