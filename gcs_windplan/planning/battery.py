"""The battery through a mission: what is left at each waypoint, and whether what must be left stays."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import Final

import numpy as np

from gcs_windplan.arrays import FloatArray
from gcs_windplan.errors import BatteryError
from gcs_windplan.flight import Flight
from gcs_windplan.mission.firmware import firmware_of
from gcs_windplan.planning.request import Request
from gcs_windplan.vehicle import (
    air_density,
    as_flown,
    landing_seconds,
    takeoff_seconds,
)

_FASTEST: Final = 1000.0  # [m/s] no limit: the planned ground speeds have the wind in them
_SLOWEST: Final = 0.01  # [m/s] or [s]
_LEVEL: Final = 1.0  # [m] a leg shorter than this in plan is a climb or descent on the spot


@dataclass(frozen=True, slots=True)
class Allowance:
    """What a flight may draw by one rule [J]; `rule` in words."""

    rule: str
    energy: float


@dataclass(frozen=True, slots=True)
class BatteryUse:
    """What a flight takes [J], take-off and, where it lands, landing included.

    `left` is the share of the whole capacity that is left at each waypoint, in the request's wind. `total` is what must
    be reckoned with: over an ensemble the member at the request's quantile. `allowed` is what the flight may draw: the
    least of the `allowances`.
    """

    left: tuple[float, ...]
    total: float
    usable: float
    allowances: tuple[Allowance, ...]

    @property
    def allowed(self) -> float:
        """What the flight may draw [J]."""
        return max(min(one.energy for one in self.allowances), 0.0)

    @property
    def missing(self) -> float:
        """By how much the strictest rule is broken [J], 0 where all are kept."""
        return max(self.total - self.allowed, 0.0)

    @property
    def broken(self) -> tuple[Allowance, ...]:
        """The rules that the flight breaks."""
        return tuple(one for one in self.allowances if self.total > one.energy)


def allowances_of(request: Request, height: float) -> tuple[Allowance, ...]:
    """What a flight may draw from the battery by each rule; all of them hold, so the least counts.

    Of the whole capacity C [J], of which U is usable, must be left on landing:

        the airframe's reserve r    (C - U) + r U           what is not usable, and a share of what is
        limits.battery b            b C                     a share of all, what is not usable within it
        limits.reserve t            (C - U) + t P           what is not usable, and t [s] at P [W]

    where P is the power of level flight at the vehicle's airspeed, at a `height` above mean sea level [m]. None where
    no airframe is known.
    """
    airframe, limits = request.airframe, request.limits
    if airframe is None:
        return ()
    battery = airframe.battery
    rules = [Allowance("the reserve", battery.energy_to_plan_with)]
    if limits.battery is not None:
        rule = f"limits.battery ({100 * limits.battery:g} % left of {battery.capacity / 3600:.0f} Wh)"
        rules.append(Allowance(rule, (1 - limits.battery) * battery.capacity))
    if limits.reserve_seconds is not None:
        watts = float(airframe.power.watts(request.vehicle.airspeed, 0.0, air_density(height)))
        rule = f"limits.reserve ({limits.reserve_seconds / 60:g} min at {watts:.0f} W)"
        rules.append(Allowance(rule, battery.usable_energy - limits.reserve_seconds * watts))
    return tuple(rules)


def battery_use(
    request: Request, flight: Flight, en_route: float | None = None, home_again: float = 0.0
) -> BatteryUse | None:
    """What a flight takes from the battery as the autopilot flies it; None where the airframe is not known.

    `en_route` [J] takes the place of the flight's own energy between first and last waypoint; `home_again` [J] is what
    a return at the end takes.
    """
    airframe, totals = request.airframe, flight.totals
    if airframe is None or totals.energy is None or totals.takeoff_energy is None or totals.landing_energy is None:
        return None
    battery, longer = airframe.battery, _longer(request, flight)
    takeoff, landing = totals.takeoff_energy * longer[0], totals.landing_energy * longer[-1]
    legs = [(leg.energy or 0.0) * share for leg, share in zip(flight.legs, longer[1:-1], strict=True)]
    drawn = takeoff + np.append(0.0, np.cumsum(legs))
    left = tuple((1 - drawn / battery.capacity).tolist())
    ends = takeoff + (landing if request.finish == "land" else home_again)
    flown = math.fsum(legs)
    total = ends + (flown if en_route is None else max(en_route * flown / totals.energy, flown))
    height = math.fsum(waypoint.altitude for waypoint in flight.waypoints) / len(flight.waypoints)
    return BatteryUse(left, total, battery.usable_energy, allowances_of(request, height))


def _longer(request: Request, flight: Flight) -> FloatArray:
    """How many times as long take-off, legs and landing (n + 2,) last as the autopilot flies them, at the same power.

    A multicopter slows at corners and gains speed again, and lands slowly; its own law (`vehicle/pace.py`) says how
    slowly. Never shorter than planned.
    """
    longer = np.ones(len(flight.legs) + 2)
    totals = flight.totals
    if not request.vehicle.hovers:
        return longer
    pace = replace(firmware_of(request.vehicle.autopilot).motion, airspeed=_FASTEST)
    points = np.array([(waypoint.east, waypoint.north, waypoint.altitude) for waypoint in flight.waypoints])
    told = np.array([leg.ground_speed if leg.distance >= _LEVEL else pace.speed for leg in flight.legs])
    seconds = as_flown(points, np.maximum(told, _SLOWEST), pace=pace).seconds
    planned = np.array([leg.seconds for leg in flight.legs])
    longer[1:-1] = seconds / np.maximum(planned, _SLOWEST)
    first, last = flight.waypoints[0].above_ground, flight.waypoints[-1].above_ground
    longer[0] = takeoff_seconds(first, pace, request.vehicle.climb) / max(totals.takeoff_seconds, _SLOWEST)
    longer[-1] = landing_seconds(last, pace, request.vehicle.descent) / max(totals.landing_seconds, _SLOWEST)
    return np.maximum(longer, 1.0)


def refuse_overdrawn(use: BatteryUse | None) -> None:
    """Raise `BatteryError` for a flight that leaves too little: by which rules, and by how much."""
    if use is None or use.missing == 0:
        return
    total = f"{use.total / 3600:.0f} Wh" if math.isfinite(use.total) else "more than any battery gives"
    over = [
        one.rule + (f" by {(use.total - one.energy) / 3600:.0f} Wh" if math.isfinite(use.total) else "")
        for one in use.broken
    ]
    raise BatteryError(
        f"the mission takes {total}, and with what must be left the battery gives {use.allowed / 3600:.0f} of"
        f" {use.usable / 3600:.0f} usable Wh: it breaks {' and '.join(over)}. Another departure, a shorter way, less to"
        " be left (limits, or the airframe's reserve), or `plan --force`."
    )
