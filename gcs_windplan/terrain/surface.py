"""The roles of the ground: what the rest of the house asks of any terrain."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

from gcs_windplan.arrays import FloatArray


@dataclass(frozen=True, slots=True)
class Extent:
    """A box in the local frame [m]."""

    west: float
    south: float
    east: float
    north: float

    def misses(self, x: float, y: float) -> float:
        """How far a place lies outside of the box [m], 0 inside."""
        dx = max(self.west - x, 0.0, x - self.east)
        dy = max(self.south - y, 0.0, y - self.north)
        return float((dx * dx + dy * dy) ** 0.5)


class Terrain(Protocol):
    """The ground's surface, heights [m] above mean sea level in `vertical_datum`."""

    @property
    def name(self) -> str:
        """Where the heights come from, for people."""

    @property
    def vertical_datum(self) -> str:
        """The datum of the heights, for people: `EGM96`, `NAVD88`, `local`."""

    @property
    def resolution(self) -> float:
        """The size of a cell or a typical triangle [m]."""

    @property
    def extent(self) -> Extent:
        """A box in the local frame inside which heights may be known."""

    def heights_at(self, places: FloatArray) -> FloatArray:
        """The ground's height at local places (n, 2 or more) [m], shape (n,); NaN where unknown."""

    def leg_heights(self, starts: FloatArray, ends: FloatArray) -> FloatArray:
        """The smallest and the largest height of straight legs over the ground, exact, shape (n, 2) [m].

        `starts` and `ends` are (n, 3): east, north, height above mean sea level. NaN where any part of the
        leg lies over unknown ground. Negative where the leg runs below the ground.
        """
