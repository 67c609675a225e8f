"""The costs that a route is chosen by.

In the search an edge costs what the kernels in `kernels/edges.py` say. For legs of any length, as shaping makes
them, each cost has a form that adds up along a polyline. For distance and time that is the same measure. The paper's
angle is counted once an edge, however long: a single leg against the wind would be "better" than ten short ones down
it. So here a leg costs its mean angle times its length in ordinary edges; and hybrid, in which the paper's search
counts distance only as what remains to the goal, adds the leg's length as a share of the straight line. By that
measure shaping compares; it is not the number that A* adds up.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Literal, TypeAlias

import numpy as np

from gcs_windplan.arrays import FloatArray
from gcs_windplan.errors import InputError, Problem
from gcs_windplan.flight.sampling import (
    LegIntegrals,
    clocked,
    integrate_each,
    performance_of,
    sample_legs,
    still_air_times,
)
from gcs_windplan.kernels import edges as kernel
from gcs_windplan.kernels.power import PowerGrid, integrate_prices
from gcs_windplan.kernels.triangle import Performance, mean_angles
from gcs_windplan.planning.cost.bounds import least_prices
from gcs_windplan.vehicle import Vehicle
from gcs_windplan.wind.field import WindField

CostName: TypeAlias = Literal["distance", "angle", "hybrid", "time", "energy"]
COST_NAMES: tuple[CostName, ...] = ("distance", "angle", "hybrid", "time", "energy")

_ESTIMATE_SAMPLES = 16
_ESTIMATE_BATCH = 50_000  # nodes at a time, so that memory stays bounded

_CODES = {
    "distance": kernel.DISTANCE,
    "angle": kernel.ANGLE,
    "hybrid": kernel.HYBRID,
    "time": kernel.TIME,
    "energy": kernel.ENERGY,
}


@dataclass(frozen=True, slots=True)
class CostChoice:
    """Which cost, with the weights of the hybrid one (11).

    >>> import gcs_windplan as gw
    >>> print(gw.CostChoice("hybrid", distance=0.3, angle=0.7))
    hybrid (distance 0.3, angle 0.7)
    """

    name: CostName = "time"
    distance: float = 0.1
    angle: float = 0.9

    def __post_init__(self) -> None:
        if self.name not in COST_NAMES:
            raise InputError(Problem(f"'{self.name}' is no cost, choose {', '.join(COST_NAMES)}", "cost"))
        weights = (self.distance, self.angle)
        if not all(math.isfinite(w) and w >= 0 for w in weights) or sum(weights) == 0:
            raise InputError(Problem("the weights of hybrid must be 0 or more, and not both 0", "cost"))

    def __str__(self) -> str:
        if self.name == "hybrid":
            return f"hybrid (distance {self.distance:g}, angle {self.angle:g})"
        return self.name


@dataclass(frozen=True, slots=True, eq=False)
class LegCost:
    """A cost at work: for one vehicle in one wind, between two sites.

    `edge_length` is the length of an ordinary edge of the veil, `straight` that of the line from start to goal [m];
    `begin` is when the start is left [s since departure]. With `members` of an ensemble a leg costs what it costs in
    the member at the `quantile` from the cheapest up; `wind` is then their mean. Along a leg
    the wind is looked at `finer` times as closely as its resolution asks for. With a `power` a leg costs its energy and
    what its time is worth [J], at the best of the airspeeds there; `energy` needs it, and `time` may have it: then
    least time is weighed against energy. `corner` [s] is what slowing down at a waypoint takes the vehicle; legs do not
    cost it, but shaping drops waypoints that are not worth it.
    """

    choice: CostChoice
    wind: WindField
    vehicle: Vehicle
    edge_length: float
    straight: float
    begin: float = 0.0
    members: tuple[WindField, ...] = ()
    quantile: float = 0.5
    finer: float = 1.0
    power: PowerGrid | None = None
    corner: float = 0.0

    def __post_init__(self) -> None:
        if self.choice.name == "energy" and self.power is None:
            raise InputError(Problem("energy asks for the vehicle's power: name its `airframe`", "cost"))

    def of_legs(self, starts: FloatArray, ends: FloatArray, when: FloatArray | None = None) -> FloatArray:
        """The cost of straight legs (n, 3), shape (n,); infinite where one cannot be flown.

        `when` (n, 2) is at what time each begins and ends [s since departure]; without it the departure counts.
        """
        return self._measured(starts, ends, when)[0]

    def of_polyline(self, points: FloatArray) -> float:
        """The cost of a polyline (n, 3)."""
        return float(np.sum(self.priced(points)[0]))

    def priced(self, points: FloatArray, guess: FloatArray | None = None) -> tuple[FloatArray, FloatArray]:
        """The cost of each leg of a polyline (n, 3), and the times at its points (n,) [s since departure].

        `guess` (n,) are times to begin with.
        """
        times = still_air_times(points, self.vehicle, self.begin) if guess is None else guess
        return clocked(lambda when: self._measured(points[:-1], points[1:], when), times, self.changing)

    @property
    def changing(self) -> bool:
        """Whether the wind changes with time."""
        return len(self.wind.times) > 1

    @property
    def toll(self) -> float:
        """What a waypoint takes, in the cost's own unit; nothing where that is no matter of time."""
        if self.power is not None:
            return self.corner * float(np.median(self.power.watts[np.isfinite(self.power.watts)]) + self.power.worth)
        return self.corner if self.choice.name == "time" else 0.0

    def least_in(self, seconds: float) -> float:
        """What a way that lasts so long [s] costs at least."""
        if self.power is not None:
            return seconds * (float(self.power.watts.min()) + self.power.worth)
        return seconds if self.choice.name == "time" else 0.0

    @property
    def rank(self) -> int:
        """How many members undercut the one that counts."""
        return rank_of(self.quantile, len(self.members)) if self.members else 0

    def scratch(self) -> FloatArray | None:
        """What the kernels note down for each member; None where there are none."""
        return np.empty((2, len(self.members))) if self.members else None

    def _measured(self, starts: FloatArray, ends: FloatArray, when: FloatArray | None) -> tuple[FloatArray, FloatArray]:
        """Cost and seconds of legs, (n,) each."""
        winds = self.members or (self.wind,)
        if self.power is not None:
            return self._priced_by_power(self.power, winds, starts, ends, when)
        parts = integrate_each(winds, self.vehicle, starts, ends, when, self.finer)
        each = [self._price(part, starts, ends) for part in parts]
        if len(each) == 1:
            return each[0], parts[0].seconds
        costs, seconds = np.stack(each), np.stack([part.seconds for part in parts])
        chosen = np.argsort(costs, axis=0, kind="stable")[self.rank : self.rank + 1]
        return np.take_along_axis(costs, chosen, 0)[0], np.take_along_axis(seconds, chosen, 0)[0]

    def _priced_by_power(
        self,
        power: PowerGrid,
        winds: Sequence[WindField],
        starts: FloatArray,
        ends: FloatArray,
        when: FloatArray | None,
    ) -> tuple[FloatArray, FloatArray]:
        """Price [J] and seconds of legs, (n,) each, at the airspeed that makes each cheapest."""
        legs = sample_legs(winds, self.vehicle, starts, ends, when, self.finer)
        speeds = np.tile(power.airspeeds, (len(starts), 1))
        heights = np.ascontiguousarray(starts[:, 2])
        tables = [
            integrate_prices(
                legs.performance, power, speeds, legs.vectors, heights, legs.first, legs.weights, legs.shares, blows
            )
            for blows in legs.winds
        ]
        seconds = np.stack([legs.in_time(table[..., 1]) for table in tables])
        prices = np.where(np.isfinite(seconds), np.stack([table[..., 0] for table in tables]), np.inf)
        member = np.argsort(prices, axis=0, kind="stable")[self.rank]
        prices, seconds = (np.take_along_axis(table, member[None], 0)[0] for table in (prices, seconds))
        best = np.argmin(prices, axis=1)[:, None]
        return np.take_along_axis(prices, best, 1)[:, 0], np.take_along_axis(seconds, best, 1)[:, 0]

    def _price(self, parts: LegIntegrals, starts: FloatArray, ends: FloatArray) -> FloatArray:
        """What the chosen cost makes of legs (n,)."""
        if self.choice.name == "time":
            return parts.seconds
        lengths = np.linalg.norm(ends - starts, axis=1)
        angle = parts.angle / self.edge_length
        match self.choice.name:
            case "distance":
                cost = lengths
            case "angle":
                cost = angle
            case "hybrid":
                cost = self.choice.angle * angle / math.pi + self.choice.distance * lengths / self.straight
        return np.where(np.isfinite(parts.seconds), cost, np.inf)

    def closer(self, times: float) -> LegCost:
        """The same cost, but the wind along a leg is looked at so many times more closely."""
        return replace(self, finer=self.finer * times)

    def setting(self, goal: FloatArray, winds: FloatArray) -> kernel.Setting:
        """The search kernels' settings for a goal (3,) in the nodes' winds (..., 3), at all times, in all members."""
        winds = winds.reshape(-1, 3)
        centre, radius = enclosing_ball(winds)
        if self.vehicle.speed_model == "paper" and np.hypot(*centre) > 0.5 * (self.vehicle.airspeed + radius):
            centre, radius = np.zeros(2), float(np.fmax.reduce(np.hypot(winds[:, 0], winds[:, 1]), initial=0.0))
        return kernel.Setting(
            code=kernel.ENERGY if self.power is not None else _CODES[self.choice.name],
            goal_e=float(goal[0]),
            goal_n=float(goal[1]),
            goal_z=float(goal[2]),
            angle_weight=float(self.choice.angle),
            distance_weight=float(self.choice.distance),
            straight=float(self.straight),
            ball_e=float(centre[0]),
            ball_n=float(centre[1]),
            ball_radius=radius,
            ball_up=float(np.fmax.reduce(winds[:, 2], initial=0.0)),  # fmax: NaN where the wind is not known
            ball_down=float(np.fmax.reduce(-winds[:, 2], initial=0.0)),
        )

    def estimates(self, points: FloatArray, start: FloatArray, goal: FloatArray, setting: kernel.Setting) -> FloatArray:
        """The estimates from nodes (n, 3) to the goal (3,) where the kernels have none of their own, else empty.

        Prices of energy have lower bounds (`bounds`), best along the way from the start (3,). `angle` needs its
        estimates here as well: (10) takes the mean angle between the wind and the straight line to the goal, here at 16
        places of that line. It overestimates routes of a single short edge, so A* with it is not optimal.
        """
        if self.power is not None:
            return least_prices(points, setting, self.power, start)
        if self.choice.name != "angle":
            return np.empty(0)
        estimates = np.zeros(len(points))
        fractions = (np.arange(_ESTIMATE_SAMPLES) + 0.5) / _ESTIMATE_SAMPLES
        for begin in range(0, len(points), _ESTIMATE_BATCH):
            batch = points[begin : begin + _ESTIMATE_BATCH]
            known = np.flatnonzero(np.isfinite(batch).all(axis=1))
            vectors = goal - batch[known]
            places = batch[known, None, :] + fractions[:, None] * vectors[:, None, :]
            winds = np.ascontiguousarray(self.wind.at(places.reshape(-1, 3)))
            estimates[begin + known] = mean_angles(np.ascontiguousarray(vectors), winds)
        return estimates

    def performance(self) -> Performance:
        """The vehicle as the kernels take it."""
        return performance_of(self.vehicle)


def rank_of(quantile: float, members: int) -> int:
    """The place of the member at a quantile, from 0: of 10 members 0.9 is the 9th, place 8."""
    return min(max(math.ceil(quantile * members - 1e-9) - 1, 0), members - 1)


def enclosing_ball(winds: FloatArray) -> tuple[FloatArray, float]:
    """A disc (centre (2,), radius [m/s]) around all winds (n, 2 or more) about the middle of their box, but NaN."""
    if len(winds) == 0 or np.isnan(winds[:, 0]).all():
        return np.zeros(2), 0.0
    east, north = winds[:, 0], winds[:, 1]
    centre = np.array([(np.fmin.reduce(axis) + np.fmax.reduce(axis)) / 2 for axis in (east, north)])
    squares = (east - centre[0]) ** 2
    squares += (north - centre[1]) ** 2
    return centre, math.sqrt(np.fmax.reduce(squares))
