"""The costs that a route is chosen by: distance, angle, hybrid (the paper's), time and energy."""

from gcs_windplan.cost.costs import COST_NAMES, CostChoice, CostName, LegCost, enclosing_ball, rank_of
from gcs_windplan.cost.sampling import (
    LegIntegrals,
    SampledLegs,
    clocked,
    integrate,
    performance_of,
    sample_legs,
    still_air_times,
)

__all__ = [
    "COST_NAMES",
    "CostChoice",
    "CostName",
    "LegCost",
    "LegIntegrals",
    "SampledLegs",
    "clocked",
    "enclosing_ball",
    "integrate",
    "performance_of",
    "rank_of",
    "sample_legs",
    "still_air_times",
]
