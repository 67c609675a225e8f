"""A judged mission as KML 2.2, for Google Earth: the way in space, its stops, its findings, its areas.

Heights are above mean sea level, as Google Earth takes `absolute` (EGM96); latitude and longitude are WGS 84.
"""

from __future__ import annotations

import math
from collections.abc import Iterable
from datetime import timedelta
from typing import TYPE_CHECKING, Final
from xml.etree import ElementTree as Xml

import numpy as np

from gcs_windplan.flight import clock
from gcs_windplan.formats.geojson import on_earth

if TYPE_CHECKING:
    from gcs_windplan.assessment import Assessment, Finding, Outline, Stop

_NAMESPACE: Final = "http://www.opengis.net/kml/2.2"
_COLOURS: Final = {  # alpha, blue, green, red
    "way": "ffff8000",
    "danger": "ff3030d0",
    "warning": "ff20a0f0",
    "stop": "ffffffff",
    "keep-out": "803030d0",
    "fence-out": "803030d0",
    "keep-in": "8030a030",
    "fence-in": "8030a030",
    "obstacle": "b05e3a5b",
}
_TALL: Final = 300.0  # [m] above the highest point of the flight, where an area has no ceiling


def format_kml(assessment: Assessment) -> str:
    """The mission as a KML document, a line absolute in height with curtains to the ground."""
    root = Xml.Element("kml", xmlns=_NAMESPACE)
    document = _child(root, "Document")
    _child(document, "name", assessment.name)
    _child(document, "description", _description(assessment))
    for name, colour in _COLOURS.items():
        _style(document, name, colour)
    _add_way(document, assessment)
    stops = _folder(document, "stops")
    for stop in assessment.stops:
        _add_stop(stops, stop, assessment)
    if assessment.findings:
        found = _folder(document, "findings")
        for finding in assessment.findings:
            _add_finding(found, finding, assessment)
    if assessment.outlines or assessment.rally:
        _add_areas(_folder(document, "areas"), assessment)
    Xml.indent(root)
    return '<?xml version="1.0" encoding="UTF-8"?>\n' + Xml.tostring(root, encoding="unicode") + "\n"


def _add_way(document: Xml.Element, assessment: Assessment) -> None:
    profile = assessment.profile
    mark = _placemark(document, assessment.name, "way")
    line = _child(mark, "LineString")
    _child(line, "extrude", "1")
    _child(line, "altitudeMode", "absolute")
    _coordinates(line, zip(profile.longitude_deg, profile.latitude_deg, profile.altitude, strict=True))


def _add_stop(folder: Xml.Element, stop: Stop, assessment: Assessment) -> None:
    mark = _placemark(folder, f"{stop.number} {stop.label}", "stop")
    lines = [f"item {stop.item}" if stop.item else "home", f"{_clock(stop.seconds)} min after arming"]
    lines += [f"{stop.altitude:.1f} m above sea level"]
    lines += [f"{stop.above_ground:.1f} m above ground"] if math.isfinite(stop.above_ground) else []
    lines += [f"{100 * stop.left:.0f} % of the battery left"] if stop.left is not None else []
    _child(mark, "description", ", ".join(lines))
    if assessment.departure is not None and math.isfinite(stop.seconds):
        when = assessment.departure + timedelta(seconds=round(stop.seconds))
        _child(_child(mark, "TimeStamp"), "when", when.strftime("%Y-%m-%dT%H:%M:%SZ"))
    _point(mark, stop.longitude_deg, stop.latitude_deg, stop.altitude)


def _add_finding(folder: Xml.Element, finding: Finding, assessment: Assessment) -> None:
    mark = _placemark(folder, f"{finding.severity}: {finding.rule}", finding.severity)
    _child(mark, "description", finding.message)
    if finding.latitude_deg is None or finding.longitude_deg is None:
        return
    altitude = _altitude(finding, assessment)
    _point(mark, finding.longitude_deg, finding.latitude_deg, altitude)


def _altitude(finding: Finding, assessment: Assessment) -> float | None:
    """How high the flight is where a finding lies [m]; None where it lies nowhere along it."""
    profile = assessment.profile
    if finding.distance is None or not len(profile.distance):
        return None
    return float(np.interp(finding.distance, profile.distance, profile.altitude))


def _add_areas(folder: Xml.Element, assessment: Assessment) -> None:
    top = max((stop.altitude for stop in assessment.stops), default=0.0) + _TALL
    for outline in assessment.outlines:
        _add_area(folder, outline, assessment, top)
    for number, (latitude, longitude) in enumerate(assessment.rally, start=1):
        _point(_placemark(folder, f"rally {number}", "stop"), longitude, latitude, None)


def _add_area(folder: Xml.Element, outline: Outline, assessment: Assessment, top: float) -> None:
    mark = _placemark(folder, f"{outline.kind} {outline.name}", outline.kind)
    polygon = _child(mark, "Polygon")
    _child(polygon, "extrude", "1")
    _child(polygon, "altitudeMode", "absolute")
    ring = _child(_child(polygon, "outerBoundaryIs"), "LinearRing")
    height = top if outline.ceiling is None else outline.ceiling
    corners = np.vstack([outline.corners, outline.corners[:1]])
    latitudes, longitudes = assessment.frame.to_geographic(corners)
    _coordinates(ring, ((x, y, height) for x, y in zip(longitudes, latitudes, strict=True)))


def _description(assessment: Assessment) -> str:
    totals = assessment.totals
    return (
        f"{totals.length / 1000:.2f} km, {_clock(totals.seconds)} min; heights above mean sea level"
        f" ({assessment.vertical_datum}); findings: {len(assessment.findings)}"
    )


def _clock(seconds: float) -> str:
    return clock(seconds) if math.isfinite(seconds) else "never"


def _style(document: Xml.Element, name: str, colour: str) -> None:
    style = _child(document, "Style")
    style.set("id", name)
    if name in ("stop", "danger", "warning"):
        icon = _child(style, "IconStyle")
        _child(icon, "color", colour)
        _child(icon, "scale", "0.7" if name == "stop" else "1.1")
    line = _child(style, "LineStyle")
    _child(line, "color", colour)
    _child(line, "width", "3")
    _child(_child(style, "PolyStyle"), "color", "40" + colour[2:])


def _folder(parent: Xml.Element, name: str) -> Xml.Element:
    folder = _child(parent, "Folder")
    _child(folder, "name", name)
    return folder


def _placemark(parent: Xml.Element, name: str, style: str) -> Xml.Element:
    mark = _child(parent, "Placemark")
    _child(mark, "name", name)
    _child(mark, "styleUrl", f"#{style}")
    return mark


def _point(mark: Xml.Element, longitude: float, latitude: float, altitude: float | None) -> None:
    point = _child(mark, "Point")
    _child(point, "altitudeMode", "clampToGround" if altitude is None else "absolute")
    _coordinates(point, [(longitude, latitude, altitude or 0.0)])


def _coordinates(parent: Xml.Element, places: Iterable[tuple[float, float, float]]) -> None:
    _child(parent, "coordinates", " ".join(_written(*on_earth(x, y), z) for x, y, z in places))


def _written(longitude: float, latitude: float, altitude: float) -> str:
    """One place, without its height where that is not known."""
    height = f",{altitude:.2f}" if math.isfinite(altitude) else ""
    return f"{longitude:.7f},{latitude:.7f}{height}"


def _child(parent: Xml.Element, tag: str, text: str | None = None) -> Xml.Element:
    child = Xml.SubElement(parent, tag)
    child.text = text
    return child
