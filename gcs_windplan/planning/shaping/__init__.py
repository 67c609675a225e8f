"""From the graph's path to few and better waypoints."""

from gcs_windplan.planning.shaping.relax import relax, thin
from gcs_windplan.planning.shaping.shape import shape, shape_quickly
from gcs_windplan.planning.shaping.shorten import shorten

__all__ = ["relax", "shape", "shape_quickly", "shorten", "thin"]
