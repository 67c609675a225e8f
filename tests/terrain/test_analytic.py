"""Terrain from formulas."""

from __future__ import annotations

import numpy as np
import pytest

from gcs_windplan.errors import TerrainError
from gcs_windplan.terrain import Hill, flat, hills


def test_a_hill_has_its_height_and_radius():
    dem = hills(400.0, 2.0, [Hill(20, -10, 50, 30)], altitude=100.0)
    top, flank = dem.heights_at(np.array([[20.0, -10.0], [50.0, -10.0]]))
    assert top == pytest.approx(150.0)
    assert flank == pytest.approx(100 + 50 * np.exp(-0.5))


def test_hills_add_up_and_hollows_dig():
    dem = hills(100.0, 10.0, [Hill(0, 0, 50, 30), Hill(0, 0, -20, 30)])
    assert dem.heights_at(np.zeros((1, 2)))[0] == pytest.approx(30.0)


def test_the_origin_is_in_the_middle():
    box = hills((300.0, 100.0), 10.0, ()).extent
    assert (box.west, box.south, box.east, box.north) == (-150, -50, 150, 50)


def test_a_plain():
    dem = flat((300.0, 120.0), 42.0)
    assert (dem.extent.west, dem.extent.north) == (-150, 60)
    legs = np.array([[-100.0, -50, 100]]), np.array([[100.0, 50, 60]])
    assert dem.leg_heights(*legs)[0] == pytest.approx((18, 58))


@pytest.mark.parametrize(("size", "cell"), [(100.0, 0.0), (0.0, 1.0), (10.0, 20.0), (1e6, 1.0)])
def test_sizes_that_make_no_grid_are_refused(size, cell):
    with pytest.raises(TerrainError, match="no grid"):
        hills(size, cell, ())


def test_a_plain_without_size_is_refused():
    with pytest.raises(TerrainError, match="plain"):
        flat(0.0)


def test_a_hill_without_a_radius_is_refused():
    with pytest.raises(TerrainError, match="radius"):
        Hill(0, 0, 10, 0)
