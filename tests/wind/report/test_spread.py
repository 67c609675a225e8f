"""Spreads of numbers and of directions."""

from __future__ import annotations

import numpy as np
import pytest

from gcs_windplan.wind.report.spread import direction_from, spread_of, spread_of_directions


@pytest.mark.parametrize(
    ("u", "v", "direction"),
    [(9.0, 0.0, 270.0), (0.0, 9.0, 180.0), (-1.0, 0.0, 90.0), (0.0, -3.0, 0.0), (1.0, 1.0, 225.0)],
)
def test_directions_are_where_the_wind_comes_from(u: float, v: float, direction: float) -> None:
    assert direction_from(np.array([[u, v]]))[0] == pytest.approx(direction)


def test_still_air_comes_from_nowhere() -> None:
    assert np.isnan(direction_from(np.zeros((1, 2)))).all()


def test_numbers() -> None:
    found = spread_of(np.array([3.0, 1.0, np.nan, 2.0]))
    assert (found.median, found.least, found.most) == (2.0, 1.0, 3.0)
    assert np.isnan(spread_of(np.array([np.nan])).median)


@pytest.mark.parametrize(
    ("directions", "expected"),
    [
        ([350.0, 10.0, 20.0], (10.0, 350.0, 20.0)),  # across north
        ([100.0, 120.0, 90.0], (100.0, 90.0, 120.0)),
        ([45.0], (45.0, 45.0, 45.0)),
        ([np.nan, 300.0], (300.0, 300.0, 300.0)),
    ],
)
def test_directions_lie_on_the_smallest_arc(directions: list[float], expected: tuple[float, float, float]) -> None:
    found = spread_of_directions(np.array(directions))
    assert (found.median, found.least, found.most) == pytest.approx(expected)


def test_no_direction_at_all() -> None:
    assert np.isnan(spread_of_directions(np.array([np.nan])).least)
