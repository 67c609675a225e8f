"""The law of the pace against figures fitted to 217 legs of a real ArduCopter, and what must hold for any law."""

from __future__ import annotations

import json
import math
from dataclasses import replace
from functools import partial

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from gcs_windplan.errors import InputError
from gcs_windplan.geo.frame import GeoPoint, LocalFrame
from gcs_windplan.mission.firmware.ardupilot import MOTION as ARDUCOPTER
from gcs_windplan.mission.firmware.px4 import MOTION as PX4
from gcs_windplan.vehicle import pace as law

as_printed = 0.051  # [s] the figures are given to a tenth
one_second = 1.0
a_microsecond = 1e-6  # [s]
as_flown = partial(law.as_flown, pace=ARDUCOPTER)
takeoff_seconds = partial(law.takeoff_seconds, pace=ARDUCOPTER)
landing_seconds = partial(law.landing_seconds, pace=ARDUCOPTER)
return_seconds = partial(law.return_seconds, pace=ARDUCOPTER)
ramp_seconds, peak_speed, overlap_seconds = (
    partial(function, jerk=ARDUCOPTER.jerk, rise=ARDUCOPTER.rise)
    for function in (law.ramp_seconds, law.peak_speed, law.overlap_seconds)
)
SWIFT = replace(ARDUCOPTER, airspeed=15.0)  # leans to 45°
WAYPOINT, SPEED = 16, 178


def bent(turn_deg: float, length: float = 1000.0) -> np.ndarray:
    """Two level legs with a turn between them."""
    turn = math.radians(turn_deg)
    return np.array([[0, 0, 50], [0, length, 50], [length * math.sin(turn), length * (1 + math.cos(turn)), 50]])


# The law, by hand


@pytest.mark.parametrize(("speed", "seconds"), [(4, 4.3), (5, 4.8), (7, 5.6), (10, 6.8), (14, 8.4)])
def test_fitted_seconds_to_a_speed(speed, seconds):
    assert ramp_seconds(speed, 2.5) == pytest.approx(seconds, abs=as_printed)


@pytest.mark.parametrize(("speed", "length"), [(5, 24), (10, 68), (14, 118)])
def test_fitted_length_that_a_speed_needs(speed, length):
    assert speed * ramp_seconds(speed, 2.5) == pytest.approx(length, abs=0.5)
    assert peak_speed(speed * ramp_seconds(speed, 2.5), 2.5) == pytest.approx(speed)


@pytest.mark.parametrize(
    ("speed", "turn", "cost"),
    [
        (10, 0, 0.0), (10, 10, 0.0), (10, 20, 0.0), (10, 30, 0.9), (10, 45, 1.6), (10, 60, 2.1), (10, 90, 2.7),
        (10, 135, 3.3), (10, 180, 3.5), (5, 65, 0.2), (5, 90, 0.7), (14, 11, 0.0), (14, 90, 4.4),
    ],
)  # fmt: skip
def test_fitted_cost_of_a_corner(speed, turn, cost):
    flown = as_flown(bent(turn), speed, pace=SWIFT)
    assert flown.losses[1] == pytest.approx(cost, abs=2 * as_printed)


@pytest.mark.parametrize(("speed", "ramp"), [(5, 4.8), (10, 6.8), (14, 8.4)])
def test_fitted_cost_of_a_full_stop(speed, ramp):
    flown = as_flown(bent(0), speed, [0, 7, 0], pace=SWIFT)
    assert flown.losses[1] == pytest.approx(ramp + 0.6, abs=2 * as_printed)
    assert flown.seconds[0] == pytest.approx(1000 / speed + ramp + 0.6 + 7, abs=2 * as_printed)


def test_measured_square_of_300_m():
    """32.7 s corner to corner, 35.2 s from rest at 10 m/s."""
    square = np.array([[0, 0, 60], [0, 300, 60], [300, 300, 60], [300, 0, 60], [0, 0, 60]])
    seconds = as_flown(square).seconds
    assert seconds[0] == pytest.approx(35.2, abs=0.2)
    assert seconds[1:3] == pytest.approx([32.7, 32.7], abs=0.1)


def test_a_wider_radius_cuts_the_corner():
    costs = [as_flown(bent(90), pace=replace(SWIFT, radius=radius)).losses[1] for radius in (1, 2, 5, 10, 100)]
    assert costs == sorted(costs, reverse=True)
    assert costs[-1] == pytest.approx(0.31)  # what settling takes


@pytest.mark.parametrize(("climb", "level_speed"), [(50, 5.0), (-50, 3.0)])  # measured: 4.98 and 2.98
def test_climb_and_descent_limit_the_speed_on_a_slope(climb, level_speed):
    flown = as_flown(np.array([[0, 0, 100], [100, 0, 100 + climb]]))
    assert flown.peaks[0] * 100 / math.hypot(100, 50) == pytest.approx(level_speed)


def test_vertical_acceleration_limits_the_ramp_straight_up():
    flown = as_flown(np.array([[0, 0, 0], [0, 0, 100]]))
    assert flown.seconds[0] == pytest.approx(100 / 2.5 + 2.5 / 1.0 + 1.3 + 0.62)


def test_a_change_of_speed_is_done_in_the_leg_that_it_was_commanded_for():
    row = np.array([[0, 0, 50], [0, 1000, 50], [0, 2000, 50], [0, 3000, 50]])
    flown = as_flown(row, [10, 5, 10], pace=SWIFT)
    assert flown.peaks == pytest.approx([10, 5, 10])
    assert flown.seconds[0] == pytest.approx(100 + 3.4 + 0.62)  # no braking before the waypoint
    assert 200 - 10 < flown.seconds[1] < 200


@pytest.mark.parametrize(("seconds", "least", "most"), [(3.5, 10.0, 10.0), (4.5, 10.5, 11.0), (9.0, 13.0, 13.5)])
def test_a_change_of_speed_is_skipped_or_done_in_part_where_the_leg_is_short(seconds, least, most):
    """Skipped under 3.6 s of straight flight at the present speed; done within the first half of it."""
    length = 10 * ramp_seconds(10, 2.5) + 10 * seconds
    row = np.array([[0, 0, 50], [0, 500, 50], [0, 500 + length, 50], [0, 1200, 50]])
    assert least <= as_flown(row, [10, 14, 14], pace=SWIFT).peaks[1] <= most


def test_measured_60_m_at_4_after_11_are_flown_at_8_1():
    row = np.array([[0, 0, 50], [0, 500, 50], [0, 560, 50], [0, 1200, 50]])
    assert as_flown(row, [11, 4, 4], pace=SWIFT).peaks[1] == pytest.approx(8.1, abs=0.1)


def test_a_command_after_a_stop_is_done_at_once():
    row = np.array([[0, 0, 50], [0, 500, 50], [0, 560, 50]])
    flown = as_flown(row, [11, 4], [0, 3, 0], pace=SWIFT)
    assert flown.peaks[1] == 4.0
    assert flown.seconds[1] == pytest.approx(60 / 4 + ramp_seconds(4, 2.5) + 0.62)


@pytest.mark.parametrize(
    ("wind", "ground_speed"),
    [((0, 5), 10.0), ((0, -5), 5.16), ((9, 0), math.sqrt(10.16**2 - 81)), ((0, -10.16), 0.0), ((10.2, 0), 0.0)],
)
def test_the_lean_angle_caps_the_airspeed(wind, ground_speed):
    """Measured: 9.98 m/s in 5 m/s of tail wind, 5.16 against them, at 30° of lean."""
    flown = as_flown(np.array([[0, 0, 50], [0, 3000, 50]]), winds=np.array(wind))
    assert flown.peaks[0] == pytest.approx(ground_speed)
    assert math.isfinite(flown.total) == (ground_speed > 0)


def test_measured_take_off_landing_and_return():
    """Take-off to 60 m 30.6 s from arming; d/10 + (z - 10)/1.5 + 36.7 s to disarmed, 66 s from 60 m overhead."""
    assert takeoff_seconds(60) == pytest.approx(30.6)
    assert takeoff_seconds(60, climb=5.0) == pytest.approx(18.6)
    for away, height in ((1500, 80), (400, 60), (2000, 120)):
        assert return_seconds((away, 0), height) == pytest.approx(away / 10 + (height - 10) / 1.5 + 36.7, abs=0.5)
    assert return_seconds((0, 0), 60) == pytest.approx(66, abs=0.7)
    assert landing_seconds(60) - landing_seconds(30) == pytest.approx(20)
    assert landing_seconds(10) - landing_seconds(5) == pytest.approx(10)
    assert landing_seconds(60, descent=5.0) == pytest.approx(landing_seconds(10) + 10)


def test_a_low_return_climbs_first():
    more = 10 / 2.5 + 2.5 + 1.3 + 0.62  # to 15 m
    assert return_seconds((500, 0), 5) == pytest.approx(return_seconds((500, 0), 15) + more)


def test_a_return_against_the_wind():
    assert return_seconds((0, 1000), 50, wind=(0, -5)) > return_seconds((0, 1000), 50) + 80
    assert return_seconds((0, 1000), 50, wind=(0, -11)) == math.inf


# What cannot be


@pytest.mark.parametrize("wrong", [{"speed": 0}, {"climb": -1}, {"jerk": math.nan}, {"settle": -1}])
def test_a_pace_checks_itself(wrong):
    with pytest.raises(InputError, match="must be above 0"):
        replace(ARDUCOPTER, **wrong)


def test_an_acceleration_must_let_the_jerk_rise():
    with pytest.raises(InputError, match=r"jerk · rise, 0\.3 m/s²"):
        replace(ARDUCOPTER, vertical_acceleration=0.2)


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ({"points": np.zeros((1, 3))}, "two or more finite points"),
        ({"points": np.zeros((2, 2))}, "two or more finite points"),
        ({"points": np.array([[0, 0, 0], [0, 0, math.nan]])}, "two or more finite points"),
        ({"points": bent(0), "speeds": np.array([10.0, 0.0])}, "speeds: 0.0 m/s is no speed"),
        ({"points": bent(0), "speeds": np.full(3, 10.0)}, r"speeds of shape \(3,\) do not fit \(2,\)"),
        ({"points": bent(0), "holds": np.array([0.0, -1.0, 0.0])}, "a hold of -1.0 s"),
        ({"points": bent(0), "winds": np.zeros((3, 3))}, "winds of shape"),
    ],
)
def test_what_does_not_fit_is_refused(arguments, message):
    with pytest.raises(InputError, match=message):
        as_flown(**arguments)


def test_a_leg_of_no_length_is_a_stop():
    twice = np.insert(bent(0), 1, bent(0)[1], axis=0)
    flown = as_flown(twice, holds=[0, 3, 4, 0])
    assert flown.seconds[1] == 4.0
    assert flown.total == pytest.approx(as_flown(bent(0), holds=[0, 7, 0]).total)


# What must hold for any law

coordinates = st.tuples(st.floats(-500, 500), st.floats(-500, 500), st.floats(20, 120))
routes = st.lists(coordinates, min_size=2, max_size=7).map(np.array)
paces = st.sampled_from([ARDUCOPTER, SWIFT, PX4, replace(SWIFT, radius=5.0)])
commands = st.floats(1.0, 18.0)


@given(routes, st.lists(commands, min_size=6, max_size=6), paces)
def test_never_faster_than_distance_by_speed(route, commanded, pace):
    speeds = np.array(commanded[: len(route) - 1])
    flown = as_flown(route, speeds, pace=pace)
    legs = np.diff(route, axis=0)
    fastest = np.maximum(speeds, np.roll(speeds, 1))  # a change may be skipped
    fastest[0] = speeds[0]
    vertical = np.where(legs[:, 2] > 0, legs[:, 2] / pace.climb, -legs[:, 2] / pace.descent)
    least = np.maximum(np.hypot(legs[:, 0], legs[:, 1]) / fastest, vertical)
    some_way = np.linalg.norm(legs, axis=1) > 0.01  # [m] nearer places are one
    assert np.all((flown.seconds >= least - a_microsecond) | ~some_way)
    assert np.all(as_flown(route, commanded[0], pace=pace).losses >= -a_microsecond)


@given(routes, st.floats(0.3, 1.0), commands, paces)
def test_a_slower_commanded_speed_never_makes_a_mission_shorter(route, share, commanded, pace):
    slow, fast = (as_flown(route, speed, pace=pace).total for speed in (share * commanded, commanded))
    assert slow >= fast - a_microsecond


@given(routes, commands, st.tuples(st.floats(-6, 6), st.floats(-6, 6)), paces)
def test_a_mirrored_mission_takes_as_long(route, commanded, wind, pace):
    winds = np.tile([*wind, 0.0], (len(route) - 1, 1))
    mirror = np.array([-1.0, 1.0, 1.0])
    here, there = (as_flown(route * m, commanded, winds=winds * m, pace=pace) for m in (np.ones(3), mirror))
    assert there.seconds == pytest.approx(here.seconds)


@given(commands, st.floats(0.3, 0.7), st.floats(0, 360), st.floats(-20, 20), paces)
def test_a_collinear_waypoint_changes_nothing(commanded, share, track, climb, pace):
    """Where both parts are long enough to be flown at the leg's speed."""
    end = np.array([2000 * math.sin(track), 2000 * math.cos(track), climb])
    whole, parts = (
        as_flown(np.array(points), commanded, pace=pace) for points in ([0 * end, end], [0 * end, share * end, end])
    )
    assert parts.total == pytest.approx(whole.total, abs=1e-5)
    assert parts.losses[1] == pytest.approx(0, abs=1e-5)


@given(st.floats(0.01, 3000), st.floats(0.5, 5), st.sampled_from([(1.0, 0.3), (4.0, 0.0), (1.0, 0.1)]))
def test_the_peak_is_where_the_two_ramps_fill_the_leg(length, acceleration, jerk):
    speed = law.peak_speed(length, acceleration, *jerk)
    assert speed * law.ramp_seconds(speed, acceleration, *jerk) == pytest.approx(length)


@given(st.floats(0, 100), st.floats(0, 10), st.floats(0.5, 5))
def test_a_farther_corner_lets_ramps_overlap_longer(distance, more, acceleration):
    near, far = (overlap_seconds(metres, acceleration) for metres in (distance, distance + more))
    assert near <= far + a_microsecond


# As measured


def _as_measured(flight):
    """The flight's points from its take-off on, with speeds and holds, and its pace."""
    given = flight["params"]
    pace = replace(
        ARDUCOPTER,
        speed=given["WPNAV_SPEED"] / 100,
        climb=given["WPNAV_SPEED_UP"] / 100,
        descent=given["WPNAV_SPEED_DN"] / 100,
        acceleration=given["WPNAV_ACCEL"] / 100,
        vertical_acceleration=given["WPNAV_ACCEL_Z"] / 100,
        jerk=given["WPNAV_JERK"],
        radius=given["WPNAV_RADIUS"] / 100,
        airspeed=10.16 if given["ANGLE_MAX"] == 3000 else 15.0,
    )
    frame = LocalFrame(GeoPoint(flight["home"]["lat"], flight["home"]["lon"]))
    points, speeds, holds, commanded = [(0.0, 0.0, flight["takeoff"]["alt"])], [], [0.0], pace.speed
    for item in flight["items"][2:]:
        if item["command"] == SPEED:
            commanded = item["p2"]
        if item["command"] == WAYPOINT:
            points.append((*frame.to_local(item["lat"], item["lon"])[0], item["alt"]))
            speeds.append(commanded)
            holds.append(item["p1"])
    return np.array(points), np.array(speeds), holds, pace


def test_twelve_missions_as_a_real_arducopter_flew_them(shared_data):
    """Each total within 1.1 %, each of 85 legs within 1 s, 0.2 s rms; nothing is fitted to these flights one by one."""
    errors = []
    for flight in json.loads((shared_data / "flights" / "arducopter_4.7.json").read_text()):
        points, speeds, holds, pace = _as_measured(flight)
        blows = math.radians(flight["wind"]["from_deg"])
        wind = -flight["wind"]["speed"] * np.array([math.sin(blows), math.cos(blows)])
        flown = as_flown(points, speeds, holds, wind, pace=pace)
        measured = [leg["duration"] for leg in flight["legs"]]
        assert flown.total == pytest.approx(flight["total"], rel=0.011), flight["name"]
        assert flown.seconds == pytest.approx(measured, abs=one_second), flight["name"]
        errors += list(flown.seconds - measured)
        returned = return_seconds(tuple(-points[-1, :2]), points[-1, 2], pace=pace, wind=tuple(wind))
        assert returned == pytest.approx(flight["rtl"]["to_disarm"], abs=0.6), flight["name"]
        lifted = takeoff_seconds(points[0, 2], pace=pace) - pace.spool_up
        assert lifted == pytest.approx(flight["takeoff"]["liftoff_to_reached"], abs=0.1), flight["name"]
    assert len(errors) == 85
    assert math.sqrt(np.mean(np.square(errors))) < 0.21
