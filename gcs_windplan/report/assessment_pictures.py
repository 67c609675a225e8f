"""An assessed mission from above and from the side, with what was found, as PNG."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np

from gcs_windplan.assessment import Assessment
from gcs_windplan.report import map as maps
from gcs_windplan.report import profile as profiles
from gcs_windplan.report import words
from gcs_windplan.report.labels import MapSign
from gcs_windplan.report.map import MapPlace, MapRoute, MapView, WindArrows
from gcs_windplan.report.places import place_of
from gcs_windplan.report.profile import ProfileView
from gcs_windplan.report.relief import ground_of, moved
from gcs_windplan.terrain import Extent


def draw_assessment_map(assessments: Sequence[Assessment], dpi: int = 120) -> bytes:
    """One or several assessed missions on a map, as PNG, in the first one's frame, with its wind.

    A single route is coloured by its ground speed; several are told apart by colour and dash.
    """
    first = assessments[0]
    ground = ground_of(assessments)
    letters = ("A", "B") if len(assessments) > 1 else ("",)
    view = MapView(
        " and ".join(_title(one) for one in assessments),
        Extent(ground.west, ground.south, ground.east, ground.north),
        ground,
        WindArrows(first.ground.wind_places, first.ground.winds, f"{first.ground.wind_height:.0f} m above ground"),
        [_route(one, first) for one in assessments],
        areas=[outline for outline in first.outlines if outline.kind != "obstacle"],
        solids=[outline.corners for outline in first.outlines if outline.kind == "obstacle"],
        places=[MapPlace(str(stop.number), stop.east, stop.north) for stop in first.stops] if letters == ("",) else (),
        signs=[sign for letter, one in zip(letters, assessments, strict=True) for sign in _signs(letter, one, first)],
    )
    return maps.draw_view(view, dpi)


def draw_assessment_profile(assessment: Assessment, dpi: int = 120) -> bytes:
    """Ground, limits, route and findings over the distance flown; below it speeds and wind, as PNG."""
    profile, limits = assessment.profile, assessment.limits
    at = [place_of(assessment, finding).sample for finding in assessment.findings]
    signs = [
        MapSign(str(i + 1), finding.severity, float(profile.distance[sample]), float(profile.altitude[sample]))
        for i, (finding, sample) in enumerate(zip(assessment.findings, at, strict=True))
        if sample is not None
    ]
    view = ProfileView(
        _title(assessment), profile.distance, profile.ground, profile.distance, profile.altitude, limits.clearance,
        limits.max_height, assessment.vertical_datum, profile.distance, profile.ground_speed, profile.airspeed,
        profile.wind_along, marks=False, signs=signs,
    )  # fmt: skip
    return profiles.draw_view(view, dpi)


def _route(assessment: Assessment, first: Assessment) -> MapRoute:
    """The way flown in the first mission's frame."""
    profile = assessment.profile
    line = moved(np.column_stack([profile.east, profile.north]), assessment.frame, first.frame)
    return MapRoute(f"{assessment.name}: {words.clock(assessment.totals.seconds)} min", line, profile.ground_speed[1:])


def _signs(letter: str, assessment: Assessment, first: Assessment) -> Iterator[MapSign]:
    """A numbered sign at each finding's place [m]."""
    for i, finding in enumerate(assessment.findings):
        place = place_of(assessment, finding)
        if place.latitude_deg is not None and place.longitude_deg is not None:
            x, y = first.frame.to_local(place.latitude_deg, place.longitude_deg)[0]
            yield MapSign(f"{letter}{i + 1}", finding.severity, float(x), float(y))


def _title(assessment: Assessment) -> str:
    found = words.counts(assessment.findings) or "nothing found"
    return f"{assessment.name}: {words.number(assessment.totals.length / 1000, 2)} km, {found}"
