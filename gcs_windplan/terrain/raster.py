"""Height grids from files: GeoTIFF, SRTM's HGT (zipped or not), and whatever else GDAL reads.

Tiles of one grid are put together as they are, without resampling: tiles that share an edge row or column
(HGT) overlap in it, tiles that touch (most GeoTIFFs) leave one cell between their outermost samples, which is
triangulated like any other.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from rasterio.errors import RasterioError
from rasterio.warp import transform as warp

from gcs_windplan.arrays import FloatArray
from gcs_windplan.errors import TerrainError
from gcs_windplan.geo.frame import LocalFrame
from gcs_windplan.terrain.dem import Dem
from gcs_windplan.terrain.rastertile import RasterTile, describe, file_error
from gcs_windplan.terrain.surface import Extent
from gcs_windplan.terrain.window import Window, covering_window

LARGEST = 200_000_000  # [samples] 1.6 GB
SAME_GRID = 0.01  # [cells] the most by which the samples of tiles of one grid may be apart


@dataclass(frozen=True, slots=True, eq=False)
class ProjectedGrid:
    """A `Georeference` by a coordinate reference system and an affine transform, both through PROJ."""

    crs: Any
    transform: tuple[float, float, float, float, float, float]
    columns: int

    def to_grid(self, latitude_deg: FloatArray, longitude_deg: FloatArray) -> FloatArray:
        """Columns and rows of WGS 84 places, shape (n, 2); inf where the projection does not reach."""
        a, b, c, d, e, f = self.transform
        x, y = _warped("EPSG:4326", self.crs, longitude_deg, latitude_deg)
        turn = full_turn(self.crs)
        if turn < math.inf:
            west = c + 0.5 * self.columns * a - turn / 2
            x = (x - west) % turn + west
        column, row = (
            (e * (x - c) - b * (y - f)) / (a * e - b * d),
            (a * (y - f) - d * (x - c)) / (a * e - b * d),
        )
        return np.stack([column - 0.5, row - 0.5], axis=-1)

    def to_geographic(self, places: FloatArray) -> tuple[FloatArray, FloatArray]:
        """WGS 84 latitudes and longitudes [deg] of columns and rows (n, 2)."""
        a, b, c, d, e, f = self.transform
        column, row = places[:, 0] + 0.5, places[:, 1] + 0.5
        longitude, latitude = _warped(self.crs, "EPSG:4326", a * column + b * row + c, d * column + e * row + f)
        return latitude, longitude


def read_dem(
    paths: str | Path | Sequence[str | Path],
    frame: LocalFrame,
    area: Extent | None = None,
    nodata: float | None = None,
    vertical_datum: str | None = None,
) -> Dem:
    """The terrain in raster files of one grid, the part that covers `area` and a few cells around it.

    Without an area, all of it. The first band counts; where tiles overlap the first that knows a height.
    Unknown, and NaN, is what the file's mask or nodata value says, what equals `nodata` (as stored, before
    scale and offset) and what is no finite number. Heights in feet become metres. `vertical_datum` overrides
    what the file says.

    Raises TerrainError, with the file, for files that are missing, damaged, without a projection or in
    unknown units, for tiles on different grids, and if nothing covers the area: then with how far away the
    terrain is.
    """
    paths = [paths] if isinstance(paths, str | Path) else list(paths)
    if not paths:
        raise TerrainError("no DEM file was named")
    tiles = [describe(Path(path)) for path in paths]
    places = [_place(tile, tiles[0]) for tile in tiles]
    first_row, first_column = min(row for row, _ in places), min(column for _, column in places)
    places = [(row - first_row, column - first_column) for row, column in places]
    rows = max(row + tile.shape[0] for tile, (row, _) in zip(tiles, places, strict=True))
    columns = max(column + tile.shape[1] for tile, (_, column) in zip(tiles, places, strict=True))
    name = ", ".join(tile.name for tile in tiles)
    whole = _part(tiles[0], Window(first_row, first_column, rows, columns))
    window = Window(0, 0, rows, columns)
    if area is not None:
        window = covering_window(whole, frame, area, (rows, columns), name)
    if window.rows * window.columns > LARGEST:
        raise TerrainError(f"{name}: {window.rows} x {window.columns} heights are too many; give a smaller area")
    heights = _mosaic(tiles, places, window, nodata)
    part = _part(tiles[0], Window(first_row + window.row, first_column + window.column, window.rows, window.columns))
    datum = tiles[0].vertical_datum if vertical_datum is None else vertical_datum
    return Dem.georeferenced(heights, part, frame, name, datum)


def full_turn(crs: Any) -> float:
    """360° in the unit of a geographic projection, inf for the others."""
    return 2 * math.pi / float(crs.units_factor[1]) if crs.is_geographic else math.inf


def _part(tile: RasterTile, window: Window) -> ProjectedGrid:
    """The grid of a block counted from a tile's first sample."""
    a, b, c, d, e, f = tile.transform
    x, y = c + a * window.column + b * window.row, f + d * window.column + e * window.row
    return ProjectedGrid(tile.crs, (a, b, x, d, e, y), window.columns)


def _place(tile: RasterTile, first: RasterTile) -> tuple[int, int]:
    """Row and column of a tile's first sample, counted from the first tile's; TerrainError if none."""
    if tile.crs != first.crs:
        raise file_error(tile.path, f"another projection than {first.path.name}; {_advice(first)}")
    a, b, c, d, e, f = first.transform
    size = max(*tile.shape, *first.shape)
    cell = max(abs(a), abs(b), abs(d), abs(e))
    drift = max(abs(tile.transform[k] - first.transform[k]) for k in (0, 1, 3, 4)) * size / cell
    dx, dy = tile.transform[2] - c, tile.transform[5] - f
    turn = full_turn(tile.crs)
    if turn < math.inf:
        dx = (dx + turn / 2) % turn - turn / 2
    column, row = (e * dx - b * dy) / (a * e - b * d), (a * dy - d * dx) / (a * e - b * d)
    apart = max(abs(column - round(column)), abs(row - round(row)))
    if drift > SAME_GRID or apart > SAME_GRID:
        raise file_error(
            tile.path,
            f"another grid than {first.path.name} (cells of {tile.transform[0]:.9g} against {a:.9g}, "
            f"samples {apart:.2f} cells apart); {_advice(first)}",
        )
    return round(row), round(column)


def _advice(first: RasterTile) -> str:
    return f"bring all tiles onto one grid: gdalwarp -t_srs {first.crs.to_string()[:40]} ... one.tif"


def _mosaic(
    tiles: Sequence[RasterTile], places: Sequence[tuple[int, int]], window: Window, nodata: float | None
) -> FloatArray:
    """The heights of a block of all tiles together, NaN where none knows."""
    heights = np.full((window.rows, window.columns), np.nan)
    for tile, (row, column) in zip(tiles, places, strict=True):
        top, left = max(row, window.row), max(column, window.column)
        bottom = min(row + tile.shape[0], window.row + window.rows)
        right = min(column + tile.shape[1], window.column + window.columns)
        if bottom <= top or right <= left:
            continue
        block = tile.read(Window(top - row, left - column, bottom - top, right - left), nodata)
        own = heights[top - window.row : bottom - window.row, left - window.column : right - window.column]
        np.copyto(own, block, where=np.isnan(own))
    return heights


def _warped(source: Any, target: Any, x: FloatArray, y: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Coordinates in another reference system, x before y in each; inf where it does not reach."""
    try:
        xs, ys = warp(source, target, x.tolist(), y.tolist())
    except RasterioError as error:
        raise TerrainError(f"PROJ cannot lead from {source} to {target} ({error})") from error
    return np.asarray(xs, dtype=np.float64), np.asarray(ys, dtype=np.float64)
