"""GeoJSON of judged missions, read back by GEOS and by the rules of RFC 7946."""

from __future__ import annotations

import json
import math
from collections.abc import Iterator
from dataclasses import replace

import numpy as np
import pytest
import shapely

from gcs_windplan.assessment import Assessment
from gcs_windplan.formats.geojson import format_geojson, on_earth
from gcs_windplan.geo.frame import GeoPoint, LocalFrame
from gcs_windplan.mission import Command
from gcs_windplan.wind import ConstantWind
from tests.assessment.cases import FRAME, TERRAIN, at, judged, ridge
from tests.formats.test_kml import REVIEW

a_centimetre_in_degrees = 1.5e-7
TWELVE_DIGITS = 1e-11


def features(review, kind: str) -> list[dict]:
    collection = json.loads(format_geojson(review))
    assert collection["type"] == "FeatureCollection"
    return [one for one in collection["features"] if one["properties"]["kind"] == kind]


def test_legs_carry_their_figures():
    legs = features(REVIEW, "leg")
    assert [one["properties"]["number"] for one in legs] == [leg.number for leg in REVIEW.legs]
    for one, leg in zip(legs, REVIEW.legs, strict=True):
        told = one["properties"]
        assert told["clearance"] == pytest.approx(leg.clearance, rel=TWELVE_DIGITS)
        assert told["ground_speed"] == pytest.approx(leg.ground_speed, rel=TWELVE_DIGITS)
        assert told["vertical_datum"] == REVIEW.vertical_datum
        line = one["geometry"]["coordinates"]
        start, end = REVIEW.stops[leg.number - 1], REVIEW.stops[leg.number]
        assert line[0] == pytest.approx([start.longitude_deg, start.latitude_deg, start.altitude], abs=0.01)
        assert line[-1] == pytest.approx([end.longitude_deg, end.latitude_deg, end.altitude], abs=0.01)
        assert all(len(place) == 3 for place in line)


def test_geos_reads_every_geometry():
    collection = json.loads(format_geojson(REVIEW))
    for one in collection["features"]:
        shape = shapely.from_geojson(json.dumps(one["geometry"]))
        assert shape.is_valid
        assert -180 <= shape.bounds[0] <= shape.bounds[2] <= 180


def test_rings_run_counter_clockwise_and_close():
    """RFC 7946, section 3.1.6."""
    (area,) = features(REVIEW, "area")
    ring = area["geometry"]["coordinates"][0]
    assert ring[0] == ring[-1]
    assert shapely.LinearRing(ring).is_ccw
    assert area["properties"]["ceiling"] == 900.0


def test_findings_and_stops_are_points():
    assert len(features(REVIEW, "stop")) == len(REVIEW.stops)
    found = features(REVIEW, "finding")
    assert [one["properties"]["message"] for one in found] == [one.message for one in REVIEW.findings]
    assert found[0]["geometry"]["coordinates"] == pytest.approx(
        [REVIEW.findings[0].longitude_deg, REVIEW.findings[0].latitude_deg], abs=a_centimetre_in_degrees
    )
    assert len(features(REVIEW, "rally")) == 1


def test_curves_have_their_bends():
    over = judged(at(400, 0, 80, frame=TERRAIN), at(1600, 0, 80, frame=TERRAIN), terrain=ridge())
    line = features(over, "leg")[1]["geometry"]["coordinates"]
    assert max(height for _, _, height in line) > 630
    spline = judged(at(0, 300), at(300, 300, 80, command=Command.NAV_SPLINE_WAYPOINT), at(300, 900))
    shape = shapely.from_geojson(json.dumps(features(spline, "leg")[1]["geometry"]))
    straight = math.dist(shape.coords[0][:2], shape.coords[-1][:2])
    assert shape.length > 1.05 * straight


def test_what_is_infinite_or_unknown_is_null():
    review = judged(at(0, 3000), at(0, 5000), wind=ConstantWind(0.0, -25.0))
    legs = features(review, "leg")
    assert legs[0]["properties"]["seconds"] is None
    assert legs[1]["properties"]["clearance"] is None


def elsewhere(east: float = 0.0, north: float = 0.0) -> Assessment:
    """The review turned by degrees about the earth; what goes beyond the antimeridian is written as a frame does."""

    def turned(longitude):
        return (longitude + east + 180) % 360 - 180

    profile = REVIEW.profile
    origin = GeoPoint(min(90.0, FRAME.origin.latitude_deg + north), float(turned(FRAME.origin.longitude_deg)))
    return replace(
        REVIEW,
        frame=LocalFrame(origin),
        profile=replace(
            profile, longitude_deg=turned(profile.longitude_deg), latitude_deg=profile.latitude_deg + north
        ),
        stops=tuple(
            replace(stop, longitude_deg=turned(stop.longitude_deg), latitude_deg=stop.latitude_deg + north)
            for stop in REVIEW.stops
        ),
        findings=(),
        rally=(),
        **({"outlines": ()} if north else {}),
    )


def places_of(coordinates: list) -> Iterator[list[float]]:
    if isinstance(coordinates[0], float | int):
        yield coordinates
    else:
        for one in coordinates:
            yield from places_of(one)


def on_earth_alone(text: str) -> bool:
    geometries = [one["geometry"] for one in json.loads(text)["features"]]
    places = [place for one in geometries if one for place in places_of(one["coordinates"])]
    return all(-180 <= x <= 180 and -90 <= y <= 90 for x, y, *_ in places)


def test_what_crosses_the_antimeridian_is_cut_there():
    """RFC 7946, section 3.1.9."""
    shift = 180 - FRAME.origin.longitude_deg
    middle = elsewhere(shift - 0.009)  # the ridge is 1 km to the east, the area from 500 to 900 m
    assert on_earth_alone(format_geojson(middle))
    legs = features(middle, "leg")
    cut = [one["geometry"] for one in legs if one["geometry"]["type"] == "MultiLineString"]
    assert cut
    for one in cut:
        first, second = one["coordinates"]
        assert first[-1][1:] == second[0][1:]
        assert {first[-1][0], second[0][0]} == {180.0, -180.0}
    for one in legs:
        lines = [one["geometry"]["coordinates"]] if one["geometry"]["type"] == "LineString" else None
        for line in lines or one["geometry"]["coordinates"]:
            assert np.ptp([place[0] for place in line]) < 1
    (area,) = features(middle, "area")
    assert area["geometry"]["type"] == "MultiPolygon"
    whole = shapely.from_geojson(json.dumps(features(REVIEW, "area")[0]["geometry"]))
    shapes = shapely.from_geojson(json.dumps(area["geometry"]))
    assert shapes.is_valid
    assert all(part.exterior.is_ccw for part in shapes.geoms)
    assert shapes.area == pytest.approx(whole.area, rel=1e-3)


def test_a_line_that_ends_at_the_antimeridian_is_whole():
    line = [(179.99, 10.0), (-180.0, 10.0)]
    start, end = REVIEW.stops[:2]
    stops = tuple(
        replace(stop, longitude_deg=x, latitude_deg=y) for stop, (x, y) in zip((start, end), line, strict=True)
    )
    nothing = {name: getattr(REVIEW.profile, name)[:0] for name in ("leg", "distance", "longitude_deg", "latitude_deg")}
    profile = replace(REVIEW.profile, **nothing, altitude=REVIEW.profile.altitude[:0])
    (leg,) = features(replace(REVIEW, stops=stops, legs=REVIEW.legs[:1], profile=profile), "leg")
    assert leg["geometry"]["type"] == "LineString"
    assert [place[0] for place in leg["geometry"]["coordinates"]] == [179.99, 180.0]


def test_no_latitude_is_beyond_a_pole():
    over = elsewhere(north=90 - FRAME.origin.latitude_deg - 0.004)
    assert over.profile.latitude_deg.max() > 90
    assert on_earth_alone(format_geojson(over))
    cut = [one["geometry"] for one in features(over, "leg") if one["geometry"]["type"] == "MultiLineString"]
    assert cut
    first, second = cut[0]["coordinates"]
    assert first[-1][1] == second[0][1] == 90.0
    assert abs(first[-1][0] - second[0][0]) == pytest.approx(180, abs=0.1)


@pytest.mark.parametrize(
    ("given", "expected"),
    [
        ((10.0, 47.0), (10.0, 47.0)),
        ((180.0, 90.0), (180.0, 90.0)),
        ((190.0, 0.0), (-170.0, 0.0)),
        ((-540.5, 0.0), (179.5, 0.0)),
        ((10.0, 91.0), (-170.0, 89.0)),
        ((-10.0, -91.0), (170.0, -89.0)),
        ((10.0, 271.0), (10.0, -89.0)),
    ],
)
def test_a_place_that_went_round_is_where_it_is(given, expected):
    assert on_earth(*given) == pytest.approx(expected)


def test_a_height_that_is_not_known_is_left_out():
    nameless = replace(REVIEW, stops=(replace(REVIEW.stops[0], altitude=math.nan), *REVIEW.stops[1:]))
    assert len(features(nameless, "stop")[0]["geometry"]["coordinates"]) == 2
