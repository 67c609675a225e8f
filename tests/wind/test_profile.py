"""Power and log law over ground."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from gcs_windplan.arrays import FloatArray
from gcs_windplan.errors import WindError
from gcs_windplan.paper.fields import Rotation
from gcs_windplan.wind import ConstantWind, LogLaw, PowerLaw, ProfileWind


def _slope(points: FloatArray) -> FloatArray:
    """Ground that rises by a metre in ten towards east, unknown beyond 1 km."""
    return np.where(points[:, 0] > 1000, np.nan, points[:, 0] / 10)


def test_the_power_law_doubles_its_height_by_hand() -> None:
    factor = PowerLaw(10.0, 0.14).factor(np.array([10.0, 20.0, 100.0, 0.0, -5.0]))
    np.testing.assert_allclose(factor, [1.0, 1.101905, 1.380384, 0.0, 0.0], atol=1e-6)  # 2^0.14, 10^0.14


def test_the_log_law_by_hand() -> None:
    factor = LogLaw(10.0, 0.1).factor(np.array([10.0, 100.0, 1.0, 0.1, 0.05, 0.0, -5.0]))
    np.testing.assert_allclose(factor, [1.0, 1.5, 0.5, 0.0, 0.0, 0.0, 0.0], atol=1e-12)


def test_heights_count_from_the_ground_below_each_point() -> None:
    wind = ProfileWind(ConstantWind(10.0, -4.0), _slope, LogLaw(10.0, 0.1))
    points = np.array([[0.0, 0.0, 100.0], [500.0, 0.0, 150.0], [500.0, 0.0, 60.0], [500.0, 0.0, 20.0]])
    np.testing.assert_allclose(wind.at(points), [[15, -6, 0], [15, -6, 0], [10, -4, 0], [0, 0, 0]], atol=1e-12)


def test_unknown_ground_is_refused_and_located() -> None:
    wind = ProfileWind(ConstantWind(10.0, 0.0), _slope, PowerLaw())
    with pytest.raises(WindError, match=r"1 of 2 points .* 1500 m east and 200 m north .* 300 m"):
        wind.at(np.array([[0.0, 0.0, 100.0], [1500.0, 200.0, 300.0]]))


def test_the_resolution_is_the_finer_of_field_and_ground() -> None:
    assert ProfileWind(Rotation(1.0, 100.0), _slope, PowerLaw(), 30.0).resolution == 5.0
    assert ProfileWind(ConstantWind(1.0, 0.0), _slope, PowerLaw(), 30.0).resolution == 30.0
    assert math.isinf(ProfileWind(ConstantWind(1.0, 0.0), _slope, PowerLaw()).resolution)


@given(
    low=st.floats(0, 500),
    rise=st.floats(0, 500),
    exponent=st.floats(0.01, 0.5),
    roughness=st.floats(0.001, 5),
)
def test_the_wind_never_weakens_with_height(low: float, rise: float, exponent: float, roughness: float) -> None:
    for law in (PowerLaw(10.0, exponent), LogLaw(10.0, roughness)):
        lower, upper = law.factor(np.array([low, low + rise]))
        assert 0 <= lower <= upper
        assert law.factor(np.array([10.0]))[0] == pytest.approx(1.0)


def test_nonsense_is_refused() -> None:
    with pytest.raises(WindError, match="reference height"):
        PowerLaw(0.0)
    with pytest.raises(WindError, match="exponent"):
        PowerLaw(10.0, 2.0)
    with pytest.raises(WindError, match="roughness"):
        LogLaw(10.0, 20.0)
    with pytest.raises(WindError, match="resolution"):
        ProfileWind(ConstantWind(1.0, 0.0), _slope, PowerLaw(), 0.0)
