"""What a firmware keeps is compared, what it does not keep is a loss, and nothing else passes."""

from __future__ import annotations

import math
from dataclasses import replace

import pytest
from hypothesis import given
from hypothesis import strategies as st
from pymavlink.dialects.v20 import ardupilotmega as mavlink

from gcs_windplan.link.comparison import Difference, compare_either_way, compare_items, loss_lines
from gcs_windplan.link.wire import item_to_message, message_to_item
from gcs_windplan.mission import Command, Frame, MissionItem, command_name, takes_place
from gcs_windplan.mission.firmware import known_firmware
from gcs_windplan.standin import storage
from gcs_windplan.standin.items import MISSION, StoredItem, read_item

from .autopilots import PX4, ArduPilot, Refused, Stored

WAYPOINT = MissionItem(3, Command.NAV_WAYPOINT, (2.0, 5.0, 0.0, 90.0), 46.8, 9.8, 61.999)
SPEED = MissionItem(0, Command.DO_CHANGE_SPEED, (1.0, 14.5, -1.0, 0.0))

items = st.builds(
    MissionItem,
    st.sampled_from([0, 3]),
    st.sampled_from([Command.NAV_WAYPOINT, Command.NAV_LAND, Command.NAV_LOITER_TIME, Command.NAV_TAKEOFF]),
    st.tuples(
        st.floats(0, 300, width=32),
        st.integers(0, 5).map(float),
        st.floats(-100, 100, width=32),
        st.floats(0, 359, width=32),
    ),
    st.integers(-900_000_000, 900_000_000).map(lambda e7: e7 / 1e7),
    st.integers(-1_800_000_000, 1_800_000_000).map(lambda e7: e7 / 1e7),
    st.floats(-400, 9000),
)


def kept(item: MissionItem, profile) -> MissionItem:
    """The item as a scripted autopilot gives it back."""
    held = profile.kept(
        Stored(item.command, item.frame, item.params, item.x, item.y, item.altitude, int(item.autocontinue)), 0
    )
    return MissionItem(
        held.frame, held.command, held.params, held.x / 1e7, held.y / 1e7, held.z, bool(held.autocontinue)
    )


@pytest.mark.parametrize("profile", [ArduPilot, PX4])
@given(item=items)
def test_what_the_firmware_makes_of_an_item_is_no_difference(profile, item):
    autopilot = "px4" if profile is PX4 else "ardupilot"
    found = compare_items([item], [kept(item, profile)], firmware=known_firmware(autopilot, "multicopter"))
    assert found.differences == ()


@pytest.mark.parametrize("autopilot", ["ardupilot", "px4", None])
@given(item=items, change=st.sampled_from(["latitude_deg", "longitude_deg", "altitude", "frame", "command"]))
def test_any_other_place_is_a_difference(autopilot, item, change):
    changed = {
        "latitude_deg": item.latitude_deg - math.copysign(1e-7, item.latitude_deg),
        "longitude_deg": item.longitude_deg - math.copysign(1e-7, item.longitude_deg),
        "altitude": item.altitude + 0.03,
        "frame": 3 - item.frame,
        "command": int(Command.NAV_LOITER_UNLIM),
    }
    found = compare_items([item], [replace(item, **{change: changed[change]})], firmware=known_firmware(autopilot))
    assert len(found.differences) == 1
    assert found.differences[0].seq == 0


@pytest.mark.parametrize(
    ("sent", "held", "fate"),
    [
        (61.999, 61.99, "lost"),  # measured on ArduCopter 4.7
        (61.999, 61.98, "differs"),
        (-12.345, -12.34, "lost"),
        (-12.345, -12.36, "differs"),
        (50.3, 50.29, "lost"),  # the float just below 50.3
        (8848.86, 8848.86, "same"),
    ],
)
def test_centimetres_of_ardupilot(sent, held, fate):
    found = compare_items(
        [replace(WAYPOINT, altitude=sent)], [replace(WAYPOINT, altitude=held)], firmware=known_firmware("ardupilot")
    )
    assert ("differs" if found.differences else "lost" if found.losses else "same") == fate
    exact = compare_items(
        [replace(WAYPOINT, altitude=sent)], [replace(WAYPOINT, altitude=held)], firmware=known_firmware("px4")
    )
    assert exact.same == (fate == "same")


@pytest.mark.parametrize(
    ("item", "params", "autopilot", "vehicle_type", "same"),
    [
        (WAYPOINT, (2, 0, 0, 0), "ardupilot", "multicopter", True),
        (WAYPOINT, (0, 0, 0, 0), "ardupilot", "multicopter", False),
        (WAYPOINT, (0, 5, 0, 0), "ardupilot", "fixed-wing", True),
        (WAYPOINT, (0, 4, 0, 0), "ardupilot", "fixed-wing", False),
        (replace(WAYPOINT, params=(-1, 0, 0, 0)), (65535, 0, 0, 0), "ardupilot", "multicopter", False),
        (replace(WAYPOINT, params=(2.7, 0, 0, math.nan)), (2, 0, 0, 0), "ardupilot", "multicopter", True),
        (WAYPOINT, (2, 5, 0, 90.00001), "px4", None, True),
        (WAYPOINT, (2, 5, 0, -270), "px4", None, True),
        (WAYPOINT, (2, 5, 0, 91), "px4", None, False),
        (WAYPOINT, (2, 5, 0, math.nan), "px4", None, False),
        (WAYPOINT, (2, 0, 0, 90), "px4", None, False),
        (SPEED, (1, 14.5, -1, 0), "ardupilot", None, True),
        (SPEED, (1, 14, -1, 0), "ardupilot", None, False),
        (SPEED, (1, 14.5, 0, 0), "ardupilot", None, False),
        (SPEED, (0, 14.5, -1, 0), "px4", None, False),
        (SPEED, (1, 14.5, -1, 0), None, None, True),
        (replace(SPEED, params=(1, 0.1, -1, 0)), (1, 0.10000000149011612, -1, 0), "px4", None, True),
    ],
)
def test_parameters(item, params, autopilot, vehicle_type, same):
    held = replace(item, params=params)
    assert compare_items([item], [held], firmware=known_firmware(autopilot, vehicle_type)).same == same


def test_frames_without_a_place_do_not_matter():
    for autopilot in ("ardupilot", "px4"):
        assert compare_items([SPEED], [replace(SPEED, frame=Frame.MISSION)], firmware=known_firmware(autopilot)).same


def test_a_place_in_frame_mission_is_not_the_place_that_ardupilot_makes_of_it():
    sent = replace(WAYPOINT, frame=Frame.MISSION)
    held = replace(WAYPOINT, frame=Frame.GLOBAL, latitude_deg=47e-7, longitude_deg=10e-7)  # x = 47, y = 10
    assert not compare_items([sent], [held], firmware=known_firmware("ardupilot")).same


def test_numbers_of_items():
    found = compare_items([WAYPOINT, SPEED], [WAYPOINT], firmware=known_firmware("px4"))
    assert [str(difference) for difference in found.differences] == ["the number of items 2 became 1"]
    assert not compare_items([], [WAYPOINT]).same


def test_differences_are_said_with_the_number_of_the_item():
    found = compare_items([SPEED, WAYPOINT], [SPEED, replace(WAYPOINT, latitude_deg=46.9)], first=1)
    assert str(found.differences[0]) == "item 2: latitude 46.8000000 became 46.9000000"


def test_fences_have_no_heights_and_no_frames():
    circle = MissionItem(3, Command.NAV_FENCE_CIRCLE_INCLUSION, (120.5, 0, 0, 0), 46.8, 9.8, 30.0)
    held = replace(circle, frame=0, altitude=0.0)
    for autopilot in ("ardupilot", "px4"):
        assert compare_items([circle], [held], mission_type="fence", firmware=known_firmware(autopilot)).same
        smaller = replace(held, params=(120.0, 0, 0, 0))
        assert not compare_items([circle], [smaller], mission_type="fence", firmware=known_firmware(autopilot)).same


def test_rally_points_of_ardupilot_are_whole_metres():
    rally = MissionItem(3, Command.NAV_RALLY_POINT, (0, 0, 0, 0), 46.8, 9.8, 60.75)
    for altitude, same in ((60.0, True), (60.75, True), (59.0, False)):
        held = replace(rally, altitude=altitude)
        assert compare_items([rally], [held], mission_type="rally", firmware=known_firmware("ardupilot")).same == same


def test_either_way():
    planned, onboard = [WAYPOINT], [replace(WAYPOINT, altitude=61.99, params=(2, 0, 0, 0))]
    for one, other in ((planned, onboard), (onboard, planned)):
        found = compare_either_way(one, other, firmware=known_firmware("ardupilot", "multicopter"))
        assert found.same
        assert len(found.losses) == 3
        (altitude,) = [loss for loss in found.losses if loss.field == "altitude"]
        assert (altitude.sent, altitude.held) == (f"{one[0].altitude:g}", f"{other[0].altitude:g}")


def test_the_scripted_ardupilot_refuses_what_the_rules_say():
    with pytest.raises(Refused):
        kept(replace(WAYPOINT, params=(math.nan, 0, 0, 0)), ArduPilot)


LOITER_TURNS, LOITER_TIME = mavlink.MAV_CMD_NAV_LOITER_TURNS, mavlink.MAV_CMD_NAV_LOITER_TIME
UNKNOWN = 50_000  # a command that nobody knows


def with_number(command: int, number: int, value: float, frame: int | None = None) -> MissionItem:
    """An item with one of its parameters set, at a place if it takes one."""
    placed = takes_place(command) or command == UNKNOWN
    numbers = [0.0, 0.0, 0.0, 0.0, *((46.8, 9.8, 50.0) if placed else (0.0, 0.0, 0.0))]
    numbers[number - 1] = value
    chosen = (Frame.GLOBAL_RELATIVE_ALT if placed else Frame.MISSION) if frame is None else frame
    return MissionItem(chosen, command, tuple(numbers[:4]), *numbers[4:])


TAMPERED = [
    (mavlink.MAV_CMD_DO_FENCE_ENABLE, 1, 1, 0),
    (mavlink.MAV_CMD_DO_PARACHUTE, 1, 2, 0),
    (mavlink.MAV_CMD_DO_SET_SERVO, 1, 9, 0),
    (mavlink.MAV_CMD_DO_SET_SERVO, 2, 1900, 0),
    (mavlink.MAV_CMD_DO_SET_SERVO, 2, 1900, 1100),
    (mavlink.MAV_CMD_DO_REPEAT_SERVO, 4, 1.5, 1),
    (mavlink.MAV_CMD_DO_SET_RELAY, 2, 1, 0),
    (mavlink.MAV_CMD_DO_REPEAT_RELAY, 2, 3, 0),
    (mavlink.MAV_CMD_DO_GRIPPER, 2, 1, 0),
    (mavlink.MAV_CMD_DO_AUX_FUNCTION, 1, 9, 0),
    (mavlink.MAV_CMD_DO_AUX_FUNCTION, 2, 2, 0),
    (mavlink.MAV_CMD_DO_ENGINE_CONTROL, 1, 1, 0),
    (mavlink.MAV_CMD_DO_ENGINE_CONTROL, 3, 2.5, 0),
    (mavlink.MAV_CMD_NAV_GUIDED_ENABLE, 1, 1, 0),
    (mavlink.MAV_CMD_DO_GUIDED_LIMITS, 3, 120, 0),
    (mavlink.MAV_CMD_DO_MOUNT_CONTROL, 1, -90, 0),
    (mavlink.MAV_CMD_DO_GIMBAL_MANAGER_PITCHYAW, 1, -45, 0),
    (mavlink.MAV_CMD_DO_GIMBAL_MANAGER_PITCHYAW, 7, 2, 0),
    (mavlink.MAV_CMD_NAV_ATTITUDE_TIME, 1, 20, 0),
    (mavlink.MAV_CMD_NAV_ATTITUDE_TIME, 2, 30, 0),
    (mavlink.MAV_CMD_NAV_ATTITUDE_TIME, 3, -10, 0),
    (mavlink.MAV_CMD_NAV_ATTITUDE_TIME, 4, 270, 0),
    (mavlink.MAV_CMD_NAV_ATTITUDE_TIME, 5, 3, 0),
    (mavlink.MAV_CMD_NAV_SCRIPT_TIME, 3, 4, 0),
    (mavlink.MAV_CMD_NAV_SCRIPT_TIME, 4, 4, 0),
    (mavlink.MAV_CMD_NAV_SCRIPT_TIME, 4, 4, 4.01),
    (mavlink.MAV_CMD_NAV_SCRIPT_TIME, 6, 7, 0),
    (mavlink.MAV_CMD_DO_SEND_SCRIPT_MESSAGE, 2, 7, 0),
    (mavlink.MAV_CMD_DO_WINCH, 3, -5, 0),
    (mavlink.MAV_CMD_DO_DIGICAM_CONTROL, 5, 1, 0),
    (mavlink.MAV_CMD_DO_SET_CAM_TRIGG_DIST, 1, 25, 0),
    (mavlink.MAV_CMD_DO_SET_CAM_TRIGG_DIST, 3, 1, 0),
    (mavlink.MAV_CMD_DO_SET_ACTUATOR, 1, 0.6, 0),
    (mavlink.MAV_CMD_DO_SET_ACTUATOR, 5, 0.6, 1),
    (mavlink.MAV_CMD_DO_SET_ACTUATOR, 5, 1, 0),
    (mavlink.MAV_CMD_CONDITION_YAW, 4, 1, 0),
    (mavlink.MAV_CMD_NAV_CONTINUE_AND_CHANGE_ALT, 7, 80, 0),
    (mavlink.MAV_CMD_NAV_CONTINUE_AND_CHANGE_ALT, 7, 80, 79.98),
    (mavlink.MAV_CMD_NAV_CONTINUE_AND_CHANGE_ALT, 7, 80, 80.01),
    (mavlink.MAV_CMD_NAV_PAYLOAD_PLACE, 1, 2, 100),
    (mavlink.MAV_CMD_NAV_PAYLOAD_PLACE, 1, 2.5, 2),
    (mavlink.MAV_CMD_NAV_LAND, 4, 0, 90),
    (mavlink.MAV_CMD_NAV_LAND, 4, 90, 45),
    (mavlink.MAV_CMD_NAV_LAND, 4, -1, 1),
    (mavlink.MAV_CMD_NAV_LAND, 4, 90, math.nan),
    (mavlink.MAV_CMD_NAV_VTOL_LAND, 1, 1, 0),
    (mavlink.MAV_CMD_NAV_VTOL_LAND, 1, 0, 1),
    (mavlink.MAV_CMD_NAV_VTOL_LAND, 3, 30, 90),
    (LOITER_TURNS, 1, 5, 50),
    (LOITER_TURNS, 1, 5, 0),
    (LOITER_TURNS, 1, 300, 44),
    (LOITER_TURNS, 1, 5, math.nan),
    (LOITER_TURNS, 3, 30, -3000),
    (LOITER_TURNS, 3, 30, -30),
    (LOITER_TURNS, 3, 30, 28),
    (LOITER_TURNS, 3, 30, 31),
    (LOITER_TURNS, 3, 1000, 980),
    (LOITER_TURNS, 3, 3000, 2550),
    (LOITER_TURNS, 3, 300, 44),
    (LOITER_TURNS, 4, 1, 7),
    (LOITER_TURNS, 4, 1, math.nan),
    (LOITER_TIME, 1, 30, 0),
    (LOITER_TIME, 3, 50, 2000),
    (LOITER_TIME, 3, 50, -1),
    (UNKNOWN, 1, 1, 0),
    (UNKNOWN, 2, 2.5, 2),
    (UNKNOWN, 4, math.nan, 0),
    (UNKNOWN, 5, 46.8, 0),
    (UNKNOWN, 6, 9.8, 0),
    (UNKNOWN, 7, 50, 0),
    (UNKNOWN, 7, 50, 50.005),
]


@pytest.mark.parametrize("vehicle_type", ["multicopter", "fixed-wing", None])
@pytest.mark.parametrize(("command", "number", "sent", "held"), TAMPERED)
def test_ardupilot_holding_another_number_is_a_difference(command, number, sent, held, vehicle_type):
    ours, theirs = with_number(command, number, sent), with_number(command, number, held)
    found = compare_items([ours], [theirs], firmware=known_firmware("ardupilot", vehicle_type))
    assert len(found.differences) == 1
    name = {5: "latitude", 6: "longitude", 7: "altitude"}.get(number) if command == UNKNOWN else None
    assert found.differences[0].field == (name or f"parameter {number}")


@pytest.mark.parametrize(
    ("command", "number", "sent", "held"),
    [
        (LOITER_TURNS, 1, 2.5, 2),
        (LOITER_TURNS, 1, 0.3, 76 / 256),
        (LOITER_TURNS, 3, -30.7, -30),
        (LOITER_TURNS, 3, 1234, 1230),
        (LOITER_TURNS, 3, 260, 250),  # 26 in tenths, as a float
        (LOITER_TURNS, 4, 0.5, 1),
        (LOITER_TIME, 3, 50, 1),
        (mavlink.MAV_CMD_NAV_LAND, 4, 90, 1),
        (mavlink.MAV_CMD_NAV_LAND, 4, -90, -1),
        (mavlink.MAV_CMD_NAV_LAND, 4, math.nan, 1),
        (mavlink.MAV_CMD_NAV_LAND, 4, 90, 0),
        (mavlink.MAV_CMD_NAV_PAYLOAD_PLACE, 1, 2.509, 2.5),
        (mavlink.MAV_CMD_NAV_VTOL_LAND, 3, 30, 0),
        (mavlink.MAV_CMD_NAV_WAYPOINT, 4, 90, 0),
        (mavlink.MAV_CMD_DO_MOUNT_CONTROL, 7, 2, 0),
        (mavlink.MAV_CMD_NAV_SCRIPT_TIME, 3, 0.1, 0.0999755859375),
        (mavlink.MAV_CMD_NAV_CONTINUE_AND_CHANGE_ALT, 7, 80.019, 80.01),
    ],
)
def test_what_ardupilot_does_not_keep_is_a_loss(command, number, sent, held):
    ours, theirs = with_number(command, number, sent), with_number(command, number, held)
    found = compare_items([ours], [theirs], firmware=known_firmware("ardupilot", "multicopter"))
    assert found.differences == ()
    assert [loss.field for loss in found.losses] == [f"parameter {number}"]


def as_kept(command: int, params: tuple[float, float, float, float]) -> tuple[MissionItem, MissionItem | None]:
    """An item, and what the stand-in's store gives back of it."""
    placed = (46.8, 9.8, 50.125) if takes_place(command) else (0.0, 0.0, 0.0)
    item = MissionItem(Frame.GLOBAL_RELATIVE_ALT, command, params, *placed)
    held = storage.store(read_item(item_to_message(item, 1, 1, 1, MISSION)), MISSION, known_firmware("ardupilot"))
    if not isinstance(held, StoredItem):
        return item, None
    numbers = (held.command, 0, 1, *held.params, held.x, held.y, held.z)
    return item, message_to_item(mavlink.MAVLink_mission_item_int_message(1, 1, 1, held.frame, *numbers, MISSION))


@pytest.mark.parametrize("command", sorted(known_firmware("ardupilot").commands), ids=command_name)
def test_whole_numbers_that_the_stand_in_keeps_are_no_difference(command):
    for params in ((0.0, 0.0, 0.0, 0.0), (1.0, 1.0, 1.0, 1.0), (2.5, 5.0, 1.0, 1.0)):
        item, held = as_kept(command, params)
        assert held is not None
        assert compare_items([item], [held], firmware=known_firmware("ardupilot", "multicopter")).same


def test_the_frame_of_a_command_that_nobody_knows_counts():
    sent = with_number(UNKNOWN, 1, 0)
    found = compare_items([sent], [replace(sent, frame=Frame.GLOBAL)], firmware=known_firmware("ardupilot"))
    assert [difference.field for difference in found.differences] == ["frame"]
    nowhere = replace(sent, latitude_deg=0.0, longitude_deg=0.0, altitude=0.0)
    assert compare_items([nowhere], [replace(nowhere, frame=Frame.GLOBAL)], firmware=known_firmware("ardupilot")).same


def test_the_frame_of_an_altitude_without_a_place_counts():
    sent = with_number(Command.NAV_CONTINUE_AND_CHANGE_ALT, 7, 80.0, Frame.GLOBAL_RELATIVE_ALT)
    found = compare_items([sent], [replace(sent, frame=Frame.GLOBAL)], firmware=known_firmware("ardupilot"))
    assert [difference.field for difference in found.differences] == ["frame"]


def test_frame_mission_becomes_one_above_the_sea_where_no_height_is():
    sent = MissionItem(Frame.MISSION, Command.DO_LAND_START)
    found = compare_items([sent], [replace(sent, frame=Frame.GLOBAL)], firmware=known_firmware("ardupilot"))
    assert (found.same, [loss.rounded for loss in found.losses]) == (True, [True])
    high = replace(sent, altitude=30.0)
    assert not compare_items([high], [replace(high, frame=Frame.GLOBAL)], firmware=known_firmware("ardupilot")).same


@pytest.mark.parametrize(
    ("sent", "held"),
    [
        (61.999, 62.0),
        (61.991, 62.0),
        (-12.345, -12.35),
        (50.0, 50.01),
        (50.0, 49.98),
        (50.009, 50.004),
        (0.005, -0.001),
        (50.0, -50.0),
    ],
)
def test_altitudes_of_ardupilot_are_cut_towards_zero_only(sent, held):
    ours, theirs = replace(WAYPOINT, altitude=sent), replace(WAYPOINT, altitude=held)
    assert not compare_items([ours], [theirs], firmware=known_firmware("ardupilot")).same


@given(st.floats(-9000, 9000))
def test_every_altitude_that_the_stand_in_stores_is_rounded(altitude):
    item = replace(WAYPOINT, altitude=altitude)
    held = storage.store(read_item(item_to_message(item, 1, 1, 1, MISSION)), MISSION, known_firmware("ardupilot"))
    assert isinstance(held, StoredItem)
    found = compare_items([item], [replace(item, altitude=held.z)], firmware=known_firmware("ardupilot"))
    assert found.same
    assert all(loss.rounded for loss in found.losses)


def test_rally_points_lose_metres_towards_zero_only():
    rally = MissionItem(3, Command.NAV_RALLY_POINT, (0, 0, 0, 0), 46.8, 9.8, 60.75)
    for altitude in (61.0, 60.5, 60.76):
        held = replace(rally, altitude=altitude)
        assert not compare_items([rally], [held], mission_type="rally", firmware=known_firmware("ardupilot")).same


@pytest.mark.parametrize("autopilot", ["ardupilot", "px4", None])
def test_parts_of_parameters_5_and_6_count(autopilot):
    for number in (5, 6):
        ours = with_number(mavlink.MAV_CMD_DO_SET_ACTUATOR, number, 0.6)
        theirs = with_number(mavlink.MAV_CMD_DO_SET_ACTUATOR, number, 1.0)
        (found,) = compare_items([ours], [theirs], firmware=known_firmware(autopilot)).differences
        assert str(found) == f"item 0: parameter {number} 0.6 became 1"


@pytest.mark.parametrize(("yaw", "same"), [(90, True), (1, True), (0, False), (45, False), (math.nan, False)])
def test_loitering_on_px4_keeps_a_yaw_or_a_flag(yaw, same):
    ours = with_number(LOITER_TIME, 4, 90)
    assert compare_items([ours], [with_number(LOITER_TIME, 4, yaw)], firmware=known_firmware("px4")).same == same


def test_numbers_too_large_for_a_float_are_compared():
    huge = replace(WAYPOINT, altitude=1e39)
    for autopilot in ("ardupilot", "px4", None):
        assert not compare_items([huge], [WAYPOINT], firmware=known_firmware(autopilot)).same
        assert compare_items([huge], [huge], firmware=known_firmware(autopilot)).same


def test_losses_in_words():
    centimetre = [Difference(seq, "altitude", "61.999", "61.99", rounded=True) for seq in range(1, 32)]
    frame = Difference(32, "frame", "MISSION", "GLOBAL", rounded=True)
    others = [Difference(seq, "parameter 2", "5", "0") for seq in (2, 3, 4, 7)]
    alone = Difference(9, "parameter 4", "90", "0")
    assert loss_lines([*centimetre, frame, *others, alone], known_firmware("ardupilot")) == (
        "31 altitudes differ by less than ArduPilot's centimetre",
        "1 frame differs that no altitude refers to",
        "not kept by ArduPilot: parameter 2 5 became 0 (items 2 to 4, 7)",
        "not kept by ArduPilot: parameter 4 90 became 0 (item 9)",
    )
    assert loss_lines([], None) == ()


@given(st.lists(items, max_size=4), st.lists(items, max_size=4), st.sampled_from(["ardupilot", "px4", None]))
def test_either_way_is_the_same_both_ways(one, other, autopilot):
    there = compare_either_way(one, other, firmware=known_firmware(autopilot))
    back = compare_either_way(other, one, firmware=known_firmware(autopilot))
    assert there.same == back.same
    named = [{(found.seq, found.field) for found in comparison.differences} for comparison in (there, back)]
    assert named[0] == named[1]
