"""A mission as a vehicle flies it: items one after the other, and the home they count from."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

from gcs_windplan.errors import InputError
from gcs_windplan.geo.frame import GeoPoint
from gcs_windplan.mission.commands import command_name, frame_name, is_global, scales_place, takes_place
from gcs_windplan.vehicle import Autopilot, VehicleType

if TYPE_CHECKING:
    from gcs_windplan.mission.fence import Fence, RallyPoint


def degrees_e7(degrees: float) -> int:
    """Degrees as MAVLink's integer of 1e-7 degrees, rounded; truncation would be off by one now and then."""
    return round(degrees * 1e7)


@dataclass(frozen=True, slots=True)
class Home:
    """Where the vehicle is armed; `altitude` AMSL [m].

    >>> import gcs_windplan as gw
    >>> gw.Home(gw.GeoPoint(46.81, 9.84), 1560.0).altitude
    1560.0
    """

    point: GeoPoint
    altitude: float

    def __post_init__(self) -> None:
        if not math.isfinite(self.altitude):
            raise InputError(f"home's altitude is {self.altitude}; give metres above mean sea level")


@dataclass(frozen=True, slots=True, repr=False)
class MissionItem:
    """One item: a command with its first four parameters and, for most, a place.

    `altitude` [m] is AMSL, above home or above ground, as `frame` says. A parameter may be NaN ("leave it to
    the vehicle"). For a command without a place `latitude_deg`, `longitude_deg` and `altitude` are its
    parameters 5 to 7. DO_JUMP's first parameter counts items from 1, home being 0, as in files and on
    ArduPilot; PX4 counts one less.

    >>> import gcs_windplan as gw
    >>> gw.MissionItem(3, 16, latitude_deg=46.81, longitude_deg=9.84, altitude=60.0).has_place  # a waypoint above home
    True
    """

    frame: int
    command: int
    params: tuple[float, float, float, float] = (0.0, 0.0, 0.0, 0.0)
    latitude_deg: float = 0.0
    longitude_deg: float = 0.0
    altitude: float = 0.0
    autocontinue: bool = True

    def __post_init__(self) -> None:
        self._check_numbers()
        self._check_place()
        # one and the same NaN, so that items with it compare equal
        p1, p2, p3, p4 = (math.nan if math.isnan(param) else float(param) for param in self.params)
        object.__setattr__(self, "params", (p1, p2, p3, p4))

    def _check_numbers(self) -> None:
        if not 0 <= self.command <= 65535:
            raise InputError(f"command {self.command} is not between 0 and 65535")
        if not 0 <= self.frame <= 255:
            raise InputError(f"frame {self.frame} is not between 0 and 255")
        if len(self.params) != 4 or any(math.isinf(param) for param in self.params):
            raise InputError(f"parameters {self.params} are not four numbers, each finite or NaN")

    def _check_place(self) -> None:
        place = (self.latitude_deg, self.longitude_deg, self.altitude)
        if not all(math.isfinite(number) for number in place):
            raise InputError(f"the place {place} of {command_name(self.command)} is not finite")
        if takes_place(self.command) and is_global(self.frame):
            GeoPoint(self.latitude_deg, self.longitude_deg)  # raises for a place that is not on Earth

    @property
    def has_place(self) -> bool:
        """Whether the item names a place on Earth; latitude and longitude both zero mean "here"."""
        on_earth = takes_place(self.command) and is_global(self.frame)
        return on_earth and not self.latitude_deg == self.longitude_deg == 0

    @property
    def x(self) -> int:
        """MISSION_ITEM_INT's x: the latitude [1e-7 deg], or parameter 5 as it is."""
        return self.lat_e7 if scales_place(self.command, self.frame) else round(self.latitude_deg)

    @property
    def y(self) -> int:
        """MISSION_ITEM_INT's y: the longitude [1e-7 deg], or parameter 6 as it is."""
        return self.lon_e7 if scales_place(self.command, self.frame) else round(self.longitude_deg)

    @property
    def lat_e7(self) -> int:
        """The latitude [1e-7 deg]."""
        return degrees_e7(self.latitude_deg)

    @property
    def lon_e7(self) -> int:
        """The longitude [1e-7 deg]."""
        return degrees_e7(self.longitude_deg)

    def __repr__(self) -> str:
        params = ", ".join(f"{param:g}" for param in self.params)
        place = f"{self.latitude_deg:.7f}, {self.longitude_deg:.7f}, {self.altitude:.3f}"
        end = "" if self.autocontinue else ", waits"
        return f"<{command_name(self.command)} ({params}) at {place} in {frame_name(self.frame)}{end}>"


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
        if self.autopilot not in (None, "ardupilot", "px4"):
            raise InputError(f"autopilot {self.autopilot!r} is neither 'ardupilot' nor 'px4'")
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
