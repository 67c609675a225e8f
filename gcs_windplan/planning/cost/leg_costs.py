"""The costs that a route is chosen by: one small class each. To add one, write its class and enter it in `COSTS`.

In the search an edge costs what the kernels in `kernels/edges.py` say by the cost's code. For legs of any length, as
shaping makes them, each cost has a form that adds up along a polyline. For distance and time that is the same measure.
The paper's angle is counted once an edge, however long: a single leg against the wind would be "better" than ten short
ones down it. So here a leg costs its mean angle times its length in ordinary edges; and hybrid, in which the paper's
search counts distance only as what remains to the goal, adds the leg's length as a share of the straight line. By that
measure shaping compares; it is not the number that A* adds up.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Final, Protocol

import numpy as np

from gcs_windplan.arrays import FloatArray
from gcs_windplan.flight import clock
from gcs_windplan.kernels import edges as kernel
from gcs_windplan.kernels.power import PowerGrid
from gcs_windplan.kernels.triangle import mean_angles
from gcs_windplan.wind.field import WindField

_ESTIMATE_SAMPLES = 16
_ESTIMATE_BATCH = 50_000  # nodes at a time, so that memory stays bounded


@dataclass(frozen=True, slots=True, eq=False)
class LegFigures:
    """What n legs come to, each (n,): seconds, ∫angle ds [rad m], length and climb [m]; infinite seconds: not flyable.

    `edge_length` is that of an ordinary edge, `straight` that of the line from start to goal [m].
    """

    seconds: FloatArray
    angle: FloatArray
    lengths: FloatArray
    climbs: FloatArray
    edge_length: float
    straight: float
    angle_weight: float
    distance_weight: float


class LegCost(Protocol):
    """What a route is chosen by.

    `name` is that in mission files, `unit` that of the cost; `code` is what the search's kernels know it by. Under
    costs that are measured along any route vertices may leave the graph when it is shaped (`leaves_graph`). `of_air`:
    whether it depends on what the wind does to the speed; over an ensemble the members' mean is then tried as well.
    """

    name: str
    unit: str
    code: float
    leaves_graph: bool = True
    of_air: bool = False
    needs_power: bool = False

    def price(self, legs: LegFigures) -> FloatArray:
        """The cost of legs (n,) that can be flown."""
        ...

    def power(self, power: PowerGrid | None, cost_index: float) -> PowerGrid | None:
        """The power by which legs are priced instead, if any, where the value of a second is `cost_index` [W]."""
        return None

    def value_of_time(self, cost_index: float) -> float:
        """The value of a second [W] when airspeeds are chosen; infinite: the fastest."""
        return 0.0

    def least_in(self, seconds: float) -> float:
        """What a way that lasts so long [s] costs at least."""
        return 0.0

    def waypoint_penalty(self, seconds: float) -> float:
        """What a waypoint takes at which the vehicle loses so many seconds; 0 where time is no matter."""
        return 0.0

    def estimates(self, wind: WindField, points: FloatArray, goal: FloatArray) -> FloatArray:
        """The estimates from nodes (n, 3) to the goal (3,) where the kernels have none of their own, else empty."""
        return np.empty(0)

    def words(self, amount: float) -> str | None:
        """An amount of it for people; None where it means nothing to them."""
        return None


class Distance(LegCost):
    """The length of the way."""

    name, unit, code = "distance", "m", kernel.DISTANCE

    def price(self, legs: LegFigures) -> FloatArray:
        """The legs' lengths [m]."""
        return legs.lengths

    def words(self, amount: float) -> str:
        """Kilometres."""
        return f"{amount / 1000:.2f} km"


class Angle(LegCost):
    """The paper's angle between track and wind (10), once an edge."""

    name, unit, code = "angle", "rad", kernel.ANGLE
    leaves_graph = False

    def price(self, legs: LegFigures) -> FloatArray:
        """The mean angle times the length in ordinary edges."""
        return legs.angle / legs.edge_length

    def estimates(self, wind: WindField, points: FloatArray, goal: FloatArray) -> FloatArray:
        """The mean angle between the wind and the straight line to the goal, here at 16 places of that line: (10).

        It overestimates routes of a single short edge, so A* with it is not optimal.
        """
        estimates = np.zeros(len(points))
        fractions = (np.arange(_ESTIMATE_SAMPLES) + 0.5) / _ESTIMATE_SAMPLES
        for begin in range(0, len(points), _ESTIMATE_BATCH):
            batch = points[begin : begin + _ESTIMATE_BATCH]
            known = np.flatnonzero(np.isfinite(batch).all(axis=1))
            vectors = goal - batch[known]
            places = batch[known, None, :] + fractions[:, None] * vectors[:, None, :]
            winds = np.ascontiguousarray(wind.at(places.reshape(-1, 3)))
            estimates[begin + known] = mean_angles(np.ascontiguousarray(vectors), winds)
        return estimates


class Hybrid(LegCost):
    """The paper's weighted sum of angle and distance (11)."""

    name, unit, code = "hybrid", "1", kernel.HYBRID
    leaves_graph = False

    def price(self, legs: LegFigures) -> FloatArray:
        """Both terms by their weights."""
        angle = legs.angle_weight * (legs.angle / legs.edge_length) / math.pi
        return angle + legs.distance_weight * legs.lengths / legs.straight


class Time(LegCost):
    """The time in flight; with a finite cost index weighed against energy."""

    name, unit, code = "time", "s", kernel.TIME
    of_air = True

    def price(self, legs: LegFigures) -> FloatArray:
        """The legs' seconds."""
        return legs.seconds

    def power(self, power: PowerGrid | None, cost_index: float) -> PowerGrid | None:
        """Power where the cost index is finite."""
        return None if power is None or math.isinf(cost_index) else power._replace(cost_index=cost_index)

    def value_of_time(self, cost_index: float) -> float:
        """The cost index."""
        return cost_index

    def least_in(self, seconds: float) -> float:
        """Just that."""
        return seconds

    def waypoint_penalty(self, seconds: float) -> float:
        """Just that."""
        return seconds

    def words(self, amount: float) -> str:
        """Minutes."""
        return f"{clock(amount)} min"


class Energy(LegCost):
    """What the vehicle draws: legs are priced by its power."""

    name, unit, code = "energy", "J", kernel.ENERGY
    of_air = True
    needs_power = True

    def price(self, legs: LegFigures) -> FloatArray:
        """Never asked: legs are priced by power."""
        raise NotImplementedError("energy is priced by power")

    def power(self, power: PowerGrid | None, cost_index: float) -> PowerGrid | None:
        """The vehicle's; time is worth nothing."""
        return power

    def words(self, amount: float) -> str:
        """Watt-hours."""
        return f"{amount / 3600:.0f} Wh"


#: All costs by their names, in the order in which they are told.
COSTS: Final[dict[str, LegCost]] = {cost.name: cost for cost in (Distance(), Angle(), Hybrid(), Time(), Energy())}
