"""The polynomial from local places to the globe."""

from __future__ import annotations

import numpy as np
import pytest

from gcs_windplan.errors import InputError
from gcs_windplan.geo.frame import GeoPoint, LocalFrame, rotate
from gcs_windplan.geo.inverse import InverseProjection, to_grid_north

ONE_CENTIMETRE = 0.01


@pytest.mark.parametrize("latitude", [-72.0, -35.0, 0.0, 46.8, 65.0])
def test_it_lies_within_a_centimetre_of_the_frame(latitude: float) -> None:
    frame = LocalFrame(GeoPoint(latitude, 179.9))
    places = np.random.default_rng(4).uniform(-100_000, 100_000, (2000, 2))
    found = InverseProjection(frame).at(places)
    back = frame.to_local(found[:, 0], found[:, 1])
    assert np.abs(back - places).max() < ONE_CENTIMETRE
    np.testing.assert_allclose(found[:, 2], frame.convergence(places), atol=1e-8)
    assert np.ptp(found[:, 1]) < 20  # runs on across the date line


@pytest.mark.parametrize("latitude", [46.8, 89.7])
def test_places_beyond_its_reach_and_near_a_pole_are_computed_exactly(latitude: float) -> None:
    frame = LocalFrame(GeoPoint(latitude, 10.0))
    places = np.array([[0.0, -150_000.0], [1000.0, 2000.0], [120_000.0, 0.0]])
    found = InverseProjection(frame).at(places)
    assert np.abs(frame.to_local(found[:, 0], found[:, 1]) - places).max() < ONE_CENTIMETRE


def test_true_winds_turn_back_by_the_convergence() -> None:
    wind = np.array([[0.0, 10.0, 0.0]])
    np.testing.assert_allclose(to_grid_north(wind, np.array([0.1])), rotate(wind, -0.1))
    assert to_grid_north(wind, np.array([0.1]))[0, 0] < 0  # grid north lies clockwise of true north


def test_a_reach_without_area_is_refused() -> None:
    with pytest.raises(InputError, match="no area"):
        InverseProjection(LocalFrame(GeoPoint(0.0, 0.0)), 0.0)
