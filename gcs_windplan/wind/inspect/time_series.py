"""The times of a forecast as a series: how long its steps are, and which times are missing from it."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from itertools import groupby, pairwise

_SAME = 1.0  # [s] steps that differ by less are the same: files count hours as fractions of days
_MOST_STEPS = 3  # different steps one after the other; with more of them it is called uneven


@dataclass(frozen=True, slots=True)
class TimeGap:
    """Times that are missing from an otherwise even series: the first, the last [s since 1970, UTC], how many."""

    first: float
    last: float
    count: int


@dataclass(frozen=True, slots=True)
class TimeSeries:
    """Times [s since 1970, UTC], ascending.

    `steps` are the steps [s] and the time until which each of them goes, at least twice if it is not the only one; none
    where there is one time alone, or where they are uneven. Gaps in it count as if they were not there.
    """

    times: tuple[float, ...]
    steps: tuple[tuple[float, float], ...]
    gaps: tuple[TimeGap, ...]


def series_of(times: Iterable[float]) -> TimeSeries:
    """The series that some times make.

    A longer step counts as a gap where the series goes on as before it: forecasts go on with longer steps after a few
    days, which is none.
    """
    ordered = sorted(set(times))
    steps = [round((b - a) / _SAME) * _SAME for a, b in pairwise(ordered)]
    usual = [_usual(steps, number) for number in range(len(steps))]
    gaps = [number for number, step in enumerate(usual) if step < steps[number]]
    if 2 * len(gaps) > len(steps):
        usual, gaps = steps, []
    runs = [list(run) for _, run in groupby(range(len(steps)), key=lambda number: usual[number])]
    often = [sum(steps[number] / usual[number] for number in run) > 1 for run in runs]  # gaps filled
    if len(runs) > 1 and not (len(runs) <= _MOST_STEPS and all(often)):
        return TimeSeries(tuple(ordered), (), ())
    return TimeSeries(
        tuple(ordered),
        tuple((usual[run[0]], ordered[run[-1] + 1]) for run in runs),
        tuple(TimeGap(ordered[n] + usual[n], ordered[n + 1] - usual[n], round(steps[n] / usual[n]) - 1) for n in gaps),
    )


def _usual(steps: list[float], number: int) -> float:
    """The step that a longer one is a multiple of: one that is there before and after it, else itself."""
    around = set(steps[:number]) & set(steps[number + 1 :])
    return max((s for s in around if 0 < s < steps[number] and steps[number] % s == 0), default=steps[number])
