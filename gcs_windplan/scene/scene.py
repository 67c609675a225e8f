"""The scene: the ground, the air and what must be kept clear of, at one place and time."""

from __future__ import annotations

from dataclasses import dataclass, field
from datetime import datetime

from gcs_windplan.geo.frame import LocalFrame
from gcs_windplan.scene.airspace import Airspace
from gcs_windplan.terrain import Obstacles, Terrain
from gcs_windplan.wind.field import WindField


@dataclass(frozen=True, slots=True, eq=False)
class Scene:
    """Where and when something is flown: all that plans or judges shares it.

    Terrain, winds, obstacles and areas are seen from `frame`. `wind` tells seconds since the `departure`, if there is
    one; of an ensemble it is the mean of the `members`. `gusts` are the forecast's, one field a member, where it tells
    any.
    """

    frame: LocalFrame
    terrain: Terrain
    wind: WindField
    members: tuple[WindField, ...] = ()
    gusts: tuple[WindField, ...] = ()
    obstacles: Obstacles | None = None
    airspace: Airspace = field(default_factory=Airspace)
    departure: datetime | None = None

    def __repr__(self) -> str:
        return f"Scene({self.terrain.name} in {self.wind.name})"
