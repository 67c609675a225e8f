"""`diff`, whichever file comes first."""

from __future__ import annotations

import json
import math
from dataclasses import replace
from pathlib import Path

import pytest
from pymavlink.dialects.v20 import ardupilotmega as mavlink
from typer.testing import CliRunner, Result

from gcs_windplan.cli.app import app
from gcs_windplan.formats import write_plan
from gcs_windplan.mission import Command, MissionItem, MissionItems
from tests.link.bench import survey


def written(path: Path, mission: MissionItems) -> Path:
    write_plan(mission, path)
    return path


def diff(*arguments: object) -> Result:
    return CliRunner().invoke(app, ["diff", *map(str, arguments)])


def both_ways(one: Path, other: Path, *options: object) -> tuple[Result, Result]:
    return diff(one, other, *options), diff(other, one, *options)


@pytest.fixture
def planned() -> MissionItems:
    return replace(survey(), autopilot="ardupilot", vehicle_type="multicopter")


def cut(mission: MissionItems) -> MissionItems:
    """The mission with its altitudes as ArduPilot keeps them."""
    items = [replace(item, altitude=math.trunc(item.altitude * 100) / 100) for item in mission.items]
    return replace(mission, items=tuple(items))


def test_two_autopilots_make_every_number_count(planned: MissionItems, tmp_path: Path):
    one = written(tmp_path / "one.plan", planned)
    other = written(tmp_path / "other.plan", replace(cut(planned), autopilot="px4"))
    for done in both_ways(one, other):
        assert done.exit_code == 1
        assert "altitude" in done.stdout
        assert "different autopilots: every number counts" in done.stderr
    for done in both_ways(one, other, "--autopilot", "ardupilot"):
        assert done.exit_code == 0
        assert "less than ArduPilot's centimetre\nthe same\n" in done.stdout
    for done in both_ways(one, other, "--json"):
        assert json.loads(done.stdout)["autopilot"] is None


@pytest.mark.parametrize("named", ["ardupilot", "px4"])
def test_one_file_that_names_an_autopilot_counts_from_either_side(named, planned: MissionItems, tmp_path: Path):
    one = written(tmp_path / "one.plan", replace(planned, autopilot=named))
    other = written(tmp_path / "other.plan", replace(cut(planned), autopilot=None))
    assert [done.exit_code for done in both_ways(one, other)] == [int(named == "px4")] * 2


@pytest.mark.parametrize(("number", "lost_on"), [(0, "fixed-wing"), (1, "multicopter")])
@pytest.mark.parametrize("others", ["multicopter", "fixed-wing", None])
@pytest.mark.parametrize("kind", ["multicopter", "fixed-wing"])
def test_kinds_of_vehicles_count_from_either_side(kind, others, number, lost_on, planned: MissionItems, tmp_path: Path):
    params = [5.0 if at == number else 0.0 for at in range(4)]
    items = (MissionItem(3, Command.NAV_WAYPOINT, tuple(params), 46.8, 9.8, 50.0),)
    one = written(tmp_path / "one.plan", replace(planned, items=items, vehicle_type=kind))
    bare = (replace(items[0], params=(0.0, 0.0, 0.0, 0.0)),)
    other = written(tmp_path / "other.plan", replace(planned, items=bare, vehicle_type=others))
    same = {kind, others} - {None} == {lost_on}
    assert [done.exit_code for done in both_ways(one, other)] == [int(not same)] * 2


def test_losses_are_said(planned: MissionItems, tmp_path: Path):
    items = tuple(replace(item, params=(item.params[0], 5.0, 0.0, 0.0)) for item in planned.items)
    one = written(tmp_path / "one.plan", replace(planned, items=items))
    bare = tuple(replace(item, params=(item.params[0], 0.0, 0.0, 0.0)) for item in planned.items)
    other = written(tmp_path / "other.plan", cut(replace(planned, items=bare)))
    done = diff(one, other)
    assert done.exit_code == 0, done.output
    *lines, last = done.stdout.splitlines()
    assert last == "the same"
    assert any(line.endswith("less than ArduPilot's centimetre") for line in lines)
    assert any(line.startswith("mission: not kept by ArduPilot: parameter 2 5 became 0 (items 1") for line in lines)


def test_a_part_of_a_fifth_parameter_is_a_difference(planned: MissionItems, tmp_path: Path):
    actuator = MissionItem(2, mavlink.MAV_CMD_DO_SET_ACTUATOR, (0.0, 0.0, 0.0, 0.0), 0.6)
    one = written(tmp_path / "one.plan", replace(planned, items=(actuator,)))
    other = written(tmp_path / "other.plan", replace(planned, items=(replace(actuator, latitude_deg=1.0),)))
    done, turned = both_ways(one, other)
    assert (done.exit_code, done.stdout) == (1, "mission: item 1: parameter 5 0.6 became 1\n")
    assert (turned.exit_code, turned.stdout) == (1, "mission: item 1: parameter 5 1 became 0.6\n")
