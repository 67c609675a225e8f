"""The interpolation kernel against scipy and against its naive twin."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.interpolate import RegularGridInterpolator

from gcs_windplan.arrays import FloatArray
from gcs_windplan.kernels.interpolation import interpolate_columns
from tests.oracles.wind import naive_interpolate_columns


def _axis(random: np.random.Generator, length: int) -> FloatArray:
    return np.cumsum(random.uniform(0.1, 2.0, length))


def _grid(random: np.random.Generator, shape: tuple[int, ...]) -> tuple[FloatArray, ...]:
    """u, v, heights that vary from column to column, times, latitudes, longitudes."""
    nt, nl, ny, nx = shape
    u, v = random.normal(size=(2, *shape))
    heights = np.cumsum(random.uniform(1.0, 50.0, (nt, nl, ny, nx)), axis=1)
    return u, v, heights, _axis(random, nt), _axis(random, ny), _axis(random, nx)


def _within(random: np.random.Generator, axis: FloatArray, count: int) -> FloatArray:
    return random.uniform(axis[0], axis[-1], count)


@pytest.mark.parametrize("shape", [(3, 5, 4, 6), (2, 2, 2, 2), (5, 9, 2, 7)])
def test_it_equals_scipy_where_the_heights_are_constant(shape: tuple[int, int, int, int]) -> None:
    random = np.random.default_rng(7)
    u, v, _, times, latitudes, longitudes = _grid(random, shape)
    levels = _axis(random, shape[1])
    heights = np.ascontiguousarray(np.broadcast_to(levels[:, np.newaxis, np.newaxis], shape))
    when, z, latitude, longitude = (_within(random, a, 500) for a in (times, levels, latitudes, longitudes))
    places = np.stack([latitude, longitude], axis=-1)
    found = interpolate_columns(u, v, heights, times, latitudes, longitudes, places, z, when)
    for column, values in enumerate((u, v)):
        scipys = RegularGridInterpolator((times, levels, latitudes, longitudes), values)
        expected = scipys(np.stack([when, z, latitude, longitude], axis=-1))
        np.testing.assert_allclose(found[:, column], expected, atol=1e-12)
    assert found[:, 2].max() <= 0


@given(seed=st.integers(0, 2**32 - 1), shape=st.tuples(*(st.integers(1, 4) for _ in range(4))))
def test_it_equals_its_naive_twin_where_heights_vary(seed: int, shape: tuple[int, int, int, int]) -> None:
    """Inside, outside on every side, above and below, with axes of length 1."""
    random = np.random.default_rng(seed)
    grid = _grid(random, shape)
    places, z = random.uniform(-2, 6, (20, 2)), random.uniform(-20, 200, 20)
    when = random.uniform(-2, 6, 20)
    found = interpolate_columns(*grid, places, z, when)
    np.testing.assert_allclose(found[:, :2], naive_interpolate_columns(*grid, places, z, when), atol=1e-12, rtol=1e-9)


def test_it_tells_how_far_a_point_lies_above_the_top() -> None:
    u = v = np.zeros((1, 2, 1, 2))
    heights = np.array([0.0, 0.0, 100.0, 140.0]).reshape(1, 2, 1, 2)
    axis, pair = np.zeros(1), np.array([0.0, 1.0])
    places, z = np.array([[0, 0], [0, 1], [0, 0.5], [0, 0.5]], dtype=float), np.array([130.0, 130, 130, 90])
    found = interpolate_columns(u, v, heights, axis, axis, pair, places, z, np.zeros(4))
    np.testing.assert_allclose(found[:, 2], [30, 0, 30, 0])
