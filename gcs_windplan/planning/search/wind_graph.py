"""A veil with the wind at its nodes, sampled at as many moments as the searches have needed so far."""

from __future__ import annotations

import math
import threading
from collections.abc import Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from gcs_windplan.arrays import FloatArray, IntArray
from gcs_windplan.cores import spread
from gcs_windplan.flight.wind_limits import NO_LIMITS, WindLimits
from gcs_windplan.planning.veil import GridVeil, PrmVeil
from gcs_windplan.wind.field import WindField

_BATCH = 100_000  # nodes whose wind is sampled at a time


@dataclass(frozen=True, slots=True, eq=False)
class NodeWinds:
    """The wind at a graph's nodes over a stretch of time; nobody changes its arrays.

    `winds` [m/s] is (n, 3) in steady wind, (times, n, 3) where it changes, with the members before that where there are
    several; no wind where the ground is unknown. Where there are limits, a fourth component is the share of them.
    `times` [s since departure] are the moments; None in steady wind.
    """

    winds: FloatArray
    times: FloatArray | None


class _Samples:
    """The winds at all nodes at the moments sampled so far: each moment is sampled once, whichever thread asks first.

    Snapshots are handed out, and never changed afterwards.
    """

    __slots__ = ("_latest", "_lock", "_slices")

    def __init__(self) -> None:
        self._lock = threading.Lock()
        self._slices: dict[float, FloatArray] = {}
        self._latest: NodeWinds | None = None

    def __getstate__(self) -> tuple[dict[float, FloatArray], NodeWinds | None]:
        with self._lock:
            return dict(self._slices), self._latest

    def __setstate__(self, state: tuple[dict[float, FloatArray], NodeWinds | None]) -> None:
        self._lock = threading.Lock()
        self._slices, self._latest = state

    @property
    def moments(self) -> tuple[float, ...]:
        """What has been sampled [s since departure]."""
        with self._lock:
            return tuple(sorted(self._slices))

    def at(self, moments: FloatArray, graph: WindGraph) -> NodeWinds:
        """The graph's winds at some moments."""
        with self._lock:
            latest = self._latest
            if latest is not None and latest.times is not None and np.array_equal(latest.times, moments):
                return latest
            for moment in moments.tolist():
                if moment not in self._slices:
                    self._slices[moment] = np.stack([_sampled(graph, k, moment) for k in range(len(graph.fields))])
            stacked = np.stack([self._slices[moment] for moment in moments.tolist()], axis=1)
            self._latest = NodeWinds(stacked if len(graph.fields) > 1 else stacked[0], moments)
            return self._latest


@dataclass(frozen=True, slots=True, eq=False)
class WindGraph:
    """A veil in one wind, or in those of an ensemble's members. Threads may share it.

    `points` (n, 3) [m] are the veil's nodes, `steady` their winds where they do not change. Sites join no
    `closed` nodes.
    """

    veil: GridVeil | PrmVeil
    fields: tuple[WindField, ...]
    points: FloatArray
    steady: NodeWinds | None = None
    limits: WindLimits = NO_LIMITS
    closed: IntArray = field(default_factory=lambda: np.empty(0, dtype=np.int64))
    _samples: _Samples = field(default_factory=_Samples, repr=False)

    @property
    def ends(self) -> float:
        """The last moment for which wind is known at all [s since departure]."""
        knots = self.fields[0].times
        return float(knots[-1]) if len(knots) > 1 else math.inf

    @property
    def sampled(self) -> tuple[float, ...]:
        """The moments of changing wind that have been sampled so far [s since departure]."""
        return self._samples.moments

    def winds_between(self, begin: float, until: float) -> NodeWinds:
        """The winds from `begin` to `until` [s] as far as they are known, at the wind's own times, sampled if need be.

        Raises `WindError` where a field does not cover the veil.
        """
        if self.steady is not None:
            return self.steady
        knots = self.fields[0].times if len(self.fields[0].times) > 1 else np.zeros(1)
        first = max(int(np.searchsorted(knots, begin, side="right")) - 1, 0)
        last = min(int(np.searchsorted(knots, until, side="left")), len(knots) - 1)
        return self._samples.at(knots[first : max(last, min(first + 1, len(knots) - 1)) + 1], self)

    def winds_at(self, points: FloatArray, times: FloatArray | None) -> FloatArray:
        """The wind at a few points (k, 3) at the `times` of `NodeWinds`, shaped as its winds; nothing is kept free of
        the limits."""
        whole = replace(self, limits=self.limits.with_spare(0.0))
        if times is None:
            return whole.sample(0, points, 0.0)
        members = range(len(self.fields))
        there = [np.stack([whole.sample(k, points, time) for time in times.tolist()]) for k in members]
        return np.stack(there) if len(there) > 1 else there[0]

    def sample(self, member: int, points: FloatArray, seconds: float) -> FloatArray:
        """A member's wind (n, 3) at points (n, 3) at a moment; (n, 4) with its share of the limits, if any."""
        winds = self.fields[member].at(points, seconds)
        if not self.limits:
            return winds
        return np.column_stack([winds, self.limits.shares(member, winds, points, seconds)])


def sample_wind(
    veil: GridVeil | PrmVeil, wind: WindField, members: Sequence[WindField] = (), limits: WindLimits = NO_LIMITS
) -> WindGraph:
    """A veil in a wind, or in those of an ensemble's members; changing ones are sampled when a search asks for them.

    Nodes are closed to all searches where the wind is beyond the `limits`.
    """
    fields = tuple(members) if len(members) > 1 else (wind,)
    graph = WindGraph(veil, fields, veil.points, limits=limits)
    if len(fields) == 1 and len(wind.times) < 2:
        return replace(graph, steady=NodeWinds(_sampled(graph, 0, 0.0), None))
    return graph


def _sampled(graph: WindGraph, member: int, seconds: float) -> FloatArray:
    """A member's wind at all nodes at a moment; 0 where a height is unknown."""
    points = graph.points
    winds = np.zeros((len(points), 4 if graph.limits else 3))

    def part(begin: int) -> None:
        some = slice(begin, begin + _BATCH)
        known = np.isfinite(points[some, 2])
        winds[some][known] = graph.sample(member, points[some][known], seconds)

    for _ in spread(part, range(0, len(points), _BATCH)):
        pass
    return winds
