"""How each firmware wants a mission on the wire: home, the frame of items without a place, the aim of DO_JUMP.

                      ArduPilot                 PX4, and kinds unknown here
home                  item 0                    no item
DO_JUMP aims at       items from 1, as files    items from 0
items without place   any frame                 frame MISSION (PX4 only)
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from gcs_windplan.errors import InputError
from gcs_windplan.geo.frame import GeoPoint
from gcs_windplan.link.wire import MissionType
from gcs_windplan.mission import (
    Command,
    Frame,
    Home,
    MissionItem,
    MissionItems,
    fence_items,
    fence_of,
    rally_items,
    rally_of,
    takes_place,
)
from gcs_windplan.mission.commands import command_name
from gcs_windplan.vehicle import Autopilot, VehicleType


def outgoing_items(
    mission: MissionItems, mission_type: MissionType, autopilot: Autopilot | None
) -> tuple[MissionItem, ...]:
    """The items of one type as they are to be sent; none where the mission has none of the type."""
    if mission_type == "fence":
        return fence_items(mission.fence)
    if mission_type == "rally":
        return rally_items(mission.rally)
    if not mission.items:
        return ()
    if autopilot == "ardupilot":
        return (_home_item(mission.home), *mission.items)
    return tuple(_for_px4(item, autopilot) for item in mission.items)


def incoming_mission(
    items: Sequence[MissionItem],
    autopilot: Autopilot | None,
    vehicle_type: VehicleType | None = None,
    home: Home | None = None,
) -> MissionItems:
    """The mission that a vehicle's items make; `home` is for vehicles that do not send it as item 0.

    Raises InputError for a DO_JUMP that aims before the first item.
    """
    if autopilot != "ardupilot":
        return MissionItems(tuple(_jump_moved(item, 1) for item in items), home, autopilot, vehicle_type)
    at_zero = _home_of(items[0]) if items else None
    return MissionItems(tuple(items[1:]), at_zero or home, autopilot, vehicle_type)


def with_fence(mission: MissionItems, items: Sequence[MissionItem]) -> MissionItems:
    """The mission with the fence of a vehicle's items; raises InputError for items that make none."""
    return replace(mission, fence=fence_of(items))


def with_rally(mission: MissionItems, items: Sequence[MissionItem]) -> MissionItems:
    """The mission with the rally points of a vehicle's items; raises InputError for items that are none."""
    return replace(mission, rally=rally_of(items))


def _home_item(home: Home | None) -> MissionItem:
    # ArduPilot puts its own home in item 0 whatever is sent; a blank is what ground stations send that know none
    if home is None:
        return MissionItem(Frame.GLOBAL, Command.NAV_WAYPOINT)
    place = home.point.latitude_deg, home.point.longitude_deg, home.altitude
    return MissionItem(Frame.GLOBAL, Command.NAV_WAYPOINT, (0.0, 0.0, 0.0, 0.0), *place)


def _home_of(item: MissionItem) -> Home | None:
    """Home as ArduPilot gives it; before it has one it gives 0, 0."""
    if not item.has_place or item.command != Command.NAV_WAYPOINT:
        return None
    return Home(GeoPoint(item.latitude_deg, item.longitude_deg), item.altitude)


def _for_px4(item: MissionItem, autopilot: Autopilot | None) -> MissionItem:
    moved = _jump_moved(item, -1)
    if autopilot != "px4" or takes_place(item.command) or not _is_known(item):
        return moved
    return replace(moved, frame=int(Frame.MISSION))


def _is_known(item: MissionItem) -> bool:
    return command_name(item.command) != f"command {item.command}"


def _jump_moved(item: MissionItem, step: int) -> MissionItem:
    """The item with a DO_JUMP's aim counted from 0 in place of 1, or back."""
    if item.command != Command.DO_JUMP:
        return item
    target, *rest = item.params
    if target + step < 0:
        raise InputError(f"DO_JUMP aims at item {target:g}, which is home: aim at an item from 1 on")
    return replace(item, params=(target + step, rest[0], rest[1], rest[2]))
