"""Missions: items, commands and frames, fences and rally points, and how a planned route becomes a mission."""

from gcs_windplan.flight.duration import FlownLeg, MissionDuration, WindAlong, duration_of
from gcs_windplan.mission.commands import (
    Command,
    Frame,
    command_name,
    frame_name,
    is_global,
    plain_frame,
    scales_place,
    takes_place,
)
from gcs_windplan.mission.fence import (
    Fence,
    FenceCircle,
    FencePolygon,
    RallyPoint,
    ReturnPoint,
    fence_items,
    fence_of,
    rally_items,
    rally_of,
)
from gcs_windplan.mission.items import Home, MissionItem, degrees_e7
from gcs_windplan.mission.mission_items import MissionItems
from gcs_windplan.planning.route_items import RoutePoint, route_mission

__all__ = [
    "Command",
    "Fence",
    "FenceCircle",
    "FencePolygon",
    "FlownLeg",
    "Frame",
    "Home",
    "MissionDuration",
    "MissionItem",
    "MissionItems",
    "RallyPoint",
    "ReturnPoint",
    "RoutePoint",
    "WindAlong",
    "command_name",
    "degrees_e7",
    "duration_of",
    "fence_items",
    "fence_of",
    "frame_name",
    "is_global",
    "plain_frame",
    "rally_items",
    "rally_of",
    "route_mission",
    "scales_place",
    "takes_place",
]
