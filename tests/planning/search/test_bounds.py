"""The lower bounds of `time`: h1, the fastest wind anywhere behind the vehicle, and h2, a ball around all winds.

Consistent (no edge is cheaper than what it takes off the bound), never above what scipy's Dijkstra finds, and A* with
either, or with none, finds the same cost.
"""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st
from scipy.sparse import csr_array
from scipy.sparse.csgraph import dijkstra

from gcs_windplan.flight.sampling import performance_of
from gcs_windplan.kernels.best_first import search_csr
from gcs_windplan.kernels.edges import Setting, edge_between, remaining
from gcs_windplan.planning.cost import CostChoice, SectionCost
from gcs_windplan.vehicle import Vehicle
from gcs_windplan.wind import Calm

rounding = 1e-9


def both_bounds(vehicle: Vehicle, winds: np.ndarray, goal: np.ndarray) -> dict[str, Setting]:
    """h1 is h2 about no wind at all."""
    cost = SectionCost(CostChoice("time"), Calm(), vehicle, 1.0, 1.0)
    h2 = cost.setting(goal, winds)
    strongest = float(np.hypot(winds[:, 0], winds[:, 1]).max())
    return {"h1": h2._replace(ball_e=0.0, ball_n=0.0, ball_radius=strongest), "h2": h2}


def scatter(seed: int, count: int = 60, strength: float = 6.0, rising: float = 1.0):
    """Random places (count, 3) and winds about a random mean; a few places stand over each other."""
    rng = np.random.default_rng(seed)
    points = rng.uniform(-1000, 1000, (count, 3)) * (1, 1, 0.05)
    points[1::7, :2] = points[0::7, :2][: len(points[1::7])]
    winds = rng.uniform(-1, 1, (count, 3)) * (strength / 2, strength / 2, rising)
    winds[:, :2] += rng.uniform(-1, 1, 2) * strength / 2
    return points, winds


def complete_graph(vehicle: Vehicle, points: np.ndarray, winds: np.ndarray) -> np.ndarray:
    """Seconds from each place to each other; infinite where it cannot be flown."""
    performance, setting = performance_of(vehicle), Setting(3.0, 0.0, 0.0, 0.0)
    n = len(points)
    seconds = np.full((n, n), math.inf)
    for i in range(n):
        for j in range(n):
            if i != j:
                seconds[i, j] = edge_between(
                    performance, setting, None, *(points[j] - points[i]), 0.0, *winds[i], *winds[j]
                )
    return seconds


vehicles = st.builds(
    Vehicle,
    airspeed=st.floats(4, 20),
    climb=st.floats(1.5, 6),
    descent=st.floats(1.5, 6),
    speed_model=st.sampled_from(["triangle", "paper"]),
)


@given(seed=st.integers(0, 10_000), vehicle=vehicles, strength=st.floats(0, 12))
def test_no_edge_is_cheaper_than_what_it_takes_off_the_bound(seed, vehicle, strength):
    points, winds = scatter(seed, count=12, strength=strength)
    goal = points[-1]
    performance = performance_of(vehicle)
    seconds = complete_graph(vehicle, points, winds)
    for name, setting in both_bounds(vehicle, winds, goal).items():
        ahead = np.array([remaining(performance, setting, *point) for point in points])
        assert ahead[-1] == 0.0
        reachable = np.isfinite(seconds)
        assert (ahead[:, None] <= (seconds + ahead[None, :]) * (1 + rounding))[reachable].all(), name


@pytest.mark.parametrize("model", ["triangle", "paper"])
@pytest.mark.parametrize("seed", range(6))
def test_the_bounds_never_exceed_dijkstra(seed, model):
    """Reverse Dijkstra by scipy gives what truly remains."""
    vehicle = Vehicle(8.0, climb=3.0, descent=2.0, speed_model=model)
    points, winds = scatter(seed)
    seconds = complete_graph(vehicle, points, winds)
    i, j = np.nonzero(np.isfinite(seconds))
    true = dijkstra(csr_array((seconds[i, j], (j, i)), shape=seconds.shape), indices=len(points) - 1)
    bounds = {}
    for name, setting in both_bounds(vehicle, winds, points[-1]).items():
        bounds[name] = np.array([remaining(performance_of(vehicle), setting, *point) for point in points])
        assert (bounds[name] <= true * (1 + rounding)).all(), name
        assert bounds[name].max() > 0.3 * true[np.isfinite(true)].max()  # a bound of nothing would pass as well


@given(seed=st.integers(0, 10_000), airspeed=st.floats(5, 20), share=st.floats(0, 0.9), blows=st.floats(0, 6.3))
def test_h2_is_exact_in_uniform_wind(seed, airspeed, share, blows):
    """A straight level line in one wind takes what the bound says: h2 knows that it is a head wind, h1 does not."""
    rng = np.random.default_rng(seed)
    a, b = rng.uniform(-1000, 1000, (2, 3)) * (1, 1, 0)
    assume(np.linalg.norm(b - a) > 1.0)
    wind = np.array([share * airspeed * math.cos(blows), share * airspeed * math.sin(blows), 0.0])
    vehicle = Vehicle(airspeed)
    performance = performance_of(vehicle)
    true = edge_between(performance, Setting(3.0, 0.0, 0.0, 0.0), None, *(b - a), 0.0, *wind, *wind)
    bounds = {name: remaining(performance, s, *a) for name, s in both_bounds(vehicle, wind[None], b).items()}
    assert bounds["h2"] == pytest.approx(true, rel=1e-9)
    assert bounds["h1"] <= bounds["h2"] * (1 + rounding)


@pytest.mark.parametrize("model", ["triangle", "paper"])
@pytest.mark.parametrize("seed", range(4))
def test_all_bounds_find_the_same_cost(seed, model):
    """A* with no bound, h1 and h2 on one roadmap; a bound never makes it expand more."""
    vehicle = Vehicle(9.0, speed_model=model)
    points, winds = scatter(seed, count=200)
    near = np.linalg.norm(points[:, None] - points[None], axis=2) < 450
    np.fill_diagonal(near, False)
    first = np.concatenate([[0], np.cumsum(near.sum(axis=1))]).astype(np.int64)
    neighbours = np.nonzero(near)[1].astype(np.int64)
    performance, costs, expanded = performance_of(vehicle), {}, {}
    bounds = both_bounds(vehicle, winds, points[-1])
    for name, setting, estimates in (
        ("none", bounds["h2"], np.zeros(len(points))),
        ("h1", bounds["h1"], np.empty(0)),
        ("h2", bounds["h2"], np.empty(0)),
    ):
        _, costs[name], expanded[name], _ = search_csr(
            first, neighbours, points, winds, estimates, performance, setting, None, 0, len(points) - 1,
            None, 0.0, 0, None, np.zeros(2, dtype=np.int64),
        )  # fmt: skip
    assert math.isfinite(costs["none"])
    assert costs["h1"] == pytest.approx(costs["none"], rel=rounding)
    assert costs["h2"] == pytest.approx(costs["none"], rel=rounding)
    assert max(expanded["h1"], expanded["h2"]) <= expanded["none"]
