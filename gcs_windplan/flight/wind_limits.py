"""The strongest wind and gust that a vehicle may be flown in, and how strong they are at a place.

Where air is sampled for a search or along legs, the strength of wind and gust comes along as a fourth component: as a
share of what is allowed. Beyond 1 nothing flies. At both ends of an edge it is 1 at most, so it is in between, as far
as the wind is linear there.
"""

from __future__ import annotations

import math
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
        gusts = self.gusts_of(member)
        return self._shares(winds, at_each(gusts, points, seconds) if gusts else None)

    def shares_of_each(self, winds: FloatArray, points: FloatArray, seconds: float | FloatArray) -> FloatArray:
        """The same for the winds (n, 3 m) of m members, (n, m); their gusts are worked out together."""
        members = winds.shape[1] // 3
        fields = [self.gusts_of(member) for member in range(members)]
        together = [one for some in fields for one in some]
        if not together:
            return np.column_stack([self._shares(winds[:, 3 * k : 3 * k + 3], None) for k in range(members)])
        ends = np.cumsum([3 * len(some) for some in fields])
        parts = np.split(at_each(together, points, seconds), ends[:-1], axis=1)
        return np.column_stack(
            [self._shares(winds[:, 3 * k : 3 * k + 3], parts[k] if fields[k] else None) for k in range(members)]
        )

    def _shares(self, winds: FloatArray, gusts: FloatArray | None) -> FloatArray:
        """The shares (n,) of winds (n, 3) and of gusts (n, 3 k) from k fields."""
        allowed = (1.0 if self.exact else 1.0 - self.spare) * (1 + _ROUNDING)
        shares: FloatArray = mean_strength(winds) / (self.wind * allowed)
        return shares if gusts is None else np.fmax(shares, mean_strength(gusts) / (self.gust * allowed))

    def __str__(self) -> str:
        """The limits in words: `limits.wind, 10 m/s`."""
        limits = {"limits.wind": self.wind, "limits.gust": self.gust}
        return ", or ".join(f"{name}, {limit:g} m/s" for name, limit in limits.items() if math.isfinite(limit))


NO_LIMITS: Final = WindLimits()


def mean_strength(winds: FloatArray) -> FloatArray:
    """The mean level speed (n,) of the winds (n, 3 k) of k fields [m/s]."""
    strengths = np.hypot(winds[:, 0::3], winds[:, 1::3])
    return strengths[:, 0] if strengths.shape[1] == 1 else np.asarray(strengths.mean(axis=1))
