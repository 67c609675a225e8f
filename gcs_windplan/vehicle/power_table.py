"""Power that somebody measured."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from gcs_windplan.arrays import FloatArray
from gcs_windplan.constants import STANDARD_GRAVITY
from gcs_windplan.errors import InputError, Problem
from gcs_windplan.vehicle.air import SEA_LEVEL_DENSITY
from gcs_windplan.vehicle.power import Flow, flow, require

_ROUNDING = 1e-9  # of an airspeed: what its way through another density may add to the table's ends


@dataclass(frozen=True, slots=True)
class PowerTable:
    """Level power against airspeed as it was measured with one mass: straight lines in between, an error outside.

    Climbing adds m g c/η; descending takes nothing off, which errs on the safe side. In another density it holds at
    the same angles and force coefficients, so at an airspeed and with a power that are both larger by √(ρ0/ρ)
    (Anderson 2016, Introduction to Flight, section 6.7); `FixedWing` and `Multirotor` do exactly this as well.
    """

    mass: float  # [kg] all that flew
    measured_airspeeds: tuple[float, ...]  # [m/s] ascending
    measured_watts: tuple[float, ...]  # [W] drawn from the battery in level flight
    density: float = SEA_LEVEL_DENSITY  # [kg/m³] in which it was measured
    climb_efficiency: float = 0.5  # η; no source: about that of hovering (missions/vehicles/large_multirotor.yaml)

    def __post_init__(self) -> None:
        require(self, ("mass", "density"), shares=("climb_efficiency",))
        speeds, watts = self.measured_airspeeds, self.measured_watts
        if len(speeds) != len(watts) or len(speeds) < 2:
            text = f"a power table needs two rows or more, not {len(speeds)} airspeeds and {len(watts)} powers"
            raise InputError(Problem(text, "power.measured"))
        if not (speeds[0] >= 0 and all(math.isfinite(one) for one in speeds) and np.all(np.diff(speeds) > 0)):
            raise InputError(Problem("the airspeeds of a power table start at 0 or above and rise", "power.measured"))
        if not all(math.isfinite(one) and one > 0 for one in watts):
            raise InputError(Problem("the powers of a power table must be above 0", "power.measured"))

    def airspeeds(self, density: float = SEA_LEVEL_DENSITY) -> tuple[float, float]:
        """The first and the last airspeed [m/s] of the table, in air of a density [kg/m³]."""
        ratio = math.sqrt(self.density / density)
        return self.measured_airspeeds[0] * ratio, self.measured_airspeeds[-1] * ratio

    def watts(
        self,
        airspeed: FloatArray | float,
        climb_rate: FloatArray | float,
        density: FloatArray | float = SEA_LEVEL_DENSITY,
    ) -> FloatArray:
        """The power [W]; see `PowerModel.watts`. Raises `InputError` for an airspeed outside the table."""
        speed, climb, rho = flow(airspeed, climb_rate, density)
        ratio = np.sqrt(rho / self.density)
        self._refuse_outside((speed, climb, rho), ratio)
        level = np.interp(speed * ratio, self.measured_airspeeds, self.measured_watts) / ratio
        return np.asarray(level + self.mass * STANDARD_GRAVITY * np.maximum(climb, 0.0) / self.climb_efficiency)

    def _refuse_outside(self, flight: Flow, ratio: FloatArray) -> None:
        speed, _, rho = np.broadcast_arrays(*flight)
        first, last = self.measured_airspeeds[0], self.measured_airspeeds[-1]
        alike = speed * ratio
        outside = (alike < first * (1 - _ROUNDING)) | (alike > last * (1 + _ROUNDING))
        if np.any(outside):
            fast, dense, at = (float(one[outside].flat[0]) for one in (speed, rho, alike))
            text = (
                f"{fast:g} m/s in air of {dense:.4g} kg/m³ is {at:.4g} m/s in the {self.density:.4g} kg/m³ of the power"
                f" table, which goes from {first:g} to {last:g} m/s; measure further or keep to it"
            )
            raise InputError(Problem(text, "power.measured"))
