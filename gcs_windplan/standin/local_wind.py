"""The air that the stand-in flies in: the mission's wind where it is, and what that leaves of its airspeed."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from gcs_windplan.errors import WindError
from gcs_windplan.kernels.triangle import TRIANGLE, ground_speed
from gcs_windplan.wind.field import WindField

# Compiling it takes longer than all the calls of a flight.
_ground_speed = getattr(ground_speed, "py_func", ground_speed)

_FRESH = 0.5  # [s] for so long a looked-up wind is good
_NEAR = 5.0  # [m] and so far


@dataclass(slots=True)
class LocalWind:
    """A wind field that always has an answer: where it ends, the last known wind goes on.

    `trouble` says why, for a log.
    """

    wind_field: WindField
    trouble: str | None = None
    _at: tuple[float, float, float, float] = (math.inf, math.inf, math.inf, math.inf)
    _wind: tuple[float, float] = (0.0, 0.0)

    def at(self, east: float, north: float, altitude: float, seconds: float) -> tuple[float, float]:
        """The wind towards east and north [m/s] at a place [m] and a time since departure [s]."""
        e, n, z, t = self._at
        near = abs(east - e) + abs(north - n) + abs(altitude - z) <= _NEAR
        if not (near and abs(seconds - t) <= _FRESH):
            self._at = (east, north, altitude, seconds)
            self._look_up(east, north, altitude, seconds)
        return self._wind

    def _look_up(self, east: float, north: float, altitude: float, seconds: float) -> None:
        try:
            wind_e, wind_n, _ = self.wind_field.at(np.array([[east, north, altitude]]), seconds)[0]
        except WindError as error:
            self.trouble = str(error)
            return
        if math.isfinite(wind_e) and math.isfinite(wind_n):
            self._wind = (float(wind_e), float(wind_n))
        else:
            self.trouble = f"the wind is not known at {altitude:.0f} m above sea level"


def speed_over_ground(airspeed: float, wind: tuple[float, float], east: float, north: float) -> float:
    """The speed [m/s] that an airspeed gives along a level unit track; 0 where the wind is too strong."""
    wind_e, wind_n = wind
    along, cross = wind_e * east + wind_n * north, wind_n * east - wind_e * north
    return float(_ground_speed(TRIANGLE, airspeed, along, cross))
