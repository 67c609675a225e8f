"""From the graph's path to few and better waypoints."""

from gcs_windplan.shaping.shorten import shorten

__all__ = ["shorten"]
