"""The DEM that comes with matplotlib."""

from __future__ import annotations

import subprocess
import sys

import numpy as np
import pytest

from gcs_windplan.errors import TerrainError
from gcs_windplan.geo.frame import GeoPoint, LocalFrame
from gcs_windplan.terrain import SAMPLE_CENTRE, Extent, sample_dem

FRAME = LocalFrame(SAMPLE_CENTRE)
one_centimetre = 1e-2


def test_it_is_the_jacksboro_fault():
    dem = sample_dem(FRAME)
    assert dem.heights.shape == (344, 403)
    assert (dem.heights.min(), dem.heights.max()) == (236, 1076)
    assert dem.resolution == pytest.approx(83, abs=1)
    assert dem.extent.east == pytest.approx(-dem.extent.west, abs=1)


def test_samples_lie_on_whole_multiples_of_three_arc_seconds():
    """As in the National Elevation Dataset; the first at 36° 43' 57" north, 84° 24' 48" west."""
    dem = sample_dem(FRAME)
    rows, columns = np.array([5, 100, 250, 338]), np.array([7, 300, 20, 395])
    places = FRAME.to_local((132237 - 3.0 * rows) / 3600, (-303888 + 3.0 * columns) / 3600)
    cells = dem.grid_map.to_grid(places)
    np.testing.assert_allclose(cells, np.stack([columns, rows], axis=-1), atol=one_centimetre / dem.resolution * 2)


def test_a_part_has_the_same_heights_as_the_whole():
    area = Extent(-2000, -1000, 2500, 1500)
    whole, part = sample_dem(FRAME), sample_dem(FRAME, area)
    assert part.heights.size < 5000
    rng = np.random.default_rng(1)
    places = rng.uniform([area.west, area.south], [area.east, area.north], (500, 2))
    np.testing.assert_allclose(part.heights_at(places), whole.heights_at(places), atol=one_centimetre)
    assert np.isfinite(part.heights_at(places)).all()


def test_elsewhere_it_says_how_far_it_is():
    with pytest.raises(TerrainError, match=r"Jacksboro.* km to the north-west"):
        sample_dem(LocalFrame(GeoPoint(46.8, 9.8)), Extent(-100, -100, 100, 100))


def test_it_needs_neither_rasterio_nor_matplotlib_nor_trimesh():
    code = (
        "import sys; from gcs_windplan.terrain import SAMPLE_CENTRE, sample_dem; "
        "from gcs_windplan.geo.frame import LocalFrame; sample_dem(LocalFrame(SAMPLE_CENTRE)); "
        "print([m for m in ('rasterio', 'matplotlib', 'trimesh') if m in sys.modules])"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "[]"
