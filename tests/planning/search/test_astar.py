"""A* against scipy's Dijkstra on the same worlds, with edge costs written down independently."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
import pytest
from scipy.sparse import coo_matrix
from scipy.sparse.csgraph import dijkstra

from gcs_windplan.errors import NoRouteError
from gcs_windplan.planning.cost import CostChoice, SectionCost, enclosing_ball
from gcs_windplan.planning.search import find_path, sample_wind
from gcs_windplan.planning.veil import lay_grid, lay_prm
from gcs_windplan.terrain import Dem
from gcs_windplan.vehicle import Vehicle
from tests.oracles.flying import naive_angle, naive_edge_time
from tests.worlds import AREA, WavyWind, over_ground, rough_dem, rules_over

EXACT = 1e-9


def _edge(choice: CostChoice, vehicle: Vehicle, vector, wind_a, wind_b) -> float:
    seconds = naive_edge_time(vehicle, vector, wind_a, wind_b)
    if choice.name == "time" or not math.isfinite(seconds):
        return seconds
    if choice.name == "distance":
        return float(np.linalg.norm(vector))
    angle = naive_angle(vector, wind_b)
    return angle if choice.name == "angle" else choice.angle * angle / math.pi


def _dijkstra(points, winds, legs, choice, vehicle, start: int, goal: int) -> float:
    """The best cost by scipy, over directed legs (m, 2)."""
    legs = np.unique(legs, axis=0)  # a sparse matrix would add up legs that stand twice
    costs = [_edge(choice, vehicle, points[j] - points[i], winds[i], winds[j]) for i, j in legs]
    keep = np.isfinite(costs)
    graph = coo_matrix((np.array(costs)[keep], (legs[keep, 0], legs[keep, 1])), shape=(len(points), len(points)))
    return float(dijkstra(graph.tocsr(), indices=start)[goal])


def _grid_legs(veil):
    """All clear legs of a grid, judged one by one from both sides."""
    layers, rows, columns = veil.heights.shape
    pairs = []
    for node in range(veil.size):
        at = np.array(np.unravel_index(node, veil.heights.shape))
        for step in veil.steps:
            to = at + step
            if ((to >= 0) & (to < (layers, rows, columns))).all():
                pairs.append((node, int(np.ravel_multi_index(to, veil.heights.shape))))
    pairs = np.array(pairs)
    points = veil.points
    return pairs[veil.clearance.breaches(points[pairs[:, 0]], points[pairs[:, 1]]) == 0]


@pytest.mark.parametrize("neighbours", [8, 16, 32, 64])
@pytest.mark.parametrize("model", ["triangle", "paper"])
@pytest.mark.parametrize("seed", range(4))
def test_time_on_grid_equals_dijkstra(neighbours, model, seed):
    dem = rough_dem(seed)
    veil = lay_grid(rules_over(dem, maximum=110.0), AREA, 150.0, (40.0, 70.0), neighbours)
    wind = WavyWind(seed, strength=6.0, rising=0.8)
    vehicle = Vehicle(9.0, speed_model=model)
    windy = sample_wind(veil, wind)
    points = windy.points
    start, goal = points[0], points[veil.size - 1]
    cost = SectionCost(CostChoice("time"), wind, vehicle, veil.edge_length, 1.0)
    expected = _dijkstra(points, windy.steady.winds, _grid_legs(veil), cost.choice, vehicle, 0, veil.size - 1)
    if math.isinf(expected):
        with pytest.raises(NoRouteError):
            find_path(windy, cost, start, goal)
        return
    found = find_path(windy, cost, start, goal)
    # the sites may join nodes two spacings away, so the path may be better than the grid's own, never worse
    assert found.cost <= expected * (1 + EXACT)
    legs = np.concatenate([_grid_legs(veil), _site_legs(veil, start, 0), _site_legs(veil, goal, veil.size - 1)])
    joined = _dijkstra(points, windy.steady.winds, legs, cost.choice, vehicle, 0, veil.size - 1)
    assert found.cost == pytest.approx(joined, rel=EXACT)


@dataclass(frozen=True)
class LowWind(WavyWind):
    """Not known above a height, as above a forecast's highest level."""

    top: float = 62.0

    def at(self, points, seconds=0.0):
        result = super().at(points, seconds)
        result[points[:, 2] > self.top] = np.nan
        return result


@pytest.mark.parametrize("neighbours", [8, 16])
@pytest.mark.parametrize("model", ["triangle", "paper"])
@pytest.mark.parametrize("seed", range(4))
def test_time_equals_dijkstra_where_the_wind_is_not_known_everywhere(neighbours, model, seed):
    """Nodes above a forecast's top must not disturb the bound, on a grid and on a roadmap."""
    dem = rough_dem(seed, relief=30.0)
    wind, vehicle = LowWind(seed, strength=6.0, rising=0.8), Vehicle(9.0, speed_model=model)
    veil = lay_grid(rules_over(dem), AREA, 180.0, (25.0, 45.0), neighbours)
    windy = sample_wind(veil, wind)
    known = np.flatnonzero(np.isfinite(windy.steady.winds[:, 0]))
    assert len(known) < veil.size
    first, last = int(known[0]), int(known[-1])
    start, goal = windy.points[first], windy.points[last]
    cost = SectionCost(CostChoice("time"), wind, vehicle, veil.edge_length, 1.0)
    legs = np.concatenate([_grid_legs(veil), _site_legs(veil, start, first), _site_legs(veil, goal, last)])
    expected = _dijkstra(
        windy.points, np.nan_to_num(windy.steady.winds, nan=99.0), legs, cost.choice, vehicle, first, last
    )
    assert math.isfinite(expected)
    assert find_path(windy, cost, start, goal).cost == pytest.approx(expected, rel=EXACT)


def _site_legs(veil, site, node: int):
    """The legs that join a site, which here is a node, with all nodes within two spacings."""
    near = veil.near(site, 2.0 * veil.spacing)
    near = near[near != node]
    points = veil.points
    clear = near[veil.clearance.breaches(np.broadcast_to(site, (len(near), 3)), points[near]) == 0]
    out = np.column_stack([np.full(len(clear), node), clear])
    return np.unique(np.concatenate([out, out[:, ::-1]]), axis=0) if len(out) else np.empty((0, 2), dtype=int)


@pytest.mark.parametrize("name", ["distance", "time"])
@pytest.mark.parametrize("model", ["triangle", "paper"])
@pytest.mark.parametrize("seed", range(5))
def test_roadmap_equals_dijkstra(name, model, seed):
    dem = rough_dem(seed)
    start, goal = over_ground(dem, -800, -800, 50), over_ground(dem, 800, 700, 50)
    veil = lay_prm(rules_over(dem), AREA, 250, seed, (50.0,), np.stack([start, goal]))
    wind = WavyWind(seed + 100, strength=7.0, rising=0.5)
    vehicle = Vehicle(10.0, speed_model=model)
    windy = sample_wind(veil, wind)
    cost = SectionCost(CostChoice(name), wind, vehicle, veil.edge_length, 1.0)
    legs = np.concatenate([veil.pairs[veil.flags == 0], veil.pairs[veil.flags == 0][:, ::-1]])
    expected = _dijkstra(veil.points, windy.steady.winds, legs, cost.choice, vehicle, 0, 1)
    if math.isinf(expected):
        with pytest.raises(NoRouteError):
            find_path(windy, cost, start, goal)
        return
    found = find_path(windy, cost, start, goal)
    assert found.cost == pytest.approx(expected, rel=EXACT)
    assert (found.points[0] == start).all()
    assert (found.points[-1] == goal).all()


@pytest.mark.parametrize("name", ["angle", "hybrid"])
@pytest.mark.parametrize("seed", range(3))
def test_the_papers_costs_are_what_their_path_adds_up_to(name, seed):
    """Their heuristics are not admissible: at best Dijkstra's cost, and the sum of the path's own edges."""
    dem = rough_dem(seed)
    start, goal = over_ground(dem, -800, -800, 50), over_ground(dem, 800, 700, 50)
    veil = lay_prm(rules_over(dem), AREA, 250, seed, (50.0,), np.stack([start, goal]))
    wind, vehicle = WavyWind(seed, strength=4.0), Vehicle(10.0)
    windy = sample_wind(veil, wind)
    cost = SectionCost(CostChoice(name), wind, vehicle, veil.edge_length, 2000.0)
    found = find_path(windy, cost, start, goal)
    at = wind.at(found.points)
    own = [
        _edge(cost.choice, vehicle, found.points[i + 1] - found.points[i], at[i], at[i + 1])
        for i in range(len(found.points) - 1)
    ]
    legs = np.concatenate([veil.pairs[veil.flags == 0], veil.pairs[veil.flags == 0][:, ::-1]])
    best = _dijkstra(veil.points, windy.steady.winds, legs, cost.choice, vehicle, 0, 1)
    assert found.cost == pytest.approx(sum(own), rel=EXACT)
    assert found.cost >= best * (1 - EXACT)


def test_same_input_same_path():
    dem = rough_dem(3)
    veil = lay_grid(rules_over(dem), AREA, 60.0, (40.0, 80.0), 16)
    windy = sample_wind(veil, WavyWind(3))
    cost = SectionCost(CostChoice("time"), WavyWind(3), Vehicle(10.0), veil.edge_length, 1.0)
    start, goal = over_ground(dem, -733, -811, 40), over_ground(dem, 812, 777, 60)
    one, two = (find_path(windy, cost, start, goal) for _ in range(2))
    assert one.cost == two.cost
    assert (one.points == two.points).all()


@pytest.mark.parametrize("seed", range(20))
def test_ball_holds_all_winds(seed):
    winds = np.random.default_rng(seed).normal(size=(200, 2)) * (5, 2) + (7, -3)
    centre, radius = enclosing_ball(winds)
    assert np.linalg.norm(winds - centre, axis=1).max() <= radius * (1 + EXACT)
    assert radius <= np.linalg.norm(winds - winds.mean(axis=0), axis=1).max() * 1.2


def _wall(relief: float) -> Dem:
    """Flat ground with a wall from west to east, and nothing else."""
    heights = np.zeros((41, 41))
    heights[20] = relief
    return Dem.local(heights, -1000.0, 1000.0, 50.0)


@pytest.mark.parametrize(
    ("reason", "dem", "maximum", "strength"),
    [
        ("height limit", _wall(400.0), 120.0, 0.0),
        ("unknown ground", _wall(np.nan), 120.0, 0.0),
        ("wind", _wall(0.0), 120.0, 30.0),
    ],
)
def test_no_route_names_what_cuts(reason, dem, maximum, strength):
    veil = lay_grid(rules_over(dem, maximum=maximum), AREA, 100.0, (60.0,), 8)
    wind = WavyWind(1, strength=strength)
    cost = SectionCost(CostChoice("time"), wind, Vehicle(8.0), veil.edge_length, 1.0)
    with pytest.raises(NoRouteError, match=reason) as caught:
        find_path(sample_wind(veil, wind), cost, over_ground(dem, 0, -800, 60), over_ground(dem, 0, 800, 60))
    assert reason in next(iter(caught.value.cuts))
