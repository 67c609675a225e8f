"""A mission as a vehicle flies it: items one after the other, home, fence and rally points."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

from gcs_windplan.errors import InputError
from gcs_windplan.mission.fence import Fence, RallyPoint
from gcs_windplan.mission.firmware import check_autopilot
from gcs_windplan.mission.items import Home, MissionItem
from gcs_windplan.vehicle import Autopilot, VehicleType


@dataclass(frozen=True, slots=True, repr=False)
class MissionItems:
    """Items in their order, what is known of home and vehicle, and the fence and rally points beside them.

    Home is not among `items`: it becomes row 0 of a .waypoints file and item 0 on ArduPilot when written
    there. `cruise_speed` (fixed-wing) and `hover_speed` (multicopter) [m/s] are what a ground station reckons
    with. Fence and rally points travel apart from the items (`fence_items`, `rally_items`).

    >>> import gcs_windplan as gw
    >>> home = gw.Home(gw.GeoPoint(46.81, 9.84), 1560.0)
    >>> gw.MissionItems((gw.MissionItem(3, 22, altitude=60.0),), home, "ardupilot", "multicopter").rally
    ()
    """

    items: tuple[MissionItem, ...]
    home: Home | None = None
    autopilot: Autopilot | None = None
    vehicle_type: VehicleType | None = None
    cruise_speed: float | None = None
    hover_speed: float | None = None
    fence: Fence | None = None
    rally: tuple[RallyPoint, ...] = ()

    def __post_init__(self) -> None:
        if self.autopilot is not None:
            check_autopilot(self.autopilot)
        if self.vehicle_type not in (None, "multicopter", "fixed-wing"):
            raise InputError(f"vehicle type {self.vehicle_type!r} is neither 'multicopter' nor 'fixed-wing'")
        for name, speed in (("cruise", self.cruise_speed), ("hover", self.hover_speed)):
            if speed is not None and not 0 < speed < math.inf:
                raise InputError(f"{name} speed {speed} m/s is not a positive number")

    def __repr__(self) -> str:
        home = "no home" if self.home is None else f"home {self.home.point}, {self.home.altitude:.1f} m"
        vehicle = ", ".join(word for word in (self.autopilot, self.vehicle_type) if word is not None)
        beside = [] if self.fence is None else ["a fence"]
        beside += [f"{len(self.rally)} rally points"] if self.rally else []
        return (
            f"<{', '.join(part for part in (f'Mission of {len(self.items)} items', home, vehicle, *beside) if part)}>"
        )

    def without_fence(self) -> MissionItems:
        """The mission without fence and rally points, for formats that have no place for them."""
        return replace(self, fence=None, rally=())
