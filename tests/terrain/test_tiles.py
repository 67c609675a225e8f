"""Several tiles of one grid: no step at the seam, no hole in it."""

from __future__ import annotations

import numpy as np
import pytest

from gcs_windplan.errors import TerrainError
from gcs_windplan.geo.frame import GeoPoint, LocalFrame
from gcs_windplan.terrain import Extent, read_dem
from tests.terrain.rasters import FRAME, UTM, from_origin, relief, same_ground, utm_corner, write, write_hgt


@pytest.mark.parametrize("order", [(0, 1, 2, 3), (3, 1, 0, 2)])
def test_touching_utm_tiles_equal_the_single_one(tmp_path, order):
    heights, (x, y) = relief(100, 100), utm_corner()
    whole = write(tmp_path / "whole.tif", heights, UTM, from_origin(x, y, 10, 10))
    quarters = [
        write(
            tmp_path / f"{i}.tif",
            heights[r : r + 50, c : c + 50],
            UTM,
            from_origin(x + 10 * c, y - 10 * r, 10, 10),
        )
        for i, (r, c) in enumerate([(0, 0), (0, 50), (50, 0), (50, 50)])
    ]
    mosaic = read_dem([quarters[i] for i in order], FRAME, Extent(-300, -300, 300, 300))
    same_ground(mosaic, read_dem(whole, FRAME), 290.0)


def test_touching_geographic_tiles_equal_the_single_one(tmp_path):
    heights, step = relief(100, 100), 1 / 7200
    west, north = 9 - 50 * step, 47 + 50 * step
    whole = write(tmp_path / "whole.tif", heights, "EPSG:4326", from_origin(west, north, step, step))
    left = write(tmp_path / "a.tif", heights[:, :50], "EPSG:4326", from_origin(west, north, step, step))
    right = write(tmp_path / "b.tif", heights[:, 50:], "EPSG:4326", from_origin(9.0, north, step, step))
    mosaic = read_dem([right, left], FRAME)
    np.testing.assert_array_equal(mosaic.heights, read_dem(whole, FRAME).heights)
    same_ground(mosaic, read_dem(whole, FRAME), 400.0)


def test_hgt_tiles_share_their_edge(tmp_path):
    ground = (np.arange(2401)[None, :] % 700 + np.arange(1201)[:, None] % 300 + 100).astype(np.int16)
    west = write_hgt(tmp_path / "N47E008.hgt", ground[:, :1201])
    east = write_hgt(tmp_path / "N47E009.hgt", ground[:, 1200:])
    frame = LocalFrame(GeoPoint(47.5, 9.0))
    area = Extent(-2000, -2000, 2000, 2000)
    dem = read_dem([east, west], frame, area)
    row = dem.heights.shape[0] // 2
    steps = np.diff(dem.heights[row])
    assert ((steps == 1) | (steps == -699)).all()
    assert dem.heights_at(np.zeros((1, 2)))[0] == pytest.approx(ground[600, 1200], abs=0.01)
    alone = read_dem(east, frame, area)
    places = np.array([[100.0, 50.0], [900.0, -700.0]])
    np.testing.assert_allclose(dem.heights_at(places), alone.heights_at(places), atol=0.01)
    assert np.isnan(alone.heights_at(np.array([[-100.0, 0.0]])))[0]


def test_hgt_voids_are_filled_by_the_tile_that_knows(tmp_path):
    ground = np.full((1201, 1201), 250, dtype=np.int16)
    holes = ground.copy()
    holes[:, 1200] = -32768
    holes[600, 1100] = -32768
    west, east = (
        write_hgt(tmp_path / "N47E008.hgt", holes),
        write_hgt(tmp_path / "N47E009.hgt", ground),
    )
    dem = read_dem([west, east], LocalFrame(GeoPoint(47.5, 9.0)))
    assert np.isnan(dem.heights).sum() == 1
    assert np.isnan(dem.heights[600, 1100])
    assert np.nanmin(dem.heights) == 250


def test_hgt_tiles_across_the_antimeridian(tmp_path):
    west = write_hgt(tmp_path / "S17E179.hgt", np.full((1201, 1201), 100))
    east = write_hgt(tmp_path / "S17W180.hgt", np.full((1201, 1201), 100))
    frame = LocalFrame(GeoPoint(-16.5, 180.0))
    dem = read_dem([west, east], frame, Extent(-5000, -5000, 5000, 5000))
    places = np.column_stack([np.linspace(-4900, 4900, 50), np.zeros(50)])
    np.testing.assert_allclose(dem.heights_at(places), 100)


def test_tiles_on_different_grids_are_refused(tmp_path):
    heights, (x, y) = relief(20, 20), utm_corner()
    first = write(tmp_path / "first.tif", heights, UTM, from_origin(x, y, 10, 10))
    coarse = write(tmp_path / "coarse.tif", heights, UTM, from_origin(x, y, 20, 20))
    shifted = write(tmp_path / "shifted.tif", heights, UTM, from_origin(x + 203, y, 10, 10))
    other = write(tmp_path / "other.tif", heights, "EPSG:32633", from_origin(x, y, 10, 10))
    for second, what in (
        (coarse, "another grid"),
        (shifted, "0.30 cells apart"),
        (other, "another projection"),
    ):
        with pytest.raises(TerrainError, match=rf"{second.name}: .*{what}.*gdalwarp"):
            read_dem([first, second], FRAME)
