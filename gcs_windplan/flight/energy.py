"""What a polyline takes from the battery: power along each leg at the airspeed and climb that the wind leaves."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np

from gcs_windplan.arrays import FloatArray
from gcs_windplan.vehicle import PowerModel, Vehicle, air_density
from gcs_windplan.wind.field import WindField

_SAMPLES: Final = 16  # of the wind along a leg, in the middles of equal parts


def leg_energies(
    points: FloatArray,
    times: FloatArray,
    wind: WindField,
    vehicle: Vehicle,
    power: PowerModel,
    airspeeds: FloatArray | None = None,
) -> FloatArray:
    """The energy of each leg of a polyline (n, 3) that is passed at `times` (n,) [s since departure], (n - 1,) [J].

    At each of 16 places along a leg the vehicle flies at its airspeed, or at the leg's own of `airspeeds` (n - 1,),
    slower only where it cannot climb or sink fast enough; it takes power(airspeed, climb through the air, density) for
    as long as that part lasts. The parts' times are scaled to the leg's own. Density is the standard atmosphere's at
    the height above mean sea level. NaN where a leg cannot be flown.
    """
    with np.errstate(invalid="ignore"):  # from the first leg on that cannot be flown, times are infinite
        lasting = np.diff(times)
    speeds = np.full(len(lasting), float(vehicle.airspeed)) if airspeeds is None else airspeeds
    return air_along(points, times, wind).energies(lasting, vehicle, power, speeds)


@dataclass(frozen=True, slots=True, eq=False)
class AirAlong:
    """The air at 16 places along n legs: vectors (n, 3) [m], winds (n, 16, 3) [m/s], densities (n, 16) [kg/m³]."""

    vectors: FloatArray
    winds: FloatArray
    densities: FloatArray

    def energies(self, lasting: FloatArray, vehicle: Vehicle, power: PowerModel, airspeeds: FloatArray) -> FloatArray:
        """The energy [J] of legs that take so many seconds (n,) at these airspeeds (n,) [m/s]; NaN where never."""
        airspeed, climb, pace = _motion(self.vectors, self.winds, vehicle, airspeeds[:, None])
        with np.errstate(invalid="ignore", divide="ignore"):
            parts = pace / pace.sum(axis=1, keepdims=True)
            watts = power.watts(np.nan_to_num(airspeed), np.nan_to_num(climb), self.densities)
        energies: FloatArray = lasting * (parts * watts).sum(axis=1)
        return np.where(np.isfinite(lasting), energies, np.nan)


def air_along(points: FloatArray, times: FloatArray, wind: WindField) -> AirAlong:
    """The air along a polyline (n, 3) that is passed at `times` (n,) [s since departure]."""
    vectors = np.diff(points, axis=0)
    share = (np.arange(_SAMPLES) + 0.5) / _SAMPLES
    places = points[:-1, None] + share[None, :, None] * vectors[:, None]
    with np.errstate(invalid="ignore"):
        lasting = np.diff(times)
    flyable = np.isfinite(lasting)
    when = np.where(flyable, times[:-1], 0.0)[:, None] + share[None] * np.where(flyable, lasting, 0.0)[:, None]
    latest = float(wind.times[-1]) if len(wind.times) > 1 else np.inf
    winds = wind.at(places.reshape(-1, 3), np.minimum(when, latest).ravel()).reshape(*when.shape, 3)
    return AirAlong(vectors, winds, air_density(places[:, :, 2]))


def _motion(
    vectors: FloatArray, winds: FloatArray, vehicle: Vehicle, airspeed: FloatArray
) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Level airspeed, climb through the air [m/s] and pace [s per leg] at places (n, k) along legs (n, 3).

    `airspeed` (n, 1) is the one to be held.
    """
    level = np.hypot(vectors[:, 0], vectors[:, 1])[:, None]
    track = vectors[:, :2] / np.maximum(level, 1e-9)
    along = (winds[:, :, :2] * track[:, None]).sum(axis=2)
    across = winds[:, :, 1] * track[:, :1] - winds[:, :, 0] * track[:, 1:]
    with np.errstate(invalid="ignore", divide="ignore"):
        forward = airspeed if vehicle.speed_model == "paper" else np.sqrt(airspeed**2 - across**2)
        speed = forward + along
        rise = vectors[:, 2:]
        rate = np.where(rise > 0, vehicle.climb + winds[:, :, 2], vehicle.descent - winds[:, :, 2])
        pace = np.maximum(np.where(level > 1e-6, level / speed, 0.0), np.abs(rise) / rate)
        over_ground = np.where(pace > 0, level / pace, 0.0)
        climb = np.where(pace > 0, rise / pace, 0.0) - winds[:, :, 2]
    upright = level <= 1e-6  # it holds its place against all the wind
    flown = np.where(upright, np.hypot(winds[:, :, 0], winds[:, :, 1]), np.hypot(over_ground - along, across))
    return flown, climb, pace
