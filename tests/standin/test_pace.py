"""The law of the pace against the figures fitted to 217 legs of a real ArduCopter."""

from __future__ import annotations

import math

import pytest

from gcs_windplan.mission.firmware.ardupilot import MOTION as ARDUCOPTER
from gcs_windplan.standin.pace import corner_speed, exit_speed, leg_pace, turn_between
from gcs_windplan.vehicle.pace import peak_speed, ramp_seconds


@pytest.mark.parametrize(("speed", "seconds"), [(4, 4.3), (5, 4.8), (7, 5.6), (10, 6.8), (14, 8.4)])
def test_fitted_seconds_to_a_speed(speed, seconds):
    assert ramp_seconds(speed, 2.5, ARDUCOPTER.jerk, ARDUCOPTER.rise) == pytest.approx(seconds, abs=0.05)


@pytest.mark.parametrize(("speed", "length"), [(5, 24), (10, 68), (14, 118)])
def test_fitted_length_that_a_speed_needs(speed, length):
    assert peak_speed(length, 2.5, ARDUCOPTER.jerk, ARDUCOPTER.rise) == pytest.approx(speed, abs=0.05)
    assert leg_pace(ARDUCOPTER, length * 1.02, 0.0, speed).speed == pytest.approx(speed)
    assert leg_pace(ARDUCOPTER, length / 2, 0.0, speed).speed < speed


@pytest.mark.parametrize(
    ("speed", "turn", "cost"),
    [
        (10, 20, 0.0), (10, 30, 0.9), (10, 45, 1.6), (10, 60, 2.1), (10, 90, 2.7), (10, 135, 3.3), (10, 180, 3.5),
        (5, 65, 0.2), (5, 90, 0.7), (14, 11, 0.0), (14, 90, 4.4),
    ],
)  # fmt: skip
def test_fitted_cost_of_a_corner(speed, turn, cost):
    """Slowing from the pace to the corner's speed and back, against passing at the pace [s]."""
    pace = leg_pace(ARDUCOPTER, 1000.0, 0.0, speed)
    slow = corner_speed(pace, math.radians(turn), ARDUCOPTER)
    lost = 2 * (speed - slow) ** 2 / (2 * pace.acceleration * speed)
    assert lost == pytest.approx(cost, abs=0.1)


def test_a_straight_corner_is_none():
    pace = leg_pace(ARDUCOPTER, 1000.0, 0.0, 10.0)
    assert corner_speed(pace, 0.0, 2.0) == 10.0
    assert turn_between((0, 3, 4), (0, 6, 8)) == pytest.approx(0.0, abs=1e-7)
    assert turn_between((1, 0, 0), (-1, 0, 0)) == pytest.approx(math.pi)


def test_a_leg_may_end_only_as_fast_as_the_next_can_be_braked():
    long, short = (0.0, 500.0, 0.0), (0.0, 3.0, 0.0)
    paces = [leg_pace(ARDUCOPTER, 500.0, 0.0, 10.0), leg_pace(ARDUCOPTER, 3.0, 0.0, 10.0)]
    speed = exit_speed([long, short], paces, 2.0)
    assert speed == pytest.approx(min(paces[1].speed, math.sqrt(2 * paces[1].acceleration * 3.0)))
    assert exit_speed([long], paces[:1], 2.0) == 0.0


def test_nothing_to_fly_takes_the_pace_as_it_is():
    assert leg_pace(ARDUCOPTER, 0.0, 0.0, 7.0).speed == 7.0
