"""Power of a wing: the drag polar's closed forms and a naive twin."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from gcs_windplan.errors import InputError
from gcs_windplan.vehicle import FixedWing, best_range_airspeed, energy_per_metre, least_power_airspeed
from tests.vehicle.strategies import densities, fixed_wings
from tests.vehicle.twins import G, naive_wing

AEROSONDE = FixedWing(  # the authors' mavsim_public, aerosonde_parameters.py
    mass=11, wing_area=0.55, aspect_ratio=15.2445, oswald=0.9, parasite_drag=0.043, efficiency=0.678
)
one_millimetre_a_second = 1e-3
flying = st.floats(3, 60)


def test_the_aerosonde_by_hand() -> None:
    """At 25 m/s: q S = 210.547 N, CL = 0.51235, CD = 0.043 + 0.0060901, D = 10.336 N; D V / 0.678."""
    assert float(AEROSONDE.watts(25.0, 0.0)) == pytest.approx(381.11, abs=0.02)


@given(fixed_wings, flying, st.floats(-10, 10), densities)
def test_power_equals_drag_times_airspeed_by_efficiency(model, speed, climb, density) -> None:
    expected = naive_wing(model, speed, climb, density)
    assert float(model.watts(speed, climb, density)) == pytest.approx(expected, rel=1e-9, abs=1e-9)


@given(fixed_wings, densities)
def test_best_range_is_where_the_closed_formula_says(model: FixedWing, density: float) -> None:
    """Anderson 2016, sections 6.3 and 6.5: √(2W/(ρS)) (k/CD0)^¼, and least power at 3^-¼ of it."""
    k = 1 / (math.pi * model.oswald * model.aspect_ratio)
    scale = math.sqrt(2 * model.mass * G / (density * model.wing_area))
    best = scale * (k / model.parasite_drag) ** 0.25
    found = best_range_airspeed(model, 4 * best, density=density)
    assert found == pytest.approx(best, abs=one_millimetre_a_second)
    least = least_power_airspeed(model, 4 * best, density)
    assert least == pytest.approx(best / 3**0.25, abs=one_millimetre_a_second)
    drag = 2 * math.sqrt(k * model.parasite_drag) * model.mass * G
    assert float(energy_per_metre(model, found, density=density)) == pytest.approx(drag / model.efficiency, rel=1e-6)


@given(fixed_wings, flying, st.floats(0.01, 10), densities)
def test_climbing_costs_its_weight_and_gliding_gives_nothing_back(model, speed, climb, density) -> None:
    level, up = (float(model.watts(speed, rate, density)) for rate in (0.0, climb))
    assert up - level == pytest.approx(model.mass * G * climb / model.efficiency, rel=1e-6)
    assert level > float(model.watts(speed, -climb, density)) >= 0


@given(fixed_wings, flying, densities, st.floats(1, 3))
def test_thin_air_and_mass_scale_exactly(model, speed, density, heavier) -> None:
    """At the same lift coefficient: power and airspeed by √(ρ0/ρ); by the mass's 1.5th power and its root."""
    faster, root = math.sqrt(1.225 / density), math.sqrt(heavier)
    loaded = replace(model, mass=model.mass * heavier)
    expected = float(model.watts(speed, 0.0))
    assert float(model.watts(speed * faster, 0.0, density)) == pytest.approx(faster * expected, rel=1e-9)
    assert float(loaded.watts(speed * root, 0.0)) == pytest.approx(heavier**1.5 * expected, rel=1e-9)


def test_below_the_stall_it_does_not_fly() -> None:
    model = replace(AEROSONDE, stall_airspeed=14.0)
    watts = model.watts(np.array([0.0, 13.99, 14.0, 20.0]), 0.0)
    assert np.isinf(watts).tolist() == [True, True, False, False]
    assert model.airspeeds() == (14.0, math.inf)
    thin = model.airspeeds(1.225 / 4)[0]
    assert thin == pytest.approx(28.0)
    assert np.isinf(model.watts(np.array([27.9, 28.1]), 0.0, 1.225 / 4)).tolist() == [True, False]
    assert best_range_airspeed(replace(AEROSONDE, stall_airspeed=18.0), 40.0) == pytest.approx(18.0)


def test_no_airspeed_takes_infinite_power() -> None:
    assert math.isinf(float(AEROSONDE.watts(0.0, 0.0)))
    assert np.isnan(AEROSONDE.watts(math.nan, 0.0))


def test_every_wrong_coefficient_is_named() -> None:
    with pytest.raises(InputError, match=r"power\.oswald: must be above 0, not 0\npower\.efficiency: must be above 0"):
        replace(AEROSONDE, oswald=0, efficiency=0.0)
