"""The vehicle, as far as planning needs it: how fast it flies, climbs and sinks."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Literal, TypeAlias

from gcs_windplan.errors import InputError, Problem

Autopilot: TypeAlias = str
"""The name of a firmware: `ardupilot`, `px4`, or another one of `mission.firmware`."""

SpeedModel: TypeAlias = Literal["triangle", "paper"]
VehicleType: TypeAlias = Literal["multicopter", "fixed-wing"]


@dataclass(frozen=True, slots=True)
class Vehicle:
    """A vehicle that holds one airspeed.

    `airspeed`, `climb` and `descent` in m/s, all positive. `speed_model` is `triangle`, the exact wind triangle, or
    `paper`, equation (12): ground speed = airspeed + wind · cos φ, the cross wind countered for free.

    >>> import gcs_windplan as gw
    >>> gw.Vehicle(18.0, type="fixed-wing").hovers
    False
    """

    airspeed: float
    climb: float = 2.5
    descent: float = 1.5
    type: VehicleType = "multicopter"
    autopilot: Autopilot = "ardupilot"
    speed_model: SpeedModel = "triangle"

    def __post_init__(self) -> None:
        for field in ("airspeed", "climb", "descent"):
            value = getattr(self, field)
            if not (math.isfinite(value) and value > 0):
                raise InputError(Problem(f"{value} m/s is no speed to fly at, give one above 0", f"vehicle.{field}"))

    @property
    def hovers(self) -> bool:
        """Whether it can fly slower than its airspeed, and straight up."""
        return self.type == "multicopter"
