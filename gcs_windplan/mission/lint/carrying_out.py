"""Commands that a firmware stores, but that this kind of vehicle does not carry out."""

from __future__ import annotations

from pymavlink.dialects.v20 import ardupilotmega as mavlink

from gcs_windplan.mission.commands import Command
from gcs_windplan.mission.items import MissionItems
from gcs_windplan.mission.lint.finding import Findings, Firmware, FirmwareFinding, named, numbered
from gcs_windplan.vehicle import VehicleType

_VTOL = frozenset((Command.NAV_VTOL_TAKEOFF, Command.NAV_VTOL_LAND, Command.DO_VTOL_TRANSITION))

# What ModeAuto::start_command in ArduCopter's mode_auto.cpp does not name, nor AP_Mission's own start_command.
_COPTER_PASSES_OVER = frozenset(
    (
        Command.NAV_CONTINUE_AND_CHANGE_ALT,
        Command.DO_VTOL_TRANSITION,
        mavlink.MAV_CMD_NAV_ALTITUDE_WAIT,
        mavlink.MAV_CMD_NAV_SET_YAW_SPEED,
        mavlink.MAV_CMD_DO_INVERTED_FLIGHT,
        mavlink.MAV_CMD_DO_GO_AROUND,
        mavlink.MAV_CMD_DO_SET_REVERSE,
        mavlink.MAV_CMD_DO_AUTOTUNE_ENABLE,
    )
)
# What Plane::start_command in ArduPlane's commands_logic.cpp does not name.
_PLANE_PASSES_OVER = frozenset(
    (
        Command.NAV_SPLINE_WAYPOINT,
        Command.CONDITION_YAW,
        mavlink.MAV_CMD_NAV_GUIDED_ENABLE,
        mavlink.MAV_CMD_NAV_SET_YAW_SPEED,
        mavlink.MAV_CMD_NAV_ATTITUDE_TIME,
        mavlink.MAV_CMD_DO_GUIDED_LIMITS,
        mavlink.MAV_CMD_DO_GO_AROUND,
        mavlink.MAV_CMD_DO_SET_REVERSE,
        mavlink.MAV_CMD_DO_WINCH,
    )
)
_PASSED_OVER: dict[VehicleType | None, frozenset[int]] = {
    "multicopter": _COPTER_PASSES_OVER,
    "fixed-wing": _PLANE_PASSES_OVER,
    None: _COPTER_PASSES_OVER & _PLANE_PASSES_OVER,
}
# mavlink_mission.cpp takes them, FeasibilityChecker.cpp (checkMissionItemValidity) does not have them.
_PX4_DOES_NOT_FLY = frozenset((Command.CONDITION_DELAY, Command.CONDITION_DISTANCE))


def carrying_out(mission: MissionItems, firmware: Firmware) -> Findings:
    """Items that are passed over in flight, or for which the mission is not flown at all."""
    for number, item in numbered(mission):
        if firmware.autopilot == "px4":
            yield from _px4(number, named(item), item.command, firmware)
        elif item.command in _PASSED_OVER[firmware.vehicle_type]:
            yield _passed_over(number, named(item), firmware)
        elif firmware.vehicle_type == "fixed-wing" and item.command in _VTOL | {Command.NAV_PAYLOAD_PLACE}:
            # quadplane.cpp, do_vtol_takeoff and do_vtol_land: false where no QuadPlane is set up
            fact = f"{firmware.name} passes over {named(item)} unless it is a QuadPlane (Q_ENABLE 1)"
            yield FirmwareFinding("vtol-only", "ignored", number, fact, "", "use NAV_TAKEOFF and NAV_LAND")


def _passed_over(number: int, name: str, firmware: Firmware) -> FirmwareFinding:
    fact = f"{firmware.name} takes {name} and passes over it in flight"
    return FirmwareFinding("command-ignored", "ignored", number, fact, "", "remove the item")


def _px4(number: int, name: str, command: int, firmware: Firmware) -> Findings:
    if command in _PX4_DOES_NOT_FLY:
        fact = f"PX4 takes a mission with {name} and does not fly it"
        yield FirmwareFinding("command-not-flown", "rejected", number, fact, "", "remove the item")
    elif command in _VTOL and firmware.vehicle_type is not None:  # FeasibilityChecker.cpp, checkItemsFitToVehicleType
        fact = f"PX4 does not fly a mission with {name} unless it is a VTOL"
        yield FirmwareFinding("vtol-only", "rejected", number, fact, "", "use NAV_TAKEOFF and NAV_LAND")
