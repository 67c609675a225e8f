"""What the page's script draws: each mission's samples, stops and findings, the map's wind and areas, the ground."""

from __future__ import annotations

import base64
from collections.abc import Sequence
from typing import Any, Final

import numpy as np
from numpy.typing import ArrayLike

from gcs_windplan.arrays import IntArray
from gcs_windplan.assessment import Assessment
from gcs_windplan.geo.frame import LocalFrame
from gcs_windplan.json_text import rounded, rounded_number
from gcs_windplan.report.places import place_of
from gcs_windplan.report.relief import Ground, contour_step, ground_of, moved, picture

_SAMPLES: Final = 2000  # of a profile, at most and besides stops and findings
_PIXELS: Final = 1000  # of the map's picture along its longer side
_MESH: Final = 140  # places of the scene's ground along its longer side: 39 000 triangles at most
_UNKNOWN: Final = -32768  # height of unknown ground

Numbers = dict[str, Any]


def page_numbers(assessments: Sequence[Assessment]) -> Numbers:
    """All that the page's script is given, as JSON's own types, rounded to what can be seen."""
    first = assessments[0]
    ground = ground_of(assessments)
    return {
        "missions": [_mission(assessment, first.frame) for assessment in assessments],
        "map": _map(assessments, ground),
        "mesh": _mesh(ground.resampled(_MESH), assessments),
    }


def _mission(assessment: Assessment, frame: LocalFrame) -> Numbers:
    profile, limits = assessment.profile, assessment.limits
    kept = _kept(assessment)
    places = np.column_stack([profile.east, profile.north])[kept]
    if assessment.frame != frame and len(places):
        places = frame.to_local(profile.latitude_deg[kept], profile.longitude_deg[kept])
    columns: Numbers = {
        "d": rounded(profile.distance[kept], 1),
        "t": rounded(profile.seconds[kept], 1),
        "e": rounded(places[:, 0], 1),
        "n": rounded(places[:, 1], 1),
        "z": rounded(profile.altitude[kept], 1),
        "g": rounded(profile.ground[kept], 1),
        "along": rounded(profile.wind_along[kept], 2),
        "across": rounded(profile.wind_across[kept], 2),
        "we": rounded(profile.wind_east[kept], 2),
        "wn": rounded(profile.wind_north[kept], 2),
        "over": rounded(profile.ground_speed[kept], 2),
        "air": rounded(profile.airspeed[kept], 2),
        "leg": profile.leg[kept].tolist(),
        "power": None if profile.power is None else rounded(profile.power[kept], 0),
        "left": None if profile.left is None else rounded(100 * profile.left[kept], 2),
    }
    return {
        "name": assessment.name,
        "track": columns,
        "stops": _stops(assessment, frame),
        "findings": _findings(assessment, frame),
        "clearance": limits.clearance,
        "maxHeight": limits.max_height,
        "reserve": None if assessment.totals.reserve is None else rounded_number(100 * assessment.totals.reserve, 1),
    }


def _kept(assessment: Assessment) -> IntArray:
    """Which samples the page gets: all, or an even choice with those at stops, findings and extremes of height."""
    profile = assessment.profile
    n = len(profile.distance)
    if n <= _SAMPLES:
        return np.arange(n)
    marks = [stop.seconds for stop in assessment.stops if np.isfinite(stop.seconds)]
    flown = np.isfinite(profile.seconds)
    at_stops = np.searchsorted(profile.seconds[flown], marks)
    places = [place_of(assessment, finding).sample for finding in assessment.findings]
    at_findings = [sample for sample in places if sample is not None]
    turns = np.flatnonzero(np.diff(profile.leg))
    above = profile.altitude - profile.ground
    extremes = [np.nanargmin(above), np.nanargmax(above)] if np.isfinite(above).any() else []
    evenly = np.linspace(0, n - 1, _SAMPLES).astype(np.int64)
    chosen: list[ArrayLike] = [evenly, at_stops, at_findings, turns, turns + 1, extremes]
    kept: IntArray = np.unique(np.clip(np.concatenate([np.asarray(some, np.int64) for some in chosen]), 0, n - 1))
    return kept


def _stops(assessment: Assessment, frame: LocalFrame) -> list[list[Any]]:
    """Each stop: number, label, east, north, altitude, distance, seconds."""
    places = moved(np.array([(s.east, s.north) for s in assessment.stops]).reshape(-1, 2), assessment.frame, frame)
    return [
        [stop.number, stop.label, *rounded([*place, stop.altitude, stop.distance, stop.seconds], 1)]
        for stop, place in zip(assessment.stops, places, strict=True)
    ]


def _findings(assessment: Assessment, frame: LocalFrame) -> list[Numbers]:
    """Each finding: what it says, the sample that it lies on, east and north."""
    listed, kept = [], _kept(assessment)
    for finding in assessment.findings:
        place = place_of(assessment, finding)
        spot: list[Any] = [None, None]
        if place.latitude_deg is not None and place.longitude_deg is not None:
            spot = rounded(frame.to_local(place.latitude_deg, place.longitude_deg)[0], 1)
        listed.append(
            {
                "severity": finding.severity,
                "text": finding.message,
                "at": None if place.sample is None else int(np.searchsorted(kept, place.sample)),
                "e": spot[0],
                "n": spot[1],
            }
        )
    return listed


def _map(assessments: Sequence[Assessment], ground: Ground) -> Numbers:
    first = assessments[0]
    wind = np.column_stack([first.ground.wind_places, first.ground.winds])
    wind = wind[np.isfinite(wind).all(axis=1)]
    areas = {}
    for one in assessments:
        for outline in one.outlines:
            corners = np.round(moved(outline.corners, one.frame, first.frame), 1)
            areas[(outline.name, outline.kind, corners.tobytes(), outline.floor, outline.ceiling)] = {
                "name": outline.name,
                "kind": outline.kind,
                "corners": (corners + 0.0).tolist(),
                "floor": rounded_number(outline.floor, 1),
                "ceiling": rounded_number(outline.ceiling, 1),
            }
    rally = {place for one in assessments for place in one.rally}
    return {
        "west": rounded_number(ground.west, 1),
        "south": rounded_number(ground.south, 1),
        "east": rounded_number(ground.east, 1),
        "north": rounded_number(ground.north, 1),
        "picture": picture(ground.resampled(_PIXELS, smooth=True)),
        "contours": contour_step(ground.relief),
        "wind": [rounded(row, 2) for row in wind],
        "windHeight": rounded_number(first.ground.wind_height, 1),
        "windSeconds": rounded_number(first.ground.wind_seconds, 0),
        "areas": list(areas.values()),
        "rally": [rounded(first.frame.to_local(*place)[0], 1) for place in sorted(rally)],
    }


def _mesh(ground: Ground, assessments: Sequence[Assessment]) -> Numbers:
    """The scene's ground: heights in steps above the lowest, as 16-bit numbers from the south-west, row by row."""
    known = ground.heights[np.isfinite(ground.heights)]
    lowest = float(known.min()) if len(known) else 0.0
    tops = [one.profile.altitude[np.isfinite(one.profile.altitude)] for one in assessments]
    highest = float(np.max(np.concatenate([known, *tops]), initial=lowest))
    step = max(0.1, ground.relief / 32000)
    steps = np.round((ground.heights - lowest) / step)
    whole = np.where(np.isfinite(steps), steps, _UNKNOWN).astype("<i2")
    return {
        "rows": whole.shape[0],
        "columns": whole.shape[1],
        "lowest": rounded_number(lowest, 1),
        "step": step,
        "heights": base64.b64encode(whole.tobytes()).decode("ascii"),
        "exaggeration": _exaggeration(ground.size, highest - lowest),
    }


def _exaggeration(size: float, height: float) -> float:
    """How much heights are stretched in the scene: not at all in mountains, up to three times in the plain."""
    return float(np.clip(round(2 * 0.16 * size / max(height, 1.0)) / 2, 1.0, 3.0))
