"""Calm, constant wind and the paper's three fields."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from gcs_windplan.arrays import FloatArray
from gcs_windplan.errors import WindError
from gcs_windplan.geo.frame import GeoPoint, LocalFrame
from gcs_windplan.wind import Calm, ConstantWind, Diverging, Jet, Rotation, WindField

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


def test_jet_14_at_points_worked_out_by_hand() -> None:
    points = _points((0, 0, 0), (50, 50, 0), (-90, -99, 0), (0, 100, 0), (0, 150, 0))
    for reading, east in (
        ("unit", [3, 3, 3, 0, 0]),
        ("magnitude", [3, 3 * 0.75, 3 * (1 - 0.99**2), 0, 0]),
        ("literal", [3, 3, 3, 0, -3]),
    ):
        wind = Jet(speed=3.0, scale=100.0, reading=reading).at(points)  # type: ignore[arg-type]
        np.testing.assert_allclose(wind[:, 0], east, atol=1e-12)
        assert not wind[:, 1:].any()


def test_diverging_15_at_points_worked_out_by_hand() -> None:
    wind = Diverging(speed=2.0, scale=10.0).at(_points((20, 7, 0), (-10, 0, 0), (5, 0, 0), (50, -3, 9)))
    expected = [
        [0, 2, 0],
        [-2, 0, 0],
        [-math.sqrt(2), math.sqrt(2), 0],
        [2 * 3 / math.sqrt(45), 2 * 6 / math.sqrt(45), 0],
    ]
    np.testing.assert_allclose(wind, expected, atol=1e-12)


def test_rotation_16_at_points_worked_out_by_hand() -> None:
    wind = Rotation(speed=2.0, scale=10.0).at(_points((5, 0, 0), (0, 3, 0), (-4, -3, 0), (0, 0, 0)))
    np.testing.assert_allclose(wind, [[0, 2, 0], [-2, 0, 0], [1.2, -1.6, 0], [0, 0, 0]], atol=1e-12)


@pytest.mark.parametrize(
    ("field", "forth", "back"),
    [
        (Jet(), 2.2285, 3.5620),
        (Jet(reading="magnitude"), 2.3145, 3.1249),
        (Jet(reading="literal"), 3.0415, 3.3083),
        (Diverging(), 3.4346, 2.7172),
        (Rotation(), 2.9394, 2.9394),
    ],
)
def test_straight_flights_through_the_fields_take_the_published_times(
    field: WindField, forth: float, back: float
) -> None:
    """The wind triangle along the diagonal of [-1.8, 1.8]² at airspeed 2, by another planner."""
    assert _straight(field, -1.8, 1.8) == pytest.approx(forth, abs=2e-4)
    assert _straight(field, 1.8, -1.8) == pytest.approx(back, abs=2e-4)


def _straight(field: WindField, start: float, end: float) -> float:
    samples = 200_000
    line = start + (end - start) * (np.arange(samples) + 0.5) / samples
    wind = field.at(np.stack([line, line, np.zeros(samples)], axis=-1))
    track = math.copysign(math.sqrt(0.5), end - start)
    along, cross = (wind[:, 0] + wind[:, 1]) * track, (wind[:, 0] - wind[:, 1]) * track
    return abs(end - start) * math.sqrt(2) * float(np.mean(1 / (np.sqrt(4 - cross**2) + along)))


@given(
    x=st.floats(-500, 500, allow_subnormal=False),
    y=st.floats(-500, 500, allow_subnormal=False),
    scale=st.floats(0.5, 200),
)
def test_the_unit_fields_have_their_speed_everywhere(x: float, y: float, scale: float) -> None:
    for field in (Diverging(4.0, scale), Rotation(4.0, scale)):
        expected = 0.0 if isinstance(field, Rotation) and math.hypot(x, y) == 0 else 4.0
        assert np.linalg.norm(field.at(_points((x, y, 0)))) == pytest.approx(expected)


def test_nonsense_is_refused() -> None:
    with pytest.raises(WindError, match="negative"):
        ConstantWind.from_direction(-1.0, 90.0)
    with pytest.raises(WindError, match="not finite"):
        ConstantWind(math.nan, 0.0)
    with pytest.raises(WindError, match="scale"):
        Rotation(1.0, 0.0)
    with pytest.raises(WindError, match="speed"):
        Diverging(math.inf)
    with pytest.raises(WindError, match="unit, magnitude, literal"):
        Jet(reading="wild")  # type: ignore[arg-type]
