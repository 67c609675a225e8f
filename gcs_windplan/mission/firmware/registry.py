"""The firmwares that there are: one file each beside this one, named as its autopilot.

Its `FIRMWARES` list the kinds of vehicles, and what all have in common.
"""

from __future__ import annotations

import importlib
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING

from gcs_windplan.errors import InputError

if TYPE_CHECKING:
    from gcs_windplan.mission.firmware.firmware import Firmware
    from gcs_windplan.vehicle import Autopilot, VehicleType


def autopilots() -> tuple[Autopilot, ...]:
    """The autopilots that something is known of: their files' names, of which none is imported, so that it is quick."""
    folders = importlib.import_module(str(__package__)).__path__
    files = (file for folder in folders for file in Path(folder).glob("*.py"))
    return tuple(sorted(file.stem for file in files if "\nFIRMWARES" in file.read_text("utf-8")))


@cache
def all_firmwares() -> tuple[Firmware, ...]:
    """Every firmware for every kind of vehicle, in the order of the files."""
    modules = (importlib.import_module(f"{__package__}.{name}") for name in autopilots())
    return tuple(one for module in modules for one in module.FIRMWARES)


def firmware_of(autopilot: Autopilot, vehicle_type: VehicleType | None = None) -> Firmware:
    """An autopilot's firmware for a kind of vehicle; without one, what all its kinds have in common.

    Raises `InputError` for one that nothing is known of.
    """
    check_autopilot(autopilot)
    for firmware in all_firmwares():
        if (firmware.autopilot, firmware.vehicle_type) == (autopilot, vehicle_type):
            return firmware
    raise InputError(f"no firmware {autopilot!r} for {vehicle_type or 'any vehicle'} is known")


def known_firmware(autopilot: Autopilot | None, vehicle_type: VehicleType | None = None) -> Firmware | None:
    """The same, and None for an autopilot that nothing is known of."""
    return None if autopilot is None else firmware_of(autopilot, vehicle_type)


def flying_firmware(autopilot: Autopilot | None, vehicle_type: VehicleType | None = None) -> Firmware:
    """The firmware that a mission is taken to be flown by: ArduPilot's, of multicopters, where it names none."""
    return firmware_of(autopilot or "ardupilot", vehicle_type or "multicopter")


def check_autopilot(autopilot: Autopilot) -> None:
    """Raise `InputError` for an autopilot that nothing is known of."""
    if all(one.autopilot != autopilot for one in all_firmwares()):
        raise InputError(f"autopilot {autopilot!r} is neither {' nor '.join(map(repr, autopilots()))}")


def autopilot_of(mav_autopilot: int) -> Autopilot | None:
    """The autopilot of a HEARTBEAT's MAV_AUTOPILOT; None for one that nothing is known of."""
    return next((one.autopilot for one in all_firmwares() if one.mav_autopilot == mav_autopilot), None)
