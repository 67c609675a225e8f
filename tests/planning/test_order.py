"""The order of the vias that costs least: as good as trying them all, and what is said where there is none."""

from __future__ import annotations

from dataclasses import dataclass, replace
from itertools import pairwise, permutations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import gcs_windplan as gw
from gcs_windplan.errors import NoRouteError, RequestError
from gcs_windplan.jobs.requests import read_request
from gcs_windplan.planning.order import Costs, best_order, optimise_order
from gcs_windplan.planning.planner import plan_route
from gcs_windplan.planning.problem import pose_problem
from gcs_windplan.planning.request import Limits, Roadmap, Site, Uniform
from gcs_windplan.planning.route import find_route, unshaped
from gcs_windplan.scene import Airspace, Prism
from gcs_windplan.wind import Calm, ConstantWind
from gcs_windplan.wind.field import Steady
from tests.ensembles import Gate, divided, request
from tests.jobs.missionfile.missions import complaints, mission, read
from tests.scenes import changed
from tests.worlds import ShiftingWind, WavyWind, rough_dem

TIME = gw.CostChoice("time")


def vias(*places: tuple[float, float]) -> tuple[Site, ...]:
    return tuple(Site(f"via.{i}", east, north) for i, (east, north) in enumerate(places))


def scattered(seed: int, count: int) -> tuple[Site, ...]:
    """Places at random, at least 100 m apart."""
    rng, places = np.random.default_rng(seed), [(-900.0, 0.0), (900.0, 0.0)]
    while len(places) < count + 2:
        place = rng.uniform(-800, 800, 2)
        if min(np.hypot(*(place - other)) for other in places) > 100:
            places.append(tuple(place.tolist()))
    return vias(*places[2:])


def graph_cost(asked, order, choice=TIME) -> float:
    """What the graph's route costs with the vias in an order."""
    problem = pose_problem(replace(asked, via=tuple(asked.via[i] for i in order), order="given"))
    try:
        return find_route(problem, choice, 0.0, shaping=unshaped).cost
    except NoRouteError:
        return np.inf


def chosen(asked, choice=TIME) -> list[int]:
    """The numbers of the vias, from 0, in the order that is found."""
    ordered = optimise_order(pose_problem(asked), choice)[0]
    return [asked.via.index(via) for via in ordered.request.via]


def tried_all(costs: Costs, begin: float) -> float:
    """The least cost over all orders, each flown by the clock."""

    def total(order: tuple[int, ...]) -> float:
        spent, clock = 0.0, begin
        for a, b in pairwise((0, *order, len(order) + 1)):
            if not np.isfinite(clock):
                return np.inf
            cost, seconds = costs.between([a], np.array([clock]), b)
            spent, clock = spent + cost[0], clock + seconds[0]
        return spent

    return min(total(order) for order in permutations(range(1, costs.costs.shape[1] - 1)))


def cost_along(costs: Costs, order: tuple[int, ...], begin: float) -> float:
    spent, clock = 0.0, begin
    for a, b in pairwise((0, *order, len(order) + 1)):
        cost, seconds = costs.between([a], np.array([clock]), b)
        spent, clock = spent + cost[0], clock + seconds[0]
    return spent


@settings(max_examples=40, deadline=None)
@given(st.integers(0, 10_000), st.integers(1, 6), st.floats(0, 0.5))
def test_no_order_is_better_than_the_one_found(seed, count, closed):
    """Random costs there and back, of which some are no ways at all."""
    rng = np.random.default_rng(seed)
    table = rng.uniform(1, 10, (1, count + 2, count + 2))
    table[rng.uniform(size=table.shape) < closed] = np.inf
    costs = Costs(np.zeros(1), table, 10 * table)
    order = best_order(costs)
    best = tried_all(costs, 0.0)
    if order is None:
        assert best == np.inf
    else:
        assert sorted(order) == list(range(1, count + 1))
        assert cost_along(costs, order, 0.0) == pytest.approx(best)


@settings(max_examples=40, deadline=None)
@given(st.integers(0, 10_000), st.integers(2, 5))
def test_in_changing_costs_each_way_is_taken_when_it_is_reached(seed, count):
    """Seconds that change slowly: who leaves later does not arrive earlier, so that subsets suffice."""
    rng = np.random.default_rng(seed)
    seconds = np.cumsum(rng.uniform(0, 1, (3, count + 2, count + 2)), axis=0) * 10 + 50
    costs = Costs(np.array([0.0, 200.0, 400.0]), seconds, seconds)
    order = best_order(costs, 20.0)
    assert cost_along(costs, order, 20.0) == pytest.approx(tried_all(costs, 20.0))


@pytest.mark.parametrize("graph", [Uniform(120.0, 8), Roadmap(nodes=250, seed=5)])
@pytest.mark.parametrize("seed", [1, 2, 3])
def test_it_is_the_best_of_all_orders_on_the_graph(seed, graph):
    asked = request(
        terrain=rough_dem(seed, size=1500.0, relief=30.0), wind=WavyWind(seed, strength=4.0),
        via=scattered(seed, 5), order="free", graph=graph,
    )  # fmt: skip
    best = min(graph_cost(asked, order) for order in permutations(range(5)))
    assert graph_cost(asked, chosen(asked)) == pytest.approx(best)


@pytest.mark.parametrize("name", ["distance", "angle", "hybrid"])
def test_by_every_cost(name):
    choice = gw.CostChoice(name)
    asked = request(wind=WavyWind(4), via=scattered(4, 4), order="free", graph=Uniform(120.0, 8), cost=choice)
    best = min(graph_cost(asked, order, choice) for order in permutations(range(4)))
    assert graph_cost(asked, chosen(asked, choice), choice) == pytest.approx(best, rel=1e-6)


@pytest.mark.parametrize("blows_from", [0.0, 180.0])
def test_wind_makes_another_order_than_the_map(blows_from):
    """By the formula of a constant wind the order of still air takes 6 % longer. Whether it blows from north or from
    south is all one: what it gives on the way there it takes on the way back, as start and goal stay where they are."""
    places = vias((700.0, -700.0), (300.0, -300.0), (200.0, -800.0), (800.0, 200.0))
    asked = request(wind=Calm(), via=places, order="free", goal=Site("goal", -900.0, 300.0))
    windy = changed(asked, wind=ConstantWind.from_direction(7.0, blows_from))
    assert (chosen(asked), chosen(windy)) == ([2, 0, 3, 1], [2, 0, 1, 3])
    assert graph_cost(windy, [2, 0, 1, 3]) < 0.97 * graph_cost(windy, [2, 0, 3, 1])
    assert graph_cost(asked, [2, 0, 3, 1]) < graph_cost(asked, [2, 0, 1, 3])


@dataclass(frozen=True)
class Whirl(Steady):
    """Air that turns around the origin, counter-clockwise for positive strengths."""

    strength: float
    name: str = "whirl"
    resolution: float = 50.0

    def at(self, points, seconds=0.0):
        far = np.maximum(np.hypot(points[:, 0], points[:, 1]), 300.0)
        return np.column_stack([-points[:, 1], points[:, 0], 0 * far]) * (self.strength / far)[:, None]


@pytest.mark.parametrize("strength", [6.0, -6.0])
def test_a_round_is_flown_with_the_whirl(strength):
    """There and back differ: on the map both ways round are as long."""
    places = vias((0.0, -700.0), (0.0, 700.0), (700.0, 0.0))
    west = {"start": Site("start", -700.0, 0.0), "goal": Site("goal", -700.0, 0.0)}
    asked = request(wind=Whirl(strength), via=places, order="free", **west)
    assert chosen(asked) == ([0, 2, 1] if strength > 0 else [1, 2, 0])
    assert graph_cost(asked, chosen(asked)) < 0.5 * graph_cost(asked, chosen(asked)[::-1])


def test_in_changing_wind_the_order_is_no_worse_than_any():
    asked = request(
        wind=ShiftingWind((1, 2), (0.0, 2000.0), strength=6.0), via=scattered(9, 4), order="free",
        graph=Uniform(120.0, 8),
    )  # fmt: skip
    costs = sorted(graph_cost(asked, order) for order in permutations(range(4)))
    assert graph_cost(asked, chosen(asked)) <= costs[0] * 1.005  # costs are known at three moments only


def test_the_plan_flies_the_order_and_says_what_it_saves():
    places = vias((500.0, 0.0), (-500.0, 100.0), (0.0, -100.0))
    asked = request(wind=Calm(), via=places, order="free")
    plan, given = plan_route(asked), plan_route(replace(asked, order="given"))
    assert [via.field for via in plan.request.via] == ["via.1", "via.2", "via.0"]
    passed = [(w.east, w.north) for w in plan.waypoints]
    assert [passed.index((via.east, via.north)) for via in plan.request.via] == [1, 2, 3]
    saved = given.totals.seconds - plan.totals.seconds
    assert plan.notes[0].startswith("order of the vias: 2, 3, 1; saves ")
    minutes, seconds = plan.notes[0].split("saves ")[1].split(" min")[0].split(":")
    assert 60 * int(minutes) + int(seconds) == pytest.approx(saved, rel=0.1)  # the graph's, not yet shaped
    assert plan_again(plan).notes[0] == "order of the vias: as given, which is the best one"
    assert given.notes == ()


def plan_again(plan):
    return plan_route(plan.request)


def test_one_via_needs_no_order():
    asked = request(wind=Calm(), via=vias((0.0, 300.0)), order="free")
    assert plan_route(asked).notes == ()


def test_over_an_ensemble_the_mean_counts():
    asked = replace(divided(), via=scattered(2, 3), order="free")
    mean = asked.in_the_mean()
    assert chosen(asked) == chosen(mean)


@dataclass(frozen=True)
class Ring(Steady):
    """A gale out of a ring around a place, or into it."""

    strength: float
    name: str = "ring"
    resolution: float = 20.0

    def at(self, points, seconds=0.0):
        away = points[:, :2] - 300.0
        far = np.maximum(np.hypot(*away.T), 1e-9)
        blows = np.where(np.abs(far - 200.0) < 90.0, self.strength, 0.0)
        return np.column_stack([blows * away[:, 0] / far, blows * away[:, 1] / far, 0 * far])


@pytest.mark.parametrize(("strength", "way"), [(30.0, "reached"), (-30.0, "left")])
def test_a_via_behind_a_gale_is_named(strength, way):
    asked = request(
        wind=Ring(strength), via=vias((-300.0, 0.0), (300.0, 300.0), (0.0, -300.0)), order="free", graph=Uniform(50.0)
    )
    with pytest.raises(NoRouteError, match=rf"^via\.1: cannot be {way} on any way: no route: .* blocked by wind"):
        plan_route(asked)


def test_a_via_that_an_area_closes_in_is_named():
    walls = [Prism(f"wall {i}", wall) for i, wall in enumerate(_walls(150.0, 450.0, 60.0))]
    asked = request(
        wind=Calm(), via=vias((300.0, 300.0), (-300.0, 0.0)), order="free", airspace=Airspace(keep_out=tuple(walls))
    )
    with pytest.raises(NoRouteError, match=r"^via\.0: cannot be reached on any way: .*keep-out or keep-in area"):
        plan_route(asked)


def _walls(low: float, high: float, thick: float) -> list[np.ndarray]:
    """Four walls around the middle of a square."""
    west, south, east, north = low, low, high, high
    return [
        np.array([[west, south], [east, south], [east, south + thick], [west, south + thick]]),
        np.array([[west, north - thick], [east, north - thick], [east, north], [west, north]]),
        np.array([[west, south], [west + thick, south], [west + thick, north], [west, north]]),
        np.array([[east - thick, south], [east, south], [east, north], [east - thick, north]]),
    ]


def test_limits_hold_while_the_order_is_sought():
    asked = request(wind=Gate(1800.0), via=vias((400.0, 100.0), (-400.0, 0.0)), order="free", vehicle=gw.Vehicle(35.0))
    assert [via.field for via in plan_route(asked).request.via] == ["via.1", "via.0"]
    with pytest.raises(NoRouteError, match="wind limit"):
        plan_route(replace(asked, limits=Limits(wind=10.0)))


def test_more_than_twelve_are_refused_and_twelve_are_ordered():
    east = np.linspace(-800.0, 800.0, 13)
    shuffled = [5, 2, 11, 0, 7, 9, 1, 4, 10, 3, 8, 6]
    asked = request(wind=Calm(), via=vias(*((east[i], 0.0) for i in shuffled)), order="free", graph=Uniform(120.0, 8))
    assert chosen(asked) == [shuffled.index(i) for i in range(12)]
    with pytest.raises(RequestError, match=r"order: 13 places are more than the 12 that can be put in order"):
        plan_route(replace(asked, via=(*asked.via, Site("via.12", 0.0, 500.0))))


def test_places_that_come_twice_are_refused():
    asked = request(wind=Calm(), via=vias((0.0, 0.0), (500.0, 0.0), (0.0, 0.0), (900.0, 0.0)), order="free")
    with pytest.raises(RequestError) as caught:
        plan_route(asked)
    assert [(problem.field, problem.message.split(":")[0]) for problem in caught.value.problems] == [
        ("via.2", "is the same place as via.0"),
        ("via.3", "is the same place as goal"),
    ]


def test_the_mission_file_says_so_too():
    there = "{latitude: 36.55, longitude: -84.25}"
    assert read(via=f"[{there}]", order="free").model.order == "free"
    assert read(via=f"[{there}]").model.order == "given"
    start = "{latitude: 36.5, longitude: -84.3}"
    other = "{latitude: 36.52, longitude: -84.25}"
    assert complaints(mission(via=f"[{there}, {other}, {there}]", order="free")) == [
        "7:83: via.2: is the same place as via.0; there is nothing to fly in between"
    ]
    assert read(via=f"[{there}, {other}, {there}]").model.order == "given"
    assert complaints(mission(via=f"[{there}, {start}]", order="free"))[0].startswith(
        "7:45: via.1: is the same place as"
    )
    assert read(start=start, goal=start, via=f"[{there}, {other}]", order="free").model.order == "free"
    many = ", ".join(f"{{latitude: 36.{50 + i}, longitude: -84.25}}" for i in range(13))
    assert complaints(mission(via=f"[{many}]", order="free")) == [
        "8:8: order: 13 places are more than the 12 that can be put in order; give the order"
    ]
    assert complaints(mission(order="best")) == ["7:8: order: write given or free, not 'best'"]


def test_the_gallerys_round_is_another_one_in_still_air(gallery):
    asked = read_request(gallery / "rounds.yaml")
    assert asked.order == "free"
    windy, calm = (chosen(one) for one in (asked, changed(asked, wind=Calm())))
    assert windy != calm
    assert graph_cost(asked, windy) < 0.92 * min(graph_cost(asked, calm), graph_cost(asked, calm[::-1]))
