"""The mission server of a stand-in vehicle: takes missions, fences and rally points, and gives them back."""

from __future__ import annotations

from gcs_windplan.mission.firmware import Firmware
from gcs_windplan.standin.ardupilot_rules import ArduPilotMissions
from gcs_windplan.standin.px4_rules import Px4Missions
from gcs_windplan.standin.rules import MissionServer, Pilot, ServerOptions


def mission_server(
    firmware: Firmware, pilot: Pilot, options: ServerOptions | None = None, now: float = 0.0
) -> MissionServer:
    """A mission server by a firmware's rules, booted at the time `now`.

    A firmware that takes a new mission over only when it is whole talks as PX4 does, any other as ArduPilot.
    """
    make = Px4Missions if firmware.uploads_whole else ArduPilotMissions
    return make(firmware, pilot, options or ServerOptions(), now)
