"""At what airspeed to fly each leg: faster in a head wind, slower in a tail wind."""

from __future__ import annotations

from collections.abc import Callable
from typing import Final

import numpy as np

from gcs_windplan.arrays import FloatArray
from gcs_windplan.flight.energy import air_along
from gcs_windplan.flight.sampling import sample_legs, still_air_times
from gcs_windplan.kernels.triangle import integrate_legs
from gcs_windplan.vehicle import PowerModel, Vehicle
from gcs_windplan.wind.field import WindField

_SCANNED: Final = 41  # airspeeds looked at first; between the best one's neighbours there is one valley
_GOLDEN: Final = (5**0.5 - 1) / 2
_CUTS: Final = 16  # of that valley: down to a thousandth of it
_ROUNDS: Final = 4  # of putting the times in again in changing wind
_SAME: Final = 1e-9  # of a price: no difference


def best_airspeeds(
    points: FloatArray,
    wind: WindField,
    vehicle: Vehicle,
    power: PowerModel,
    between: tuple[float, float],
    *,
    begin: float = 0.0,
    cost_index: float = 0.0,
) -> FloatArray:
    """The airspeed of each leg of a polyline (n, 3) that takes the least energy, (n - 1,) [m/s].

    `between` the slowest and the fastest [m/s]; with a `cost_index` [W], the value of a second, the least
    energy and price of time. The wind is that of the time at which the leg is flown, from `begin` [s since departure]
    on. Where several airspeeds take the same, as on a leg whose climb holds the vehicle back, the slowest. The fastest
    where none can be flown.
    """
    changing = len(wind.times) > 1
    times = still_air_times(points, vehicle, begin)
    for _ in range(_ROUNDS if changing else 1):
        seconds, price = _priced(points, times, wind, vehicle, power, cost_index, changing)
        airspeeds = _cheapest(price, len(points) - 1, between)
        times = begin + np.append(0.0, np.cumsum(seconds(airspeeds)))
    return airspeeds


def _priced(
    points: FloatArray,
    times: FloatArray,
    wind: WindField,
    vehicle: Vehicle,
    power: PowerModel,
    cost_index: float,
    changing: bool,
) -> tuple[Callable[[FloatArray], FloatArray], Callable[[FloatArray], FloatArray]]:
    """What gives the legs' seconds and prices (n,) for their airspeeds (n,); infinite where they cannot be flown."""
    when = np.column_stack([times[:-1], times[1:]]) if changing else None
    legs = sample_legs((wind,), vehicle, points[:-1], points[1:], when)
    air = air_along(points, times, wind)

    def seconds(airspeeds: FloatArray) -> FloatArray:
        table = integrate_legs(legs.performance, airspeeds, legs.vectors, legs.first, legs.weights, legs.winds[0])
        return legs.in_time(table[:, 0])

    def price(airspeeds: FloatArray) -> FloatArray:
        lasting = seconds(airspeeds)
        joules = air.energies(lasting, vehicle, power, airspeeds)
        flyable = np.isfinite(joules)
        return np.where(flyable, joules + cost_index * np.where(flyable, lasting, 0.0), np.inf)

    return seconds, price


def _cheapest(price: Callable[[FloatArray], FloatArray], legs: int, between: tuple[float, float]) -> FloatArray:
    """The airspeed of the smallest price for each leg: a scan, then golden sections around the best."""
    scanned = np.linspace(*between, _SCANNED)
    prices = np.stack([price(np.full(legs, airspeed)) for airspeed in scanned])
    least = prices.min(axis=0)
    with np.errstate(invalid="ignore"):
        best = np.argmax(prices <= least * (1 + _SAME), axis=0)
    best[~np.isfinite(least)] = _SCANNED - 1
    low, high = scanned[np.maximum(best - 1, 0)], scanned[np.minimum(best + 1, _SCANNED - 1)]
    for _ in range(_CUTS):
        inner, outer = high - _GOLDEN * (high - low), low + _GOLDEN * (high - low)
        left = price(inner) <= price(outer) * (1 + _SAME)
        low, high = np.where(left, low, inner), np.where(left, outer, high)
    middle = (low + high) / 2
    better = price(middle) < least * (1 - _SAME)
    airspeeds: FloatArray = np.where(better, middle, scanned[best])
    return airspeeds
