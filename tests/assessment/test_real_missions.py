"""Real missions over real ground: every one judged or refused with the reason, and three checked by other means."""

from __future__ import annotations

import math
from collections import Counter
from pathlib import Path

import numpy as np
import pytest
import rasterio

from gcs_windplan.assessment import Assessment
from gcs_windplan.errors import InputError
from gcs_windplan.formats.geojson import format_geojson
from gcs_windplan.formats.kml import format_kml
from gcs_windplan.formats.legs_csv import format_legs_csv
from gcs_windplan.geo.frame import GeoPoint
from gcs_windplan.jobs.review import review as review_mission

five_centimetres = 0.05
one_percent = 0.01

#: What of the corpus is no mission that can be judged, by a part of the reason.
REFUSED = {
    "begins with '": 3,  # lists of fence points
    "nor any place": 2,  # a take-off alone, and camera commands alone, without home
    "lies 7988 km from": 1,  # home of another continent
    "holds no items": 1,  # a fence alone
    "without the simple items": 2,
    "is missing: the file is cut short": 1,
    "is 7, and only 2 is known": 1,
    "is 42, and only 1 is known": 1,
    "ends in none of": 3,
}


def judge(file: Path, *terrain: str, **more: str) -> Assessment:
    return review_mission(file, terrain=terrain, **more)


def test_every_real_mission_is_judged_or_refused_with_the_reason(shared_data):
    refused: Counter[str] = Counter()
    for file in sorted((shared_data / "missions").glob("*/*")):
        try:
            review = judge(file, "flat:584", wind=("8 m/s from 270",), max_height="120")
        except InputError as error:
            refused[next((part for part in REFUSED if part in str(error)), f"{file}: {error}")] += 1
            continue
        assert len(review.stops) == len(review.legs) + 1, file
        assert all(finding.message for finding in review.findings)
        assert np.isfinite(review.profile.distance).all()
        assert (np.diff(review.profile.seconds) >= -1e-6).all(), file
        for leg, start, end in zip(review.legs, review.stops, review.stops[1:], strict=False):
            assert leg.clearance <= min(start.above_ground, end.above_ground) + five_centimetres, (file, leg)
            assert leg.height >= max(start.above_ground, end.above_ground) - five_centimetres, (file, leg)
        for write in (format_kml, format_geojson, format_legs_csv):
            assert write(review)
    assert refused == REFUSED


class Srtm:
    """A tile of SRTM heights read by rasterio alone, each cell two triangles."""

    def __init__(self, tile: Path) -> None:
        with rasterio.open(f"/vsizip/{tile}/{tile.name.removesuffix('.zip')}") as file:
            self.heights, self.to_grid = file.read(1).astype(float), ~file.transform

    def at(self, latitudes: np.ndarray, longitudes: np.ndarray) -> np.ndarray:
        a, b, c, d, e, f = self.to_grid[:6]
        columns = a * longitudes + b * latitudes + c - 0.5
        rows = d * longitudes + e * latitudes + f - 0.5
        j, i = np.floor(columns).astype(int), np.floor(rows).astype(int)
        f, g = columns - j, rows - i
        corner, opposite = self.heights[i, j], self.heights[i + 1, j + 1]
        side = np.where(f >= g, self.heights[i, j + 1], self.heights[i + 1, j])
        return corner + np.maximum(f, g) * (side - corner) + np.minimum(f, g) * (opposite - side)


def rows_of(file: Path) -> list[list[float]]:
    lines = [line.split() for line in file.read_text().splitlines()]
    return [[float(cell) for cell in line] for line in lines if len(line) == 12 and line[0].isdigit()]


@pytest.mark.parametrize(
    "name",
    [
        "Generic_Missions__CMAC-copter-navtest.txt",
        "ArduPlane_Tests__AltitudeSlopeMaxHeight__rapid-descent-then-climb.txt",
        "ArduCopter_Tests__PAUSE_CONTINUE__copter_mission.txt",
    ],
)
def test_heights_of_legs_by_rasterio_and_dense_samples(shared_data, name):
    """Straight legs between waypoints above home, sampled along latitude and longitude by hand."""
    file = shared_data / "missions" / "ardupilot" / name
    tile = shared_data / "dem" / "S36E149.hgt.zip"
    review, ground, rows = judge(file, str(tile), clearance="30", max_height="120"), Srtm(tile), rows_of(file)
    home, checked = rows[0], 0
    for leg in review.legs:
        here, before = rows[leg.item], rows[leg.item - 1]
        if not (
            here[2] == before[2] == 3
            and here[3] == before[3] == 16
            and before[8]
            and here[8]
            and before[10]
            and here[10]
        ):
            continue
        start, end = (np.array([row[8], row[9], home[10] + row[10]]) for row in (before, here))
        places = start + np.linspace(0, 1, 20_001)[:, None] * (end - start)
        above = places[:, 2] - ground.at(places[:, 0], places[:, 1])
        assert leg.clearance == pytest.approx(above.min(), abs=five_centimetres)
        assert leg.height == pytest.approx(above.max(), abs=five_centimetres)
        told = {finding.rule: finding.value for finding in review.findings if finding.leg == leg.number}
        assert ("clearance" in told) == (above.min() < 30)
        assert ("height" in told) == (above.max() > 120)
        assert told.get("clearance", above.min()) == pytest.approx(above.min(), abs=five_centimetres)
        checked += 1
    assert checked >= 3


def test_the_triangle_of_a_real_leg(shared_data):
    """CMAC-circuit in 8 m/s of west wind, its first leg by the law of sines."""
    file = shared_data / "missions" / "ardupilot" / "Generic_Missions__CMAC-circuit.txt"
    tile = str(shared_data / "dem" / "S36E149.hgt.zip")
    review = judge(file, tile, wind=("4 m/s from 270",))
    leg = review.legs[1]
    angle = math.radians(leg.track_deg)
    along, across = 4 * math.sin(angle), 4 * math.cos(angle)
    assert (leg.wind_along, leg.wind_across) == pytest.approx((along, across), abs=0.01)
    crab = math.radians((leg.heading_deg - leg.track_deg + 180) % 360 - 180)
    ground = leg.airspeed * math.cos(crab) + along
    assert leg.airspeed * math.sin(crab) == pytest.approx(-across, rel=one_percent)
    assert ground == pytest.approx(leg.distance / leg.seconds, rel=0.05), "but for speeding up and slowing down"
    assert next(one for one in review.findings if one.rule == "home").value == pytest.approx(650 - 584.05, abs=0.05)


def test_a_mission_in_a_real_forecast(shared_data, tmp_path):
    """Davos in ERA5 of 2020-02-22: the wind is the one that the forecast's own report tells."""
    from gcs_windplan.wind.inspect.sounding import HeightAsked, take_sounding
    from gcs_windplan.wind.reading import open_indexes

    file = tmp_path / "davos.waypoints"
    rows = [
        "QGC WPL 110",
        "0\t1\t0\t16\t0\t0\t0\t0\t46.8134380\t9.8437720\t1560.0\t1",
        "1\t0\t3\t22\t0\t0\t0\t0\t46.8134380\t9.8437720\t700.0\t1",
        "2\t0\t3\t16\t0\t0\t0\t0\t46.8204380\t9.8337720\t700.0\t1",
        "",
    ]
    file.write_text("\n".join(rows))
    era5 = shared_data / "wind" / "bella_lui_weather_data_ERA5.nc"
    review = judge(file, str(shared_data / "dem" / "davosdorf.tif"), wind=(str(era5),), departure="2020-02-22T08:00Z")
    middle = np.argmin(np.abs(review.profile.distance - review.legs[0].distance / 2))
    point = GeoPoint(float(review.profile.latitude_deg[middle]), float(review.profile.longitude_deg[middle]))
    moment = review.departure.timestamp() + review.profile.seconds[middle]
    with open_indexes([era5]) as indexes:
        found = take_sounding(indexes, point, moment, None, HeightAsked(2260.0)).at_height
    assert found is not None
    here = (review.profile.wind_east[middle], review.profile.wind_north[middle])
    assert here == pytest.approx(tuple(found.winds[0]), abs=0.05)
