"""The paper's three wind fields, (14) to (16).

The paper draws them on a plane without units, x and y in [-2, 2]. Here the plane lies about the local origin: `scale`
metres of ground are one unit of the plane, x east and y north, and `speed` [m/s] is the paper's wind of 1.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Literal, TypeAlias, get_args

import numpy as np

from gcs_windplan.arrays import BoolArray, FloatArray
from gcs_windplan.errors import WindError
from gcs_windplan.wind.field import Steady

#: How (14) is read, see `Jet`.
JetReading: TypeAlias = Literal["unit", "magnitude", "literal"]

_SAMPLES_PER_UNIT = 20  # of the paper's plane: the figures there show 4 units, so 80 samples across


@dataclass(frozen=True, slots=True)
class _OnPlane(Steady):
    """A field on the paper's plane."""

    speed: float = 1.0
    scale: float = 1.0

    def __post_init__(self) -> None:
        if not math.isfinite(self.speed):
            raise WindError(f"the field's speed {self.speed} m/s is not finite")
        if not (math.isfinite(self.scale) and self.scale > 0):
            raise WindError(f"the field's scale {self.scale} m is not above 0")

    @property
    def resolution(self) -> float:
        """A twentieth of the plane's unit [m]; no spacing resolves a jet's border or the origin's turn."""
        return self.scale / _SAMPLES_PER_UNIT


@dataclass(frozen=True, slots=True)
class Jet(_OnPlane):
    """The paper's case 1, equation (14): an eastward wind between y = -1 and y = 1.

    As printed, (1 - y²) / sqrt((1 - y²)²) is 1 wherever |y| < 1, while the text speaks of varied magnitude.
    `reading` chooses:

        unit        1 where |y| < 1, still air elsewhere (the printed formula and its domain)
        magnitude   1 - y² where |y| < 1, still air elsewhere (the text)
        literal     the printed formula on the whole plane: 1 inside, -1 outside

    At |y| = 1 the printed formula is 0/0 and the air is still.
    """

    reading: JetReading = "unit"

    def __post_init__(self) -> None:
        _OnPlane.__post_init__(self)
        if self.reading not in get_args(JetReading):
            raise WindError(f"the jet can be read as {', '.join(get_args(JetReading))}, not as {self.reading!r}")

    @property
    def name(self) -> str:
        """What the wind is, for people."""
        return f"jet between ±{self.scale:g} m north, read as {self.reading}, {self.speed:g} m/s (paper, 14)"

    def at(self, points: FloatArray, seconds: float | FloatArray = 0.0) -> FloatArray:
        """The wind (n, 3) [m/s] at points (n, 3)."""
        bulge = 1 - (points[:, 1] / self.scale) ** 2
        if self.reading == "magnitude":
            strength = np.maximum(bulge, 0.0)
        elif self.reading == "unit":
            strength = np.where(bulge > 0, 1.0, 0.0)
        else:
            strength = np.sign(bulge)
        return _field(self.speed * strength, np.zeros(len(points)))


@dataclass(frozen=True, slots=True)
class Diverging(_OnPlane):
    """The paper's case 2, equation (15): the unit vector along (x - 2, x + 1).

    Both components depend on x alone, as printed: left of x = -1 it blows to the south-west, between to the
    north-west, right of x = 2 to the north-east. They never vanish together, so there is no singular point.
    """

    @property
    def name(self) -> str:
        """What the wind is, for people."""
        return f"diverging field, {self.speed:g} m/s, {self.scale:g} m a unit (paper, 15)"

    def at(self, points: FloatArray, seconds: float | FloatArray = 0.0) -> FloatArray:
        """The wind (n, 3) [m/s] at points (n, 3)."""
        x = points[:, 0] / self.scale
        return _unit_field(x - 2, x + 1, self.speed)


@dataclass(frozen=True, slots=True)
class Rotation(_OnPlane):
    """The paper's case 3, equation (16): the unit vector along (-y, x), anticlockwise about the local origin.

    The origin itself is singular; the air is still there.
    """

    @property
    def name(self) -> str:
        """What the wind is, for people."""
        return f"rotation about the origin, {self.speed:g} m/s (paper, 16)"

    def at(self, points: FloatArray, seconds: float | FloatArray = 0.0) -> FloatArray:
        """The wind (n, 3) [m/s] at points (n, 3)."""
        return _unit_field(-points[:, 1], points[:, 0], self.speed)


def _field(east: FloatArray, north: FloatArray) -> FloatArray:
    return np.stack([east, north, np.zeros_like(east)], axis=-1)


def _unit_field(east: FloatArray, north: FloatArray, speed: float) -> FloatArray:
    """Vectors of length |speed| along (east, north); still where both vanish."""
    length = np.hypot(east, north)
    singular: BoolArray = length == 0
    safe = np.where(singular, 1.0, length)  # divided by before the speed comes in: no overflow next to the origin
    return _field(east / safe * speed, north / safe * speed)
