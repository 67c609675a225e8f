"""A* on the veil."""

from gcs_windplan.planning.search.astar import GraphPath, find_path
from gcs_windplan.planning.search.opening import find_open_path
from gcs_windplan.planning.search.wind_graph import NodeWinds, WindGraph, sample_wind

__all__ = ["GraphPath", "NodeWinds", "WindGraph", "find_open_path", "find_path", "sample_wind"]
