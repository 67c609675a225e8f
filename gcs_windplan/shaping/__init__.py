"""From the graph's path to few and better waypoints."""

from gcs_windplan.shaping.relax import relax, thin
from gcs_windplan.shaping.shape import shape
from gcs_windplan.shaping.shorten import shorten

__all__ = ["relax", "shape", "shorten", "thin"]
