"""How long missions take: the meanings of their items by hand, and twelve as a real ArduCopter flew them."""

from __future__ import annotations

import json
import math
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from gcs_windplan.errors import InputError
from gcs_windplan.flight.duration import duration_of
from gcs_windplan.geo.frame import GeoPoint, LocalFrame
from gcs_windplan.mission import Command, Frame, Home, MissionItem, MissionItems
from gcs_windplan.vehicle import ARDUCOPTER_PACE, PX4_PACE, Pace, as_flown, landing_seconds, takeoff_seconds

HOME = Home(GeoPoint(36.5, -84.3), 300.0)
FRAME = LocalFrame(HOME.point)
SWIFT = replace(ARDUCOPTER_PACE, airspeed=15.0)  # leans to 45°
RELATIVE, AMSL, TERRAIN = Frame.GLOBAL_RELATIVE_ALT, Frame.GLOBAL, Frame.GLOBAL_TERRAIN_ALT
a_hundredth = 0.01  # [s]
one_centimetre = 0.01  # [m]
one_second = 1.0


def at(
    east: float,
    north: float,
    height: float = 80.0,
    *params: float,
    command: int = Command.NAV_WAYPOINT,
    frame: int = RELATIVE,
) -> MissionItem:
    latitude, longitude = FRAME.to_geographic(np.array([[east, north]]))
    given = (*params, 0.0, 0.0, 0.0, 0.0)
    return MissionItem(frame, command, given[:4], float(latitude[0]), float(longitude[0]), height)


def free(command: int, *params: float) -> MissionItem:
    given = (*params, 0.0, 0.0, 0.0, 0.0)
    return MissionItem(Frame.MISSION, command, given[:4])


def takeoff(height: float = 80.0) -> MissionItem:
    return MissionItem(RELATIVE, Command.NAV_TAKEOFF, altitude=height)


def speed(value: float, kind: float = 1.0) -> MissionItem:
    return free(Command.DO_CHANGE_SPEED, kind, value, -1.0)


def mission(*items: MissionItem, **more: Any) -> MissionItems:
    return MissionItems((takeoff(), *items), HOME, **{"autopilot": "ardupilot", **more})


def leg_seconds(*items: MissionItem, pace: Pace = SWIFT) -> list[float]:
    return [leg.seconds for leg in duration_of(mission(*items), pace=pace).legs]


HOME_AGAIN = free(Command.NAV_RETURN_TO_LAUNCH)
ROW = (at(0, 500), at(0, 1000), at(0, 1500))


# The meanings of items


def test_a_whole_mission_in_parts():
    flown = duration_of(mission(*ROW, HOME_AGAIN))
    assert flown.takeoff == pytest.approx(4.4 + 80 / 2.5 + 2.2)
    assert [leg.seconds for leg in flown.legs] == pytest.approx([54.0, 50.0, 53.4], abs=0.1)
    assert flown.ending == pytest.approx(150 + 70 / 1.5 + 36.7, abs=0.5)
    assert flown.total == pytest.approx(flown.takeoff + flown.en_route + flown.ending)
    assert flown.losses == pytest.approx(flown.en_route - 150, abs=a_hundredth)
    assert flown.remarks == ()


def test_a_leg_says_where_it_leads_and_how_fast():
    first = duration_of(mission(speed(7), at(300, 400, 90, 5.0))).legs[0]
    assert (first.item, first.commanded, first.hold) == (3, 7.0, 5.0)
    assert first.start == pytest.approx((0, 0, 380))
    assert first.end == pytest.approx((300, 400, 390), abs=one_centimetre)
    assert first.peak == pytest.approx(7.0 * math.hypot(500, 10) / 500)


def test_the_legs_are_those_of_the_pace():
    places = [(0, 200, 80), (150, 260, 100), (150, 300, 100), (-80, 320, 60)]
    points = np.array([(0, 0, 380), *((e, n, 300 + z) for e, n, z in places)], dtype=float)
    expected = as_flown(points, [10, 6, 6, 9], [0, 0, 4, 0, 0], pace=SWIFT)
    items = (at(*places[0]), speed(6), at(*places[1], 4.0), at(*places[2]), speed(9), at(*places[3]))
    assert leg_seconds(*items) == pytest.approx(list(expected.seconds), abs=a_hundredth)


@pytest.mark.parametrize(
    ("kind", "value", "seconds"),
    [(0, 5, 200), (1, 5, 200), (1, 0, 100), (1, -1, 100), (7, 5, 100), (1, math.nan, 100), (2, 5, 100)],
)
def test_speed_types(kind, value, seconds):
    middle = leg_seconds(speed(value, kind), at(0, 1000), at(0, 2000), at(0, 3000))[1]
    assert middle == pytest.approx(seconds, abs=a_hundredth)


def test_climb_and_descent_are_commanded_apart():
    up, down = leg_seconds(speed(1.0, 2), speed(0.5, 3), at(0, 0, 180), at(0, 0, 80))
    assert up == pytest.approx(100, abs=4)
    assert down == pytest.approx(200, abs=4)


@pytest.mark.parametrize(
    "stop",
    [
        at(0, 500, 80, 1),
        at(0, 500, 80, 1, command=Command.NAV_LOITER_TIME),
    ],
)
def test_a_hold_is_a_full_stop(stop):
    assert sum(leg_seconds(stop, at(0, 1000))) - sum(leg_seconds(at(0, 500), at(0, 1000))) == pytest.approx(8.42)


def test_a_delay_waits_where_it_is():
    flown = duration_of(mission(at(0, 500), free(Command.NAV_DELAY, 25), at(0, 1000)))
    assert [leg.item for leg in flown.legs] == [2, 3, 4]
    assert flown.legs[1].seconds == 25.0
    assert flown.en_route == pytest.approx(100 + 2 * (6.8 + 0.62) + 25, abs=0.1)


def test_loiter_time_holds_and_is_passed_to():
    first, second = leg_seconds(at(0, 500), at(0, 1000, 80, 20, command=Command.NAV_LOITER_TIME))
    assert first == pytest.approx(50 + 3.4 + 0.62)
    assert second == pytest.approx(50 + 3.4 + 20)


@pytest.mark.parametrize("ending", [HOME_AGAIN, at(0, 500, 0, command=Command.NAV_LAND)])
def test_the_last_waypoint_is_a_stop(ending):
    assert leg_seconds(at(0, 500), ending) == pytest.approx([50 + 6.8 + 0.62])


def test_a_landing_flies_there_level_and_goes_down():
    flown = duration_of(mission(at(0, 500), at(0, 1000, 20, command=Command.NAV_LAND)))
    assert flown.legs[1].end == pytest.approx((0, 1000, 380), abs=one_centimetre)
    assert flown.ending == pytest.approx(landing_seconds(60))


def test_a_landing_without_place_or_height_is_here_and_at_homes_height():
    flown = duration_of(mission(at(0, 500), MissionItem(RELATIVE, Command.NAV_LAND)))
    assert len(flown.legs) == 1
    assert flown.ending == pytest.approx(landing_seconds(80))


def test_landing_and_taking_off_again():
    land = MissionItem(RELATIVE, Command.NAV_LAND)
    flown = duration_of(mission(at(0, 500), land, takeoff(50), at(0, 0, 50), HOME_AGAIN))
    assert flown.takeoff == pytest.approx(takeoff_seconds(80) + takeoff_seconds(50))
    assert flown.ending > landing_seconds(80) + landing_seconds(50)
    assert [leg.end[2] for leg in flown.legs] == pytest.approx([380, 350])


def test_nothing_is_flown_after_the_return():
    flown = duration_of(mission(at(0, 500), HOME_AGAIN, at(0, 9000)))
    assert flown.total == duration_of(mission(at(0, 500), HOME_AGAIN)).total


def test_a_jump_is_made_as_often_as_it_says():
    flown = duration_of(mission(at(0, 50), at(0, 100), free(Command.DO_JUMP, 2, 2), at(0, 150)))
    assert [leg.item for leg in flown.legs] == [2, 3, 2, 3, 2, 3, 5]


def test_jumps_to_a_tag_forever_and_to_nowhere():
    tag = free(Command.JUMP_TAG, 42)
    flown = duration_of(mission(tag, at(0, 50), free(Command.DO_JUMP_TAG, 42, 1), free(Command.DO_JUMP, 99, 1)))
    assert [leg.item for leg in flown.legs] == [3, 3]
    assert flown.remarks == ("item 5 jumps to nowhere and is passed over",)
    flown = duration_of(mission(at(0, 50), free(Command.DO_JUMP, 2, -1), at(0, 99)))
    assert [leg.item for leg in flown.legs] == [2]
    assert flown.remarks == ("item 3 jumps for ever; the time counts up to its first jump",)


@pytest.mark.parametrize("jump", [free(Command.DO_JUMP, math.nan, 1), free(Command.DO_JUMP, 2, math.nan)])
def test_a_jump_without_numbers_is_none(jump):
    assert len(duration_of(mission(at(0, 50), jump, at(0, 99))).legs) == 2


def test_a_speed_commanded_on_the_way_stays_when_it_jumps_back():
    flown = duration_of(mission(at(0, 500), speed(5), at(0, 1000), free(Command.DO_JUMP, 2, 1)))
    assert [leg.commanded for leg in flown.legs] == [10, 5, 5, 5]


def test_what_is_not_modelled_is_named():
    items = (
        at(0, 100),
        free(Command.CONDITION_DELAY, 10),
        at(0, 200, 80, 2, command=Command.NAV_LOITER_TURNS),
        free(Command.DO_SET_CAM_TRIGG_DIST, 20),
        MissionItem(Frame.MISSION, 31337),
        free(Command.NAV_DELAY, -1, 12, 0, 0),
        at(0, 300, frame=TERRAIN),
        at(0, 400, command=Command.NAV_LOITER_UNLIM),
        at(0, 500),
    )
    flown = duration_of(mission(*items))
    assert flown.remarks == (
        "item 3, CONDITION_DELAY, is passed over",
        "item 6, command 31337, is passed over",
        "item 7, NAV_DELAY until a time of day, is counted as a stop",
        "item 8 counts from the terrain; its height is taken from home",
        "item 9, NAV_LOITER_UNLIM, holds for ever; the time counts up to it",
    )
    assert [leg.item for leg in flown.legs] == [2, 4, 8, 9]


def test_without_a_takeoff_one_is_counted():
    flown = duration_of(MissionItems((at(0, 500, 60), at(0, 900, 60)), HOME, "px4"))
    assert flown.takeoff == pytest.approx(takeoff_seconds(60, PX4_PACE))
    assert flown.remarks == ("there is no take-off before item 1; one straight up is counted",)
    assert len(flown.legs) == 2


def test_px4_flies_to_the_place_of_its_takeoff():
    lift = at(30, 40, 20, command=Command.NAV_TAKEOFF)
    ends = {
        autopilot: [leg.end for leg in duration_of(MissionItems((lift, at(0, 100, 20)), HOME, autopilot)).legs]
        for autopilot in ("px4", "ardupilot")
    }
    assert ends["px4"][0] == pytest.approx((30, 40, 320), abs=one_centimetre)
    assert len(ends["ardupilot"]) == 1


def test_each_autopilot_has_its_own_pace():
    items = (takeoff(), at(0, 1000), at(0, 2000), at(0, 3000))
    px4, ardupilot = (duration_of(MissionItems(items, HOME, name)).legs[1].seconds for name in ("px4", "ardupilot"))
    assert (px4, ardupilot) == (pytest.approx(200, abs=a_hundredth), pytest.approx(100, abs=a_hundredth))


def test_measured_zero_altitude_and_zero_place_mean_here():
    here = MissionItem(RELATIVE, Command.NAV_WAYPOINT, altitude=90.0)
    ends = [leg.end for leg in duration_of(mission(at(0, 100, 0), here, at(0, 200, 400, frame=AMSL))).legs]
    assert [end[2] for end in ends] == pytest.approx([380, 390, 400])
    assert [end[1] for end in ends] == pytest.approx([100, 100, 200], abs=one_centimetre)


def test_going_up_in_a_second_takeoff_and_loitering_to_a_height():
    flown = duration_of(mission(at(0, 100), takeoff(100), at(0, 200, 130, command=Command.NAV_LOITER_TO_ALT)))
    assert [leg.end[2] for leg in flown.legs] == pytest.approx([380, 400, 400, 430])


def test_the_wind_is_asked_for_along_each_leg_and_on_the_way_home():
    def head_wind(starts, ends):
        return np.where(ends[:, 1:2] > 600, [[0.0, -5.0, 0.0]], [[0.0, 0.0, 0.0]])

    items = (*ROW, at(0, 2000), HOME_AGAIN)
    still, windy = duration_of(mission(*items)), duration_of(mission(*items), head_wind)
    assert [leg.peak for leg in windy.legs] == pytest.approx([10, 5.16, 5.16, 5.16])
    assert windy.ending == still.ending
    south = duration_of(mission(*items), lambda starts, ends: np.tile([0.0, 5.0, 0.0], (len(starts), 1)))
    assert south.en_route == pytest.approx(still.en_route)
    assert south.ending > still.ending + 150


def test_a_wind_that_is_too_strong_takes_for_ever():
    flown = duration_of(mission(*ROW), lambda starts, ends: np.tile([0.0, -11.0, 0.0], (len(starts), 1)))
    assert flown.total == math.inf


@pytest.mark.parametrize(
    ("wrong", "message"),
    [
        (MissionItems((takeoff(),)), "names no home"),
        (mission(*ROW, vehicle_type="fixed-wing"), "a fixed-wing"),
        (mission(at(0, 50), free(Command.DO_JUMP, 2, 30000)), "more than 20000 items"),
    ],
)
def test_what_cannot_be_told_is_refused(wrong, message):
    with pytest.raises(InputError, match=message):
        duration_of(wrong)


def test_jumps_that_go_round_end():
    round_trip = (free(Command.DO_JUMP, 3, 9999), free(Command.DO_JUMP, 2, 9999))
    assert duration_of(mission(*round_trip)).legs == ()


@pytest.mark.parametrize("items", [(), (takeoff(),), (HOME_AGAIN,), (free(Command.NAV_DELAY, 3),)])
def test_a_mission_of_nearly_nothing(items):
    assert duration_of(MissionItems(items, HOME)).total >= 0


# What must hold for any mission

places = st.lists(
    st.tuples(st.floats(-500, 500), st.floats(-500, 500), st.floats(20, 120)), min_size=1, max_size=5
)  # fmt: skip


@given(places, st.floats(1, 15), st.floats(0.3, 1))
def test_a_slower_commanded_speed_never_makes_a_mission_shorter(route, commanded, share):
    slow, fast = (
        duration_of(mission(speed(value), *(at(*place) for place in route), HOME_AGAIN), pace=SWIFT).total
        for value in (share * commanded, commanded)
    )
    assert slow >= fast - a_hundredth


@given(places, st.integers(0, 60))
def test_a_hold_costs_at_least_its_seconds(route, hold):
    still, held = (
        duration_of(mission(*(at(*place) for place in route[:-1]), at(*route[-1], seconds), at(0, 0))).total
        for seconds in (0.0, hold)
    )
    assert held >= still + hold - a_hundredth


@pytest.mark.parametrize(
    ("turns", "radius", "speed_told", "flown"),
    [
        (2, 10, 10, math.radians(20) * 10),  # CIRCLE_RATE
        (2, 50, 10, math.sqrt(0.5 * 2.5 * 50)),  # half of WPNAV_ACCEL
        (3, 200, 6, 6),  # as commanded
        (1, 0, 10, math.radians(20) * 10),  # CIRCLE_RADIUS
        (2.7, -50, 10, math.sqrt(0.5 * 2.5 * 50) * 2.7 / 2),  # whole turns are kept, and the way round is the sign
    ],
)
def test_arducopter_flies_its_circles(turns, radius, speed_told, flown):
    """AC_Circle.cpp, calc_velocities: at most CIRCLE_RATE, and half of the acceleration towards the middle."""
    circles = at(0, 500, 80, turns, 0, radius, command=Command.NAV_LOITER_TURNS)
    held, still = (
        duration_of(mission(speed(speed_told), item, at(0, 900))).en_route
        for item in (circles, at(0, 500, 80, 0, command=Command.NAV_LOITER_TURNS))
    )
    way = turns * 2 * math.pi * abs(radius or 10)
    assert held - still == pytest.approx(way / flown, abs=a_hundredth)


def test_holds_count_as_the_firmware_keeps_them():
    """ArduPilot keeps whole seconds from 0 to 65535, PX4 floats: -5 s is no wait."""

    def waits(autopilot, seconds, command):
        hold = at(0, 500, 80, seconds, command=command)
        return [leg.hold for leg in duration_of(MissionItems((takeoff(), hold), HOME, autopilot)).legs]

    loiter, waypoint = Command.NAV_LOITER_TIME, Command.NAV_WAYPOINT
    assert waits("ardupilot", -5, loiter) == [65531]
    assert waits("ardupilot", 1e12, waypoint) == [4096]
    assert waits("ardupilot", 2.5, waypoint) == [2]
    assert waits("px4", -5, loiter) == [0]
    assert waits("px4", 2.5, waypoint) == [2.5]


# As measured


def _read(flight: Any) -> tuple[MissionItems, Pace]:
    """A measured mission, and the pace by its parameters."""
    given = flight["params"]
    pace = Pace(
        speed=given["WPNAV_SPEED"] / 100,
        climb=given["WPNAV_SPEED_UP"] / 100,
        descent=given["WPNAV_SPEED_DN"] / 100,
        acceleration=given["WPNAV_ACCEL"] / 100,
        vertical_acceleration=given["WPNAV_ACCEL_Z"] / 100,
        jerk=given["WPNAV_JERK"],
        radius=given["WPNAV_RADIUS"] / 100,
        airspeed=10.16 if given["ANGLE_MAX"] == 3000 else 15.0,
        landing=given["LAND_SPEED"] / 100,
        landing_height=given["LAND_ALT_LOW"] / 100,
        return_height=given["RTL_ALT"] / 100,
    )
    items = tuple(
        MissionItem(i["frame"], i["command"], (i["p1"], i["p2"], i["p3"], i["p4"]), i["lat"], i["lon"], i["alt"])
        for i in flight["items"][1:]
    )
    home = flight["home"]
    return MissionItems(items, Home(GeoPoint(home["lat"], home["lon"]), home["alt"]), "ardupilot"), pace


def predicted_duration(flight: dict):
    """What a measured flight is predicted to take, with its parameters in its wind."""
    blows, towards = flight["wind"]["speed"], math.radians(flight["wind"]["from_deg"] + 180)
    wind = blows * np.array([math.sin(towards), math.cos(towards), 0.0])
    items, pace = _read(flight)
    return duration_of(items, lambda starts, ends: np.tile(wind, (len(starts), 1)), pace)


def test_twelve_missions_as_a_real_arducopter_flew_them(shared_data):
    """Totals of the legs within 1.1 %, each leg within 1 s, take-off and return within 0.6 s."""
    for flight in json.loads((shared_data / "flights" / "arducopter_4.7.json").read_text()):
        _, pace = _read(flight)
        flown = predicted_duration(flight)
        assert flown.en_route == pytest.approx(flight["total"], rel=0.011), flight["name"]
        assert [leg.item for leg in flown.legs] == [leg["to_seq"] for leg in flight["legs"]]
        measured = [leg["duration"] for leg in flight["legs"]]
        assert [leg.seconds for leg in flown.legs] == pytest.approx(measured, abs=one_second), flight["name"]
        assert flown.takeoff - pace.spool_up == pytest.approx(flight["takeoff"]["liftoff_to_reached"], abs=0.1)
        assert flown.ending == pytest.approx(flight["rtl"]["to_disarm"], abs=0.6), flight["name"]
        assert flown.remarks == ()
