"""The roles of the air: what the rest of the house asks of any wind."""

from __future__ import annotations

from collections.abc import Callable
from typing import Final, Protocol, TypeAlias

import numpy as np

from gcs_windplan.arrays import FloatArray

#: The ground's height above mean sea level [m] at local places (n, 2 or more); NaN where unknown.
Ground: TypeAlias = Callable[[FloatArray], FloatArray]


#: The times of a wind that does not change.
STEADY: Final[FloatArray] = np.empty(0)


class Steady:
    """What a wind that does not change says of its times."""

    __slots__ = ()

    @property
    def times(self) -> FloatArray:
        """None: it is steady."""
        return STEADY


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

    @property
    def times(self) -> FloatArray:
        """The moments (n,) [s since departure], ascending, between which the wind is linear in time; empty: steady."""

    def at(self, points: FloatArray, seconds: float | FloatArray = 0.0) -> FloatArray:
        """The wind (n, 3) [m/s] at points (n, 3): east, north, height above mean sea level [m].

        `seconds`, one or one a point (n,), count from the departure. NaN above the heights for which the field is
        known: no leg goes there. Raises `WindError` outside of the field's area or times.
        """
