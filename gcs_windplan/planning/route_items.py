"""From a planned route to mission items, by the rules of the autopilot that shall fly them.

ArduCopter flies every AUTO leg at one ground speed, the parameter's or the last commanded one, whatever the
wind (measured in its simulator: 10 m/s commanded, 9.98 m/s in still air and in 5 m/s of tail wind). A plan
that uses the wind must therefore command each leg's ground speed, with a DO_CHANGE_SPEED before it. A fixed-wing holds
an airspeed, and so that is what it is told.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, TypeAlias

from gcs_windplan.errors import InputError
from gcs_windplan.geo.frame import GeoPoint, LocalFrame
from gcs_windplan.mission.commands import Command, Frame
from gcs_windplan.mission.items import Home, MissionItem, MissionItems
from gcs_windplan.vehicle import Autopilot, VehicleType

if TYPE_CHECKING:
    from gcs_windplan.planning.request import AltitudeReference, Finish

Params: TypeAlias = tuple[float, float, float, float]

_SPEED_STEP = 0.1  # [m/s] smaller changes are not commanded
_SAME_PLACE = 1.0  # [m] half of ArduCopter's default waypoint radius (WPNAV_RADIUS)
_FIXED_WING_PITCH = 15.0  # [deg] least pitch in a fixed-wing take-off, as in ArduPilot's own test missions
_NEARLY_ZERO = 0.02  # [m] survives ArduPilot's truncation to centimetres
_AIRSPEED, _GROUND_SPEED = 0.0, 1.0  # MAVLink SPEED_TYPE_AIRSPEED, SPEED_TYPE_GROUNDSPEED
_SAME_THROTTLE = -1.0  # MAVLink: no change


@dataclass(frozen=True, slots=True)
class RoutePoint:
    """A point of a planned route; `altitude` AMSL [m].

    `ground_speed` is the planned horizontal ground speed [m/s] of the leg that ends here, `airspeed` what a fixed-wing
    is to hold on it; None for the first point, and where none is to be commanded.
    """

    point: GeoPoint
    altitude: float
    ground_speed: float | None = None
    airspeed: float | None = None

    def __post_init__(self) -> None:
        if not math.isfinite(self.altitude):
            raise InputError(f"the altitude {self.altitude} of the route point {self.point} is not finite")
        for name, speed in (("ground speed", self.ground_speed), ("airspeed", self.airspeed)):
            if speed is not None and not 0.01 <= speed < math.inf:
                raise InputError(f"the {name} {speed} m/s to {self.point} is not at least 0.01 m/s")


def route_mission(
    home: Home,
    route: Sequence[RoutePoint],
    *,
    autopilot: Autopilot,
    vehicle_type: VehicleType,
    finish: Finish,
    altitude: AltitudeReference,
    speed_changes: bool,
    cruise_speed: float | None = None,
    landing_altitude: float | None = None,
) -> MissionItems:
    """The mission that takes off at home, flies the route and finishes by landing, returning or holding.

    `landing_altitude` is the ground's height AMSL [m] at the last point, needed to land there. `cruise_speed`
    [m/s] is only noted for ground stations. With `speed_changes` the speed of each leg is commanded
    before it, as long as it differs by 0.1 m/s or more from the last one commanded. Raises InputError where
    route and wishes contradict.
    """
    if not route:
        raise InputError("the route has no points; a mission needs at least one")
    if route[0].altitude <= home.altitude:
        raise InputError(
            f"the route begins at {route[0].altitude:.1f} m, not above home at {home.altitude:.1f} m: "
            "raise its first point"
        )
    if altitude not in ("relative", "amsl"):
        raise InputError(f"altitude {altitude!r} is neither 'relative' nor 'amsl'")
    writer = _ItemWriter(home, autopilot, altitude)
    items = (
        writer.take_off(route[0].altitude, vehicle_type),
        *_legs(writer, route, speed_changes),
        *_ending(writer, route[-1].point, finish, landing_altitude),
    )
    return MissionItems(items, home, autopilot, vehicle_type, cruise_speed, cruise_speed)


@dataclass(frozen=True, slots=True)
class _ItemWriter:
    """Knows how an autopilot wants its items. ArduPilot: never NaN. PX4: NaN yaw, MISSION without a place."""

    home: Home
    autopilot: Autopilot
    reference: AltitudeReference

    def take_off(self, amsl: float, vehicle_type: VehicleType) -> MissionItem:
        pitch = _FIXED_WING_PITCH if vehicle_type == "fixed-wing" else 0.0
        return self.at_place(Command.NAV_TAKEOFF, self.home.point, self._height(amsl), pitch)

    def waypoint(self, target: RoutePoint) -> MissionItem:
        height = self._height(target.altitude)
        if self.autopilot == "ardupilot" and self.reference == "relative" and abs(height) < _NEARLY_ZERO:
            height = _NEARLY_ZERO  # ArduPilot takes a relative altitude of 0 for "stay as high as you are"
        return self.at_place(Command.NAV_WAYPOINT, target.point, height)

    def land(self, point: GeoPoint, amsl: float) -> MissionItem:
        return self.at_place(Command.NAV_LAND, point, self._height(amsl))

    def at_place(self, command: Command, point: GeoPoint, height: float, param1: float = 0.0) -> MissionItem:
        frame = Frame.GLOBAL_RELATIVE_ALT if self.reference == "relative" else Frame.GLOBAL
        yaw = math.nan if self.autopilot == "px4" else 0.0
        params = (param1, 0.0, 0.0, yaw)
        return MissionItem(frame, command, params, point.latitude_deg, point.longitude_deg, height)

    def without_place(self, command: Command, params: Params = (0.0, 0.0, 0.0, 0.0)) -> MissionItem:
        # ArduPilot does not look at the frame of such items and gives them back in GLOBAL
        return MissionItem(Frame.MISSION if self.autopilot == "px4" else Frame.GLOBAL, command, params)

    def _height(self, amsl: float) -> float:
        return amsl - self.home.altitude if self.reference == "relative" else amsl


def _legs(writer: _ItemWriter, route: Sequence[RoutePoint], speed_changes: bool) -> Iterator[MissionItem]:
    if _apart(writer.home.point, route[0].point) > _SAME_PLACE:
        yield writer.waypoint(route[0])
    commanded = -math.inf
    for target in route[1:]:
        kind, told = (_GROUND_SPEED, target.ground_speed) if target.airspeed is None else (_AIRSPEED, target.airspeed)
        if speed_changes and told is not None:
            speed = round(told, 2)
            if abs(speed - commanded) >= _SPEED_STEP - 1e-9:
                commanded = speed
                yield writer.without_place(Command.DO_CHANGE_SPEED, (kind, speed, _SAME_THROTTLE, 0.0))
        yield writer.waypoint(target)


def _ending(
    writer: _ItemWriter, goal: GeoPoint, finish: Finish, landing_altitude: float | None
) -> Iterator[MissionItem]:
    if finish == "land":
        if landing_altitude is None:
            raise InputError("to land at the goal the height of the ground there is needed (landing_altitude)")
        yield writer.land(goal, landing_altitude)
    elif finish == "return":
        yield writer.without_place(Command.NAV_RETURN_TO_LAUNCH)
    elif finish != "hold":
        raise InputError(f"finish {finish!r} is none of 'land', 'return', 'hold'")


def _apart(a: GeoPoint, b: GeoPoint) -> float:
    """Metres between two near places."""
    east, north = LocalFrame(a).to_local(b.latitude_deg, b.longitude_deg)[0]
    return math.hypot(east, north)
