"""Projected grids against formulas that were written down from Snyder 1987 (USGS Professional Paper 1395)."""

from __future__ import annotations

from collections.abc import Callable
from math import asin, atan2, cos, degrees, hypot, log, pi, radians, sin, sqrt, tan
from pathlib import Path
from typing import Any

import netCDF4
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from gcs_windplan.arrays import FloatArray
from gcs_windplan.errors import WindError
from gcs_windplan.wind.files.cf import Variable
from gcs_windplan.wind.files.netcdf import open_netcdf
from gcs_windplan.wind.files.projection import unprojected

NDFD = Path(__file__).resolve().parents[3].parent / "shared" / "data" / "wind" / "ndfd_20170603T1800.nc"
ONE_METRE = 1e-5  # [deg]
R = 6371200.0  # [m]

Forward = Callable[[float, float], tuple[float, float]]


def _mapping(name: str, **attributes: Any) -> Variable:
    return Variable("crs", (), (), {"grid_mapping_name": name, "earth_radius": R, **attributes})


def _half(latitude: float) -> float:
    return tan(pi / 4 + latitude / 2)


def _lambert(first: float, second: float, origin: float, centre: float) -> Forward:
    """Equations 15-1 to 15-5."""
    one, two, zero = radians(first), radians(second), radians(origin)
    n = sin(one) if first == second else log(cos(one) / cos(two)) / log(_half(two) / _half(one))
    f = cos(one) * _half(one) ** n / n

    def forward(latitude: float, longitude: float) -> tuple[float, float]:
        rho, rho0 = R * f / _half(latitude) ** n, R * f / _half(zero) ** n
        theta = n * (longitude - radians(centre))
        return rho * sin(theta), rho0 - rho * cos(theta)

    return forward


def _albers(first: float, second: float, origin: float, centre: float) -> Forward:
    """Equations 14-1 to 14-6."""
    one, two, zero = radians(first), radians(second), radians(origin)
    n = (sin(one) + sin(two)) / 2
    c = cos(one) ** 2 + 2 * n * sin(one)

    def forward(latitude: float, longitude: float) -> tuple[float, float]:
        rho, rho0 = (R * sqrt(c - 2 * n * sin(at)) / n for at in (latitude, zero))
        theta = n * (longitude - radians(centre))
        return rho * sin(theta), rho0 - rho * cos(theta)

    return forward


def _polar(true_scale: float, centre: float, south: bool = False) -> Forward:
    """Equations 21-5 to 21-10, true to scale at a parallel (21-7 solved for k0)."""
    sign = -1 if south else 1

    def forward(latitude: float, longitude: float) -> tuple[float, float]:
        rho = R * (1 + sin(radians(abs(true_scale)))) * tan(pi / 4 - sign * latitude / 2)
        turn = longitude - radians(centre)
        return rho * sin(turn), -sign * rho * cos(turn)

    return forward


def _mercator(true_scale: float, centre: float) -> Forward:
    """Equations 7-1 and 7-2."""
    scale = cos(radians(true_scale))
    return lambda latitude, longitude: (R * scale * (longitude - radians(centre)), R * scale * log(_half(latitude)))


def _azimuthal(origin: float, centre: float) -> Forward:
    """Equations 24-2, 22-4 and 22-5."""
    zero = radians(origin)

    def forward(latitude: float, longitude: float) -> tuple[float, float]:
        turn = longitude - radians(centre)
        k = sqrt(2 / (1 + sin(zero) * sin(latitude) + cos(zero) * cos(latitude) * cos(turn)))
        north = cos(zero) * sin(latitude) - sin(zero) * cos(latitude) * cos(turn)
        return R * k * cos(latitude) * sin(turn), R * k * north

    return forward


def _rotated(pole_latitude: float, pole_longitude: float) -> Forward:
    """Degrees on a sphere whose axis goes through a pole elsewhere: spherical trigonometry (5-7, 5-8b)."""
    pole = radians(pole_latitude)

    def forward(latitude: float, longitude: float) -> tuple[float, float]:
        turn = longitude - radians(pole_longitude)
        height = sin(pole) * sin(latitude) + cos(pole) * cos(latitude) * cos(turn)
        east = -cos(latitude) * sin(turn)
        towards = cos(pole) * sin(latitude) - sin(pole) * cos(latitude) * cos(turn)
        return degrees(atan2(east, towards)), degrees(asin(height))

    return forward


LAMBERT = {"latitude_of_projection_origin": 63.3, "longitude_of_central_meridian": 15.0}
CASES = {
    "Lambert, one parallel": (
        _mapping("lambert_conformal_conic", standard_parallel=63.3, **LAMBERT), _lambert(63.3, 63.3, 63.3, 15.0)),
    "Lambert, two parallels": (
        _mapping("lambert_conformal_conic", standard_parallel=[40.0, 60.0], **LAMBERT), _lambert(40, 60, 63.3, 15.0)),
    "Albers": (
        _mapping("albers_conical_equal_area", standard_parallel=np.array([40.0, 60.0], np.float32), **LAMBERT),
        _albers(40, 60, 63.3, 15.0)),
    "north pole": (
        _mapping("polar_stereographic", latitude_of_projection_origin=90.0, standard_parallel=60.0,
                 straight_vertical_longitude_from_pole=-45.0), _polar(60, -45)),
    "south pole": (
        _mapping("polar_stereographic", latitude_of_projection_origin=-90.0, standard_parallel=-71.0,
                 straight_vertical_longitude_from_pole=10.0), _polar(71, 10, south=True)),
    "Mercator": (
        _mapping("mercator", longitude_of_projection_origin=5.0, standard_parallel=20.0), _mercator(20, 5)),
    "Lambert, equal area": (
        _mapping("lambert_azimuthal_equal_area", latitude_of_projection_origin=52.0,
                 longitude_of_projection_origin=10.0), _azimuthal(52, 10)),
    "rotated": (
        _mapping("rotated_latitude_longitude", grid_north_pole_latitude=40.0, grid_north_pole_longitude=-170.0),
        _rotated(40, -170)),
}  # fmt: skip


@pytest.mark.parametrize("case", CASES)
@settings(max_examples=15)
@given(latitude=st.floats(-60, 80), east=st.floats(-80, 80))
def test_places_come_back_from_formulas(case: str, latitude: float, east: float) -> None:
    mapping, forward = CASES[case]
    if case == "south pole":
        latitude = -abs(latitude) - 10
    elif case != "Mercator":
        latitude = abs(latitude)
    longitude = 10.0 + east
    x, y = forward(radians(latitude), radians(longitude))
    units = ("degrees",) * 2 if case == "rotated" else ("m",) * 2
    found = unprojected(np.array([x]), np.array([y]), mapping, units)
    assert found[0].shape == (1, 1)
    assert float(found[0][0, 0]) == pytest.approx(latitude, abs=ONE_METRE)
    turn = (float(found[1][0, 0]) - longitude + 180) % 360 - 180
    assert turn * cos(radians(latitude)) == pytest.approx(0, abs=ONE_METRE)


def _inverse_lambert(x: FloatArray, y: FloatArray, parallel: float, centre: float) -> tuple[FloatArray, FloatArray]:
    """Equations 15-8 to 15-11 of a cone that touches at the origin's latitude."""
    phi = radians(parallel)
    n, f = sin(phi), cos(phi) * _half(phi) ** sin(phi) / sin(phi)
    rho0 = R * f / _half(phi) ** n
    rho, theta = np.hypot(x, rho0 - y), np.arctan2(x, rho0 - y)
    return np.degrees(2 * np.arctan((R * f / rho) ** (1 / n)) - pi / 2), np.degrees(theta / n) + centre


def test_all_nodes_of_the_real_ndfd_file_stand_where_snyder_puts_them() -> None:
    """A sphere of 6371.2 km, kilometres, and the corners that the file's own attributes tell."""
    if not NDFD.exists():
        pytest.skip("the shared test data are missing")
    with open_netcdf(NDFD) as index:
        grid = index.fields[0].grid
    with netCDF4.Dataset(NDFD) as file:
        x, y = (np.asarray(file[axis][:], dtype=np.float64) * 1000 for axis in ("x", "y"))
        bounds = [float(file.getncattr(f"geospatial_{end}")) for end in ("lat_min", "lat_max", "lon_min", "lon_max")]
    assert (grid.shape, grid.regular) == ((106, 83), False)
    latitudes, longitudes = _inverse_lambert(*np.meshgrid(x, y), 25.0, -95.0)
    np.testing.assert_allclose(grid.latitudes, latitudes, atol=ONE_METRE)
    np.testing.assert_allclose(grid.longitudes, longitudes, atol=ONE_METRE)
    ends = [grid.latitudes.min(), grid.latitudes.max(), grid.longitudes.min(), grid.longitudes.max()]
    np.testing.assert_allclose(ends, bounds, atol=0.05)


def test_false_origins_are_in_the_units_of_the_axes() -> None:
    mapping, forward = CASES["Lambert, one parallel"]
    x, y = forward(radians(60.0), radians(10.0))
    moved = Variable("crs", (), (), {**mapping.attributes, "false_easting": 500.0, "false_northing": -200.0})
    found = unprojected(np.array([x / 1000 + 500]), np.array([y / 1000 - 200]), moved, ("km", "km"))
    np.testing.assert_allclose([found[0][0, 0], found[1][0, 0]], [60.0, 10.0], atol=ONE_METRE)


@pytest.mark.parametrize(
    ("earth", "radius"),
    [
        ({}, 6371229.0),
        ({"semi_major_axis": 6371000.0}, 6371000.0),
        ({"semi_major_axis": 6370000.0, "inverse_flattening": 0.0}, 6370000.0),
        ({"semi_major_axis": 6370000.0, "semi_minor_axis": 6370000.0}, 6370000.0),
    ],
)
def test_the_sphere_is_the_mappings_own(earth: dict[str, float], radius: float) -> None:
    said = {"grid_mapping_name": "mercator", "longitude_of_projection_origin": 0.0, **earth}
    found = unprojected(np.array([radius * 0.1]), np.array([0.0]), Variable("crs", (), (), said), ("m", "m"))
    assert float(found[1][0, 0]) == pytest.approx(degrees(0.1), abs=1e-9)


def test_an_ellipsoid_makes_no_shift_of_datum() -> None:
    """On the Clarke 1866 ellipsoid the equator's degrees are those of its own semi-major axis."""
    said = {
        "grid_mapping_name": "mercator", "longitude_of_projection_origin": 0.0,
        "semi_major_axis": 6378206.4, "inverse_flattening": 294.978698,
    }  # fmt: skip
    found = unprojected(np.array([637820.64]), np.array([0.0]), Variable("crs", (), (), said), ("m", "m"))
    assert hypot(float(found[0][0, 0]), float(found[1][0, 0]) - degrees(0.1)) == pytest.approx(0, abs=1e-9)


@pytest.mark.parametrize(
    ("changes", "units", "message"),
    [
        ({"grid_mapping_name": "geostationary"}, "m", r"grid mapping crs is 'geostationary'; known are albers"),
        ({"standard_parallel": "none"}, "m", "0 standard parallels"),
        ({"latitude_of_projection_origin": None}, "m", "crs has no latitude_of_projection_origin: set it"),
        ({}, "", "x has no units; set its attribute `units` to a height"),
        ({}, "degrees", "x is in 'degrees'"),
        ({"standard_parallel": [30.0, -30.0]}, "m", r"its grid mapping crs \(\+proj=lcc .* cannot be worked out"),
    ],
)
def test_mappings_that_cannot_be_used_are_explained(changes: dict[str, Any], units: str, message: str) -> None:
    said = {**CASES["Lambert, one parallel"][0].attributes, **changes}
    mapping = Variable("crs", (), (), {name: value for name, value in said.items() if value is not None})
    with pytest.raises(WindError, match=message):
        unprojected(np.array([0.0]), np.array([0.0]), mapping, (units, units))


def test_places_that_no_projection_reaches_are_refused() -> None:
    mapping = CASES["Lambert, equal area"][0]
    with pytest.raises(WindError, match=r"cannot be worked out|cannot reach"):
        unprojected(np.array([1.0, 9e7]), np.array([0.0]), mapping, ("m", "m"))
