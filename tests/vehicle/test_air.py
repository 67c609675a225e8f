"""The standard atmosphere against ISO 2533:1975 (its tables by geometric height) and against an integration."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from gcs_windplan.errors import InputError
from gcs_windplan.vehicle import SEA_LEVEL_DENSITY, air_density
from tests.vehicle.twins import naive_density

heights = st.floats(-2000, 11_000)


@pytest.mark.parametrize(
    ("height", "density"), [(0, 1.225), (1000, 1.1117), (3000, 0.9093), (5000, 0.7364), (10_000, 0.4135)]
)
def test_published_densities_of_iso_2533(height: float, density: float) -> None:
    assert float(air_density(height)) == pytest.approx(density, abs=5e-5)


def test_sea_level_is_where_the_models_hold() -> None:
    assert float(air_density(0.0)) == pytest.approx(SEA_LEVEL_DENSITY, rel=1e-7)


@given(heights)
def test_it_is_the_integral_of_the_air_above(height: float) -> None:
    assert float(air_density(height)) == pytest.approx(naive_density(height), rel=1e-9)


@given(heights, st.floats(-60, 60))
def test_warmer_air_is_thinner_by_the_ratio_of_temperatures(height: float, warmer: float) -> None:
    """At the same pressure: the gas law."""
    standard = 288.15 - 0.0065 * 6_356_766 * height / (6_356_766 + height)
    expected = float(air_density(height)) * standard / (standard + warmer)
    assert float(air_density(height, warmer)) == pytest.approx(expected, rel=1e-12)


def test_a_hot_day_by_hand() -> None:
    """35 °C at sea level: 101 325 / (287.053 · 308.15)."""
    assert float(air_density(0.0, 20.0)) == pytest.approx(1.14549, abs=1e-5)


def test_heights_and_temperatures_broadcast_and_unknown_ones_stay_unknown() -> None:
    found = air_density(np.array([[0.0], [1000.0]]), np.array([0.0, 10.0, math.nan]))
    assert found.shape == (2, 3)
    assert np.isnan(found[:, 2]).all()
    assert not np.isnan(found[:, :2]).any()


@pytest.mark.parametrize("height", [-2000.1, 11_000.1, 1e9])
def test_heights_outside_the_layer_are_refused(height: float) -> None:
    with pytest.raises(InputError, match=r"known from -2000 m to 11000 m, not at"):
        air_density(np.array([0.0, height]))


def test_air_without_a_temperature_is_refused() -> None:
    with pytest.raises(InputError, match="-300 K warmer than standard has no temperature above 0 K"):
        air_density(0.0, -300.0)
