"""The battery through a mission, and missions that it does not carry."""

from __future__ import annotations

from dataclasses import replace

import pytest
from typer.testing import CliRunner

import gcs_windplan as gw
from gcs_windplan.cli.app import app
from gcs_windplan.errors import BatteryError
from gcs_windplan.spec.airframe import read_airframe
from gcs_windplan.wind import Calm
from tests.ensembles import divided, request


@pytest.fixture
def airframe(gallery):
    return read_airframe(gallery / "vehicles" / "small_quadcopter.yaml")


def smaller(airframe, joules: float):
    return replace(airframe, battery=replace(airframe.battery, capacity=joules))


def test_what_is_left_falls_from_waypoint_to_waypoint(airframe):
    plan = gw.plan_route(request(wind=Calm(), airframe=airframe))
    totals, use = plan.totals, plan.battery
    assert use.total == pytest.approx(totals.energy + totals.takeoff_energy + totals.landing_energy)
    assert use.left[0] == pytest.approx(1 - totals.takeoff_energy / airframe.battery.capacity)
    assert use.left[-1] == pytest.approx(1 - (totals.takeoff_energy + totals.energy) / airframe.battery.capacity)
    assert list(use.left) == sorted(use.left, reverse=True)
    assert use.missing == 0
    returning = gw.plan_route(request(wind=Calm(), airframe=airframe, finish="hold"))
    assert returning.battery.total == pytest.approx(use.total - totals.landing_energy)


def test_a_mission_that_breaks_the_reserve_is_refused_and_says_by_how_much(airframe):
    """1.8 km take about 36 Wh with both ends: of 45 Wh 36 are usable, and 28.8 with the reserve."""
    asked = request(wind=Calm(), airframe=airframe)
    total = gw.plan_route(asked).battery.total
    weak = replace(asked, airframe=smaller(airframe, total / 0.8 * 1.01))
    with pytest.raises(BatteryError) as error:
        gw.plan_route(weak)
    missing = (total - total * 1.01 * 0.8) / 3600
    assert f"breaks the reserve by {missing:.0f} Wh" in str(error.value)
    assert gw.plan_routes(weak, [weak.cost])[0].battery.missing == pytest.approx(missing * 3600)
    gw.plan_route(replace(asked, airframe=smaller(airframe, total / 0.64 * 1.01)))


def test_over_an_ensemble_the_member_at_the_quantile_counts(airframe):
    plan = gw.plan_route(replace(divided(0.5), airframe=airframe))
    robust = plan.request.airframe.battery
    ends = plan.totals.takeoff_energy + plan.totals.landing_energy
    assert plan.battery.total == pytest.approx(ends + max(plan.spread.energy_at(0.5), plan.totals.energy))
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
    assert "battery %" in forced.output.replace("\n", " ") or "battery" in forced.output
