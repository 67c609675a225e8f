"""One posed problem, many threads: each finds what it would find alone."""

from __future__ import annotations

import pickle
import sys
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass

import numpy as np
import pytest

import gcs_windplan as gw
from gcs_windplan.planning.cost import CostChoice, SectionCost
from gcs_windplan.planning.problem import pose_problem
from gcs_windplan.planning.request import Uniform
from gcs_windplan.planning.route import find_route, unshaped
from gcs_windplan.planning.search import find_path, sample_wind
from gcs_windplan.planning.veil import lay_grid
from tests.ensembles import request
from tests.worlds import AREA, ShiftingWind, rough_dem, rules_over

HOURS = tuple(3600.0 * hour for hour in range(5))
THREADS = 6


@pytest.fixture
def restless():
    """Threads take turns as often as they can."""
    interval = sys.getswitchinterval()
    sys.setswitchinterval(1e-6)
    yield
    sys.setswitchinterval(interval)


@pytest.mark.usefixtures("restless")
@pytest.mark.parametrize("members", [1, 3])
def test_threads_that_search_one_graph_find_what_each_finds_alone(members):
    """Departures hours apart need other stretches of a wind that changes every hour."""
    veil = lay_grid(rules_over(rough_dem(1, relief=20.0), maximum=110.0), AREA, 120.0, (40.0,), 8)
    winds = tuple(ShiftingWind(tuple(range(k, k + 5)), HOURS, strength=6.0) for k in range(members))
    start, goal, vehicle = veil.points[0], veil.points[veil.size - 1], gw.Vehicle(11.0)
    begins = [1200.0 * k for k in range(11)]

    def found(graph, begin: float) -> tuple[float, list]:
        ensemble = winds if members > 1 else ()
        cost = SectionCost(CostChoice("time"), winds[0], vehicle, veil.edge_length, 1.0, begin, ensemble)
        path = find_path(graph, cost, start, goal, begin)
        return path.cost, path.points.tolist()

    alone = [found(sample_wind(veil, winds[0], winds), begin) for begin in begins]
    shared = sample_wind(veil, winds[0], winds)
    with ThreadPoolExecutor(THREADS) as pool:
        together = list(pool.map(lambda begin: found(shared, begin), begins))
    assert together == alone
    assert len({cost for cost, _ in alone}) == 11


@pytest.mark.usefixtures("restless")
def test_threads_that_route_one_problem_find_what_each_finds_alone():
    asked = request(wind=ShiftingWind(tuple(range(5)), HOURS, strength=6.0), graph=Uniform(150.0, 8))
    begins = [2700.0 * k for k in range(4)]

    def found(problem, begin: float) -> tuple[float, list]:
        route = find_route(problem, CostChoice("time"), begin, shaping=unshaped)
        return route.arrival, route.points.tolist()

    alone = [found(pose_problem(asked), begin) for begin in begins]
    shared = pose_problem(asked)
    with ThreadPoolExecutor(THREADS) as pool:
        assert list(pool.map(lambda begin: found(shared, begin), begins)) == alone


def test_no_moment_is_sampled_twice():
    @dataclass(frozen=True)
    class Counted(ShiftingWind):
        asked: tuple[list[float], ...] = ([],)

        def at(self, points, seconds=0.0):
            if np.ndim(seconds) == 0 and len(points) > 2:
                self.asked[0].append(float(seconds))
            return super().at(points, seconds)

    veil = lay_grid(rules_over(rough_dem(1, relief=20.0), maximum=110.0), AREA, 150.0, (40.0,), 16)
    wind = Counted(tuple(range(5)), HOURS)
    graph = sample_wind(veil, wind)
    for begin, until in ((0.0, 8000.0), (9000.0, 14_000.0), (0.0, 8000.0), (3600.0, 14_000.0)):
        air = graph.winds_between(begin, until)
        assert air.times is not None
        assert air.times[0] <= begin
        assert air.times[-1] >= until
        assert air.winds.shape == (len(air.times), veil.size, 3)
    assert sorted(wind.asked[0]) == [3600.0 * hour for hour in range(5)]
    assert graph.sampled == tuple(wind.asked[0])


def test_a_graph_travels_with_the_moments_that_are_sampled():
    veil = lay_grid(rules_over(rough_dem(1, relief=20.0), maximum=110.0), AREA, 150.0, (40.0,), 16)
    graph = sample_wind(veil, ShiftingWind(tuple(range(5)), HOURS))
    graph.winds_between(0.0, 100.0)
    copy = pickle.loads(pickle.dumps(graph))
    assert copy.sampled == graph.sampled == HOURS[:2]
    assert (copy.winds_between(0.0, 14_000.0).winds == graph.winds_between(0.0, 14_000.0).winds).all()
    assert copy.sampled == HOURS
