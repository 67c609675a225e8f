"""How a firmware stores a number: what comes back of it, and whether that is all that could.

Each way of storing is a value with three questions. A float that travels as MAVLink's 32 bits is cut to the type of
the firmware's own field, which is what the constants are named by:

    FLOAT   a float of 32 bits     HALF    one of 16 bits        YAW    an angle, modulo 360°
    U8 U16  whole, no sign         I8 I16  whole, with a sign    CM     in hundredths, cut
    FLAG    1 above zero, else 0   SIGN    -1 or 1               NONE   not stored
    BIT0    1 for odd, else 0      UNREAD  stored, and not read back

What a whole number's type cannot hold begins again at its other end (measured on ArduCopter 4.7: -1 comes back as
65535; by the C standard it is not defined, and a processor may stop at the end instead).
"""

from __future__ import annotations

import math
import struct
from dataclasses import dataclass
from typing import Final, Literal, TypeAlias

Retention: TypeAlias = Literal["same", "rounded", "lost", "differs"]
"""What became of a number: it came back; all of it that matters did; only as much of it as the firmware stores; or
another came back."""

CENTIMETRE: Final = 0.01  # [m]
_BYTE: Final = 255
_YAW: Final = 1e-3  # [deg] of a float of 32 bits in radians
_TURN: Final = 1 / 256  # ArduPilot's parts of a turn
_TENS: Final = 10.0  # [m] ArduPilot's steps of radii above 255 m


def single(number: float) -> float:
    """The number as a float of 32 bits; one too large for it is infinite."""
    try:
        return float(struct.unpack("<f", struct.pack("<f", number))[0])
    except OverflowError:
        return math.copysign(math.inf, number)


def same_float(one: float, other: float) -> bool:
    """Whether both are the same float of 32 bits, or both NaN."""
    return (math.isnan(one) and math.isnan(other)) or single(one) == single(other)


def float_text(number: float) -> str:
    """The shortest decimal that is the same float of 32 bits."""
    texts = (f"{number:.{digits}g}" for digits in range(6, 10))
    return next((text for text in texts if same_float(float(text), number)), f"{number:.9g}")


def is_cut(sent: float, held: float, step: float) -> bool:
    """Whether a number was cut towards zero to whole steps; the float on the wire may lie just below a step."""
    if not (math.isfinite(sent) and math.isfinite(held)):
        return False
    noise = math.ulp(sent) * 2.0**30  # twice the distance of the floats of 32 bits around it
    in_steps = abs(held - round(held / step) * step) <= noise
    gone = math.copysign(1.0, sent) * (sent - held)
    return in_steps and sent * held >= 0 and -noise <= gone < step + noise


@dataclass(frozen=True, slots=True)
class Storage:
    """Stored as a float of 32 bits; all other ways derive from this one."""

    @property
    def words(self) -> str:
        """How the firmware stores it, after `stores parameter 1 of NAV_WAYPOINT`."""
        return "as a float of 32 bits"

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

    @property
    def words(self) -> str:
        """See `Storage`."""
        return "with 3 digits"

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
class Whole(Storage):
    """A whole number of a type that reaches from `lowest` to `highest`, cut towards zero."""

    lowest: int = 0
    highest: int = 0xFFFF

    @property
    def words(self) -> str:
        """See `Storage`."""
        return f"as a whole number from {self.lowest} to {self.highest}, cut"

    def held(self, sent: float) -> float:
        """See `Storage`."""
        if not math.isfinite(sent):
            return 0.0
        return float((int(sent) - self.lowest) % (self.highest - self.lowest + 1) + self.lowest)

    def leaves(self, sent: float, held: float) -> bool:
        """See `Storage`: one that began again at the other end is another number."""
        return math.isfinite(sent) and held == math.trunc(sent)

    def rounds(self, sent: float, held: float) -> bool:
        """See `Storage`."""
        return abs(sent - held) < 1 and (held == 0 or sent * held > 0)

    def flown(self, sent: float) -> float:
        """See `Storage`."""
        return sent if math.isnan(sent) else self.held(sent)


@dataclass(frozen=True, slots=True)
class Capped(Whole):
    """A whole number of 16 bits of which no more than `most` fits (ArduPlane's halves of an item's p1)."""

    most: int = _BYTE

    @property
    def words(self) -> str:
        """See `Storage`."""
        return f"as a whole number from 0 to {self.most}, cut"

    def held(self, sent: float) -> float:
        """See `Storage`."""
        return min(float(self.most), Whole.held(self, sent))

    def leaves(self, sent: float, held: float) -> bool:
        """See `Storage`."""
        return Whole.leaves(self, sent, held) or held == self.most < sent


@dataclass(frozen=True, slots=True)
class Clamped(Whole):
    """A whole number that is moved to the nearer end of the type's range first."""

    def held(self, sent: float) -> float:
        """See `Storage`."""
        return 0.0 if math.isnan(sent) else float(int(min(max(sent, self.lowest), self.highest)))

    def leaves(self, sent: float, held: float) -> bool:
        """See `Storage`."""
        return same_float(held, self.held(sent))


@dataclass(frozen=True, slots=True)
class Bounded(Whole):
    """A whole number, 0 in place of one outside of a range."""

    @property
    def words(self) -> str:
        """See `Storage`."""
        return f"as a whole number from {self.lowest} to {self.highest}, cut, and 0 for others"

    def held(self, sent: float) -> float:
        """See `Storage`."""
        return float(int(sent)) if self.lowest <= sent <= self.highest else 0.0


@dataclass(frozen=True, slots=True)
class Nearest(Whole):
    """A whole number, rounded (PX4's vertex counts)."""

    @property
    def words(self) -> str:
        """See `Storage`."""
        return f"as a whole number from {self.lowest} to {self.highest}"

    def held(self, sent: float) -> float:
        """See `Storage`."""
        return Whole.held(self, sent + 0.5)

    def leaves(self, sent: float, held: float) -> bool:
        """See `Storage`."""
        return Whole.leaves(self, sent + 0.5, held)


@dataclass(frozen=True, slots=True)
class SignedWhole(Whole):
    """A whole number whose sign is stored apart from its size (ArduPilot's loiter_ccw)."""

    @property
    def words(self) -> str:
        """See `Storage`."""
        return f"as a whole number up to {self.highest}, cut"

    def held(self, sent: float) -> float:
        """See `Storage`."""
        return math.copysign(Whole.held(self, abs(sent)), sent)


@dataclass(frozen=True, slots=True)
class CircleRadius(Whole):
    """ArduPilot's radius of turns: a byte of metres, or of tens of them above 255 m; its sign is the way round."""

    @property
    def words(self) -> str:
        """See `Storage`."""
        return "in whole metres to 255, in tens of metres to 2550"

    def held(self, sent: float) -> float:
        """See `Storage`."""
        size = abs(sent) if math.isfinite(sent) else 0.0
        return math.copysign(float(int(size)) if size <= _BYTE else _TENS * min(_BYTE, int(size * 0.1)), sent)

    def leaves(self, sent: float, held: float) -> bool:
        """See `Storage`."""
        return is_cut(sent, held, 1.0 if abs(sent) <= _BYTE else _TENS)

    def rounds(self, sent: float, held: float) -> bool:
        """See `Storage`."""
        return abs(sent - held) < _TENS and (held == 0 or sent * held > 0)


@dataclass(frozen=True, slots=True)
class Turns(Whole):
    """ArduPilot's turns: whole ones up to 255, fewer than one in parts of 256."""

    @property
    def words(self) -> str:
        """See `Storage`."""
        return "as whole turns from 1 to 255, cut"

    def held(self, sent: float) -> float:
        """See `Storage`."""
        if 0 < sent < 1:
            return int(sent / _TURN) * _TURN
        return Whole.held(self, min(sent, self.highest))

    def leaves(self, sent: float, held: float) -> bool:
        """See `Storage`."""
        return Whole.leaves(self, sent, held) or abs(sent - held) <= _TURN


@dataclass(frozen=True, slots=True)
class Hundredths(Whole):
    """A whole number of hundredths, cut."""

    @property
    def words(self) -> str:
        """See `Storage`."""
        return "in hundredths, cut"

    def held(self, sent: float) -> float:
        """See `Storage`; the product is one of floats of 32 bits."""
        return single(Whole.held(self, single(single(sent) * 100)) / 100)

    def leaves(self, sent: float, held: float) -> bool:
        """See `Storage`."""
        return is_cut(sent, held, CENTIMETRE)

    def rounds(self, sent: float, held: float) -> bool:
        """See `Storage`."""
        return abs(sent - held) < CENTIMETRE and (held == 0 or sent * held > 0)


@dataclass(frozen=True, slots=True)
class Altitude(Hundredths):
    """A height in whole centimetres: what is cut matters to nobody."""

    def retention(self, sent: float, held: float) -> Retention:
        """See `Storage`."""
        found = Hundredths.retention(self, sent, held)
        return "rounded" if found == "lost" else found


@dataclass(frozen=True, slots=True)
class Yaw(Storage):
    """An angle [deg], the same modulo 360°; NaN is none (PX4's wrap_2pi)."""

    @property
    def words(self) -> str:
        """See `Storage`."""
        return "modulo 360°"

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

    @property
    def words(self) -> str:
        """See `Storage`."""
        return "as 1 or 0 only"

    def held(self, sent: float) -> float:
        """See `Storage`."""
        return float(sent > 0)

    def flown(self, sent: float) -> float:
        """See `Storage`."""
        return sent if math.isnan(sent) else self.held(sent)


@dataclass(frozen=True, slots=True)
class LowestBit(Flag):
    """1 for an odd whole number, else 0 (ArduPilot's ENGINE_CONTROL_OPTIONS)."""

    def held(self, sent: float) -> float:
        """See `Storage`."""
        return float(int(sent) & 1) if math.isfinite(sent) else 0.0


@dataclass(frozen=True, slots=True)
class Sign(Storage):
    """-1 or 1; the size goes, and the firmware flies by its own."""

    @property
    def words(self) -> str:
        """See `Storage`."""
        return "as its sign only"

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

    @property
    def words(self) -> str:
        """See `Storage`."""
        return "as 0"

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


FLOAT, HALF, YAW = Storage(), HalfFloat(), Yaw()
U8, U16, I8, I16 = Whole(0, 0xFF), Whole(0, 0xFFFF), Whole(-0x80, 0x7F), Whole(-0x8000, 0x7FFF)
I32 = Whole(-0x8000_0000, 0x7FFF_FFFF)
CM = Hundredths(0, 0xFFFF)
ALTITUDE = Altitude(-0x8000_0000, 0x7FFF_FFFF)
FLAG, BIT0, SIGN, LANDING_YAW, NONE, UNREAD = Flag(), LowestBit(), Sign(), LandingYaw(), NotStored(), Unread()
