"""The battery through a mission, and missions that it does not carry."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
import pytest
from typer.testing import CliRunner

from gcs_windplan.assessment import assess_plan
from gcs_windplan.cli.app import app
from gcs_windplan.errors import BatteryError
from gcs_windplan.jobs.missionfile.airframe import read_airframe
from gcs_windplan.planning.battery import Allowance, BatteryUse, allowances_of, check_reserve
from gcs_windplan.planning.export import flown_duration
from gcs_windplan.planning.planner import plan_route, plan_routes
from gcs_windplan.planning.request import Limits
from gcs_windplan.wind import Calm
from tests.ensembles import divided, request
from tests.plans import planned

WATT_HOUR = 3600.0


@pytest.fixture
def airframe(gallery):
    return read_airframe(gallery / "vehicles" / "small_quadcopter.yaml")


def smaller(airframe, joules: float):
    return replace(airframe, battery=replace(airframe.battery, capacity=joules))


def test_what_is_left_falls_from_waypoint_to_waypoint(airframe):
    plan = plan_route(request(wind=Calm(), airframe=airframe))
    use = plan.battery
    takeoff, en_route, landing = as_flown(plan)
    assert use.total == pytest.approx(takeoff + en_route + landing)
    assert use.left[0] == pytest.approx(1 - takeoff / airframe.battery.capacity)
    assert use.left[-1] == pytest.approx(1 - (takeoff + en_route) / airframe.battery.capacity)
    assert list(use.left) == sorted(use.left, reverse=True)
    assert use.missing == 0
    returning = plan_route(request(wind=Calm(), airframe=airframe, finish="hold"))
    assert returning.battery.total == pytest.approx(use.total - landing)


@pytest.mark.parametrize("name", ["shear", "rounds", "front"])
def test_the_review_of_the_mission_that_is_written_finds_the_same(name):
    """Two ways to the battery's end: the plan's legs made longer, and the mission's items flown sample by sample."""
    plan = planned(name)
    review = assess_plan(plan)
    end = plan.totals.takeoff_energy + plan.totals.landing_energy + plan.totals.energy
    assert review.totals.energy > 1.01 * end
    assert plan.battery.left[-1] == pytest.approx(review.stops[-1].left, abs=0.012)


def as_flown(plan) -> tuple[float, float, float]:
    """Take-off, one leg and landing [J], each as much longer than planned as the mission takes."""
    totals, flown = plan.totals, flown_duration(plan)
    takeoff = totals.takeoff_energy * flown.takeoff / totals.takeoff_seconds
    landing = totals.landing_energy * flown.ending / totals.landing_seconds
    return takeoff, totals.energy * flown.en_route / totals.seconds, landing


def test_a_mission_that_breaks_the_reserve_is_refused_and_says_by_how_much(airframe):
    """1.8 km take about 36 Wh with both ends: of 45 Wh 36 are usable, and 28.8 with the reserve."""
    asked = request(wind=Calm(), airframe=airframe)
    total = plan_route(asked).battery.total
    weak = replace(asked, airframe=smaller(airframe, total / 0.8 * 1.01))
    with pytest.raises(BatteryError) as error:
        plan_route(weak)
    missing = (total - total * 1.01 * 0.8) / 3600
    assert f"breaks the reserve by {missing:.0f} Wh" in str(error.value)
    assert plan_routes(weak, [weak.cost])[0].battery.missing == pytest.approx(missing * 3600)
    plan_route(replace(asked, airframe=smaller(airframe, total / 0.64 * 1.01)))


@dataclass(frozen=True)
class Steady300:
    """300 W, whatever it does; in thin air twice as much."""

    mass: float = 4.21

    def airspeeds(self, density=1.225):
        return 0.0, 17.0

    def watts(self, airspeed, climb_rate, density=1.225):
        power = np.where(np.asarray(density) < 0.7, 600.0, 300.0)
        return power * np.ones(np.broadcast_shapes(*map(np.shape, (airspeed, climb_rate, density))))


def test_what_a_flight_may_draw_by_each_rule(airframe):
    """100 Wh, of which 80 are usable. The reserve of 20 % leaves 64 Wh to draw; 30 % of the whole left, 70 Wh; 6 min
    at 300 W are 30 Wh beside the 20 that are not usable, 50 Wh. At 6 km, where it takes twice as much, 20 Wh."""
    known = replace(smaller(airframe, 100 * WATT_HOUR), power=Steady300())
    asked = request(wind=Calm(), airframe=known, limits=Limits(battery=0.3, reserve_seconds=360.0))
    drawn = {one.rule: one.energy / WATT_HOUR for one in allowances_of(asked, 100.0)}
    assert drawn == {
        "the reserve": pytest.approx(64.0),
        "limits.battery (30 % left of 100 Wh)": pytest.approx(70.0),
        "limits.reserve (6 min at 300 W)": pytest.approx(50.0),
    }
    assert allowances_of(asked, 6000.0)[-1].energy == pytest.approx(20 * WATT_HOUR)
    assert [one.rule for one in allowances_of(replace(asked, limits=Limits()), 100.0)] == ["the reserve"]
    assert allowances_of(replace(asked, airframe=None), 100.0) == ()


def test_the_strictest_rule_counts_and_all_that_are_broken_are_named():
    rules = (Allowance("the reserve", 64 * WATT_HOUR), Allowance("limits.battery (50 % left of 100 Wh)", 180_000.0))
    use = BatteryUse((), 60 * WATT_HOUR, 80 * WATT_HOUR, rules)
    assert (use.allowed, use.missing) == (50 * WATT_HOUR, 10 * WATT_HOUR)
    with pytest.raises(
        BatteryError, match=r"takes 60 Wh, and with what must be left the battery gives 50 of 80 usable"
    ):
        check_reserve(use)
    with pytest.raises(BatteryError, match=r"it breaks limits\.battery \(50 % left of 100 Wh\) by 10 Wh\. Another"):
        check_reserve(use)
    with pytest.raises(BatteryError, match=r"breaks the reserve by 6 Wh and limits\.battery .* by 20 Wh"):
        check_reserve(replace(use, total=70 * WATT_HOUR))
    check_reserve(replace(use, total=50 * WATT_HOUR))
    hopeless = BatteryUse((), 3600.0, 3600.0, (Allowance("limits.reserve (60 min at 300 W)", -1e6),))
    assert (hopeless.allowed, hopeless.missing) == (0.0, 3600.0)


def test_a_plan_keeps_the_limits_of_its_battery(airframe):
    asked = request(wind=Calm(), airframe=airframe)
    use = plan_route(asked).battery
    share = use.total / airframe.battery.capacity
    plan_route(replace(asked, limits=Limits(battery=1 - share - 1e-6)))
    with pytest.raises(BatteryError, match=r"limits\.battery"):
        plan_route(replace(asked, limits=Limits(battery=1 - share + 1e-6)))
    with pytest.raises(BatteryError, match=r"breaks limits\.reserve \(30 min at \d+ W\) by"):
        plan_route(replace(asked, limits=Limits(reserve_seconds=1800.0)))


def test_over_an_ensemble_the_member_at_the_quantile_counts(airframe):
    plan = plan_route(replace(divided(0.5), airframe=airframe))
    robust = plan.request.airframe.battery
    takeoff, en_route, landing = as_flown(plan)
    longer = en_route / plan.totals.energy
    most = max(plan.spread.energy_at(0.5), plan.totals.energy)
    assert plan.battery.total == pytest.approx(takeoff + landing + most * longer, rel=5e-3)  # here of several legs
    assert plan.battery.allowed == pytest.approx(robust.capacity * 0.8 * 0.8)


def test_the_command_refuses_and_forces(gallery, tmp_path):
    text = (gallery / "jacksboro.yaml").read_text().replace("wind/jack", f"{gallery}/wind/jack")
    head, tail = text.split("vehicle:\n")
    tail = tail[tail.index("terrain:") :]
    mission = tmp_path / "far.yaml"
    mission.write_text(f"{head}vehicle: {{airframe: {gallery}/vehicles/small_quadcopter.yaml}}\n{tail}")
    with pytest.raises(BatteryError, match="breaks the reserve by"):
        CliRunner().invoke(app, ["plan", str(mission), "-o", str(tmp_path / "out")], catch_exceptions=False)
    assert not (tmp_path / "out").exists()
    forced = CliRunner().invoke(app, ["plan", str(mission), "-o", str(tmp_path / "out"), "--force"])
    assert forced.exit_code == 0, forced.output
    assert "Wh into the reserve (small quadcopter)" in forced.output
    assert "left %" in forced.output
