"""The shaping that a cost asks for."""

from __future__ import annotations

from gcs_windplan.arrays import FloatArray
from gcs_windplan.cost import LegCost
from gcs_windplan.shaping.relax import relax
from gcs_windplan.shaping.shorten import shorten
from gcs_windplan.veil import Clearance


def shape(points: FloatArray, cost: LegCost, clearance: Clearance) -> FloatArray:
    """Few and good waypoints (m, 3) out of a graph's path (n, 3), never dearer than it in the chosen cost.

    Time and distance are measured along any route, so vertices may leave the graph. The paper's angle and hybrid are
    made for the graph's edges: a vertex that is free to follow them would stroll along the wind, away from the goal.
    Their routes are shortened only.
    """
    shortened = shorten(points, cost, clearance)
    return relax(shortened, cost, clearance) if cost.choice.name in ("time", "distance") else shortened
