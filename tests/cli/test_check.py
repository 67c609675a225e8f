"""`check`: what a firmware makes of a mission, in lines, in JSON and as an exit code."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path

import pytest
from typer.testing import CliRunner, Result

from gcs_windplan.cli.app import app
from gcs_windplan.formats import read_items, write_plan, write_waypoints
from gcs_windplan.geo.frame import GeoPoint
from gcs_windplan.mission import Command, Home, MissionItem, MissionItems

CORPUS = Path(__file__).parents[3] / "shared" / "data" / "missions"
FILES = sorted(path for path in CORPUS.rglob("*") if path.is_file()) if CORPUS.is_dir() else []
HOME = Home(GeoPoint(46.8, 9.8), 500.0)
TAKEOFF = MissionItem(3, Command.NAV_TAKEOFF, (0.0, 0.0, 0.0, 0.0), 46.8, 9.8, 50.0)
WAYPOINT = MissionItem(3, Command.NAV_WAYPOINT, (0.0, 0.0, 0.0, 0.0), 46.801, 9.8, 50.0)
LAND = MissionItem(3, Command.NAV_LAND, (0.0, 0.0, 0.0, 0.0), 46.802, 9.8, 0.0)
SOUND = MissionItems((TAKEOFF, WAYPOINT, LAND), HOME, "ardupilot", "multicopter")
SPLINE = replace(WAYPOINT, command=int(Command.NAV_SPLINE_WAYPOINT))
TURNED = replace(WAYPOINT, params=(0.0, 0.0, 7.0, 90.0))

YAML = """
name: flat
vehicle: {airspeed: 12 m/s, climb: 3, descent: 2, autopilot: AUTOPILOT}
terrain:
  surface: {size: 3 km, cell: 50 m}
  origin: {latitude: 46.8, longitude: 9.8, altitude: 500 m}
wind: {constant: {speed: 6 m/s, from: 250 deg}}
start: {east: -600, north: 0}
goal: {east: 600, north: 50}
clearance: 30 m
graph: {uniform: {spacing: 100 m}}
"""


def check(*arguments: object) -> Result:
    return CliRunner().invoke(app, ["check", *map(str, arguments)], catch_exceptions=True)


def written(path: Path, mission: MissionItems) -> Path:
    (write_plan if path.suffix == ".plan" else write_waypoints)(mission, path)
    return path


def test_nothing_found(tmp_path: Path):
    done = check(written(tmp_path / "sound.plan", SOUND))
    assert done.exit_code == 0
    assert done.stdout == (
        "sound.plan for ArduCopter: nothing rejected, dropped, rounded, changed or ignored in 3 items\n"
    )
    assert done.stderr == ""


def test_findings_are_told_worst_first_and_counted(tmp_path: Path):
    mission = MissionItems((TAKEOFF, TURNED, SPLINE, TURNED, LAND), HOME)
    file = written(tmp_path / "mission.waypoints", mission)
    done = check(file, "--autopilot", "px4", "--vehicle-type", "multicopter")
    assert done.exit_code == 1
    assert done.stdout.splitlines() == [
        "rejected  item 3: PX4 takes no NAV_SPLINE_WAYPOINT (82); make it a NAV_WAYPOINT",
        "dropped   items 2, 4: PX4 drops parameter 3 of NAV_WAYPOINT (distance to pass by [m]): 7; "
        "write 0, or do not count on it",
        "mission.waypoints for PX4 multicopter: 1 rejected, 2 dropped",
    ]


def test_without_a_firmware_it_asks_for_one(tmp_path: Path):
    done = check(written(tmp_path / "mission.waypoints", SOUND))
    assert isinstance(done.exception, Exception)
    assert "does not say for which autopilot it is: give --autopilot ardupilot or --autopilot px4" in str(
        done.exception
    )


def test_without_a_vehicle_type_it_says_that_it_looked_for_less(tmp_path: Path):
    file = written(tmp_path / "mission.waypoints", SOUND)
    done = check(file, "--autopilot", "ardupilot")
    assert done.exit_code == 0
    assert done.stdout.startswith("mission.waypoints for ArduPilot: nothing ")
    assert "for which kind of vehicle is not said" in done.stderr


def test_another_autopilot_than_the_file_s(tmp_path: Path):
    done = check(written(tmp_path / "mission.plan", SOUND), "--autopilot", "px4")
    assert done.exit_code == 0
    assert "the file is for ardupilot, and --autopilot px4 asks for other rules" in done.stderr
    assert "for PX4 multicopter" in done.stdout


def test_repairs_are_notes_and_no_findings(tmp_path: Path):
    file = written(tmp_path / "mission.waypoints", SOUND)
    file.write_text("\ufeff" + file.read_text(), encoding="utf-8")
    done = check(file, "--autopilot", "ardupilot", "--vehicle-type", "multicopter")
    assert done.exit_code == 0
    assert "byte order mark dropped" in done.stderr


def test_json(tmp_path: Path):
    file = written(tmp_path / "mission.plan", replace(SOUND, items=(TAKEOFF, TURNED, LAND)))
    done = check(file, "--json")
    document = json.loads(done.stdout)
    assert done.exit_code == document["exit_code"] == 1
    assert (document["autopilot"], document["vehicle_type"], document["items"]) == ("ardupilot", "multicopter", 3)
    assert document["counts"] == {"dropped": 2}
    assert [(found["rule"], found["effect"], found["item"]) for found in document["findings"]] == [
        ("parameter-dropped", "dropped", 2)
    ] * 2
    assert "90" in document["findings"][1]["message"]


def test_json_of_what_cannot_be_checked(tmp_path: Path):
    done = check(written(tmp_path / "mission.waypoints", SOUND), "--json")
    document = json.loads(done.stdout)
    assert (document["outcome"], document["exit_code"]) == ("error", 2)


@pytest.mark.parametrize(("autopilot", "name"), [("ardupilot", "ArduCopter"), ("px4", "PX4 multicopter")])
def test_a_mission_file_is_planned_and_breaks_no_rule(autopilot: str, name: str, tmp_path: Path):
    file = tmp_path / "flat.yaml"
    file.write_text(YAML.replace("AUTOPILOT", autopilot))
    done = check(file, "--json")
    document = json.loads(done.stdout)
    assert document["autopilot"] == autopilot
    assert set(document["counts"]) <= {"rounded"}
    assert f"flat.yaml for {name}: " in check(file).stdout


@pytest.mark.skipif(not FILES, reason="the shared corpus of missions is not here")
@pytest.mark.parametrize("path", FILES, ids=lambda path: path.name)
def test_every_file_of_the_corpus_ends_in_a_verdict(path: Path):
    from gcs_windplan.errors import FormatError

    for options in (("--vehicle-type", "multicopter"), ("--vehicle-type", "fixed-wing"), ()):
        done = check(path, "--autopilot", "ardupilot", *options)
        if isinstance(done.exception, FormatError):
            with pytest.raises(FormatError):
                read_items(path)
        else:
            assert done.exit_code in (0, 1)
            assert f"{path.name} for Ardu" in done.stdout
