"""Winds given by a formula: calm, one constant wind, and the paper's three fields.

The paper draws its fields on a plane without units, x and y in [-2, 2]. Here the plane lies about the local
origin: `scale` metres of ground are one unit of the plane, x east and y north, and `speed` [m/s] is the
paper's wind of 1.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import Literal, TypeAlias, get_args

import numpy as np

from gcs_windplan.arrays import BoolArray, FloatArray
from gcs_windplan.errors import WindError
from gcs_windplan.geo.frame import LocalFrame
from gcs_windplan.geo.inverse import InverseProjection, to_grid_north
from gcs_windplan.wind.field import Steady

#: How (14) is read, see `Jet`.
JetReading: TypeAlias = Literal["unit", "magnitude", "literal"]

_SAMPLES_PER_UNIT = 20  # of the paper's plane: the figures there show 4 units, so 80 samples across


@dataclass(frozen=True, slots=True)
class Calm(Steady):
    """Still air everywhere."""

    @property
    def name(self) -> str:
        """What the wind is, for people."""
        return "calm"

    @property
    def resolution(self) -> float:
        """Infinite: it is uniform [m]."""
        return math.inf

    def at(self, points: FloatArray, seconds: float | FloatArray = 0.0) -> FloatArray:
        """Zeros (n, 3) [m/s] at points (n, 3)."""
        return np.zeros((len(points), 3))


@dataclass(frozen=True, slots=True)
class ConstantWind(Steady):
    """The same wind everywhere and always: `east` and `north` [m/s], towards where the air moves.

    Without `frame` these lie along the local axes. With it they are true east and north, and are turned at
    every point by the frame's convergence, as a wind told by direction is the same *true* direction
    everywhere.
    """

    east: float
    north: float
    frame: LocalFrame | None = None
    _inverse: InverseProjection | None = field(init=False, repr=False, compare=False)

    def __post_init__(self) -> None:
        if not (math.isfinite(self.east) and math.isfinite(self.north)):
            raise WindError(f"a constant wind of ({self.east}, {self.north}) m/s is not finite")
        object.__setattr__(self, "_inverse", InverseProjection(self.frame) if self.frame and self.speed > 0 else None)

    @classmethod
    def from_direction(cls, speed: float, from_deg: float, frame: LocalFrame | None = None) -> ConstantWind:
        """A wind of `speed` [m/s] that blows FROM `from_deg` [deg], clockwise from true north.

        Raises `WindError` if the speed is negative.
        """
        if speed < 0:
            raise WindError(f"the wind speed {speed} m/s is negative: turn the direction instead")
        angle = math.radians(from_deg)
        return cls(-speed * math.sin(angle), -speed * math.cos(angle), frame)

    @property
    def speed(self) -> float:
        """How fast the air moves [m/s]."""
        return math.hypot(self.east, self.north)

    @property
    def from_deg(self) -> float:
        """The direction that it blows from [deg], in [0, 360)."""
        return math.degrees(math.atan2(-self.east, -self.north)) % 360.0

    @property
    def name(self) -> str:
        """What the wind is, for people."""
        return f"constant wind, {self.speed:.1f} m/s from {round(self.from_deg) % 360:03d}°"

    @property
    def resolution(self) -> float:
        """Infinite: it is uniform [m]; the convergence turns it by a degree in tens of kilometres."""
        return math.inf

    def at(self, points: FloatArray, seconds: float | FloatArray = 0.0) -> FloatArray:
        """The wind (n, 3) [m/s] at points (n, 3); the upward component is 0."""
        wind = np.tile([self.east, self.north, 0.0], (len(points), 1))
        return wind if self._inverse is None else to_grid_north(wind, self._inverse.at(points)[:, 2])


@dataclass(frozen=True, slots=True)
class Jet(Steady):
    """The paper's case 1, equation (14): an eastward wind between y = -1 and y = 1.

    As printed, (1 - y²) / sqrt((1 - y²)²) is 1 wherever |y| < 1, while the text speaks of varied magnitude.
    `reading` chooses:

        unit        1 where |y| < 1, still air elsewhere (the printed formula and its domain)
        magnitude   1 - y² where |y| < 1, still air elsewhere (the text)
        literal     the printed formula on the whole plane: 1 inside, -1 outside

    At |y| = 1 the printed formula is 0/0 and the air is still.
    """

    speed: float = 1.0
    scale: float = 1.0
    reading: JetReading = "unit"

    def __post_init__(self) -> None:
        _check(self.speed, self.scale)
        if self.reading not in get_args(JetReading):
            raise WindError(f"the jet can be read as {', '.join(get_args(JetReading))}, not as {self.reading!r}")

    @property
    def name(self) -> str:
        """What the wind is, for people."""
        return f"jet between ±{self.scale:g} m north, read as {self.reading}, {self.speed:g} m/s (paper, 14)"

    @property
    def resolution(self) -> float:
        """A twentieth of the plane's unit [m]; no spacing resolves the jump at the jet's border."""
        return self.scale / _SAMPLES_PER_UNIT

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
class Diverging(Steady):
    """The paper's case 2, equation (15): the unit vector along (x - 2, x + 1).

    Both components depend on x alone, as printed: left of x = -1 it blows to the south-west, between to the
    north-west, right of x = 2 to the north-east. They never vanish together, so there is no singular point.
    """

    speed: float = 1.0
    scale: float = 1.0

    def __post_init__(self) -> None:
        _check(self.speed, self.scale)

    @property
    def name(self) -> str:
        """What the wind is, for people."""
        return f"diverging field, {self.speed:g} m/s, {self.scale:g} m a unit (paper, 15)"

    @property
    def resolution(self) -> float:
        """A twentieth of the plane's unit [m]."""
        return self.scale / _SAMPLES_PER_UNIT

    def at(self, points: FloatArray, seconds: float | FloatArray = 0.0) -> FloatArray:
        """The wind (n, 3) [m/s] at points (n, 3)."""
        x = points[:, 0] / self.scale
        return _unit_field(x - 2, x + 1, self.speed)


@dataclass(frozen=True, slots=True)
class Rotation(Steady):
    """The paper's case 3, equation (16): the unit vector along (-y, x), anticlockwise about the local origin.

    The origin itself is singular; the air is still there.
    """

    speed: float = 1.0
    scale: float = 1.0

    def __post_init__(self) -> None:
        _check(self.speed, self.scale)

    @property
    def name(self) -> str:
        """What the wind is, for people."""
        return f"rotation about the origin, {self.speed:g} m/s (paper, 16)"

    @property
    def resolution(self) -> float:
        """A twentieth of the plane's unit [m]; no spacing resolves the turn at the origin."""
        return self.scale / _SAMPLES_PER_UNIT

    def at(self, points: FloatArray, seconds: float | FloatArray = 0.0) -> FloatArray:
        """The wind (n, 3) [m/s] at points (n, 3)."""
        return _unit_field(-points[:, 1], points[:, 0], self.speed)


def _check(speed: float, scale: float) -> None:
    if not math.isfinite(speed):
        raise WindError(f"the field's speed {speed} m/s is not finite")
    if not (math.isfinite(scale) and scale > 0):
        raise WindError(f"the field's scale {scale} m is not above 0")


def _field(east: FloatArray, north: FloatArray) -> FloatArray:
    return np.stack([east, north, np.zeros_like(east)], axis=-1)


def _unit_field(east: FloatArray, north: FloatArray, speed: float) -> FloatArray:
    """Vectors of length |speed| along (east, north); still where both vanish."""
    length = np.hypot(east, north)
    singular: BoolArray = length == 0
    safe = np.where(singular, 1.0, length)  # divided by before the speed comes in: no overflow next to the origin
    return _field(east / safe * speed, north / safe * speed)
