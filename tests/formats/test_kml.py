"""KML of judged missions: what Google Earth draws, read back as XML."""

from __future__ import annotations

from dataclasses import replace
from datetime import UTC, datetime
from xml.etree import ElementTree as Xml

import numpy as np
import pytest

from gcs_windplan.assessment import AssessmentLimits
from gcs_windplan.formats.kml import format_kml
from gcs_windplan.mission import RallyPoint
from gcs_windplan.scene import Airspace, Prism
from tests.assessment.cases import RETURN, at, judged, point, ridge

SPACE = {"k": "http://www.opengis.net/kml/2.2"}
a_centimetre_in_degrees = 1.5e-7

BOX = np.array([[500.0, -200.0], [900.0, -200.0], [900.0, 200.0], [500.0, 200.0]])
REVIEW = judged(
    at(2000, 0),
    at(2000, 900, 150),
    RETURN,
    terrain=ridge(),
    limits=AssessmentLimits(clearance=30, max_height=120),
    airspace=Airspace((Prism("school & co <1>", BOX, ceiling=900.0),)),
    departure=datetime(2026, 5, 1, 8, tzinfo=UTC),
    mission={"rally": (RallyPoint(point(100, 100), 40.0),)},
)


@pytest.fixture(scope="module")
def document() -> Xml.Element:
    return Xml.fromstring(format_kml(REVIEW).encode())


def places(element: Xml.Element) -> np.ndarray:
    text = element.find(".//k:coordinates", SPACE).text
    return np.array([[float(number) for number in place.split(",")] for place in text.split()])


def folder(document: Xml.Element, name: str) -> list[Xml.Element]:
    (found,) = [one for one in document.iterfind(".//k:Folder", SPACE) if one.find("k:name", SPACE).text == name]
    return found.findall("k:Placemark", SPACE)


def test_the_way_is_the_profile_absolute_and_extruded(document):
    line = document.find(".//k:LineString", SPACE)
    assert line.find("k:altitudeMode", SPACE).text == "absolute"
    assert line.find("k:extrude", SPACE).text == "1"
    profile = REVIEW.profile
    assert places(line)[:, 0] == pytest.approx(profile.longitude_deg, abs=a_centimetre_in_degrees)
    assert places(line)[:, 1] == pytest.approx(profile.latitude_deg, abs=a_centimetre_in_degrees)
    assert places(line)[:, 2] == pytest.approx(profile.altitude, abs=0.01)


def test_stops_have_times_and_places(document):
    marks = folder(document, "stops")
    assert len(marks) == len(REVIEW.stops)
    for mark, stop in zip(marks, REVIEW.stops, strict=True):
        assert places(mark)[0] == pytest.approx([stop.longitude_deg, stop.latitude_deg, stop.altitude], abs=0.01)
        when = datetime.fromisoformat(mark.find(".//k:when", SPACE).text)
        assert (when - REVIEW.departure).total_seconds() == pytest.approx(stop.seconds, abs=0.51)


def test_findings_are_where_they_are(document):
    marks = folder(document, "findings")
    assert [mark.find("k:description", SPACE).text for mark in marks] == [one.message for one in REVIEW.findings]
    first = REVIEW.findings[0]
    assert places(marks[0])[0, :2] == pytest.approx(
        [first.longitude_deg, first.latitude_deg], abs=a_centimetre_in_degrees
    )
    assert {mark.find("k:styleUrl", SPACE).text for mark in marks} <= {"#danger", "#warning"}


def test_areas_close_and_have_their_ceiling(document):
    area, rally = folder(document, "areas")
    ring = places(area)
    assert area.find("k:name", SPACE).text == "keep-out school & co <1>"
    assert (ring[0] == ring[-1]).all()
    assert set(ring[:, 2]) == {900.0}
    assert rally.find("k:name", SPACE).text == "rally 1"


def test_every_style_that_is_named_is_there(document):
    styles = {f"#{style.get('id')}" for style in document.iterfind(".//k:Style", SPACE)}
    assert {url.text for url in document.iterfind(".//k:styleUrl", SPACE)} <= styles


def test_the_same_review_gives_the_same_text():
    assert format_kml(REVIEW) == format_kml(REVIEW)


def test_longitudes_and_latitudes_stay_on_earth():
    profile = REVIEW.profile
    far = replace(profile, longitude_deg=profile.longitude_deg + 175, latitude_deg=profile.latitude_deg + 43.2)
    text = format_kml(replace(REVIEW, profile=far))
    line = places(Xml.fromstring(text.encode()).find(".//k:LineString", SPACE))
    assert far.longitude_deg.max() > 180
    assert far.latitude_deg.max() > 90
    assert np.abs(line[:, 0]).max() <= 180
    assert np.abs(line[:, 1]).max() <= 90
