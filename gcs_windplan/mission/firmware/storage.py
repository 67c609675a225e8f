"""How a firmware stores a number: what comes back of it, and whether that is all that could.

Each way of storing is a value with three questions. A float that travels as MAVLink's 32 bits is cut to the type of
the firmware's own field, which is what the constants are named by (the whole ones in `whole_numbers`):

    FLOAT   a float of 32 bits     HALF    one of 16 bits        YAW    an angle, modulo 360°
    U8 U16  whole, no sign         I8 I16  whole, with a sign    CM     in hundredths, cut
    FLAG    1 above zero, else 0   SIGN    -1 or 1               NONE   not stored
    BIT0    1 for odd, else 0      UNREAD  stored, and not read back
"""

from __future__ import annotations

import math
import struct
from dataclasses import dataclass
from typing import ClassVar, Final, Literal, TypeAlias

from gcs_windplan.mission.firmware.floats import same_float, single

Retention: TypeAlias = Literal["same", "rounded", "lost", "differs"]
"""What became of a number: it came back; all of it that matters did; only as much of it as the firmware stores; or
another came back."""

_YAW: Final = 1e-3  # [deg] of a float of 32 bits in radians


@dataclass(frozen=True, slots=True)
class Storage:
    """Stored as a float of 32 bits; all other ways derive from this one."""

    form: ClassVar[str] = "as a float of 32 bits"

    @property
    def words(self) -> str:
        """How the firmware stores it, after `keeps parameter 1 of NAV_WAYPOINT`."""
        return self.form.format(self)

    def held(self, sent: float) -> float:
        """What comes back of a number; NaN and infinity count as 0 where the field has none."""
        return single(sent)

    def leaves(self, sent: float, held: float) -> bool:
        """Whether `held` is what is left of `sent`, and no other number."""
        return same_float(held, self.held(sent))

    def retention(self, sent: float, held: float) -> Retention:
        """What became of a number, from what was sent and what is held."""
        if same_float(sent, held):
            return "same"
        return "lost" if self.leaves(sent, held) else "differs"

    def rounds(self, sent: float, held: float) -> bool:
        """Whether `held` is `sent` to the firmware's own precision, rather than another number."""
        return False

    def flown(self, sent: float) -> float:
        """The number that the firmware flies by."""
        return sent


@dataclass(frozen=True, slots=True)
class HalfFloat(Storage):
    """A float of 16 bits (ArduPilot's Float16_t)."""

    form: ClassVar[str] = "with 3 digits"

    def held(self, sent: float) -> float:
        """See `Storage`."""
        try:
            return float(struct.unpack("<e", struct.pack("<e", sent))[0])
        except OverflowError:
            return math.copysign(math.inf, sent)

    def leaves(self, sent: float, held: float) -> bool:
        """See `Storage`."""
        return abs(sent - held) <= abs(sent) * 2.0**-10  # NaN compares false

    def rounds(self, sent: float, held: float) -> bool:
        """See `Storage`."""
        return True


@dataclass(frozen=True, slots=True)
class Yaw(Storage):
    """An angle [deg], the same modulo 360°; NaN is none (PX4's wrap_2pi)."""

    form: ClassVar[str] = "modulo 360°"

    def held(self, sent: float) -> float:
        """See `Storage`."""
        return single(sent % 360.0) if math.isfinite(sent) else math.nan

    def retention(self, sent: float, held: float) -> Retention:
        """See `Storage`."""
        if same_float(sent, held):
            return "same"
        if not (math.isfinite(sent) and math.isfinite(held)):
            return "differs"
        return "same" if abs((sent - held + 180) % 360 - 180) < _YAW else "differs"


@dataclass(frozen=True, slots=True)
class Flag(Storage):
    """1 for a number above zero, else 0."""

    form: ClassVar[str] = "as 1 or 0 only"

    def held(self, sent: float) -> float:
        """See `Storage`."""
        return float(sent > 0)

    def flown(self, sent: float) -> float:
        """See `Storage`."""
        return sent if math.isnan(sent) else self.held(sent)


@dataclass(frozen=True, slots=True)
class FlagOrYaw(Flag):
    """1 for a number above zero, else 0, where older firmware gives back the angle itself."""

    def retention(self, sent: float, held: float) -> Retention:
        """See `Storage`."""
        return "same" if YAW.retention(sent, held) == "same" else Flag.retention(self, sent, held)


@dataclass(frozen=True, slots=True)
class LowestBit(Flag):
    """1 for an odd whole number, else 0 (ArduPilot's ENGINE_CONTROL_OPTIONS)."""

    def held(self, sent: float) -> float:
        """See `Storage`."""
        return float(int(sent) & 1) if math.isfinite(sent) else 0.0


@dataclass(frozen=True, slots=True)
class Sign(Storage):
    """-1 or 1; the size goes, and the firmware flies by its own."""

    form: ClassVar[str] = "as its sign only"

    def held(self, sent: float) -> float:
        """See `Storage`."""
        return -1.0 if sent < 0 else 1.0

    def flown(self, sent: float) -> float:
        """See `Storage`: its own size counts, as for 0."""
        return 0.0


@dataclass(frozen=True, slots=True)
class LandingYaw(Sign):
    """The sign of a landing's yaw, of which older ArduPilot stored nothing."""

    def leaves(self, sent: float, held: float) -> bool:
        """See `Storage`."""
        return held == self.held(sent) or (held == 0 and not sent < 0)

    def flown(self, sent: float) -> float:
        """See `Storage`: it turns nothing but a nose."""
        return sent


@dataclass(frozen=True, slots=True)
class NotStored(Storage):
    """Comes back as 0."""

    form: ClassVar[str] = "as 0"

    def held(self, sent: float) -> float:
        """See `Storage`."""
        return 0.0

    def retention(self, sent: float, held: float) -> Retention:
        """See `Storage`."""
        if same_float(sent, held) or (math.isnan(sent) and held == 0):
            return "same"
        return "lost" if held == 0 else "differs"

    def flown(self, sent: float) -> float:
        """See `Storage`."""
        return 0.0


@dataclass(frozen=True, slots=True)
class Unread(NotStored):
    """Stored, and not among what is read back."""

    def flown(self, sent: float) -> float:
        """See `Storage`."""
        return sent


FLOAT, HALF, YAW, FLAG, BIT0 = Storage(), HalfFloat(), Yaw(), Flag(), LowestBit()
SIGN, LANDING_YAW, NONE, UNREAD = Sign(), LandingYaw(), NotStored(), Unread()
FLAG_OR_YAW = FlagOrYaw()
