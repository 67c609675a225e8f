"""What missions' items mean: moves, their speeds and holds, with the ground and without it."""

from __future__ import annotations

import math

import numpy as np
import pytest

from gcs_windplan.errors import InputError
from gcs_windplan.mission import Command, Frame, Home, MissionItem, MissionItems
from gcs_windplan.mission.path import Told, course_of
from tests.flight.test_duration import FRAME, HOME, HOME_AGAIN, at, free, mission, speed, takeoff

one_centimetre = 0.01


def slope(places: np.ndarray) -> np.ndarray:
    """Ground that rises northwards by a tenth from home's height."""
    return HOME.altitude + 0.1 * places[:, 1]


def test_a_mission_in_moves():
    land = at(0, 900, 20, command=Command.NAV_LAND)
    course = course_of(mission(speed(7), at(0, 500, 80, 3.0), at(0, 800), land))
    assert [(move.kind, move.item) for move in course.moves] == [
        ("take-off", 1), ("leg", 3), ("leg", 4), ("leg", 5), ("landing", 5),
    ]  # fmt: skip
    assert course.moves[1].told == Told(ground=7)
    assert course.moves[1].hold == 3.0
    assert [move.rests for move in course.moves[1:4]] == [True, True, True]
    assert course.moves[-1].end[2] == pytest.approx(HOME.altitude + 20)
    assert course.landings[0][0] == 5
    for before, after in zip(course.moves, course.moves[1:], strict=False):
        assert after.start == before.end


def test_a_landing_ends_on_the_ground_where_it_is_known():
    land = at(0, 500, 20, command=Command.NAV_LAND)
    assert course_of(mission(at(0, 300), land), ground=slope).moves[-1].end[2] == pytest.approx(350, abs=one_centimetre)


def test_heights_above_the_ground():
    terrain = at(0, 600, 50, frame=Frame.GLOBAL_TERRAIN_ALT)
    known, unknown = (course_of(mission(terrain), ground=ground) for ground in (slope, None))
    assert known.moves[1].end[2] == pytest.approx(HOME.altitude + 60 + 50, abs=one_centimetre)
    assert known.moves[1].follows
    assert known.remarks == ()
    assert unknown.moves[1].end[2] == pytest.approx(HOME.altitude + 50)
    assert not unknown.moves[1].follows
    nowhere = course_of(mission(terrain), ground=lambda places: np.full(len(places), math.nan))
    assert "counts from the terrain" in nowhere.remarks[0]


def test_a_jump_for_ever_ahead_is_made_and_one_back_ends_it():
    ahead = course_of(mission(free(Command.DO_JUMP, 4, -1), at(0, 99), at(0, 200)))
    assert [move.item for move in ahead.moves] == [1, 4]
    back = course_of(mission(at(0, 99), free(Command.DO_JUMP, 2, -1), at(0, 200)))
    assert [move.item for move in back.moves] == [1, 2]
    assert "jumps for ever" in back.remarks[0]


def test_jumps_ahead_and_back_for_ever_end():
    items = (free(Command.DO_JUMP, 3, -1), free(Command.DO_JUMP, 2, -1), at(0, 50))
    assert [move.item for move in course_of(mission(*items)).moves] == [1]


def test_a_fixed_wing_circles_glides_and_keeps_its_airspeed():
    turns = at(0, 500, 80, 2, 0, -70, command=Command.NAV_LOITER_TURNS)
    land = at(0, 100, 0, command=Command.NAV_LAND)
    course = course_of(mission(speed(18, 0), speed(9, 1), turns, land, vehicle_type="fixed-wing"))
    assert course.moves[1].circling == pytest.approx(2 * 2 * math.pi * 70)
    assert course.moves[1].radius == 70
    assert course.moves[1].told == Told(ground=9, air=18)
    assert course.moves[2].end[2] == pytest.approx(HOME.altitude)
    assert course.moves[3].start == course.moves[3].end


def test_another_frame_moves_the_places_and_nothing_else():
    far = MissionItem(Frame.GLOBAL, Command.NAV_WAYPOINT, latitude_deg=36.51, longitude_deg=-84.29, altitude=400)
    there = course_of(MissionItems((takeoff(), far, HOME_AGAIN), Home(HOME.point, 300.0), "ardupilot"), FRAME)
    here = course_of(MissionItems((takeoff(), far, HOME_AGAIN), Home(HOME.point, 300.0), "ardupilot"))
    assert there.moves == here.moves
    assert there.moves[-1].kind == "return"


def test_a_mission_without_home_has_no_course():
    with pytest.raises(InputError, match="names no home"):
        course_of(MissionItems((takeoff(),)))


def test_what_never_ends_and_what_ends_in_the_air():
    there, land = at(0, 99), at(0, 99, command=Command.NAV_LAND)
    back, unlimited = free(Command.DO_JUMP, 2, -1), at(0, 200, command=Command.NAV_LOITER_UNLIM)
    for items, endless, aloft in (
        ((there, back), 3, False),
        ((there, unlimited, HOME_AGAIN), 3, False),
        ((there, HOME_AGAIN), None, False),
        ((there, land), None, False),
        ((there,), None, True),
        ((there, land, takeoff(), there), None, True),
        ((there, land, back), None, False),
        ((there, land, free(Command.DO_JUMP, 1, -1)), 4, False),
    ):
        course = course_of(mission(*items))
        assert (course.endless, course.aloft) == (endless, aloft), items


@pytest.mark.parametrize("end", [at(0, 99, command=Command.NAV_LAND), HOME_AGAIN])
def test_nothing_but_a_takeoff_goes_on_behind_a_landing(end):
    behind = course_of(mission(end, at(0, 200), at(0, 300)))
    assert {move.item for move in behind.moves} <= {1, 2}
    assert "item 3, NAV_WAYPOINT, stands behind a landing" in behind.remarks[-1]
    again = course_of(mission(end, speed(5), free(Command.NAV_DELAY, 9), takeoff(), at(0, 300)))
    assert [move.item for move in again.moves][-3:] == [4, 5, 6]
    for other in ({"autopilot": "px4"}, {"vehicle_type": "fixed-wing"}):
        over = course_of(mission(end, takeoff(), at(0, 300), **other))
        assert {move.item for move in over.moves} <= {1, 2}, other


def test_jumps_through_too_many_items_are_named():
    with pytest.raises(InputError, match="item 4 jumps 30000 times"):
        course_of(mission(at(0, 99), at(0, 200), free(Command.DO_JUMP, 2, 30_000)))


def test_a_planes_loiter_in_time_keeps_the_sign_of_its_radius_only():
    loiter = at(0, 500, 80, 30, 0, 200, command=Command.NAV_LOITER_TIME)
    assert course_of(mission(loiter, vehicle_type="fixed-wing")).moves[-1].radius == 60
    hold = at(0, 500, 80, 30)
    assert course_of(mission(hold, vehicle_type="fixed-wing")).moves[-1].hold == 0, "ArduPlane keeps none"
