"""The way from the local frame into a height grid: a polynomial that stands in for the projections.

The exact way (local frame, geographic, the grid's own projection, columns and rows) costs microseconds and
cannot enter a kernel. Over one DEM it is so smooth that a polynomial of a low degree follows it to less than
a centimetre.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Protocol, TypeAlias

import numpy as np
from numpy.polynomial.polynomial import polyval2d

from gcs_windplan.arrays import FloatArray
from gcs_windplan.errors import TerrainError
from gcs_windplan.geo.fit import PolynomialFit, chebyshev_points
from gcs_windplan.geo.frame import LocalFrame
from gcs_windplan.terrain.surface import Extent

MAP_ERROR = 0.01  # [m] the most by which the polynomial may stray from the exact way
STRAIGHTNESS = 0.05  # [m] the most by which a piece of a leg may bulge when it is taken as straight in the grid
HIGHEST_DEGREE = 6
FARTHEST = 600_000.0  # [m] from the origin; LocalFrame itself ends at 1000 km

Projection: TypeAlias = Callable[[FloatArray], FloatArray]


class Georeference(Protocol):
    """Where a grid lies on the ellipsoid. Columns and rows count from the centre of the first sample."""

    def to_grid(self, latitude_deg: FloatArray, longitude_deg: FloatArray) -> FloatArray:
        """Columns and rows of WGS 84 places, shape (n, 2)."""

    def to_geographic(self, places: FloatArray) -> tuple[FloatArray, FloatArray]:
        """WGS 84 latitudes and longitudes [deg] of columns and rows (n, 2)."""


@dataclass(frozen=True, slots=True)
class GeographicGrid:
    """A grid along meridians and parallels of WGS 84, the first row to the north, all angles in degrees."""

    first_latitude: float
    first_longitude: float
    latitude_step: float
    longitude_step: float
    columns: int

    def to_grid(self, latitude_deg: FloatArray, longitude_deg: FloatArray) -> FloatArray:
        """Columns and rows of WGS 84 places, shape (n, 2)."""
        middle = (self.columns - 1) / 2
        east = longitude_deg - self.first_longitude - middle * self.longitude_step
        column = ((east + 180) % 360 - 180) / self.longitude_step + middle
        return np.stack([column, (self.first_latitude - latitude_deg) / self.latitude_step], axis=-1)

    def to_geographic(self, places: FloatArray) -> tuple[FloatArray, FloatArray]:
        """WGS 84 latitudes and longitudes [deg] of columns and rows (n, 2)."""
        latitude = self.first_latitude - places[:, 1] * self.latitude_step
        return latitude, self.first_longitude + places[:, 0] * self.longitude_step


@dataclass(frozen=True, slots=True, eq=False)
class GridMap:
    """East and north [m] to (column, row), by a polynomial of total degree d that holds inside of `extent`.

    `coefficients` is (2, d+1, d+1): [0, i, j] multiplies u^i v^j in the column and [1, i, j] in the row,
    where u and v run from -1 to 1 over the extent.
    """

    coefficients: FloatArray
    extent: Extent

    @classmethod
    def affine(cls, extent: Extent, shape: tuple[int, int]) -> GridMap:
        """The map of a grid of (rows, columns) in the local frame whose outermost samples lie on the extent's rim."""
        height, width = (shape[0] - 1) / 2, (shape[1] - 1) / 2
        coefficients = np.array([[[width, 0.0], [width, 0.0]], [[height, -height], [0.0, 0.0]]])
        return cls(coefficients, extent)

    @classmethod
    def fitted(cls, projection: Projection, extent: Extent, name: str) -> GridMap:
        """The lowest degree that follows `projection`, (n, 2) to (n, 2), to 1 cm inside of `extent`.

        Judged at places that took no part in the fit. Raises TerrainError if degree 6 does not do.
        """
        rng = np.random.default_rng(1)
        centre, half_sizes = _centre(extent), _half_sizes(extent)
        rim = [(a, b) for a in (-1.0, 0.1, 1.0) for b in (-1.0, -0.1, 1.0)]
        check_points = centre + np.concatenate([rng.uniform(-1, 1, (400, 2)), np.array(rim)]) * half_sizes
        fit_points = chebyshev_points(centre, half_sizes, 16)
        fit_values, check_values = projection(fit_points), projection(check_points)
        if not (np.isfinite(fit_values).all() and np.isfinite(check_values).all()):
            raise TerrainError(f"{name}: reaches beyond where its projection holds; plan a smaller area")
        error = math.inf
        for degree in range(1, HIGHEST_DEGREE + 1):
            fit = PolynomialFit.least_squares(centre, half_sizes, degree, fit_points, fit_values)
            grid_map = cls(fit.matrix, extent)
            residual = fit.residual(check_points, check_values) @ np.linalg.inv(grid_map._slopes()).T
            error = float(np.max(np.hypot(residual[:, 0], residual[:, 1])))
            if error < MAP_ERROR:
                return grid_map
        raise TerrainError(
            f"{name}: the projection bends too much here: a polynomial of degree {HIGHEST_DEGREE} is "
            f"{error:.2f} m off, {MAP_ERROR} m allowed; plan a smaller area, or reproject the DEM (gdalwarp)"
        )

    def to_grid(self, places: FloatArray) -> FloatArray:
        """Columns and rows of local places (n, 2), shape (n, 2); meaningless outside of the extent."""
        u, v = ((places[:, :2] - _centre(self.extent)) / _half_sizes(self.extent)).T
        return np.stack([polyval2d(u, v, part) for part in self.coefficients], axis=-1)

    def to_local(self, cells: FloatArray) -> FloatArray:
        """Local places (n, 2) of columns and rows (n, 2), by Newton's method with fixed slopes."""
        slopes = np.linalg.inv(self._slopes())
        places = np.tile(_centre(self.extent), (len(cells), 1))
        for _ in range(50):
            step = (cells - self.to_grid(places)) @ slopes.T
            places = places + step
            if np.max(np.abs(step), initial=0.0) < 1e-8:
                break
        return places

    @property
    def cell_area(self) -> float:
        """The area of a cell at the extent's centre [m²]."""
        return float(1 / abs(np.linalg.det(self._slopes())))

    @property
    def scaling(self) -> FloatArray:
        """Centre, half sizes and greatest straight length [m], shape (5,), as the kernels take them."""
        return np.array([*_centre(self.extent), *_half_sizes(self.extent), self._straight_length()])

    def _slopes(self) -> FloatArray:
        """Cells per metre at the extent's centre: d(column, row) / d(east, north), shape (2, 2)."""
        half = _half_sizes(self.extent)
        return np.stack([self.coefficients[:, 1, 0] / half[0], self.coefficients[:, 0, 1] / half[1]], axis=-1)

    def _straight_length(self) -> float:
        """The length up to which any leg in the extent bulges by less than STRAIGHTNESS in the grid [m].

        A curve with second derivative at most K strays from its chord by at most K L² / 8. With |u|, |v| <= 1
        no second derivative of u^i v^j along a unit vector exceeds (i + j)².
        """
        power = np.add.outer(np.arange(self.coefficients.shape[1]), np.arange(self.coefficients.shape[1]))
        bend = np.where(power >= 2, power**2, 0) * np.abs(self.coefficients)
        cells = float(np.hypot(*bend.sum(axis=(1, 2)))) / float(np.min(_half_sizes(self.extent))) ** 2
        metres = cells * float(np.linalg.norm(np.linalg.inv(self._slopes()), 2))
        return math.sqrt(8 * STRAIGHTNESS / metres) if metres > 0 else math.inf


def fit_grid_map(georeference: Georeference, frame: LocalFrame, shape: tuple[int, int], name: str) -> GridMap:
    """The map of a georeferenced grid of `shape` (rows, columns) into a local frame.

    Raises TerrainError where the polynomial cannot follow the projection to 1 cm.
    """
    outline = _outline(shape)
    places = frame.to_local(*georeference.to_geographic(outline))
    if not np.isfinite(places).all():
        raise TerrainError(f"{name}: reaches beyond where its projection holds; plan a smaller area")
    (west, south), (east, north) = places.min(axis=0), places.max(axis=0)
    extent = Extent(float(west), float(south), float(east), float(north))

    if max(-west, east, -south, north) > FARTHEST:
        raise TerrainError(f"{name}: too large for one local frame; give an area of the mission's size")

    def projection(local: FloatArray) -> FloatArray:
        return georeference.to_grid(*frame.to_geographic(local))

    return GridMap.fitted(projection, extent, name)


def _outline(shape: tuple[int, int]) -> FloatArray:
    """Columns and rows along the rim of a grid, 41 a side, shape (164, 2)."""
    rows, columns = shape
    along = np.linspace(0.0, 1.0, 41)
    zero, one = np.zeros_like(along), np.ones_like(along)
    sides = [(along, zero), (along, one), (zero, along), (one, along)]
    return np.concatenate([np.stack([x * (columns - 1), y * (rows - 1)], axis=-1) for x, y in sides])


def _centre(box: Extent) -> FloatArray:
    return np.array([box.west + box.east, box.south + box.north]) / 2


def _half_sizes(box: Extent) -> FloatArray:
    return np.array([box.east - box.west, box.north - box.south]) / 2
