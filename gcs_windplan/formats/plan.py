"""`.plan`, QGroundControl's mission file: one JSON object.

    fileType "Plan", version 1, groundStation, geoFence{}, rallyPoints{} (geofence.py)
    mission: version 2, firmwareType, vehicleType, cruiseSpeed, hoverSpeed,
             plannedHomePosition [latitude, longitude, AMSL], items
      each item: type "SimpleItem", command, frame, params [7, null for NaN], autoContinue, doJumpId

Home is no item. Complex items (surveys, corridors) are read through the simple items they carry.
"""

from __future__ import annotations

import json
import math
import os
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from typing import Any

from pymavlink.dialects.v20 import common as mavlink

from gcs_windplan.errors import FormatError, InputError, Problem
from gcs_windplan.formats.digits import json_number, json_place
from gcs_windplan.formats.document import Node, parse_document
from gcs_windplan.formats.geofence import fence_object, rally_object, read_fence, read_rally
from gcs_windplan.formats.reading import ReadMission, Repairs, home_or_none, read_text, without_mark
from gcs_windplan.formats.writing import write_atomically
from gcs_windplan.link.peer import VEHICLE_TYPES, VTOL_TYPES
from gcs_windplan.mission import (
    Command,
    Frame,
    Home,
    MissionItem,
    MissionItems,
    command_name,
    is_global,
    plain_frame,
    takes_place,
)
from gcs_windplan.mission.firmware import autopilot_of, firmware_of
from gcs_windplan.vehicle import Autopilot, VehicleType

_VEHICLES: dict[VehicleType, int] = {
    "multicopter": mavlink.MAV_TYPE_QUADROTOR,
    "fixed-wing": mavlink.MAV_TYPE_FIXED_WING,
}
# QGroundControl's AltMode; 0 is mixed
_ALTITUDE_MODES: dict[int, int] = {Frame.GLOBAL_RELATIVE_ALT: 1, Frame.GLOBAL: 2, Frame.GLOBAL_TERRAIN_ALT: 4}


def write_plan(mission: MissionItems, path: str | os.PathLike[str]) -> None:
    """Write the mission as a .plan file. Raises FormatError: no home, or the file cannot be written."""
    write_atomically(path, format_plan(mission))


def format_plan(mission: MissionItems) -> str:
    """The text of the mission's .plan file; raises FormatError for a mission without home.

    Coordinates are rounded to 1e-7 degrees, altitudes to millimetres; the deprecated _INT frames, which
    QGroundControl would take for AMSL, become plain ones. Fence and rally points are there even where they are
    empty, as its readers demand; rally points above ground have no place there and raise FormatError.
    """
    if mission.home is None:
        raise FormatError("a .plan file needs the planned home, and this mission has none: give it one")
    document = {
        "fileType": "Plan",
        "geoFence": fence_object(mission.fence),
        "groundStation": "gcs-windplan",
        "mission": _mission_object(mission, mission.home),
        "rallyPoints": rally_object(mission.rally, mission.home),
        "version": 1,
    }
    return json.dumps(document, indent=4, sort_keys=True, allow_nan=False) + "\n"


def _mission_object(mission: MissionItems, home: Home) -> dict[str, Any]:
    place = json_place(home.point.latitude_deg, home.point.longitude_deg, home.altitude)
    speeds = {"cruiseSpeed": mission.cruise_speed, "hoverSpeed": mission.hover_speed}
    return {
        "firmwareType": 0 if mission.autopilot is None else firmware_of(mission.autopilot).mav_autopilot,
        "globalPlanAltitudeMode": _common_altitude_mode(mission),
        "items": [_item_object(item, number) for number, item in enumerate(mission.items, start=1)],
        "plannedHomePosition": place,
        "vehicleType": 0 if mission.vehicle_type is None else _VEHICLES[mission.vehicle_type],
        "version": 2,
        **{key: json_number(speed) for key, speed in speeds.items() if speed is not None},
    }


def _common_altitude_mode(mission: MissionItems) -> int:
    modes = {_altitude_mode(item) for item in mission.items} - {None}
    return (modes.pop() or 0) if len(modes) == 1 else 0


def _altitude_mode(item: MissionItem) -> int | None:
    """QGroundControl's altitude mode, None for an item without an altitude on Earth."""
    return _ALTITUDE_MODES.get(plain_frame(item.frame)) if takes_place(item.command) else None


def _item_object(item: MissionItem, number: int) -> dict[str, Any]:
    place = json_place(item.latitude_deg, item.longitude_deg, item.altitude)
    mode = _altitude_mode(item)
    altitude = {"AMSLAltAboveTerrain": None, "Altitude": place[2], "AltitudeMode": mode}
    return {
        "autoContinue": item.autocontinue,
        "command": int(item.command),
        "doJumpId": number,
        "frame": plain_frame(item.frame),
        "params": [*(None if math.isnan(param) else json_number(param) for param in item.params), *place],
        "type": "SimpleItem",
        **(altitude if mode is not None else {}),
    }


def read_plan(path: str | os.PathLike[str]) -> ReadMission:
    """Read a .plan file. Raises FormatError with the place in the document and what to do."""
    repairs = Repairs()
    return _parse(read_text(path, repairs), Path(path), repairs)


def parse_plan(text: str, name: str = "<text>") -> ReadMission:
    """Read the text of a .plan file; `name` stands for the file in messages.

    What cannot be used of fence and rally points is left out, which the repairs note. Raises FormatError
    for other versions and for complex items that do not carry their simple ones.
    """
    return _parse(text, Path(name), Repairs())


def _parse(text: str, file: Path, repairs: Repairs) -> ReadMission:
    root = parse_document(without_mark(text, repairs), file)
    _check_versions(root)
    mission = root.at("mission")
    items = _items(mission.at("items"), repairs)
    home = _home(mission.at("plannedHomePosition"), repairs)
    autopilot = _autopilot(mission.at("firmwareType"), repairs)
    vehicle_type = _vehicle_type(mission.at("vehicleType"), repairs)
    cruise_speed = _speed(mission.at("cruiseSpeed"), repairs)
    hover_speed = _speed(mission.at("hoverSpeed"), repairs)
    fence, rally = read_fence(root, repairs), read_rally(root, repairs)
    read = MissionItems(items, home, autopilot, vehicle_type, cruise_speed, hover_speed, fence, rally)
    return repairs.read(read)


def _check_versions(root: Node) -> None:
    if root.at("fileType").value != "Plan":
        advice = "an older .mission file can be opened in QGroundControl and saved as .plan"
        raise FormatError(Problem(f"is no .plan file (its fileType is not 'Plan'); {advice}", file=root.file))
    for node, known in ((root.at("version"), 1), (root.at("mission").at("version"), 2)):
        if (version := node.whole()) != known:
            node.refuse(f"is {version}, and only {known} is known: save it with a current QGroundControl")


def _items(array: Node, repairs: Repairs) -> tuple[MissionItem, ...]:
    nodes = list(_simple_items(array, repairs))
    places: dict[int, int] = {}
    for place, node in enumerate(nodes, start=1):
        jump_id = node.at("doJumpId")
        if jump_id.present:
            places.setdefault(jump_id.whole(), place)
    return tuple(_landing_right(_item(node, repairs), node, places, repairs) for node in nodes)


def _simple_items(array: Node, repairs: Repairs) -> Iterator[Node]:
    for node in array.elements():
        kind = node.at("type").value
        if kind == "SimpleItem":
            yield node
        elif kind == "ComplexItem":
            yield from _expanded(node, repairs)
        else:
            node.at("type").refuse("is neither SimpleItem nor ComplexItem")


def _expanded(node: Node, repairs: Repairs) -> Iterator[Node]:
    """The simple items that a complex item carries."""
    name = f"{node.at('complexItemType').value}, version {node.at('version').value}"
    style = node.at("TransectStyleComplexItem")
    items = style.at("Items") if style.present else style
    if not items.present:
        node.refuse(
            f"is a complex item ({name}) without the simple items it stands for: upload the mission to a "
            "vehicle or simulator, download it and save that"
        )
    repairs.add(f"{node.path} ({name}) was replaced by the simple items it carries")
    yield from _simple_items(items, repairs)


def _item(node: Node, repairs: Repairs) -> MissionItem:
    command, frame = node.at("command").whole(), node.at("frame").whole()
    p1, p2, p3, p4, *place = _seven_numbers(node, repairs)
    unknown = list(map(math.isnan, place))
    if any(unknown) and takes_place(command) and is_global(frame):
        if unknown[0] != unknown[1] or (unknown[2] and not unknown[0]):
            node.refuse(f"{command_name(command)} has null for a part of its place: give all of it, or none for 'here'")
        repairs.add(f"{node.path}.params: null in the place was read as 0")
    latitude, longitude, altitude = (0.0 if math.isnan(number) else number for number in place)
    proceed = _flag(node.at("autoContinue"), repairs)
    try:
        return MissionItem(frame, command, (p1, p2, p3, p4), latitude, longitude, altitude, proceed)
    except InputError as error:
        node.refuse(str(error))


def _seven_numbers(node: Node, repairs: Repairs) -> list[float]:
    """The parameters; older files have four, and the place stood beside them."""
    numbers = [param.number_or_nan() for param in node.at("params").elements()]
    beside = node.at("coordinate")
    if len(numbers) == 4 and beside.present:
        repairs.add(f"{node.path}: the coordinate beside its four params was taken for the last three")
        numbers += [number.number_or_nan() for number in beside.elements()]
    if len(numbers) != 7:
        node.at("params").refuse(f"has {len(numbers)} numbers, not 7: the place comes last")
    return numbers


def _flag(node: Node, repairs: Repairs) -> bool:
    if not isinstance(node.value, bool):
        repairs.add(f"{node.path} is no true or false; read as true")
        return True
    return node.value


def _landing_right(item: MissionItem, node: Node, places: dict[int, int], repairs: Repairs) -> MissionItem:
    """The item; a DO_JUMP aims at an item's number from 1 and no longer at its doJumpId."""
    target = item.params[0]
    place = places.get(int(target), target) if math.isfinite(target) else target
    if item.command != Command.DO_JUMP or place == target:
        return item
    repairs.add(f"{node.path}: DO_JUMP to doJumpId {target:g} became one to item {place}")
    return replace(item, params=(float(place), *item.params[1:]))


def _home(node: Node, repairs: Repairs) -> Home | None:
    if not node.present or node.value is None:
        repairs.add("the file has no planned home")
        return None
    numbers = [element.number_or_nan() for element in node.elements()]
    if len(numbers) != 3:
        node.refuse(f"has {len(numbers)} numbers, not latitude, longitude and altitude")
    latitude, longitude, altitude = numbers
    if any(map(math.isnan, numbers)):
        repairs.add("the planned home has null in it; it was left out")
        return None
    try:
        return home_or_none(latitude, longitude, altitude, repairs)
    except InputError as error:
        node.refuse(str(error))


def _autopilot(node: Node, repairs: Repairs) -> Autopilot | None:
    firmware = node.whole() if node.present else 0
    autopilot = autopilot_of(firmware)
    if autopilot is None:
        repairs.add(f"firmwareType {firmware} is neither ArduPilot nor PX4; the autopilot is unknown")
    return autopilot


def _vehicle_type(node: Node, repairs: Repairs) -> VehicleType | None:
    number = node.whole() if node.present else 0
    kind = None if number in VTOL_TYPES else VEHICLE_TYPES.get(number)
    if kind is None:
        repairs.add(f"vehicleType {number} is neither a multicopter nor fixed-wing; the vehicle is unknown")
    return kind


def _speed(node: Node, repairs: Repairs) -> float | None:
    if not node.present or node.value is None:
        return None
    speed = node.number()
    if speed > 0:
        return speed
    repairs.add(f"{node.path} {speed:g} is no speed; it was left out")
    return None
