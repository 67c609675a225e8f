"""The costs that a route is chosen by: distance, angle, hybrid (the paper's) and time."""

from gcs_windplan.cost.costs import COST_NAMES, CostChoice, CostName, LegCost, enclosing_ball
from gcs_windplan.cost.sampling import LegIntegrals, integrate, performance_of

__all__ = [
    "COST_NAMES",
    "CostChoice",
    "CostName",
    "LegCost",
    "LegIntegrals",
    "enclosing_ball",
    "integrate",
    "performance_of",
]
