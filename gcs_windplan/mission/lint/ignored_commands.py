"""Commands that a firmware stores, but that this kind of vehicle does not carry out."""

from __future__ import annotations

from gcs_windplan.mission.firmware import Firmware
from gcs_windplan.mission.lint.finding import Findings, FirmwareFinding, named, numbered
from gcs_windplan.mission.mission_items import MissionItems

_NO_VTOL = "use NAV_TAKEOFF and NAV_LAND"


def ignored_commands(mission: MissionItems, firmware: Firmware) -> Findings:
    """Items that are ignored in flight, or for which the mission is not flown at all."""
    for number, item in numbered(mission):
        name, command = named(item), item.command
        if command in firmware.not_flown:
            fact = f"{firmware.name} takes a mission with {name} and does not fly it"
            yield FirmwareFinding("command-not-flown", "rejected", number, fact, "", "remove the item")
        elif command in firmware.vtol_only:
            fact = f"{firmware.name} does not fly a mission with {name} unless it is a VTOL"
            yield FirmwareFinding("vtol-only", "rejected", number, fact, "", _NO_VTOL)
        elif command in firmware.ignored:
            fact = f"{firmware.name} takes {name} and ignores it in flight"
            yield FirmwareFinding("command-ignored", "ignored", number, fact, "", "remove the item")
        elif command in firmware.quadplane_only:
            fact = f"{firmware.name} ignores {name} unless it is a QuadPlane (Q_ENABLE 1)"
            yield FirmwareFinding("vtol-only", "ignored", number, fact, "", _NO_VTOL)
