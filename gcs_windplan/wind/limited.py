"""Wind with a limit: where it, or its gusts, are stronger, the air is closed."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from dataclasses import field as worked_out
from typing import Final

import numpy as np

from gcs_windplan.arrays import BoolArray, FloatArray
from gcs_windplan.wind.each import at_each
from gcs_windplan.wind.field import WindField

_ROUNDING: Final = 1e-9  # of a limit: a wind of just as much is allowed
SPARE: Final = 0.01  # of a limit, kept free where the wind is known by samples: between two it may be stronger


@dataclass(frozen=True, slots=True, eq=False)
class LimitedWind:
    """A wind that is NaN, as where it is not known, wherever it or its gusts are stronger than a limit.

    `limit` and `gust_limit` are level speeds [m/s]. Of several fields of `gusts` the mean of their strengths counts.
    Unless the wind is uniform and steady, the air closes at the share `spare` below the limits: a route is judged by
    samples, and between two of them the limit itself must hold. It closes at the `share` of them that is left; samples
    as far apart as the `resolution` [m] resolve wind and gusts.
    """

    field: WindField
    limit: float = math.inf
    gusts: tuple[WindField, ...] = ()
    gust_limit: float = math.inf
    spare: float = SPARE
    resolution: float = worked_out(init=False)
    share: float = worked_out(init=False)

    def __post_init__(self) -> None:
        resolution = min(one.resolution for one in (self.field, *self.gusts))
        uniform = math.isinf(resolution) and len(self.field.times) < 2
        object.__setattr__(self, "resolution", resolution)
        object.__setattr__(self, "share", 1.0 if uniform else 1.0 - self.spare)

    @property
    def name(self) -> str:
        """The wind's own."""
        return self.field.name

    @property
    def times(self) -> FloatArray:
        """The wind's own."""
        return self.field.times

    def at(self, points: FloatArray, seconds: float | FloatArray = 0.0) -> FloatArray:
        """The wind (n, 3) [m/s] at points (n, 3), `seconds` (one, or (n,)) after departure; NaN where it is closed."""
        winds = self.field.at(points, seconds)
        gusts = at_each(self.gusts, points, seconds) if self.gusts else None
        return self.closing(winds, gusts)

    @classmethod
    def at_members(cls, members: Sequence[LimitedWind], points: FloatArray, seconds: float | FloatArray) -> FloatArray:
        """The winds (n, 3 m) of members: fields and gusts are worked out together, then closed one by one."""
        fields = at_each([member.field for member in members], points, seconds)
        counts = [3 * len(member.gusts) for member in members]
        gusts = [gust for member in members for gust in member.gusts]
        gust_winds = at_each(gusts, points, seconds) if gusts else np.empty((len(points), 0))
        parts = np.split(gust_winds, np.cumsum(counts)[:-1], axis=1)
        closed = [
            member.closing(fields[:, 3 * k : 3 * k + 3], parts[k] if counts[k] else None)
            for k, member in enumerate(members)
        ]
        return np.concatenate(closed, axis=1)

    def closing(self, winds: FloatArray, gusts: FloatArray | None) -> FloatArray:
        """The winds (n, 3), NaN where they or the gusts (n, 3 k) of k fields are too strong."""
        closed = _strength(winds) > self.limit * self.share * (1 + _ROUNDING)
        if gusts is not None:
            closed |= _mean_strength(gusts) > self.gust_limit * self.share * (1 + _ROUNDING)
        if not closed.any():
            return winds
        open_winds = winds.copy()
        open_winds[closed] = np.nan
        return open_winds

    def closed(self, points: FloatArray, seconds: float | FloatArray = 0.0) -> BoolArray:
        """Where (n,) the limits close the air; where the wind is not known at all they do not."""
        closed: BoolArray = np.isnan(self.at(points, seconds)[:, 0]) & ~np.isnan(self.field.at(points, seconds)[:, 0])
        return closed

    def strengths(self, points: FloatArray, seconds: float | FloatArray = 0.0) -> tuple[FloatArray, FloatArray]:
        """The strength of the wind and of its gusts (n,) each [m/s]; NaN where it is not known, or there are none."""
        winds = _strength(self.field.at(points, seconds))
        if not self.gusts:
            return winds, np.full(len(points), np.nan)
        return winds, _mean_strength(at_each(self.gusts, points, seconds))

    def __str__(self) -> str:
        """The limits in words: `limits.wind, 10 m/s`."""
        limits = {"limits.wind": self.limit, "limits.gust": self.gust_limit}
        return ", or ".join(f"{name}, {limit:g} m/s" for name, limit in limits.items() if math.isfinite(limit))


def unlimited(wind: WindField) -> WindField:
    """The wind without limits."""
    return wind.field if isinstance(wind, LimitedWind) else wind


def with_spare(wind: WindField, spare: float) -> WindField:
    """The wind, closed at another share below its limits, if it has any: less for those who look more closely."""
    return replace(wind, spare=spare) if isinstance(wind, LimitedWind) else wind


def _strength(winds: FloatArray) -> FloatArray:
    """The level speed (n,) of winds (n, 3) [m/s]."""
    return np.asarray(np.hypot(winds[:, 0], winds[:, 1]))


def _mean_strength(winds: FloatArray) -> FloatArray:
    """The mean level speed (n,) of the winds (n, 3 k) of k fields [m/s]."""
    return np.asarray(np.hypot(winds[:, 0::3], winds[:, 1::3]).mean(axis=1))
