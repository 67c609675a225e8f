"""Winds given by a formula: calm, and one constant wind."""

from __future__ import annotations

import math
from dataclasses import dataclass, field

import numpy as np

from gcs_windplan.arrays import FloatArray
from gcs_windplan.errors import WindError
from gcs_windplan.geo.frame import LocalFrame
from gcs_windplan.geo.inverse import InverseProjection, to_grid_north
from gcs_windplan.wind.field import Steady


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
