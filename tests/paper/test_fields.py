"""The paper's three fields."""

from __future__ import annotations

import math
import pickle

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from gcs_windplan.arrays import FloatArray
from gcs_windplan.errors import WindError
from gcs_windplan.paper.fields import Diverging, Jet, Rotation
from gcs_windplan.wind import WindField


def _points(*rows: tuple[float, float, float]) -> FloatArray:
    return np.array(rows, dtype=np.float64)


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
    with pytest.raises(WindError, match="scale"):
        Rotation(1.0, 0.0)
    with pytest.raises(WindError, match="speed"):
        Diverging(math.inf)
    with pytest.raises(WindError, match="unit, magnitude, literal"):
        Jet(reading="wild")  # type: ignore[arg-type]


def test_the_fields_are_values_that_pickle() -> None:
    for field in (Jet(3.0, 100.0, "literal"), Diverging(2.0), Rotation(scale=5.0)):
        assert pickle.loads(pickle.dumps(field)) == field
