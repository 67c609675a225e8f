"""A judged mission as GeoJSON (RFC 7946), for QGIS and other map tools: legs, stops, findings, areas.

Coordinates are WGS 84 longitude, latitude and height. RFC 7946 wants heights above the ellipsoid; these are above mean
sea level, as terrain and autopilots have them, and each feature with one says so in `vertical_datum`.

What lies across the antimeridian is cut there (section 3.1.9), and what leads over a pole there.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any, Final, TypeAlias

import numpy as np

from gcs_windplan.json_text import json_text, json_value

if TYPE_CHECKING:
    from gcs_windplan.assessment import AssessedLeg, Assessment, Finding, Outline, Stop

_DIGITS, _CENTIMETRES = 7, 2
_OVER_POLE: Final = 179.9  # [deg] of longitude between two neighbours: their straight line leads over the pole

_Place: TypeAlias = "tuple[float, float, float]"  # longitude and latitude [deg], height [m]


def format_geojson(assessment: Assessment) -> str:
    """The mission as GeoJSON's text."""
    return json_text(geojson_of(assessment)) + "\n"


def geojson_of(assessment: Assessment) -> dict[str, Any]:
    """A FeatureCollection; `kind` of a feature is `leg`, `stop`, `finding`, `area` or `rally`."""
    features = [
        *(_leg(leg, assessment) for leg in assessment.legs),
        *(_stop(stop, assessment) for stop in assessment.stops),
        *(_finding(finding) for finding in assessment.findings),
        *(_area(outline, assessment) for outline in assessment.outlines),
        *(_rally(number, place) for number, place in enumerate(assessment.rally, start=1)),
    ]
    collection: dict[str, Any] = json_value(
        {"type": "FeatureCollection", "name": assessment.name, "features": features}
    )
    return collection


def on_earth(longitude: float, latitude: float) -> tuple[float, float]:
    """The same longitude and latitude [deg] within 180 and 90 degrees, for one that went round or over a pole."""
    latitude = (latitude + 180) % 360 - 180 if abs(latitude) > 90 else latitude
    if abs(latitude) > 90:
        longitude, latitude = longitude + 180, math.copysign(180, latitude) - latitude
    return (longitude + 180) % 360 - 180 if abs(longitude) > 180 else longitude, latitude


def _leg(leg: AssessedLeg, assessment: Assessment) -> dict[str, Any]:
    """A leg as flown, a curve with its samples."""
    profile = assessment.profile
    inside = np.flatnonzero(profile.leg == leg.number)
    start, end = assessment.stops[leg.number - 1], assessment.stops[leg.number]
    low, high = start.distance - 1e-6, end.distance + 1e-6
    inside = inside[(profile.distance[inside] >= low) & (profile.distance[inside] <= high)]
    samples = zip(profile.longitude_deg[inside], profile.latitude_deg[inside], profile.altitude[inside], strict=True)
    line = [(start.longitude_deg, start.latitude_deg, start.altitude)]
    line += [(float(x), float(y), float(z)) for x, y, z in samples][1:-1]
    line.append((end.longitude_deg, end.latitude_deg, end.altitude))
    return _feature("leg", _line(line), json_value(leg), assessment)


def _line(places: Sequence[_Place]) -> dict[str, Any]:
    """A line, or several where it crosses the antimeridian or a pole."""
    parts: list[list[list[float]]] = []
    for part in _parts(places):
        written = [_place(*place) for place in part]
        kept = [place for i, place in enumerate(written) if i in (0, len(written) - 1) or place != written[i - 1]]
        parts.append(kept)
    if len(parts) == 1:
        return {"type": "LineString", "coordinates": parts[0]}
    return {"type": "MultiLineString", "coordinates": parts}


def _parts(places: Sequence[_Place]) -> list[list[_Place]]:
    """A line's parts on either side of the antimeridian or a pole, each with the places where it was cut."""
    parts: list[list[_Place]] = [[(*on_earth(*places[0][:2]), places[0][2])]]
    for place in places[1:]:
        longitude, latitude = on_earth(*place[:2])
        before = parts[-1][-1]
        eastwards = (longitude - before[0] + 180) % 360 - 180
        if abs(eastwards) > _OVER_POLE:
            pole = math.copysign(90, before[1] + latitude)
            near, far = abs(pole - before[1]), abs(pole - latitude)
            height = _between(before[2], place[2], near / (near + far) if near + far else 0)
            parts[-1].append((before[0], pole, height))
            parts.append([(longitude, pole, height), (longitude, latitude, place[2])])
            continue
        unwrapped = before[0] + eastwards
        if abs(unwrapped) <= 180:
            parts[-1].append((unwrapped, latitude, place[2]))
            continue
        side = math.copysign(180, unwrapped)
        share = (side - before[0]) / eastwards
        cut = _between(before[1], latitude, share), _between(before[2], place[2], share)
        if share > 0:
            parts[-1].append((side, *cut))
        parts.append([(-side, *cut), (longitude, latitude, place[2])])
    return [part for part in parts if len(part) > 1] or parts


def _between(first: float, second: float, share: float) -> float:
    return first * (1 - share) + second * share


def _stop(stop: Stop, assessment: Assessment) -> dict[str, Any]:
    place = _place(*on_earth(stop.longitude_deg, stop.latitude_deg), stop.altitude)
    return _feature("stop", {"type": "Point", "coordinates": place}, json_value(stop), assessment)


def _finding(finding: Finding) -> dict[str, Any]:
    figures = json_value(finding)
    del figures["facts"]  # properties are flat
    if finding.latitude_deg is None or finding.longitude_deg is None:
        return _feature("finding", None, figures)
    return _feature("finding", _point(finding.longitude_deg, finding.latitude_deg), figures)


def _area(outline: Outline, assessment: Assessment) -> dict[str, Any]:
    """An area; its ring runs counter-clockwise, as RFC 7946 wants it."""
    x, y = outline.corners.T
    turned = float(np.sum(x * np.roll(y, -1) - np.roll(x, -1) * y)) < 0
    corners = outline.corners[::-1] if turned else outline.corners
    latitudes, longitudes = assessment.frame.to_geographic(corners)
    places = [on_earth(float(a), float(b)) for a, b in zip(longitudes, latitudes, strict=True)]
    figures = {"name": outline.name, "area": outline.kind, "floor": outline.floor, "ceiling": outline.ceiling}
    return _feature("area", _polygon(places), figures, assessment)


def _polygon(corners: Sequence[tuple[float, float]]) -> dict[str, Any]:
    """A polygon, or two where the antimeridian cuts it."""
    longitudes = np.unwrap([longitude for longitude, _ in corners], period=360)
    ring = [(float(x), y) for x, (_, y) in zip(longitudes, corners, strict=True)]
    if all(abs(x) <= 180 for x, _ in ring):
        return {"type": "Polygon", "coordinates": [_closed(ring)]}
    turned = [[(x + turn, y) for x, y in ring] for turn in (0, 360, -360)]
    parts = [_west_of(180, _west_of(180, one), turned=True) for one in turned]
    return {"type": "MultiPolygon", "coordinates": [[_closed(part)] for part in parts if len(part) > 2]}


def _closed(ring: Sequence[tuple[float, float]]) -> list[list[float]]:
    written = [[round(x, _DIGITS), round(y, _DIGITS)] for x, y in ring]
    return [*written, written[0]]


def _west_of(edge: float, ring: list[tuple[float, float]], turned: bool = False) -> list[tuple[float, float]]:
    """What of a ring lies west of a meridian; turned: east of the opposite one (Sutherland and Hodgman 1974)."""
    sign = -1 if turned else 1
    kept: list[tuple[float, float]] = []
    for (x, y), (before, y_before) in zip(ring, [*ring[-1:], *ring[:-1]], strict=True):
        if (sign * x > edge) != (sign * before > edge):
            share = (sign * edge - before) / (x - before)
            kept.append((sign * edge, _between(y_before, y, share)))
        if sign * x <= edge:
            kept.append((x, y))
    return kept if len({x for x, _ in kept}) > 1 else []


def _rally(number: int, place: tuple[float, float]) -> dict[str, Any]:
    return _feature("rally", _point(place[1], place[0]), {"number": number})


def _feature(
    kind: str, geometry: dict[str, Any] | None, figures: dict[str, Any], assessment: Assessment | None = None
) -> dict[str, Any]:
    datum = {} if assessment is None else {"vertical_datum": assessment.vertical_datum}
    return {"type": "Feature", "geometry": geometry, "properties": {"kind": kind, **figures, **datum}}


def _place(longitude: float, latitude: float, altitude: float) -> list[float]:
    """Without its height where that is not known."""
    height = [round(altitude, _CENTIMETRES)] if math.isfinite(altitude) else []
    return [round(longitude, _DIGITS), round(latitude, _DIGITS), *height]


def _point(longitude: float, latitude: float) -> dict[str, Any]:
    longitude, latitude = on_earth(longitude, latitude)
    return {"type": "Point", "coordinates": [round(longitude, _DIGITS), round(latitude, _DIGITS)]}
