"""How near the best route that physics allows: least times that are known, and that they are what is claimed."""

from __future__ import annotations

import math

import pytest
from scipy.optimize import brentq

from tests.oracles.limits import OTHERS, PAPER, Limit
from tests.oracles.zermelo import least_time, least_time_in_layers

one_thousandth = 1e-3
LAST_DIGIT = {"rotation": 1e-6, "vortices": 1e-4, "shear": 2e-5}  # as the limits are printed; else six digits
SMOOTH = [limit for limit in PAPER + OTHERS if limit.formula and (limit.case, limit.way) != ("3", "rev")]  # 3: as there
BACK = [limit for limit in PAPER if (limit.way, limit.model) == ("rev", "triangle")]
JUMPS = [limit for limit in PAPER if limit.formula is None]
OUTSIDE = {"1": 0.0, "1c": -1.0}  # the wind beside the jet


def near(limit: Limit, nodes: int, neighbours: int) -> int:
    """Check that a shaped route is near the limit; its waypoints."""
    cost, path, shaped = limit.route(nodes, neighbours)
    seconds = cost.of_polyline(shaped)
    assert seconds <= cost.of_polyline(path)
    assert limit.seconds * (1 - 1e-4) <= seconds  # nothing beats the limit: a time below it would be a wrong time
    assert seconds <= limit.seconds * (1 + one_thousandth)
    return len(shaped)


@pytest.mark.parametrize("limit", PAPER, ids=str)
def test_least_time_is_near_the_limit_in_the_papers_fields(limit):
    """From 101 x 101 nodes with 16 neighbours; where the wind jumps no worse than where it is smooth."""
    assert near(limit, 101, 16) <= 16


@pytest.mark.parametrize("limit", OTHERS, ids=str)
def test_least_time_is_near_the_limit_elsewhere(limit):
    """Rotation (Techy 2011), four vortices (Ferraro 2021) and a linear shear, from the same grid."""
    assert near(limit, 101, 16) <= 35


@pytest.mark.parametrize("limit", BACK + OTHERS, ids=str)
@pytest.mark.parametrize("neighbours", [16, 32])
def test_a_coarse_grid_is_as_good(limit, neighbours):
    near(limit, 41, neighbours)


@pytest.mark.parametrize("limit", JUMPS, ids=str)
@pytest.mark.parametrize("nodes", [41, 101])
def test_vertices_do_not_stick_where_the_wind_jumps(limit, nodes):
    """Even from a path in 8 directions, 3 to 8 % above the limit."""
    near(limit, nodes, 8)


@pytest.mark.parametrize("limit", SMOOTH, ids=str)
def test_the_smooth_limits_are_those_of_optimal_control(limit):
    """No ray arrives earlier. The vortices tear rays apart, so it takes many of them to find the first."""
    rays = 5001 if limit.case == "vortices" else 721
    found = least_time(limit.formula, limit.airspeed, limit.model, limit.start, limit.goal, 1.02 * limit.seconds, rays)
    assert found == pytest.approx(limit.seconds, rel=LAST_DIGIT.get(limit.case, 5e-6))


@pytest.mark.parametrize("limit", JUMPS, ids=str)
def test_the_limits_with_a_jump_are_those_of_refraction(limit):
    beside = OUTSIDE[limit.case]
    found = least_time_in_layers((-1.0, 1.0), (beside, 1.0, beside), 2.0, limit.model, limit.start, limit.goal)
    assert found == pytest.approx(limit.seconds, rel=5e-6)


def test_the_rotations_limit_solves_its_equation():
    """Techy 2011: the air carries the goal along, so the flight is a chord: T = 2 sin((π/3 + 0.9 T)/2)."""
    found = brentq(lambda t: t - 2 * math.sin((math.pi / 3 + 0.9 * t) / 2), 1.0, 2.5)
    assert found == pytest.approx(OTHERS[0].seconds, rel=1e-6)
