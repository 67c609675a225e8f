"""A* on the veil."""

from gcs_windplan.planning.search.astar import GraphPath, find_path
from gcs_windplan.planning.search.opening import find_open_path
from gcs_windplan.planning.search.windy import WindyVeil, blow

__all__ = ["GraphPath", "WindyVeil", "blow", "find_open_path", "find_path"]
