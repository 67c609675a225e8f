"""The airspeeds that take the least: the published ones of Zeng, Xu, Zhang 2019, and properties."""

from __future__ import annotations

import math
import subprocess
import sys

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from gcs_windplan.errors import InputError
from gcs_windplan.vehicle import best_range_airspeed, energy_per_metre, least_power_airspeed
from tests.vehicle.strategies import densities, multirotors, rotary_wings
from tests.vehicle.test_power_rotors import ZENG

one_centimetre_a_second = 1e-2


def test_zeng_least_power() -> None:
    """Zeng, Xu, Zhang 2019, doi:10.1109/TWC.2019.2902559: 126 W at 10.21 m/s."""
    airspeed = least_power_airspeed(ZENG, 60.0)
    assert airspeed == pytest.approx(10.21, abs=one_centimetre_a_second)
    assert float(ZENG.watts(airspeed, 0.0)) == pytest.approx(126, abs=0.5)


@pytest.mark.parametrize(
    ("head_wind", "airspeed", "joules"),
    [(-10, 15.3, 5.54), (-5, 16.6, 6.86), (0, 18.3, 8.83), (5, 20.8, 11.9), (10, 24.3, 16.6)],
)
def test_zeng_best_range_by_head_wind(head_wind: float, airspeed: float, joules: float) -> None:
    """In still air published; with wind from the same coefficients."""
    found = best_range_airspeed(ZENG, 60.0, head_wind)
    assert found == pytest.approx(airspeed, abs=0.05)
    assert float(energy_per_metre(ZENG, found, head_wind)) == pytest.approx(joules, rel=0.004)


def test_holding_the_airspeed_of_still_air_costs_three_percent_at_five_and_a_third_at_ten() -> None:
    still = best_range_airspeed(ZENG, 60.0)
    extra = []
    for head_wind in (5.0, 10.0):
        best = energy_per_metre(ZENG, best_range_airspeed(ZENG, 60.0, head_wind), head_wind)
        extra.append(float(energy_per_metre(ZENG, still, head_wind) / best - 1))
    assert 0.02 < extra[0] < 0.035
    assert 0.16 < extra[1] < 0.35


@given(st.one_of(rotary_wings, multirotors), st.floats(-15, 15), densities)
def test_no_airspeed_on_a_fine_grid_is_better(model, head_wind: float, density: float) -> None:
    found = best_range_airspeed(model, 40.0, head_wind, density)
    every = np.linspace(max(head_wind, 0.0) + 0.01, 40.0, 4001)
    least = float(np.min(energy_per_metre(model, every, head_wind, density)))
    assert float(energy_per_metre(model, found, head_wind, density)) <= least * (1 + 1e-6)
    least = float(np.min(model.watts(every, 0.0, density)))
    assert float(model.watts(least_power_airspeed(model, 40.0, density), 0.0, density)) <= least * (1 + 1e-6)


@given(st.one_of(rotary_wings, multirotors), st.floats(-10, 10), st.floats(0.1, 5))
def test_more_head_wind_is_flown_faster_and_costs_more(model, head_wind: float, more: float) -> None:
    calmer, windier = (best_range_airspeed(model, 40.0, wind) for wind in (head_wind, head_wind + more))
    assert windier >= calmer - one_centimetre_a_second
    assert energy_per_metre(model, windier, head_wind + more) >= energy_per_metre(model, calmer, head_wind)


def test_no_way_over_ground_takes_infinite_energy() -> None:
    joules = energy_per_metre(ZENG, np.array([5.0, 10.0, 15.0, math.nan]), 10.0)
    assert np.isinf(joules).tolist() == [True, True, False, True]


def test_what_cannot_be_asked() -> None:
    with pytest.raises(InputError, match="a head wind of 20 m/s leaves no speed over ground at 20 m/s"):
        best_range_airspeed(ZENG, 20.0, 20.0)
    with pytest.raises(InputError, match="0 m/s is no largest airspeed; give one above 0 m/s"):
        least_power_airspeed(ZENG, 0.0)
    with pytest.raises(InputError, match="inf m/s is no largest airspeed"):
        least_power_airspeed(ZENG, math.inf)


def test_the_vehicle_is_imported_without_scipy() -> None:
    code = "import sys, gcs_windplan.vehicle; sys.exit('scipy' in sys.modules)"
    assert subprocess.run([sys.executable, "-c", code], check=False).returncode == 0
