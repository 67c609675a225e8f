"""The paper's sampled test beside the exact one: where they agree, and where samples pass through."""

from __future__ import annotations

import pickle

import numpy as np
import pytest

from gcs_windplan.errors import InputError
from gcs_windplan.paper.sampled import SampledTest, sampled_collisions
from gcs_windplan.scene.clearance import TOO_LOW, Clearance
from gcs_windplan.terrain import Dem, Hill, MeshTerrain, hills
from tests.oracles import terrain as naive


def ridge() -> Dem:
    """A plain with a ridge 40 m high that is 2 m wide at its foot, running north."""
    heights = np.zeros((41, 101))
    heights[:, 50] = 40.0
    return Dem.local(heights, -50.0, 20.0, 1.0, "ridge")


ACROSS = np.array([[-20.3, 1.2, 30.0]]), np.array([[20.4, 1.7, 30.0]])


def test_samples_pass_through_a_thin_ridge_and_the_exact_test_does_not():
    dem = ridge()
    assert not sampled_collisions(dem, *ACROSS, step=2.0)[0]
    assert dem.leg_heights(*ACROSS)[0, 0] == pytest.approx(-10.0, abs=0.01)


def test_fine_samples_see_the_ridge():
    assert sampled_collisions(ridge(), *ACROSS, step=0.01)[0]


def test_a_leg_wholly_below_the_ground_meets_nothing():
    """The paper's method asks for a common point with the surface only."""
    dem = hills(100.0, 5.0, ())
    starts, ends = np.array([[-20.0, 0, -5.0]]), np.array([[20.0, 3.0, -5.0]])
    assert not sampled_collisions(dem, starts, ends, step=0.5)[0]
    assert dem.leg_heights(starts, ends)[0, 0] == pytest.approx(-5.0)


def test_fine_samples_and_the_exact_test_agree_over_hills():
    dem = hills(200.0, 10.0, [Hill(0, 0, 60, 30), Hill(50, -40, 30, 20)])
    rng = np.random.default_rng(1)
    starts = np.column_stack([rng.uniform(-95, 95, (400, 2)), np.zeros(400)])
    ends = np.column_stack([rng.uniform(-95, 95, (400, 2)), np.zeros(400)])
    starts[:, 2], ends[:, 2] = (dem.heights_at(p) + rng.uniform(3, 20, 400) for p in (starts, ends))
    low = dem.leg_heights(starts, ends)[:, 0]
    hit = sampled_collisions(dem, starts, ends, step=0.05)
    clear = np.abs(low) > 1.0
    np.testing.assert_array_equal(hit[clear], low[clear] < 0)
    assert 0.1 < hit.mean() < 0.9


def test_every_sampled_collision_is_near_a_real_one():
    dem = hills(200.0, 10.0, [Hill(0, 0, 60, 30)])
    rng = np.random.default_rng(2)
    starts = np.column_stack([rng.uniform(-95, 95, (500, 2)), rng.uniform(5, 70, 500)])
    ends = np.column_stack([rng.uniform(-95, 95, (500, 2)), rng.uniform(5, 70, 500)])
    hit = sampled_collisions(dem, starts, ends, step=1.0)
    assert dem.leg_heights(starts, ends)[hit, 0].max() < 10 * np.sqrt(1e-3)


def test_the_kernel_equals_the_equations():
    rng = np.random.default_rng(3)
    triangles = rng.uniform(0, 10, (40, 3, 3))
    starts, ends = rng.uniform(0, 10, (60, 3)), rng.uniform(0, 10, (60, 3))
    step, tolerance = 0.3, 0.01
    expected = []
    for start, end in zip(starts, ends, strict=True):
        length = np.linalg.norm(end - start)
        points = [start + (end - start) * min(k * step / length, 1) for k in range(int(np.ceil(length / step)) + 1)]
        low, high = np.minimum(start, end), np.maximum(start, end)
        near = [t for t in triangles if (t.max(axis=0) >= low).all() and (t.min(axis=0) <= high).all()]
        expected.append(any(naive.areas_meet(t, p, tolerance) for t in near for p in points))
    assert 0 < sum(expected) < 60
    np.testing.assert_array_equal(sampled_collisions(triangles, starts, ends, step, tolerance), expected)


def test_a_triangle_larger_than_the_box_of_the_nodes_is_met():
    """Equation (5) as printed asks for its vertices between the nodes, and would miss it."""
    triangle = np.array([[[-100.0, -100, 0], [100, -100, 0], [0, 150, 0]]])
    starts, ends = np.array([[0.0, 0, 1.0]]), np.array([[0.5, 0, -1.0]])
    assert sampled_collisions(triangle, starts, ends, step=0.01)[0]
    assert sampled_collisions(triangle, ends, starts, step=0.01)[0]


def test_grounds_of_every_kind_give_the_same():
    dem = hills(100.0, 10.0, [Hill(0, 0, 30, 20)])
    triangles = dem.triangles()
    mesh = MeshTerrain(triangles.reshape(-1, 3), np.arange(3 * len(triangles)).reshape(-1, 3))
    rng = np.random.default_rng(4)
    legs = rng.uniform([-45, -45, 0], [45, 45, 40], (50, 3)), rng.uniform([-45, -45, 0], [45, 45, 40], (50, 3))
    answers = [sampled_collisions(ground, *legs, step=0.5) for ground in (dem, mesh, triangles)]
    np.testing.assert_array_equal(answers[0], answers[1])
    np.testing.assert_array_equal(answers[0], answers[2])


@pytest.mark.parametrize(("step", "tolerance"), [(0.0, 1e-3), (-1.0, 1e-3), (np.nan, 1e-3), (1.0, -1.0)])
def test_a_step_or_tolerance_that_is_none_is_refused(step, tolerance):
    with pytest.raises(InputError, match="step"):
        sampled_collisions(ridge(), *ACROSS, step=step, tolerance=tolerance)


def test_what_are_no_triangles_are_refused():
    with pytest.raises(InputError, match="triangles"):
        sampled_collisions(np.zeros((3, 3)), *ACROSS, step=1.0)


def test_as_a_test_of_clearance_it_steps_a_quarter_of_a_cell_and_pickles():
    dem, test = ridge(), pickle.loads(pickle.dumps(SampledTest()))
    assert test == SampledTest()
    starts, ends = (np.asarray(legs, dtype=float) for legs in ACROSS)
    expected = sampled_collisions(dem, starts, ends, step=dem.resolution / 4)
    np.testing.assert_array_equal(test.too_low(dem, starts, ends), expected)
    flags = Clearance(dem, 1000.0, test=test).breaches(starts, ends)
    np.testing.assert_array_equal(flags & TOO_LOW != 0, expected)
