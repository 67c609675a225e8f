"""The search in wind that changes with time, against brute force over all paths and over time."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np
import pytest

from gcs_windplan.errors import NoRouteError
from gcs_windplan.flight import fly_legs
from gcs_windplan.planning.cost import CostChoice, SectionCost, rank_of
from gcs_windplan.planning.search import find_path, sample_wind
from gcs_windplan.planning.veil import lay_grid, lay_prm
from gcs_windplan.vehicle import Vehicle
from tests.oracles.changing import best_of_all_paths, best_with_waiting, edge_lasting, leg_by_ode
from tests.worlds import AREA, ShiftingWind, over_ground, rough_dem, rules_over

EXACT = 1e-9
one_millisecond = 1e-3
TIME = CostChoice("time")


def roadmap(seed: int, nodes: int = 5):
    """A small roadmap over rough ground with the start as node 0 and the goal as the last one, and its legs."""
    dem = rough_dem(seed, relief=20.0)
    start, goal = over_ground(dem, -800, -800, 50), over_ground(dem, 800, 700, 50)
    veil = lay_prm(rules_over(dem), AREA, nodes, seed, (50.0,), np.stack([start, goal]), 1500.0)
    order = [0, *range(2, veil.size), 1]
    place = {node: i for i, node in enumerate(order)}
    legs: dict[int, list[int]] = {i: [] for i in range(veil.size)}
    for a, b in veil.pairs[veil.flags == 0]:
        legs[place[a]].append(place[b])
        legs[place[b]].append(place[a])
    return veil, start, goal, veil.points[order], legs


@pytest.mark.parametrize("rising", [0.0, 0.5])
@pytest.mark.parametrize("begin", [0.0, 137.0])
@pytest.mark.parametrize("seed", range(6))
def test_on_small_roadmaps_it_equals_brute_force_over_all_paths(seed, begin, rising):
    veil, start, goal, points, legs = roadmap(seed)
    wind = ShiftingWind((seed, seed + 50, seed + 90), (-60.0, 300.0, 1500.0), strength=6.0, rising=rising)
    vehicle = Vehicle(10.0)
    expected = best_of_all_paths(veil.size, legs, edge_lasting(vehicle, points, wind), begin)
    cost = SectionCost(TIME, wind, vehicle, veil.edge_length, 1.0, begin)
    found = find_path(sample_wind(veil, wind), cost, start, goal, begin)
    assert found.cost == pytest.approx(expected, rel=1e-7)


@pytest.mark.parametrize("seed", range(4))
def test_waiting_on_the_way_does_not_arrive_earlier(seed):
    """In the time-expanded graph, where waiting is allowed everywhere, nothing arrives earlier: first in, first out."""
    veil, start, goal, points, legs = roadmap(seed, nodes=6)
    wind = ShiftingWind((seed, seed + 50), (0.0, 600.0), strength=6.0)
    vehicle = Vehicle(10.0)
    cost = SectionCost(TIME, wind, vehicle, veil.edge_length, 1.0)
    found = find_path(sample_wind(veil, wind), cost, start, goal)
    step = 0.5
    waited = best_with_waiting(veil.size, legs, edge_lasting(vehicle, points, wind), 0.0, step)
    assert found.cost <= waited + EXACT
    assert waited <= found.cost + step * len(found.points)


@pytest.mark.parametrize("seed", range(3))
def test_on_a_grid_it_beats_no_bound_and_equals_it(seed):
    """With the bound of the ball over all times the same cost comes out as with none."""
    dem = rough_dem(seed, relief=20.0)
    veil = lay_grid(rules_over(dem, maximum=110.0), AREA, 150.0, (40.0, 70.0), 16)
    wind = ShiftingWind((seed, seed + 7), (0.0, 500.0), strength=6.0)
    windy, vehicle = sample_wind(veil, wind), Vehicle(11.0)

    class Unbounded(SectionCost):
        __slots__ = ()

        def estimates(self, points, start, goal, setting):
            return np.zeros(len(points))

    start, goal = veil.points[0], veil.points[veil.size - 1]
    arguments = (TIME, wind, vehicle, veil.edge_length, 1.0)
    bounded = find_path(windy, SectionCost(*arguments), start, goal)
    free = find_path(windy, Unbounded(*arguments), start, goal)
    assert bounded.cost == pytest.approx(free.cost, rel=EXACT)
    assert bounded.expanded < free.expanded


def test_a_wind_that_does_not_change_is_found_as_the_steady_one():
    dem = rough_dem(3)
    veil = lay_grid(rules_over(dem, maximum=110.0), AREA, 150.0, (40.0, 70.0), 16)
    start, goal, vehicle = veil.points[0], veil.points[veil.size - 1], Vehicle(11.0)
    changing = ShiftingWind((4, 4), (0.0, 900.0))
    steady = replace(changing, knots=(0.0,))  # one time alone: steady
    costs = []
    for wind in (changing, steady):
        cost = SectionCost(TIME, wind, vehicle, veil.edge_length, 1.0)
        windy = sample_wind(veil, wind) if wind is changing else sample_wind(veil, _Frozen(changing))
        costs.append(find_path(windy, cost, start, goal).cost)
    assert costs[0] == pytest.approx(costs[1], rel=EXACT)


@dataclass(frozen=True)
class _Frozen:
    """Another wind as it is at the departure, for ever."""

    wind: ShiftingWind
    name: str = "frozen"
    resolution: float = 25.0

    @property
    def times(self):
        return np.empty(0)

    def at(self, points, seconds=0.0):
        return self.wind.at(points, 0.0)


@pytest.mark.parametrize("name", ["distance", "angle", "hybrid", "time"])
def test_every_cost_finds_a_way_that_can_be_flown(name):
    dem = rough_dem(2)
    veil = lay_grid(rules_over(dem, maximum=110.0), AREA, 150.0, (40.0, 70.0), 16)
    wind = ShiftingWind((5, 6), (0.0, 700.0), strength=5.0)
    start, goal = veil.points[0], veil.points[veil.size - 1]
    cost = SectionCost(CostChoice(name), wind, Vehicle(12.0), veil.edge_length, 2000.0)
    found = find_path(sample_wind(veil, wind), cost, start, goal)
    assert np.isfinite(fly_legs(found.points, wind, Vehicle(12.0))[1]).all()


@pytest.mark.parametrize(("changes_in", "tolerance"), [(3 * 3600.0, 0.05), (900.0, 0.3)], ids=["forecast", "wild"])
@pytest.mark.parametrize("seed", range(5))
def test_legs_last_as_long_as_integrating_their_speed_says(seed, changes_in, tolerance):
    """In a forecast's three hours and, wilder than any, in a quarter of an hour; tolerances in seconds."""
    random = np.random.default_rng(seed)
    wind, vehicle = ShiftingWind((seed, seed + 1), (0.0, changes_in), strength=4.0), Vehicle(12.0, climb=3.0)
    points = np.cumsum(np.vstack([np.zeros(3), random.uniform(-600, 600, (4, 3)) * (1, 1, 0.1)]), axis=0)
    _, times = fly_legs(points, wind, vehicle, 20.0)
    clock = 20.0
    for i in range(4):
        clock += leg_by_ode(vehicle, wind, points[i], points[i + 1], clock)
        assert times[i + 1] == pytest.approx(clock, abs=tolerance)


def test_beyond_the_forecast_there_is_no_route_and_the_error_says_so():
    dem = rough_dem(1)
    veil = lay_grid(rules_over(dem, maximum=110.0), AREA, 150.0, (40.0, 70.0), 16)
    wind = ShiftingWind((1, 2), (0.0, 60.0))
    cost = SectionCost(TIME, wind, Vehicle(12.0), veil.edge_length, 1.0)
    with pytest.raises(NoRouteError, match="longer than the forecast reaches"):
        find_path(sample_wind(veil, wind), cost, veil.points[0], veil.points[veil.size - 1])


def test_more_of_the_forecast_is_sampled_only_where_the_flight_lasts_so_long():
    """Against a strong wind the way lasts more than three times what it would in still air."""
    dem = rough_dem(1, relief=5.0)
    veil = lay_grid(rules_over(dem, maximum=110.0), AREA, 150.0, (40.0,), 8)
    calm = ShiftingWind((1, 2, 3, 4, 5), (0.0, 300.0, 1500.0, 3000.0, 9000.0), strength=1.0)
    windy = sample_wind(veil, calm)
    start, goal = veil.points[0], veil.points[veil.size - 1]
    find_path(windy, SectionCost(TIME, calm, Vehicle(12.0), veil.edge_length, 1.0), start, goal)
    assert windy.sampled == (0.0, 300.0, 1500.0)

    @dataclass(frozen=True)
    class Headwind(ShiftingWind):
        def at(self, points, seconds=0.0):
            return super().at(points, seconds) + np.array([-7.7, -7.7, 0.0])

    against = Headwind(calm.seeds, calm.knots, strength=0.2)
    windy = sample_wind(veil, against)
    found = find_path(windy, SectionCost(TIME, against, Vehicle(12.0), veil.edge_length, 1.0), start, goal)
    assert found.cost > 1000.0
    assert len(windy.sampled) > 3


@pytest.mark.parametrize("quantile", [0.5, 0.8, 0.9])
def test_over_members_an_edge_costs_the_quantile(quantile):
    """Against Dijkstra with the quantile of naive times; all members change alike in time."""
    veil, start, goal, points, legs = roadmap(4, nodes=6)
    members = tuple(ShiftingWind((k, k + 1), (0.0, 800.0), strength=5.0) for k in range(7))
    vehicle = Vehicle(13.0)
    each = [edge_lasting(vehicle, points, member) for member in members]

    def lasting(i, j, clock):
        return sorted(one(i, j, clock) for one in each)[rank_of(quantile, 7)]

    expected = best_of_all_paths(veil.size, legs, lasting, 0.0)
    assert math.isfinite(expected)
    cost = SectionCost(TIME, members[0], vehicle, veil.edge_length, 1.0, 0.0, members, quantile)
    found = find_path(sample_wind(veil, members[0], members), cost, start, goal)
    assert found.cost == pytest.approx(expected, rel=1e-7)


def test_ranks_are_the_usual_order_statistics():
    assert [rank_of(q, 10) for q in (0.1, 0.5, 0.9, 0.99)] == [0, 4, 8, 9]
    assert rank_of(0.9, 1) == 0
