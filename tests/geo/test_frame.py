"""The local frame against PROJ's azimuthal equidistant projection and GeographicLib's geodesics."""

from __future__ import annotations

import numpy as np
import pytest
from geographiclib.geodesic import Geodesic
from hypothesis import given
from hypothesis import strategies as st
from rasterio.warp import transform as warp

from gcs_windplan.errors import InputError
from gcs_windplan.geo.frame import GeoPoint, LocalFrame, rotate

LATITUDES = [0.0, 36.0, -35.0, 65.0, 80.0]
two_millimetres = 2e-3
two_centimetres = 2e-2
one_millimetre = 1e-3
half_a_metre = 0.5
widest_scale = (50 / 6335) ** 2 / 6  # 6335 km: the least radius of curvature of WGS 84
ten_micrometres = 1e-5


def ring(radius: float, count: int = 72) -> np.ndarray:
    bearing = np.linspace(0, 2 * np.pi, count, endpoint=False)
    return radius * np.stack([np.sin(bearing), np.cos(bearing)], axis=-1)


def aeqd(origin: GeoPoint) -> str:
    return f"+proj=aeqd +lat_0={origin.latitude_deg} +lon_0={origin.longitude_deg} +datum=WGS84 +units=m +no_defs"


def by_proj(origin: GeoPoint, latitude: np.ndarray, longitude: np.ndarray) -> np.ndarray:
    return np.stack(warp("EPSG:4326", aeqd(origin), longitude.tolist(), latitude.tolist()), axis=-1)


@pytest.mark.parametrize("latitude", LATITUDES)
@pytest.mark.parametrize(
    ("radius", "tolerance"), [(1_000, two_millimetres), (50_000, two_millimetres), (100_000, two_centimetres)]
)
def test_places_equal_projs(latitude, radius, tolerance):
    origin = GeoPoint(latitude, 11.5)
    x, y = ring(radius).T
    longitude, lat = (np.array(a) for a in warp(aeqd(origin), "EPSG:4326", x.tolist(), y.tolist()))
    places = LocalFrame(origin).to_local(lat, longitude)
    assert np.hypot(*(places - ring(radius)).T).max() < tolerance


@pytest.mark.parametrize("latitude", LATITUDES)
def test_distance_and_bearing_from_the_origin_are_true(latitude):
    origin = GeoPoint(latitude, -70.0)
    lat, longitude = LocalFrame(origin).to_geographic(ring(50_000))
    for k, bearing in enumerate(np.linspace(0, 360, 72, endpoint=False)):
        geodesic = Geodesic.WGS84.Inverse(latitude, -70.0, lat[k], longitude[k])
        assert geodesic["s12"] == pytest.approx(50_000, abs=two_millimetres)
        off = (geodesic["azi1"] - bearing + 180) % 360 - 180
        assert abs(np.radians(off)) * 50_000 < two_millimetres


@pytest.mark.parametrize("latitude", LATITUDES)
def test_distances_between_places_within_50_km_are_off_by_less_than_half_a_metre(latitude):
    """Across the bearing the scale is c / sin c at an angle c from the origin: 1 + c²/6, 1.04e-5 at 50 km."""
    rng = np.random.default_rng(int(latitude) + 100)
    frame = LocalFrame(GeoPoint(latitude, 20.0))
    radius, bearing = 50_000 * np.sqrt(rng.uniform(0, 1, 600)), rng.uniform(0, 2 * np.pi, 600)
    bearing[401::2] = bearing[400::2] + rng.uniform(0.01, 0.1, 100)  # neighbours, one beside the other
    places = radius[:, None] * np.stack([np.sin(bearing), np.cos(bearing)], axis=-1)
    lat, longitude = frame.to_geographic(places)
    for a, b in zip(range(0, 600, 2), range(1, 600, 2), strict=True):
        true = Geodesic.WGS84.Inverse(lat[a], longitude[a], lat[b], longitude[b])["s12"]
        excess = np.hypot(*(places[b] - places[a])) - true
        assert -one_millimetre < excess < min(half_a_metre, widest_scale * true + one_millimetre)


@pytest.mark.parametrize("latitude", LATITUDES)
def test_convergence_equals_projs(latitude):
    """The grid bearing of a short step along the meridian, in PROJ's projection."""
    origin = GeoPoint(latitude, 0.0)
    frame, places = LocalFrame(origin), ring(50_000)
    lat, longitude = frame.to_geographic(places)
    step = by_proj(origin, lat + 1e-3, longitude) - by_proj(origin, lat - 1e-3, longitude)
    expected = -np.arctan2(step[:, 0], step[:, 1])
    np.testing.assert_allclose(frame.convergence(places), expected, atol=1e-6)


def test_convergence_is_one_degree_at_65_degrees_latitude_50_km_east():
    """About sin(latitude) times the difference of longitude; grid north lies clockwise of true north in the east."""
    frame, place = LocalFrame(GeoPoint(65.0, 0.0)), np.array([[50_000.0, 0.0]])
    (longitude,) = frame.to_geographic(place)[1]
    (convergence,) = frame.convergence(place)
    assert np.degrees(convergence) == pytest.approx(0.96, abs=0.01)
    assert convergence == pytest.approx(np.radians(longitude) * np.sin(np.radians(65.0)), rel=0.01)


@given(
    latitude=st.floats(-84, 84),
    longitude=st.floats(-180, 180),
    east=st.floats(-100_000, 100_000),
    north=st.floats(-100_000, 100_000),
)
def test_there_and_back(latitude, longitude, east, north):
    frame, place = LocalFrame(GeoPoint(latitude, longitude)), np.array([[east, north]])
    lat, lon = frame.to_geographic(place)
    assert -180 <= lon[0] <= 180
    np.testing.assert_allclose(frame.to_local(lat, lon), place, atol=ten_micrometres)


@given(latitude=st.floats(-70, 70), beyond=st.floats(0, 0.5), offset=st.floats(-0.5, 0.5), north=st.floats(-0.5, 0.5))
def test_across_the_antimeridian_nothing_changes(latitude, beyond, offset, north):
    here = LocalFrame(GeoPoint(latitude, 180.0 - beyond))
    away = LocalFrame(GeoPoint(latitude, 0.0))
    longitude = (180.0 - beyond + offset + 180.0) % 360.0 - 180.0
    np.testing.assert_allclose(
        here.to_local(latitude + north, longitude), away.to_local(latitude + north, offset), atol=ten_micrometres
    )


def test_the_origin_is_zero_and_comes_back():
    frame = LocalFrame(GeoPoint(47.0, 8.0))
    assert frame.to_local(47.0, 8.0).tolist() == [[0.0, 0.0]]
    lat, lon = frame.to_geographic(np.zeros((1, 3)))
    assert (lat[0], lon[0]) == (pytest.approx(47.0), pytest.approx(8.0))


def test_too_far_away_is_refused():
    with pytest.raises(InputError, match="2000 km"):
        LocalFrame(GeoPoint(0, 0)).to_geographic(np.array([[2e6, 0.0]]))


@pytest.mark.parametrize("point", [(91, 0), (0, 181), (float("nan"), 0)])
def test_what_is_no_place_is_refused(point):
    with pytest.raises(InputError, match="not between"):
        GeoPoint(*point)


@given(angle=st.floats(-10, 10))
def test_rotating_and_back(angle):
    vectors = np.array([[1.0, 2.0, 3.0], [-4.0, 5.0, 6.0]])
    np.testing.assert_allclose(rotate(rotate(vectors, angle), -angle), vectors, atol=1e-12)


def test_rotating_is_clockwise():
    np.testing.assert_allclose(rotate(np.array([[0.0, 1.0]]), np.pi / 2), [[1.0, 0.0]], atol=1e-15)
