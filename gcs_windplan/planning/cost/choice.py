"""Which cost a user asks for."""

from __future__ import annotations

import math
from dataclasses import dataclass

from gcs_windplan.errors import InputError, Problem
from gcs_windplan.planning.cost.leg_costs import COSTS, LegCost


@dataclass(frozen=True, slots=True)
class CostChoice:
    """Which cost, by its name in `COSTS`, with the weights of the hybrid one (11).

    >>> import gcs_windplan as gw
    >>> print(gw.CostChoice("hybrid", distance=0.3, angle=0.7))
    hybrid (distance 0.3, angle 0.7)
    """

    name: str = "time"
    distance: float = 0.1
    angle: float = 0.9

    def __post_init__(self) -> None:
        if self.name not in COSTS:
            raise InputError(Problem(f"'{self.name}' is no cost, choose {', '.join(COSTS)}", "cost"))
        weights = (self.distance, self.angle)
        if not all(math.isfinite(w) and w >= 0 for w in weights) or sum(weights) == 0:
            raise InputError(Problem("the weights of hybrid must be 0 or more, and not both 0", "cost"))

    @property
    def leg_cost(self) -> LegCost:
        """The cost itself."""
        return COSTS[self.name]

    def __str__(self) -> str:
        if self.name == "hybrid":
            return f"hybrid (distance {self.distance:g}, angle {self.angle:g})"
        return self.name
