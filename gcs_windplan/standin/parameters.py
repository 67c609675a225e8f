"""A few of the autopilots' parameters with their real names, so that a ground station finds what it looks for."""

from __future__ import annotations

import math
import struct
from collections.abc import Iterator, Mapping
from contextlib import suppress
from dataclasses import replace

from pymavlink.dialects.v20 import ardupilotmega as mavlink

from gcs_windplan.errors import InputError
from gcs_windplan.link.codec import Message
from gcs_windplan.mission.firmware import Firmware
from gcs_windplan.vehicle import MotionProfile

_KINDS = {
    "int8": mavlink.MAV_PARAM_TYPE_INT8,
    "int16": mavlink.MAV_PARAM_TYPE_INT16,
    "int32": mavlink.MAV_PARAM_TYPE_INT32,
    "real32": mavlink.MAV_PARAM_TYPE_REAL32,
}
_REAL = _KINDS["real32"]
_NOBODY = 65535  # PARAM_VALUE's index for a parameter that was asked for by name or set


class Parameters:
    """The parameters of one vehicle. Those that are part of the profile change it when they are set."""

    def __init__(self, firmware: Firmware, profile: MotionProfile, system: int) -> None:
        self._firmware = firmware
        self._values: dict[str, tuple[float, int]] = {
            name: (getattr(profile, one.field) / one.unit if one.field else one.value, _KINDS[one.kind])
            for name, one in sorted(firmware.parameters.items())
        }
        self.note(SYSID_THISMAV=system, MAV_SYS_ID=system)

    def note(self, **values: float) -> None:
        """Take over what the vehicle knows better; names that this firmware has not are ignored."""
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

    def set(self, name: str, number: float, kind: int, profile: MotionProfile) -> tuple[Message | None, MotionProfile]:
        """Set a parameter from PARAM_SET's number; the answer, and the profile to fly on by.

        A number that no profile can have is held, and changes nothing of how it flies.
        """
        if name not in self._values:
            return None, profile
        value = self._decoded(number, kind)
        one = self._firmware.parameters[name]
        if math.isfinite(value) and not (one.field and value <= 0):
            self.note(**{name: value})
            if one.field:
                changes: Mapping[str, float] = {one.field: value * one.unit}
                with suppress(InputError):
                    profile = replace(profile, **changes)
        return self._message(name, _NOBODY), profile

    def _message(self, name: str, index: int) -> Message:
        value, kind = self._values[name]
        return mavlink.MAVLink_param_value_message(
            name.encode(), self._encoded(value, kind), kind, len(self._values), index
        )

    def _encoded(self, value: float, kind: int) -> float:
        """PX4 sends an integer's bytes as a float's, ArduPilot its value (mavlink.io, Parameter Protocol)."""
        if self._firmware.integers_as_bytes and kind != _REAL:
            return float(struct.unpack("<f", struct.pack("<i", int(value)))[0])
        return value

    def _decoded(self, number: float, kind: int) -> float:
        if self._firmware.integers_as_bytes and kind != _REAL and math.isfinite(number):
            return float(struct.unpack("<i", struct.pack("<f", number))[0])
        return number
