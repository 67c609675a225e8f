"""A* on the veil."""

from gcs_windplan.search.astar import GraphPath, WindyVeil, blow, find_path

__all__ = ["GraphPath", "WindyVeil", "blow", "find_path"]
