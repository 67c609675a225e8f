"""The wind along legs: integrals by Gauss-Legendre quadrature, in panels that resolve the field."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from gcs_windplan.arrays import FloatArray, IntArray
from gcs_windplan.kernels.triangle import PAPER, TRIANGLE, integrate_legs
from gcs_windplan.vehicle import Vehicle
from gcs_windplan.wind.field import WindField

_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(3)
_FRACTIONS, _SHARES = (_NODES + 1) / 2, _WEIGHTS / 2
_MOST_PANELS = 512


@dataclass(frozen=True, slots=True, eq=False)
class LegIntegrals:
    """What wind does along n legs, each (n,): seconds, ∫angle ds [rad m], mean wind along and across [m/s].

    `seconds` is infinite where a leg cannot be flown. Across is positive from left to right.
    """

    seconds: FloatArray
    angle: FloatArray
    along: FloatArray
    across: FloatArray


def performance_of(vehicle: Vehicle) -> FloatArray:
    """The vehicle as the kernels take it, shape (5,)."""
    model = PAPER if vehicle.speed_model == "paper" else TRIANGLE
    return np.array([model, vehicle.airspeed, vehicle.climb, vehicle.descent, float(vehicle.hovers)])


def integrate(
    wind: WindField, vehicle: Vehicle, starts: FloatArray, ends: FloatArray, seconds: float = 0.0
) -> LegIntegrals:
    """Integrate along straight legs (n, 3) in the wind as it is `seconds` after departure."""
    vectors = np.ascontiguousarray(ends - starts, dtype=np.float64)
    first, weights, points = _sample(starts, vectors, wind.resolution)
    winds = np.ascontiguousarray(wind.at(points, seconds))
    table = integrate_legs(performance_of(vehicle), vectors, first, weights, winds)
    return LegIntegrals(table[:, 0], table[:, 1], table[:, 2], table[:, 3])


def _sample(starts: FloatArray, vectors: FloatArray, resolution: float) -> tuple[IntArray, FloatArray, FloatArray]:
    """Quadrature points on each leg: where each leg's begin, their weights (k,), the points (k, 3)."""
    lengths = np.linalg.norm(vectors, axis=1)
    panels = np.clip(np.ceil(lengths / resolution), 1, _MOST_PANELS).astype(np.int64)
    first = np.zeros(len(panels) + 1, dtype=np.int64)
    np.cumsum(3 * panels, out=first[1:])
    leg = np.repeat(np.arange(len(panels)), 3 * panels)
    within = np.arange(first[-1]) - first[leg]
    fraction = (within // 3 + _FRACTIONS[within % 3]) / panels[leg]
    weights = _SHARES[within % 3] / panels[leg]
    return first, weights, starts[leg] + fraction[:, None] * vectors[leg]
