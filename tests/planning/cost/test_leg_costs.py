"""Costs are one class each: what theirs say, and a new one that the planner takes as any."""

from __future__ import annotations

import math
import pickle
from typing import get_args

import numpy as np
import pytest

from gcs_windplan.errors import InputError
from gcs_windplan.jobs.missionfile.model import MissionModel
from gcs_windplan.kernels import edges
from gcs_windplan.planning.cost import COSTS, CostChoice, LegCost, LegFigures
from gcs_windplan.planning.planner import plan_routes
from gcs_windplan.planning.request import Uniform
from gcs_windplan.terrain import Dem
from gcs_windplan.wind import Calm
from tests.ensembles import request


class Lazy(LegCost):
    """Time, with each metre of climb as bad as half a minute; searched as time, priced in Python."""

    name, unit, code = "lazy", "s", edges.TIME
    of_air = True

    def price(self, legs: LegFigures) -> np.ndarray:
        return legs.seconds + 30.0 * np.maximum(legs.climbs, 0.0)

    def words(self, amount: float) -> str:
        return f"{amount:.0f} lazy seconds"


@pytest.fixture
def lazy(monkeypatch) -> CostChoice:
    monkeypatch.setitem(COSTS, "lazy", Lazy())
    return CostChoice("lazy")


def climbed(plan) -> float:
    return sum(max(leg.climb, 0.0) for leg in plan.legs)


def hill() -> Dem:
    """A hill of 60 m a little to the north of the way."""
    axis = np.arange(-1500.0, 1501.0, 50.0)
    east, north = np.meshgrid(axis, axis[::-1])
    return Dem.local(60.0 * np.exp(-(east**2 + (north - 100.0) ** 2) / 300.0**2), -1500.0, 1500.0, 50.0)


def test_a_new_cost_is_a_class_and_an_entry(lazy):
    """The quickest way leads over the side of a hill, the lazy one around it."""
    asked = request(terrain=hill(), wind=Calm(), graph=Uniform(75.0, 8))
    quick, level = plan_routes(asked, [CostChoice("time"), lazy])
    assert climbed(level) < 0.8 * climbed(quick)
    assert level.totals.seconds >= quick.totals.seconds
    assert level.cost == pytest.approx(level.totals.seconds + 30.0 * climbed(level), rel=1e-6)
    assert str(level.choice) == "lazy"
    assert lazy.leg_cost.words(12.3) == "12 lazy seconds"


def test_a_cost_that_is_not_entered_is_refused():
    with pytest.raises(InputError, match="'lazy' is no cost, choose distance, angle, hybrid, time, energy"):
        CostChoice("lazy")


def test_choices_travel_between_processes(lazy):
    assert pickle.loads(pickle.dumps(lazy)) == lazy
    assert pickle.loads(pickle.dumps(CostChoice("hybrid", 0.2, 0.8))) == CostChoice("hybrid", 0.2, 0.8)


def test_mission_files_know_all_costs():
    cost = MissionModel.model_fields["cost"].annotation
    assert get_args(cost.model_fields["name"].annotation) == tuple(COSTS)


def test_what_the_costs_make_of_two_legs():
    figures = LegFigures(
        seconds=np.array([10.0, 20.0]), angle=np.array([50.0, 0.0]), lengths=np.array([100.0, 200.0]),
        climbs=np.array([5.0, -5.0]), edge_length=50.0, straight=250.0, angle_weight=0.9, distance_weight=0.1,
    )  # fmt: skip
    expected = {"distance": [100, 200], "angle": [1, 0], "time": [10, 20]}
    expected["hybrid"] = [0.9 / math.pi + 0.1 * 0.4, 0.1 * 0.8]
    for name, prices in expected.items():
        assert COSTS[name].price(figures) == pytest.approx(prices)
    assert [cost.unit for cost in COSTS.values()] == ["m", "rad", "1", "s", "J"]
    assert [cost.words(7200.0) for cost in COSTS.values()] == ["7.20 km", None, None, "120:00 min", "2 Wh"]
    assert [cost.waypoint_penalty(0.7) for cost in COSTS.values()] == [0, 0, 0, 0.7, 0]
