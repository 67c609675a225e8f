"""Gridded wind: frames, borders, heights and times."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from gcs_windplan.arrays import FloatArray
from gcs_windplan.errors import WindError
from gcs_windplan.geodesy import GeoPoint, LocalFrame, rotate
from gcs_windplan.wind import GriddedWind

ONE_CM_PER_SECOND = 0.01
FRAME = LocalFrame(GeoPoint(65.0, 19.0))


def _wind(**changes: object) -> GriddedWind:
    """From the west at 10 m/s by 0, falling to 4 m/s two hours later; twice that at 200 m."""
    u = np.array([[10.0, 20.0], [4.0, 8.0]])[:, :, np.newaxis, np.newaxis] * np.ones((2, 2, 3, 3))
    wind = GriddedWind(
        name="made up",
        frame=FRAME,
        latitudes=np.array([64.0, 65.0, 66.0]),
        longitudes=np.array([17.0, 19.0, 21.0]),
        heights=np.array([100.0, 200.0]),
        times=np.array([0.0, 7200.0]),
        u=u,
        v=0 * u,
    )
    return replace(wind, **changes)  # type: ignore[arg-type]


def _at(wind: GriddedWind, east: float, north: float, up: float, seconds: float = 0.0) -> FloatArray:
    result: FloatArray = wind.at(np.array([[east, north, up]]), seconds)[0]
    return result


def test_it_is_linear_in_height_and_time() -> None:
    np.testing.assert_allclose(_at(_wind(), 0, 0, 150), [15, 0, 0], atol=ONE_CM_PER_SECOND)
    np.testing.assert_allclose(_at(_wind(), 0, 0, 150, 3600), [10.5, 0, 0], atol=ONE_CM_PER_SECOND)


def test_true_components_are_turned_into_the_local_grid() -> None:
    """50 km east at 65° the convergence is about a degree: a true west wind also blows to grid north."""
    wind = _at(_wind(), 50_000, 0, 100)
    convergence = FRAME.convergence(np.array([[50_000.0, 0.0]]))
    np.testing.assert_allclose(wind[np.newaxis], rotate(np.array([[10.0, 0.0, 0.0]]), -convergence), atol=1e-6)
    assert wind[1] == pytest.approx(0.168, abs=ONE_CM_PER_SECOND)


@pytest.mark.parametrize("turn", [-360.0, 0.0, 360.0])
def test_longitudes_may_be_counted_from_anywhere(turn: float) -> None:
    wind = _wind(longitudes=np.array([17.0, 19.0, 21.0]) + turn)
    np.testing.assert_allclose(_at(wind, 0, 0, 100), [10, 0, 0], atol=ONE_CM_PER_SECOND)


def test_below_the_lowest_level_its_wind_is_taken() -> None:
    np.testing.assert_allclose(_at(_wind(), 0, 0, -50), [10, 0, 0], atol=ONE_CM_PER_SECOND)


def test_above_the_highest_level_the_wind_is_not_known() -> None:
    assert np.isnan(_at(_wind(), 0, 0, 235)).all()
    assert np.isfinite(_at(_wind(), 0, 0, 200)).all()


def test_levels_above_ground_follow_the_ground() -> None:
    wind = _wind(ground=lambda points: 1000 + points[:, 0] / 10)
    np.testing.assert_allclose(_at(wind, 500, 0, 1200), [15, 0, 0], atol=ONE_CM_PER_SECOND)
    assert np.isnan(_at(wind, 500, 0, 1300)).all()


def test_unknown_ground_is_an_error() -> None:
    wind = _wind(ground=lambda points: np.full(len(points), np.nan))
    with pytest.raises(WindError, match="terrain has to cover"):
        _at(wind, 0, 0, 150)


def test_a_single_level_holds_at_every_height() -> None:
    wind = _wind(heights=np.array([10.0]), u=np.full((2, 1, 3, 3), 5.0), v=np.zeros((2, 1, 3, 3)))
    np.testing.assert_allclose(_at(wind, 0, 0, 3000), [5, 0, 0], atol=ONE_CM_PER_SECOND)


def test_outside_of_the_area_is_an_error_unless_extended() -> None:
    with pytest.raises(WindError, match=r"ends 1[01]\.\d km short of 66\.\d+.*extend: nearest"):
        _at(_wind(), 0, 122_000, 100)
    extended = _at(_wind(extend=True), 0, 122_000, 100)
    np.testing.assert_allclose(extended, [10, 0, 0], atol=ONE_CM_PER_SECOND)


def test_outside_of_its_times_is_an_error_even_if_extended() -> None:
    with pytest.raises(WindError, match=r"3\.50 h after departure, 1\.50 h after its last"):
        _at(_wind(extend=True), 0, 0, 100, 3.5 * 3600)
    with pytest.raises(WindError, match=r"0\.50 h before its first"):
        _at(_wind(), 0, 0, 100, -1800)


def test_a_single_time_is_steady() -> None:
    still = _wind()
    wind = replace(still, times=still.times[:1], u=still.u[:1], v=still.v[:1], heights=still.heights[:1], window=None)
    assert _at(wind, 0, 0, 100, 1e7)[0] == pytest.approx(10)


def test_places_that_are_not_finite_are_refused() -> None:
    with pytest.raises(WindError, match="not finite"):
        _at(_wind(), math.nan, 0, 100)


def test_no_points_give_no_wind() -> None:
    assert _wind().at(np.empty((0, 3))).shape == (0, 3)


def test_the_resolution_is_half_the_smallest_spacing() -> None:
    """2° of longitude at 66° are 90.5 km, 1° of latitude 111.2 km."""
    assert _wind().resolution == pytest.approx(45_200, rel=0.01)


@given(
    east=st.floats(-80_000, 80_000),
    north=st.floats(-80_000, 80_000),
    up=st.floats(0, 200),
    seconds=st.floats(0, 7200),
)
def test_the_wind_never_exceeds_the_values_of_the_grid(east: float, north: float, up: float, seconds: float) -> None:
    speed = np.linalg.norm(_at(_wind(), east, north, up, seconds))
    assert 4 - 1e-9 <= speed <= 20 + 1e-9


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"latitudes": np.array([66.0, 65.0, 64.0])}, "latitudes have to be finite and ascend"),
        ({"times": np.array([0.0, 0.0])}, "times have to be finite and ascend"),
        ({"u": np.full((2, 2, 3, 3), np.nan)}, "u are not finite"),
        ({"v": np.zeros((2, 2, 3, 4))}, r"v have the shape \(2, 2, 3, 4\)"),
        ({"heights": np.array([200.0, 100.0])}, "do not ascend in every column"),
    ],
)
def test_what_does_not_fit_is_refused(changes: dict[str, object], message: str) -> None:
    with pytest.raises(WindError, match=message):
        _wind(**changes)
