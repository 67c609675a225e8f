"""ArduPilot's mission rules, row by row as they were measured."""

from __future__ import annotations

import math

import pytest
from pymavlink.dialects.v20 import ardupilotmega as mavlink

from gcs_windplan.mission.firmware import firmware_of
from gcs_windplan.standin.items import StoredItem
from gcs_windplan.standin.rules import Parked, ServerOptions
from gcs_windplan.standin.servers import mission_server

from . import speaking as say

ACCEPTED, ERROR, UNSUPPORTED, NO_SPACE, INVALID_SEQUENCE, DENIED, CANCELLED = 0, 1, 3, 4, 13, 14, 15
HOME = StoredItem(0, say.WAYPOINT, x=365_123_456, y=-843_210_987, z=409.12)

FIRMWARE = firmware_of("ardupilot", "multicopter")


@pytest.fixture
def pilot():
    return Parked(HOME)


@pytest.fixture
def server(pilot):
    """Booted at 0, and ready."""
    return mission_server(FIRMWARE, pilot)


def some(n: int, **changes):
    return [say.item(seq, z=50.0 + seq, **changes) for seq in range(n)]


def test_it_asks_with_mission_request(server):
    assert say.told(server.handle(say.count(2), 10)) == [("REQUEST", 0)]
    assert say.told(server.handle(say.item(0), 10)) == [("REQUEST", 1)]
    assert say.told(server.handle(say.item(1), 10)) == [("ACK", ACCEPTED)]
    assert server.arrived == {say.MISSION}


def test_it_asks_again_every_second_and_gives_up_after_eight(server):
    server.handle(say.count(3), 10)
    server.handle(say.item(0), 10.5)
    asked, now = [], 10.5
    while math.isfinite(server.wake):
        now = server.wake
        assert server.tick(now - 0.001) == []
        answer = server.tick(now)
        asked.append((now - 10.5, *say.told(answer)))
    assert asked == [*((float(n), ("REQUEST", 1)) for n in range(1, 8)), (8.0, ("ACK", CANCELLED))]
    assert say.texts(answer) == ["Mission upload timeout"]


def test_an_answer_puts_off_the_end(server):
    server.handle(say.count(3), 10)
    server.tick(17.9)
    assert say.told(server.handle(say.item(0), 17.95)) == [("REQUEST", 1)]
    assert say.told(server.tick(20)) == [("REQUEST", 1)]


def test_an_upload_is_not_atomic_it_cuts_first_and_merges(server):
    say.upload(server, some(6), 10)
    server.handle(say.count(4), 20)
    for seq in range(2):
        server.handle(say.item(seq, z=200.0 + seq), 20)
    server.tick(28.1)
    held = server.items[say.MISSION]
    assert [item.z for item in held] == [pytest.approx(HOME.z), 201.0, 52.0, 53.0]
    assert server.arrived == {say.MISSION}  # of the first one


def test_a_wrong_seq_is_told_and_the_upload_goes_on(server):
    server.handle(say.count(3), 10)
    server.handle(say.item(0), 10)
    assert say.told(server.handle(say.item(2), 10)) == [("ACK", INVALID_SEQUENCE)]
    assert say.told(server.handle(say.item(0), 10)) == [("ACK", INVALID_SEQUENCE)]
    assert say.told(server.handle(say.item(1), 10)) == [("REQUEST", 2)]


def test_a_bad_item_ends_the_upload_and_what_came_before_stays(server):
    say.upload(server, some(3), 10)
    server.handle(say.count(3), 20)
    server.handle(say.item(0), 20)
    server.handle(say.item(1, z=99.0), 20)
    assert say.told(server.handle(say.item(2, params=(math.nan, 0, 0, 0)), 20)) == [("ACK", 6)]
    assert math.isinf(server.wake)
    assert say.told(server.handle(say.item(2), 21)) == [("ACK", ERROR)]
    assert [item.z for item in server.items[say.MISSION]][1:] == [99.0, 52.0]


def test_a_second_ground_station_is_denied(server):
    server.handle(say.count(3), 10)
    server.handle(say.item(0), 10)
    assert say.told(server.handle(say.count(2, by=say.OTHERS), 10)) == [("ACK", DENIED)]
    assert say.told(server.handle(say.item(1, by=say.OTHERS), 10)) == [("ACK", DENIED)]
    assert say.told(server.handle(say.request_list(by=say.OTHERS), 10)) == [("ACK", DENIED)]
    assert say.told(server.handle(say.request(0, by=say.OTHERS), 10)) == [("ACK", DENIED)]
    assert say.told(server.handle(say.item(1), 10)) == [("REQUEST", 2)]


def test_answers_go_to_who_asked(server):
    server.handle(say.count(3), 10)
    (answer,) = server.handle(say.count(2, by=say.OTHERS), 10)
    assert (answer.target_system, answer.target_component) == say.OTHERS


def test_a_count_from_the_same_station_begins_again(server):
    server.handle(say.count(3), 10)
    server.handle(say.item(0), 10)
    server.handle(say.item(1), 10)
    assert say.told(server.handle(say.count(2), 10)) == [("REQUEST", 0)]
    assert say.told(server.handle(say.item(0), 10)) == [("REQUEST", 1)]


def test_an_item_after_the_end_is_an_error(server):
    say.upload(server, some(2), 10)
    assert say.told(server.handle(say.item(1), 10)) == [("ACK", ERROR)]


def test_no_space_while_booting(server):
    assert say.told(server.handle(say.count(2), 1.9)) == [("ACK", NO_SPACE)]
    assert say.told(server.handle(say.count(2), 2.0)) == [("REQUEST", 0)]


def test_a_reboot_ends_the_upload_and_keeps_the_mission(server):
    say.upload(server, some(3), 10)
    server.handle(say.count(3), 20)
    server.reboot(21)
    assert math.isinf(server.wake)
    assert say.told(server.handle(say.count(2), 22)) == [("ACK", NO_SPACE)]
    assert say.told(server.handle(say.item(0), 22)) == [("ACK", ERROR)]
    assert len(server.items[say.MISSION]) == 3


def test_item_0_is_home_whatever_is_sent(server, pilot):
    say.upload(server, [say.item(0, say.TAKEOFF, z=77.0), say.item(1)], 10)
    first, _ = say.download(server, 11)
    assert say.numbers(first) == StoredItem(0, say.WAYPOINT, (0, 0, 0, 0), HOME.x, HOME.y, pytest.approx(HOME.z))
    pilot.home_item = StoredItem(0, say.WAYPOINT, x=1, y=2, z=3.0)
    assert say.download(server, 12)[0].z == 3.0


def test_home_can_always_be_read(server):
    assert say.download(server, 10) == []
    assert say.told(server.handle(say.request(0), 10)) == [("ITEM_INT", 0)]


def test_a_request_behind_the_end_is_answered_with_the_count(server):
    say.upload(server, some(3), 10)
    assert say.told(server.handle(say.request(3), 10)) == [("COUNT", 3), ("ACK", ERROR)]


def test_any_item_can_be_asked_for_at_any_time(server):
    say.upload(server, some(3), 10)
    for seq in (2, 0, 2, 1):
        assert say.told(server.handle(say.request(seq, by=say.OTHERS), 10)) == [("ITEM_INT", seq)]


def test_mission_request_is_answered_with_mission_item(server):
    say.upload(server, some(2), 10)
    (answer,) = server.handle(say.request(1, as_int=False), 10)
    assert answer.get_type() == "MISSION_ITEM"
    assert answer.x == pytest.approx(36.5, abs=4e-6)  # a float of 32 bits
    assert answer.y == pytest.approx(-84.3, abs=8e-6)


def test_mission_item_is_taken_with_the_precision_of_its_floats(server):
    message = mavlink.MAVLink_mission_item_message(1, 1, 0, 3, say.WAYPOINT, 0, 1, 0, 0, 0, 0, 36.5, -84.3, 50)
    server.handle(say.count(2), 10)
    server.handle(say.said(message), 10)
    message.seq = 1
    assert say.told(server.handle(say.said(message), 10)) == [("ACK", ACCEPTED)]
    held = server.items[say.MISSION][1]
    assert (held.x, held.y) == (365_000_000, pytest.approx(-843_000_000, abs=80))


def test_clearing(server, pilot):
    say.upload(server, some(3), 10)
    pilot.flies_mission = True
    assert say.told(server.handle(say.clear(), 10)) == [("ACK", ERROR)]  # measured: refused in AUTO
    assert len(server.items[say.MISSION]) == 3
    pilot.flies_mission = False
    assert say.told(server.handle(say.clear(), 10)) == [("ACK", ACCEPTED)]
    assert server.items[say.MISSION] == []
    server.handle(say.count(3), 10)
    assert say.told(server.handle(say.clear(), 10)) == [("ACK", ERROR)]


def test_a_count_of_zero_clears(server):
    say.upload(server, some(3), 10)
    assert say.told(server.handle(say.count(0), 10)) == [("ACK", ACCEPTED)]
    assert say.download(server, 11) == []


def test_a_cancel_is_not_understood(server):
    server.handle(say.count(3), 10)
    assert server.handle(say.ack(CANCELLED), 10) == []
    assert say.told(server.tick(11)) == [("REQUEST", 0)]


@pytest.mark.parametrize(("target", "answer"), [(0, ERROR), (5, ERROR), (4, ACCEPTED), (1, ACCEPTED)])
def test_a_jump_leads_to_an_item_or_is_refused(server, target, answer):
    items = [*some(4), say.item(4, say.JUMP, (target, 2, 0, 0), x=0, y=0, z=0)]
    assert say.upload(server, items, 10) == [("ACK", answer)]


def test_the_default_room_is_copters_and_can_be_chosen(pilot):
    server = mission_server(FIRMWARE, pilot)
    answer = server.handle(say.count(719), 10)
    assert say.told(answer) == [("ACK", NO_SPACE)]
    assert say.texts(answer) == ["Only 718 items are supported"]
    assert say.told(server.handle(say.count(718), 10)) == [("REQUEST", 0)]
    small = mission_server(FIRMWARE, pilot, ServerOptions(capacity=5))
    assert say.told(small.handle(say.count(6), 10)) == [("ACK", NO_SPACE)]
    assert say.told(small.handle(say.count(5), 10)) == [("REQUEST", 0)]


def test_others_are_not_answered(server):
    assert server.handle(say.count(2, to=(2, 1)), 10) == []
    assert server.handle(say.count(2, to=(1, 100)), 10) == []
    assert say.told(server.handle(say.count(2, to=(0, 0)), 10)) == [("REQUEST", 0)]


def test_an_unknown_type_is_unsupported(server):
    assert say.told(server.handle(say.count(2, kind=7), 10)) == [("ACK", UNSUPPORTED)]
    assert say.told(server.handle(say.clear(say.ALL), 10)) == [("ACK", UNSUPPORTED)]


def test_mavlink_1_has_no_fence(pilot):
    server = mission_server(FIRMWARE, pilot, ServerOptions(mavlink1=True))
    answer = server.handle(say.count(3, say.FENCE), 10)
    assert say.told(answer) == [("ACK", UNSUPPORTED)]
    assert say.texts(answer) == ["Need mavlink2 for item transfer"]
    assert say.told(server.handle(say.count(3), 10)) == [("REQUEST", 0)]


def test_current(server, pilot):
    say.upload(server, some(4), 10)
    assert say.told(server.handle(say.set_current(2), 10)) == [("CURRENT", 2)]
    assert pilot.current == 2
    answer = server.handle(say.set_current(4), 10)
    assert say.told(answer) == []
    assert "does not exist" in say.texts(answer)[0]
    assert [message.current for message in say.download(server, 11)] == [0, 0, 1, 0]


@pytest.mark.parametrize("current", [2, 3])
def test_an_item_with_current_2_or_3_is_flown_to_and_never_stored(pilot, current):
    flown = []

    class Guided(Parked):
        def fly_there(self, item):
            flown.append(item)
            return True

    server = mission_server(FIRMWARE, Guided(HOME))
    say.upload(server, some(3), 10)
    server.handle(say.count(2), 11)
    assert say.told(server.handle(say.item(0, current=current, z=321.0), 11)) == [("ACK", ACCEPTED)]
    assert [item.z for item in flown] == [321.0]
    assert say.told(server.handle(say.item(0), 11)) == [("REQUEST", 1)]  # the upload goes on
    parked = mission_server(FIRMWARE, pilot)
    assert say.told(parked.handle(say.item(0, current=current), 10)) == [("ACK", ERROR)]


def partial(first, last):
    return say.said(mavlink.MAVLink_mission_write_partial_list_message(1, 1, first, last, say.MISSION))


def test_writing_a_part(server):
    say.upload(server, some(5), 10)
    assert say.told(server.handle(partial(2, 3), 11)) == [("REQUEST", 2)]
    server.handle(say.item(2, z=200.0), 11)
    assert say.told(server.handle(say.item(3, z=201.0), 11)) == [("ACK", ACCEPTED)]
    assert [item.z for item in server.items[say.MISSION]][1:] == [51.0, 200.0, 201.0, 54.0]
    assert say.told(server.handle(partial(3, 9), 12)) == [("ACK", ERROR)]


TRIANGLE = [say.item(seq, say.INCLUSION, (3, 0, 0, 0), x=365_000_000 + seq, kind=say.FENCE) for seq in range(3)]


def circle(seq, radius=120.5):
    return say.item(seq, say.CIRCLE_OUT, (radius, 0, 0, 0), kind=say.FENCE)


def test_a_fence_is_gathered_first(server):
    say.upload(server, [*TRIANGLE, circle(3)], 10, say.FENCE)
    server.handle(say.count(1, say.FENCE), 20)
    server.tick(28.1)
    assert len(server.items[say.FENCE]) == 4
    triangle, *_, last = say.download(server, 30, say.FENCE)
    assert say.numbers(triangle) == StoredItem(0, say.INCLUSION, (3, 0, 0, 0), say.LATITUDE, say.LONGITUDE, 0.0)
    assert last.param1 == 120.5


@pytest.mark.parametrize(
    "items",
    [
        TRIANGLE[:2],
        [*TRIANGLE[:2], circle(2)],
        [circle(0, 0.0)],
        [say.item(seq, say.INCLUSION, (2, 0, 0, 0), kind=say.FENCE) for seq in range(2)],
        [say.item(0, say.CIRCLE_IN, (9, 0, 0, 0), x=900_000_001, kind=say.FENCE)],
    ],
    ids=["corner missing", "cut short", "no radius", "two corners", "off the Earth"],
)
def test_a_broken_fence_is_refused_at_its_end(server, items):
    say.upload(server, TRIANGLE, 10, say.FENCE)
    assert say.upload(server, items, 20, say.FENCE) == [("ACK", ERROR)]
    assert len(server.items[say.FENCE]) == 3


def test_fence_and_rally_points_arrive_beside_a_mission(server):
    server.handle(say.count(2), 10)
    assert say.upload(server, TRIANGLE, 10, say.FENCE) == [("ACK", ACCEPTED)]
    rally = [say.item(0, say.RALLY_POINT, z=99.99, kind=say.RALLY)]
    assert say.upload(server, rally, 10, say.RALLY) == [("ACK", ACCEPTED)]
    assert say.told(server.handle(say.item(0), 10)) == [("REQUEST", 1)]
    (point,) = say.download(server, 11, say.RALLY)
    assert (point.frame, point.z) == (3, 99.0)  # AP_Rally keeps whole metres
    assert say.told(server.handle(say.request(1, say.RALLY), 11)) == [("ACK", INVALID_SEQUENCE)]


def test_fence_and_rally_points_have_their_own_room(server):
    assert say.told(server.handle(say.count(71, say.FENCE), 10)) == [("ACK", NO_SPACE)]
    assert say.told(server.handle(say.count(47, say.RALLY), 10)) == [("ACK", NO_SPACE)]


def test_what_happened_is_noted_in_plain_words(server):
    say.upload(server, some(2), 10)
    server.handle(say.count(900), 11)
    assert server.notes == [
        "upload of 2 items of mission by 255/190 begins",
        "upload of mission by 255/190 accepted: 2 items in 0.00 s",
        "refused 255/190 (mission): NO_SPACE (4), 900 items, room for 718",
    ]
