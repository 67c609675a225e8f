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
from gcs_windplan.geo.frame import GeoPoint, LocalFrame, rotate
from gcs_windplan.kernels.interpolation import LOG, POWER, Columns, Law
from gcs_windplan.wind import GriddedWind
from gcs_windplan.wind.placement import LatLonPlacement

ONE_CM_PER_SECOND = 0.01
FRAME = LocalFrame(GeoPoint(65.0, 19.0))
EPOCH = 1.7e9  # [s since 1970] the departure of the tests


def _columns(**changes: object) -> Columns:
    """From the west at 10 m/s at 100 m, falling to 4 m/s two hours later; twice that at 200 m."""
    u = np.array([[10.0, 20.0], [4.0, 8.0]]).reshape(2, 1, 1, 2) * np.ones((2, 3, 3, 2))
    columns = Columns(
        winds=np.stack([u, 0 * u], axis=-1),
        above=np.empty(0),
        heights=np.array([100.0, 200.0]).reshape(1, 1, 1, 2),
        terrain=np.full((3, 3), -np.inf),
        roughness=np.full((3, 3), 0.1),
        times=EPOCH + np.array([0.0, 7200.0]),
        rows=np.array([64.0, 65.0, 66.0]),
        columns=np.array([17.0, 19.0, 21.0]),
    )
    return columns._replace(**changes)


def _wind(columns: Columns | None = None, **changes: object) -> GriddedWind:
    columns = _columns() if columns is None else columns
    wind = GriddedWind(
        name="made up",
        placement=LatLonPlacement(FRAME, columns.rows, columns.columns),
        columns=columns,
        law=Law(LOG, 0.0, 0.0),
        departure=EPOCH,
        window=(float(columns.times[0]), float(columns.times[-1])),
    )
    return replace(wind, **changes)  # type: ignore[arg-type]


def _above_ground() -> Columns:
    return _columns(above=np.array([100.0, 200.0]), heights=np.empty((2, 3, 3, 0)))


def _at(wind: GriddedWind, east: float, north: float, up: float, seconds: float = 0.0) -> FloatArray:
    result: FloatArray = wind.at(np.array([[east, north, up]]), seconds)[0]
    assert result[2] == 0
    return result


def test_it_is_linear_in_height_and_time() -> None:
    np.testing.assert_allclose(_at(_wind(), 0, 0, 150), [15, 0, 0], atol=ONE_CM_PER_SECOND)
    np.testing.assert_allclose(_at(_wind(), 0, 0, 150, 3600), [10.5, 0, 0], atol=ONE_CM_PER_SECOND)


def test_each_point_may_have_its_own_time() -> None:
    points = np.array([[0.0, 0.0, 150.0]] * 3)
    found = _wind().at(points, np.array([0.0, 3600.0, 7200.0]))
    np.testing.assert_allclose(found[:, 0], [15, 10.5, 6], atol=ONE_CM_PER_SECOND)


def test_times_count_from_the_departure() -> None:
    later = replace(_wind(), departure=EPOCH + 1800.0)
    np.testing.assert_allclose(later.times, [-1800, 5400])
    np.testing.assert_allclose(_at(later, 0, 0, 150, 1800.0), [10.5, 0, 0], atol=ONE_CM_PER_SECOND)


def test_true_components_are_turned_into_the_local_grid() -> None:
    """50 km east at 65° the convergence is about a degree: a true west wind also blows to grid north."""
    wind = _at(_wind(), 50_000, 0, 100)
    convergence = FRAME.convergence(np.array([[50_000.0, 0.0]]))
    np.testing.assert_allclose(wind[np.newaxis], rotate(np.array([[10.0, 0.0, 0.0]]), -convergence), atol=1e-6)
    assert wind[1] == pytest.approx(0.168, abs=ONE_CM_PER_SECOND)
    true = _wind().true_wind(np.array([[50_000.0, 0.0, 100.0]]))
    np.testing.assert_allclose(true, [[10.0, 0.0, 0.0]], atol=1e-9)


def test_other_values_on_the_same_grid_are_the_same_at_all_heights_and_nothing_below_the_ground() -> None:
    values = np.full((2, 3, 3, 2), [3.0, 4.0]) * np.array([1.0, 2.0])[:, np.newaxis, np.newaxis, np.newaxis]
    field = _wind(ground=lambda points: np.full(len(points), 50.0)).at_all_heights(values)
    points = np.array([[0.0, 0.0, height] for height in (51.0, 400.0, 9000.0, 49.0)])
    expected = [[4.5, 6.0, 0.0]] * 3 + [[0.0, 0.0, 0.0]]
    np.testing.assert_allclose(field.true_wind(points, 3600.0), expected, atol=ONE_CM_PER_SECOND)


def test_above_the_highest_level_it_is_not_known() -> None:
    assert np.isnan(_at(_wind(), 0, 0, 201)[:2]).all()
    np.testing.assert_allclose(_at(_wind(), 0, 0, 200.005), [20, 0, 0], atol=ONE_CM_PER_SECOND)


def test_below_the_lowest_level_a_law_leads_it_to_the_ground() -> None:
    """Over ground at 50 m the level at 100 m lies 50 m high; at 5 m a power law of 0.2 leaves (5 / 50) ** 0.2."""
    wind = _wind(ground=lambda points: np.full(len(points), 50.0), law=Law(POWER, 0.2, 0.0))
    np.testing.assert_allclose(_at(wind, 0, 0, 55), [10 * 0.1**0.2, 0, 0], atol=ONE_CM_PER_SECOND)
    np.testing.assert_allclose(_at(wind, 0, 0, 50), [0, 0, 0])
    assert np.isnan(_at(_wind(), 0, 0, 55)[:2]).all()  # nobody knows where the ground is


def test_levels_above_ground_follow_the_ground() -> None:
    wind = _wind(_above_ground(), ground=lambda points: 1000 + points[:, 0] / 10)
    np.testing.assert_allclose(_at(wind, 500, 0, 1200), [15, 0, 0], atol=ONE_CM_PER_SECOND)
    assert np.isnan(_at(wind, 500, 0, 1300)[:2]).all()


def test_over_unknown_ground_the_forecasts_own_counts() -> None:
    unknown = _wind(_above_ground(), ground=lambda points: np.full(len(points), np.nan))
    assert np.isnan(_at(unknown, 0, 0, 150)[:2]).all()
    own = replace(unknown, columns=_above_ground()._replace(terrain=np.full((3, 3), 30.0)))
    np.testing.assert_allclose(_at(own, 0, 0, 180), [15, 0, 0], atol=ONE_CM_PER_SECOND)


def test_outside_of_the_area_is_an_error_unless_extended() -> None:
    with pytest.raises(WindError, match=r"ends 1[01]\.\d km short of 66\.\d+.*extend: nearest"):
        _at(_wind(), 0, 122_000, 100)
    extended = _at(_wind(extend=True), 0, 122_000, 100)
    np.testing.assert_allclose(extended, [10, 0, 0], atol=ONE_CM_PER_SECOND)
    with pytest.raises(WindError, match=r"ends 1[23]\d\.\d km short"):  # more than one spacing
        _at(_wind(extend=True), 0, 240_000, 100)


def test_a_forecast_for_one_place_reaches_15_km() -> None:
    one = _columns(
        winds=_columns().winds[:, :1, :1], terrain=np.full((1, 1), -np.inf), roughness=np.full((1, 1), 0.1),
        rows=np.array([65.0]), columns=np.array([19.0]),
    )  # fmt: skip
    wind = _wind(one)
    np.testing.assert_allclose(_at(wind, 10_000, 10_000, 100)[0], 10, atol=ONE_CM_PER_SECOND)
    with pytest.raises(WindError, match=r"ends [45]\.\d km short of .* knows 65\.0000, 19\.0000 and 15 km around"):
        _at(wind, 0, 20_000, 100)


def test_outside_of_its_times_is_an_error_even_if_extended() -> None:
    with pytest.raises(WindError, match=r"3\.50 h after departure, 1\.50 h after its last"):
        _at(_wind(extend=True), 0, 0, 100, 3.5 * 3600)
    with pytest.raises(WindError, match=r"0\.50 h before its first"):
        _at(_wind(), 0, 0, 100, -1800)


def test_a_single_time_is_steady() -> None:
    still = _columns()
    one = still._replace(winds=still.winds[:1], times=still.times[:1])
    wind = _wind(one, window=(-math.inf, math.inf))
    assert _at(wind, 0, 0, 100, 1e7)[0] == pytest.approx(10)
    assert len(wind.times) == 0


def test_places_that_are_not_finite_are_refused() -> None:
    with pytest.raises(WindError, match="not finite"):
        _at(_wind(), math.nan, 0, 100)


def test_no_points_give_no_wind() -> None:
    assert _wind().at(np.empty((0, 3))).shape == (0, 3)


def test_many_points_are_the_same_as_few() -> None:
    random = np.random.default_rng(3)
    points = random.uniform((-80e3, -80e3, 100.0), (80e3, 80e3, 200.0), (60_000, 3))
    some = slice(50_000, 50_040)
    np.testing.assert_array_equal(_wind().at(points)[some], _wind().at(points[some]))


def test_the_resolution_is_half_the_smallest_spacing() -> None:
    """2° of longitude at 66° are 90.5 km, 1° of latitude 111.2 km; levels above the ground follow the ground."""
    assert _wind().resolution == pytest.approx(45_200, rel=0.01)
    assert _wind(_above_ground(), ground_resolution=30.0).resolution == 30.0
    assert _wind(ground_resolution=30.0).resolution == pytest.approx(45_200, rel=0.01)


@given(
    east=st.floats(-80_000, 80_000),
    north=st.floats(-80_000, 80_000),
    up=st.floats(100, 200),
    seconds=st.floats(0, 7200),
)
def test_the_wind_never_exceeds_the_values_of_the_grid(east: float, north: float, up: float, seconds: float) -> None:
    speed = np.linalg.norm(_at(_wind(), east, north, up, seconds))
    assert 4 - 1e-9 <= speed <= 20 + 1e-9


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"rows": np.array([66.0, 65.0, 64.0])}, "rows have to be finite and ascend"),
        ({"times": np.array([0.0, 0.0])}, "times have to be finite and ascend"),
        ({"winds": np.full((2, 3, 3, 2, 2), np.nan)}, "not finite everywhere"),
        ({"roughness": np.zeros((3, 3))}, "roughness length is not above 0"),
        ({"terrain": np.zeros((3, 4))}, r"terrain have the shape \(3, 4\), not \(3, 3\)"),
        ({"heights": np.array([200.0, 100.0]).reshape(1, 1, 1, 2)}, "do not ascend in every column"),
    ],
)
def test_what_does_not_fit_is_refused(changes: dict[str, object], message: str) -> None:
    with pytest.raises(WindError, match=message):
        _wind(_columns(**changes))
