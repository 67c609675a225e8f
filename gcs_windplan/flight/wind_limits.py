"""The strongest wind and gust that a vehicle may be flown in, and how strong they are at a place.

Where air is sampled for a search or along legs, the strength of wind and gust comes along as a fourth component: as a
share of what is allowed. Beyond 1 nothing flies. At both ends of an edge it is 1 at most, so it is in between, as far
as the wind is linear there.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Final

import numpy as np

from gcs_windplan.arrays import FloatArray
from gcs_windplan.wind.each import at_each
from gcs_windplan.wind.field import WindField

SPARE: Final = 0.01  # of a limit, kept free where the wind is known by samples: between two it may be stronger
_ROUNDING: Final = 1e-9  # of a limit: a wind of just as much is allowed


@dataclass(frozen=True, slots=True, eq=False)
class WindLimits:
    """Limits of the level wind and gust [m/s], infinite where there are none.

    `gusts` are the fields of the gusts, some for each wind (each member); of several the mean of their strengths
    counts. The share `spare` of the limits is kept free. In an `exact` wind, uniform and steady, nothing is.
    """

    wind: float = math.inf
    gust: float = math.inf
    gusts: tuple[tuple[WindField, ...], ...] = ()
    spare: float = SPARE
    exact: bool = False

    def __bool__(self) -> bool:
        """Whether there is any limit."""
        return math.isfinite(self.wind) or math.isfinite(self.gust)

    def with_spare(self, spare: float) -> WindLimits:
        """The same limits with another share of them kept free: less for those who look more closely."""
        return replace(self, spare=spare)

    def gusts_of(self, member: int) -> tuple[WindField, ...]:
        """The gusts that count for a member; none where there is no limit of gusts."""
        return self.gusts[member] if self.gusts and math.isfinite(self.gust) else ()

    def resolution_beside(self, wind: WindField, member: int) -> float:
        """Samples so far apart [m] resolve a wind and its gusts."""
        return min(one.resolution for one in (wind, *self.gusts_of(member)))

    def shares(self, member: int, winds: FloatArray, points: FloatArray, seconds: float | FloatArray) -> FloatArray:
        """How strong winds (n, 3) and the member's gusts at points (n, 3) are, as shares of what is allowed (n,)."""
        allowed = (1.0 if self.exact else 1.0 - self.spare) * (1 + _ROUNDING)
        shares: FloatArray = strength_of(winds) / (self.wind * allowed)
        gusts = self.gusts_of(member)
        if gusts:
            shares = np.fmax(shares, mean_strength(gusts, points, seconds) / (self.gust * allowed))
        return shares

    def __str__(self) -> str:
        """The limits in words: `limits.wind, 10 m/s`."""
        limits = {"limits.wind": self.wind, "limits.gust": self.gust}
        return ", or ".join(f"{name}, {limit:g} m/s" for name, limit in limits.items() if math.isfinite(limit))


NO_LIMITS: Final = WindLimits()


def strength_of(winds: FloatArray) -> FloatArray:
    """The level speed (n,) of winds (n, 3) [m/s]."""
    return np.asarray(np.hypot(winds[:, 0], winds[:, 1]))


def mean_strength(fields: Sequence[WindField], points: FloatArray, seconds: float | FloatArray = 0.0) -> FloatArray:
    """The mean level speed (n,) of some fields at points (n, 3) [m/s]."""
    winds = at_each(fields, points, seconds)
    return np.asarray(np.hypot(winds[:, 0::3], winds[:, 1::3]).mean(axis=1))
