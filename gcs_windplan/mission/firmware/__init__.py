"""Firmwares: one file each holds what it takes, stores, rounds, changes, refuses and ignores, and its defaults."""

from gcs_windplan.mission.firmware.firmware import (
    Activity,
    CommandRule,
    Feasibility,
    Firmware,
    Jumps,
    MissionType,
    Mode,
    Parameter,
    Transfers,
    stores,
)
from gcs_windplan.mission.firmware.registry import (
    all_firmwares,
    autopilot_of,
    autopilots,
    check_autopilot,
    firmware_of,
    flying_firmware,
    known_firmware,
)
from gcs_windplan.mission.firmware.storage import Retention, Storage

__all__ = [
    "Activity",
    "CommandRule",
    "Feasibility",
    "Firmware",
    "Jumps",
    "MissionType",
    "Mode",
    "Parameter",
    "Retention",
    "Storage",
    "Transfers",
    "all_firmwares",
    "autopilot_of",
    "autopilots",
    "check_autopilot",
    "firmware_of",
    "flying_firmware",
    "known_firmware",
    "stores",
]
