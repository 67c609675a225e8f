"""Mesh terrain and mesh files, against trimesh's rays (embree), the Dem, shapely and dense samples."""

from __future__ import annotations

import numpy as np
import pytest
import trimesh

from gcs_windplan.errors import TerrainError
from gcs_windplan.terrain import Dem, Hill, MeshTerrain, hills, read_mesh
from tests.oracles import terrain as naive

one_micrometre = 1e-6
ray_error = 1e-3  # [m] embree counts in single precision


def boxed(*boxes: tuple[list[float], list[float]]) -> MeshTerrain:
    """A plain of 200 m at height 0 with boxes of (extents, centre) on and over it."""
    plain = trimesh.Trimesh([[-100, -100, 0], [100, -100, 0], [100, 100, 0], [-100, 100, 0]], [[0, 1, 2], [0, 2, 3]])
    parts = [plain]
    for extents, centre in boxes:
        box = trimesh.creation.box(extents=extents)
        box.apply_translation(centre)
        parts.append(box)
    mesh = trimesh.util.concatenate(parts)
    return MeshTerrain(mesh.vertices, mesh.faces, "town")


TOWN = boxed(([20, 20, 30], [0, 0, 15]), ([10, 40, 4], [40, 5, 20]), ([8, 8, 60], [-33.3, -21.7, 30]))


def as_trimesh(terrain: MeshTerrain) -> trimesh.Trimesh:
    return trimesh.Trimesh(terrain.vertices, terrain.faces, process=False)


def bumps(seed: int) -> Dem:
    return Dem.local(np.random.default_rng(seed).uniform(0, 40, (13, 17)), -80.0, 60.0, 10.0)


def meshed(dem: Dem) -> MeshTerrain:
    rows, columns = dem.heights.shape
    first = (np.arange(rows - 1)[:, None] * columns + np.arange(columns - 1)).ravel()
    upper = np.stack([first, first + columns + 1, first + 1], axis=-1)
    lower = np.stack([first, first + columns, first + columns + 1], axis=-1)
    return MeshTerrain(dem.vertices(), np.concatenate([upper, lower]))


def random_legs(count: int, seed: int, reach: float = 59.0) -> tuple[np.ndarray, np.ndarray]:
    rng = np.random.default_rng(seed)
    low, high = [-reach, -reach, 0.0], [reach, reach, 100.0]
    return rng.uniform(low, high, (count, 3)), rng.uniform(low, high, (count, 3))


def single(terrain: MeshTerrain, start: list[float], end: list[float]) -> tuple[float, float]:
    low, high = terrain.leg_heights(np.array([start], dtype=float), np.array([end], dtype=float))[0]
    return float(low), float(high)


@pytest.mark.parametrize("terrain", [TOWN, meshed(bumps(1))])
def test_heights_equal_rays(terrain):
    places, _ = random_legs(2000, 2)
    expected = naive.ray_heights(as_trimesh(terrain), places)
    np.testing.assert_allclose(terrain.heights_at(places), expected, atol=ray_error)


def test_heights_off_the_mesh_are_unknown():
    assert np.isnan(TOWN.heights_at(np.array([[100.5, 0.0], [1e9, 0.0], [np.nan, 0.0]]))).all()
    assert TOWN.heights_at(np.array([[100.0, 100.0]]))[0] == 0.0


@pytest.mark.parametrize("seed", range(3))
def test_a_dem_and_its_mesh_agree(seed):
    dem = bumps(seed)
    starts, ends = random_legs(2000, seed)
    mesh = meshed(dem)
    np.testing.assert_allclose(mesh.leg_heights(starts, ends), dem.leg_heights(starts, ends), atol=one_micrometre)
    np.testing.assert_allclose(mesh.heights_at(starts), dem.heights_at(starts), atol=one_micrometre)


def test_a_dem_and_its_mesh_agree_on_the_lines_of_the_grid():
    dem, rng = bumps(4), np.random.default_rng(4)
    mesh = meshed(dem)
    starts = np.column_stack(
        [10.0 * rng.integers(-8, 9, (500, 1)), 10.0 * rng.integers(-6, 7, (500, 1)), rng.uniform(0, 90, 500)]
    )
    ends = np.column_stack(
        [10.0 * rng.integers(-8, 9, (500, 1)), 10.0 * rng.integers(-6, 7, (500, 1)), rng.uniform(0, 90, 500)]
    )
    np.testing.assert_allclose(mesh.leg_heights(starts, ends), dem.leg_heights(starts, ends), atol=one_micrometre)


def test_legs_equal_shapely():
    mesh = meshed(bumps(6))
    starts, ends = random_legs(60, 6)
    expected = [naive.leg_heights(mesh.triangles, a, b) for a, b in zip(starts, ends, strict=True)]
    np.testing.assert_allclose(mesh.leg_heights(starts, ends), expected, atol=one_micrometre)


def test_legs_over_a_town_bound_dense_rays_and_meet_them():
    starts, ends = random_legs(40, 9)
    mesh = as_trimesh(TOWN)
    for start, end, (low, high) in zip(starts, ends, TOWN.leg_heights(starts, ends), strict=True):
        points = naive.along(start, end, 4001)
        over = points[:, 2] - naive.ray_heights(mesh, points)
        step = abs(end - start)[2] / 4000 + ray_error
        assert low - ray_error <= over.min()
        assert over.max() <= high + ray_error
        # roofs are flat, so away from their rims samples are as good as the truth
        assert over.max() >= high - 2 * step
        assert over.min() <= low + 2 * step


def test_below_an_overhang_is_below_the_ground():
    deck = boxed(([10, 40, 4], [40, 5, 20]))
    assert single(deck, [40, 0, 10], [40, 10, 10]) == pytest.approx((-12, -12))
    assert single(deck, [0, 0, 10], [80, 0, 10]) == pytest.approx((-12, 10))


def test_the_peak_between_two_crossing_surfaces_is_found():
    """A valley between two planes that cross beneath the leg: neither has a corner there."""
    one = [[-10, -5, 10], [10, -5, -10], [10, 5, -10], [-10, 5, 10]]
    other = [[-10, -5, -10], [10, -5, 10], [10, 5, 10], [-10, 5, -10]]
    valley = MeshTerrain(np.array(one + other, dtype=float), np.array([[0, 1, 2], [0, 2, 3], [4, 5, 6], [4, 6, 7]]))
    assert single(valley, [-8, 1, 30], [8, 1, 30]) == pytest.approx((22, 30))
    assert single(valley, [-8, 1, 30], [7, 2, 31])[1] == pytest.approx(30 + 8 / 15)


def test_the_peak_between_many_crossing_surfaces_bounds_and_meets_samples():
    rng = np.random.default_rng(12)
    corners = np.array([[-50.0, -50], [50, -50], [50, 50], [-50, 50]])
    for _ in range(20):
        sheets = [np.column_stack([corners, corners @ rng.uniform(-2, 2, 2) + rng.uniform(-5, 5)]) for _ in range(6)]
        faces = np.concatenate([np.array([[0, 1, 2], [0, 2, 3]]) + 4 * k for k in range(6)])
        terrain = MeshTerrain(np.concatenate(sheets), faces)
        start, end = np.array([*rng.uniform(-49, 49, 2), 200.0]), np.array([*rng.uniform(-49, 49, 2), 220.0])
        low, high = single(terrain, list(start), list(end))
        points = naive.along(start, end, 20_001)
        over = points[:, 2] - terrain.heights_at(points)
        assert low - one_micrometre <= over.min() <= low + 0.02
        assert high - 0.02 <= over.max() <= high + one_micrometre


def test_a_free_wall_is_seen_from_across_and_from_along():
    plain = [[-50, -50, 0], [50, -50, 0], [50, 50, 0], [-50, 50, 0]]
    fence = [[10, -20, 0], [10, 20, 0], [10, 20, 6], [10, -20, 6]]
    faces = np.array([[0, 1, 2], [0, 2, 3], [4, 5, 6], [4, 6, 7]])
    terrain = MeshTerrain(np.array(plain + fence, dtype=float), faces)
    assert single(terrain, [0, 0, 8], [20, 3, 8])[0] == pytest.approx(2)
    assert single(terrain, [10, -30, 8], [10, 30, 8]) == pytest.approx((2, 8))
    assert single(terrain, [10, -10, 8], [10, 10, 10]) == pytest.approx((2, 4))
    assert single(terrain, [0, 30, 8], [20, 30, 8])[0] == pytest.approx(8)


def test_vertical_and_zero_length_legs():
    assert single(TOWN, [1, 2, 90], [1, 2, 50]) == pytest.approx((20, 60))
    assert single(TOWN, [60, -60, 9], [60, -60, 9]) == pytest.approx((9, 9))


def test_legs_off_the_mesh_or_over_holes_are_unknown():
    ring = trimesh.creation.annulus(r_min=5, r_max=20, height=1)
    terrain = MeshTerrain(ring.vertices, ring.faces)
    assert np.isnan(single(terrain, [-10, 0, 9], [10, 0, 9])).all()
    assert np.isnan(single(terrain, [10, 0, 9], [30, 0, 9])).all()
    assert np.isnan(single(terrain, [10, 0, np.nan], [11, 0, 9])).all()
    assert single(terrain, [-10, 8, 9], [10, 8, 9]) == pytest.approx((8.5, 8.5))


@pytest.mark.parametrize("suffix", [".stl", ".obj", ".ply", ".glb"])
def test_files_hold_the_mesh(tmp_path, suffix):
    town = as_trimesh(TOWN)
    path = tmp_path / f"town{suffix}"
    town.export(path)
    terrain = MeshTerrain.read(path)
    places, _ = random_legs(500, 3)
    assert terrain.name == path.name
    np.testing.assert_allclose(terrain.heights_at(places), TOWN.heights_at(places), atol=ray_error)


def test_the_parts_of_a_glb_scene_are_put_where_they_belong(tmp_path):
    scene, box = trimesh.Scene(), trimesh.creation.box(extents=[2, 2, 2])
    for x in (0.0, 10.0):
        scene.add_geometry(box, transform=trimesh.transformations.translation_matrix([x, 0, 5]))
    path = tmp_path / "two.glb"
    scene.export(path)
    vertices, faces = read_mesh(path)
    assert len(faces) == 24
    np.testing.assert_allclose(vertices.min(axis=0), [-1, -1, 4])
    np.testing.assert_allclose(vertices.max(axis=0), [11, 1, 6])


@pytest.mark.parametrize(
    ("name", "content", "message"),
    [
        ("a.stl", None, "no such file"),
        ("a.stl", b"", "not a mesh|no faces"),
        ("a.obj", b"v 0 0 0\nv 1 0 0\n", "no faces|not a mesh"),
        ("a.obj", b"v 0 0 nan\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", "not finite"),
        ("a.glb", b"glTF broken", "not a mesh"),
        ("a.xyz", b"1 2 3", "files named"),
    ],
)
def test_a_file_that_is_no_mesh_is_named(tmp_path, name, content, message):
    path = tmp_path / name
    if content is not None:
        path.write_bytes(content)
    with pytest.raises(TerrainError, match=message) as caught:
        read_mesh(path)
    assert name in str(caught.value)


@pytest.mark.parametrize(
    ("vertices", "faces"),
    [
        (np.zeros((3, 3)), np.zeros((0, 3), dtype=int)),
        (np.zeros((3, 3)), np.array([[0, 1, 3]])),
        (np.full((3, 3), np.nan), np.array([[0, 1, 2]])),
        (np.zeros((3, 2)), np.array([[0, 1, 2]])),
    ],
)
def test_what_is_no_mesh_is_refused(vertices, faces):
    with pytest.raises(TerrainError, match="mesh"):
        MeshTerrain(vertices, faces)


def test_extent_and_resolution():
    mesh = meshed(hills(100.0, 5.0, [Hill(0, 0, 20, 15)]))
    assert (mesh.extent.west, mesh.extent.north) == (-50, 50)
    assert mesh.resolution == pytest.approx(5.0)
