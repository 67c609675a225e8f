"""The best airspeed of each leg against a brute-force scan, and against what is published."""

from __future__ import annotations

from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest

from gcs_windplan.flight import fly_legs
from gcs_windplan.flight.energy import leg_energies
from gcs_windplan.jobs.missionfile.airframe import read_airframe
from gcs_windplan.planning.airspeeds import best_airspeeds
from gcs_windplan.vehicle import Vehicle, air_density, best_range_airspeed
from gcs_windplan.wind import Calm, ConstantWind
from tests.worlds import ShiftingWind, WavyWind

tenth = 0.1  # [m/s]
AIRFRAMES = ["small_quadcopter", "large_multirotor", "fixed_wing"]


def brute_force(points, wind, vehicle, power, between, cost_index=0.0, begin=0.0):
    """Each leg at every 5 cm/s, half of what is allowed, one leg after the other, the cheapest kept."""
    best, clock = [], begin
    airspeeds = np.arange(between[0], between[1] + 1e-9, 0.05)
    for leg in pairwise(points):
        scan = _at_once if len(wind.times) == 1 else _one_by_one
        joules, times = scan(np.stack(leg), wind, vehicle, power, airspeeds, clock)
        flown = np.isfinite(times)
        price = np.where(flown, joules + cost_index * np.where(flown, times - clock, 0.0), np.inf)
        k = int(np.argmin(price))
        best.append((price[k], airspeeds[k], times[k]))
        clock = times[k]
    return np.array(best)


def _at_once(leg, wind, vehicle, power, airspeeds, begin):
    """Energies and arrivals of a leg at all airspeeds: to and fro, as its way back tells nothing in a steady wind."""
    points, speeds = np.tile(leg, (len(airspeeds), 1)), np.repeat(airspeeds, 2)[:-1]
    seconds = fly_legs(points, wind, vehicle, begin, speeds)[0].seconds
    times = np.append(0.0, np.cumsum(np.where(np.isfinite(seconds), seconds, 1.0)))
    with np.errstate(invalid="ignore"):  # too slow for the wind
        return leg_energies(points, times, wind, vehicle, power, speeds)[::2], begin + seconds[::2]


def _one_by_one(leg, wind, vehicle, power, airspeeds, begin):
    """The same in a wind that changes."""
    found = []
    for airspeed in airspeeds:
        flown = replace(vehicle, airspeed=float(airspeed))
        times = fly_legs(leg, wind, flown, begin)[1]
        found.append((leg_energies(leg, times, wind, flown, power)[0] if np.isfinite(times[-1]) else np.inf, times[-1]))
    return np.array(found).T


def legs_of(seed: int, count: int = 5, climb: float = 10.0) -> np.ndarray:
    rng = np.random.default_rng(seed)
    points = rng.uniform(-900, 900, (count, 3))
    points[:, 2] = 200.0 + rng.uniform(0, climb, count)
    return points


@pytest.mark.parametrize("name", AIRFRAMES)
@pytest.mark.parametrize("cost_index", [0.0, 300.0])
@pytest.mark.parametrize("seed", [1])
def test_it_is_what_a_scan_finds(name, cost_index, seed):
    airframe = read_airframe(f"missions/vehicles/{name}.yaml")
    wind = WavyWind(seed, strength=6.0)
    between = (20.0 if name == "fixed_wing" else 4.0, airframe.maximum_airspeed)
    points = legs_of(seed)
    found = best_airspeeds(points, wind, airframe.vehicle, airframe.power, between, cost_index=cost_index)
    scanned = brute_force(points, wind, airframe.vehicle, airframe.power, between, cost_index)
    assert np.abs(found - scanned[:, 1]).max() <= tenth


def test_it_is_what_a_scan_finds_in_wind_that_changes():
    airframe = read_airframe("missions/vehicles/small_quadcopter.yaml")
    wind = ShiftingWind(knots=(0.0, 900.0), strength=7.0)
    points = legs_of(3, count=4)
    found = best_airspeeds(points, wind, airframe.vehicle, airframe.power, (4.0, 17.0))
    scanned = brute_force(points, wind, airframe.vehicle, airframe.power, (4.0, 17.0))
    assert np.abs(found - scanned[:, 1]).max() <= tenth


@pytest.mark.parametrize("along", [-6.0, 0.0, 6.0])
def test_level_in_one_wind_it_is_the_best_range_airspeed(along):
    """Faster in a head wind, slower in a tail wind, as best range has it (Zeng et al. 2019's curve; the M600's)."""
    airframe = read_airframe("missions/vehicles/large_multirotor.yaml")
    points = np.array([[0.0, 0.0, 500.0], [3000.0, 0.0, 500.0]])
    wind = ConstantWind(along, 0.0)
    found = best_airspeeds(points, wind, airframe.vehicle, airframe.power, (2.0, 18.0))[0]
    expected = best_range_airspeed(airframe.power, 18.0, -along, float(air_density(500.0)))
    assert found == pytest.approx(expected, abs=tenth / 2)


def test_faster_in_a_head_wind_than_in_a_tail_wind():
    airframe = read_airframe("missions/vehicles/large_multirotor.yaml")
    points = np.array([[0.0, 0.0, 300.0], [2000.0, 0.0, 300.0], [0.0, 0.0, 300.0]])
    head, tail = best_airspeeds(points, ConstantWind(-5.0, 0.0), airframe.vehicle, airframe.power, (3.0, 18.0))
    calm = best_airspeeds(points, Calm(), airframe.vehicle, airframe.power, (3.0, 18.0))
    assert head > calm[0] + 0.5
    assert tail < calm[1] - 0.5
    assert calm[0] == pytest.approx(calm[1], abs=1e-3)


def test_a_leg_held_back_by_its_climb_takes_the_slowest_airspeed_that_is_as_good():
    """Straight up nearly: whatever the airspeed, it flies as slow as it climbs."""
    airframe = read_airframe("missions/vehicles/small_quadcopter.yaml")
    points = np.array([[0.0, 0.0, 100.0], [20.0, 0.0, 200.0]])
    vehicle = Vehicle(8.0, climb=2.5, descent=1.5)
    assert best_airspeeds(points, Calm(), vehicle, airframe.power, (3.0, 17.0))[0] == 3.0


def test_where_nothing_flies_it_is_the_fastest():
    airframe = read_airframe("missions/vehicles/small_quadcopter.yaml")
    points = np.array([[0.0, 0.0, 300.0], [2000.0, 0.0, 300.0]])
    found = best_airspeeds(points, ConstantWind(-30.0, 0.0), airframe.vehicle, airframe.power, (3.0, 17.0))
    assert found[0] == 17.0
