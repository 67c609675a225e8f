"""Where local places lie on the globe, fast: one polynomial for the whole neighbourhood of the origin.

`LocalFrame.to_geographic` iterates: with the convergence 5 µs a place. A polynomial of degree 6 in east and
north gives the same to a millimetre over 200 km in a hundredth of that.
"""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from gcs_windplan.arrays import FloatArray
from gcs_windplan.errors import WindError
from gcs_windplan.geo.frame import LocalFrame, rotate

_DEGREE = 6
_NODES = 12  # samples a side that the polynomial is fitted to, at Chebyshev's nodes
_CHECKS = 9  # samples a side that it is checked at, equally spaced, borders and corners included
_BLOCK = 8192  # places at a time, so that the powers stay in the cache
_LARGEST_ERROR = 1.0  # [m] on the ground
_LARGEST_TWIST = 1e-5  # [rad] in the convergence: 0.1 mm/s in a wind of 10 m/s
_METRES_PER_DEGREE = 111_320.0  # [m] of a meridian, to 1 %: only compares errors with a bound


@dataclass(frozen=True, slots=True)
class Chart:
    """Latitude, longitude and convergence of local places: a polynomial near the origin, exact farther away.

    `reach` [m] is how far the polynomial goes to each of the four sides. It is checked when made, at places
    it was not fitted to; where it is off by a metre or more (next to a pole) everything is computed exactly.
    Longitudes [deg] run on continuously from the frame's origin, so they may leave [-180, 180].
    """

    frame: LocalFrame
    reach: float = 100_000.0
    _coefficients: FloatArray | None = field(init=False, repr=False, compare=False)

    def __post_init__(self) -> None:
        if not 0 < self.reach < np.inf:
            raise WindError(f"a chart that reaches {self.reach} m holds no area")
        angles = (np.arange(_NODES) + 0.5) * np.pi / _NODES
        nodes = _lattice(self.reach * np.cos(angles))
        checks = _lattice(self.reach * np.linspace(-1, 1, _CHECKS))
        fitted, *_ = np.linalg.lstsq(self._powers(nodes), self._exact(nodes), rcond=None)
        error = np.abs(self._powers(checks) @ fitted - self._exact(checks)).max(axis=0)
        good = max(error[:2]) * _METRES_PER_DEGREE < _LARGEST_ERROR and error[2] < _LARGEST_TWIST
        object.__setattr__(self, "_coefficients", np.ascontiguousarray(fitted) if good else None)

    def at(self, places: FloatArray) -> FloatArray:
        """Latitude [deg], longitude [deg] and convergence [rad] of places (n, 2 or more), shape (n, 3)."""
        if self._coefficients is None:
            return self._exact(places)
        outside = ~((np.abs(places[:, 0]) <= self.reach) & (np.abs(places[:, 1]) <= self.reach))
        result = np.empty((len(places), 3))
        for start in range(0, len(places), _BLOCK):
            block = slice(start, start + _BLOCK)
            result[block] = self._powers(places[block]) @ self._coefficients
        if outside.any():
            result[outside] = self._exact(places[outside])
        return result

    def _exact(self, places: FloatArray) -> FloatArray:
        latitude, longitude = self.frame.to_geographic(places)
        origin = self.frame.origin.longitude_deg
        longitude = origin + (longitude - origin + 180.0) % 360.0 - 180.0
        return np.stack([latitude, longitude, self.frame.convergence(places)], axis=-1)

    def _powers(self, places: FloatArray) -> FloatArray:
        return monomials(places[:, :2] / self.reach, _DEGREE)


def monomials(places: FloatArray, degree: int) -> FloatArray:
    """The monomials x^i y^j with i + j ≤ degree of places (n, 2) scaled to [-1, 1], shape (n, k)."""
    x, y = places[:, 0], places[:, 1]
    powers = np.empty(((degree + 1) * (degree + 2) // 2, len(x)))
    powers[0] = 1.0
    row = 1
    for total in range(1, degree + 1):  # each degree is the one before times x, and its last one times y
        np.multiply(powers[row - total : row], x, out=powers[row : row + total])
        np.multiply(powers[row - 1], y, out=powers[row + total])
        row += total + 1
    return powers.T


def to_grid(true_wind: FloatArray, convergence: FloatArray) -> FloatArray:
    """Winds (n, 2 or more), given as true east and north, along the local frame's axes.

    Grid north lies clockwise of true north by the `convergence` (n,) [rad], so seen from the grid every
    vector turns back by it.
    """
    return rotate(true_wind, -convergence)


def _lattice(offsets: FloatArray) -> FloatArray:
    """Places at all pairs of `offsets` [m], shape (k², 2)."""
    x, y = np.meshgrid(offsets, offsets)
    return np.stack([x.ravel(), y.ravel()], axis=-1)
