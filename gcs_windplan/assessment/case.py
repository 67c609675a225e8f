"""What a mission is judged by: ground, air, vehicle and limits."""

from __future__ import annotations

from dataclasses import dataclass, field
from datetime import datetime

from gcs_windplan.assessment.assessment import Limits, Source
from gcs_windplan.geo.frame import LocalFrame
from gcs_windplan.mission import MissionItems
from gcs_windplan.scene import Airspace
from gcs_windplan.terrain import Obstacles, Terrain
from gcs_windplan.vehicle import Airframe, Autopilot, Pace, VehicleType
from gcs_windplan.wind.field import WindField


@dataclass(frozen=True, slots=True, eq=False)
class Case:
    """A mission and what it is judged by; terrain, wind and areas are seen from `frame`.

    `wind` tells seconds since the `departure`, `gusts` are its gusts, one field a member. Of an ensemble it is the mean
    of the `members`, and the share `robust` of them is to be flown in. The autopilot keeps `pace`, of which `airspeed`
    is the most that the vehicle reaches; `cruise` [m/s] is its own, which a fixed-wing holds. Energy is known with an
    `airframe`. `home_is_given`: home's altitude is the pilot's, and counts as it is.
    """

    name: str
    mission: MissionItems
    frame: LocalFrame
    terrain: Terrain
    wind: WindField
    autopilot: Autopilot
    vehicle_type: VehicleType
    pace: Pace
    cruise: float
    limits: Limits = field(default_factory=Limits)
    airframe: Airframe | None = None
    gusts: tuple[WindField, ...] = ()
    members: tuple[WindField, ...] = ()
    robust: float = 0.5
    airspace: Airspace = field(default_factory=Airspace)
    obstacles: Obstacles | None = None
    departure: datetime | None = None
    home_is_given: bool = False
    sources: tuple[Source, ...] = ()
    remarks: tuple[str, ...] = ()

    @property
    def hovers(self) -> bool:
        """Whether the vehicle can stand still in the air."""
        return self.vehicle_type == "multicopter"

    @property
    def fastest(self) -> float:
        """The most that the vehicle reaches through the air [m/s]."""
        return max(self.pace.airspeed, self.cruise if not self.hovers else 0.0)
