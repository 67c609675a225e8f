"""A judged mission as GeoJSON (RFC 7946), for QGIS and other map tools: legs, stops, findings, areas.

Coordinates are WGS 84 longitude, latitude and height. RFC 7946 wants heights above the ellipsoid; these are above mean
sea level, as terrain and autopilots have them, and each feature with one says so in `vertical_datum`.
"""

from __future__ import annotations

import json
import math
from dataclasses import asdict
from typing import TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    from gcs_windplan.assessment import Assessment, Finding, JudgedLeg, Outline, Stop

_DIGITS, _CENTIMETRES = 7, 2


def format_geojson(assessment: Assessment) -> str:
    """A FeatureCollection; `kind` of a feature is `leg`, `stop`, `finding`, `area` or `rally`."""
    features = [
        *(_leg(leg, assessment) for leg in assessment.legs),
        *(_stop(stop, assessment) for stop in assessment.stops),
        *(_finding(finding) for finding in assessment.findings),
        *(_area(outline, assessment) for outline in assessment.outlines),
        *(_rally(number, place) for number, place in enumerate(assessment.rally, start=1)),
    ]
    collection = {"type": "FeatureCollection", "name": assessment.name, "features": features}
    return json.dumps(collection, indent=1, ensure_ascii=False, allow_nan=False) + "\n"


def plain(value: Any) -> Any:
    """A figure as JSON takes it: null for what is not known or infinite."""
    return None if isinstance(value, float) and not math.isfinite(value) else value


def _leg(leg: JudgedLeg, assessment: Assessment) -> dict[str, Any]:
    """A leg as flown, a curve with its samples."""
    profile = assessment.profile
    inside = np.flatnonzero(profile.leg == leg.number)
    start, end = assessment.stops[leg.number - 1], assessment.stops[leg.number]
    low, high = start.distance - 1e-6, end.distance + 1e-6
    inside = inside[(profile.distance[inside] >= low) & (profile.distance[inside] <= high)]
    line = [_place(start.longitude_deg, start.latitude_deg, start.altitude)]
    for i in inside:
        place = _place(float(profile.longitude_deg[i]), float(profile.latitude_deg[i]), float(profile.altitude[i]))
        if place != line[-1] and i not in (inside[0], inside[-1]):
            line.append(place)
    line.append(_place(end.longitude_deg, end.latitude_deg, end.altitude))
    figures = {name: plain(value) for name, value in asdict(leg).items()}
    return _feature("leg", {"type": "LineString", "coordinates": line}, figures, assessment)


def _stop(stop: Stop, assessment: Assessment) -> dict[str, Any]:
    figures = {name: plain(value) for name, value in asdict(stop).items()}
    place = _place(stop.longitude_deg, stop.latitude_deg, stop.altitude)
    return _feature("stop", {"type": "Point", "coordinates": place}, figures, assessment)


def _finding(finding: Finding) -> dict[str, Any]:
    figures = {name: plain(value) for name, value in asdict(finding).items()}
    if finding.latitude_deg is None or finding.longitude_deg is None:
        return _feature("finding", None, figures)
    return _feature("finding", _point(finding.longitude_deg, finding.latitude_deg), figures)


def _area(outline: Outline, assessment: Assessment) -> dict[str, Any]:
    """An area; its ring runs counter-clockwise, as RFC 7946 wants it."""
    x, y = outline.corners.T
    turned = float(np.sum(x * np.roll(y, -1) - np.roll(x, -1) * y)) < 0
    corners = outline.corners[::-1] if turned else outline.corners
    latitudes, longitudes = assessment.frame.to_geographic(np.vstack([corners, corners[:1]]))
    ring = [[round(float(a), _DIGITS), round(float(b), _DIGITS)] for a, b in zip(longitudes, latitudes, strict=True)]
    ring[-1] = ring[0]
    figures = {"name": outline.name, "area": outline.kind, "floor": outline.floor, "ceiling": outline.ceiling}
    return _feature("area", {"type": "Polygon", "coordinates": [ring]}, figures, assessment)


def _rally(number: int, place: tuple[float, float]) -> dict[str, Any]:
    return _feature("rally", _point(place[1], place[0]), {"number": number})


def _feature(
    kind: str, geometry: dict[str, Any] | None, figures: dict[str, Any], assessment: Assessment | None = None
) -> dict[str, Any]:
    datum = {} if assessment is None else {"vertical_datum": assessment.vertical_datum}
    return {"type": "Feature", "geometry": geometry, "properties": {"kind": kind, **figures, **datum}}


def _place(longitude: float, latitude: float, altitude: float) -> list[float]:
    return [round(longitude, _DIGITS), round(latitude, _DIGITS), round(altitude, _CENTIMETRES)]


def _point(longitude: float, latitude: float) -> dict[str, Any]:
    return {"type": "Point", "coordinates": [round(longitude, _DIGITS), round(latitude, _DIGITS)]}
