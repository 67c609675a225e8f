"""Pictures of a plan."""

from gcs_windplan.review.map import draw_map
from gcs_windplan.review.profile import draw_profile

__all__ = ["draw_map", "draw_profile"]
