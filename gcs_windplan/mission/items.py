"""The items of a mission, and the home that they count from."""

from __future__ import annotations

import math
from dataclasses import dataclass

from gcs_windplan.errors import InputError
from gcs_windplan.geo.frame import GeoPoint
from gcs_windplan.mission.commands import (
    command_name,
    frame_name,
    is_global,
    scales_place,
    takes_place,
)


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
