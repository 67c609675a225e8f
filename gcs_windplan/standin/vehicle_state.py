"""The stand-in's state: body, home and surroundings, and what it has to say."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TypeAlias

import numpy as np

from gcs_windplan.geo.frame import GeoPoint
from gcs_windplan.mission import Command, Frame, degrees_e7, plain_frame
from gcs_windplan.mission.firmware import Firmware
from gcs_windplan.standin.items import StoredItem
from gcs_windplan.standin.local_wind import LocalWind
from gcs_windplan.standin.manoeuvres import Manoeuvres
from gcs_windplan.standin.motion import Body
from gcs_windplan.standin.pace import Vector
from gcs_windplan.standin.world import World
from gcs_windplan.vehicle import MotionProfile

REACH = 500_000.0  # [m] a place farther than this from home lies outside of the flat local frame


@dataclass(frozen=True, slots=True)
class Reached:
    """An item was completed: MISSION_ITEM_REACHED."""

    seq: int


@dataclass(frozen=True, slots=True)
class Current:
    """An item has become the current one: MISSION_CURRENT."""

    seq: int


@dataclass(frozen=True, slots=True)
class Said:
    """Something for the log and the ground station: STATUSTEXT."""

    words: str


Event: TypeAlias = Reached | Current | Said


class VehicleState:
    """Where the vehicle is, what it stands on, and the events that nobody has taken yet."""

    def __init__(self, firmware: Firmware, profile: MotionProfile, world: World) -> None:
        self.firmware = firmware
        self.armed = False
        self.landed = True
        self.events: list[Event] = []
        self._profile = profile
        self.settle(world)

    def settle(self, world: World) -> None:
        """Stand on the ground of a world."""
        self.world, self.home = world, world.home
        place = world.frame.to_local(world.home.point.latitude_deg, world.home.point.longitude_deg)[0]
        air = LocalWind(world.wind)
        self.body = Body(float(place[0]), float(place[1]), world.home.altitude, air, self._profile.airspeed)
        self.manoeuvres = Manoeuvres(self._profile, self.body, self.ground, self.firmware.circle_radius)

    @property
    def profile(self) -> MotionProfile:
        """How fast it flies."""
        return self._profile

    @profile.setter
    def profile(self, profile: MotionProfile) -> None:
        self._profile = self.manoeuvres.profile = profile

    @property
    def point(self) -> GeoPoint:
        """Where it is."""
        return self.geographic(self.body.east, self.body.north)

    @property
    def home_place(self) -> Vector:
        """Home in the local frame: east, north, altitude AMSL [m]."""
        return self.local(self.home.point.latitude_deg, self.home.point.longitude_deg, self.home.altitude)

    @property
    def home_item(self) -> StoredItem:
        """Home as ArduPilot's item 0, its altitude cut to centimetres."""
        point, altitude = self.home.point, self.firmware.altitude.held(self.home.altitude)
        x, y = degrees_e7(point.latitude_deg), degrees_e7(point.longitude_deg)
        return StoredItem(Frame.GLOBAL, Command.NAV_WAYPOINT, x=x, y=y, z=altitude)

    def local(self, latitude_deg: float, longitude_deg: float, altitude: float) -> Vector:
        """A place on Earth as east, north, altitude AMSL [m]."""
        east, north = self.world.frame.to_local(latitude_deg, longitude_deg)[0]
        return float(east), float(north), altitude

    def geographic(self, east: float, north: float) -> GeoPoint:
        """A local place as a place on Earth."""
        latitude, longitude = self.world.frame.to_geographic(np.array([[east, north]]))
        return GeoPoint(float(latitude[0]), float(longitude[0]))

    def ground(self, east: float, north: float) -> float:
        """The ground's height AMSL [m] at a place, home's where no terrain tells it."""
        height = self.world.ground(east, north)
        return self.home.altitude if height is None else height

    def target(self, item: StoredItem) -> Vector:
        """Where an item leads: east, north, altitude AMSL [m]; here, where it names no place."""
        east, north, altitude = self.body.place
        if item.has_place:
            east, north, _ = self.local(item.latitude_deg, item.longitude_deg, 0.0)
        if self.firmware.means_present_altitude(item.command, item.frame, item.z):
            return east, north, altitude
        frame = plain_frame(item.frame)
        if frame == Frame.GLOBAL:
            return east, north, item.z
        if frame == Frame.GLOBAL_TERRAIN_ALT:
            return east, north, self.ground(east, north) + item.z
        if frame == Frame.GLOBAL_RELATIVE_ALT:
            return east, north, self.home.altitude + item.z
        return east, north, altitude

    def is_near(self, item: StoredItem) -> bool:
        """Whether an item's place lies within reach."""
        return self.reaches(item.latitude_deg, item.longitude_deg)

    def reaches(self, latitude_deg: float, longitude_deg: float) -> bool:
        """Whether a place lies within reach."""
        return math.hypot(*self.local(latitude_deg, longitude_deg, 0.0)) <= REACH

    def lift_off(self) -> None:
        """Leave the ground."""
        self.landed = False
        self.say("Lifted off")

    def say(self, words: str) -> None:
        """Tell the log and the ground station."""
        self.events.append(Said(words))
