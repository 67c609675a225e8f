"""An airframe: how fast it flies, what it weighs, what it draws and what its battery holds."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from gcs_windplan.errors import InputError, Problem
from gcs_windplan.vehicle.air import SEA_LEVEL_DENSITY
from gcs_windplan.vehicle.power import PowerModel
from gcs_windplan.vehicle.vehicle import Vehicle


@dataclass(frozen=True, slots=True)
class Battery:
    """A battery: its capacity [J], and how much of it a flight may take.

    >>> import gcs_windplan as gw
    >>> gw.Battery(capacity=100 * 3600.0).energy_to_plan_with / 3600  # [Wh] 80 % of 100, and of that 80 %
    64.0
    """

    capacity: float  # [J] from full to empty
    usable: float = 0.8  # share of the capacity that may be drawn at all
    reserve: float = 0.2  # share of the usable energy that a mission leaves; its limits may ask for more

    def __post_init__(self) -> None:
        if not (math.isfinite(self.capacity) and self.capacity > 0):
            raise InputError(Problem(f"must be above 0 J, not {self.capacity}", "battery.capacity"))
        if not 0 < self.usable <= 1:
            raise InputError(Problem(f"must be above 0 and at most 1, not {self.usable}", "battery.usable"))
        if not 0 <= self.reserve < 1:
            raise InputError(Problem(f"must be at least 0 and below 1, not {self.reserve}", "battery.reserve"))

    @property
    def usable_energy(self) -> float:
        """What may be drawn at all [J]."""
        return self.capacity * self.usable

    @property
    def energy_to_plan_with(self) -> float:
        """What may be drawn [J] when the reserve stays."""
        return self.usable_energy * (1 - self.reserve)


@dataclass(frozen=True, slots=True)
class Airframe:
    """A vehicle that is known well enough to plan its energy.

    `vehicle` holds its speeds, of which its airspeed is the cruise; `acceleration` [m/s²] is level, along the track.

    >>> import gcs_windplan as gw
    >>> copter = gw.read_airframe("missions/vehicles/large_multirotor.yaml")
    >>> copter.mass == copter.power.mass
    True
    """

    name: str
    vehicle: Vehicle
    mass: float  # [kg] all that flies; that of `power`
    battery: Battery
    power: PowerModel
    maximum_airspeed: float  # [m/s]
    acceleration: float = 2.5  # [m/s²] ArduCopter's default of WPNAV_ACCEL

    def __post_init__(self) -> None:
        if self.mass != self.power.mass:
            text = f"{self.mass:g} kg fly, but the power is that of {self.power.mass:g} kg; make both the same"
            raise InputError(Problem(text, "mass"))
        if not math.isfinite(self.maximum_airspeed):
            raise InputError(Problem(f"{self.maximum_airspeed} m/s is no largest airspeed", "maximum_airspeed"))
        if self.maximum_airspeed < self.vehicle.airspeed:
            text = f"{self.maximum_airspeed:g} m/s is less than the cruise at {self.vehicle.airspeed:g} m/s"
            raise InputError(Problem(text, "maximum_airspeed"))
        rates = np.array([-self.vehicle.descent, 0.0, self.vehicle.climb])
        with np.errstate(all="ignore"):
            drawn = self.power.watts(self.vehicle.airspeed, rates, SEA_LEVEL_DENSITY)
        if not (np.isfinite(drawn).all() and drawn[1] > 0):
            level, climbing = float(drawn[1]), float(drawn[2])
            text = f"at the cruise it comes to {level:g} W, climbing to {climbing:g} W: check its numbers"
            raise InputError(Problem(text, "power"))
        if not (math.isfinite(self.acceleration) and self.acceleration > 0):
            raise InputError(Problem(f"must be above 0 m/s², not {self.acceleration}", "acceleration"))
