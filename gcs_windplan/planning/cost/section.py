"""A cost at work on one section of a route, between two sites."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from gcs_windplan.arrays import BoolArray, FloatArray
from gcs_windplan.errors import InputError, Problem
from gcs_windplan.flight.sampling import (
    LegIntegrals,
    clocked,
    integrate_each,
    performance_of,
    sample_legs,
    still_air_times,
)
from gcs_windplan.flight.wind_limits import NO_LIMITS, WindLimits
from gcs_windplan.kernels import edges as kernel
from gcs_windplan.kernels.power import PowerGrid, integrate_prices
from gcs_windplan.kernels.triangle import Performance
from gcs_windplan.planning.cost.bounds import least_prices
from gcs_windplan.planning.cost.choice import CostChoice
from gcs_windplan.planning.cost.leg_costs import LegFigures
from gcs_windplan.vehicle import Vehicle
from gcs_windplan.wind.field import WindField


@dataclass(frozen=True, slots=True, eq=False)
class SectionCost:
    """A cost at work: for one vehicle in one wind, between two sites.

    `edge_length` is the length of an ordinary edge of the veil, `straight` that of the line from start to goal [m];
    `begin` is when the start is left [s since departure]. With `members` of an ensemble a leg costs what it costs in
    the member at the `quantile` from the cheapest up; `wind` is then their mean. Along a leg
    the wind is looked at `finer` times as closely as its resolution asks for. With a `power` a leg costs its energy and
    what its time is worth [J], at the best of the airspeeds there; `energy` needs it, and `time` may have it: then
    least time is weighed against energy. `waypoint_seconds` is what slowing down at a waypoint takes the
    vehicle; legs do not cost it, but shaping drops waypoints that gain less. Beyond the `limits` of wind no leg flies.
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
    waypoint_seconds: float = 0.0
    limits: WindLimits = NO_LIMITS

    def __post_init__(self) -> None:
        if self.choice.leg_cost.needs_power and self.power is None:
            raise InputError(Problem(f"{self.choice} asks for the vehicle's power: name its `airframe`", "cost"))

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
    def waypoint_penalty(self) -> float:
        """What a waypoint takes, in the cost's own unit; nothing where that is no matter of time."""
        if self.power is not None:
            return self.waypoint_seconds * float(
                np.median(self.power.watts[np.isfinite(self.power.watts)]) + self.power.cost_index
            )
        return self.choice.leg_cost.waypoint_penalty(self.waypoint_seconds)

    def least_in(self, seconds: float) -> float:
        """What a way that lasts so long [s] costs at least."""
        if self.power is not None:
            return seconds * (float(self.power.watts.min()) + self.power.cost_index)
        return self.choice.leg_cost.least_in(seconds)

    @property
    def rank(self) -> int:
        """How many members undercut the one that counts."""
        return rank_of(self.quantile, len(self.members)) if self.members else 0

    def too_many(self, closed: BoolArray) -> BoolArray:
        """What (n,) is closed in more members (members, n) than may be left out."""
        many: BoolArray = closed.sum(axis=0) > len(closed) - 1 - self.rank
        return many

    def scratch(self) -> FloatArray | None:
        """What the kernels note down for each member; None where there are none."""
        return np.empty((2, len(self.members))) if self.members else None

    def _measured(self, starts: FloatArray, ends: FloatArray, when: FloatArray | None) -> tuple[FloatArray, FloatArray]:
        """Cost and seconds of legs, (n,) each."""
        winds = self.members or (self.wind,)
        if self.power is not None:
            return self._priced_by_power(self.power, winds, starts, ends, when)
        parts = integrate_each(winds, self.vehicle, starts, ends, when, finer=self.finer, limits=self.limits)
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
        legs = sample_legs(winds, self.vehicle, starts, ends, when, finer=self.finer, limits=self.limits)
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
        vectors = ends - starts
        legs = LegFigures(
            parts.seconds, parts.angle, np.linalg.norm(vectors, axis=1), vectors[:, 2], self.edge_length, self.straight,
            self.choice.angle, self.choice.distance,
        )  # fmt: skip
        return np.where(np.isfinite(parts.seconds), self.choice.leg_cost.price(legs), np.inf)

    def closer(self, times: float) -> SectionCost:
        """The same cost, but the wind along a leg is looked at so many times more closely."""
        return replace(self, finer=self.finer * times)

    def with_spare(self, spare: float) -> SectionCost:
        """The same cost with another share of the limits of wind kept free."""
        return replace(self, limits=self.limits.with_spare(spare)) if self.limits else self

    def setting(self, goal: FloatArray, winds: FloatArray) -> kernel.Setting:
        """The search kernels' settings for a goal (3,) in the nodes' winds (..., 3), at all times, in all members."""
        if winds.shape == (len(winds), 4):  # steady, with limits: nobody flies in stronger winds
            winds = winds[~(winds[:, 3] > 1.0)]
        winds = winds.reshape(-1, winds.shape[-1])
        centre, radius = enclosing_ball(winds)
        if radius > self.limits.wind:  # nor where it changes, between two of its times
            centre, radius = np.zeros(2), self.limits.wind
        if self.vehicle.speed_model == "paper" and np.hypot(*centre) > 0.5 * (self.vehicle.airspeed + radius):
            centre, radius = np.zeros(2), float(np.fmax.reduce(np.hypot(winds[:, 0], winds[:, 1]), initial=0.0))
        return kernel.Setting(
            code=kernel.ENERGY if self.power is not None else self.choice.leg_cost.code,
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

        Prices of energy have lower bounds (`bounds`), best along the way from the start (3,).
        """
        if self.power is not None:
            return least_prices(points, setting, self.power, start)
        return self.choice.leg_cost.estimates(self.wind, points, goal)

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
