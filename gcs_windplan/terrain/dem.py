"""A digital elevation model: regular heights in their own grid, never resampled, each cell two triangles.

Samples sit at pixel centres. Every cell is cut along the diagonal from (row, column) to (row + 1, column +
1):

    (r, c) ──── (r, c+1)
       │ ╲         │
       │   ╲       │
       │     ╲     │
       │        ╲  │
    (r+1, c) ── (r+1, c+1)

Bilinear patches were not taken: along a leg they are quadratic, and neighbouring tools (meshes, ray casters,
the review page's 3D view) draw triangles. With triangles a leg's clearance is exact and the same everywhere.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field

import numpy as np

from gcs_windplan.arrays import FloatArray
from gcs_windplan.errors import TerrainError
from gcs_windplan.geo.frame import LocalFrame
from gcs_windplan.kernels import heightfield
from gcs_windplan.terrain.gridmap import Georeference, GridMap, fit_grid_map
from gcs_windplan.terrain.surface import Extent

RASTER_LIMIT = 50_000_000  # [samples] 400 MB


@dataclass(frozen=True, slots=True, eq=False)
class Dem:
    """A triangulated height grid, a `Terrain`.

    `heights` is (rows, columns) in metres above mean sea level, NaN where unknown; `grid_map` leads from the
    local frame to its (column, row). Raises TerrainError for fewer than two rows or columns, or if no height
    is known.
    """

    heights: FloatArray
    grid_map: GridMap
    name: str
    vertical_datum: str
    _scaling: FloatArray = field(init=False, repr=False)

    def __post_init__(self) -> None:
        heights = np.array(self.heights, dtype=np.float64, order="C")
        _grid_shape(heights, self.name)
        if not np.isfinite(heights).any():
            raise TerrainError(f"{self.name}: not one known height in the area; is the nodata value right?")
        heights[~np.isfinite(heights)] = np.nan
        object.__setattr__(self, "heights", heights)
        object.__setattr__(self, "_scaling", self.grid_map.scaling)

    @classmethod
    def local(
        cls,
        heights: FloatArray,
        west: float,
        north: float,
        cell: float,
        name: str = "local grid",
        vertical_datum: str = "local",
    ) -> Dem:
        """A grid in the local frame: the first sample at (west, north), columns run east, rows south."""
        if not cell > 0:
            raise TerrainError(f"{name}: a cell of {cell} m; it must be positive")
        rows, columns = _grid_shape(heights, name)
        extent = Extent(west, north - (rows - 1) * cell, west + (columns - 1) * cell, north)
        return cls(heights, GridMap.affine(extent, (rows, columns)), name, vertical_datum)

    @classmethod
    def georeferenced(
        cls,
        heights: FloatArray,
        georeference: Georeference,
        frame: LocalFrame,
        name: str,
        vertical_datum: str,
    ) -> Dem:
        """A grid somewhere on the ellipsoid, seen from a local frame.

        Raises TerrainError where a polynomial cannot follow the projection to 1 cm.
        """
        grid_map = fit_grid_map(georeference, frame, _grid_shape(heights, name), name)
        return cls(heights, grid_map, name, vertical_datum)

    @property
    def resolution(self) -> float:
        """The side of a square as large as a cell [m]."""
        return math.sqrt(self.grid_map.cell_area)

    @property
    def extent(self) -> Extent:
        """The box around the outermost samples; a grid that lies askew leaves its corners empty."""
        return self.grid_map.extent

    def heights_at(self, places: FloatArray) -> FloatArray:
        """The ground's height at local places (n, 2 or more) [m], shape (n,).

        NaN outside of the outermost samples and inside of triangles with an unknown corner.
        """
        return heightfield.heights_at(self.heights, self.grid_map.coefficients, self._scaling, as_kernel_points(places))

    def leg_heights(self, starts: FloatArray, ends: FloatArray) -> FloatArray:
        """The smallest and the largest height of legs (n, 3) over the ground, shape (n, 2) [m].

        Exact for the triangulated ground; a long leg's track bulges in the grid by less than 5 cm. NaN where
        a leg touches unknown ground. Negative where it runs below the ground. Legs may be vertical or of no
        length.
        """
        return heightfield.leg_heights(
            self.heights, self.grid_map.coefficients, self._scaling, as_kernel_points(starts), as_kernel_points(ends)
        )

    def raster(self, extent: Extent, cell: float) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Heights on a regular local grid, for pictures.

        Returns heights (rows, columns), east (columns,) and north (rows,), all [m]. Both axes ascend, so row
        0 lies south; NaN outside of the terrain. Raises TerrainError for a grid of more than 50 million
        samples.
        """
        if not cell > 0:
            raise TerrainError(f"{self.name}: a raster of {cell} m cells; the cell must be positive")
        x = np.arange(extent.west, extent.east + 0.5 * cell, cell)
        y = np.arange(extent.south, extent.north + 0.5 * cell, cell)
        if len(x) * len(y) > RASTER_LIMIT:
            raise TerrainError(f"{self.name}: a raster of {len(y)} x {len(x)} samples; take larger cells")
        east, north = np.meshgrid(x, y)
        heights = self.heights_at(np.stack([east.ravel(), north.ravel()], axis=-1))
        return heights.reshape(east.shape), x, y

    def vertices(self) -> FloatArray:
        """The samples in the local frame, row by row, shape (rows * columns, 3) [m]."""
        rows, columns = np.indices(self.heights.shape, dtype=np.float64)
        places = self.grid_map.to_local(np.stack([columns.ravel(), rows.ravel()], axis=-1))
        return np.column_stack([places, self.heights.ravel()])

    def triangles(self) -> FloatArray:
        """The triangles in the local frame, shape (m, 3, 3) [m], without those that have an unknown corner.

        Counter-clockwise seen from above. 72 bytes each: meant for small DEMs.
        """
        rows, columns = self.heights.shape
        first = (np.arange(rows - 1)[:, None] * columns + np.arange(columns - 1)).ravel()
        upper = np.stack([first, first + columns + 1, first + 1], axis=-1)
        lower = np.stack([first, first + columns, first + columns + 1], axis=-1)
        triangles = self.vertices()[np.concatenate([upper, lower])]
        known: FloatArray = triangles[np.isfinite(triangles).all(axis=(1, 2))]
        return known


def _grid_shape(heights: FloatArray, name: str) -> tuple[int, int]:
    """Rows and columns; TerrainError for fewer than two of either."""
    shape = np.shape(heights)
    if len(shape) != 2 or min(shape) < 2:
        raise TerrainError(f"{name}: a height grid needs two rows and two columns, not the shape {shape}")
    return shape[0], shape[1]


def as_kernel_points(places: FloatArray) -> FloatArray:
    """Places as the kernels take them: float64, C order, one a row."""
    return np.ascontiguousarray(np.atleast_2d(places), dtype=np.float64)
