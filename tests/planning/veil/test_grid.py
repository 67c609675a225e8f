"""The uniform veil and the roadmap."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from gcs_windplan.planning.veil import breaches_around, grid_steps, lay_grid, lay_prm
from gcs_windplan.scene import Clearance
from gcs_windplan.terrain import Obstacle, Obstacles
from tests.worlds import AREA, over_ground, rough_dem, rules_over


@pytest.mark.parametrize("neighbours", [8, 16, 32, 64])
def test_steps_are_the_nearest_directions(neighbours):
    steps = grid_steps(neighbours, layered=False)
    assert len(steps) == neighbours
    angles = np.degrees(np.arctan2(steps[:, 1], steps[:, 2]))
    assert len(np.unique(np.round(angles, 6))) == neighbours  # no two in the same direction
    half = len(steps) // 2
    assert (steps[half:] == -steps[:half]).all()


def test_layers_add_18_steps():
    assert len(grid_steps(16, layered=True)) == 16 + 18


@settings(max_examples=20, deadline=None)
@given(seed=st.integers(0, 1000), neighbours=st.sampled_from([8, 16, 32, 64]), layers=st.integers(1, 3))
def test_legal_bits_equal_legs_judged_one_by_one(seed, neighbours, layers):
    dem = rough_dem(seed, relief=90.0)
    heights = tuple(40.0 + 30 * i for i in range(layers))
    veil = lay_grid(rules_over(dem, 25.0, 115.0), AREA, 225.0, heights, neighbours)
    half = len(veil.steps) // 2
    shape = veil.heights.shape
    points = veil.points
    for node in range(veil.size):
        at = np.array(np.unravel_index(node, shape))
        for k in range(half):
            to = at + veil.steps[k]
            inside = ((to >= 0) & (to < shape)).all()
            bit = bool(int(veil.legal[node]) >> k & 1)
            if not inside:
                assert not bit
                continue
            other = int(np.ravel_multi_index(to, shape))
            assert bit == (veil.clearance.breaches(points[[node]], points[[other]])[0] == 0)


def test_nodes_hang_at_the_layers_height():
    dem = rough_dem(1)
    veil = lay_grid(rules_over(dem), AREA, 100.0, (40.0, 90.0), 8)
    points = veil.points
    above = points[:, 2] - dem.heights_at(points)
    half = veil.size // 2
    assert above[:half] == pytest.approx(40.0)
    assert above[half:] == pytest.approx(90.0)
    assert points[:, 0].min() == pytest.approx(-900.0)
    assert points[:, 1].max() == pytest.approx(900.0)


def test_near_finds_all_layers():
    veil = lay_grid(rules_over(rough_dem(1)), AREA, 100.0, (40.0, 90.0), 8)
    near = veil.near(np.array([20.0, -30.0, 0.0]), 200.0)
    flat = np.linalg.norm(veil.points[:, :2] - (20.0, -30.0), axis=1)
    assert set(near) == set(np.flatnonzero(flat <= 200.0))


def _box(width: float, height: float) -> tuple[np.ndarray, np.ndarray]:
    import trimesh

    box = trimesh.creation.box((width, width, height))
    box.apply_translation((0, 0, height / 2))
    return np.array(box.vertices), np.array(box.faces, dtype=np.int64)


def test_nodes_inside_an_obstacle_are_lifted_above_it():
    """Paper, section 3: vertices which lie inside obstacles are elevated above them."""
    dem = rough_dem(1, relief=0.0)
    tower = Obstacle("tower", *_box(150.0, 80.0), 10.0)
    rules = Clearance(dem, 20.0, np.inf, Obstacles([tower]))
    veil = lay_grid(rules, AREA, 50.0, (40.0,), 8)
    points = veil.points
    over = (np.abs(points[:, :2]) < 75.0).all(axis=1)
    assert over.sum() == 9
    assert points[over, 2] == pytest.approx(100.0)  # top and clearance
    far = (np.abs(points[:, :2]) > 90.0).any(axis=1)
    assert points[far, 2] == pytest.approx(40.0)
    low = np.array([[-400.0, 0, 40]]), np.array([[400.0, 0, 40]])
    assert rules.breaches(*low)[0] == 8
    beside = np.array([[-400.0, 90, 40]]), np.array([[400.0, 90, 40]])
    assert rules.breaches(*beside)[0] == 0


@pytest.mark.parametrize("seed", range(5))
def test_roadmap_joins_all_pairs_within_the_radius(seed):
    dem = rough_dem(seed, relief=80.0)
    sites = np.stack([over_ground(dem, -800, -800, 40), over_ground(dem, 800, 800, 40)])
    veil = lay_prm(rules_over(dem, 25.0, 100.0), AREA, 120, seed, (40.0, 80.0), sites)
    assert veil.size == 2 + 2 * 120
    assert (veil.points[:2] == sites).all()
    for node in range(veil.size):
        distance = np.linalg.norm(veil.points - veil.points[node], axis=1)
        near = np.flatnonzero((distance <= veil.radius) & (np.arange(veil.size) != node))
        starts = np.broadcast_to(veil.points[node], (len(near), 3))
        clear = near[veil.clearance.breaches(starts, veil.points[near]) == 0]
        assert (veil.neighbours[veil.first[node] : veil.first[node + 1]] == clear).all()


def test_roadmap_is_the_same_for_the_same_seed():
    dem = rough_dem(1)
    sites = np.stack([over_ground(dem, -800, -800, 40), over_ground(dem, 800, 800, 40)])
    one, two, other = (lay_prm(rules_over(dem), AREA, 100, seed, (40.0,), sites) for seed in (5, 5, 6))
    assert (one.points == two.points).all()
    assert not (one.points == other.points).all()


def test_breaches_around_lists_every_leg():
    veil = lay_grid(rules_over(rough_dem(2, relief=120.0), 25.0, 110.0), AREA, 300.0, (50.0,), 8)
    middle = np.array([veil.size // 2])
    led, flags = breaches_around(veil, middle)
    assert len(led) == 8
    assert len(flags) == 8
