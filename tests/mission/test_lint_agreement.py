"""What the lint says of a mission, and what the stand-in vehicle does with it, by one table of the firmware's facts."""

from __future__ import annotations

import math
import re
from dataclasses import replace
from pathlib import Path

import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from pymavlink.dialects.v20 import ardupilotmega as mavlink

from gcs_windplan.errors import FormatError, InputError
from gcs_windplan.formats import read_items
from gcs_windplan.geo.frame import GeoPoint
from gcs_windplan.link.wire import item_to_message
from gcs_windplan.mission import Command, Frame, Home, MissionItem, MissionItems, takes_place
from gcs_windplan.mission.firmware import firmware_of
from gcs_windplan.mission.firmware.floats import float_text, same_float, single
from gcs_windplan.mission.lint import lint
from gcs_windplan.standin.items import MISSION, StoredItem
from gcs_windplan.standin.rules import Parked
from gcs_windplan.standin.servers import mission_server
from gcs_windplan.standin.storage import infeasible

CORPUS = Path(__file__).parents[3] / "shared" / "data" / "missions"
HOME = Home(GeoPoint(46.8, 9.8), 500.0)
GROUND_STATION = (255, 190)
UPLOAD = {
    *("capacity", "command-unsupported", "frame-unsupported", "frame-mission-needed", "place-frame-needed"),
    *("interest-kind", "parameter-nan", "altitude-too-large", "jump-target"),
}
PLACED = (
    Command.NAV_WAYPOINT,
    Command.NAV_LOITER_UNLIM,
    Command.NAV_LOITER_TURNS,
    Command.NAV_LOITER_TIME,
    Command.NAV_LAND,
    Command.NAV_TAKEOFF,
    Command.NAV_LOITER_TO_ALT,
    Command.NAV_SPLINE_WAYPOINT,
    Command.NAV_VTOL_LAND,
    Command.DO_SET_ROI_LOCATION,
    Command.NAV_RALLY_POINT,
)
YAWED = (Command.NAV_WAYPOINT, Command.NAV_LOITER_UNLIM, Command.NAV_TAKEOFF, Command.NAV_VTOL_LAND)
FREE = (
    Command.DO_JUMP,
    Command.DO_CHANGE_SPEED,
    Command.NAV_DELAY,
    Command.CONDITION_YAW,
    Command.DO_SET_ROI_NONE,
    mavlink.MAV_CMD_DO_SET_SERVO,
    mavlink.MAV_CMD_DO_SET_RELAY,
    mavlink.MAV_CMD_DO_REPEAT_SERVO,
    mavlink.MAV_CMD_DO_AUX_FUNCTION,
    mavlink.MAV_CMD_DO_ENGINE_CONTROL,
    31010,
)

numbers = st.one_of(
    st.sampled_from([0.0, 0.0, 0.0, 1.0, -1.0, 2.5, 90.0, 300.0, 2000.0, 70_000.0]),
    st.floats(-400, 400, width=32),
    st.just(math.nan),
)
quiet = st.one_of(st.just(0.0), st.integers(0, 9).map(float), st.integers(0, 9).map(lambda tenths: tenths / 8))
frames = st.sampled_from([0, 3, 3, 3, 3, 6, 10, 2, 1])


def items(params, frame=frames):
    place = st.tuples(st.integers(460_000_000, 470_000_000), st.integers(90_000_000, 99_000_000))
    params = st.tuples(params, params, params, params)
    altitudes = st.one_of(st.floats(-50, 900, width=32), st.sampled_from([61.999, 50.3, 83_000.0]))

    def placed(command, frame, params, place, altitude, proceed):
        return MissionItem(frame, command, params, place[0] / 1e7, place[1] / 1e7, altitude, proceed)

    def free(command, frame, params):
        target, *rest = params
        if command == Command.DO_JUMP and not math.isnan(target):
            target = float(int(math.fmod(target, 9.0)))
        return MissionItem(frame, command, (target, *rest))

    return st.one_of(
        st.builds(placed, st.sampled_from(PLACED), frame, params, place, altitudes, st.booleans()),
        st.builds(free, st.sampled_from(FREE), st.sampled_from([0, 2, 2, 3, 10, 1]), params),
    )


missions = st.lists(st.one_of(items(quiet, st.just(3)), items(quiet), items(numbers)), min_size=1, max_size=7).map(
    lambda found: MissionItems(tuple(found), HOME)
)


def messages(mission, autopilot):
    """The mission's items as they are, with nothing mended but the count of jumps on PX4."""
    if autopilot == "ardupilot":
        home = MissionItem(0, Command.NAV_WAYPOINT, latitude_deg=46.8, longitude_deg=9.8, altitude=500.0)
        sent = (home, *mission.items)
    else:
        sent = tuple(
            replace(item, params=(item.params[0] - 1, *item.params[1:])) if item.command == Command.DO_JUMP else item
            for item in mission.items
        )
    return [item_to_message(item, seq, 1, 1, MISSION) for seq, item in enumerate(sent)]


def sendable(mission, autopilot):
    """The messages, of missions without a place in a frame that has no degrees: nobody can send such a one."""
    try:
        return messages(mission, autopilot)
    except InputError:
        assume(False)


def uploaded(sent, autopilot):
    """What the stand-in holds of an upload, None where it refuses."""
    server = mission_server(firmware_of(autopilot, "multicopter"), Parked(), now=0.0)

    def say(message):
        message._header.srcSystem, message._header.srcComponent = GROUND_STATION
        return server.handle(message, 10.0)

    answers = say(mavlink.MAVLink_mission_count_message(1, 1, len(sent), MISSION))
    while True:
        request = next((answer for answer in answers if "REQUEST" in answer.get_type()), None)
        if request is None:
            break
        answers = say(sent[request.seq])
    (code,) = [answer.type for answer in answers if answer.get_type() == "MISSION_ACK"]
    return list(server.items[MISSION]) if code == mavlink.MAV_MISSION_ACCEPTED else None


@settings(max_examples=400)
@given(mission=missions)
def test_ardupilot_refuses_what_is_called_rejected_and_nothing_else(mission):
    held = uploaded(sendable(mission, "ardupilot"), "ardupilot")
    rejected = {
        found.rule for found in lint(mission, firmware_of("ardupilot", "multicopter")) if found.effect == "rejected"
    }
    assert (held is None) == bool(rejected & UPLOAD)
    assert rejected <= UPLOAD | {"takeoff-missing"}


@settings(max_examples=400)
@given(mission=missions)
def test_px4_refuses_what_is_called_rejected_and_nothing_else(mission):
    held = uploaded(sendable(mission, "px4"), "px4")
    refused = held is None or infeasible(held, firmware_of("px4")) is not None
    rejected = {found.rule for found in lint(mission, firmware_of("px4", "multicopter")) if found.effect == "rejected"}
    assert refused == bool(rejected & (UPLOAD | {"takeoff-not-first"}))


@settings(max_examples=600)
@given(
    item=st.one_of(items(quiet, st.just(3)), items(numbers, st.sampled_from([0, 3, 10]))),
    autopilot=st.sampled_from(["ardupilot", "px4"]),
)
def test_the_numbers_that_change_are_those_that_come_back_changed(item, autopilot):
    assume(autopilot == "ardupilot" or item.command not in (Command.NAV_LAND, Command.NAV_LOITER_TIME))
    assume(autopilot == "ardupilot" or item.command != Command.DO_JUMP or item.params[1] >= 0)
    if item.command == Command.DO_JUMP:
        item = replace(item, params=(1.0, *item.params[1:]))
    if autopilot == "px4" and not takes_place(item.command):
        item = replace(item, frame=int(Frame.MISSION))
    mission = MissionItems((item,), HOME)
    held = uploaded(sendable(mission, autopilot), autopilot)
    assume(held is not None)
    if autopilot == "px4" and item.command == Command.DO_JUMP:
        held = [replace(held[0], params=(held[0].params[0] + 1, *held[0].params[1:]))]
    found = lint(mission, firmware_of(autopilot, "multicopter"))
    assert told_changes(found) == changes(item, held[-1], autopilot)
    cut = [finding.number for finding in found if finding.rule == "altitude-rounded"]
    moved = takes_place(item.command) and not same_float(item.altitude, held[-1].z)
    assert cut == ([f"{float_text(item.altitude)} m becomes {float_text(held[-1].z)} m"] if moved else [])
    dropped = any(finding.rule == "autocontinue-dropped" for finding in found)
    assert dropped == (held[-1].autocontinue != item.autocontinue)


def told_changes(found):
    """Parameter and value that comes back, of the findings."""
    told = {}
    for finding in found:
        if match := re.search(r"parameter (\d) of", finding.fact):
            told[int(match[1])] = finding.number.partition(" becomes ")[2] or "0"
    return told


def changes(item: MissionItem, held: StoredItem, autopilot):
    """The same by what the stand-in holds; what was not set, and a yaw of another turn, count for nothing."""
    changed = {}
    for position, (sent, back) in enumerate(zip(item.params, held.params, strict=True), start=1):
        if same_float(sent, back) or ((sent == 0 or math.isnan(sent)) and abs(back) in (0, 1)):
            continue
        if (
            autopilot == "px4"
            and item.command in YAWED
            and position == 4
            and abs((sent - back + 180) % 360 - 180) < 1e-3
        ):
            continue
        changed[position] = float_text(back)
    return changed


@pytest.mark.parametrize("command", sorted({int(number) for number in mavlink.enums["MAV_CMD"]} - {0}))
@pytest.mark.parametrize("autopilot", ["ardupilot", "px4"])
def test_both_know_the_same_commands(command, autopilot):
    placed = command in firmware_of("px4").commands if autopilot == "px4" else takes_place(command)
    frame = Frame.GLOBAL_RELATIVE_ALT if placed else Frame.MISSION
    item = MissionItem(frame, command, (0.0, 0.0, 0.0, 0.0), 46.8 if placed else 0.0, 9.8 if placed else 0.0, 50.0)
    if command == Command.DO_JUMP:
        item = replace(item, params=(1.0, 1.0, 0.0, 0.0))
    held = uploaded(messages(MissionItems((item,), HOME), autopilot), autopilot)
    rejected = {
        found.rule for found in lint(MissionItems((item,), HOME), firmware_of(autopilot)) if found.effect == "rejected"
    }
    assert (held is None) == bool(rejected & UPLOAD)
    if autopilot == "px4":
        assert (held is not None) == firmware_of("px4").takes(command)


@pytest.mark.parametrize(("autopilot", "most"), [("ardupilot", 717), ("px4", 2000)])
@pytest.mark.parametrize("more", [0, 1])
def test_both_have_the_same_room(autopilot, most, more):
    item = MissionItem(3, Command.NAV_WAYPOINT, (0.0, 0.0, 0.0, 0.0), 46.8, 9.8, single(50.0))
    mission = MissionItems((item,) * (most + more), HOME)
    rules = {found.rule for found in lint(mission, firmware_of(autopilot, "multicopter"))}
    assert ("capacity" in rules) == (uploaded(messages(mission, autopilot), autopilot) is None) == bool(more)


FILES = sorted(path for path in CORPUS.rglob("*") if path.is_file()) if CORPUS.is_dir() else []


@pytest.mark.skipif(not FILES, reason="the shared corpus of missions is not here")
@pytest.mark.parametrize("autopilot", ["ardupilot", "px4"])
@pytest.mark.parametrize("path", FILES, ids=lambda path: path.name)
def test_missions_of_the_wild_get_a_verdict_that_the_stand_in_shares(path, autopilot):
    try:
        mission = read_items(path).mission
    except FormatError:
        pytest.skip("no mission that can be read")
    for kind in ("fixed-wing", None, "multicopter"):
        found = lint(mission, firmware_of(autopilot, kind))
        assert all(finding.item is None or 1 <= finding.item <= len(mission.items) for finding in found)
    try:
        held = uploaded(messages(mission, autopilot), autopilot)
    except InputError as error:
        pytest.skip(f"cannot be sent: {error}")
    refused = held is None or (autopilot == "px4" and infeasible(held, firmware_of(autopilot)) is not None)
    rejected = {finding.rule for finding in found if finding.effect == "rejected"}
    assert refused == bool(rejected & (UPLOAD | {"takeoff-not-first"}))
