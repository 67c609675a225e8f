"""The power that flight takes, and the airspeeds that take the least of it."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Final, Protocol, TypeAlias

import numpy as np

from gcs_windplan.arrays import FloatArray
from gcs_windplan.errors import InputError, Problem
from gcs_windplan.vehicle.air import SEA_LEVEL_DENSITY

Flow: TypeAlias = tuple[FloatArray, FloatArray, FloatArray]  # airspeed, climb rate, density

_SCAN: Final = 129  # airspeeds looked at first; between the best one's neighbours there is one valley
_CLOSE: Final = 1e-7  # [m/s] how closely an airspeed is found


class PowerModel(Protocol):
    """What a vehicle of a mass draws in flight."""

    @property
    def mass(self) -> float:
        """All that flies [kg], the payload with it."""

    def airspeeds(self, density: float = SEA_LEVEL_DENSITY) -> tuple[float, float]:
        """The lowest and the highest airspeed [m/s] that it knows in air of a density [kg/m³]."""

    def watts(
        self,
        airspeed: FloatArray | float,
        climb_rate: FloatArray | float,
        density: FloatArray | float = SEA_LEVEL_DENSITY,
    ) -> FloatArray:
        """The power [W] at a level airspeed [m/s], climbing through the air [m/s, up positive], in a density [kg/m³].

        The three broadcast. Never negative: nothing is charged on the way down. NaN (wind that is not known) gives
        NaN. Raises `InputError` for a negative airspeed and a density that is not above 0.
        """


def least_power_airspeed(model: PowerModel, fastest: float, density: float = SEA_LEVEL_DENSITY) -> float:
    """The airspeed [m/s] of the longest level flight, up to `fastest` [m/s] or what the model knows."""
    lowest, highest = _between(model, fastest, density)
    return _cheapest(lambda airspeed: model.watts(airspeed, 0.0, density), lowest, highest)


def best_range_airspeed(
    model: PowerModel, fastest: float, head_wind: float = 0.0, density: float = SEA_LEVEL_DENSITY
) -> float:
    """The airspeed [m/s] that takes the least energy over ground against a head wind [m/s], negative from behind.

    Up to `fastest` [m/s] or what the model knows; `InputError` where the head wind is not below that.
    """
    lowest, highest = _between(model, fastest, density)
    if not head_wind < highest:
        raise InputError(f"a head wind of {head_wind:g} m/s leaves no speed over ground at {highest:g} m/s")

    def cost(airspeed: FloatArray | float) -> FloatArray:
        return energy_per_metre(model, airspeed, head_wind, density)

    return _cheapest(cost, max(lowest, head_wind), highest)


def energy_per_metre(
    model: PowerModel, airspeed: FloatArray | float, head_wind: float = 0.0, density: float = SEA_LEVEL_DENSITY
) -> FloatArray:
    """Joules per metre over ground in level flight against a head wind [m/s]; infinite without way over ground."""
    over_ground = np.asarray(airspeed, dtype=np.float64) - head_wind
    watts = model.watts(airspeed, 0.0, density)
    with np.errstate(over="ignore"):  # next to no way: infinite as well
        return np.asarray(np.divide(watts, over_ground, out=np.full(watts.shape, math.inf), where=over_ground > 0))


def flow(airspeed: FloatArray | float, climb_rate: FloatArray | float, density: FloatArray | float) -> Flow:
    """Airspeed, climb rate and density as arrays; `InputError` for what no air does."""
    speed, climb, rho = (np.asarray(one, dtype=np.float64) for one in (airspeed, climb_rate, density))
    if np.any(speed < 0):
        raise InputError(f"an airspeed of {float(np.min(speed)):g} m/s is below 0; the wind's sign is no part of it")
    if np.any(rho <= 0):
        raise InputError(f"an air density of {float(np.min(rho)):g} kg/m³ is not above 0")
    return speed, climb, rho


def require(
    model: object, positive: tuple[str, ...] = (), not_negative: tuple[str, ...] = (), shares: tuple[str, ...] = ()
) -> None:
    """Raise `InputError` for each field of a model that is not above 0, is below 0, or is no share up to 1."""
    rules: tuple[tuple[tuple[str, ...], Callable[[float], bool], str], ...] = (
        (positive, lambda value: value > 0, "must be above 0"),
        (not_negative, lambda value: value >= 0, "must not be below 0"),
        (shares, lambda value: 0 < value <= 1, "must be above 0 and at most 1"),
    )
    problems = [
        Problem(f"{rule}, not {getattr(model, name)}", f"power.{name}")
        for names, holds, rule in rules
        for name in names
        if not (math.isfinite(getattr(model, name)) and holds(getattr(model, name)))
    ]
    if problems:
        raise InputError(problems)


def _between(model: PowerModel, fastest: float, density: float) -> tuple[float, float]:
    lowest, highest = model.airspeeds(density)
    if not (math.isfinite(fastest) and fastest > lowest):
        raise InputError(f"{fastest:g} m/s is no largest airspeed; give one above {lowest:g} m/s")
    return lowest, min(highest, fastest)


def _cheapest(cost: Callable[[FloatArray | float], FloatArray], lowest: float, highest: float) -> float:
    """The airspeed of the smallest cost: a scan, then a search between the best one's neighbours."""
    from scipy.optimize import minimize_scalar  # here, since most who import this room never ask for it

    grid = np.linspace(lowest, highest, _SCAN)
    best = int(np.argmin(cost(grid)))
    bounds = (float(grid[max(best - 1, 0)]), float(grid[min(best + 1, _SCAN - 1)]))
    search = minimize_scalar(
        lambda airspeed: float(cost(airspeed)), bounds=bounds, method="bounded", options={"xatol": _CLOSE}
    )
    found, scanned = float(search.x), float(grid[best])
    return found if cost(found) < cost(scanned) else scanned
