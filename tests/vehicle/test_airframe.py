"""Airframes: their own checks, and those of the repository against what is published of them."""

from __future__ import annotations

import math
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from scipy.optimize import brentq

from gcs_windplan.errors import InputError
from gcs_windplan.jobs.missionfile.airframe import read_airframe
from gcs_windplan.vehicle import Airframe, Battery, Vehicle, best_range_airspeed, energy_per_metre
from tests.vehicle.test_power_rotors import LIU
from tests.vehicle.test_power_wings import AEROSONDE
from tests.vehicle.twins import G, naive_aerosonde_thrust

WATT_HOUR = 3600.0
FIFTEEN_PERCENT, TEN_PERCENT = 0.15, 0.10
PLAIN = Airframe("plain", Vehicle(9.0), 1.5, Battery(100 * WATT_HOUR), LIU, 15.0)


@pytest.fixture(scope="module")
def vehicles(gallery: Path) -> dict[str, Airframe]:
    return {path.stem: read_airframe(path) for path in (gallery / "vehicles").glob("*.yaml")}


def test_every_airframe_reads_and_flies(vehicles: dict[str, Airframe]) -> None:
    assert sorted(vehicles) == ["fixed_wing", "large_multirotor", "small_quadcopter"]
    for airframe in vehicles.values():
        speeds = np.linspace(airframe.vehicle.airspeed, airframe.maximum_airspeed, 20)
        rates = np.array([-airframe.vehicle.descent, 0.0, airframe.vehicle.climb])
        down, level, up = airframe.power.watts(speeds, rates[:, None])
        assert np.all((down >= 0) & (down < level) & (level < up) & (up < math.inf))
        minutes = airframe.battery.energy_to_plan_with / float(airframe.power.watts(speeds[0], 0.0)) / 60
        assert 5 < minutes < 120


def test_the_small_quadcopter_takes_what_its_flights_took(vehicles: dict[str, Airframe]) -> None:
    """Rodrigues et al. 2022, doi:10.1016/j.patter.2022.100569: about 0.08 MJ/km with 0.5 kg, flown at 4 to 12 m/s."""
    airframe = vehicles["small_quadcopter"]
    at_that_field = 1.172  # kg/m³
    cruise = float(energy_per_metre(airframe.power, airframe.vehicle.airspeed, density=at_that_field)) / 1000
    assert cruise == pytest.approx(0.08, rel=FIFTEEN_PERCENT)
    flown = energy_per_metre(airframe.power, np.array([4.0, 6.0, 8.0, 10.0, 12.0]), density=at_that_field) / 1000
    assert float(np.mean(flown)) == pytest.approx(0.08, rel=0.01)


def test_the_small_quadcopter_empty_hovers_as_its_fit_says(vehicles: dict[str, Airframe]) -> None:
    """Choudhry et al. 2021, liu_model.py: (0.99545857/100 + 2.06852797) (3.71 · 9.81)^1.5, by their gravity."""
    empty = replace(vehicles["small_quadcopter"].power, mass=3.71)  # type: ignore[type-var]
    expected = (0.99545857 / 100 + 2.06852797) * (3.71 * 9.81) ** 1.5
    assert float(empty.watts(0.0, 0.0, 1.172)) == pytest.approx(expected, rel=1e-3)


@pytest.mark.parametrize(
    ("payload", "battery", "minutes"),
    [
        *[(payload, "TB48S", minutes) for payload, minutes in ((0, 38), (0.5, 35), (0.9, 34), (1.9, 29), (5.5, 18))],
        *[(payload, "TB47S", minutes) for payload, minutes in ((0, 32), (0.4, 30), (0.9, 28), (1.8, 23), (6.0, 16))],
    ],
)
def test_the_large_multirotor_hovers_as_long_as_its_maker_says(
    vehicles: dict[str, Airframe], payload: float, battery: str, minutes: float
) -> None:
    """DJI, Matrice 600 Pro, specifications: at sea level, no wind, landing with 10 % of the battery."""
    empty, watt_hours = {"TB48S": (10.0, 6 * 129.96), "TB47S": (9.5, 6 * 99.9)}[battery]
    power = replace(vehicles["large_multirotor"].power, mass=empty + payload)  # type: ignore[type-var]
    found = 0.9 * watt_hours * 60 / float(power.watts(0.0, 0.0))
    exact = payload == 0 and battery == "TB48S"
    assert found == pytest.approx(minutes, rel=1e-3 if exact else TEN_PERCENT)


def test_the_large_multirotor_leans_as_its_maker_says(vehicles: dict[str, Airframe]) -> None:
    """DJI, Matrice 600 Pro, specifications: 25° and 65 km/h at most, six propellers of 21 inches."""
    airframe = vehicles["large_multirotor"]
    drag = airframe.power.c4 * airframe.maximum_airspeed**2  # type: ignore[attr-defined]
    assert math.degrees(math.atan2(drag, airframe.mass * G)) == pytest.approx(25.0, abs=0.05)
    swept = 6 * math.pi * (21 * 0.0254 / 2) ** 2
    assert airframe.power.k2 == pytest.approx(math.sqrt(2 * 1.225 * swept), rel=1e-4)  # type: ignore[attr-defined]


def test_the_fixed_wing_is_as_efficient_as_its_motor(vehicles: dict[str, Airframe]) -> None:
    """Beard and McLain's motor and propeller, at the voltage whose thrust is the drag; the thrust of 44.4 V ends it."""
    airframe = vehicles["fixed_wing"]
    assert airframe.power == replace(AEROSONDE, stall_airspeed=15.7)

    def drag(speed: float) -> float:
        return float(airframe.power.watts(speed, 0.0)) * AEROSONDE.efficiency / speed

    cruise = airframe.vehicle.airspeed
    volts = brentq(lambda one: naive_aerosonde_thrust(cruise, one, 1.225)[0] - drag(cruise), 10, 60)
    battery = naive_aerosonde_thrust(cruise, volts, 1.225)[1]
    assert drag(cruise) * cruise / battery == pytest.approx(AEROSONDE.efficiency, abs=1e-3)
    end = brentq(lambda one: naive_aerosonde_thrust(one, 44.4, 1.225)[0] - drag(one), 20, 60)
    assert airframe.maximum_airspeed == pytest.approx(end, abs=0.5)
    spare = (naive_aerosonde_thrust(cruise, 44.4, 1.225)[0] - drag(cruise)) * cruise / (airframe.mass * G)
    assert airframe.vehicle.climb < 0.6 * spare


def test_against_ten_metres_a_second_the_cruise_would_be_faster(vehicles: dict[str, Airframe]) -> None:
    airframe = vehicles["large_multirotor"]
    still, windy = (best_range_airspeed(airframe.power, airframe.maximum_airspeed, wind) for wind in (0.0, 10.0))
    assert still == pytest.approx(14.6, abs=0.1)
    assert windy == pytest.approx(airframe.maximum_airspeed)


def test_a_battery_leaves_its_reserve() -> None:
    battery = Battery(100 * WATT_HOUR, 0.8, 0.25)
    assert battery.usable_energy == pytest.approx(80 * WATT_HOUR)
    assert battery.energy_to_plan_with == pytest.approx(60 * WATT_HOUR)


@pytest.mark.parametrize(
    ("fields", "message"),
    [
        ({"capacity": 0.0}, "battery.capacity: must be above 0 J, not 0.0"),
        ({"capacity": math.nan}, "battery.capacity: must be above 0 J, not nan"),
        ({"capacity": 1.0, "usable": 1.1}, "battery.usable: must be above 0 and at most 1, not 1.1"),
        ({"capacity": 1.0, "reserve": 1.0}, "battery.reserve: must be at least 0 and below 1, not 1.0"),
    ],
)
def test_a_battery_that_is_none(fields: dict[str, float], message: str) -> None:
    with pytest.raises(InputError) as caught:
        Battery(**fields)
    assert str(caught.value) == message


@pytest.mark.parametrize(
    ("fields", "message"),
    [
        ({"mass": 2.0}, "mass: 2 kg fly, but the power is that of 1.5 kg; make both the same"),
        ({"maximum_airspeed": 8.0}, "maximum_airspeed: 8 m/s is less than the cruise at 9 m/s"),
        ({"maximum_airspeed": math.inf}, "maximum_airspeed: inf m/s is no largest airspeed"),
        ({"acceleration": 0.0}, "acceleration: must be above 0 m/s², not 0.0"),
    ],
)
def test_an_airframe_that_is_none(fields: dict[str, float], message: str) -> None:
    with pytest.raises(InputError) as caught:
        replace(PLAIN, **fields)  # type: ignore[arg-type]
    assert str(caught.value) == message
