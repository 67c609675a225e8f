"""Whole numbers as a firmware stores them: of a type's range, cut, and in fixed steps.

What a whole number's type cannot hold begins again at its other end (measured on ArduCopter 4.7: -1 comes back as
65535; by the C standard it is not defined, and a processor may stop at the end instead).
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import ClassVar, Final

from gcs_windplan.mission.firmware.floats import is_cut, same_float, single
from gcs_windplan.mission.firmware.storage import Retention, Storage

CENTIMETRE: Final = 0.01  # [m]
_BYTE: Final = 255
_TURN: Final = 1 / 256  # ArduPilot's parts of a turn
_TENS: Final = 10.0  # [m] ArduPilot's steps of radii above 255 m


@dataclass(frozen=True, slots=True)
class WholeNumber(Storage):
    """A whole number of a type that reaches from `lowest` to `highest`, cut towards zero."""

    lowest: int = 0
    highest: int = 0xFFFF

    form: ClassVar[str] = "as a whole number from {0.lowest} to {0.highest}, cut"

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
class Capped(WholeNumber):
    """A whole number of 16 bits of which no more than `most` fits (ArduPlane's halves of an item's p1)."""

    most: int = _BYTE

    form: ClassVar[str] = "as a whole number from 0 to {0.most}, cut"

    def held(self, sent: float) -> float:
        """See `Storage`."""
        return min(float(self.most), WholeNumber.held(self, sent))

    def leaves(self, sent: float, held: float) -> bool:
        """See `Storage`."""
        return WholeNumber.leaves(self, sent, held) or held == self.most < sent


@dataclass(frozen=True, slots=True)
class Clamped(WholeNumber):
    """A whole number that is moved to the nearer end of the type's range first."""

    def held(self, sent: float) -> float:
        """See `Storage`."""
        return 0.0 if math.isnan(sent) else float(int(min(max(sent, self.lowest), self.highest)))

    def leaves(self, sent: float, held: float) -> bool:
        """See `Storage`."""
        return same_float(held, self.held(sent))


@dataclass(frozen=True, slots=True)
class Bounded(WholeNumber):
    """A whole number, 0 in place of one outside of a range."""

    form: ClassVar[str] = "as a whole number from {0.lowest} to {0.highest}, cut, and 0 for others"

    def held(self, sent: float) -> float:
        """See `Storage`."""
        return float(int(sent)) if self.lowest <= sent <= self.highest else 0.0


@dataclass(frozen=True, slots=True)
class Nearest(WholeNumber):
    """A whole number, rounded (PX4's vertex counts)."""

    form: ClassVar[str] = "as a whole number from {0.lowest} to {0.highest}"

    def held(self, sent: float) -> float:
        """See `Storage`."""
        return WholeNumber.held(self, sent + 0.5)

    def leaves(self, sent: float, held: float) -> bool:
        """See `Storage`."""
        return WholeNumber.leaves(self, sent + 0.5, held)


@dataclass(frozen=True, slots=True)
class SignedWhole(WholeNumber):
    """A whole number whose sign is stored apart from its size (ArduPilot's loiter_ccw)."""

    form: ClassVar[str] = "as a whole number up to {0.highest}, cut"

    def held(self, sent: float) -> float:
        """See `Storage`."""
        return math.copysign(WholeNumber.held(self, abs(sent)), sent)


@dataclass(frozen=True, slots=True)
class CircleRadius(WholeNumber):
    """ArduPilot's radius of turns: a byte of metres, or of tens of them above 255 m; its sign is the way round."""

    form: ClassVar[str] = "in whole metres to 255, in tens of metres to 2550"

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
class Turns(WholeNumber):
    """ArduPilot's turns: whole ones up to 255, fewer than one in parts of 256."""

    form: ClassVar[str] = "as whole turns from 1 to 255, cut"

    def held(self, sent: float) -> float:
        """See `Storage`."""
        if 0 < sent < 1:
            return int(sent / _TURN) * _TURN
        return WholeNumber.held(self, min(sent, self.highest))

    def leaves(self, sent: float, held: float) -> bool:
        """See `Storage`."""
        return WholeNumber.leaves(self, sent, held) or abs(sent - held) <= _TURN


@dataclass(frozen=True, slots=True)
class Hundredths(WholeNumber):
    """A whole number of hundredths, cut."""

    form: ClassVar[str] = "in hundredths, cut"

    def held(self, sent: float) -> float:
        """See `Storage`; the product is one of floats of 32 bits."""
        return single(WholeNumber.held(self, single(single(sent) * 100)) / 100)

    def leaves(self, sent: float, held: float) -> bool:
        """See `Storage`."""
        return is_cut(sent, held, CENTIMETRE)

    def rounds(self, sent: float, held: float) -> bool:
        """See `Storage`."""
        return abs(sent - held) < CENTIMETRE and (held == 0 or sent * held > 0)


@dataclass(frozen=True, slots=True)
class CutAltitude(Hundredths):
    """A height in whole centimetres: what is cut matters to nobody."""

    def retention(self, sent: float, held: float) -> Retention:
        """See `Storage`."""
        found = Hundredths.retention(self, sent, held)
        return "rounded" if found == "lost" else found


U8, U16 = WholeNumber(0, 0xFF), WholeNumber(0, 0xFFFF)
I8, I16, I32 = WholeNumber(-0x80, 0x7F), WholeNumber(-0x8000, 0x7FFF), WholeNumber(-0x8000_0000, 0x7FFF_FFFF)
CM = Hundredths(0, 0xFFFF)
ALTITUDE = CutAltitude(-0x8000_0000, 0x7FFF_FFFF)
