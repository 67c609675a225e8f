"""What a polyline takes from the battery: power along each leg at the airspeed and climb that the wind leaves."""

from __future__ import annotations

from typing import Final

import numpy as np

from gcs_windplan.arrays import FloatArray
from gcs_windplan.vehicle import PowerModel, Vehicle, air_density
from gcs_windplan.wind.field import WindField

_SAMPLES: Final = 16  # of the wind along a leg, in the middles of equal parts


def leg_energies(
    points: FloatArray, times: FloatArray, wind: WindField, vehicle: Vehicle, power: PowerModel
) -> FloatArray:
    """The energy of each leg of a polyline (n, 3) that is passed at `times` (n,) [s since departure], (n - 1,) [J].

    At each of 16 places along a leg the vehicle flies at its airspeed, slower only where it cannot climb or sink fast
    enough; it takes power(airspeed, climb through the air, density) for as long as that part lasts. The parts' times
    are scaled to the leg's own. Density is the standard atmosphere's at the height above mean sea level. NaN where a
    leg cannot be flown.
    """
    vectors = np.diff(points, axis=0)
    share = (np.arange(_SAMPLES) + 0.5) / _SAMPLES
    places = points[:-1, None] + share[None, :, None] * vectors[:, None]
    with np.errstate(invalid="ignore"):  # from the first leg on that cannot be flown, times are infinite
        lasting = np.diff(times)
    flyable = np.isfinite(lasting)
    when = np.where(flyable, times[:-1], 0.0)[:, None] + share[None] * np.where(flyable, lasting, 0.0)[:, None]
    latest = float(wind.times[-1]) if len(wind.times) > 1 else np.inf
    winds = wind.at(places.reshape(-1, 3), np.minimum(when, latest).ravel()).reshape(*when.shape, 3)
    airspeed, climb, pace = _motion(vectors, winds, vehicle)
    density = air_density(places[:, :, 2])
    with np.errstate(invalid="ignore", divide="ignore"):
        parts = pace / pace.sum(axis=1, keepdims=True)
        watts = power.watts(np.nan_to_num(airspeed), np.nan_to_num(climb), density)
    energies: FloatArray = lasting * (parts * watts).sum(axis=1)
    return np.where(flyable, energies, np.nan)


def _motion(vectors: FloatArray, winds: FloatArray, vehicle: Vehicle) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Level airspeed, climb through the air [m/s] and pace [s per leg] at places (n, k) along legs (n, 3)."""
    level = np.hypot(vectors[:, 0], vectors[:, 1])[:, None]
    track = vectors[:, :2] / np.maximum(level, 1e-9)
    along = (winds[:, :, :2] * track[:, None]).sum(axis=2)
    across = winds[:, :, 1] * track[:, :1] - winds[:, :, 0] * track[:, 1:]
    with np.errstate(invalid="ignore", divide="ignore"):
        if vehicle.speed_model == "paper":
            speed = vehicle.airspeed + along
        else:
            speed = np.sqrt(vehicle.airspeed**2 - across**2) + along
        rise = vectors[:, 2:]
        rate = np.where(rise > 0, vehicle.climb + winds[:, :, 2], vehicle.descent - winds[:, :, 2])
        pace = np.maximum(np.where(level > 1e-6, level / speed, 0.0), np.abs(rise) / rate)
        over_ground = np.where(pace > 0, level / pace, 0.0)
        climb = np.where(pace > 0, rise / pace, 0.0) - winds[:, :, 2]
    upright = level <= 1e-6  # it holds its place against all the wind
    airspeed = np.where(upright, np.hypot(winds[:, :, 0], winds[:, :, 1]), np.hypot(over_ground - along, across))
    return airspeed, climb, pace
