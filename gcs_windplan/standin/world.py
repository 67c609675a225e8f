"""Where the stand-in flies: its local frame, wind and ground, and where it stands at first."""

from __future__ import annotations

from dataclasses import dataclass, field
from datetime import datetime
from typing import TYPE_CHECKING

import numpy as np

from gcs_windplan.errors import InputError, TerrainError
from gcs_windplan.geo.frame import GeoPoint, LocalFrame
from gcs_windplan.mission import Home
from gcs_windplan.mission.firmware import Firmware
from gcs_windplan.wind.analytic import Calm
from gcs_windplan.wind.field import WindField

if TYPE_CHECKING:
    from gcs_windplan.planning.request import Request
    from gcs_windplan.terrain import Terrain


@dataclass(frozen=True, slots=True, eq=False)
class World:
    """The surroundings of a stand-in.

    Wind and terrain are in the local `frame`. Without terrain the ground is level, at home's height. A world that is
    not `settled` may be left for the place where the first mission begins. `departure` is the time of take-off.
    """

    home: Home
    frame: LocalFrame
    wind: WindField = field(default_factory=Calm)
    terrain: Terrain | None = None
    settled: bool = True
    departure: datetime | None = None

    def ground(self, east: float, north: float) -> float | None:
        """The ground's height AMSL [m] at a place; None where no terrain tells it."""
        if self.terrain is None:
            return None
        try:
            height = float(self.terrain.heights_at(np.array([[east, north]]))[0])
        except TerrainError:
            return None
        return height if np.isfinite(height) else None


def world_at(home: Home, wind: WindField | None = None) -> World:
    """A level world around a home."""
    return World(home, LocalFrame(home.point), wind if wind is not None else Calm())


def simulator_world(firmware: Firmware, wind: WindField | None = None) -> World:
    """A level world that is left for the place of the first mission that comes."""
    latitude_deg, longitude_deg, altitude = firmware.simulator_home
    home = Home(GeoPoint(latitude_deg, longitude_deg), altitude)
    return World(home, LocalFrame(home.point), wind if wind is not None else Calm(), settled=False)


def planned_world(request: Request, home: Home | None = None, wind: WindField | None = None) -> World:
    """The world of a mission file: its wind and terrain, home on the ground at its start."""
    scene = request.scene
    if home is None:
        start = request.start
        place = np.array([[start.east, start.north]])
        height = float(scene.terrain.heights_at(place)[0])
        if not np.isfinite(height):
            raise InputError("the ground at the mission's start is not known: give --home with an altitude")
        latitude, longitude = scene.frame.to_geographic(place)
        home = Home(GeoPoint(float(latitude[0]), float(longitude[0])), height)
    wind = scene.wind if wind is None else wind
    return World(home, scene.frame, wind, scene.terrain, departure=scene.departure)
