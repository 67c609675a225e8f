"""The flight modes of ArduCopter and PX4, and what the stand-in does in each."""

from __future__ import annotations

from dataclasses import dataclass

from pymavlink.dialects.v20 import ardupilotmega as mavlink

from gcs_windplan.standin.flight import Doing
from gcs_windplan.vehicle import Autopilot

_CUSTOM = mavlink.MAV_MODE_FLAG_CUSTOM_MODE_ENABLED | mavlink.MAV_MODE_FLAG_STABILIZE_ENABLED
_BY_ITSELF = _CUSTOM | mavlink.MAV_MODE_FLAG_GUIDED_ENABLED
_PX4_AUTO = _BY_ITSELF | mavlink.MAV_MODE_FLAG_AUTO_ENABLED
_BY_HAND = mavlink.MAV_MODE_FLAG_MANUAL_INPUT_ENABLED


@dataclass(frozen=True, slots=True)
class Mode:
    """One mode: HEARTBEAT's `custom_mode` and the flags of its `base_mode`."""

    name: str
    number: int
    doing: Doing
    flags: int


def _px4(main: int, sub: int = 0) -> int:
    return main << 16 | sub << 24  # px4_custom_mode.h


#: ArduCopter's mode.h; PX4's px4_custom_mode.h. The first is the one after boot.
MODES: dict[Autopilot, tuple[Mode, ...]] = {
    "ardupilot": (
        Mode("STABILIZE", 0, "hold", _CUSTOM | _BY_HAND),
        Mode("ALT_HOLD", 2, "hold", _CUSTOM | _BY_HAND),
        Mode("AUTO", 3, "mission", _BY_ITSELF),
        Mode("GUIDED", 4, "guided", _BY_ITSELF),
        Mode("LOITER", 5, "hold", _CUSTOM | _BY_HAND),
        Mode("RTL", 6, "return", _BY_ITSELF),
        Mode("LAND", 9, "land", _BY_ITSELF),
        Mode("POSHOLD", 16, "hold", _CUSTOM | _BY_HAND),
        Mode("BRAKE", 17, "hold", _BY_ITSELF),
        Mode("SMART_RTL", 21, "return", _BY_ITSELF),
    ),
    "px4": (
        Mode("Hold", _px4(4, 3), "guided", _PX4_AUTO),
        Mode("Mission", _px4(4, 4), "mission", _PX4_AUTO),
        Mode("Return", _px4(4, 5), "return", _PX4_AUTO),
        Mode("Land", _px4(4, 6), "land", _PX4_AUTO),
        Mode("Takeoff", _px4(4, 2), "guided", _PX4_AUTO),
        Mode("Manual", _px4(1), "hold", _CUSTOM | _BY_HAND),
        Mode("Altitude", _px4(2), "hold", _CUSTOM | _BY_HAND),
        Mode("Position", _px4(3), "hold", _CUSTOM | _BY_HAND),
        Mode("Stabilized", _px4(7), "hold", _CUSTOM | _BY_HAND),
    ),
}


_NAMES: dict[Autopilot, dict[Doing, str]] = {
    "ardupilot": {"hold": "LOITER", "mission": "AUTO", "guided": "GUIDED", "return": "RTL", "land": "LAND"},
    "px4": {"hold": "Hold", "mission": "Mission", "guided": "Hold", "return": "Return", "land": "Land"},
}


def mode_numbered(autopilot: Autopilot, number: int) -> Mode | None:
    """The mode with a `custom_mode`, None where the stand-in has none."""
    return next((mode for mode in MODES[autopilot] if mode.number == number), None)


def mode_for(autopilot: Autopilot, doing: Doing) -> Mode:
    """The mode in which the vehicle does something of its own, or stays where it is."""
    name = _NAMES[autopilot][doing]
    return next(mode for mode in MODES[autopilot] if mode.name == name)
