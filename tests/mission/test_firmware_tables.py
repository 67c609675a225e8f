"""Every command and parameter of the firmwares' tables: against twins written from the sources, and among them."""

from __future__ import annotations

import json
import math
import pickle
import struct
from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from pymavlink.dialects.v20 import ardupilotmega as mavlink

from gcs_windplan.geo.frame import GeoPoint
from gcs_windplan.link.comparison import compare_items
from gcs_windplan.link.wire import item_to_message, message_to_item
from gcs_windplan.mission import Frame, Home, MissionItem, MissionItems, takes_place
from gcs_windplan.mission.firmware import all_firmwares, firmware_of
from gcs_windplan.mission.firmware.floats import same_float
from gcs_windplan.mission.firmware.storage import UNREAD
from gcs_windplan.mission.lint import lint
from gcs_windplan.standin.items import MISSION, Refusal, StoredItem, read_item
from gcs_windplan.standin.storage import store
from gcs_windplan.vehicle import takeoff_seconds

from . import ardupilot_twin

COPTER, PLANE = firmware_of("ardupilot", "multicopter"), firmware_of("ardupilot", "fixed-wing")
PX4 = firmware_of("px4", "multicopter")
HOME = Home(GeoPoint(46.8, 9.8), 500.0)
COMMANDS = sorted(number for number in mavlink.enums["MAV_CMD"] if number)
PLACE = (468_000_000, 98_000_000, 50.3)
VALUES = (0.0, 1.0, -1.0, 2.5, -7.75, 100.0, 181.0, 255.0, 256.5, 300.0, 655.37, 2600.0, 40_000.0, 70_000.0)

#: PX4's mission_item_s, by mavlink_mission.cpp: f a float, u an uint16_t, b a flag, y a yaw, 0 not read back.
PX4_PLACES = {
    "NAV_WAYPOINT": "ff0y", "NAV_LOITER_UNLIM": "00fy", "NAV_LOITER_TIME": "fbfb", "NAV_LAND": "0u0y",
    "NAV_TAKEOFF": "000y", "NAV_LOITER_TO_ALT": "bf0b", "NAV_VTOL_TAKEOFF": "000y", "NAV_VTOL_LAND": "000y",
    "DO_SET_ROI": "0000", "DO_SET_ROI_LOCATION": "0000", "CONDITION_GATE": "0000",
}  # fmt: skip
PX4_PLACELESS = [
    "DO_JUMP",
    "DO_SET_ROI",
    "DO_WINCH",
    "DO_GRIPPER",
    "DO_CHANGE_SPEED",
    "DO_SET_HOME",
    "DO_LAND_START",
    "DO_TRIGGER_CONTROL",
    "DO_DIGICAM_CONTROL",
    "DO_MOUNT_CONFIGURE",
    "DO_MOUNT_CONTROL",
    "DO_GIMBAL_MANAGER_PITCHYAW",
    "SET_CAMERA_FOCUS",
    "DO_GIMBAL_MANAGER_CONFIGURE",
    "IMAGE_START_CAPTURE",
    "IMAGE_STOP_CAPTURE",
    "VIDEO_START_CAPTURE",
    "VIDEO_STOP_CAPTURE",
    "DO_CONTROL_VIDEO",
    "DO_SET_CAM_TRIGG_DIST",
    "OBLIQUE_SURVEY",
    "DO_SET_CAM_TRIGG_INTERVAL",
    "SET_CAMERA_MODE",
    "SET_CAMERA_SOURCE",
    "DO_VTOL_TRANSITION",
    "NAV_DELAY",
    "NAV_RETURN_TO_LAUNCH",
    "DO_SET_ROI_WPNEXT_OFFSET",
    "DO_SET_ROI_NONE",
    "CONDITION_DELAY",
    "CONDITION_DISTANCE",
    "DO_SET_ACTUATOR",
    "DO_AUTOTUNE_ENABLE",
    "COMPONENT_ARM_DISARM",
]


def single(number: float) -> float:
    return struct.unpack("<f", struct.pack("<f", number))[0]


def sent(command: int, params: tuple[float, ...], frame: int = Frame.GLOBAL_RELATIVE_ALT, place=PLACE) -> StoredItem:
    return StoredItem(frame, command, tuple(map(single, params)), place[0], place[1], single(place[2]))


def each_parameter():
    """Four parameters, one of them set at a time."""
    for position in range(4):
        for value in VALUES:
            yield tuple(value if i == position else 0.0 for i in range(4))


def numbers(item: StoredItem) -> tuple[float, ...]:
    return (*item.params, item.x, item.y, item.z)


@pytest.mark.parametrize("command", COMMANDS, ids=str)
def test_ardupilot_stores_of_every_command_what_its_source_says(command):
    twin = {**ardupilot_twin.FIELDS, **ardupilot_twin.PLACES}
    assert (command in COPTER.commands) == (command in twin)
    for params in each_parameter():
        item = sent(command, params, place=PLACE if command in ardupilot_twin.PLACES else (300, -2, 7.25))
        held = store(item, MISSION, COPTER)
        if command not in twin:
            assert isinstance(held, Refusal)
            continue
        expected = ardupilot_twin.read_back(command, item.params, (item.x, item.y, item.z))
        assert all(map(same_float, numbers(held), expected)), (params, numbers(held), expected)
        assert held.frame == (Frame.GLOBAL_RELATIVE_ALT if command in ardupilot_twin.PLACES else Frame.GLOBAL)


def test_arduplane_differs_in_waypoints_and_takes_no_splines():
    """AP_Mission.cpp, APM_BUILD_ArduPlane: two bytes of p1, each at most 255."""
    differing = {command for command in COPTER.commands if COPTER.commands[command] != PLANE.commands.get(command)}
    assert differing == {mavlink.MAV_CMD_NAV_WAYPOINT, mavlink.MAV_CMD_NAV_SPLINE_WAYPOINT}
    held = store(sent(mavlink.MAV_CMD_NAV_WAYPOINT, (9.0, 300.5, 7.9, 45.0)), MISSION, PLANE)
    assert held.params == (0.0, 255.0, 7.0, 0.0)
    assert store(sent(mavlink.MAV_CMD_NAV_SPLINE_WAYPOINT, (0.0,) * 4), MISSION, PLANE).code == 3


def px4_field(kind: str, number: float) -> float:
    return {"f": number, "u": float(int(number) % 65536), "b": float(number > 0), "y": single(number % 360), "0": 0.0}[
        kind
    ]


@pytest.mark.parametrize("command", COMMANDS, ids=str)
def test_px4_stores_of_every_command_what_its_source_says(command):
    name = command_name_of(command)
    for params in each_parameter():
        if name == "DO_SET_ROI" and params[0]:
            continue  # other kinds of it are refused
        placed = store(sent(command, params), MISSION, PX4)
        assert isinstance(placed, StoredItem) == (name in PX4_PLACES)
        if name in PX4_PLACES:
            expected = tuple(map(px4_field, PX4_PLACES[name], sent(command, params).params))
            assert placed.params == pytest.approx(expected, abs=1e-4)
            assert (placed.x, placed.y, placed.z, placed.frame) == (*PLACE[:2], single(PLACE[2]), 6)
        free = store(sent(command, params, Frame.MISSION, (7, -8, 9.5)), MISSION, PX4)
        assert isinstance(free, StoredItem) == (name in PX4_PLACELESS)
        if name in PX4_PLACELESS and name != "DO_JUMP":
            assert numbers(free) == (*sent(command, params).params, 7, -8, 9.5)


def command_name_of(command: int) -> str:
    return mavlink.enums["MAV_CMD"][command].name.removeprefix("MAV_CMD_")


def test_px4_counts_jumps_in_16_bits():
    """navigation.h: int16_t do_jump_mission_index, uint16_t do_jump_repeat_count."""
    jump = sent(mavlink.MAV_CMD_DO_JUMP, (3.7, 70_000.0, 1.5, 2.5), Frame.MISSION, (0, 0, 0.0))
    assert store(jump, MISSION, PX4).params == (3.0, 4464.0, 1.5, 2.5)


@pytest.mark.parametrize(
    "firmware", [one for one in all_firmwares() if not one.variants], ids=lambda one: one.full_name
)
@pytest.mark.parametrize("command", COMMANDS, ids=str)
def test_lint_and_comparison_say_what_the_store_does(firmware, command):
    """What comes back as it was is no finding and no difference, what is cut a loss, another number a finding."""
    rule = firmware.rule(command)
    own_frame = Frame.GLOBAL if firmware.placeless is None else Frame.MISSION
    for params in each_parameter() if rule is not None else ():
        place = (46.8, 9.8, 50.25) if rule.place and takes_place(command) else (0.0, 0.0, 0.0)
        item = MissionItem(Frame.GLOBAL_RELATIVE_ALT if rule.place else own_frame, command, params, *place)
        stored = store(read_item(item_to_message(item, 1, 1, 1, MISSION)), MISSION, firmware)
        found = lint(MissionItems((item,), HOME), firmware)
        if isinstance(stored, Refusal) or math.inf in stored.params or any("jump" in one.rule for one in found):
            continue  # jumps have rules of their own
        values = (1, 1, 1, stored.frame, command, 0, 1, *stored.params, stored.x, stored.y, stored.z, MISSION)
        compared = compare_items([item], [message_to_item(mavlink.MAVLink_mission_item_int_message(*values))],
                                 firmware=firmware)  # fmt: skip
        told = [one.effect for one in found if one.rule.startswith("parameter-")]
        kept = all(map(same_float, params, stored.params))
        assert "changed" in told or compared.same, (params, compared.differences)
        assert not kept or not told, (params, told)
        assert kept or told or all(loss.sent == "0" for loss in compared.losses) or UNREAD in rule.params


@given(number=st.floats(-70_000, 70_000, width=32))
@settings(max_examples=60)
def test_what_comes_back_is_stored_once_more_as_it_is(number):
    for firmware in (COPTER, PLANE, PX4):
        for table in (firmware.commands, firmware.placeless or {}, firmware.fence):
            for rule in table.values():
                for way in set(rule.params):
                    held = way.held(number)
                    assert way.retention(held, way.held(held)) != "differs"


@pytest.mark.parametrize("firmware", all_firmwares(), ids=lambda one: one.full_name)
def test_tables_agree_with_themselves(firmware):
    """The parameters are the motion profile's; modes, circles, ignored and flown commands are among those taken."""
    for name, one in firmware.parameters.items():
        if one.field:
            assert getattr(firmware.motion, one.field) == pytest.approx(one.value * one.unit), name
    for activity in ("hold", "mission", "guided", "return", "land"):
        assert firmware.mode_for(activity).activity in (activity, "guided")
    assert len({mode.number for mode in firmware.modes}) == len(firmware.modes)
    taken = firmware.ignored | firmware.quadplane_only | firmware.vtol_only | firmware.not_flown | firmware.navigation
    assert all(firmware.takes(command) for command in {*taken, *firmware.circles})
    again = pickle.loads(pickle.dumps(firmware))
    assert (again.name, again.commands, again.motion) == (firmware.name, firmware.commands, firmware.motion)


def test_the_navigation_commands_are_those_of_the_sources():
    """AP_Mission.cpp, is_nav_cmd; PX4's items that contain a position, the return and the delay."""
    more = {mavlink.MAV_CMD_NAV_SET_YAW_SPEED, mavlink.MAV_CMD_NAV_SCRIPT_TIME, mavlink.MAV_CMD_NAV_ATTITUDE_TIME}
    for command in COPTER.commands:
        assert (command in COPTER.navigation) == (command <= 95 or command in more)
    names = {name for name in {*PX4_PLACES, *PX4_PLACELESS} if name.startswith("NAV_")}
    assert {command_name_of(command) for command in PX4.navigation} == names


FLIGHTS = Path(__file__).parents[3] / "shared" / "data" / "flights"


@pytest.mark.skipif(not FLIGHTS.is_dir(), reason="the shared recordings of flights are not here")
def test_defaults_are_those_that_real_firmwares_name():
    """PX4 as its simulator said when asked (RTL_RETURN_ALT is 30 m, not the module's 60), ArduCopter likewise."""
    asked = json.loads((FLIGHTS / "px4_sih.json").read_text())["parameters"]
    for name in set(asked) & set(PX4.parameters):
        assert PX4.parameters[name].value == pytest.approx(asked[name]), name
    flown = json.loads((FLIGHTS / "arducopter_4.7.json").read_text())[0]["params"]
    for name in set(flown) & set(COPTER.parameters):
        assert COPTER.parameters[name].value == flown[name], name


@pytest.mark.skipif(not FLIGHTS.is_dir(), reason="the shared recordings of flights are not here")
def test_px4s_takeoff_takes_as_long_as_measured():
    missions = json.loads((FLIGHTS / "px4_sih.json").read_text())["missions"]
    for mission in missions.values():
        height, measured = mission["items"][0]["alt"], mission["measured"]["takeoff"]
        assert takeoff_seconds(height, PX4.motion) == pytest.approx(measured, abs=5.0), mission["name"]
