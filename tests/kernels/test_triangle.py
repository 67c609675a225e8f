"""The wind triangle and the time of legs against plain twins."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.integrate import quad
from scipy.optimize import brentq

from gcs_windplan.flight.sampling import integrate, performance_of
from gcs_windplan.kernels import edges
from gcs_windplan.kernels.triangle import ground_speed, leg_seconds, wind_angle
from gcs_windplan.paper.fields import Diverging, Jet, Rotation
from gcs_windplan.vehicle import Vehicle
from gcs_windplan.wind import ConstantWind
from tests.oracles.flying import naive_angle, naive_edge_time, naive_slowness

speeds = st.floats(-15, 15)
directions = st.tuples(st.floats(-1, 1), st.floats(-1, 1), st.floats(-0.5, 0.5)).filter(lambda d: math.hypot(*d) > 0.1)
vehicles = st.builds(
    Vehicle,
    airspeed=st.floats(2, 20),
    climb=st.floats(0.5, 5),
    descent=st.floats(0.5, 5),
    type=st.sampled_from(["multicopter", "fixed-wing"]),
    speed_model=st.sampled_from(["triangle", "paper"]),
)


@given(vehicles, directions, st.tuples(speeds, speeds, st.floats(-2, 2)))
def test_slowness_equals_its_twin(vehicle, direction, wind):
    unit = np.array(direction) / math.hypot(*direction)
    expected = naive_slowness(vehicle, unit, wind)
    level = math.hypot(unit[0], unit[1])
    track = (unit[0] / level, unit[1] / level) if level > 0 else (0.0, 0.0)
    found = leg_seconds(performance_of(vehicle), level, *track, unit[2], *wind)
    assert found == pytest.approx(expected, rel=1e-9) or (math.isinf(found) and expected > 1e6)


@given(vehicles, directions, st.tuples(speeds, speeds, st.just(0.0)), st.tuples(speeds, speeds, st.just(0.0)))
def test_edge_time_equals_its_twin(vehicle, vector, a, b):
    expected = naive_edge_time(vehicle, np.array(vector) * 100, a, b)
    setting = edges.Setting(edges.TIME, 0.0, 0.0, 0.0)
    found = edges.edge_between(performance_of(vehicle), setting, None, *(np.array(vector) * 100), 0.0, *a, *b)
    assert found == pytest.approx(expected, rel=1e-9) or expected > 1e8


@given(st.floats(1, 20), st.floats(0, 2 * math.pi), st.floats(0, 2 * math.pi), st.floats(0, 18))
def test_ground_speed_is_reached_by_some_heading(airspeed, track, blows, strength):
    """The heading whose velocity plus the wind points along the track, found by root finding."""
    wind = strength * np.array([math.sin(blows), math.cos(blows)])
    unit = np.array([math.sin(track), math.cos(track)])
    left = np.array([unit[1], -unit[0]])
    along, cross = float(wind @ unit), float(wind @ left)
    if abs(cross) > 0.999 * airspeed:
        return

    def drift(crab: float) -> float:
        return airspeed * math.sin(crab) + cross

    crab = brentq(drift, -math.pi / 2, math.pi / 2, xtol=1e-14)
    expected = airspeed * math.cos(crab) + along
    assert ground_speed(0, airspeed, along, cross) == pytest.approx(max(0.0, expected), abs=1e-6)


@given(st.floats(5, 20), st.floats(0, 4), st.floats(0, 4))
def test_more_tail_wind_is_never_slower(airspeed, tail, more):
    still = ground_speed(0, airspeed, 0.0, 1.0)
    assert ground_speed(0, airspeed, tail, 1.0) >= still
    assert ground_speed(0, airspeed, tail + more, 1.0) >= ground_speed(0, airspeed, tail, 1.0)


@given(directions, st.tuples(speeds, speeds, speeds).filter(lambda w: math.hypot(*w) > 1e-6))
def test_angle_equals_its_twin(direction, wind):
    assert wind_angle(*direction, *wind) == pytest.approx(naive_angle(direction, wind), abs=1e-6)


def test_angle_in_still_air_is_neutral():
    assert wind_angle(1.0, 0.0, 0.0, 0.0, 0.0, 0.0) == pytest.approx(math.pi / 2)


A, B = np.array([[-1.8, -1.8, 0.0]]), np.array([[1.8, 1.8, 0.0]])


@pytest.mark.parametrize(
    ("wind", "start", "end", "triangle", "paper"),
    [
        (Jet(), A, B, 2.2285, 2.1762),
        (Jet(), B, A, 3.5620, 3.3191),
        (Jet(reading="magnitude"), A, B, 2.3145, 2.2848),
        (Jet(reading="magnitude"), B, A, 3.1249, 3.0150),
        (Jet(reading="literal"), A, B, 3.0415, 2.7949),
        (Jet(reading="literal"), B, A, 3.3083, 3.0236),
        (Diverging(), A, B, 3.4346, 3.0690),
        (Diverging(), B, A, 2.7172, 2.4380),
        (Rotation(), A, B, 2.9394, 2.5456),
        (Rotation(), B, A, 2.9394, 2.5456),
    ],
    ids=["1 fwd", "1 rev", "1b fwd", "1b rev", "1c fwd", "1c rev", "2 fwd", "2 rev", "3 fwd", "3 rev"],
)
def test_straight_lines_through_the_papers_fields(wind, start, end, triangle, paper):
    """Reference values for the straight line at airspeed 2, printed to 1e-4 s; at a jump in the wind panels are
    halved."""
    printed = 1.5e-4
    for model, expected in (("triangle", triangle), ("paper", paper)):
        vehicle = Vehicle(2.0, climb=9.0, descent=9.0, speed_model=model)
        seconds = integrate(wind, vehicle, start, end).seconds[0]
        assert seconds == pytest.approx(expected, abs=printed)


@pytest.mark.parametrize("seed", range(10))
def test_leg_times_against_adaptive_quadrature(seed):
    rng = np.random.default_rng(seed)
    start, end = rng.uniform(-1.5, 1.5, (2, 3))
    vehicle, wind = Vehicle(2.0, climb=1.0, descent=0.7), Diverging()
    vector = end - start
    length = np.linalg.norm(vector)

    def density(share: float) -> float:
        blows = wind.at((start + share * vector)[None])[0]
        return length * naive_slowness(vehicle, vector / length, blows)

    expected, _ = quad(density, 0, 1, limit=200, epsrel=1e-10)
    assert integrate(wind, vehicle, start[None], end[None]).seconds[0] == pytest.approx(expected, rel=1e-5)


def test_wind_components_and_their_signs():
    """A wind from the west on a leg to the north comes from the left: it blows from left to right."""
    west_wind = ConstantWind.from_direction(5.0, 270.0)
    parts = integrate(west_wind, Vehicle(10.0), np.zeros((1, 3)), np.array([[0.0, 100.0, 0.0]]))
    assert parts.along[0] == pytest.approx(0.0, abs=1e-9)
    assert parts.across[0] == pytest.approx(5.0)
    assert parts.seconds[0] == pytest.approx(100 / math.sqrt(75))


def test_strong_wind_cannot_be_flown():
    gale = ConstantWind.from_direction(12.0, 0.0)
    against = integrate(gale, Vehicle(10.0), np.zeros((1, 3)), np.array([[0.0, 100.0, 0.0]]))
    with_it = integrate(gale, Vehicle(10.0), np.zeros((1, 3)), np.array([[0.0, -100.0, 0.0]]))
    assert math.isinf(against.seconds[0])
    assert with_it.seconds[0] == pytest.approx(100 / 22)
