"""Routes that keep the limits of wind and gust, and what is said where none does."""

from __future__ import annotations

import re
from dataclasses import dataclass, replace
from datetime import UTC, datetime, timedelta

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from typer.testing import CliRunner

import gcs_windplan as gw
from gcs_windplan.cli.app import app
from gcs_windplan.cli.tables import summary_lines
from gcs_windplan.errors import NoRouteError, RequestError
from gcs_windplan.jobs.requests import read_request
from gcs_windplan.planning.cost import COSTS
from gcs_windplan.planning.departures import sweep
from gcs_windplan.planning.limits import strongest_along
from gcs_windplan.planning.planner import plan_route
from gcs_windplan.planning.request import Limits, Roadmap, Site, Uniform
from gcs_windplan.wind import ConstantWind, PowerLaw, ProfileWind
from gcs_windplan.wind.field import Steady
from tests.ensembles import Corridor, Everywhere, Gate, divided, request
from tests.scenes import changed
from tests.worlds import WavyWind, rough_dem

WITHOUT_AIRFRAME = [name for name in COSTS if name != "energy"]  # that one asks for an airframe


@dataclass(frozen=True)
class Curtain(Steady):
    """A gale along north in a curtain 30 m thick across the way, between all nodes of a grid, with a gap in it."""

    gap: float = 60.0
    strength: float = 12.0
    name: str = "curtain"
    resolution: float = 5.0

    def at(self, points, seconds=0.0):
        thick = np.clip((15.0 - np.abs(points[:, 0] - self.middle)) / 5.0, 0.0, 1.0)
        wide = np.clip((np.abs(points[:, 1] - 300.0) - self.gap) / 5.0, 0.0, 1.0)
        blows = self.strength * thick * wide
        return np.column_stack([0 * blows, blows, 0 * blows])

    @property
    def middle(self) -> float:
        """Half-way between two columns of nodes that are 60 m apart, the first 1400 m west of the origin."""
        return -1400.0 + 23.5 * 60.0


def met(plan, fields=None, samples=4000):
    """The strongest wind along a plan's route, by dense sampling of each leg."""
    corners = np.array([(w.east, w.north, w.altitude) for w in plan.waypoints])
    times = np.array([w.seconds for w in plan.waypoints])
    share = np.linspace(0, 1, samples)[:, None]
    return max(
        float(np.nanmax(np.hypot(*field.at(a + share * (b - a), s + share[:, 0] * (t - s))[:, :2].T)))
        for field in fields or (plan.request.scene.wind,)
        for a, b, s, t in zip(corners[:-1], corners[1:], times[:-1], times[1:], strict=True)
    )


def test_a_route_stays_out_of_the_wind_that_is_too_strong():
    asked = request(wind=Corridor(6.0))
    free = plan_route(asked)
    bound = plan_route(replace(asked, limits=Limits(wind=4.0)))
    assert met(free) > 5.9
    assert free.strongest is None
    assert 3.5 < met(bound) <= 4.0
    assert bound.strongest.wind == pytest.approx(met(bound), abs=0.01)
    assert free.totals.seconds < bound.totals.seconds < 180.0  # 1.8 km at 10 m/s: half in the corridor's edge
    assert bound.request.scene.wind == Corridor(6.0)


@pytest.mark.parametrize("graph", [Uniform(60.0), Uniform(60.0, 64), Roadmap(nodes=700, seed=3)])
@pytest.mark.parametrize("cost", WITHOUT_AIRFRAME)
def test_a_curtain_between_the_nodes_is_passed_through_its_gap(graph, cost):
    vehicle = gw.Vehicle(14.0)
    asked = request(wind=Curtain(), vehicle=vehicle, graph=graph, cost=gw.CostChoice(cost))
    assert met(plan_route(asked)) > 10.0
    bound = plan_route(replace(asked, limits=Limits(wind=10.0)))
    assert met(bound) <= 10.0
    assert bound.totals.distance > 1850.0


@pytest.mark.parametrize("graph", [Uniform(60.0), Roadmap(nodes=700, seed=3)])
def test_a_curtain_without_a_gap_leaves_no_route_and_the_limit_is_the_reason(graph):
    asked = request(wind=Curtain(gap=-5.0), vehicle=gw.Vehicle(14.0), graph=graph, limits=Limits(wind=10.0))
    with pytest.raises(
        NoRouteError, match=r"blocked by wind limit \(limits\.wind, 10 m/s\): \d+ legs.* A higher limit"
    ):
        plan_route(asked)


def test_wind_that_grows_with_height_is_a_ceiling():
    """By (h / 10)^0.25 · 5 m/s the wind reaches 7.5 m/s at 50.6 m; a percent below that is kept free."""
    dem = rough_dem(1, size=1500.0, relief=40.0)
    wind = ProfileWind(ConstantWind.from_direction(5.0, 270.0), dem.heights_at, PowerLaw(10.0, 0.25), 60.0)
    asked = request(terrain=dem, wind=wind, layers=(30.0, 40.0, 60.0, 90.0))
    assert plan_route(asked).totals.height > 100.0
    bound = plan_route(replace(asked, limits=Limits(wind=7.5)))
    assert 45.0 < bound.totals.height <= 10.0 * (7.5 / 5.0) ** 4
    assert met(bound) <= 7.5


@settings(max_examples=20, deadline=None)
@given(st.integers(0, 10_000), st.floats(2.0, 9.0), st.sampled_from([Uniform(60.0), Roadmap(nodes=500)]))
def test_what_is_planned_keeps_the_limit(seed, limit, graph):
    asked = request(
        terrain=rough_dem(seed, size=1500.0, relief=60.0), wind=WavyWind(seed, strength=8.0), graph=graph,
        limits=Limits(wind=limit), vehicle=gw.Vehicle(14.0),
    )  # fmt: skip
    try:
        plan = plan_route(asked)
    except (NoRouteError, RequestError) as error:
        assert "wind" in str(error)  # noqa: PT017
    else:
        assert met(plan) <= limit


def test_a_site_in_too_strong_a_wind_is_an_error_at_once():
    north = Site("goal", 900.0, 600.0)
    with pytest.raises(RequestError) as caught:
        plan_route(request(wind=Corridor(6.0), goal=north, limits=Limits(wind=4.0)))
    (problem,) = caught.value.problems
    assert problem.field == "goal"
    assert problem.message.startswith("the wind there is 6.00 m/s or more, too much for limits.wind, 4 m/s: another")
    with pytest.raises(RequestError) as caught:
        plan_route(request(wind=Everywhere(6.0), limits=Limits(wind=4.0)))
    assert [problem.field for problem in caught.value.problems] == ["start", "goal"]


def test_what_opens_later_is_said():
    """For half an hour a wall of wind stands across the way, which the vehicle could fly through."""
    asked = request(wind=Gate(1800.0), vehicle=gw.Vehicle(35.0), limits=Limits(wind=10.0))
    plan_route(replace(asked, limits=Limits()))
    with pytest.raises(NoRouteError, match=r"wind limit \(limits\.wind, 10 m/s\).* when leaving 40 min later"):
        plan_route(asked)


def test_a_limit_is_looked_at_between_the_forecasts_times():
    """The wind of this morning grows from nothing to 20 m/s within 6 h: 10 m/s are reached after 3 h, not before."""

    @dataclass(frozen=True)
    class Growing:
        name: str = "growing"
        resolution: float = 1000.0
        times: tuple[float, ...] = (0.0, 21_600.0)

        def at(self, points, seconds=0.0):
            blows = np.broadcast_to(np.asarray(seconds, dtype=float), len(points)) / 1080.0
            return np.column_stack([blows, *np.zeros((2, len(points)))])

    growing = Growing()
    object.__setattr__(growing, "times", np.array([0.0, 21_600.0]))
    begin = datetime(2026, 5, 1, tzinfo=UTC)
    asked = request(wind=growing, vehicle=gw.Vehicle(30.0), limits=Limits(wind=10.0), departure=begin)
    moments = [begin + timedelta(minutes=m) for m in (0, 120, 165, 182, 240)]
    found = list(sweep(asked, moments, cores=1))
    assert [one.feasible for one in found] == [True, True, True, False, False]
    assert found[2].wind == pytest.approx(165 / 18, abs=0.1)
    assert all("wind limit" in one.reason for one in found[3:])


def test_members_that_break_the_limit_count_as_ones_that_cannot_fly():
    """Three of ten members blow 7 m/s, against a limit of 6.5; seven 6."""
    asked = replace(divided(0.5), limits=Limits(wind=6.5))
    plan = plan_route(asked)
    assert plan.spread.unflyable in (0, 3)  # they are closed in the corridor only
    assert plan.strongest.within_limits(asked.limits) == 10 - plan.spread.unflyable
    assert met(plan, asked.scene.members[:1]) <= 6.5
    robust = plan_route(replace(asked, robust=0.9))
    assert robust.strongest.within_limits(asked.limits) >= 9
    with pytest.raises(RequestError, match=r"limits\.wind"):
        plan_route(changed(asked, wind=Everywhere(7.0), members=(Everywhere(7.0),) * 10))


def test_gusts_are_limited_where_the_forecast_tells_them():
    asked = request(wind=Corridor(6.0), gusts=(Corridor(9.0),), limits=Limits(gust=6.0))
    assert plan_route(replace(asked, limits=Limits(wind=7.0))).strongest.gust > 8.8
    bound = plan_route(asked)
    assert met(bound, asked.scene.gusts) <= 6.0
    assert bound.strongest.gust == pytest.approx(met(bound, asked.scene.gusts), abs=0.01)
    with pytest.raises(RequestError) as caught:
        plan_route(changed(asked, gusts=()))
    (problem,) = caught.value.problems
    assert problem.field == "limits.gust"
    assert problem.message.startswith("the forecast has no gusts (corridor): leave the limit out")
    with pytest.raises(RequestError, match=r"the gusts there are 9\.00 m/s or more, too much for limits\.gust, 6 m/s"):
        plan_route(replace(asked, goal=Site("goal", 900.0, 600.0)))


def test_the_strongest_wind_is_that_of_a_naive_look():
    asked = request(wind=WavyWind(5, strength=6.0), limits=Limits(wind=12.0))
    plan = plan_route(asked)
    points = np.array([(w.east, w.north, w.altitude) for w in plan.waypoints])
    strongest = strongest_along(asked, points)
    assert strongest.winds.shape == (1, len(plan.legs))
    assert strongest.wind == pytest.approx(met(plan), abs=0.02)
    assert strongest.gust is None


def test_the_mission_files_limits_reach_the_plan_and_are_printed(gallery, tmp_path):
    assert read_request(gallery / "rounds.yaml").limits == Limits(9.0, None, 0.3, 300.0, None)
    done = CliRunner().invoke(app, ["plan", str(gallery / "rounds.yaml"), "-o", str(tmp_path)])
    assert done.exit_code == 0, done.output
    assert re.search(r"^strongest: wind 8\.[5-9] m/s \(limits\.wind 9 m/s\)$", done.output, re.MULTILINE)


def test_gusts_of_a_file(gallery, tmp_path):
    def written(name: str, limits: str):
        text = (gallery / f"{name}.yaml").read_text().replace("{max_height: 120 m}", limits)
        text = text.replace("forecast: wind/", f"forecast: {gallery}/wind/").replace(
            "airframe: ", f"airframe: {gallery}/"
        )
        path = tmp_path / f"{name}.yaml"
        path.write_text(text)
        return read_request(path)

    plan = plan_route(written("front", "{max_height: 120 m, wind: 9 m/s, gust: 10 m/s}"))
    assert 8.0 < plan.strongest.gust <= 10.0
    assert plan.strongest.winds.shape == plan.strongest.gusts.shape == (10, len(plan.legs))
    (line,) = [line for line in summary_lines(plan) if line.startswith("strongest")]
    assert re.search(r"in any of the 10 members: wind \d\.\d m/s \(limits\.wind 9 m/s\), gust \d+\.\d m/s", line)
    assert line.endswith("10 of 10 keep the limits")
    with pytest.raises(RequestError, match=r"jacksboro\.yaml:\d+:\d+: limits\.gust: the forecast has no gusts"):
        plan_route(written("jacksboro", "{max_height: 120 m, gust: 10 m/s}"))
