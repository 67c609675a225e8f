"""The firmwares that there are: one file each beside this one, with a `FIRMWARES` that lists its kinds of vehicles."""

from __future__ import annotations

import importlib
import pkgutil
from functools import cache

from gcs_windplan.errors import InputError
from gcs_windplan.mission.firmware.firmware import Firmware
from gcs_windplan.vehicle import Autopilot, VehicleType


@cache
def all_firmwares() -> tuple[Firmware, ...]:
    """Every firmware for every kind of vehicle, in the order of the files."""
    folders = importlib.import_module(__package__).__path__
    names = sorted(module.name for module in pkgutil.iter_modules(folders))
    modules = (importlib.import_module(f"{__package__}.{name}") for name in names)
    return tuple(one for module in modules for one in getattr(module, "FIRMWARES", ()))


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


def autopilots() -> tuple[Autopilot, ...]:
    """The autopilots that something is known of."""
    return tuple(dict.fromkeys(one.autopilot for one in all_firmwares()))


def check_autopilot(autopilot: Autopilot) -> None:
    """Raise `InputError` for an autopilot that nothing is known of."""
    if autopilot not in autopilots():
        raise InputError(f"autopilot {autopilot!r} is neither {' nor '.join(map(repr, autopilots()))}")


def autopilot_of(mav_autopilot: int) -> Autopilot | None:
    """The autopilot of a HEARTBEAT's MAV_AUTOPILOT; None for one that nothing is known of."""
    return next((one.autopilot for one in all_firmwares() if one.mav_autopilot == mav_autopilot), None)
