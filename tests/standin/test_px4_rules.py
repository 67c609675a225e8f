"""PX4's mission rules, row by row."""

from __future__ import annotations

import math

import pytest

from gcs_windplan.mission.firmware import firmware_of
from gcs_windplan.standin.rules import Parked, ServerOptions
from gcs_windplan.standin.servers import mission_server

from . import speaking as say

ACCEPTED, ERROR, UNSUPPORTED_FRAME, UNSUPPORTED, NO_SPACE, INVALID, CANCELLED = 0, 1, 2, 3, 4, 5, 15

FIRMWARE = firmware_of("px4", "multicopter")


@pytest.fixture
def pilot():
    return Parked()


@pytest.fixture
def server(pilot):
    return mission_server(FIRMWARE, pilot)


def some(n: int):
    return [say.item(seq, say.TAKEOFF if seq == 0 else say.WAYPOINT, z=50.0 + seq) for seq in range(n)]


def altitudes(server):
    return [item.z for item in server.items[say.MISSION]]


def test_it_asks_with_mission_request_int_and_needs_no_time_to_boot(server):
    assert say.told(server.handle(say.count(2), 0)) == [("REQUEST_INT", 0)]
    assert say.told(server.handle(some(2)[0], 0)) == [("REQUEST_INT", 1)]
    assert say.told(server.handle(some(2)[1], 0)) == [("ACK", ACCEPTED)]
    assert server.arrived == {say.MISSION}


def test_it_asks_again_every_250_ms_and_gives_up_after_five_seconds(server):
    server.handle(say.count(3), 10)
    server.handle(some(3)[0], 10.5)
    asked = []
    while math.isfinite(server.wake):
        now = server.wake
        assert server.tick(now - 0.001) == []
        answer = server.tick(now)
        asked.append((now - 10.5, say.told(answer)))
    assert asked[:-1] == [(pytest.approx(0.25 * n), [("REQUEST_INT", 1)]) for n in range(1, 20)]
    assert asked[-1] == (5.0, [])  # and no ACK
    assert say.texts(answer) == ["Operation timeout"]


def test_an_upload_is_atomic(server):
    say.upload(server, some(4), 10)
    server.handle(say.count(3), 20)
    for message in some(3)[:2]:
        server.handle(message, 20)
    server.tick(25.1)
    assert altitudes(server) == [50.0, 51.0, 52.0, 53.0]
    server.handle(say.count(3), 30)
    server.handle(say.item(0, z=300.0), 30)
    assert say.told(server.handle(say.item(1, frame=10), 30)) == [("ACK", UNSUPPORTED_FRAME)]
    assert altitudes(server) == [50.0, 51.0, 52.0, 53.0]
    assert math.isinf(server.wake)


def test_the_last_item_again_is_acknowledged_again(server):
    say.upload(server, some(3), 10)
    assert say.told(server.handle(some(3)[2], 11)) == [("ACK", ACCEPTED)]
    assert say.told(server.handle(some(3)[1], 11)) == [("ACK", ERROR)]
    assert altitudes(server) == [50.0, 51.0, 52.0]


def test_a_count_again_after_item_0_is_an_error_and_the_upload_goes_on(server):
    server.handle(say.count(3), 10)
    assert say.told(server.handle(say.count(3), 10)) == [("REQUEST_INT", 0)]  # item 0 had not come: asked again
    server.handle(some(3)[0], 10)
    assert say.told(server.handle(say.count(3), 10)) == [("ACK", ERROR)]
    assert say.told(server.handle(some(3)[1], 10)) == [("REQUEST_INT", 2)]
    assert say.told(server.handle(some(3)[2], 10)) == [("ACK", ACCEPTED)]


def test_a_wrong_seq_is_ignored(server):
    server.handle(say.count(3), 10)
    assert server.handle(some(3)[2], 10) == []
    assert say.told(server.tick(10.25)) == [("REQUEST_INT", 0)]


def test_a_second_ground_station(server):
    server.handle(say.count(3), 10)
    assert say.told(server.handle(say.count(2, by=say.OTHERS), 10)) == [("ACK", ERROR)]
    answer = server.handle(say.item(0, by=say.OTHERS), 10)
    assert (say.told(answer), say.texts(answer)) == ([], ["REJ. MIS ITEM: partner id mismatch"])
    assert say.told(server.handle(some(3)[0], 10)) == [("REQUEST_INT", 1)]


def test_an_item_of_another_type_is_an_error(server):
    server.handle(say.count(3), 10)
    assert say.told(server.handle(say.item(0, kind=say.FENCE), 10)) == [("ACK", ERROR)]
    assert say.told(server.handle(some(3)[0], 10)) == [("REQUEST_INT", 1)]


def test_cancel(server):
    server.handle(say.count(3), 10)
    server.handle(some(3)[0], 10)
    server.handle(say.ack(CANCELLED, by=say.OTHERS), 10)
    assert math.isfinite(server.wake)
    assert server.handle(say.ack(CANCELLED), 10) == []
    assert math.isinf(server.wake)
    assert server.notes[-1] == "upload of mission cancelled by 255/190 at item 1"
    assert say.upload(server, some(2), 11) == [("ACK", ACCEPTED)]


def test_unsupported_makes_it_ask_the_other_way(server):
    server.handle(say.count(3), 10)
    assert say.told(server.handle(say.ack(UNSUPPORTED), 10)) == [("REQUEST", 0)]
    assert say.told(server.handle(say.ack(UNSUPPORTED), 10)) == [("REQUEST_INT", 0)]


def test_download_is_asked_for_in_order(server):
    say.upload(server, some(4), 10)
    assert say.told(server.handle(say.request_list(), 11)) == [("COUNT", 4)]
    assert say.told(server.handle(say.request(0), 11)) == [("ITEM_INT", 0)]
    assert say.told(server.handle(say.request(0), 11)) == [("ITEM_INT", 0)]  # ours was lost
    assert say.told(server.handle(say.request(1), 11)) == [("ITEM_INT", 1)]
    answer = server.handle(say.request(3), 11)
    assert say.told(answer) == [("ACK", ERROR)]
    assert say.texts(answer) == ["WPM: REJ. CMD: Req. WP was unexpected"]
    assert server.handle(say.request(2), 11) == []  # no download is on its way any more


def test_while_a_download_is_on_its_way(server):
    say.upload(server, some(3), 10)
    server.handle(say.request_list(), 11)
    answer = server.handle(say.request_list(by=say.OTHERS), 11)
    assert (say.told(answer), say.texts(answer)) == ([], ["Mission download request ignored, already active"])
    assert say.told(server.handle(say.count(2), 11)) == [("ACK", ERROR)]
    answer = server.handle(say.clear(), 11)
    assert (say.told(answer), say.texts(answer)) == ([], ["WPM: IGN CLEAR CMD: Busy"])
    answer = server.handle(say.set_current(1), 11)
    assert say.texts(answer) == ["WPM: IGN WP CURR CMD: Busy"]
    assert say.texts(server.tick(16.0)) == ["Operation timeout"]
    assert say.told(server.handle(say.clear(), 17)) == [("ACK", ACCEPTED)]


def test_a_download_without_its_ack_does_not_block(server):
    say.upload(server, some(2), 10)
    server.handle(say.request_list(), 11)
    for seq in range(2):
        server.handle(say.request(seq), 11)
    assert say.told(server.handle(say.request_list(by=say.OTHERS), 11)) == [("COUNT", 2)]


def test_mission_request_is_answered_with_mission_item_in_plain_frames(server):
    say.upload(server, some(2), 10)
    assert [message.frame for message in say.download(server, 11)] == [6, 6]
    assert [message.frame for message in say.download(server, 12, as_int=False)] == [3, 3]


def test_clearing_and_count_zero(server):
    say.upload(server, some(2), 10)
    assert say.told(server.handle(say.count(0), 11)) == [("ACK", ACCEPTED)]
    assert altitudes(server) == []
    say.upload(server, some(2), 12)
    rally = [say.item(0, say.RALLY_POINT, kind=say.RALLY)]
    assert say.upload(server, rally, 12, say.RALLY) == [("ACK", ACCEPTED)]
    assert say.told(server.handle(say.clear(say.ALL), 13)) == [("ACK", ACCEPTED)]
    assert {kind: len(items) for kind, items in server.items.items()} == {0: 0, 1: 0, 2: 0}


def test_room(pilot):
    server = mission_server(FIRMWARE, pilot)
    assert say.told(server.handle(say.count(2001), 10)) == [("ACK", NO_SPACE)]
    assert say.told(server.handle(say.count(2000), 10)) == [("REQUEST_INT", 0)]
    small = mission_server(FIRMWARE, pilot, ServerOptions(capacity=5))
    assert say.told(small.handle(say.count(6), 10)) == [("ACK", NO_SPACE)]


def test_a_fence_polygon_has_three_corners(server):
    triangle = [say.item(seq, say.INCLUSION, (3, 0, 0, 0), kind=say.FENCE) for seq in range(3)]
    assert say.upload(server, triangle, 10, say.FENCE) == [("ACK", ACCEPTED)]
    assert say.upload(server, [say.item(0, say.INCLUSION, (2, 0, 0, 0), kind=say.FENCE)], 11, say.FENCE) == [
        ("ACK", ERROR)
    ]
    assert len(server.items[say.FENCE]) == 3


def test_what_belongs_to_a_fence_is_no_mission_item(server):
    server.handle(say.count(1), 10)
    assert say.told(server.handle(say.item(0, say.RALLY_POINT), 10)) == [("ACK", ERROR)]


def test_a_takeoff_behind_a_waypoint_is_held_and_not_flown(server):
    server.handle(say.count(2), 10)
    server.handle(say.item(0), 10)
    answer = server.handle(say.item(1, say.TAKEOFF), 10)
    assert say.told(answer) == [("ACK", ACCEPTED)]
    assert say.texts(answer) == ["Mission rejected: takeoff is not the first waypoint item"[:50]]


def test_a_reboot_forgets_the_transfer(server):
    say.upload(server, some(3), 10)
    server.handle(say.count(3), 20)
    server.reboot(21)
    assert math.isinf(server.wake)
    assert say.told(server.handle(say.item(0), 21)) == []  # who sent it is not known any more
    assert altitudes(server) == [50.0, 51.0, 52.0]


def test_current(server, pilot):
    say.upload(server, some(3), 10)
    assert say.told(server.handle(say.set_current(2), 11)) == [("CURRENT", 2)]
    assert pilot.current == 2
    assert say.texts(server.handle(say.set_current(3), 11)) == ["WPM: WP CURR CMD: Not in list"]


def test_others_are_not_answered(server):
    assert server.handle(say.count(2, to=(2, 1)), 10) == []
    assert server.handle(say.count(2, to=(0, 1)), 10) == []  # PX4 wants to be named
    assert say.told(server.handle(say.count(2, to=(1, 190)), 10)) == [("REQUEST_INT", 0)]  # its mission planner


def test_an_unknown_type(server):
    assert say.told(server.handle(say.count(2, kind=7), 10)) == [("ACK", INVALID)]
