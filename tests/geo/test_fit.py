"""The one polynomial fit, beside sums written out term by term."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from gcs_windplan.geo.fit import PolynomialFit, chebyshev_points, exponents, monomials

ROUNDING = 1e-9
CENTRE, HALF = np.array([300.0, -50.0]), np.array([2000.0, 700.0])


def naive(points, matrix):
    """Sums over all u^i v^j, one number at a time."""
    values = []
    for x, y in points:
        u, v = (x - CENTRE[0]) / HALF[0], (y - CENTRE[1]) / HALF[1]
        values.append([
            sum(part[i][j] * u**i * v**j for i in range(len(part)) for j in range(len(part) - i)) for part in matrix
        ])  # fmt: skip
    return np.array(values)


@given(st.integers(0, 6), st.integers(0, 2**32 - 1))
def test_a_polynomial_is_found_again(degree: int, seed: int) -> None:
    rng = np.random.default_rng(seed)
    matrix = rng.uniform(-5, 5, (2, degree + 1, degree + 1))
    fit_points, check_points = chebyshev_points(CENTRE, HALF, 9), rng.uniform(-1, 1, (40, 2)) * HALF + CENTRE
    fit = PolynomialFit.least_squares(CENTRE, HALF, degree, fit_points, naive(fit_points, matrix))
    np.testing.assert_allclose(fit.at(check_points), naive(check_points, matrix), atol=ROUNDING)
    np.testing.assert_allclose(naive(check_points, fit.matrix), naive(check_points, matrix), atol=ROUNDING)
    assert np.abs(fit.residual(check_points, naive(check_points, matrix))).max() < ROUNDING


def test_the_residual_of_a_curve_that_a_straight_line_cannot_follow() -> None:
    """u² over [-1, 1]: at Chebyshev's nodes the mean is 1/2, so the line is off by 1/2 in the middle and at the rim."""
    points = chebyshev_points(CENTRE, HALF, 16)
    squares = ((points[:, :1] - CENTRE[0]) / HALF[0]) ** 2
    fit = PolynomialFit.least_squares(CENTRE, HALF, 1, points, squares)
    middle, rim = CENTRE[None], (CENTRE + HALF)[None]
    assert fit.residual(middle, np.zeros((1, 1)))[0, 0] == pytest.approx(0.5)
    assert fit.residual(rim, np.ones((1, 1)))[0, 0] == pytest.approx(-0.5)


def test_monomials_stand_in_the_order_of_their_exponents() -> None:
    scaled = np.random.default_rng(2).uniform(-1, 1, (30, 2))
    expected = np.stack([scaled[:, 0] ** i * scaled[:, 1] ** j for i, j in exponents(6)], axis=-1)
    np.testing.assert_allclose(monomials(scaled, 6), expected, rtol=1e-13)


def test_many_points_come_in_blocks_and_a_height_is_ignored() -> None:
    fit_points = chebyshev_points(np.zeros(2), np.ones(2), 3)
    fit = PolynomialFit.least_squares(np.zeros(2), np.ones(2), 1, fit_points, fit_points)
    points = np.random.default_rng(3).uniform(-1, 1, (20_000, 3))
    np.testing.assert_allclose(fit.at(points), points[:, :2], atol=ROUNDING)
