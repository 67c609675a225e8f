"""Whole missions over real terrain in real forecasts, with the heights read back by rasterio alone."""

from __future__ import annotations

from itertools import pairwise
from pathlib import Path

import netCDF4
import numpy as np
import pytest
import rasterio
from rasterio.warp import transform

import gcs_windplan as gw
from gcs_windplan.jobs.requests import read_request
from gcs_windplan.planning.planner import PlannedRoute, plan_route

half_a_decimetre_per_second = 0.05

DAVOS = """\
name: davos
vehicle: {{airspeed: 15 m/s, climb: 4 m/s, descent: 3 m/s}}
terrain: {{dem: {data}/dem/davosdorf.tif}}
wind: {{forecast: {data}/wind/bella_lui_weather_data_ERA5.nc}}
start: {{latitude: 46.803, longitude: 9.845}}
goal: {{latitude: 46.834, longitude: 9.812}}
clearance: 40 m
limits: {{max_height: 150 m}}
graph: {{uniform: {{spacing: 60 m}}}}
departure: {departure}
"""
CANBERRA = """\
name: cmac
vehicle: {{airspeed: 12 m/s}}
terrain: {{dem: {data}/dem/S36E149.hgt.zip}}
wind: {{constant: {{speed: 5 m/s, from: 300 deg}}, profile: {{law: power, exponent: 0.16}}}}
start: {{latitude: -35.363262, longitude: 149.165237}}
goal: {{latitude: -35.30, longitude: 149.22}}
clearance: 40 m
limits: {{max_height: 120 m}}
"""
BUTTE = """\
name: butte
vehicle: {{airspeed: 16 m/s, autopilot: px4}}
terrain: {{dem: {data}/dem/big_butte.tif}}
wind: {{forecast: {data}/wind/ndfd_20170603T1800.nc, profile: {{law: log, roughness: 0.1 m}}}}
start: {{latitude: 43.36, longitude: -113.08}}
goal: {{latitude: 43.43, longitude: -112.97}}
clearance: 50 m
limits: {{max_height: 150 m}}
departure: 2017-06-03T19:00Z
"""


def plan(tmp_path: Path, text: str, **values) -> PlannedRoute:
    path = tmp_path / "mission.yaml"
    path.write_text(text.format(**values))
    return plan_route(read_request(path))


def pixel_heights(dem: Path, latitudes, longitudes) -> np.ndarray:
    """The heights of the pixels under places, nearest neighbour, by rasterio."""
    name = f"zip://{dem}!{dem.name[:-4].replace('.hgt', '')}.hgt" if dem.suffix == ".zip" else dem
    with rasterio.open(name) as file:
        x, y = transform("EPSG:4326", file.crs, longitudes, latitudes)
        return np.array([value[0] for value in file.sample(zip(x, y, strict=True))], dtype=float)


@pytest.mark.parametrize(
    ("text", "dem", "slope"),
    [(DAVOS, "davosdorf.tif", 12.0), (CANBERRA, "S36E149.hgt.zip", 40.0), (BUTTE, "big_butte.tif", 25.0)],
    ids=["davos", "canberra", "butte"],
)
def test_routes_over_real_ground(text, dem, slope, shared_data, tmp_path):
    """Along each leg the height over the nearest pixel stays in the limits, but for a cell's own slope [m]."""
    found = plan(tmp_path, text, data=shared_data, departure="2020-02-22T12:00Z")
    request = found.request
    corners = np.array([(w.east, w.north, w.altitude) for w in found.waypoints])
    share = np.linspace(0, 1, 200)[:, None]
    points = np.concatenate([a + share * (b - a) for a, b in pairwise(corners)])
    latitudes, longitudes = request.scene.frame.to_geographic(points)
    above = points[:, 2] - pixel_heights(shared_data / "dem" / dem, latitudes, longitudes)
    assert above.min() >= request.clearance - slope
    assert above.max() <= request.max_height + slope
    assert found.totals.clearance >= request.clearance - 1e-6
    assert found.totals.height <= request.max_height + 1e-6


def test_a_departure_outside_the_forecast_is_an_error(shared_data, tmp_path):
    with pytest.raises(gw.InputError, match=r"mission\.yaml:4:\d+: wind: .*bella_lui"):
        plan(tmp_path, DAVOS, data=shared_data, departure="2020-02-25T12:00Z")


def test_over_davos_the_wind_of_each_leg_is_era5s(shared_data, tmp_path):
    """The wind in the middle of every leg, by netCDF4 and numpy alone, linear along every axis."""
    found = plan(tmp_path, DAVOS, data=shared_data, departure="2020-02-22T08:00Z")
    with netCDF4.Dataset(shared_data / "wind" / "bella_lui_weather_data_ERA5.nc") as file:
        winds = {name: np.asarray(file[name][:]) for name in ("u", "v", "z")}
        latitudes, longitudes, hours = (np.asarray(file[name][:]) for name in ("latitude", "longitude", "time"))
    hours = hours - hours[0]  # since 2020-02-22 00:00 UTC
    for leg, a, b in zip(found.legs, found.waypoints[:-1], found.waypoints[1:], strict=True):
        when = 8.0 + (a.seconds + b.seconds) / 7200
        place = ((a.point.latitude_deg + b.point.latitude_deg) / 2, (a.point.longitude_deg + b.point.longitude_deg) / 2)
        u, v = _at(winds, hours, latitudes, longitudes, when, *place, (a.altitude + b.altitude) / 2)
        track = np.radians(leg.track_deg)
        assert leg.wind_along == pytest.approx(u * np.sin(track) + v * np.cos(track), abs=half_a_decimetre_per_second)
        assert leg.wind_across == pytest.approx(u * np.cos(track) - v * np.sin(track), abs=half_a_decimetre_per_second)


def _at(winds, hours, latitudes, longitudes, when, latitude, longitude, height):
    """u and v, one axis after the other, height first."""

    def in_column(name, t, y, x):
        heights = winds["z"][t, :, y, x] / 9.80665
        order = np.argsort(heights)
        return np.interp(height, heights[order], winds[name][t, order, y, x])

    def weights(axis, value):
        order = np.argsort(axis)
        return {int(i): w for i, w in zip(order, _shares(axis[order], value), strict=True) if w}

    return [
        sum(
            wt * wy * wx * in_column(name, t, y, x)
            for t, wt in weights(hours, when).items()
            for y, wy in weights(latitudes, latitude).items()
            for x, wx in weights(longitudes, longitude).items()
        )
        for name in ("u", "v")
    ]


def _shares(axis, value):
    return [float(np.interp(value, axis, row)) for row in np.eye(len(axis))]


def test_over_the_big_butte_ten_metre_winds_are_carried_up_by_the_law(shared_data, tmp_path):
    found = plan(tmp_path, BUTTE, data=shared_data)
    request = found.request
    ground = np.array([[w.east, w.north, 0.0] for w in found.waypoints])
    ground[:, 2] = request.scene.terrain.heights_at(ground)
    low, high = (request.scene.wind.at(ground + np.array([0.0, 0.0, height])) for height in (10.0, 100.0))
    np.testing.assert_allclose(high, low * np.log(1000) / np.log(100), atol=1e-9)
    assert np.hypot(low[:, 0], low[:, 1]).min() > 0.5
