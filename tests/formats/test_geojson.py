"""GeoJSON of judged missions, read back by GEOS and by the rules of RFC 7946."""

from __future__ import annotations

import json
import math

import pytest
import shapely

from gcs_windplan.formats.geojson import format_geojson
from gcs_windplan.mission import Command
from gcs_windplan.wind import ConstantWind
from tests.assessment.cases import TERRAIN, at, judged, ridge
from tests.formats.test_kml import REVIEW

a_centimetre_in_degrees = 1.5e-7


def features(review, kind: str) -> list[dict]:
    collection = json.loads(format_geojson(review))
    assert collection["type"] == "FeatureCollection"
    return [one for one in collection["features"] if one["properties"]["kind"] == kind]


def test_legs_carry_their_figures():
    legs = features(REVIEW, "leg")
    assert [one["properties"]["number"] for one in legs] == [leg.number for leg in REVIEW.legs]
    for one, leg in zip(legs, REVIEW.legs, strict=True):
        told = one["properties"]
        assert told["clearance"] == leg.clearance
        assert told["ground_speed"] == leg.ground_speed
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
