"""The costs that a route is chosen by: distance, angle, hybrid (the paper's) and time."""

from gcs_windplan.cost.costs import COST_NAMES, CostChoice, CostName, LegCost, enclosing_ball, rank_of
from gcs_windplan.cost.sampling import LegIntegrals, clocked, integrate, performance_of, still_air_times

__all__ = [
    "COST_NAMES",
    "CostChoice",
    "CostName",
    "LegCost",
    "LegIntegrals",
    "clocked",
    "enclosing_ball",
    "integrate",
    "performance_of",
    "rank_of",
    "still_air_times",
]
