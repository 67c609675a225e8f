"""Obstacles against trimesh's proximity, dense samples and shapes whose distances are known."""

from __future__ import annotations

import numpy as np
import pytest
import trimesh
from hypothesis import given, settings
from hypothesis import strategies as st

from gcs_windplan.errors import TerrainError
from gcs_windplan.terrain import Obstacle, Obstacles
from tests.oracles import terrain as naive

one_millimetre = 1e-3
one_nanometre = 1e-9


def box(extents: list[float], centre: list[float], margin: float, name: str = "house") -> Obstacle:
    mesh = trimesh.creation.box(extents=extents)
    mesh.apply_translation(centre)
    return Obstacle(name, mesh.vertices, mesh.faces, margin)


def margin_of(obstacles: Obstacles, start: list[float], end: list[float]) -> float:
    return float(obstacles.leg_margins(np.array([start], dtype=float), np.array([end], dtype=float))[0])


HOUSE = Obstacles([box([20, 10, 8], [0, 0, 4], 3.0)])


@pytest.mark.parametrize(
    ("start", "end", "distance"),
    [
        ([30, 0, 4], [30, 0, 9], 20),  # beside a wall, vertical
        ([-30, 0, 12], [30, 0, 12], 4),  # over the roof
        ([-30, 9, 20], [30, 9, 20], np.hypot(4, 12)),  # beside and above an edge
        ([13, 9, 12], [13, 9, 12], np.sqrt(9 + 16 + 16)),  # a point off a corner
        ([14, 0, 4], [40, 0, 4], 4),  # its end nearest
        ([-30, 0, 30], [0, 0, 11], 3),  # down to the roof
    ],
)
def test_distances_to_a_house(start, end, distance):
    assert margin_of(HOUSE, start, end) == pytest.approx(distance - 3.0)
    assert margin_of(HOUSE, end, start) == pytest.approx(distance - 3.0)


@pytest.mark.parametrize(
    ("start", "end"),
    [
        ([-30, 0, 4], [30, 0, 4]),  # through
        ([0, 0, 4], [30, 0, 4]),  # out of
        ([-2, 1, 3], [2, -1, 5]),  # inside, touching nothing
        ([1, 1, 4], [1, 1, 4]),  # a point inside
        ([-30, 0, 8], [30, 0, 8]),  # along the roof
        ([10, 5, 0], [10, 5, 20]),  # along an edge
    ],
)
@pytest.mark.parametrize("margin", [0.0, 3.0])
def test_a_leg_in_or_at_an_obstacle_is_negative_even_without_margin(start, end, margin):
    house = Obstacles([box([20, 10, 8], [0, 0, 4], margin)])
    assert margin_of(house, start, end) == pytest.approx(-margin - one_millimetre)


def test_each_obstacle_keeps_its_own_margin():
    pair = Obstacles([box([2, 2, 2], [-10, 0, 0], 1.0, "near"), box([2, 2, 2], [20, 0, 0], 15.0, "far")])
    assert margin_of(pair, [0, 0, 0], [0, 0, 0]) == pytest.approx(min(9 - 1, 19 - 15))


def test_no_obstacles():
    none = Obstacles()
    assert len(none) == 0
    assert none.leg_margins(np.zeros((2, 3)), np.ones((2, 3))).tolist() == [np.inf, np.inf]
    assert none.tops_at(np.zeros((2, 2))).tolist() == [-np.inf, -np.inf]


def random_solids(seed: int, count: int) -> list[trimesh.Trimesh]:
    rng, solids = np.random.default_rng(seed), []
    for _ in range(count):
        solid = trimesh.convex.convex_hull(rng.normal(size=(12, 3)) * rng.uniform(2, 9, 3))
        solid.apply_translation(rng.uniform(-40, 40, 3))
        solids.append(solid)
    return solids


@pytest.mark.parametrize("seed", range(3))
def test_margins_bound_sampled_distances_and_meet_them(seed):
    solids, rng = random_solids(seed, 6), np.random.default_rng(seed)
    margins = rng.uniform(0, 4, 6)
    obstacles = Obstacles([Obstacle(f"{k}", s.vertices, s.faces, margins[k]) for k, s in enumerate(solids)])
    starts, ends = rng.uniform(-60, 60, (25, 3)), rng.uniform(-60, 60, (25, 3))
    for start, end, margin in zip(starts, ends, obstacles.leg_margins(starts, ends), strict=True):
        sampled = min(
            naive.sampled_distance(solid, start, end, 400) - own for solid, own in zip(solids, margins, strict=True)
        )
        half_step = np.linalg.norm(end - start) / 399 / 2
        assert margin <= sampled + one_nanometre
        assert margin >= sampled - half_step - one_millimetre


def test_points_inside_equal_trimeshs_contains():
    rng = np.random.default_rng(5)
    knot = trimesh.creation.torus(major_radius=10, minor_radius=4)
    ring = Obstacles([Obstacle("ring", knot.vertices, knot.faces, 0.0)])
    points = rng.uniform([-15, -15, -5], [15, 15, 5], (3000, 3))
    inside = ring.leg_margins(points, points) < 0
    _, distances, _ = trimesh.proximity.closest_point(knot, points)
    clear = distances > 0.01
    np.testing.assert_array_equal(inside[clear], knot.contains(points)[clear])


@settings(max_examples=40, deadline=None)
@given(seed=st.integers(0, 10_000), shift=st.tuples(*[st.floats(-1000, 1000)] * 3))
def test_shifting_everything_changes_nothing(seed, shift):
    rng = np.random.default_rng(seed)
    starts, ends = rng.uniform(-30, 30, (20, 3)), rng.uniform(-30, 30, (20, 3))
    moved = Obstacles([box([20, 10, 8], list(np.array([0, 0, 4]) + shift), 3.0)])
    np.testing.assert_allclose(
        moved.leg_margins(starts + shift, ends + shift), HOUSE.leg_margins(starts, ends), atol=1e-3
    )


def test_tops_around_a_house():
    places = np.array([[0, 0], [12.9, 0], [13.1, 0], [12, 7], [12.2, 7.2], [0, -7.9], [0, -8.1]])
    assert HOUSE.tops_at(places).tolist() == [8, 8, -np.inf, 8, -np.inf, 8, -np.inf]


def test_tops_are_the_highest_surface_within_the_margin():
    for seed in range(4):
        solid = random_solids(seed, 1)[0]
        margin = 1.5 * seed
        obstacles = Obstacles([Obstacle("rock", solid.vertices, solid.faces, margin)])
        rng = np.random.default_rng(seed)
        low, high = solid.bounds
        for x, y in rng.uniform(low[:2] - 2, high[:2] + 2, (30, 2)):
            top = float(obstacles.tops_at(np.array([[x, y]]))[0])
            sampled = naive.disc_top(solid, x, y, margin)
            assert top >= sampled - 1e-6
            if margin > 0 and np.isfinite(sampled):
                assert top <= sampled + 1.0  # as dense as the samples are on a steep face
            if margin == 0:
                ray = naive.ray_heights(solid, np.array([[x, y]]))[0]
                assert top == pytest.approx(-np.inf if np.isnan(ray) else ray, abs=one_millimetre)


def test_a_place_at_its_clear_height_keeps_the_margin():
    rng = np.random.default_rng(2)
    solids = random_solids(2, 5)
    obstacles = Obstacles([Obstacle(f"{k}", s.vertices, s.faces, 4.0) for k, s in enumerate(solids)])
    places = rng.uniform(-50, 50, (2000, 2))
    clear = obstacles.clear_heights_at(places, minimum=1.0)
    near = np.isfinite(clear)
    assert 50 < near.sum() < 1900
    points = np.column_stack([places, clear])[near]
    assert obstacles.leg_margins(points, points).min() >= -1e-6


def test_an_open_mesh_is_refused():
    mesh = trimesh.creation.box(extents=[2, 2, 2])
    with pytest.raises(TerrainError, match=r"shed: the mesh is not closed, 3 of its edges"):
        Obstacle("shed", mesh.vertices, mesh.faces[1:], 1.0)


def test_a_closed_mesh_of_loose_triangles_is_closed():
    mesh = trimesh.creation.box(extents=[2, 2, 2])
    loose = mesh.triangles.reshape(-1, 3)
    assert Obstacle("shed", loose, np.arange(len(loose)).reshape(-1, 3), 1.0).margin == 1.0


@pytest.mark.parametrize("margin", [-1.0, np.nan, np.inf])
def test_a_margin_that_is_none_is_refused(margin):
    with pytest.raises(TerrainError, match="margin"):
        box([1, 1, 1], [0, 0, 0], margin)


def test_obstacles_from_a_file(tmp_path):
    path = tmp_path / "mast.stl"
    trimesh.creation.cylinder(radius=0.5, height=40).export(path)
    mast = Obstacle.read(path, 5.0)
    assert mast.name == "mast.stl"
    assert margin_of(Obstacles([mast]), [10.5, 0, 0], [10.5, 0, 0]) == pytest.approx(5.0, abs=0.01)
