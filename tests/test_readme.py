"""What the README prints is what the program does."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

import gcs_windplan as gw
from gcs_windplan.cli.tables import summary_lines
from gcs_windplan.cost import COST_NAMES, CostChoice
from gcs_windplan.errors import MissionFileError
from gcs_windplan.reproduction.cases import CASES, make_rules, make_terrain, make_vehicle
from gcs_windplan.reproduction.flying import SHAPED, fly_case, sites_of
from gcs_windplan.reproduction.graphs import lay_uniform
from gcs_windplan.reproduction.published import ANGLE, DISTANCE, HYBRID
from gcs_windplan.spec import parse_mission

ROOT = Path(__file__).resolve().parents[1]
README = (ROOT / "README.md").read_text()


def test_the_mission_shown_is_the_mission_shipped():
    shown = re.search(r"```yaml\n(.*?)\n```", README, re.DOTALL)
    assert shown is not None
    assert shown[1] == (ROOT / "missions" / "jacksboro.yaml").read_text().rstrip()


def test_the_figures_shown_are_the_programs():
    """Within what rounding on another processor may change: vertices settle a little elsewhere."""
    request = gw.read_mission(ROOT / "missions" / "jacksboro.yaml")
    plans = gw.plan_routes(request, [CostChoice(name) for name in COST_NAMES if name != "energy"])
    shown = re.search(r"^jacksboro, least time: (\d+) waypoints, ([\d.]+) km, (\d+):(\d\d) min", README, re.MULTILINE)
    assert shown is not None
    by_time = plans[-1]
    assert int(shown[1]) == pytest.approx(len(by_time.waypoints), abs=5)
    assert float(shown[2]) == pytest.approx(by_time.totals.length / 1000, rel=5e-3)
    assert 60 * int(shown[3]) + int(shown[4]) == pytest.approx(by_time.totals.seconds, rel=2e-3)
    for plan in plans:
        row = re.search(rf"^ {plan.choice.name} +(\d+):(\d\d) ", README, re.MULTILINE)
        assert row is not None
        assert 60 * int(row[1]) + int(row[2]) == pytest.approx(plan.totals.seconds, rel=2e-3), plan
    assert re.search(r"^# Plan\('jacksboro', time: ", README, re.MULTILINE)
    assert summary_lines(by_time)[1].split("wind: ")[1] in README


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
    assert second.endswith("-m pytest")
