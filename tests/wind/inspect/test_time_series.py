"""Steps and gaps of times."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from gcs_windplan.wind.inspect.time_series import TimeGap, series_of

HOUR = 3600.0


def _hours(*numbers: float) -> list[float]:
    return [number * HOUR for number in numbers]


@pytest.mark.parametrize(
    ("hours", "steps", "gaps"),
    [
        ([], [], []),
        ([5], [], []),
        ([0, 6], [(6, 6)], []),
        ([0, 1, 2, 3], [(1, 3)], []),
        ([0, 1, 2, 3, 6, 9, 12], [(1, 3), (3, 12)], []),  # longer steps after some days are no gaps
        ([0, 1, 3, 4, 5], [(1, 5)], [(2, 2, 1)]),
        ([0, 1, 2, 6, 7, 8], [(1, 8)], [(3, 5, 3)]),
        ([0, 1, 3, 4, 6, 7, 8], [(1, 8)], [(2, 2, 1), (5, 5, 1)]),
        ([0, 1, 2, 5, 8, 14, 17], [(1, 2), (3, 17)], [(11, 11, 1)]),
        ([0, 6, 12, 13, 18], [], []),  # uneven
        ([0, 1, 5, 6], [(1, 6)], [(2, 4, 3)]),
        ([0, 5, 6, 11, 12], [], []),  # as much gap as series
        ([0, 1, 2, 3, 10.5], [], []),
    ],
)
def test_steps_and_gaps(
    hours: list[float], steps: list[tuple[float, float]], gaps: list[tuple[float, float, int]]
) -> None:
    found = series_of(_hours(*hours))
    assert found.times == tuple(_hours(*hours))
    assert found.steps == tuple((step * HOUR, end * HOUR) for step, end in steps)
    assert found.gaps == tuple(TimeGap(first * HOUR, last * HOUR, count) for first, last, count in gaps)


def test_single_precision_does_not_make_a_series_uneven() -> None:
    assert series_of([0.0, 3600.2, 7199.8, 10800.1]).steps == ((3600.0, 10800.1),)


@given(st.integers(4, 40).flatmap(lambda last: st.tuples(st.just(last), st.integers(2, last - 2))))
def test_an_hour_that_is_taken_out_of_an_hourly_series_is_named(taken: tuple[int, int]) -> None:
    last, out = taken
    found = series_of(_hours(*(number for number in range(last + 1) if number != out)))
    assert found.gaps == (TimeGap(out * HOUR, out * HOUR, 1),)
    assert found.steps == ((HOUR, last * HOUR),)
