"""Measured power: straight lines in between, an error outside, and what density and climb do to it."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from gcs_windplan.errors import InputError
from gcs_windplan.vehicle import PowerTable, best_range_airspeed, energy_per_metre, least_power_airspeed
from tests.vehicle.strategies import densities
from tests.vehicle.test_power_wings import AEROSONDE
from tests.vehicle.twins import G

TABLE = PowerTable(2.0, (0.0, 5.0, 10.0, 15.0), (300.0, 250.0, 280.0, 400.0))


def test_between_rows_by_hand() -> None:
    watts = TABLE.watts(np.array([0.0, 2.5, 5.0, 9.0, 15.0, math.nan]), 0.0)
    np.testing.assert_allclose(watts, [300, 275, 250, 274, 400, math.nan])


def test_climbing_adds_its_weight_and_sinking_takes_nothing_off() -> None:
    watts = replace(TABLE, climb_efficiency=0.8).watts(5.0, np.array([2.0, 0.0, -2.0]))
    np.testing.assert_allclose(watts, [250 + 2 * G * 2 / 0.8, 250, 250])


@given(st.floats(0, 15), densities)
def test_thin_air_is_flown_faster_with_more_power(speed: float, density: float) -> None:
    faster = math.sqrt(1.225 / density)
    expected = faster * float(TABLE.watts(speed, 0.0))
    assert float(TABLE.watts(speed * faster, 0.0, density)) == pytest.approx(expected, rel=1e-9)


@given(st.floats(12, 38), st.floats(0.9, 1.3))
def test_a_dense_table_of_a_wing_is_the_wing(speed: float, density: float) -> None:
    """Its rule for another density is that of the theory."""
    rows = np.linspace(8, 45, 400)
    table = PowerTable(11.0, tuple(rows.tolist()), tuple(AEROSONDE.watts(rows, 0.0).tolist()))
    assert float(table.watts(speed, 0.0, density)) == pytest.approx(
        float(AEROSONDE.watts(speed, 0.0, density)), rel=1e-3
    )


def test_an_airspeed_outside_is_refused_and_located() -> None:
    text = (
        "power.measured: 16 m/s in air of 1.225 kg/m³ is 16 m/s in the 1.225 kg/m³ of the power table,"
        " which goes from 0 to 15 m/s; measure further or keep to it"
    )
    with pytest.raises(InputError) as caught:
        TABLE.watts(np.array([3.0, 16.0]), 0.0)
    assert str(caught.value) == text
    with pytest.raises(InputError, match=r"15 m/s in air of 1\.4 kg/m³ is 16\.04 m/s in the 1\.225 kg/m³"):
        TABLE.watts(15.0, np.zeros(3), 1.4)
    with pytest.raises(InputError, match="4 m/s in air"):
        PowerTable(2.0, (5.0, 6.0), (1.0, 2.0)).watts(4.0, 0.0)


@given(st.floats(-10, 12), densities)
def test_the_best_airspeeds_are_those_of_a_fine_search(head_wind: float, density: float) -> None:
    lowest, highest = TABLE.airspeeds(density)
    if head_wind > highest - 0.5:
        return
    every = np.linspace(max(lowest, head_wind + 1e-3), highest, 20_001)[:-1]
    found = best_range_airspeed(TABLE, 99.0, head_wind, density)
    least = float(np.min(energy_per_metre(TABLE, every, head_wind, density)))
    assert float(energy_per_metre(TABLE, found, head_wind, density)) <= least * (1 + 1e-6)
    assert least_power_airspeed(TABLE, 99.0, density) == pytest.approx(5.0 * math.sqrt(1.225 / density), abs=1e-3)


@pytest.mark.parametrize(
    ("airspeeds", "watts", "message"),
    [
        ((0.0,), (1.0,), "needs two rows or more, not 1 airspeeds and 1 powers"),
        ((0.0, 1.0), (1.0, 2.0, 3.0), "not 2 airspeeds and 3 powers"),
        ((0.0, 2.0, 1.0), (1.0, 1.0, 1.0), "start at 0 or above and rise"),
        ((-1.0, 2.0), (1.0, 1.0), "start at 0 or above and rise"),
        ((0.0, math.nan), (1.0, 1.0), "start at 0 or above and rise"),
        ((0.0, 1.0), (1.0, 0.0), "must be above 0"),
        ((0.0, 1.0), (1.0, math.inf), "must be above 0"),
    ],
)
def test_a_table_that_is_none(airspeeds: tuple[float, ...], watts: tuple[float, ...], message: str) -> None:
    with pytest.raises(InputError, match=message):
        PowerTable(2.0, airspeeds, watts)
