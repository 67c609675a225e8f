"""Height grids from files: real ones, and small ones written by rasterio with every trap in them."""

from __future__ import annotations

import zipfile
from pathlib import Path

import numpy as np
import pytest
import rasterio
from affine import Affine
from rasterio.warp import transform as warp

from gcs_windplan.errors import TerrainError
from gcs_windplan.geo.frame import GeoPoint, LocalFrame
from gcs_windplan.terrain import Extent, read_dem
from gcs_windplan.units import INTERNATIONAL_FOOT, US_SURVEY_FOOT
from tests.terrain.rasters import FRAME, UTM, from_origin, relief, same_ground, utm_corner, write

DATA = Path(__file__).resolve().parents[2].parent / "shared" / "data" / "dem"
one_millimetre = 1e-3
one_centimetre = 1e-2
two_metres = 2.0


def stored(name: str) -> Path:
    path = DATA / name
    if not path.exists():
        pytest.skip(f"{path} is not on this machine")
    return path


def centres(path: str | Path, frame: LocalFrame) -> tuple[np.ndarray, np.ndarray]:
    """Local places of pixel centres and the values there, by rasterio's own transform."""
    with rasterio.open(path) as file:
        values = file.read(1, masked=True).astype(float).filled(np.nan)
        rows, columns = np.indices(values.shape)
        xs, ys = rasterio.transform.xy(file.transform, rows.ravel(), columns.ravel())
        longitude, latitude = warp(file.crs, "EPSG:4326", list(xs), list(ys))
    return frame.to_local(np.array(latitude), np.array(longitude)), values


def steepest(values: np.ndarray, cell: float) -> float:
    return float(max(np.nanmax(np.abs(np.diff(values, axis=k))) for k in (0, 1)) / cell)


# Real files


def test_arducopters_home_at_cmac_is_584_metres():
    """ArduPilot, Tools/autotest/locations.txt: CMAC=-35.363262,149.165237,584,353."""
    frame = LocalFrame(GeoPoint(-35.363262, 149.165237))
    dem = read_dem(stored("S36E149.hgt.zip"), frame, Extent(-3000, -3000, 3000, 3000))
    assert dem.heights_at(np.zeros((1, 2)))[0] == pytest.approx(584, abs=two_metres)
    assert dem.vertical_datum == "EGM96"
    assert dem.resolution == pytest.approx(83.7, abs=0.5)  # 3 arc-seconds: 92.5 m by 75.7 m
    assert max(dem.heights.shape) < 100  # only the window was read


@pytest.mark.parametrize(
    ("name", "origin"),
    [
        ("davosdorf.tif", GeoPoint(46.818, 9.828)),
        ("big_butte.tif", GeoPoint(43.387, -113.024)),
        ("wn_some_nodata.tif", GeoPoint(43.9, -113.6)),
        ("wn_geog_epsg4326.tif", GeoPoint(43.9, -113.6)),
        ("S36E149.hgt.zip", GeoPoint(-35.5, 149.5)),
    ],
)
def test_pixel_centres_have_the_pixels_heights(name, origin):
    path, frame = stored(name), LocalFrame(origin)
    dem = read_dem(path, frame)
    places, values = centres(path, frame)
    inner = np.zeros(values.shape, dtype=bool)
    inner[1:-1, 1:-1] = True
    got, want = dem.heights_at(places)[inner.ravel()], values[inner]
    known = np.isfinite(got)
    assert known.sum() > 0.98 * known.size
    tolerance = one_centimetre * 2 * steepest(values, dem.resolution) + one_millimetre
    assert np.abs(got - want)[known].max() < tolerance


def test_nodata_cells_are_unknown():
    dem = read_dem(stored("wn_some_nodata.tif"), LocalFrame(GeoPoint(43.9, -113.6)))
    assert np.isnan(dem.heights).sum() == 10
    assert np.nanmin(dem.heights) > 1000


def test_a_terrain_far_away_says_how_far():
    frame = LocalFrame(GeoPoint(43.9, -113.0))
    with pytest.raises(TerrainError, match=r"wn_some_nodata\.tif: covers latitude 43\.778.* 37\.\d km to the west"):
        read_dem(stored("wn_some_nodata.tif"), frame, Extent(-100, -100, 100, 100))
    with pytest.raises(TerrainError, match=r"davosdorf\.tif: .* km to the north"):
        read_dem(stored("davosdorf.tif"), LocalFrame(GeoPoint(-35.0, 149.0)), Extent(-100, -100, 100, 100))


# What a file may say


def test_area_or_point_moves_nothing(tmp_path):
    """GDAL moves the transform of a PixelIsPoint file by half a pixel, so the samples stay where they are."""
    heights, (x, y) = relief(100, 100), utm_corner()
    transform = from_origin(x, y, 10, 10)
    area = write(tmp_path / "area.tif", heights, UTM, transform, tags={"AREA_OR_POINT": "Area"})
    point = write(tmp_path / "point.tif", heights, UTM, transform, tags={"AREA_OR_POINT": "Point"})
    with rasterio.open(point) as file:
        assert file.tags()["AREA_OR_POINT"] == "Point"
        assert file.transform == transform
    same_ground(read_dem(area, FRAME), read_dem(point, FRAME), 300.0)


@pytest.mark.parametrize(
    ("unit", "factor"),
    [("m", 1), ("metre", 1), ("ft", INTERNATIONAL_FOOT), ("US survey foot", US_SURVEY_FOOT)],
)
def test_feet_become_metres(tmp_path, unit, factor):
    x, y = utm_corner()
    flat = np.full((30, 30), 1000, dtype=np.float32)
    path = write(tmp_path / "dem.tif", flat, UTM, from_origin(x, y, 40, 40), units=[unit])
    np.testing.assert_allclose(read_dem(path, FRAME).heights, 1000 * factor, rtol=1e-12)


def test_an_unknown_unit_is_refused(tmp_path):
    x, y = utm_corner()
    path = write(tmp_path / "dem.tif", relief(30, 30), UTM, from_origin(x, y, 40, 40), units=["fathom"])
    with pytest.raises(TerrainError, match=r"dem\.tif: heights in 'fathom'"):
        read_dem(path, FRAME)


def test_scale_offset_and_nodata_as_stored(tmp_path):
    x, y = utm_corner()
    raw = np.full((30, 30), 5000, dtype=np.int16)
    raw[3, 4], raw[5, 6] = -9999, 0
    path = write(
        tmp_path / "dem.tif",
        raw,
        UTM,
        from_origin(x, y, 40, 40),
        nodata=-9999,
        scales=[0.1],
        offsets=[20.0],
    )
    dem = read_dem(path, FRAME)
    assert np.isnan(dem.heights).sum() == 1
    assert dem.heights[0, 0] == pytest.approx(520.0)
    assert dem.heights[5, 6] == pytest.approx(20.0)
    also = read_dem(path, FRAME, nodata=0)
    assert np.isnan(also.heights).sum() == 2


def test_infinite_heights_are_unknown(tmp_path):
    x, y = utm_corner()
    heights = relief(30, 30)
    heights[1, 1], heights[2, 2] = np.inf, np.nan
    dem = read_dem(write(tmp_path / "dem.tif", heights, UTM, from_origin(x, y, 40, 40)), FRAME)
    assert np.isnan(dem.heights).sum() == 2


def test_a_compound_projection_names_the_vertical_datum(tmp_path):
    x, y = utm_corner()
    path = write(tmp_path / "dem.tif", relief(30, 30), "EPSG:32632+5773", from_origin(x, y, 40, 40))
    assert "EGM96" in read_dem(path, FRAME).vertical_datum
    assert read_dem(path, FRAME, vertical_datum="mine").vertical_datum == "mine"


def test_the_vertical_datum_is_as_in_the_file_otherwise(tmp_path):
    x, y = utm_corner()
    path = write(tmp_path / "dem.tif", relief(30, 30), UTM, from_origin(x, y, 40, 40))
    assert read_dem(path, FRAME).vertical_datum == "as in dem.tif"


def test_the_first_of_several_bands_is_read_and_said(tmp_path):
    x, y = utm_corner()
    bands = np.stack([relief(30, 30), relief(30, 30) + 5000])
    dem = read_dem(write(tmp_path / "dem.tif", bands, UTM, from_origin(x, y, 40, 40)), FRAME)
    assert dem.name == "dem.tif (band 1 of 2)"
    assert dem.heights.max() < 1000


def test_a_rotated_grid(tmp_path):
    x, y = utm_corner()
    cos, sin = 10 * np.cos(np.radians(30)), 10 * np.sin(np.radians(30))
    turned = Affine(cos, -sin, x + 500, -sin, -cos, y + 300)
    path = write(tmp_path / "dem.tif", relief(80, 80), UTM, turned)
    dem = read_dem(path, FRAME)
    places, values = centres(path, FRAME)
    inner = np.zeros(values.shape, dtype=bool)
    inner[1:-1, 1:-1] = True
    slope = steepest(values, 10.0)
    np.testing.assert_allclose(dem.heights_at(places)[inner.ravel()], values[inner], atol=2 * slope * one_centimetre)


def test_a_zip_with_a_geotiff(tmp_path):
    x, y = utm_corner()
    path = write(tmp_path / "dem.tif", relief(30, 30), UTM, from_origin(x, y, 40, 40))
    with zipfile.ZipFile(tmp_path / "dem.zip", "w") as archive:
        archive.write(path, "inside/dem.tif")
    np.testing.assert_array_equal(read_dem(tmp_path / "dem.zip", FRAME).heights, read_dem(path, FRAME).heights)
