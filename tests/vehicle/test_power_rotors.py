"""Power of rotors: published figures, naive twins, and what theory says of climb, density and mass."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from gcs_windplan.errors import InputError
from gcs_windplan.vehicle import Multirotor, RotaryWing
from gcs_windplan.vehicle.power_rotors import inflow
from tests.vehicle.strategies import airspeeds, climbs, densities, multirotors, rotary_wings
from tests.vehicle.twins import G, naive_inflow, naive_liu, naive_zeng

ZENG = RotaryWing(mass=20 / G, disc_area=0.503, solidity=0.05, tip_speed=120)  # table I: W = 20 N
LIU = Multirotor(mass=1.5, k1=0.8554, k2=0.3051, c2=0.3177, c4=0.0296, c5=0.0279)  # table of the IRIS+
one_milliwatt = 1e-3
sinking = st.floats(-15, 10)


def test_zeng_hover_power() -> None:
    """Zeng, Xu, Zhang 2019: P0 = 79.8563 W, Pi = 88.6279 W, v0 = 4.03 m/s."""
    assert float(ZENG.blade_power()) == pytest.approx(79.8563, abs=one_milliwatt)
    assert float(ZENG.watts(0.0, 0.0)) == pytest.approx(79.8563 + 88.6279, abs=one_milliwatt)
    assert float(ZENG.induced_velocity()) == pytest.approx(4.03, abs=0.005)


@given(airspeeds, densities)
def test_level_power_is_zengs_closed_form(speed: float, density: float) -> None:
    induced = 1.1 * 20**1.5 / math.sqrt(2 * density * 0.503)
    hover = math.sqrt(20 / (2 * density * 0.503))
    body = 0.5 * 0.6 * density * 0.05 * 0.503
    expected = naive_zeng(speed, 79.85628 * density / 1.225, induced, 120, hover, body)
    assert float(ZENG.watts(speed, 0.0, density)) == pytest.approx(expected, rel=1e-9)


@given(st.floats(0, 60), sinking, st.floats(0.5, 15))
def test_the_inflow_is_the_root_that_bisection_finds(speed: float, climb: float, hover: float) -> None:
    found = float(inflow(np.array(speed), np.array(climb), np.array(hover)))
    assert found == pytest.approx(naive_inflow(speed, climb, hover), rel=1e-9, abs=1e-9)


def test_a_vertical_climb_by_hand() -> None:
    """Leishman 2006, section 2.13: v = -c/2 + √(c²/4 + v0²); with c = v0 that is 0.618 v0."""
    hover = float(ZENG.induced_velocity())
    expected = 79.85628 + 20 * (hover + 1.1 * 0.6180339887 * hover)
    assert float(ZENG.watts(0.0, hover)) == pytest.approx(expected, rel=1e-9)


def test_fast_forward_flight_climbs_for_its_weight_alone() -> None:
    """Leishman 2006, section 2.14: at high speed v is v0²/V, whatever the climb."""
    climbing = float(ZENG.watts(40.0, 2.0)) - float(ZENG.watts(40.0, 0.0))
    assert climbing == pytest.approx(20 * 2.0, rel=0.01)


@given(st.one_of(rotary_wings, multirotors), airspeeds, climbs, densities)
def test_climbing_costs_more_than_level_flight(model, speed, climb, density) -> None:
    level, up = (float(model.watts(speed, rate, density)) for rate in (0.0, climb + 0.01))
    assert up > level > 0


@given(st.one_of(rotary_wings, multirotors), airspeeds, st.tuples(sinking, sinking), densities)
def test_power_is_positive_and_never_falls_with_the_climb_rate(model, speed, rates, density) -> None:
    slow, fast = (float(model.watts(speed, rate, density)) for rate in sorted(rates))
    assert 0 < slow <= fast * (1 + 1e-9)


@given(rotary_wings, densities)
def test_hover_power_of_a_rotary_wing_scales_exactly(model: RotaryWing, density: float) -> None:
    """The blades' part with ρ, the induced one with 1/√ρ."""
    ratio = density / 1.225
    blades = float(model.blade_power()) / model.efficiency
    induced = float(model.watts(0.0, 0.0)) - blades
    assert float(model.watts(0.0, 0.0, density)) == pytest.approx(blades * ratio + induced / math.sqrt(ratio))


@given(multirotors, airspeeds, sinking, densities)
def test_a_multirotor_in_thin_air_flies_the_same_but_faster(model, speed, climb, density) -> None:
    """The same angles and coefficients: airspeed, climb rate and power all by √(ρ0/ρ)."""
    faster = math.sqrt(model.density / density)
    expected = faster * float(model.watts(speed, climb, model.density))
    assert float(model.watts(speed * faster, climb * faster, density)) == pytest.approx(expected, rel=1e-9)


@given(multirotors, airspeeds, st.floats(1, 3))
def test_a_heavier_multirotor_flies_the_same_but_faster(model: Multirotor, speed: float, heavier: float) -> None:
    """Power by the mass's 1.5th power, at an airspeed by its root."""
    loaded = replace(model, mass=model.mass * heavier)
    expected = heavier**1.5 * float(model.watts(speed, 0.0))
    assert float(loaded.watts(speed * math.sqrt(heavier), 0.0)) == pytest.approx(expected, rel=1e-9)


@given(rotary_wings, airspeeds, st.floats(1, 3))
def test_a_payload_costs_power(model: RotaryWing, speed: float, heavier: float) -> None:
    assert float(replace(model, mass=model.mass * heavier).watts(speed, 0.0)) >= float(model.watts(speed, 0.0))


def test_liu_hover_power_by_hand() -> None:
    """T = 1.5 · 9.80665 N; (0.8554/0.3051 + 0.3177) T^1.5 = 3.12136 · 56.4183 W."""
    assert float(LIU.watts(0.0, 0.0)) == pytest.approx(176.1014, abs=one_milliwatt)


def test_liu_climb_by_hand() -> None:
    """k1 T (1 + √(1 + T/k2²)) + c2 T^1.5 at 2 m/s: 0.8554 · 14.71 · (1 + √(1 + 158.024)) + 17.924."""
    assert float(LIU.watts(0.0, 2.0)) == pytest.approx(189.185, abs=0.01)


@given(multirotors, airspeeds, sinking, densities)
def test_a_multirotor_equals_its_twin(model, speed, climb, density) -> None:
    expected = naive_liu(model, speed, climb, density)
    assert float(model.watts(speed, climb, density)) == pytest.approx(expected, rel=1e-9)


@pytest.mark.parametrize("model", [ZENG, LIU], ids=["rotary wing", "multirotor"])
def test_arrays_broadcast_and_unknown_wind_stays_unknown(model) -> None:
    speeds, rates = np.array([0.0, 5.0, math.nan]), np.array([[-1.0], [2.0]])
    watts = model.watts(speeds, rates, np.array([1.0, 1.1, 1.2]))
    assert watts.shape == (2, 3)
    assert watts[1, 1] == pytest.approx(float(model.watts(5.0, 2.0, 1.1)))
    assert np.isnan(watts[:, 2]).all()


@pytest.mark.parametrize("model", [ZENG, LIU], ids=["rotary wing", "multirotor"])
def test_what_no_air_does_is_refused(model) -> None:
    with pytest.raises(InputError, match="an airspeed of -3 m/s is below 0"):
        model.watts(np.array([2.0, -3.0]), 0.0)
    with pytest.raises(InputError, match="an air density of 0 kg/m³ is not above 0"):
        model.watts(2.0, 0.0, 0.0)


def test_every_wrong_coefficient_is_named() -> None:
    with pytest.raises(InputError) as caught:
        RotaryWing(mass=0.0, disc_area=math.nan, solidity=0.05, tip_speed=120, body_drag=-1.0, efficiency=1.5)
    assert str(caught.value).split("\n") == [
        "power.mass: must be above 0, not 0.0",
        "power.disc_area: must be above 0, not nan",
        "power.body_drag: must not be below 0, not -1.0",
        "power.efficiency: must be above 0 and at most 1, not 1.5",
    ]
    with pytest.raises(InputError, match=r"power\.k2: must be above 0, not 0"):
        replace(LIU, k2=0.0)
    with pytest.raises(InputError, match=r"power\.c2: cannot be 0 with k1 at 0 as well"):
        replace(LIU, k1=0.0, c2=0.0)
