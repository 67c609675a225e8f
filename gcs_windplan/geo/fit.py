"""A polynomial in east and north that stands in for a projection.

The exact way (local frame, geographic, a grid's own projection) costs microseconds a place and cannot enter a kernel.
Over the area of a mission it is so smooth that a polynomial of a low degree follows it.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from gcs_windplan.arrays import FloatArray

_BLOCK = 8192  # points at a time, so that their powers stay in the cache


@dataclass(frozen=True, slots=True, eq=False)
class PolynomialFit:
    """k values at points of a plane: the sum of c u^i v^j over i + j ≤ degree, u and v in [-1, 1] over the fitted area.

    u and v are (point - `centre`) / `half_size`, both (2,) [m]. `coefficients` (terms, k) stand in the order of
    `exponents`.
    """

    centre: FloatArray
    half_size: FloatArray
    degree: int
    coefficients: FloatArray

    @classmethod
    def least_squares(
        cls, centre: FloatArray, half_size: FloatArray, degree: int, fit_points: FloatArray, fit_values: FloatArray
    ) -> PolynomialFit:
        """The polynomial that comes nearest to `fit_values` (n, k) at `fit_points` (n, 2 or more)."""
        u, v = ((fit_points[:, :2] - centre) / half_size).T
        terms = exponents(degree)
        by_power = sorted(range(len(terms)), key=terms.__getitem__)  # the order decides how the last digits are rounded
        powers = np.stack([u ** terms[n][0] * v ** terms[n][1] for n in by_power], axis=-1)
        coefficients = np.empty((len(terms), fit_values.shape[1]))
        coefficients[by_power], *_ = np.linalg.lstsq(powers, fit_values, rcond=None)
        return cls(centre, half_size, degree, coefficients)

    def at(self, points: FloatArray) -> FloatArray:
        """The values (n, k) at points (n, 2 or more); meaningless far outside of the fitted area."""
        values = np.empty((len(points), self.coefficients.shape[1]))
        for start in range(0, len(points), _BLOCK):
            block = slice(start, start + _BLOCK)
            values[block] = monomials((points[block, :2] - self.centre) / self.half_size, self.degree) @ (
                self.coefficients
            )
        return values

    def residual(self, check_points: FloatArray, check_values: FloatArray) -> FloatArray:
        """By how much it misses `check_values` (n, k) at `check_points` (n, 2 or more), shape (n, k)."""
        return self.at(check_points) - check_values

    @property
    def matrix(self) -> FloatArray:
        """The coefficients as kernels take them: [:, i, j] multiplies u^i v^j, shape (k, degree + 1, degree + 1)."""
        matrix = np.zeros((self.coefficients.shape[1], self.degree + 1, self.degree + 1))
        for (i, j), coefficients in zip(exponents(self.degree), self.coefficients, strict=True):
            matrix[:, i, j] = coefficients
        return matrix


def exponents(degree: int) -> list[tuple[int, int]]:
    """The i and j of all u^i v^j with i + j ≤ degree, by their sum."""
    return [(total - j, j) for total in range(degree + 1) for j in range(total + 1)]


def monomials(scaled: FloatArray, degree: int) -> FloatArray:
    """All u^i v^j of `exponents` at points (n, 2) scaled to [-1, 1], shape (n, terms)."""
    u, v = scaled[:, 0], scaled[:, 1]
    powers = np.empty(((degree + 1) * (degree + 2) // 2, len(u)))
    powers[0] = 1.0
    row = 1
    for total in range(1, degree + 1):  # each degree is the one before times u, and its last one times v
        np.multiply(powers[row - total : row], u, out=powers[row : row + total])
        np.multiply(powers[row - 1], v, out=powers[row + total])
        row += total + 1
    return powers.T


def chebyshev_points(centre: FloatArray, half_size: FloatArray, count: int) -> FloatArray:
    """Chebyshev's nodes over a box, `count` a side, shape (count², 2): no runaway at the rim."""
    return lattice(centre, half_size, np.cos((np.arange(count) + 0.5) * np.pi / count))


def lattice(centre: FloatArray, half_size: FloatArray, offsets: FloatArray) -> FloatArray:
    """Points of a box at all pairs of `offsets` (n,) in [-1, 1], shape (n², 2)."""
    u, v = np.meshgrid(offsets, offsets)
    points: FloatArray = centre + np.stack([u.ravel(), v.ravel()], axis=-1) * half_size
    return points
