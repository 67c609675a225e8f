"""Missions: items, commands and frames, and how a planned route becomes a mission."""

from gcs_windplan.mission.build import RoutePoint, route_mission
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
from gcs_windplan.mission.items import Home, Mission, MissionItem, degrees_e7

__all__ = [
    "Command",
    "Frame",
    "Home",
    "Mission",
    "MissionItem",
    "RoutePoint",
    "command_name",
    "degrees_e7",
    "frame_name",
    "is_global",
    "plain_frame",
    "route_mission",
    "scales_place",
    "takes_place",
]
