"""What a mission is judged by: ground, air, vehicle and limits."""

from __future__ import annotations

from dataclasses import dataclass, field

from gcs_windplan.assessment.assessment import AssessmentLimits, Source
from gcs_windplan.mission import MissionItems
from gcs_windplan.scene import Scene
from gcs_windplan.vehicle import Airframe, Autopilot, MotionProfile, VehicleType


@dataclass(frozen=True, slots=True, eq=False)
class Case:
    """A mission and what it is judged by.

    Of the members of an ensemble's wind it is to be flown in the share `robust`. The autopilot keeps `pace`, of
    which `airspeed` is the most that the vehicle reaches; `cruise` [m/s] is its own, which a fixed-wing holds.
    Energy is known with an `airframe`. `home_is_given`: home's altitude is the pilot's, and counts as it is.
    """

    name: str
    mission: MissionItems
    scene: Scene
    autopilot: Autopilot
    vehicle_type: VehicleType
    pace: MotionProfile
    cruise: float
    limits: AssessmentLimits = field(default_factory=AssessmentLimits)
    airframe: Airframe | None = None
    robust: float = 0.5
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
