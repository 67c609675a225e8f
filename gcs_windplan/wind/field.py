"""The roles of the air: what the rest of the house asks of any wind."""

from __future__ import annotations

from collections.abc import Callable
from typing import Protocol, TypeAlias

from gcs_windplan.arrays import FloatArray

#: The ground's height above mean sea level [m] at local places (n, 2 or more); NaN where unknown.
Ground: TypeAlias = Callable[[FloatArray], FloatArray]


class WindField(Protocol):
    """The velocity of the air over ground, towards where it moves.

    Components are east, north, up [m/s] along the axes of the local frame (grid north, not true north).
    """

    @property
    def name(self) -> str:
        """What the wind is, for people: one line."""

    @property
    def resolution(self) -> float:
        """Samples this far apart resolve the field [m]; infinite where it is uniform."""

    def at(self, points: FloatArray, seconds: float = 0.0) -> FloatArray:
        """The wind (n, 3) [m/s] at points (n, 3): east, north, height above mean sea level [m].

        `seconds` count from the departure. NaN above the heights for which the field is known: no leg goes there.
        Raises `WindError` outside of the field's area or times.
        """
