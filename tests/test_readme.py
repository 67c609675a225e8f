"""What the README prints is what the program does."""

from __future__ import annotations

import json
import re
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from gcs_windplan.cli.tables import mean_height, summary_lines
from gcs_windplan.errors import MissionFileError
from gcs_windplan.jobs.missionfile import parse_mission
from gcs_windplan.jobs.missionfile.airframe import read_airframe
from gcs_windplan.jobs.requests import read_request
from gcs_windplan.paper.cases import CASES, make_rules, make_terrain, make_vehicle
from gcs_windplan.paper.flying import SHAPED, fly_case, sites_of
from gcs_windplan.paper.graphs import lay_uniform
from gcs_windplan.paper.published import ANGLE, DISTANCE, HYBRID
from gcs_windplan.planning.cost import COST_NAMES, CostChoice
from gcs_windplan.planning.planner import plan_routes
from gcs_windplan.vehicle import best_range_airspeed, energy_per_metre, least_power_airspeed
from tests.flight.test_duration import predicted_duration
from tests.vehicle.test_power_rotors import ZENG

ROOT = Path(__file__).resolve().parents[1]
README = (ROOT / "README.md").read_text()


def test_the_mission_shown_is_the_mission_shipped():
    shown = re.search(r"```yaml\n(.*?)\n```", README, re.DOTALL)
    assert shown is not None
    assert shown[1] == (ROOT / "missions" / "jacksboro.yaml").read_text().rstrip()


def test_the_figures_shown_are_the_programs():
    """Within what rounding on another processor may change: vertices settle a little elsewhere."""
    request = read_request(ROOT / "missions" / "jacksboro.yaml")
    plans = plan_routes(request, [CostChoice(name) for name in COST_NAMES if name != "energy"])
    shown = re.search(r"^jacksboro, least time: (\d+) waypoints, ([\d.]+) km, (\d+):(\d\d) min", README, re.MULTILINE)
    assert shown is not None
    by_time = plans[-1]
    assert int(shown[1]) == pytest.approx(len(by_time.waypoints), abs=5)
    assert float(shown[2]) == pytest.approx(by_time.totals.length / 1000, rel=5e-3)
    assert 60 * int(shown[3]) + int(shown[4]) == pytest.approx(by_time.totals.seconds, rel=2e-3)
    table = README.split("$ gcs-windplan compare missions/jacksboro.yaml")[1].split("```")[0]
    for plan in plans:
        row = re.search(rf"^ {plan.choice.name} +(\d+):(\d\d) ", table, re.MULTILINE)
        assert row is not None
        exactly = 2e-3 if plan.choice.name in ("time", "distance") else 0.05  # A* by angle is not optimal: ties decide
        assert 60 * int(row[1]) + int(row[2]) == pytest.approx(plan.totals.seconds, rel=exactly), plan
    assert re.search(r"^# Plan\('jacksboro', time: ", README, re.MULTILINE)
    assert summary_lines(by_time)[1].split("wind: ")[1] in README


def test_the_energies_shown_are_the_programs():
    request = read_request(ROOT / "missions" / "shear.yaml")
    plans = plan_routes(request, [CostChoice("distance"), CostChoice("time"), CostChoice("energy")])
    table = README.split("$ gcs-windplan compare missions/shear.yaml")[1].split("```")[0]
    for plan in plans:
        row = re.search(rf"^ {plan.choice.name} +\d+:\d\d +\S+ % +([\d.]+) ", table, re.MULTILINE)
        assert row is not None
        assert float(row[1]) == pytest.approx(plan.totals.energy / 3600, rel=3e-3), plan
    told = re.search(
        r"^energy takes ([\d.]+) Wh less than distance; it flies (\d+) m .* and (\d+) m", table, re.MULTILINE
    )
    assert told is not None
    assert float(told[1]) == pytest.approx((plans[0].totals.energy - plans[2].totals.energy) / 3600, rel=0.02)
    assert [int(told[2]), int(told[3])] == pytest.approx([mean_height(plans[2], sign) for sign in (-1, 1)], abs=5)


def test_the_published_figures_shown_are_the_models():
    """The cells of the model's column, each from the model itself."""
    hexacopter = read_airframe(ROOT / "missions" / "vehicles" / "large_multirotor.yaml").power
    quadcopter = read_airframe(ROOT / "missions" / "vehicles" / "small_quadcopter.yaml").power
    slow = least_power_airspeed(ZENG, 60.0)

    def minutes(mass: float, watt_hours: float) -> str:
        return f"{0.9 * watt_hours * 60 / float(replace(hexacopter, mass=mass).watts(0.0, 0.0)):.1f}"

    large = ", ".join(minutes(10.0 + payload, 6 * 129.96) for payload in (0, 0.5, 1.9, 5.5))
    small = ", ".join(minutes(9.5 + payload, 6 * 99.9) for payload in (0, 0.9, 6.0))
    mean = float(np.mean(energy_per_metre(quadcopter, np.array([4.0, 6.0, 8.0, 10.0, 12.0]), density=1.172))) / 1000
    for cell in (
        f"{float(ZENG.watts(0.0, 0.0)):.1f} W; {float(ZENG.watts(slow, 0.0)):.1f} W at {slow:.2f} m/s;"
        f" {best_range_airspeed(ZENG, 60.0):.2f} m/s",
        f"{large} min",
        f"{small} min",
        f"{mean:.3f} MJ/km in the mean",
    ):
        assert f"| {cell} |" in README


def test_the_flights_shown_are_the_predicted_ones(shared_data):
    rows = re.findall(r"^\| [\w ,0-9x/]+ \| (\d+) \| ([\d.]+) \| ([\d.]+) \| ([+-][\d.]+) % \|$", README, re.MULTILINE)
    flights = json.loads((shared_data / "flights" / "arducopter_4.7.json").read_text())
    assert len(rows) == len(flights) == 12
    for (legs, measured, predicted, off), flight in zip(rows, flights, strict=True):
        found = predicted_duration(flight).en_route
        assert int(legs) == len(flight["legs"])
        assert float(measured) == pytest.approx(flight["total"], abs=0.051)
        assert float(predicted) == pytest.approx(found, abs=0.051)
        assert float(off) == pytest.approx(100 * (found / flight["total"] - 1), abs=0.051)


def test_the_papers_cases_shown_are_the_programs():
    terrain = make_terrain()
    rules = make_rules(terrain)
    veil = lay_uniform(rules, sites_of(rules, CASES))
    routes = [fly_case(case, veil, make_vehicle(), rules) for case in CASES]
    for name, key in (("distance", str(DISTANCE)), ("angle", str(ANGLE)), ("hybrid", str(HYBRID)), ("time", SHAPED)):
        row = re.search(
            rf"^\| {name}.* \| [\d.-]+ / ([\d.]+) \| [\d.-]+ / ([\d.]+) \| [\d.-]+ / ([\d.]+) \|$", README, re.M
        )
        assert row is not None, name
        assert [float(cell) for cell in row.groups()] == pytest.approx([r[key].seconds for r in routes], abs=0.011), (
            name
        )


def test_the_errors_shown_are_the_programs():
    shown = re.findall(r"^error: (broken\.yaml:.*)$", README, re.MULTILINE)
    broken = (ROOT / "missions" / "jacksboro.yaml").read_text()
    for good, bad in (
        ("airspeed: 14 m/s", "airspeed: 14 m"),
        ("goal: {latitude", "goal: {lattitude"),
        ("max_height: 120 m", "max_height: 30 m"),
    ):
        assert good in broken
        broken = broken.replace(good, bad)
    try:
        parse_mission(broken, Path("broken.yaml"))
    except MissionFileError as error:
        assert [str(problem) for problem in error.problems] == shown  # noqa: PT017
    else:
        raise AssertionError("the broken mission passed")


def test_the_two_commands_stand_in_the_first_shell_block():
    block = re.search(r"```sh\n(.*?)\n```", README, re.DOTALL)
    assert block is not None
    first, second = block[1].splitlines()
    assert first.endswith("gcs-windplan plan missions/jacksboro.yaml")
    assert second.endswith("-m pytest -n auto --dist loadfile")
