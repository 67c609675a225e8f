"""Whole missions over real terrain in real forecasts, with the heights read back by rasterio alone."""

from __future__ import annotations

from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest
import rasterio
from rasterio.warp import transform

import gcs_windplan as gw

DAVOS = """\
name: davos
vehicle: {{airspeed: 15 m/s, climb: 4 m/s, descent: 3 m/s}}
terrain: {{dem: {data}/dem/davosdorf.tif}}
wind: {{netcdf: {data}/wind/bella_lui_weather_data_ERA5.nc}}
start: {{latitude: 46.803, longitude: 9.845}}
goal: {{latitude: 46.834, longitude: 9.812}}
clearance: 40 m
max_height: 150 m
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
max_height: 120 m
"""
BUTTE = """\
name: butte
vehicle: {{airspeed: 16 m/s, autopilot: px4}}
terrain: {{dem: {data}/dem/big_butte.tif}}
wind: {{constant: {{speed: 14 kt, from: 230 deg}}}}
start: {{latitude: 43.36, longitude: -113.08}}
goal: {{latitude: 43.43, longitude: -112.97}}
clearance: 50 m
max_height: 150 m
"""


def plan(tmp_path: Path, text: str, **values) -> gw.Plan:
    path = tmp_path / "mission.yaml"
    path.write_text(text.format(**values))
    return gw.plan_route(gw.read_mission(path))


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
    latitudes, longitudes = request.frame.to_geographic(points)
    above = points[:, 2] - pixel_heights(shared_data / "dem" / dem, latitudes, longitudes)
    assert above.min() >= request.clearance - slope
    assert above.max() <= request.max_height + slope
    assert found.totals.clearance >= request.clearance - 1e-6
    assert found.totals.height <= request.max_height + 1e-6


def test_a_departure_outside_the_forecast_is_an_error(shared_data, tmp_path):
    with pytest.raises(gw.InputError, match=r"mission\.yaml:4:\d+: wind: .*bella_lui"):
        plan(tmp_path, DAVOS, data=shared_data, departure="2020-02-25T12:00Z")
