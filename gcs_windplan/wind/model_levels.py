"""How high model levels lie: the hydrostatic equation, from the surface upwards.

ECMWF, IFS Documentation, Part III: Dynamics and Numerical Procedures, equations (2.20) to (2.23) (Simmons and Burridge
1981, doi:10.1175/1520-0493(1981)109<0758:AEAAMC>2.0.CO;2).
"""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from gcs_windplan.arrays import FloatArray
from gcs_windplan.constants import DRY_AIR, STANDARD_GRAVITY, WATER_VAPOUR
from gcs_windplan.errors import WindError

_TOP = 0.1  # [Pa] taken for the pressure at the top of the model where that is 0, as ECMWF does


def heights_of_levels(
    half_levels: tuple[FloatArray, FloatArray],
    pressure: FloatArray,
    terrain: FloatArray,
    temperature: Mapping[int, FloatArray],
    humidity: Mapping[int, FloatArray],
) -> dict[int, FloatArray]:
    """Heights above mean sea level [m] of the model levels, by number, 1 at the top.

    `half_levels` a [Pa] and b (n + 1,) from the top down; `pressure` at the surface [Pa], `terrain` [m] and each
    level's `temperature` [K] and specific `humidity` [kg/kg] (0 where there is none) have one shape. Counting begins
    at the ground: raises `WindError` where the lowest level or one in between has no temperature.
    """
    a, b = half_levels
    bottom = len(a) - 1
    numbers = sorted(temperature, reverse=True)
    missing = sorted(set(range(numbers[-1], bottom + 1)) - set(numbers)) if numbers else [bottom]
    if missing:
        raise WindError(
            f"the heights of its model levels need the temperature on all of them from the ground up: level"
            f" {missing[-1]} is missing"
        )
    heights: dict[int, FloatArray] = {}
    below = terrain * STANDARD_GRAVITY  # [m²/s²] geopotential of the half level under the level
    for level in numbers:
        lower = a[level] + b[level] * pressure
        upper = np.maximum(a[level - 1] + b[level - 1] * pressure, _TOP)
        vapour = humidity.get(level, np.zeros_like(pressure))
        warmth = DRY_AIR * temperature[level] * (1 + (WATER_VAPOUR / DRY_AIR - 1) * vapour)
        thickness = np.log(lower / upper)
        share = np.log(2.0) if level == 1 else 1 - upper / (lower - upper) * thickness
        heights[level] = (below + warmth * share) / STANDARD_GRAVITY
        below = below + warmth * thickness
    return heights
