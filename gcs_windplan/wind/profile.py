"""How the wind grows with height above the ground, where a field does not know it."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Protocol

import numpy as np

from gcs_windplan.arrays import FloatArray
from gcs_windplan.errors import WindError
from gcs_windplan.wind.field import Ground, WindField


class ProfileLaw(Protocol):
    """The wind at a height above the ground as a share of the wind at the reference height."""

    @property
    def name(self) -> str:
        """The law and its numbers, for people."""

    def factor(self, heights: FloatArray) -> FloatArray:
        """Shares (n,) ≥ 0 at heights above the ground (n,) [m], which may be 0 or negative."""


@dataclass(frozen=True, slots=True)
class PowerLaw:
    """(z / zr) ** exponent: 1 at the reference height zr [m], 0 at and below the ground.

    IEC 61400-1 (2005) takes 0.2 for normal wind (6.3.1.2) and 0.11 for extremes (6.3.2.1); IEC 61400-3 takes
    0.14 over the sea, and 1/7 is the usual value over short grass in neutral air.
    """

    reference: float = 10.0
    exponent: float = 0.14

    def __post_init__(self) -> None:
        if not (math.isfinite(self.reference) and self.reference > 0):
            raise WindError(f"the profile's reference height {self.reference} m is not above 0")
        if not 0 <= self.exponent <= 1:
            raise WindError(f"the power law's exponent {self.exponent} is not between 0 and 1")

    @property
    def name(self) -> str:
        """The law and its numbers, for people."""
        return f"power law {self.exponent:g} from {self.reference:g} m"

    def factor(self, heights: FloatArray) -> FloatArray:
        """Shares (n,) at heights above the ground (n,) [m]; 0 at and below the ground."""
        shares: FloatArray = (np.maximum(heights, 0.0) / self.reference) ** self.exponent
        return np.where(heights > 0, shares, 0.0)


@dataclass(frozen=True, slots=True)
class LogLaw:
    """ln(z / z0) / ln(zr / z0): 1 at the reference height zr [m], 0 at and below the roughness length z0 [m].

    Neutral air (Stull 1988, An Introduction to Boundary Layer Meteorology, chapter 9). z0 is about 0.03 m
    over grass, 0.1 m over farmland, 1 m over forest and towns (his figure 9.6).
    """

    reference: float = 10.0
    roughness: float = 0.03

    def __post_init__(self) -> None:
        if not 0 < self.roughness < self.reference < math.inf:
            raise WindError(
                f"the log law needs 0 < roughness length < reference height, not {self.roughness} m "
                f"and {self.reference} m"
            )

    @property
    def name(self) -> str:
        """The law and its numbers, for people."""
        return f"log law, z0 {self.roughness:g} m, from {self.reference:g} m"

    def factor(self, heights: FloatArray) -> FloatArray:
        """Shares (n,) at heights above the ground (n,) [m]."""
        above = np.maximum(heights, self.roughness)
        shares: FloatArray = np.log(above / self.roughness) / math.log(self.reference / self.roughness)
        return shares


@dataclass(frozen=True, slots=True)
class ProfileWind:
    """A field multiplied by a profile law at each point's height above the ground.

    `field` is the wind at the law's reference height. `ground_resolution` [m] is the ground's own, where
    known, for the wind now follows the ground. At and below the ground the laws give still air. Raises
    `WindError` over ground of unknown height.
    """

    field: WindField
    ground: Ground
    law: ProfileLaw
    ground_resolution: float = math.inf

    def __post_init__(self) -> None:
        if not self.ground_resolution > 0:
            raise WindError(f"the ground's resolution {self.ground_resolution} m is not above 0")

    @property
    def name(self) -> str:
        """What the wind is, for people."""
        return f"{self.field.name}, {self.law.name} above ground"

    @property
    def resolution(self) -> float:
        """The finer one of the field's and the ground's [m]."""
        return min(self.field.resolution, self.ground_resolution)

    @property
    def times(self) -> FloatArray:
        """The field's own."""
        return self.field.times

    def at(self, points: FloatArray, seconds: float | FloatArray = 0.0) -> FloatArray:
        """The wind (n, 3) [m/s] at points (n, 3)."""
        factor = self.law.factor(heights_above(self.ground, points))
        return self.field.at(points, seconds) * factor[:, np.newaxis]


def heights_above(ground: Ground, points: FloatArray) -> FloatArray:
    """Heights of points (n, 3) above the ground (n,) [m]. Raises `WindError` where the ground is unknown."""
    heights: FloatArray = points[:, 2] - ground(points)
    unknown = np.flatnonzero(np.isnan(heights))
    if len(unknown):
        east, north, up = points[unknown[0]]
        raise WindError(
            f"the height above ground of {len(unknown)} of {len(points)} points is unknown, and with it the "
            f"wind; the first lies {east:.0f} m east and {north:.0f} m north of the origin at {up:.0f} m: "
            "the terrain has to cover the route"
        )
    return heights
