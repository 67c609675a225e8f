"""The interpolation kernel against scipy and against its naive twin."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.interpolate import RegularGridInterpolator

from gcs_windplan.arrays import FloatArray
from gcs_windplan.kernels.interpolation import LOG, POWER, Columns, Law, interpolate_columns
from tests.oracles.wind import naive_interpolate_columns

LOG_LAW = Law(LOG, 0.0, 0.0)


def _axis(random: np.random.Generator, length: int, largest: float = 2.0) -> FloatArray:
    return np.cumsum(random.uniform(0.1, largest, length))


def _within(random: np.random.Generator, axis: FloatArray, count: int) -> FloatArray:
    return random.uniform(axis[0], axis[-1], count)


def _columns(random: np.random.Generator, shape: tuple[int, ...], na: int, shared: bool, terrain: bool) -> Columns:
    """A random forecast of (times, levels, rows, columns), `na` of its levels above the ground."""
    nt, levels, ny, nx = shape
    beyond = levels - na
    where = (1, 1, 1) if shared else (nt, ny, nx)
    return Columns(
        winds=random.normal(size=(nt, ny, nx, levels, 2)),
        above=_axis(random, na, 60.0),
        heights=np.cumsum(random.uniform(1.0, 80.0, (*where, beyond)), axis=3),
        terrain=random.uniform(-20.0, 150.0, (ny, nx)) if terrain else np.full((ny, nx), -math.inf),
        roughness=random.uniform(0.01, 1.5, (ny, nx)),
        times=_axis(random, nt),
        rows=_axis(random, ny),
        columns=_axis(random, nx),
    )


@pytest.mark.parametrize("shared", [True, False])
@pytest.mark.parametrize("shape", [(3, 5, 4, 6), (2, 2, 2, 2), (5, 9, 2, 7)])
def test_it_equals_scipy_where_the_heights_are_constant(shape: tuple[int, int, int, int], shared: bool) -> None:
    random = np.random.default_rng(7)
    field = _columns(random, shape, 0, True, terrain=False)
    levels = field.heights[0, 0, 0]
    if not shared:
        nt, _, ny, nx = shape
        field = field._replace(heights=np.ascontiguousarray(np.broadcast_to(levels, (nt, ny, nx, len(levels)))))
    axes = (field.times, levels, field.rows, field.columns)
    when, z, row, column = (_within(random, axis, 500) for axis in axes)
    found = interpolate_columns(field, LOG_LAW, np.stack([row, column], axis=-1), z, np.zeros(500), when)
    for part in range(2):
        scipys = RegularGridInterpolator(axes, field.winds[..., part].transpose(0, 3, 1, 2))
        np.testing.assert_allclose(found[:, part], scipys(np.stack([when, z, row, column], axis=-1)), atol=1e-12)


@pytest.mark.parametrize("shape", [(3, 5, 4, 6), (2, 2, 3, 2)])
def test_it_equals_scipy_above_the_ground(shape: tuple[int, int, int, int]) -> None:
    random = np.random.default_rng(8)
    field = _columns(random, shape, shape[1], True, terrain=False)._replace(heights=np.empty((1, 1, 1, 0)))
    axes = (field.times, field.above, field.rows, field.columns)
    when, agl, row, column = (_within(random, axis, 500) for axis in axes)
    ground = random.uniform(-100, 2000, 500)
    found = interpolate_columns(field, LOG_LAW, np.stack([row, column], axis=-1), ground + agl, ground, when)
    for part in range(2):
        scipys = RegularGridInterpolator(axes, field.winds[..., part].transpose(0, 3, 1, 2))
        np.testing.assert_allclose(found[:, part], scipys(np.stack([when, agl, row, column], axis=-1)), atol=1e-9)


@given(
    seed=st.integers(0, 2**32 - 1),
    shape=st.tuples(st.integers(1, 3), st.integers(1, 5), st.integers(1, 3), st.integers(1, 3)),
    above=st.integers(0, 5),
    shared=st.booleans(),
    terrain=st.booleans(),
    known=st.booleans(),
    law=st.sampled_from([Law(LOG, 0.0, 0.0), Law(LOG, 0.0, 300.0), Law(POWER, 0.2, 0.0), Law(POWER, 0.14, 300.0)]),
)
def test_it_equals_its_naive_twin(seed, shape, above, shared, terrain, known, law) -> None:
    """Inside, outside on every side, above and below, levels of both kinds, ground known or not, axes of length 1."""
    random = np.random.default_rng(seed)
    na = min(above, shape[1])
    field = _columns(random, shape, na, shared, terrain)
    places, z, when = random.uniform(-2, 6, (20, 2)), random.uniform(-60, 400, 20), random.uniform(-2, 6, 20)
    ground = random.uniform(-50.0, 120.0, 20) if known else np.full(20, np.nan)
    found = interpolate_columns(field, law, places, z, ground, when)
    expected = naive_interpolate_columns(field, law, places, z, ground, when)
    np.testing.assert_allclose(found[:, :2], expected, atol=1e-11, rtol=1e-9)
    assert not found[:, 2].any()


def _single(heights: FloatArray, speeds: FloatArray, above: FloatArray, terrain: float = -math.inf) -> Columns:
    """One column with winds towards east."""
    winds = np.stack([speeds, np.zeros_like(speeds)], axis=-1).reshape(1, 1, 1, -1, 2)
    one = np.zeros(1)
    return Columns(
        winds, above, heights.reshape(1, 1, 1, -1), np.full((1, 1), terrain), np.full((1, 1), 0.1), one, one, one
    )


def _east(field: Columns, z: list[float], ground: float, law: Law = LOG_LAW) -> FloatArray:
    points = np.array(z)
    n = len(z)
    return interpolate_columns(field, law, np.zeros((n, 2)), points, np.full(n, ground), np.zeros(n))[:, 0]


def test_below_the_lowest_pressure_level_the_log_law_leads_to_the_ground() -> None:
    """10 m/s at 500 m above sea level over ground at 400 m: at 10 m above it ln(10 / 0.1) / ln(100 / 0.1) of that."""
    field = _single(np.array([500.0, 900.0]), np.array([10.0, 20.0]), np.empty(0))
    found = _east(field, [400.0, 400.05, 410.0, 500.0, 700.0], 400.0)
    np.testing.assert_allclose(found, [0, 0, 10 * math.log(100) / math.log(1000), 10, 15], atol=1e-12)


def test_levels_below_the_forecasts_own_ground_do_not_count() -> None:
    """Its ground is at 600 m: the level at 500 m is a fiction; the one at 900 m is the lowest, 300 m above its ground.

    50 m above the true ground, 200 m lower, blows what the forecast has 50 m above its own.
    """
    field = _single(np.array([500.0, 900.0, 1300.0]), np.array([99.0, 10.0, 20.0]), np.empty(0), terrain=600.0)
    factor = math.log(50 / 0.1) / math.log(300 / 0.1)
    np.testing.assert_allclose(_east(field, [450.0, 900.0, 1100.0], 400.0), [10 * factor, 10, 15], atol=1e-12)


def test_above_levels_over_the_ground_the_next_one_above_the_sea_counts() -> None:
    """10 and 100 m above ground at 300 m, then 850 m above sea level; 350 m lies below 400 m and is passed over."""
    field = _single(np.array([350.0, 850.0]), np.array([4.0, 8.0, 99.0, 17.0]), np.array([10.0, 100.0]))
    found = _east(field, [310.0, 355.0, 400.0, 625.0, 850.0], 300.0)
    np.testing.assert_allclose(found, [4, 6, 8, 12.5, 17], atol=1e-12)


def test_above_the_top_the_wind_is_not_known_unless_a_law_carries_it() -> None:
    field = _single(np.empty(0), np.array([6.0]), np.array([10.0]))
    assert np.isnan(_east(field, [60.0], 0.0)).all()
    power = Law(POWER, 0.2, 100.0)
    np.testing.assert_allclose(_east(field, [10.0, 60.0], 0.0, power), [6, 6 * 6**0.2], atol=1e-12)
    assert np.isnan(_east(field, [101.0], 0.0, power)).all()


def test_without_any_ground_the_wind_below_the_lowest_level_is_not_known() -> None:
    field = _single(np.array([500.0, 900.0]), np.array([10.0, 20.0]), np.empty(0))
    assert np.isnan(_east(field, [499.0], math.nan)).all()
    np.testing.assert_allclose(_east(field, [500.0, 700.0], math.nan), [10, 15], atol=1e-12)
