"""Missions: items, commands and frames, fences and rally points, and how a planned route becomes a mission."""

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

__all__ = [
    "Command",
    "Fence",
    "FenceCircle",
    "FencePolygon",
    "Frame",
    "Home",
    "MissionItem",
    "MissionItems",
    "RallyPoint",
    "ReturnPoint",
    "command_name",
    "degrees_e7",
    "fence_items",
    "fence_of",
    "frame_name",
    "is_global",
    "plain_frame",
    "rally_items",
    "rally_of",
    "scales_place",
    "takes_place",
]
