"""Calm and constant wind."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from gcs_windplan.arrays import FloatArray
from gcs_windplan.errors import WindError
from gcs_windplan.geo.frame import GeoPoint, LocalFrame
from gcs_windplan.wind import Calm, ConstantWind

ONE_MM_PER_SECOND = 0.001
TROMSO = LocalFrame(GeoPoint(65.0, 19.0))


def _points(*rows: tuple[float, float, float]) -> FloatArray:
    return np.array(rows, dtype=np.float64)


def test_calm_is_still() -> None:
    assert not Calm().at(_points((0, 0, 0), (5, -3, 100)), 60.0).any()
    assert math.isinf(Calm().resolution)


@pytest.mark.parametrize(
    ("from_deg", "east", "north"),
    [(0, 0, -10), (90, -10, 0), (180, 0, 10), (270, 10, 0), (225, 7.0711, 7.0711)],
)
def test_a_direction_says_where_the_wind_comes_from(from_deg: float, east: float, north: float) -> None:
    wind = ConstantWind.from_direction(10.0, from_deg)
    np.testing.assert_allclose(wind.at(_points((7e3, 3e3, 50))), [[east, north, 0]], atol=ONE_MM_PER_SECOND)
    assert wind.from_deg == pytest.approx(from_deg % 360, abs=1e-9)
    assert f"from {from_deg:03d}°" in wind.name


def test_a_true_west_wind_follows_the_parallel_east_of_the_origin() -> None:
    """At 65° latitude, 50 km east: true east is where longitude grows and latitude stays."""
    places = _points((50_000, 0, 0))
    latitude, longitude = TROMSO.to_geographic(places)
    step = 1e-3
    along = TROMSO.to_local(latitude, longitude + step) - TROMSO.to_local(latitude, longitude - step)
    expected = 10 * along / np.linalg.norm(along)
    wind = ConstantWind.from_direction(10.0, 270.0, TROMSO).at(places)
    np.testing.assert_allclose(wind[:, :2], expected, atol=ONE_MM_PER_SECOND)
    assert wind[0, 1] == pytest.approx(10 * math.sin(math.radians(0.96)), abs=0.01)  # 50 km · tan 65° / 6390 km


def test_a_true_wind_at_the_origin_is_not_turned() -> None:
    wind = ConstantWind.from_direction(10.0, 180.0, TROMSO).at(_points((0, 0, 0)))
    np.testing.assert_allclose(wind, [[0, 10, 0]], atol=ONE_MM_PER_SECOND)


@given(
    speed=st.floats(0, 50),
    from_deg=st.floats(0, 360),
    east=st.floats(-300_000, 300_000),
    north=st.floats(-300_000, 300_000),
)
def test_a_constant_wind_keeps_its_speed_and_its_true_direction(
    speed: float, from_deg: float, east: float, north: float
) -> None:
    point = _points((east, north, 0))
    wind = ConstantWind.from_direction(speed, from_deg, TROMSO).at(point)
    assert np.linalg.norm(wind) == pytest.approx(speed, abs=ONE_MM_PER_SECOND)
    towards = math.atan2(wind[0, 0], wind[0, 1]) + TROMSO.convergence(point)[0]
    true = speed * math.sin(towards), speed * math.cos(towards)
    angle = math.radians(from_deg)
    assert true == pytest.approx((-speed * math.sin(angle), -speed * math.cos(angle)), abs=ONE_MM_PER_SECOND)


def test_nonsense_is_refused() -> None:
    with pytest.raises(WindError, match="negative"):
        ConstantWind.from_direction(-1.0, 90.0)
    with pytest.raises(WindError, match="not finite"):
        ConstantWind(math.nan, 0.0)
