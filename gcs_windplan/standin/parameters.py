"""A few of the autopilots' parameters with their real names, so that a ground station finds what it looks for."""

from __future__ import annotations

import math
import struct
from collections.abc import Iterator, Mapping
from dataclasses import replace

from pymavlink.dialects.v20 import ardupilotmega as mavlink

from gcs_windplan.link.codec import Message
from gcs_windplan.standin.airframe import Airframe
from gcs_windplan.vehicle import Autopilot

_INT8, _INT16, _INT32 = mavlink.MAV_PARAM_TYPE_INT8, mavlink.MAV_PARAM_TYPE_INT16, mavlink.MAV_PARAM_TYPE_INT32
_REAL = mavlink.MAV_PARAM_TYPE_REAL32
_NOBODY = 65535  # PARAM_VALUE's index for a parameter that was asked for by name or set

#: Parameters that are a field of the airframe, in units of this many SI units.
_AIRFRAME_FIELDS: dict[Autopilot, dict[str, tuple[str, float]]] = {
    "ardupilot": {
        "WPNAV_SPEED": ("cruise", 0.01),
        "WPNAV_SPEED_UP": ("climb", 0.01),
        "WPNAV_SPEED_DN": ("descent", 0.01),
        "WPNAV_ACCEL": ("acceleration", 0.01),
        "WPNAV_ACCEL_Z": ("vertical_acceleration", 0.01),
        "WPNAV_RADIUS": ("radius", 0.01),
        "RTL_ALT": ("return_height", 0.01),
        "LAND_SPEED": ("landing", 0.01),
        "LAND_ALT_LOW": ("landing_height", 0.01),
    },
    "px4": {
        "MPC_XY_CRUISE": ("cruise", 1.0),
        "MPC_Z_V_AUTO_UP": ("climb", 1.0),
        "MPC_Z_V_AUTO_DN": ("descent", 1.0),
        "MPC_ACC_HOR": ("acceleration", 1.0),
        "MPC_ACC_UP_MAX": ("vertical_acceleration", 1.0),
        "NAV_ACC_RAD": ("radius", 1.0),
        "RTL_RETURN_ALT": ("return_height", 1.0),
        "MPC_LAND_SPEED": ("landing", 1.0),
        "MPC_LAND_ALT2": ("landing_height", 1.0),
    },
}
#: The others, with their type. None of them changes what the stand-in does.
_OTHERS: dict[Autopilot, dict[str, tuple[float, int]]] = {
    "ardupilot": {
        "SYSID_THISMAV": (1, _INT16),
        "SYSID_MYGCS": (255, _INT16),
        "FRAME_CLASS": (1, _INT8),
        "FRAME_TYPE": (1, _INT8),
        "ANGLE_MAX": (4500, _INT16),
        "ARMING_CHECK": (1, _INT32),
        "AUTO_OPTIONS": (3, _INT32),  # arming in AUTO, take-off with no raised throttle: as the stand-in does it
        "BATT_CAPACITY": (5000, _INT32),
        "BATT_MONITOR": (4, _INT8),
        "FENCE_ACTION": (1, _INT8),
        "FENCE_ALT_MAX": (100, _REAL),
        "FENCE_ENABLE": (0, _INT8),
        "FENCE_MARGIN": (2, _REAL),
        "FENCE_RADIUS": (300, _REAL),
        "FENCE_TOTAL": (0, _INT8),
        "FENCE_TYPE": (7, _INT8),
        "FS_GCS_ENABLE": (0, _INT8),
        "FS_THR_ENABLE": (0, _INT8),
        **{f"FLTMODE{i}": (number, _INT8) for i, number in enumerate((7, 9, 6, 3, 5, 0), start=1)},
        "MIS_OPTIONS": (0, _INT16),
        "MIS_RESTART": (0, _INT8),
        "MIS_TOTAL": (0, _INT16),
        "RALLY_LIMIT_KM": (0.3, _REAL),
        "RALLY_TOTAL": (0, _INT8),
        "RTL_ALT_FINAL": (0, _INT16),
        "RTL_LOIT_TIME": (5000, _INT32),
        "RTL_SPEED": (0, _INT16),
        "SIMPLE": (0, _INT8),
        "SUPER_SIMPLE": (0, _INT8),
        "WP_YAW_BEHAVIOR": (1, _INT8),
    },
    "px4": {
        "BAT1_CAPACITY": (5000, _REAL),
        "BAT1_N_CELLS": (4, _INT32),
        "COM_DISARM_LAND": (2, _REAL),
        "COM_RC_IN_MODE": (4, _INT32),
        "GF_ACTION": (2, _INT32),
        "GF_MAX_HOR_DIST": (0, _REAL),
        "GF_MAX_VER_DIST": (0, _REAL),
        "MAV_COMP_ID": (1, _INT32),
        "MAV_SYS_ID": (1, _INT32),
        "MAV_TYPE": (2, _INT32),
        "MIS_DIST_1WP": (10_000, _REAL),
        "MIS_TAKEOFF_ALT": (2.5, _REAL),
        "NAV_DLL_ACT": (0, _INT32),
        "NAV_RCL_ACT": (2, _INT32),
        "RTL_DESCEND_ALT": (30, _REAL),
        "RTL_LAND_DELAY": (0, _REAL),
        "RTL_TYPE": (0, _INT32),
        "SYS_AUTOSTART": (4001, _INT32),
    },
}


class Parameters:
    """The parameters of one vehicle. Those that are part of the airframe change it when they are set."""

    def __init__(self, autopilot: Autopilot, airframe: Airframe, system: int) -> None:
        fields = _AIRFRAME_FIELDS[autopilot]
        values = {name: (getattr(airframe, field) / unit, _REAL) for name, (field, unit) in fields.items()}
        self._autopilot = autopilot
        self._fields = fields
        self._values = dict(sorted({**values, **_OTHERS[autopilot]}.items()))
        self.note(SYSID_THISMAV=system, MAV_SYS_ID=system)

    def note(self, **values: float) -> None:
        """Take over what the vehicle knows better; names that this autopilot has not are passed over."""
        for name, value in values.items():
            if name in self._values:
                self._values[name] = (value, self._values[name][1])

    def all(self) -> Iterator[Message]:
        """Every parameter, as PARAM_REQUEST_LIST wants them."""
        for index, name in enumerate(self._values):
            yield self._message(name, index)

    def read(self, name: str, index: int) -> Message | None:
        """One parameter, by its index, or by its name where the index is -1; None where there is none."""
        names = list(self._values)
        if index >= 0:
            return self._message(names[index], index) if index < len(names) else None
        return self._message(name, names.index(name)) if name in self._values else None

    def set(self, name: str, number: float, kind: int, airframe: Airframe) -> tuple[Message | None, Airframe]:
        """Set a parameter from PARAM_SET's number; the answer, and the airframe that flies on."""
        if name not in self._values:
            return None, airframe
        value = self._decoded(number, kind)
        field, unit = self._fields.get(name, ("", 1.0))
        if not field and math.isfinite(value):
            self.note(**{name: value})
        elif 0 < value < math.inf:
            self.note(**{name: value})
            changes: Mapping[str, float] = {field: value * unit}
            airframe = replace(airframe, **changes)
        return self._message(name, _NOBODY), airframe

    def _message(self, name: str, index: int) -> Message:
        value, kind = self._values[name]
        return mavlink.MAVLink_param_value_message(
            name.encode(), self._encoded(value, kind), kind, len(self._values), index
        )

    def _encoded(self, value: float, kind: int) -> float:
        """PX4 sends an integer's bytes as a float's, ArduPilot its value (mavlink.io, Parameter Protocol)."""
        if self._autopilot == "px4" and kind != _REAL:
            return float(struct.unpack("<f", struct.pack("<i", int(value)))[0])
        return value

    def _decoded(self, number: float, kind: int) -> float:
        if self._autopilot == "px4" and kind != _REAL and math.isfinite(number):
            return float(struct.unpack("<i", struct.pack("<f", number))[0])
        return number
