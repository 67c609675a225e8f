"""The costs that a route is chosen by: distance, angle, hybrid (the paper's), time and energy."""

from gcs_windplan.planning.cost.costs import COST_NAMES, CostChoice, CostName, LegCost, enclosing_ball, rank_of

__all__ = ["COST_NAMES", "CostChoice", "CostName", "LegCost", "enclosing_ball", "rank_of"]
