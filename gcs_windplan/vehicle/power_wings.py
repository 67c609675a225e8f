"""Power of vehicles that hang on a wing."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from gcs_windplan.arrays import FloatArray
from gcs_windplan.constants import STANDARD_GRAVITY
from gcs_windplan.vehicle.air import SEA_LEVEL_DENSITY
from gcs_windplan.vehicle.power import flow, require


@dataclass(frozen=True, slots=True)
class FixedWing:
    """Drag times airspeed, and weight times climb rate, by the efficiency from battery to thrust.

    P = (D V + W c)/η with D = ½ ρ V² S (CD0 + CL²/(π e AR)) and CL = W/(½ ρ V² S): a parabolic drag polar at small
    angles of climb (Beard and McLain 2012, Small Unmanned Aircraft, chapter 4; Anderson 2016, Introduction to
    Flight, sections 6.3 to 6.8). Electrical power if `efficiency` is that of propeller, motor and controller. In a
    descent steeper than the glide it is 0: a propeller gives nothing back. Infinite below the stall, which lies at a
    true airspeed that grows with 1/√ρ, and at no airspeed.
    """

    mass: float  # [kg] all that flies
    wing_area: float  # [m²] S
    aspect_ratio: float  # AR, span² by area
    oswald: float  # e, Oswald's efficiency of the lift's spread along the span
    parasite_drag: float  # CD0
    efficiency: float  # η, thrust times airspeed by the battery's power
    stall_airspeed: float = 0.0  # [m/s] at sea level in the standard atmosphere

    def __post_init__(self) -> None:
        positive = ("mass", "wing_area", "aspect_ratio", "oswald", "parasite_drag")
        require(self, positive, ("stall_airspeed",), ("efficiency",))

    def airspeeds(self, density: float = SEA_LEVEL_DENSITY) -> tuple[float, float]:
        """From the stall [m/s] on, without end."""
        return self.stall_airspeed * math.sqrt(SEA_LEVEL_DENSITY / density), math.inf

    def watts(
        self,
        airspeed: FloatArray | float,
        climb_rate: FloatArray | float,
        density: FloatArray | float = SEA_LEVEL_DENSITY,
    ) -> FloatArray:
        """The power [W]; see `PowerModel.watts`."""
        speed, climb, rho = flow(airspeed, climb_rate, density)
        weight, plate = self.mass * STANDARD_GRAVITY, 0.5 * rho * self.wing_area
        parasite = plate * self.parasite_drag * speed**3
        with np.errstate(divide="ignore"):  # at no airspeed: infinite
            induced = weight**2 / (plate * math.pi * self.oswald * self.aspect_ratio * speed)
        watts = np.maximum(parasite + induced + weight * climb, 0.0) / self.efficiency
        stalled = speed * np.sqrt(rho / SEA_LEVEL_DENSITY) < self.stall_airspeed
        return np.where(stalled, math.inf, watts)
