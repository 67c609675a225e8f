"""What a firmware makes of latitudes, longitudes and altitudes."""

from __future__ import annotations

from gcs_windplan.mission.commands import Command, Frame, is_global, plain_frame, takes_place
from gcs_windplan.mission.items import MissionItem, MissionItems
from gcs_windplan.mission.kept import float_text, keeps_altitude, same_float
from gcs_windplan.mission.lint.finding import Findings, Firmware, FirmwareFinding, named, numbered
from gcs_windplan.mission.lint.parameters import held_value
from gcs_windplan.mission.supported import ARDUPILOT_STORES_PLACE

_CIRCLES = frozenset(
    (Command.NAV_LOITER_UNLIM, Command.NAV_LOITER_TURNS, Command.NAV_LOITER_TIME, Command.NAV_LOITER_TO_ALT)
)
_WAYPOINTS = frozenset((Command.NAV_WAYPOINT, Command.NAV_SPLINE_WAYPOINT))
_FLOWN_TO = _CIRCLES | _WAYPOINTS | {Command.NAV_LAND, Command.NAV_VTOL_LAND, Command.NAV_PAYLOAD_PLACE}
_LOWEST_TAKEOFF = 1.0  # [m] ArduCopter takeoff.cpp and mode_auto.cpp, takeoff_start: 100 cm


def places(mission: MissionItems, firmware: Firmware) -> Findings:
    """Places that are rounded, or mean something else than they say."""
    for number, item in numbered(mission):
        if firmware.autopilot == "ardupilot":
            yield from _cut_altitude(number, item, firmware)
            yield from _altitude_zero(number, item, firmware)
            yield from _no_degrees(number, item, firmware)
            yield from _low_takeoff(number, item, firmware)
        yield from _place_zero(number, item, firmware)
    yield from _merged(mission, firmware)


def _cut_altitude(number: int, item: MissionItem, firmware: Firmware) -> Findings:
    """AP_Mission.cpp: the altitude times 100.0f as an integer. Measured: 61.999 comes back as 61.99."""
    if item.command not in ARDUPILOT_STORES_PLACE or not (
        takes_place(item.command) or keeps_altitude(item.command, "ardupilot")
    ):
        return
    held = held_value("c", item.altitude)
    if held is not None and not same_float(held, item.altitude):
        change = f"{float_text(item.altitude)} m becomes {float_text(held)} m"
        fact = f"{firmware.name} cuts altitudes to whole centimetres"
        yield FirmwareFinding("altitude-rounded", "rounded", number, fact, change)


def _altitude_zero(number: int, item: MissionItem, firmware: Firmware) -> Findings:
    """ArduCopter mode_auto.cpp, loc_from_cmd: 0 in any frame; Location.cpp, sanitize: 0 above home, in circles."""
    if abs(item.altitude) >= 0.01 or not takes_place(item.command):
        return
    copter = firmware.vehicle_type != "fixed-wing"
    circles_above_home = item.command in _CIRCLES and plain_frame(item.frame) == Frame.GLOBAL_RELATIVE_ALT
    if item.command in _CIRCLES | _WAYPOINTS if copter else circles_above_home:
        fact = f"{firmware.name} takes the altitude 0 of {named(item)} for: stay as high as you are"
        change = f"altitude {float_text(item.altitude)} m"
        yield FirmwareFinding("altitude-zero", "changed", number, fact, change, "write 0.02 m, or the altitude meant")


def _low_takeoff(number: int, item: MissionItem, firmware: Firmware) -> Findings:
    """ArduCopter mode_auto.cpp, takeoff_start: never below 1 m above home."""
    above_home = plain_frame(item.frame) == Frame.GLOBAL_RELATIVE_ALT
    if item.command != Command.NAV_TAKEOFF or not above_home or firmware.vehicle_type == "fixed-wing":
        return
    if item.altitude < _LOWEST_TAKEOFF:
        fact = f"{firmware.name} climbs to {_LOWEST_TAKEOFF:.0f} m at least"
        change = f"take-off to {float_text(item.altitude)} m"
        yield FirmwareFinding("takeoff-raised", "changed", number, fact, change, "write the altitude meant")


def _no_degrees(number: int, item: MissionItem, firmware: Firmware) -> Findings:
    """AP_Mission.cpp: MAV_FRAME_MISSION is stored as an altitude above sea level; MISSION_ITEM_INT has no degrees."""
    if item.frame != Frame.MISSION or item.command not in ARDUPILOT_STORES_PLACE or not takes_place(item.command):
        return
    if item.latitude_deg or item.longitude_deg or item.altitude:
        fact = f"{firmware.name} takes the place of a {named(item)} in frame MISSION (2) for one above sea level"
        where = f"{item.latitude_deg:.7g}, {item.longitude_deg:.7g}, {float_text(item.altitude)} m"
        advice = "give it frame 0 or 3: in frame 2 degrees are no degrees on the wire"
        yield FirmwareFinding("place-in-mission-frame", "changed", number, fact, where, advice)


def _place_zero(number: int, item: MissionItem, firmware: Firmware) -> Findings:
    """Latitude and longitude 0: `here` on ArduPilot (loc_from_cmd, set_next_WP), a place like any other on PX4."""
    if not is_global(item.frame) or item.latitude_deg or item.longitude_deg:
        return
    if firmware.autopilot == "px4":
        if item.command in _FLOWN_TO | {Command.NAV_TAKEOFF}:
            fact = f"PX4 takes latitude and longitude 0 of {named(item)} for a place on the equator, not for here"
            yield FirmwareFinding("place-zero", "changed", number, fact, "", "write the place meant")
    elif item.command in _FLOWN_TO:
        fact = f"{firmware.name} takes latitude and longitude 0 of {named(item)} for the place where it is then"
        yield FirmwareFinding("place-zero", "changed", number, fact, "", "write the place unless that is meant")


def _merged(mission: MissionItems, firmware: Firmware) -> Findings:
    """Both firmwares get 1e-7 degrees, 11 mm: that matters only where two places become one."""
    before: tuple[int, MissionItem] | None = None
    for number, item in numbered(mission):
        if not item.has_place:
            continue
        if before is not None and _become_one(before[1], item):
            fact = "MAVLink carries 1e-7 degrees (11 mm), so that two places become one"
            same = f"items {before[0]} and {number}"
            yield FirmwareFinding("place-rounded", "rounded", number, fact, same, "remove one of them")
        before = number, item


def _become_one(one: MissionItem, other: MissionItem) -> bool:
    apart = (one.latitude_deg, one.longitude_deg) != (other.latitude_deg, other.longitude_deg)
    return apart and (one.lat_e7, one.lon_e7, one.altitude) == (other.lat_e7, other.lon_e7, other.altitude)
