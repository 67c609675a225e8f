"""The standard atmosphere: how dense the air is at a height."""

from __future__ import annotations

from typing import Final

import numpy as np

from gcs_windplan.arrays import FloatArray
from gcs_windplan.constants import STANDARD_GRAVITY
from gcs_windplan.errors import InputError

SEA_LEVEL_DENSITY: Final = 1.225  # [kg/m³] ISO 2533:1975
_SEA_LEVEL_PRESSURE: Final = 101_325.0  # [Pa] ISO 2533:1975
_SEA_LEVEL_TEMPERATURE: Final = 288.15  # [K] ISO 2533:1975
_GAS_CONSTANT: Final = 287.05287  # [J/kg/K] of dry air; ISO 2533:1975
_LAPSE: Final = 0.0065  # [K/m] up to 11 km; ISO 2533:1975
_EARTH_RADIUS: Final = 6_356_766.0  # [m] of the geopotential; ISO 2533:1975
_LOWEST, _HIGHEST = -2000.0, 11_000.0  # [m] the layer that begins where ISO 2533 does and ends at the tropopause


def air_density(height: FloatArray | float, warmer: FloatArray | float = 0.0) -> FloatArray:
    """The density of the air [kg/m³] at heights above mean sea level [m], by ISO 2533 (ICAO Doc 7488).

    `warmer` [K] is how much warmer than standard the air is; the pressure stays that of the standard. Raises
    `InputError` below -2 km and above 11 km, and where `warmer` leaves no temperature.
    """
    metres, warmth = np.asarray(height, dtype=np.float64), np.asarray(warmer, dtype=np.float64)
    outside = (metres < _LOWEST) | (metres > _HIGHEST)
    if np.any(outside):
        found = float(metres[outside].flat[0])
        raise InputError(f"the air's density is known from {_LOWEST:g} m to {_HIGHEST:g} m, not at {found:g} m")
    geopotential = _EARTH_RADIUS * metres / (_EARTH_RADIUS + metres)
    standard = _SEA_LEVEL_TEMPERATURE - _LAPSE * geopotential
    if np.any(standard + warmth <= 0):
        raise InputError(f"air that is {float(np.min(warmth)):g} K warmer than standard has no temperature above 0 K")
    exponent = STANDARD_GRAVITY / (_GAS_CONSTANT * _LAPSE)
    pressure = _SEA_LEVEL_PRESSURE * (standard / _SEA_LEVEL_TEMPERATURE) ** exponent
    return np.asarray(pressure / (_GAS_CONSTANT * (standard + warmth)))
