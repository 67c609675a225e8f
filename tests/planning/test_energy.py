"""Energy en route: by hand in still air, against a naive integration in wind."""

from __future__ import annotations

import math
from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest

from gcs_windplan.flight import fly, fly_legs
from gcs_windplan.flight.energy import leg_energies
from gcs_windplan.jobs.missionfile.airframe import read_airframe
from gcs_windplan.planning.planner import plan_route
from gcs_windplan.scene import Scene
from gcs_windplan.vehicle import Multirotor, Vehicle, air_density
from gcs_windplan.wind import Calm, ConstantWind
from tests.ensembles import FRAME, Everywhere, divided
from tests.worlds import ShiftingWind, rough_dem

LIU = Multirotor(1.5, k1=0.8554, k2=0.3051, c2=0.3177, c4=0.0296, c5=0.0279, density=1.225)
VEHICLE = Vehicle(10.0, climb=3.0, descent=2.0)
one_joule = 1.0


def energy(points, wind, vehicle=VEHICLE, power=LIU):
    points = np.asarray(points, dtype=float)
    return leg_energies(points, fly_legs(points, wind, vehicle)[1], wind, vehicle, power)


def test_level_flight_in_still_air_takes_power_times_time():
    (joules,) = energy([[0, 0, 500], [0, 1000, 500]], Calm())
    assert joules == pytest.approx(100.0 * float(LIU.watts(10.0, 0.0, air_density(500.0))), rel=1e-9)


@pytest.mark.parametrize("along", [-6.0, -2.0, 3.0])
def test_along_the_wind_the_airspeed_stays_and_only_the_time_changes(along):
    (joules,) = energy([[0, 0, 0], [1000, 0, 0]], Everywhere(along))
    assert joules == pytest.approx(1000.0 / (10.0 + along) * float(LIU.watts(10.0, 0.0)), rel=1e-6)


def test_a_cross_wind_is_countered_at_the_same_airspeed():
    (joules,) = energy([[0, 0, 0], [0, 1000, 0]], ConstantWind(6.0, 0.0))
    assert joules == pytest.approx(1000.0 / 8.0 * float(LIU.watts(10.0, 0.0)), rel=1e-6)


def test_where_the_climb_rate_holds_it_back_it_flies_slower_through_the_air():
    """100 m up on 200 m of way take 33.3 s at 3 m/s: 6 m/s over ground, 7 m/s through the air ahead."""
    (joules,) = energy([[0, 0, 0], [200, 0, 100]], Everywhere(-1.0))
    heights = (np.arange(16) + 0.5) / 16 * 100.0
    assert joules == pytest.approx(100 / 3 * float(np.mean(LIU.watts(7.0, 3.0, air_density(heights)))), rel=1e-9)


def test_straight_up_it_holds_its_place_against_the_wind():
    (joules,) = energy([[0, 0, 0], [0, 0, 60]], Everywhere(5.0))
    heights = (np.arange(16) + 0.5) / 16 * 60.0
    assert joules == pytest.approx(20.0 * float(np.mean(LIU.watts(5.0, 3.0, air_density(heights)))), rel=1e-9)


@pytest.mark.parametrize("seed", range(4))
def test_in_changing_wind_it_equals_a_flight_in_small_steps(seed):
    """Second by second: wind here and now, ground speed by the triangle, power, energy."""
    wind = ShiftingWind((seed, seed + 3), (0.0, 1200.0), strength=3.0)
    random = np.random.default_rng(seed)
    points = np.cumsum(np.vstack([[0, 0, 300], random.uniform(-500, 500, (3, 3)) * (1, 1, 0.05)]), axis=0)
    clock, total = 0.0, 0.0
    for start, end in pairwise(points):
        vector, gone = end - start, 0.0
        level = math.hypot(vector[0], vector[1])
        while gone < 1.0:
            here = (start + gone * vector)[None]
            w = wind.at(here, clock)[0]
            along = (w[0] * vector[0] + w[1] * vector[1]) / level
            across = (w[1] * vector[0] - w[0] * vector[1]) / level
            speed = math.sqrt(VEHICLE.airspeed**2 - across**2) + along
            rate = VEHICLE.climb if vector[2] > 0 else VEHICLE.descent
            pace = max(level / speed, abs(vector[2]) / rate)
            step = min(0.05, (1.0 - gone) * pace)
            airspeed = math.hypot(level / pace - along, across)
            total += step * float(LIU.watts(airspeed, vector[2] / pace, air_density(here[0, 2])))
            clock, gone = clock + step, gone + step / pace
            if step < 0.05:
                break
    assert energy(points, wind).sum() == pytest.approx(total, rel=2e-3)


def test_a_leg_that_cannot_be_flown_has_no_energy():
    found = energy([[0, 0, 0], [0, 100, 0], [500, 100, 0]], Everywhere(-12.0))
    assert np.isnan(found).all()


def test_a_flight_carries_the_energy_of_its_legs_and_ends():
    dem = rough_dem(1, relief=0.0)
    points = np.array([[0.0, 0, 60], [500, 0, 60], [500, 500, 80]])
    flight = fly(points, Scene(FRAME, dem, Calm()), VEHICLE, power=LIU)
    assert [leg.energy for leg in flight.legs] == pytest.approx(list(energy(points, Calm())), abs=one_joule)
    assert flight.totals.energy == pytest.approx(sum(leg.energy for leg in flight.legs))
    assert flight.totals.takeoff_energy == pytest.approx(20.0 * float(LIU.watts(0.0, 3.0, air_density(60.0))))
    assert flight.totals.landing_energy == pytest.approx(40.0 * float(LIU.watts(0.0, -2.0, air_density(80.0))))
    assert fly(points, Scene(FRAME, dem, Calm()), VEHICLE).totals.energy is None


def test_the_spread_over_members_holds_their_energies(gallery):
    airframe = read_airframe(gallery / "vehicles" / "small_quadcopter.yaml")
    plan = plan_route(replace(divided(0.5), airframe=airframe))
    points = np.array([(w.east, w.north, w.altitude) for w in plan.waypoints])
    vehicle = plan.request.vehicle
    each = [
        float(leg_energies(points, fly_legs(points, member, vehicle)[1], member, vehicle, airframe.power).sum())
        for member in plan.request.scene.members
    ]
    assert plan.spread.energies == pytest.approx(each, rel=1e-9)
    assert plan.spread.energy_at(0.9) > plan.spread.energy_at(0.1)
