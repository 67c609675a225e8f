"""The costs that a route is chosen by: distance, angle, hybrid (the paper's), time and energy."""

from gcs_windplan.planning.cost.choice import CostChoice
from gcs_windplan.planning.cost.leg_costs import COSTS, LegCost, LegFigures
from gcs_windplan.planning.cost.section import SectionCost, enclosing_ball, rank_of

__all__ = ["COSTS", "CostChoice", "LegCost", "LegFigures", "SectionCost", "enclosing_ball", "rank_of"]
