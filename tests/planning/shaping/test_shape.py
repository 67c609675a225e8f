"""Shaping: fewer waypoints, never worse than the graph's path, always clear. How good it is: `test_quality`."""

from __future__ import annotations

import math
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from gcs_windplan.planning.cost import COSTS, CostChoice, SectionCost
from gcs_windplan.planning.search import find_path, sample_wind
from gcs_windplan.planning.shaping import relax, shape, shorten, thin
from gcs_windplan.planning.veil import lay_grid
from gcs_windplan.scene import Clearance
from gcs_windplan.terrain import Dem, Extent
from gcs_windplan.vehicle import Multirotor, Vehicle
from gcs_windplan.vehicle.power_grid import tabulate
from gcs_windplan.wind import Calm
from gcs_windplan.wind.field import Steady
from tests.worlds import AREA, WavyWind, over_ground, rough_dem

QUADCOPTER = Multirotor(4.21, 0.99545857, 100.0, 2.06852797, 0.02745631, 0.01473469, 1.172)


@settings(max_examples=12, deadline=None)
@given(seed=st.integers(0, 1000), name=st.sampled_from(list(COSTS)), strength=st.floats(0, 7))
def test_never_worse_than_the_graph_and_always_clear(seed, name, strength):
    dem = rough_dem(seed, relief=80.0)
    rules = Clearance(dem, 25.0, 110.0)
    veil = lay_grid(rules, AREA, 90.0, (40.0, 80.0), 16)
    wind = WavyWind(seed, strength=strength)
    vehicle = Vehicle(12.0)
    power = tabulate(QUADCOPTER, vehicle, np.array([8.0, 12.0, 16.0]), (0.0, 300.0)) if name == "energy" else None
    cost = SectionCost(CostChoice(name), wind, vehicle, veil.edge_length, 2000.0, power=power)
    path = find_path(
        sample_wind(veil, wind), cost, over_ground(dem, -800, -700, 40), over_ground(dem, 750, 800, 60)
    ).points
    limit = cost.of_polyline(path)
    for shaped in (shorten(path, cost, rules), shape(path, cost, rules)):
        assert cost.of_polyline(shaped) <= limit * (1 + 1e-12)
        assert (shaped[0] == path[0]).all()
        assert (shaped[-1] == path[-1]).all()
        assert len(shaped) <= max(len(path), 2) + 20
        assert (rules.breaches(shaped[:-1], shaped[1:])[1:-1] == 0).all()


def test_a_staircase_becomes_a_straight_line():
    stairs = np.array([(x, y, 30.0) for i in range(10) for x, y in ((10.0 * i, 10.0 * i), (10.0 * i + 10, 10.0 * i))])
    stairs = np.vstack([stairs, (100.0, 100.0, 30.0)])
    rules = Clearance(rough_dem(1, relief=0.0), 20.0)
    cost = SectionCost(CostChoice("distance"), Calm(), Vehicle(10.0), 10.0, 140.0)
    shaped = shape(stairs, cost, rules)
    assert len(shaped) == 2
    assert cost.of_polyline(shaped) == pytest.approx(math.hypot(100, 100))


def test_thin_keeps_to_its_limit():
    rng = np.random.default_rng(1)
    points = np.column_stack([np.arange(30) * 20.0 - 300, rng.normal(0, 5, 30), np.full(30, 40.0)])
    rules = Clearance(rough_dem(1, relief=0.0), 20.0)
    cost = SectionCost(CostChoice("distance"), Calm(), Vehicle(10.0), 10.0, 600.0)
    limit = 1.1 * cost.of_polyline(points)
    thinned = thin(points, cost, rules, limit)
    assert 2 <= len(thinned) < len(points)
    assert cost.of_polyline(thinned) <= limit


def test_relax_leaves_an_unflyable_line_alone():
    line = np.array([[-100.0, 0, 40], [0, 10, 40], [100, 0, 40]])
    rules = Clearance(rough_dem(1, relief=0.0), 20.0)
    cost = SectionCost(CostChoice("time"), WavyWind(1, strength=90.0), Vehicle(1.0), 10.0, 200.0)
    assert (relax(line, cost, rules) == line).all()


@dataclass(frozen=True)
class Disc(Steady):
    """A strong wind inside a disc, a light one outside: the jump has a curved border, and chords of it are short."""

    resolution: float = 0.05
    name: str = "disc"

    def at(self, points, seconds=0.0):
        inside = np.hypot(points[:, 0], points[:, 1]) < 0.8
        return np.where(inside[:, None], [-1.5, -1.0, 0.0], [0.3, 0.0, 0.0])


def test_shaping_gains_nothing_from_what_lies_between_two_samples():
    """Timed at 20 000 places a leg, the shaped route is still no slower than the graph's path."""
    start, goal = np.array([-1.8, -1.8, 0.0]), np.array([1.8, 1.8, 0.0])
    rules = Clearance(Dem.local(np.full((9, 9), -10.0), -4.0, 4.0, 1.0), 1.0)
    vehicle = Vehicle(2.0, 9.0, 9.0)
    veil = lay_grid(rules, Extent(-2, -2, 2, 2), 0.04, (10.0,), 16)
    cost = SectionCost(CostChoice("time"), Disc(), vehicle, veil.edge_length, 5.0)
    path = find_path(sample_wind(veil, Disc()), cost, start, goal).points
    shaped = shape(path, cost, rules)
    assert _true_seconds(shaped, vehicle) <= _true_seconds(path, vehicle) * 1.001


def _true_seconds(points, vehicle):
    total = 0.0
    for a, b in pairwise(points):
        places = a + (np.arange(20_000)[:, None] + 0.5) / 20_000 * (b - a)
        wind, way = Disc().at(places), b - a
        length = float(np.linalg.norm(way))
        track = way / length
        along, across = wind @ track, wind[:, 1] * track[0] - wind[:, 0] * track[1]
        total += float(np.mean(length / (np.sqrt(vehicle.airspeed**2 - across**2) + along)))
    return total
