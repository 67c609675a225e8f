"""The battery through a mission: what is left at each waypoint, and whether the reserve stays."""

from __future__ import annotations

import math
from dataclasses import dataclass

from gcs_windplan.errors import BatteryError
from gcs_windplan.flight import Flight
from gcs_windplan.request import Request


@dataclass(frozen=True, slots=True)
class BatteryUse:
    """What a flight takes [J], take-off and, where it lands, landing included.

    `left` is the share of the whole capacity that is left at each waypoint, in the request's wind. `total` is what must
    be reckoned with: over an ensemble the member at the request's quantile. `allowed` is the usable energy without the
    reserve.
    """

    left: tuple[float, ...]
    total: float
    usable: float
    allowed: float

    @property
    def missing(self) -> float:
        """By how much the reserve is broken [J], 0 where it stays."""
        return max(self.total - self.allowed, 0.0)


def battery_use(
    request: Request, flight: Flight, en_route: float | None = None, home_again: float = 0.0
) -> BatteryUse | None:
    """What a flight takes from the battery; None where the airframe is not known.

    `en_route` [J] takes the place of the flight's own energy between first and last waypoint; `home_again` [J] is what
    a return at the end takes.
    """
    airframe, totals = request.airframe, flight.totals
    if airframe is None or totals.energy is None or totals.takeoff_energy is None or totals.landing_energy is None:
        return None
    battery = airframe.battery
    drawn, left = totals.takeoff_energy, [1 - totals.takeoff_energy / battery.capacity]
    for leg in flight.legs:
        drawn += leg.energy or 0.0
        left.append(1 - drawn / battery.capacity)
    ends = totals.takeoff_energy + (totals.landing_energy if request.finish == "land" else home_again)
    total = ends + (totals.energy if en_route is None else max(en_route, totals.energy))
    return BatteryUse(tuple(left), total, battery.usable_energy, battery.energy_to_plan_with)


def refuse_overdrawn(use: BatteryUse | None) -> None:
    """Raise `BatteryError` for a flight that breaks the reserve, by how much."""
    if use is None or use.missing == 0:
        return
    total = f"{use.total / 3600:.0f} Wh" if math.isfinite(use.total) else "more than any battery gives"
    over = f" by {use.missing / 3600:.0f} Wh" if math.isfinite(use.missing) else ""
    raise BatteryError(
        f"the mission takes {total}, and with its reserve the battery gives {use.allowed / 3600:.0f} of"
        f" {use.usable / 3600:.0f} usable Wh: it breaks the reserve{over}. Another departure, a shorter way, a lower"
        " reserve in the airframe's file, or `plan --force`."
    )
