"""Heights and legs over a triangulated grid, against planes, shapely and dense samples."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from gcs_windplan.errors import TerrainError
from gcs_windplan.geo.frame import GeoPoint, LocalFrame
from gcs_windplan.terrain import Dem, Extent, GeographicGrid
from tests.oracles import terrain as naive

CELL = 10.0
ROWS, COLUMNS = 7, 9
one_micrometre = 1e-6
one_millimetre = 1e-3
one_centimetre = 1e-2


def make_dem(seed: int = 0, gaps: tuple[tuple[int, int], ...] = ()) -> Dem:
    heights = np.random.default_rng(seed).uniform(0, 50, (ROWS, COLUMNS))
    for gap in gaps:
        heights[gap] = np.nan
    return Dem.local(heights, 0.0, (ROWS - 1) * CELL, CELL)


def random_legs(dem: Dem, count: int, seed: int) -> tuple[np.ndarray, np.ndarray]:
    rng, box = np.random.default_rng(seed), dem.extent
    low, high = [box.west, box.south, 0.0], [box.east, box.north, 100.0]
    return rng.uniform(low, high, (count, 3)), rng.uniform(low, high, (count, 3))


def single(dem: Dem, start: list[float], end: list[float]) -> tuple[float, float]:
    low, high = dem.leg_heights(np.array([start]), np.array([end]))[0]
    return float(low), float(high)


def test_heights_are_those_of_the_triangles():
    dem = make_dem()
    places, _ = random_legs(dem, 300, 1)
    expected = [naive.grid_height(dem.heights, x / CELL, (dem.extent.north - y) / CELL) for x, y, _ in places]
    np.testing.assert_allclose(dem.heights_at(places), expected, atol=one_micrometre)


def test_heights_at_samples_are_the_samples():
    dem = make_dem()
    np.testing.assert_allclose(dem.heights_at(dem.vertices()), dem.heights.ravel(), atol=one_micrometre)


def test_the_diagonal_runs_from_row_column_to_the_next_row_and_column():
    dem = Dem.local(np.array([[0.0, 0.0], [10.0, 0.0]]), 0.0, 1.0, 1.0)  # north row flat, south-west corner 10
    assert dem.heights_at(np.array([[0.5, 0.5]]))[0] == pytest.approx(0.0, abs=1e-9)
    assert dem.heights_at(np.array([[0.75, 0.75]]))[0] == pytest.approx(0.0, abs=1e-9)
    assert dem.heights_at(np.array([[0.25, 0.25]]))[0] == pytest.approx(5.0)


@pytest.mark.parametrize("seed", range(3))
def test_legs_equal_shapely(seed):
    dem = make_dem(seed)
    starts, ends = random_legs(dem, 150, seed)
    triangles = dem.triangles()
    expected = [naive.leg_heights(triangles, a, b) for a, b in zip(starts, ends, strict=True)]
    np.testing.assert_allclose(dem.leg_heights(starts, ends), expected, atol=one_micrometre)


def test_legs_bound_dense_samples_and_meet_them():
    dem = make_dem(5)
    starts, ends = random_legs(dem, 200, 5)
    for start, end, (low, high) in zip(starts, ends, dem.leg_heights(starts, ends), strict=True):
        points = naive.along(start, end, 5001)
        over = points[:, 2] - dem.heights_at(points)
        steepest = 50 / CELL * 2 + 100 / CELL
        step = np.hypot(*(end - start)[:2]) / 5000 * steepest + abs(end - start)[2] / 5000
        assert low - one_micrometre <= over.min() <= low + step
        assert high - step <= over.max() <= high + one_micrometre


def test_legs_with_unknown_cells_equal_shapely():
    dem = make_dem(7, gaps=((2, 3), (6, 8)))
    starts, ends = random_legs(dem, 200, 7)
    triangles = dem.triangles()
    expected = np.array([naive.leg_heights(triangles, a, b) for a, b in zip(starts, ends, strict=True)])
    assert 0.1 < np.isnan(expected[:, 0]).mean() < 0.9
    np.testing.assert_allclose(dem.leg_heights(starts, ends), expected, atol=one_micrometre)


@pytest.mark.parametrize(
    ("start", "end"),
    [
        ([0, 20, 60], [80, 20, 70]),  # along a row
        ([30, 0, 60], [30, 60, 70]),  # along a column
        ([10, 50, 60], [50, 10, 90]),  # along diagonals
        ([10, 10, 60], [50, 50, 90]),  # across diagonals, through samples
        ([0, 60, 60], [80, 60, 60]),  # northern rim
        ([0, 0, 60], [80, 0, 60]),  # southern rim
        ([80, 0, 60], [80, 60, 60]),  # eastern rim
        ([0, 0, 60], [80, 60, 60]),  # corner to corner
        ([80, 0, 60], [0, 60, 60]),
        ([12, 13, 60], [14, 15, 61]),  # within one triangle
    ],
)
def test_legs_on_the_lines_of_the_grid(start, end):
    dem = make_dem(11)
    start, end = np.array(start, dtype=float), np.array(end, dtype=float)
    expected = naive.leg_heights(dem.triangles(), start, end)
    assert single(dem, list(start), list(end)) == pytest.approx(expected, abs=one_micrometre)
    assert single(dem, list(end), list(start)) == pytest.approx(expected, abs=one_micrometre)


def test_vertical_and_zero_length_legs():
    dem = make_dem()
    ground = float(dem.heights_at(np.array([[33.0, 21.0]]))[0])
    assert single(dem, [33, 21, 90], [33, 21, 70]) == pytest.approx((70 - ground, 90 - ground))
    assert single(dem, [33, 21, 70], [33, 21, 70]) == pytest.approx((70 - ground, 70 - ground))
    assert single(dem, [30, 20, 70], [30, 20, 70])[0] == pytest.approx(70 - dem.heights[4, 3])


@pytest.mark.parametrize(
    ("start", "end"),
    [
        ([-0.1, 20, 60], [30, 20, 60]),
        ([30, 20, 60], [80.1, 20, 60]),
        ([-50, -50, 60], [-40, -40, 60]),
        ([np.nan, 20, 60], [30, 20, 60]),
        ([30, 20, np.nan], [30, 20, 60]),
        ([30, 20, 60], [np.inf, 20, 60]),
    ],
)
def test_legs_outside_are_unknown(start, end):
    assert np.isnan(single(make_dem(), start, end)).all()
    assert np.isnan(single(make_dem(), end, start)).all()


def test_a_leg_that_only_passes_over_a_gap_is_unknown():
    dem = make_dem(gaps=((3, 4),))
    assert np.isnan(single(dem, [15, 30, 90], [75, 30, 90])).all()
    assert not np.isnan(single(dem, [15, 50, 90], [75, 50, 90])).any()


def test_both_directions_agree():
    dem = make_dem(3)
    starts, ends = random_legs(dem, 500, 3)
    there, back = dem.leg_heights(starts, ends), dem.leg_heights(ends, starts)
    np.testing.assert_allclose(there, back, atol=one_micrometre)


@settings(max_examples=50, deadline=None)
@given(lift=st.floats(-500, 500), seed=st.integers(0, 1000))
def test_lifting_a_leg_lifts_its_heights(lift, seed):
    dem = make_dem(2)
    starts, ends = random_legs(dem, 5, seed)
    raised = np.array([0.0, 0.0, lift])
    moved = dem.leg_heights(starts + raised, ends + raised)
    np.testing.assert_allclose(moved, dem.leg_heights(starts, ends) + lift, atol=one_micrometre)


def curved_dem(latitude: float, span: float) -> tuple[Dem, GeographicGrid, LocalFrame]:
    """A geographic grid, curved in the local frame, `span` degrees wide."""
    frame = LocalFrame(GeoPoint(latitude, 10.0))
    step = span / 60
    grid = GeographicGrid(latitude + span / 2, 10.0 - span / 2, step, step, 61)
    heights = np.random.default_rng(4).uniform(0, 500, (61, 61))
    return Dem.georeferenced(heights, grid, frame, "curved", "EGM96"), grid, frame


@pytest.mark.parametrize("latitude", [0.0, 47.0, -65.0])
def test_long_legs_over_a_curved_grid_follow_the_exact_chain(latitude):
    dem, grid, frame = curved_dem(latitude, 0.5)
    slope = 1000 / (0.5 / 60 * 111_000 * np.cos(np.radians(latitude)))
    rng = np.random.default_rng(8)
    reach = 0.6 * dem.extent.east, 0.6 * dem.extent.north
    for _ in range(10):
        start, end = (np.array([*rng.uniform([-reach[0], -reach[1]], reach), 600.0]) for _ in range(2))
        low, high = single(dem, list(start), list(end))
        points = naive.along(start, end, 2001)
        cells = grid.to_grid(*frame.to_geographic(points))
        over = points[:, 2] - [naive.grid_height(dem.heights, c, r) for c, r in cells]
        slack = slope * (0.05 + one_centimetre)  # the bulge of a piece, the error of the polynomial
        step = slope * np.hypot(*(end - start)[:2]) / 2000
        assert low - slack <= over.min() <= low + slack + step
        assert high - slack - step <= over.max() <= high + slack


@pytest.mark.parametrize("far", [1e7, 1e18, 1e300, np.inf])
def test_a_leg_that_ends_far_beyond_a_curved_grid_is_unknown(far):
    dem, _, _ = curved_dem(47.0, 0.5)
    assert np.isnan(single(dem, [0, 0, 600], [far, 0, 600])).all()
    assert np.isnan(single(dem, [0, -far, 600], [0, 0, 600])).all()


def test_the_map_follows_the_exact_chain_to_a_centimetre():
    dem, grid, frame = curved_dem(60.0, 1.0)
    box, rng = dem.extent, np.random.default_rng(3)
    places = rng.uniform([box.west, box.south], [box.east, box.north], (1000, 2))
    exact = grid.to_grid(*frame.to_geographic(places))
    metres = (dem.grid_map.to_grid(places) - exact) * dem.resolution * 2
    assert np.abs(metres).max() < 2 * one_centimetre
    inside = exact[((exact > 0) & (exact < 60)).all(axis=1)]
    back = dem.grid_map.to_local(inside)
    np.testing.assert_allclose(dem.grid_map.to_grid(back), inside, atol=1e-6)


def test_a_map_that_bends_too_much_is_refused():
    frame = LocalFrame(GeoPoint(88.5, 0.0))
    grid = GeographicGrid(89.9, -40.0, 0.05, 1.0, 81)
    with pytest.raises(TerrainError, match=r"polar: .*(bends too much|projection holds)"):
        Dem.georeferenced(np.zeros((50, 81)), grid, frame, "polar", "local")


def test_a_grid_across_the_antimeridian():
    frame = LocalFrame(GeoPoint(-17.0, 180.0))
    grid = GeographicGrid(-16.95, 179.95, 0.001, 0.001, 101)
    dem = Dem.georeferenced(np.tile(np.arange(101.0), (101, 1)), grid, frame, "Fiji", "EGM96")
    east = frame.to_local(-17.0, -179.97)
    assert dem.heights_at(east)[0] == pytest.approx(80.0, abs=one_millimetre)


def test_raster_has_ascending_axes_and_the_same_heights():
    dem = make_dem()
    heights, x, y = dem.raster(Extent(5, 5, 95, 45), 10.0)
    assert heights.shape == (5, 10)
    assert (x[0], x[-1], y[0], y[-1]) == (5, 95, 5, 45)
    assert heights[2, 3] == dem.heights_at(np.array([[35.0, 25.0]]))[0]
    assert np.isnan(heights[:, 8:]).all()


def test_triangles_cover_the_grid_and_face_up():
    dem = make_dem()
    triangles = dem.triangles()
    normals = np.cross(triangles[:, 1] - triangles[:, 0], triangles[:, 2] - triangles[:, 0])
    assert len(triangles) == 2 * (ROWS - 1) * (COLUMNS - 1)
    assert normals[:, 2] == pytest.approx(CELL**2)


def test_a_dem_keeps_its_own_copy_of_the_heights():
    heights = np.zeros((3, 3))
    dem = Dem.local(heights, 0, 0, 1)
    heights[:] = 5
    assert dem.heights.max() == 0


@pytest.mark.parametrize("heights", [np.zeros((1, 5)), np.full((3, 3), np.nan), np.zeros(4)])
def test_what_is_no_grid_is_refused(heights):
    with pytest.raises(TerrainError):
        Dem.local(heights, 0, 0, 1)
