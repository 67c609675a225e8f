"""A* with `energy` against scipy's Dijkstra on random worlds; the lower bound; the table of powers."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.sparse import coo_matrix
from scipy.sparse.csgraph import dijkstra

from gcs_windplan.errors import InputError, NoRouteError
from gcs_windplan.flight.sampling import performance_of
from gcs_windplan.kernels.edges import edge_between
from gcs_windplan.kernels.power import watts_at
from gcs_windplan.planning.cost import CostChoice, SectionCost
from gcs_windplan.planning.cost.bounds import least_prices
from gcs_windplan.planning.search import find_path, sample_wind
from gcs_windplan.planning.veil import lay_grid, lay_prm
from gcs_windplan.vehicle import FixedWing, Multirotor, RotaryWing, Vehicle, air_density
from gcs_windplan.vehicle.power_grid import tabulate
from gcs_windplan.wind import Calm
from tests.oracles.powering import naive_edge_prices, naive_table
from tests.planning.search.test_bounds import scatter
from tests.worlds import AREA, WavyWind, rough_dem, rules_over

rounding = 1e-9

QUADCOPTER = Multirotor(4.21, 0.99545857, 100.0, 2.06852797, 0.02745631, 0.01473469, 1.172)
HELICOPTER = RotaryWing(2.04, 0.5, 0.05, 120.0)
WING = FixedWing(11.0, 0.55, 15.2445, 0.9, 0.043, 0.678, stall_airspeed=14.0)
MODELS = {"quadcopter": QUADCOPTER, "helicopter": HELICOPTER}


def pair_energies(cost: SectionCost, points, winds, pairs):
    """Independent prices of directed edges."""
    starts, ends = pairs.T
    return naive_edge_prices(
        cost.vehicle, cost.power.airspeeds, points[starts], points[ends], winds[starts], winds[ends],
        naive_table(cost.power), cost.power.cost_index,
    )  # fmt: skip


def dijkstra_cost(costs, pairs, size: int, start: int, goal: int) -> float:
    keep = np.isfinite(costs)
    graph = coo_matrix((costs[keep], (pairs[keep, 0], pairs[keep, 1])), shape=(size, size))
    return float(dijkstra(graph.tocsr(), indices=start)[goal])


def energy_cost(wind, vehicle, power, airspeeds, edge: float, cost_index: float = 0.0) -> SectionCost:
    grid = tabulate(power, vehicle, np.array(airspeeds), (0.0, 200.0), cost_index)
    return SectionCost(CostChoice("energy"), wind, vehicle, edge, 1.0, power=grid)


@pytest.mark.parametrize("airspeeds", [(9.0,), (6.0, 9.0, 12.0, 15.0)], ids=["one", "free"])
@pytest.mark.parametrize("model", MODELS)
@pytest.mark.parametrize("seed", [0, 2, 3, 5])  # roadmaps so small must still reach the goal
def test_energy_on_a_roadmap_equals_dijkstra(seed, model, airspeeds):
    veil = lay_prm(rules_over(rough_dem(seed)), AREA, 70, seed, (40.0, 70.0), _sites(seed), 620.0)
    wind = WavyWind(seed, strength=6.0, rising=0.8)
    vehicle = Vehicle(9.0, climb=3.0, descent=2.0)
    windy = sample_wind(veil, wind)
    cost = energy_cost(wind, vehicle, MODELS[model], airspeeds, veil.edge_length, cost_index=50.0 * (seed % 2))
    start, goal = _sites(seed)
    ends = [int(np.argmin(np.linalg.norm(veil.points - site, axis=1))) for site in (start, goal)]
    pairs = np.array([(i, j) for i in range(veil.size) for j in veil.neighbours[veil.first[i] : veil.first[i + 1]]])
    expected = dijkstra_cost(pair_energies(cost, veil.points, windy.steady.winds, pairs), pairs, veil.size, *ends)
    assert math.isfinite(expected)
    found = find_path(windy, cost, start, goal)
    assert found.cost == pytest.approx(expected, rel=rounding)


@pytest.mark.parametrize("seed", range(4))
def test_energy_on_a_grid_is_what_its_edges_add_up_to_and_no_bound_changes_it(seed, monkeypatch):
    veil = lay_grid(rules_over(rough_dem(seed), maximum=110.0), AREA, 120.0, (40.0, 70.0), 16)
    wind = WavyWind(seed, strength=7.0, rising=0.5)
    vehicle = Vehicle(10.0)
    windy = sample_wind(veil, wind)
    cost = energy_cost(wind, vehicle, QUADCOPTER, (6.0, 10.0, 14.0), veil.edge_length)
    start, goal = windy.points[0], windy.points[veil.size - 1]
    found = find_path(windy, cost, start, goal)
    watts = naive_table(cost.power)
    winds, way = wind.at(found.points), found.points
    added = naive_edge_prices(vehicle, cost.power.airspeeds, way[:-1], way[1:], winds[:-1], winds[1:], watts)
    assert found.cost == pytest.approx(added.sum(), rel=rounding)
    monkeypatch.setattr("gcs_windplan.planning.cost.section.least_prices", lambda points, *_: np.zeros(len(points)))
    blind = find_path(windy, cost, start, goal)
    assert found.cost == pytest.approx(blind.cost, rel=rounding)
    assert found.expanded < blind.expanded


def _sites(seed: int):
    ground = rough_dem(seed).heights_at(np.array([[-800.0, -800.0], [800.0, 800.0]]))
    return np.array([[-800.0, -800.0, ground[0] + 50], [800.0, 800.0, ground[1] + 50]])


@given(
    seed=st.integers(0, 10_000),
    strength=st.floats(0, 12),
    model=st.sampled_from([*MODELS.values(), WING]),
    cost_index=st.floats(0, 500),
    climb=st.floats(1.5, 6),
    descent=st.floats(1.5, 6),
)
def test_no_edge_is_cheaper_than_what_it_takes_off_the_bound(seed, strength, model, cost_index, climb, descent):
    points, winds = scatter(seed, count=12, strength=strength)
    kind = "fixed-wing" if model is WING else "multicopter"
    vehicle = Vehicle(16.0, climb, descent, type=kind)
    cost = energy_cost(Calm(), vehicle, model, (9.0, 16.0, 22.0), 1.0, cost_index)
    setting = cost.setting(points[-1], winds)
    ahead = least_prices(points, setting, cost.power, points[0])
    assert ahead[-1] == 0.0
    assert (ahead >= 0).all()
    performance = performance_of(vehicle)
    for i in range(len(points)):
        for j in range(len(points)):
            price = min(
                edge_between(
                    performance._replace(airspeed=airspeed), setting, cost.power, *(points[j] - points[i]),
                    points[i, 2], *winds[i], *winds[j],
                )
                for airspeed in (9.0, 16.0, 22.0)
            )  # fmt: skip
            assert ahead[i] <= (price + ahead[j]) * (1 + rounding)


def test_the_bound_is_close_in_uniform_wind():
    """A straight level line against one wind takes what the bound says, but for the 64 directions' 0.1 %."""
    points = np.array([[0.0, 0.0, 100.0], [1000.0, 200.0, 100.0]])
    winds = np.tile([-5.0, 1.0, 0.0], (2, 1))
    cost = energy_cost(Calm(), Vehicle(10.0), QUADCOPTER, np.linspace(4, 17, 14), 1.0)
    setting = cost.setting(points[1], winds)
    bound = least_prices(points, setting, cost.power, points[0])[0]
    watts = naive_table(cost.power)
    start, end, *blows = (row[None] for row in (*points, *winds))
    true = naive_edge_prices(Vehicle(10.0), cost.power.airspeeds, start, end, *blows, watts)[0]
    assert bound <= true
    assert bound == pytest.approx(true, rel=0.005)


@pytest.mark.parametrize("model", [QUADCOPTER, HELICOPTER, WING], ids=["quadcopter", "helicopter", "wing"])
def test_the_table_is_the_model(model):
    """At random flights within 0.5 % of the level power, but near the stall, where it is infinite sooner."""
    rng = np.random.default_rng(1)
    vehicle = Vehicle(16.0, 3.0, 2.0)
    grid = tabulate(model, vehicle, np.array([16.0, 20.0]), (100.0, 3000.0))
    for _ in range(300):
        airspeed = rng.uniform(15.5 if model is WING else 0.0, 20.0)
        rate, height = rng.uniform(-2, 3), rng.uniform(100, 3000)
        true = float(model.watts(airspeed, rate, air_density(height)))
        found = watts_at(grid, airspeed, rate, height)
        if math.isfinite(found):
            level = float(model.watts(airspeed, 0.0, air_density(height)))
            kink = 0.015 if model is WING else 5e-3  # where a glide begins, and power ends
            assert found == pytest.approx(true, abs=kink * level)
        else:
            assert model is WING
            assert airspeed < 14.5 * math.sqrt(1.225 / float(air_density(3000.0)))
    assert watts_at(grid, 20.1, 0.0, 100.0) == math.inf


def test_no_energy_without_power():
    with pytest.raises(InputError, match="name its `airframe`"):
        SectionCost(CostChoice("energy"), Calm(), Vehicle(10.0), 1.0, 1.0)


def test_wind_too_strong_for_every_airspeed_is_no_route():
    veil = lay_grid(rules_over(rough_dem(1)), AREA, 200.0, (50.0,), 8)
    wind = replace(WavyWind(1), strength=120.0)
    cost = energy_cost(wind, Vehicle(8.0), QUADCOPTER, (8.0, 12.0), veil.edge_length)
    windy = sample_wind(veil, wind)
    with pytest.raises(NoRouteError):
        find_path(windy, cost, windy.points[0], windy.points[veil.size - 1])
