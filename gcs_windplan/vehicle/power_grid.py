"""A power model as a table, for the search, and the airspeeds that it may choose from."""

from __future__ import annotations

import math
from typing import Final

import numpy as np

from gcs_windplan.arrays import FloatArray
from gcs_windplan.kernels.power import PowerGrid
from gcs_windplan.vehicle.air import air_density
from gcs_windplan.vehicle.airframe import Airframe
from gcs_windplan.vehicle.power import PowerModel, least_power_airspeed
from gcs_windplan.vehicle.vehicle import Vehicle

_SPEEDS: Final = 129  # from 0 to the fastest
_RATES: Final = 32  # from level flight to the larger one of climb and descent
_HEIGHTS: Final = 5
_MARGIN: Final = 1.2  # times the slowest airspeed that there is power for
_CHOICES: Final = 9  # airspeeds that an edge or leg may choose from: between them it loses some thousandths at most


def tabulate(
    power: PowerModel, vehicle: Vehicle, airspeeds: FloatArray, heights: tuple[float, float], cost_index: float = 0.0
) -> PowerGrid:
    """The power of a vehicle between two heights above mean sea level [m], and the airspeeds (k,) [m/s] to choose from.

    Level flight is a knot of the climb rates, since powers have a kink there. Infinite where the model knows no power.
    """
    fastest = float(np.max(airspeeds))
    speeds: FloatArray = np.linspace(0.0, fastest, _SPEEDS)
    step = max(vehicle.climb, vehicle.descent) / _RATES
    lowest, highest = -math.ceil(vehicle.descent / step), math.ceil(vehicle.climb / step)
    rates = step * np.arange(lowest, highest + 1, dtype=np.float64)
    low, high = heights[0], max(heights[1], heights[0] + 1.0)
    levels = np.linspace(low, high, _HEIGHTS)
    watts = np.stack([_layer(power, rates, speeds, float(density)) for density in air_density(levels)])
    return PowerGrid(
        watts=watts,
        lowest_height=low,
        height_step=float(levels[1] - low),
        lowest_climb=float(rates[0]),
        climb_step=step,
        airspeed_step=float(speeds[1]),
        airspeeds=np.ascontiguousarray(airspeeds, dtype=np.float64),
        cost_index=cost_index,
    )


def airspeed_choices(airframe: Airframe, height: float) -> FloatArray:
    """The airspeeds (9,) [m/s] worth flying at a height [m]: from that of least power to the airframe's largest.

    Slower than at least power no flight takes less energy, in whatever wind, and none is quicker. A wing keeps 1.2
    times its stall's airspeed (as V2 does in CS-23).
    """
    density = float(air_density(height))
    lowest, _ = airframe.power.airspeeds(density)
    slowest = max(least_power_airspeed(airframe.power, airframe.maximum_airspeed, density), _MARGIN * lowest)
    return np.linspace(min(slowest, airframe.vehicle.airspeed), airframe.maximum_airspeed, _CHOICES)


def _layer(power: PowerModel, rates: FloatArray, speeds: FloatArray, density: float) -> FloatArray:
    """The power (rates, speeds) in air of one density."""
    lowest, highest = power.airspeeds(density)
    known = (speeds >= lowest) & (speeds <= highest)
    watts = np.full((len(rates), len(speeds)), np.inf)
    watts[:, known] = power.watts(speeds[known], rates[:, None], density)
    return watts
