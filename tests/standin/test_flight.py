"""The stand-in's kinematics against times worked out by hand, and against a real ArduCopter's."""

from __future__ import annotations

import json
import math
from dataclasses import dataclass, replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from gcs_windplan.geo.frame import GeoPoint
from gcs_windplan.mission import Home
from gcs_windplan.standin.flight import SimulatedFlight
from gcs_windplan.standin.items import StoredItem
from gcs_windplan.standin.world import world_at
from gcs_windplan.terrain import Hill, hills
from gcs_windplan.wind.field import Steady

from .scenes import COPTER, FRAME, HOME, SWIFT, Scene, at, fly, free, home_again, scene, speed, takeoff, wind_from
from .speaking import DELAY, JUMP, LAND, LOITER_TIME, WAYPOINT

a_tenth_of_a_second = 0.1  # [s]
one_decimetre = 0.1  # [m]
LOITER_UNLIM, LOITER_TURNS, LOITER_TO_ALT, CONDITION_DELAY, CONDITION_DISTANCE = 17, 18, 31, 112, 114
JUMP_TAG, DO_JUMP_TAG, DO_SET_HOME, ALTITUDE_WAIT = 600, 601, 179, 83
#: Four places in a row to the north: the second and third leg have no corner at either end.
ROW = [takeoff(), at(0, 500), at(0, 2000), at(0, 3500), at(0, 4000)]
MIDDLE = 3  # the number of the item at the end of the second leg


@pytest.mark.parametrize(
    ("wind", "commanded", "ground_speed"),
    [
        ((0, 0), 10, 10.0),
        ((5, 180), 10, 10.0),  # a tail wind alone makes no leg faster
        ((5, 0), 10, 10.0),
        ((5, 270), 10, 10.0),
        ((5, 180), 14, 14.0),  # measured: 13.98
        ((8, 0), 10, 7.0),  # 15 m/s through the air
        ((9, 90), 15, 12.0),  # sqrt(15² - 9²)
        ((9, 45), 15, math.sqrt(15**2 - 40.5) - math.sqrt(40.5)),
    ],
)
def test_a_straight_leg_takes_its_length_by_the_commanded_ground_speed(wind, commanded, ground_speed):
    items = [takeoff(), speed(commanded), *ROW[1:]]
    flown = fly(items, wind=wind_from(*wind))
    assert flown.seconds[MIDDLE + 1] == pytest.approx(1500 / ground_speed, abs=a_tenth_of_a_second)


def test_measured_5_metres_of_head_wind_at_30_degrees_of_lean():
    flown = fly(ROW, wind=wind_from(5, 0), profile=COPTER.motion)
    assert flown.seconds[MIDDLE] == pytest.approx(1500 / 5.16, abs=a_tenth_of_a_second)


@dataclass(frozen=True)
class Shear(Steady):
    """A head wind that grows to the north, 2 m/s a kilometre."""

    name: str = "shear"
    resolution: float = 100.0

    def at(self, points, seconds=0.0):
        return np.column_stack([np.zeros(len(points)), -0.002 * points[:, 1], np.zeros(len(points))])


def test_a_leg_in_a_wind_that_changes_along_it():
    flown = fly([takeoff(), speed(15), *ROW[1:]], wind=Shear())
    # 15 - y / 500 over ground: the integral of dy / (15 - y / 500) from 500 to 2000
    assert flown.seconds[MIDDLE + 1] == pytest.approx(500 * math.log(14 / 11), abs=a_tenth_of_a_second)


@pytest.mark.parametrize(("climb", "level_speed"), [(50, 5.0), (-50, 3.0)])  # measured: 4.98 and 2.98
def test_climb_and_descent_rates_slow_a_steep_leg(climb, level_speed):
    legs = [at(0, 1000 * n, 2000 + 500 * n * math.copysign(1, climb)) for n in range(1, 4)]
    flown = fly([takeoff(2000), *legs])
    assert flown.seconds[3] == pytest.approx(1000 / level_speed, abs=a_tenth_of_a_second)


def test_the_square_of_300_m_as_measured():
    """32.7 s corner to corner, 35.2 s from rest at 10 m/s."""
    flown = fly([takeoff(60), at(0, 300, 60), at(300, 300, 60), at(300, 0, 60), at(0, 0, 60), home_again()])
    assert flown.seconds[2] == pytest.approx(35.2, abs=0.3)
    assert flown.seconds[3] == pytest.approx(32.7, abs=0.2)
    assert flown.seconds[4] == pytest.approx(32.7, abs=0.2)


def test_take_off_and_return_as_measured():
    """Take-off to 60 m 30.6 s from arming, altitude/2.5 + 2.2 s from lift-off; return from 60 m overhead 66 s."""
    flown = fly([takeoff(60), at(0, 0.5, 60), home_again()])
    assert flown.seconds[1] == pytest.approx(30.6, abs=0.2)
    assert flown.begins[1][1] - flown.when("Lifted off") == pytest.approx(60 / 2.5 + 2.2, abs=0.05)
    assert flown.seconds[3] == pytest.approx(66, abs=2.0)
    assert not flown.flight.state.armed
    assert flown.flight.state.body.place == pytest.approx((0, 0, 300), abs=one_decimetre)


def test_return_from_far_as_fitted():
    """d/10 + (z - 10)/1.5 + 36.7 s to disarmed."""
    flown = fly([takeoff(80), at(0, 1500), home_again()])
    assert flown.seconds[3] == pytest.approx(150 + 70 / 1.5 + 36.7, abs=2.0)


def test_a_low_return_climbs_first_and_knows_no_commanded_speed():
    flown = scene([takeoff(5), speed(4), at(0, 1000, 5), home_again()]).start()
    while flown.flight.current < 4:
        flown.advance(0.1)
    begin, highest = flown.time, 0.0
    while flown.flight.state.armed:
        flown.advance(0.1)
        highest = max(highest, flown.flight.state.body.altitude)
    assert highest == pytest.approx(315.0, abs=one_decimetre)
    assert flown.time - begin < 100 + 60  # and not the 250 s of 4 m/s


def test_it_passes_over_every_waypoint():
    places = [(0, 200), (150, 260), (150, 300), (-80, 320), (-80, 100), (-75, 95), (300, 500)]
    flown = scene([takeoff(), *(at(e, n, 80 + i) for i, (e, n) in enumerate(places))]).start()
    nearest = dict.fromkeys(range(len(places)), math.inf)
    while not flown.flight.run.complete:
        flown.advance(0.01)
        body = flown.flight.state.body
        for i, (east, north) in enumerate(places):
            gap = math.dist(body.place, (east, north, 380 + i))
            nearest[i] = min(nearest[i], gap)
    assert max(nearest.values()) < one_decimetre
    assert flown.order == list(range(1, 9))


def test_the_time_does_not_depend_on_how_often_the_clock_is_asked():
    items = [takeoff(), at(0, 200), at(150, 260), at(150, 300), at(-80, 320, 120, params=(3, 0, 0, 0)), at(0, 0)]
    ends = []
    for step in (0.01, 0.37, 11.0, 1000.0):
        flown = scene(items, wind=wind_from(6, 200)).start()
        while not flown.flight.run.complete:
            flown.advance(step)
        ends.append(flown.flight.state.body.clock - flown.time)
        # the clock goes on to the end of the last step; what counts is when the last item was reached
    finer = fly(items, wind=wind_from(6, 200), step=0.001).time
    for step in (0.01, 0.1):
        assert fly(items, wind=wind_from(6, 200), step=step).time == pytest.approx(finer, abs=step + 0.01)
    assert ends == pytest.approx([0.0] * 4, abs=1e-6)


def test_it_stops_for_holds_delays_and_loitering():
    items = [
        takeoff(),
        at(0, 200, params=(7, 0, 0, 0)),
        at(0, 400, command=LOITER_TIME, params=(20, 0, 0, 0)),
        free(DELAY, 5),
        at(0, 600),
    ]
    flown = scene(items).start()
    still = 0.0
    while flown.flight.current < 5:
        flown.advance(0.02)
        if flown.flight.current > 1 and flown.flight.state.body.speed == 0:
            still += 0.02
    assert still == pytest.approx(7 + 20 + 5 + 2 * 0.62, abs=0.1)  # and what each start from rest takes to settle
    assert flown.seconds[4] == pytest.approx(5.0, abs=0.05)


def test_a_delay_until_a_time_of_day():
    from datetime import UTC, datetime

    flown = scene([takeoff(), free(DELAY, -1, 12, 2, 0), at(0, 100)])
    world = flown.flight.state.world
    flown.flight.settle(replace(world, departure=datetime(2026, 5, 1, 12, 0, tzinfo=UTC)))
    flown.start().until_over()
    assert flown.begins[2][1] == pytest.approx(120.0, abs=a_tenth_of_a_second + 1.0)


@pytest.mark.parametrize("radius", [20.0, -20.0])
def test_turns_around_a_place(radius):
    flown = scene([takeoff(), at(0, 200, command=LOITER_TURNS, params=(2, 0, radius, 0)), at(0, 400)]).start()
    angles = []
    while flown.flight.current < 3:
        flown.advance(0.1)
        body = flown.flight.state.body
        if flown.flight.current == 2 and math.hypot(body.east, body.north - 200) < 20.01:
            angles.append(math.atan2(body.east, body.north - 200))
    turned = np.unwrap(angles)
    assert turned[-1] - turned[0] == pytest.approx(math.copysign(4 * math.pi, radius), abs=0.2)
    assert flown.seconds[2] == pytest.approx(180 / 10 + 6.8 + 0.6 + 4 * math.pi * 20 / (20 * math.radians(20)), abs=1.0)


def test_loiter_to_altitude():
    flown = fly([takeoff(), at(0, 200, 130, command=LOITER_TO_ALT), at(0, 400, 130)])
    assert flown.seconds[2] == pytest.approx(200 / 10 + 6.8 + 0.6 + 50 / 2.5 + 3.8 + 0.6, abs=0.5)


def test_a_jump_is_made_as_often_as_it_says():
    flown = fly([takeoff(), at(0, 50), at(0, 100), free(JUMP, 2, 2), at(0, 150)])
    assert flown.order == [1, 2, 3, 2, 3, 2, 3, 5]


def test_a_jump_for_ever_and_one_to_a_tag():
    flown = scene([takeoff(), free(JUMP_TAG, 42), at(0, 50), at(0, 100), free(DO_JUMP_TAG, 42, -1)]).start()
    while flown.time < 200:
        flown.advance(0.5)
    assert len(flown.order) > 10
    assert flown.order[:6] == [1, 3, 4, 3, 4, 3]


@pytest.mark.parametrize(
    "round_trip",
    [
        [takeoff(), free(ALTITUDE_WAIT), free(JUMP, 2, -1)],
        [takeoff(), free(JUMP, 3, -1), free(JUMP, 2, -1)],
        [takeoff(), at(0, 0, 80), free(JUMP, 2, -1)],
    ],
    ids=["items that are not flown", "jumps alone", "the same place"],
)
def test_a_mission_that_goes_round_does_not_hold_up_the_clock(round_trip):
    flown = scene(round_trip).start()
    flown.advance(500.0)
    assert flown.flight.state.body.clock == pytest.approx(500.0)
    assert flown.flight.state.body.altitude == pytest.approx(380.0)


def test_a_speed_is_in_force_from_the_next_leg_on():
    flown = fly([takeoff(), *ROW[1:3], speed(5), at(0, 3500), at(0, 5000), at(0, 6000)])
    assert flown.seconds[3] == pytest.approx(150, abs=a_tenth_of_a_second)  # no braking before the waypoint
    assert flown.seconds[5] == pytest.approx(300 - 5 * 5 / (2 * 5 / 4.78) * 0.2, abs=3.0)
    assert flown.seconds[6] == pytest.approx(300, abs=a_tenth_of_a_second)


@pytest.mark.parametrize("change", [(1, 0), (1, -1), (7, 5)])
def test_a_speed_that_changes_nothing(change):
    kind, value = change
    flown = fly([takeoff(), speed(value, kind), *ROW[1:]])
    assert flown.seconds[MIDDLE + 1] == pytest.approx(150, abs=a_tenth_of_a_second)


def test_climb_and_descent_can_be_commanded():
    flown = fly([takeoff(), speed(1.0, 2), speed(0.5, 3), at(0, 1, 180), at(0, 2, 80)])
    assert flown.seconds[4] == pytest.approx(100, abs=4)
    assert flown.seconds[5] == pytest.approx(200, abs=4)


def test_measured_a_speed_is_lost_on_leaving_the_mission():
    flown = scene([takeoff(), speed(4), *ROW[1:]]).start()
    flown.advance(120.0)
    assert (flown.flight.current, flown.flight.state.body.speed) == (3, pytest.approx(4.0))
    flown.flight.stay()
    flown.advance(20.0)
    assert flown.flight.state.body.speed == 0
    assert flown.flight.fly_mission() is None
    flown.advance(15.0)
    assert flown.flight.current == 3
    assert flown.flight.state.body.speed == pytest.approx(10.0)


@pytest.mark.parametrize("distance", [300.0, 100.0])
def test_conditions_put_off_what_stands_behind_them(distance):
    items = [takeoff(), at(0, 500), free(CONDITION_DISTANCE, distance), speed(5), at(0, 2000), at(0, 3000)]
    flown = scene(items).start()
    while flown.flight.current < 5:
        flown.advance(0.1)
    while flown.flight.run.waits_for_condition:
        assert flown.flight.state.body.speed == pytest.approx(10.0, abs=0.5)
        flown.advance(0.1)
    assert flown.flight.state.body.north == pytest.approx(2000 - distance, abs=7.0)
    flown.advance(8.0)
    assert flown.flight.state.body.speed == pytest.approx(5.0)


def test_a_condition_of_time():
    flown = scene([takeoff(), at(0, 500), free(CONDITION_DELAY, 30), speed(5), at(0, 2000), at(0, 3000)]).start()
    while flown.flight.current < 5:
        flown.advance(0.1)
    flown.advance(29.0)
    assert flown.flight.state.body.speed == pytest.approx(10.0)
    flown.advance(10.0)
    assert flown.flight.state.body.speed == pytest.approx(5.0)


def test_measured_arducopter_names_the_item_that_is_done_after_a_waypoint():
    items = [takeoff(), at(0, 50), speed(5), at(0, 100)]
    assert fly(items).reached == [1, 3, 4]
    assert fly(items, autopilot="px4").reached == [0, 1, 3]


def test_measured_zero_altitude_and_zero_place_mean_here():
    here = StoredItem(3, WAYPOINT, (1.0, 0.0, 0.0, 0.0), z=90.0)
    flown = fly([takeoff(60), at(0, 100, 0, params=(1, 0, 0, 0)), here, at(0, 200, 90)])
    assert flown.seconds[2] == pytest.approx(1 + 10 + 6.8 + 0.6, abs=0.1)  # level
    assert flown.seconds[3] == pytest.approx(1 + 30 / 2.5 + 3.8 + 0.6, abs=0.1)  # straight up


def test_a_landing_ends_the_mission_on_the_ground():
    flown = fly([takeoff(), at(0, 200), at(100, 300, 0, command=LAND)])
    body = flown.flight.state.body
    assert body.place == pytest.approx((100, 300, 300), abs=one_decimetre)
    assert (flown.flight.state.armed, flown.flight.state.landed) == (False, True)
    assert flown.reached == [1, 2, 3]
    assert flown.flight.current == 0


def test_a_landing_between_goes_on_with_the_next_takeoff():
    flown = fly([takeoff(), at(0, 200), at(0, 200, 0, command=LAND), takeoff(50), at(0, 0, 50), home_again()])
    assert flown.order == [1, 2, 3, 4, 5, 6]
    assert [words for words, _ in flown.words].count("Lifted off") == 2


def test_it_lands_on_the_terrain_and_flies_above_it():
    terrain = hills((3000, 3000), 20.0, [Hill(0, 500, 90.0, 150.0)], altitude=300.0)
    top = float(terrain.heights_at(np.array([[0.0, 500.0]]))[0])
    assert top == pytest.approx(390, abs=1.0)
    flown = scene(
        [takeoff(), at(0, 250, 60, frame=10), at(0, 500, 60, frame=10), at(0, 500, 0, command=LAND)], terrain=terrain
    )
    flown.start()
    while flown.flight.current < 4:
        flown.advance(0.05)
    assert flown.flight.state.body.altitude == pytest.approx(top + 60, abs=one_decimetre)
    flown.until_over()
    assert flown.flight.state.body.altitude == pytest.approx(top, abs=one_decimetre)


def test_why_a_mission_is_not_flown():
    assert scene([]).flight.fly_mission() == "there is no mission"
    assert scene([at(0, 100)]).flight.fly_mission() == "Missing Takeoff Cmd"
    assert scene([takeoff(), at(0, 100, frame=10)]).flight.fly_mission() == "Missing terrain data"
    far = StoredItem(3, WAYPOINT, x=0, y=1, z=50.0)
    assert "more than 500 km away" in scene([takeoff(), far]).flight.fly_mission()
    jump = [at(0, 0, command=22), free(JUMP, 9, 1)]
    assert "there is none" in scene(jump, autopilot="px4").flight.fly_mission()


def test_a_wind_stronger_than_the_airspeed_holds_it_where_it_is():
    flown = scene(ROW, wind=wind_from(16, 0)).start()
    flown.advance(200.0)
    assert flown.flight.state.body.place == pytest.approx((0, 0, 380), abs=one_decimetre)
    assert flown.flight.current == 2


@settings(max_examples=40)
@given(
    st.lists(st.tuples(st.floats(-400, 400), st.floats(-400, 400), st.floats(20, 120)), min_size=1, max_size=6),
    st.floats(0, 9),
    st.floats(0, 360),
    st.floats(2, 18),
)
def test_it_never_flies_faster_than_told_nor_than_the_air_lets_it(places, blows, from_deg, commanded):
    wind = wind_from(blows, from_deg)
    flown = scene([takeoff(), speed(commanded), *(at(*place) for place in places)], wind=wind).start()
    state = flown.flight.state
    while not flown.flight.run.complete and flown.time < 3000:
        flown.advance(0.5)
        east, north, up = state.body.velocity
        level = math.hypot(east, north)
        assert level <= commanded + 1e-6
        assert -state.profile.descent - 1e-6 <= up <= state.profile.climb + 1e-6
        if level > 0.1:
            assert math.hypot(east - wind.east, north - wind.north) <= state.profile.airspeed + 1e-6
    assert flown.flight.run.complete
    assert state.body.place == pytest.approx((*places[-1][:2], 300 + places[-1][2]), abs=one_decimetre)


def test_px4_flies_to_the_place_of_its_takeoff_and_lifts_off_without_one():
    flown = fly([at(30, 40, 20, command=22), at(0, 100, 20)], autopilot="px4")
    assert flown.order == [0, 1]
    assert flown.seconds[0] == pytest.approx(1 + 2 * math.sqrt(20 * 10.4 / 3) + 50 / 5 + 5 / 3 + 3 / 4, abs=0.1)
    flown = fly([at(0, 50, 20), at(0, 100, 20)], autopilot="px4")
    assert flown.order == [0, 1]
    assert flown.flight.state.body.place == pytest.approx((0, 100, 320), abs=one_decimetre)


def test_jumping_to_an_item():
    flown = scene([takeoff(), *ROW[1:]]).start()
    flown.advance(100.0)
    assert flown.flight.jump(5)
    assert flown.flight.current == 5
    flown.advance(500.0)
    assert flown.flight.run.complete
    assert not flown.flight.jump(9)
    assert flown.flight.state.body.north == pytest.approx(4000, abs=one_decimetre)


def test_a_new_mission_in_flight_is_taken_up_after_the_present_leg():
    flown = scene(ROW).start()
    flown.advance(60.0)
    assert flown.flight.current == 2
    flown.items[2:] = [at(300, 0), at(300, 600)]
    flown.until_over()
    assert flown.order == [1, 2, 3]
    assert flown.flight.state.body.place == pytest.approx((300, 600, 380), abs=one_decimetre)
    flown.items.clear()
    flown.flight.run.complete = False
    flown.advance(1.0)
    assert flown.flight.run.complete


def test_guided_flight():
    flown = scene([])
    flight = flown.flight
    assert flight.take_off(320.0) == "it is not armed"
    flight.arm()
    assert flight.go_to((100, 0, 320)) == "it stands on the ground"
    assert flight.take_off(320.0) is None
    flown.advance(30.0)
    assert flight.state.body.place == pytest.approx((0, 0, 320))
    assert flight.take_off(330.0) == "it is flying already"
    assert flight.go_to((100, 0, 340)) is None
    flown.advance(30.0)
    assert flight.state.body.place == pytest.approx((100, 0, 340))
    assert flight.fly_there(at(0, 100, 50))
    flown.advance(60.0)
    assert flight.state.body.place == pytest.approx((0, 100, 350), abs=one_decimetre)
    assert flight.go_to((1e9, 0, 340)) == "that is too far away"
    flight.stay()
    assert not flight.fly_there(at(0, 0))
    assert flight.disarm() == "it is flying"
    flight.land()
    flown.advance(120.0)
    assert (flight.state.landed, flight.state.armed) == (True, False)
    flight.arm()
    assert flight.disarm() is None


def test_home_is_where_it_is_armed():
    flown = fly([takeoff(), at(0, 200), at(0, 200, 0, command=LAND)])
    assert flown.flight.state.home == HOME
    flown.flight.arm()
    assert FRAME.to_local(*_degrees(flown.flight.state.home.point))[0] == pytest.approx((0, 200), abs=one_decimetre)


def _degrees(point: GeoPoint) -> tuple[float, float]:
    return point.latitude_deg, point.longitude_deg


def test_disarmed_in_the_air_it_falls():
    flown = scene(ROW).start()
    flown.advance(60.0)
    flown.flight.disarm(force=True)
    flown.collect()
    assert flown.words[-1][0] == "Disarmed in the air: it fell"
    assert flown.flight.state.body.altitude == 300.0


@dataclass(frozen=True)
class Ending(Steady):
    """A wind that is known up to 1 km north, and no higher than 350 m."""

    name: str = "ending"
    resolution: float = math.inf

    def at(self, points, seconds=0.0):
        from gcs_windplan.errors import WindError

        if points[0, 1] > 1000:
            raise WindError("outside of the forecast")
        return np.array([[np.nan, np.nan, np.nan]]) if points[0, 2] > 350 else np.array([[0.0, -3.0, 0.0]])


def test_where_the_wind_is_not_known_the_last_one_goes_on():
    flown = scene(ROW, wind=Ending()).start()
    body = flown.flight.state.body
    assert body.wind == (0.0, -3.0)
    flown.advance(100.0)
    assert body.air.trouble == "the wind is not known at 380 m above sea level"
    assert body.wind == (0.0, -3.0)
    flown.until_over()
    assert body.air.trouble == "outside of the forecast"


def _as_measured(flight) -> tuple[float, list[tuple[float, float]]]:
    """A measured mission flown by the stand-in: its total, and each leg's duration beside the measured one."""
    p = flight["params"]
    profile = replace(
        SWIFT,
        airspeed=10.16 if p["ANGLE_MAX"] == 3000 else 15.0,
        speed=p["WPNAV_SPEED"] / 100,
        climb=p["WPNAV_SPEED_UP"] / 100,
        descent=p["WPNAV_SPEED_DN"] / 100,
        radius=p["WPNAV_RADIUS"] / 100,
        return_height=p["RTL_ALT"] / 100,
    )
    items = [
        StoredItem(
            i["frame"], i["command"], (i["p1"], i["p2"], i["p3"], i["p4"]),
            round(i["lat"] * 1e7), round(i["lon"] * 1e7), i["alt"],
        )
        for i in flight["items"]
    ]  # fmt: skip
    home = Home(GeoPoint(flight["home"]["lat"], flight["home"]["lon"]), flight["home"]["alt"])
    wind = wind_from(flight["wind"]["speed"], flight["wind"]["from_deg"])
    flown = Scene(items, SimulatedFlight(COPTER, profile, world_at(home, wind), lambda: items)).start().until_over(0.05)
    legs = [(flown.seconds[leg["to_seq"]], leg["duration"]) for leg in flight["legs"]]
    begins = dict(flown.begins)
    behind = [time for seq, time in flown.begins if seq > flight["legs"][-1]["to_seq"]]
    return (behind[0] if behind else flown.time) - begins[flight["legs"][0]["to_seq"]], legs


def test_twelve_missions_as_a_real_arducopter_flew_them(shared_data):
    errors = []
    for flight in json.loads((shared_data / "flights" / "arducopter_4.7.json").read_text()):
        total, legs = _as_measured(flight)
        assert total == pytest.approx(flight["total"], rel=0.015), flight["name"]
        errors += [ours - theirs for ours, theirs in legs]
    assert len(errors) == 85
    assert math.sqrt(sum(error**2 for error in errors) / len(errors)) < 0.6
