"""Adding a firmware is adding a file: one dropped beside the others is known to lint, comparison and stand-in."""

from __future__ import annotations

import importlib
import subprocess
import sys
from pathlib import Path
from typing import get_args

import pytest

from gcs_windplan.errors import InputError
from gcs_windplan.flight.duration import duration_of
from gcs_windplan.formats import write_waypoints
from gcs_windplan.geo.frame import GeoPoint
from gcs_windplan.jobs.words import VehicleKind
from gcs_windplan.link.comparison import compare_items
from gcs_windplan.link.firmware import incoming_mission, outgoing_items
from gcs_windplan.link.peer import Ident, Peer
from gcs_windplan.link.wire import item_to_message, message_to_item
from gcs_windplan.mission import Command, Home, MissionItem, MissionItems
from gcs_windplan.mission.firmware import autopilot_of, autopilots, firmware_of
from gcs_windplan.mission.firmware.registry import all_firmwares
from gcs_windplan.mission.lint import lint
from gcs_windplan.standin.items import MISSION, Refusal, read_item
from gcs_windplan.standin.rules import Parked
from gcs_windplan.standin.servers import mission_server
from gcs_windplan.standin.storage import store
from gcs_windplan.vehicle import VehicleType

from ..standin import speaking as say

FILE = '''
"""A firmware that was not there before."""

from dataclasses import replace

from gcs_windplan.mission.commands import Command, Frame
from gcs_windplan.mission.firmware.firmware import stores
from gcs_windplan.mission.firmware.px4 import MULTICOPTER
from gcs_windplan.mission.firmware.storage import FLOAT, NONE
from gcs_windplan.mission.firmware.whole_numbers import U8

_PLACE = stores(U8, FLOAT, NONE, NONE, FLOAT, FLOAT, FLOAT, place=True)  # hold, radius

TOYFLY = replace(
    MULTICOPTER,
    autopilot="toyfly",
    name="ToyFly",
    family="ToyFly",
    mav_autopilot=200,
    commands={Command.NAV_TAKEOFF: _PLACE, Command.NAV_WAYPOINT: _PLACE, Command.DO_JUMP: stores(U8, U8)},
    placeless=None,
    capacity={"mission": 6, "fence": 0, "rally": 0},
    navigation=frozenset((Command.NAV_TAKEOFF, Command.NAV_WAYPOINT)),
    ignored=frozenset((Command.DO_JUMP,)),
    not_flown=frozenset(),
    vtol_only=frozenset(),
    feasibility=None,
    motion=replace(MULTICOPTER.motion, speed=2.0),
)
FIRMWARES = (TOYFLY, replace(TOYFLY, vehicle_type=None, variants=(TOYFLY,)))
'''
HOME = Home(GeoPoint(46.8, 9.8), 500.0)


@pytest.fixture
def toyfly(tmp_path, monkeypatch):
    (tmp_path / "toyfly.py").write_text(FILE)
    package = importlib.import_module("gcs_windplan.mission.firmware")
    monkeypatch.setattr(package, "__path__", [*package.__path__, str(tmp_path)])
    all_firmwares.cache_clear()
    yield firmware_of("toyfly", "multicopter")
    all_firmwares.cache_clear()
    sys.modules.pop("gcs_windplan.mission.firmware.toyfly", None)


def at(command, north, *params):
    return MissionItem(3, command, (*params, *[0.0] * (4 - len(params))), 46.8 + north / 111_195, 9.8, 50.0)


def test_it_is_known_by_its_name_and_its_number(toyfly):
    assert (toyfly.name, toyfly.full_name) == ("ToyFly", "ToyFly multicopter")
    assert autopilot_of(200) == "toyfly"
    assert str(Peer(Ident(1, 1), "toyfly", "multicopter")) == "ToyFly 1/1"
    assert MissionItems((), HOME, "toyfly").autopilot == "toyfly"


def test_without_the_file_nobody_knows_it():
    with pytest.raises(InputError, match="autopilot 'toyfly' is neither 'ardupilot' nor 'px4'"):
        firmware_of("toyfly")


def test_lint_knows_what_it_takes_stores_and_ignores(toyfly):
    items = (
        at(Command.NAV_TAKEOFF, 0),
        at(Command.NAV_WAYPOINT, 100, 2.5, 7.25, 3.0),
        MissionItem(0, Command.DO_JUMP, (1.0, 300.0, 0.0, 0.0)),
        at(Command.NAV_LAND, 0),
    )
    found = {(one.rule, one.item) for one in lint(MissionItems(items, HOME), toyfly)}
    assert found == {
        ("parameter-rounded", 2),  # the hold in whole seconds
        ("parameter-dropped", 2),
        ("jump-shift", 3),
        ("command-ignored", 3),
        ("parameter-changed", 3),  # 300 in a byte
        ("command-unsupported", 4),
    }
    assert {one.rule for one in lint(MissionItems(items[:2] * 4, HOME), toyfly)} >= {"capacity"}


def test_the_stand_in_stores_and_the_comparison_accepts_what_it_stores(toyfly):
    sent = at(Command.NAV_WAYPOINT, 100, 2.5, 7.25, 3.0, 90.0)
    stored = store(read_item(item_to_message(sent, 1, 1, 1, MISSION)), MISSION, toyfly)
    assert stored.params == (2.0, 7.25, 0.0, 0.0)
    assert isinstance(store(read_item(item_to_message(at(Command.NAV_LAND, 0), 1, 1, 1, 0)), MISSION, toyfly), Refusal)
    held = message_to_item(say.said(item_to_message(sent, 1, 1, 1, MISSION)))
    assert compare_items([sent], [held], firmware=toyfly).same
    held = MissionItem(3, sent.command, stored.params, sent.latitude_deg, sent.longitude_deg, sent.altitude)
    compared = compare_items([sent], [held], firmware=toyfly)
    assert compared.same
    assert [loss.field for loss in compared.losses] == ["parameter 1", "parameter 3", "parameter 4"]
    wrong = MissionItem(3, sent.command, (2.0, 7.0, 0.0, 0.0), sent.latitude_deg, sent.longitude_deg, sent.altitude)
    assert not compare_items([sent], [wrong], firmware=toyfly).same


def test_its_mission_server_takes_a_mission_and_gives_it_back(toyfly):
    mission = MissionItems(
        (at(Command.NAV_TAKEOFF, 0), at(Command.NAV_WAYPOINT, 100, 2.5)), HOME, "toyfly", "multicopter"
    )
    items = outgoing_items(mission, "mission", toyfly)
    server = mission_server(toyfly, Parked())
    assert say.told(server.handle(say.count(len(items)), 0.0)) == [("REQUEST_INT", 0)]
    for seq, item in enumerate(items):
        answers = server.handle(say.said(item_to_message(item, seq, 1, 1, MISSION)), 0.1)
    assert say.told(answers) == [("ACK", 0)]
    held = [item.params for item in server.items[MISSION]]
    assert held == [(0.0, 0.0, 0.0, 0.0), (2.0, 0.0, 0.0, 0.0)]
    assert incoming_mission(items, toyfly, "multicopter", HOME) == mission


def test_missions_are_flown_at_its_pace(toyfly):
    items = (at(Command.NAV_TAKEOFF, 0), at(Command.NAV_WAYPOINT, 400))
    slow = duration_of(MissionItems(items, HOME, "toyfly", "multicopter")).en_route
    assert slow > 2 * duration_of(MissionItems(items, HOME, "px4", "multicopter")).en_route


SESSION = """
import importlib, sys
from pathlib import Path
sys.path.insert(0, sys.argv[2])
importlib.import_module("gcs_windplan.mission.firmware").__path__.append(sys.argv[1])
from typer.testing import CliRunner
from gcs_windplan.cli.app import app
print("numpy" in sys.modules)
from gcs_windplan.jobs.missionfile.airframe import read_airframe
from gcs_windplan.jobs.missionfile.reference import json_schema
print(json_schema()["$defs"]["VehicleModel"]["properties"]["autopilot"]["enum"])
print(read_airframe(Path(sys.argv[1]) / "toy.yaml").vehicle.autopilot)
for words in sys.argv[3:]:
    done = CliRunner().invoke(app, words.split())
    print(done.exit_code, *(done.output or str(done.exception)).split())
"""
TOY_MISSION = """
name: toy
vehicle: {airspeed: 5, autopilot: toyfly}
terrain: {sample: jacksboro}
wind: {calm: true}
start: {latitude: 36.6, longitude: -84.2}
goal: {latitude: 36.601, longitude: -84.2}
"""


def test_mission_files_and_options_take_its_name(tmp_path, gallery):
    """In a process of its own, which finds the file beside the others when it starts."""
    (tmp_path / "toyfly.py").write_text(FILE)
    (tmp_path / "toy.yaml").write_text(
        (gallery / "vehicles" / "small_quadcopter.yaml").read_text() + "\nautopilot: toyfly\n"
    )
    write_waypoints(MissionItems((at(Command.NAV_LAND, 0),), HOME), tmp_path / "m.waypoints")
    (tmp_path / "m.yaml").write_text(TOY_MISSION)
    (tmp_path / "typo.yaml").write_text(TOY_MISSION.replace("toyfly", "tofly"))
    verbs = [
        "check --help",
        f"check {tmp_path}/m.waypoints --autopilot toyfly",
        f"check {tmp_path}/m.waypoints --autopilot tofly",
        f"check {tmp_path}/m.yaml",
        f"plan {tmp_path}/typo.yaml",
    ]
    done = subprocess.run(
        [sys.executable, "-c", SESSION, str(tmp_path), str(Path(__file__).parents[2]), *verbs],
        capture_output=True, text=True,
    )  # fmt: skip
    assert done.returncode == 0, done.stderr
    heavy, schema, airframe, helped, taken, refused, planned, mistyped = done.stdout.splitlines()
    assert heavy == "False", "listing the firmwares loads none of them"
    assert schema == "['ardupilot', 'px4', 'toyfly']"
    assert airframe == "toyfly"
    assert "ardupilot|px4|toyfly" in helped
    assert "rejected item 1: ToyFly takes no NAV_LAND" in taken
    assert "'tofly' is not one of 'ardupilot', 'px4', 'toyfly'" in refused
    assert "m.yaml for ToyFly multicopter:" in planned
    assert "write ardupilot, px4 or toyfly, not 'tofly'; did you mean toyfly?" in mistyped


def test_the_kinds_of_vehicles_that_may_be_written_are_those_that_fly():
    assert get_args(VehicleKind) == get_args(VehicleType)
    assert {one.vehicle_type for one in all_firmwares()} - {None} == set(get_args(VehicleKind))
    assert tuple(dict.fromkeys(one.autopilot for one in all_firmwares())) == autopilots()
