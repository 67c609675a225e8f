"""From local places back to latitudes and longitudes, fast: one polynomial for the whole neighbourhood of the origin.

`LocalFrame.to_geographic` iterates: with the convergence 5 µs a place. A polynomial of degree 6 in east and
north gives the same to a millimetre over 200 km in a hundredth of that.
"""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from gcs_windplan.arrays import FloatArray
from gcs_windplan.errors import InputError
from gcs_windplan.geo.fit import PolynomialFit, chebyshev_points, lattice
from gcs_windplan.geo.frame import LocalFrame, rotate

_DEGREE = 6
_FIT_POINTS = 12  # a side
_CHECK_POINTS = 9  # a side, equally spaced, borders and corners included
_LARGEST_ERROR = 1.0  # [m] on the ground
_LARGEST_TWIST = 1e-5  # [rad] in the convergence: 0.1 mm/s in a wind of 10 m/s
_METRES_PER_DEGREE = 111_320.0  # [m] of a meridian, to 1 %: only compares errors with a bound


@dataclass(frozen=True, slots=True)
class InverseProjection:
    """Latitude, longitude and convergence of local places: a polynomial near the origin, exact farther away.

    `reach` [m] is how far the polynomial goes to each of the four sides. It is checked when made, at places
    it was not fitted to; where it is off by a metre or more (next to a pole) everything is computed exactly.
    Longitudes [deg] run on continuously from the frame's origin, so they may leave [-180, 180]. Raises `InputError`
    for a reach that is not above 0.
    """

    frame: LocalFrame
    reach: float = 100_000.0
    _fit: PolynomialFit | None = field(init=False, repr=False, compare=False)

    def __post_init__(self) -> None:
        if not 0 < self.reach < np.inf:
            raise InputError(f"an inverse projection that reaches {self.reach} m holds no area")
        centre, half_size = np.zeros(2), np.full(2, self.reach)
        fit_points = chebyshev_points(centre, half_size, _FIT_POINTS)
        fit = PolynomialFit.least_squares(centre, half_size, _DEGREE, fit_points, self._exact(fit_points))
        check_points = lattice(centre, half_size, np.linspace(-1, 1, _CHECK_POINTS))
        error = np.abs(fit.residual(check_points, self._exact(check_points))).max(axis=0)
        good = max(error[:2]) * _METRES_PER_DEGREE < _LARGEST_ERROR and error[2] < _LARGEST_TWIST
        object.__setattr__(self, "_fit", fit if good else None)

    def at(self, places: FloatArray) -> FloatArray:
        """Latitude [deg], longitude [deg] and convergence [rad] of places (n, 2 or more), shape (n, 3)."""
        if self._fit is None:
            return self._exact(places)
        result = self._fit.at(places)
        outside = ~((np.abs(places[:, 0]) <= self.reach) & (np.abs(places[:, 1]) <= self.reach))
        if outside.any():
            result[outside] = self._exact(places[outside])
        return result

    def _exact(self, places: FloatArray) -> FloatArray:
        latitude, longitude = self.frame.to_geographic(places)
        origin = self.frame.origin.longitude_deg
        longitude = origin + (longitude - origin + 180.0) % 360.0 - 180.0
        return np.stack([latitude, longitude, self.frame.convergence(places)], axis=-1)


def to_grid_north(true_wind: FloatArray, convergence: FloatArray) -> FloatArray:
    """Winds (n, 2 or more), given as true east and north, along the local frame's axes.

    Grid north lies clockwise of true north by the `convergence` (n,) [rad], so seen from the grid every
    vector turns back by it.
    """
    return rotate(true_wind, -convergence)
