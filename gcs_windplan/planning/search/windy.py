"""A veil with the wind at its nodes, sampled at as many moments as a search has needed so far."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field
from itertools import pairwise

import numpy as np

from gcs_windplan.arrays import FloatArray
from gcs_windplan.cores import spread
from gcs_windplan.planning.veil import GridVeil, PrmVeil
from gcs_windplan.wind.field import WindField
from gcs_windplan.wind.limited import LimitedWind, with_spare

_OFTEN = 600.0  # [s] how often limits are looked at, if the wind's times lie farther apart
_MOST_MOMENTS = 24  # from a departure to the end of what is searched
_BATCH = 100_000  # nodes whose wind is sampled at a time


@dataclass(eq=False)
class WindyVeil:
    """A veil in one wind, or in those of an ensemble's members.

    `points` (n, 3) [m]. `winds` [m/s] is (n, 3) in steady wind, (times, n, 3) where it changes, with the members before
    that where there are several; no wind where the ground is unknown. `times` [s since departure] are the moments
    sampled so far; None in steady wind.
    """

    veil: GridVeil | PrmVeil
    fields: Sequence[WindField]
    points: FloatArray
    winds: FloatArray
    times: FloatArray | None
    _slices: dict[float, FloatArray] = field(default_factory=dict, repr=False)

    @property
    def ends(self) -> float:
        """The last moment for which wind is known at all [s since departure]."""
        knots = self.fields[0].times
        return float(knots[-1]) if len(knots) > 1 else math.inf

    def cover(self, begin: float, until: float) -> None:
        """Sample more moments if need be, so that the winds reach from `begin` to `until` [s] as far as they are known.

        Raises `WindError` where a field does not cover the veil.
        """
        if self.times is None:
            return
        knots = self._moments(begin, until)
        first = max(int(np.searchsorted(knots, begin, side="right")) - 1, 0)
        last = min(int(np.searchsorted(knots, until, side="left")), len(knots) - 1)
        wanted = knots[first : max(last, min(first + 1, len(knots) - 1)) + 1]
        if np.array_equal(wanted, self.times):
            return
        for knot in wanted:
            if float(knot) not in self._slices:
                self._slices[float(knot)] = np.stack(self._sampled(float(knot)))
        stacked = np.stack([self._slices[float(knot)] for knot in wanted], axis=1)
        self.times, self.winds = wanted, stacked if len(self.fields) > 1 else stacked[0]

    def _moments(self, begin: float, until: float) -> FloatArray:
        """The wind's own times, between which it is linear. With limits others between them, as a limit is not."""
        knots = self.fields[0].times if len(self.fields[0].times) > 1 else np.zeros(1)
        if len(knots) < 2 or not isinstance(self.fields[0], LimitedWind):
            return knots
        step = max(_OFTEN, (until - begin) / _MOST_MOMENTS)
        parts = [np.linspace(a, b, math.ceil((b - a) / step), endpoint=False) for a, b in pairwise(knots)]
        moments = np.append(np.concatenate(parts), knots[-1])
        self._slices = {time: there for time, there in self._slices.items() if time in knots or time in moments}
        return moments

    def at(self, points: FloatArray) -> FloatArray:
        """The wind at a few points (k, 3), shaped as `winds`; closed at the limits themselves, where they have any."""
        fields = [with_spare(one, 0.0) for one in self.fields]
        if self.times is None:
            return fields[0].at(points)
        there = [np.stack([one.at(points, float(time)) for time in self.times]) for one in fields]
        return np.stack(there) if len(self.fields) > 1 else there[0]

    def _sampled(self, seconds: float) -> list[FloatArray]:
        """The winds at all nodes at a moment, one array a field."""
        return [sample(self.points, one, seconds) for one in self.fields]


def blow(veil: GridVeil | PrmVeil, wind: WindField, members: Sequence[WindField] = ()) -> WindyVeil:
    """A veil in a wind, or in those of an ensemble's members; changing ones are sampled when a search asks for them."""
    fields = list(members) if len(members) > 1 else [wind]
    points = veil.points
    if all(len(one.times) < 2 for one in fields) and len(fields) == 1:
        return WindyVeil(veil, fields, points, sample(points, fields[0], 0.0), None)
    return WindyVeil(veil, fields, points, np.empty((0, len(points), 3)), np.empty(0))


def sample(points: FloatArray, wind: WindField, seconds: float) -> FloatArray:
    """The wind (n, 3) at points (n, 3) at a moment; 0 where a height is unknown."""
    winds = np.zeros_like(points)

    def part(begin: int) -> None:
        some = slice(begin, begin + _BATCH)
        known = np.isfinite(points[some, 2])
        winds[some][known] = wind.at(points[some][known], seconds)

    for _ in spread(part, range(0, len(points), _BATCH)):
        pass
    return winds
