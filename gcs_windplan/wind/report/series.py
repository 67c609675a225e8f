"""The times of a forecast as a series: how long its steps are, and which times are missing from it."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from itertools import groupby, pairwise

_SAME = 1.0  # [s] steps that differ by less are the same: files count hours as fractions of days
_MOST_STEPS = 3  # different steps one after the other; with more of them it is called uneven


@dataclass(frozen=True, slots=True)
class Gap:
    """Times that are missing from an otherwise even series: the first, the last [s since 1970, UTC], how many."""

    first: float
    last: float
    count: int


@dataclass(frozen=True, slots=True)
class Series:
    """Times [s since 1970, UTC], ascending.

    `steps` are the steps [s] and the time until which each of them goes, at least twice if it is not the only one; none
    where there is one time alone, or where they are uneven. Gaps in it count as if they were not there.
    """

    times: tuple[float, ...]
    steps: tuple[tuple[float, float], ...]
    gaps: tuple[Gap, ...]

    @property
    def uneven(self) -> bool:
        """Whether there are several times without an order."""
        return len(self.times) > 1 and not self.steps


def series_of(times: Iterable[float]) -> Series:
    """The series that some times make.

    A longer step counts as a gap where the series goes on as before it: forecasts go on with longer steps after a few
    days, which is none.
    """
    ordered = sorted(set(times))
    ways = [round((b - a) / _SAME) * _SAME for a, b in pairwise(ordered)]
    usual = [_usual(ways, number) for number in range(len(ways))]
    holes = [number for number, step in enumerate(usual) if step < ways[number]]
    if 2 * len(holes) > len(ways):
        usual, holes = ways, []
    runs = [list(run) for _, run in groupby(range(len(ways)), key=lambda number: usual[number])]
    even = len(runs) == 1 or (len(runs) <= _MOST_STEPS and all(_times_in(run, usual, ways) > 1 for run in runs))
    steps = tuple((usual[run[0]], ordered[run[-1] + 1]) for run in runs if even)
    gaps = tuple(_gap(ordered[number], usual[number], ways[number]) for number in holes if even)
    return Series(tuple(ordered), steps, gaps)


def _usual(ways: list[float], number: int) -> float:
    """The step that a way from one time to the next is made of: one that is there before and after it, else itself."""
    around = set(ways[:number]) & set(ways[number + 1 :])
    return max((step for step in around if 0 < step < ways[number] and ways[number] % step == 0), default=ways[number])


def _times_in(run: list[int], usual: list[float], ways: list[float]) -> float:
    """How often a step is made, gaps filled."""
    return sum(ways[number] / usual[number] for number in run)


def _gap(before: float, step: float, way: float) -> Gap:
    return Gap(before + step, before + way - step, round(way / step) - 1)
