"""A route over the members of an ensemble: what it takes in each."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from gcs_windplan.arrays import FloatArray
from gcs_windplan.flight import fly_legs
from gcs_windplan.flight.energy import leg_energies
from gcs_windplan.planning.cost import rank_of
from gcs_windplan.planning.limits import strongest_along
from gcs_windplan.planning.request import Request


@dataclass(frozen=True, slots=True)
class Spread:
    """What the route takes in each member of an ensemble: seconds, infinite where one cannot fly it, and energy [J],
    where the vehicle's power is known."""

    seconds: tuple[float, ...]
    energies: tuple[float, ...] = ()

    def at(self, quantile: float) -> float:
        """The time of the member at a quantile, from the fastest up [s]."""
        return sorted(self.seconds)[rank_of(quantile, len(self.seconds))]

    def energy_at(self, quantile: float) -> float:
        """The energy of the member at a quantile, from the least up [J]."""
        return sorted(self.energies)[rank_of(quantile, len(self.energies))]

    @property
    def unflyable(self) -> int:
        """How many members cannot fly it."""
        return sum(not np.isfinite(one) for one in self.seconds)


def spread_of(
    request: Request, points: FloatArray, begin: float = 0.0, airspeeds: FloatArray | None = None
) -> Spread | None:
    """A route (n, 3) flown in every member of the ensemble, from `begin` on; None where there is no ensemble.

    In a member whose wind or gusts break the request's limits it cannot be flown. Each leg is flown at the vehicle's
    airspeed, or at its own of `airspeeds` (n - 1,) [m/s].
    """
    if not request.scene.members:
        return None
    times = [fly_legs(points, member, request.vehicle, begin, airspeeds)[1] for member in request.scene.members]
    if request.limits.of_wind:
        broken = np.any(strongest_along(request, points, begin, airspeeds).over(request.limits), axis=1).tolist()
        times = [np.full(len(passed), np.inf) if over else passed for passed, over in zip(times, broken, strict=True)]
    energies = []
    if request.power is not None:
        for member, passed in zip(request.scene.members, times, strict=True):
            joules = leg_energies(points, passed, member, request.vehicle, request.power, airspeeds).sum()
            energies.append(float(joules) if np.isfinite(joules) else float("inf"))
    return Spread(tuple(float(passed[-1] - begin) for passed in times), tuple(energies))
