"""Which messages a vehicle sends by itself, and how often."""

from __future__ import annotations

import math

from pymavlink.dialects.v20 import ardupilotmega as mavlink

from gcs_windplan.mission.firmware import Firmware

_FASTEST = 0.05  # [s]

_RATES = {
    mavlink.MAVLINK_MSG_ID_HEARTBEAT: 1.0,
    mavlink.MAVLINK_MSG_ID_ATTITUDE: 4.0,
    mavlink.MAVLINK_MSG_ID_GLOBAL_POSITION_INT: 4.0,
    mavlink.MAVLINK_MSG_ID_LOCAL_POSITION_NED: 4.0,
    mavlink.MAVLINK_MSG_ID_VFR_HUD: 4.0,
    mavlink.MAVLINK_MSG_ID_GPS_RAW_INT: 2.0,
    mavlink.MAVLINK_MSG_ID_NAV_CONTROLLER_OUTPUT: 2.0,
    mavlink.MAVLINK_MSG_ID_SYS_STATUS: 1.0,
    mavlink.MAVLINK_MSG_ID_BATTERY_STATUS: 0.5,
    mavlink.MAVLINK_MSG_ID_MISSION_CURRENT: 1.0,
    mavlink.MAVLINK_MSG_ID_EXTENDED_SYS_STATE: 1.0,
    mavlink.MAVLINK_MSG_ID_SYSTEM_TIME: 1.0,
    mavlink.MAVLINK_MSG_ID_HOME_POSITION: 0.5,
}
_WIND_RATES = {
    True: {mavlink.MAVLINK_MSG_ID_WIND: 1.0, mavlink.MAVLINK_MSG_ID_EKF_STATUS_REPORT: 1.0},
    False: {mavlink.MAVLINK_MSG_ID_WIND_COV: 1.0},
}
#: ArduPilot's groups for REQUEST_DATA_STREAM (MAV_DATA_STREAM), as far as the stand-in has their messages.
_GROUPS = {
    mavlink.MAV_DATA_STREAM_EXTENDED_STATUS: (
        mavlink.MAVLINK_MSG_ID_SYS_STATUS,
        mavlink.MAVLINK_MSG_ID_MISSION_CURRENT,
        mavlink.MAVLINK_MSG_ID_GPS_RAW_INT,
        mavlink.MAVLINK_MSG_ID_NAV_CONTROLLER_OUTPUT,
    ),
    mavlink.MAV_DATA_STREAM_POSITION: (
        mavlink.MAVLINK_MSG_ID_GLOBAL_POSITION_INT,
        mavlink.MAVLINK_MSG_ID_LOCAL_POSITION_NED,
    ),
    mavlink.MAV_DATA_STREAM_EXTRA1: (mavlink.MAVLINK_MSG_ID_ATTITUDE,),
    mavlink.MAV_DATA_STREAM_EXTRA2: (mavlink.MAVLINK_MSG_ID_VFR_HUD,),
    mavlink.MAV_DATA_STREAM_EXTRA3: (
        mavlink.MAVLINK_MSG_ID_WIND,
        mavlink.MAVLINK_MSG_ID_EKF_STATUS_REPORT,
        mavlink.MAVLINK_MSG_ID_SYSTEM_TIME,
        mavlink.MAVLINK_MSG_ID_BATTERY_STATUS,
    ),
}


class Streams:
    """The intervals of messages, by their number, and when each is due [s]."""

    def __init__(self, firmware: Firmware, now: float) -> None:
        self._defaults = {kind: 1 / rate for kind, rate in {**_RATES, **_WIND_RATES[firmware.stream_groups]}.items()}
        self._intervals = dict(self._defaults)
        self._due = dict.fromkeys(self._defaults, now)

    @property
    def wake(self) -> float:
        """When the next message is due."""
        return min(self._due.values(), default=math.inf)

    def due(self, now: float) -> list[int]:
        """The messages that are due, and not again before their interval has passed."""
        kinds = [kind for kind, when in self._due.items() if when <= now]
        for kind in kinds:
            due, interval = self._due[kind], self._intervals[kind]
            self._due[kind] = due + interval if due + interval > now else now + interval
        return kinds

    def interval(self, kind: int) -> float | None:
        """A message's interval [s], infinite where it is off, None for one that is not sent here."""
        if kind not in self._defaults:
            return None
        return self._intervals[kind] if kind in self._due else math.inf

    def set_interval(self, kind: int, microseconds: float, now: float) -> bool:
        """MAV_CMD_SET_MESSAGE_INTERVAL: -1 stops, 0 is the default; False for a message that is not sent here."""
        if kind not in self._defaults:
            return False
        if microseconds < 0 and kind != mavlink.MAVLINK_MSG_ID_HEARTBEAT:
            self._due.pop(kind, None)
            return True
        self._intervals[kind] = max(microseconds / 1e6, _FASTEST) if microseconds > 0 else self._defaults[kind]
        self._due[kind] = now
        return True

    def set_group(self, group: int, rate: float, start: bool, now: float) -> None:
        """REQUEST_DATA_STREAM: a group, or all of them, so many times a second."""
        groups = _GROUPS.values() if group == mavlink.MAV_DATA_STREAM_ALL else (_GROUPS.get(group, ()),)
        for kind in (kind for kinds in groups for kind in kinds):
            self.set_interval(kind, 1e6 / rate if start and rate > 0 else -1.0, now)
