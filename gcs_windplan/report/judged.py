"""A judged mission from above and from the side, with what was found, as PNG."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from matplotlib.transforms import ScaledTranslation

from gcs_windplan.arrays import FloatArray
from gcs_windplan.assessment import Assessment
from gcs_windplan.png import png_bytes
from gcs_windplan.report import sheet, words
from gcs_windplan.report.places import place_of
from gcs_windplan.report.relief import ground_of, moved
from gcs_windplan.report.room import Room, rings
from gcs_windplan.report.side import Side, draw_heights, dress_speeds, side_figure
from gcs_windplan.terrain import Extent

_PIXELS = 600  # of relief along the longer side
_SIGN = 8.0  # [point] half a finding's sign
_SIGNS = {"danger": ("8", "#b8490a", "white", 0.0), "warning": ("^", "#ffc94d", "#2b1d00", -2.5)}
_TIE = {"arrowstyle": "-", "lw": 0.9, "color": "#1c2430", "shrinkA": 0, "shrinkB": 0}
_RINGS = ((0.0, 0.0), *rings(2.1 * _SIGN, 4))
_AROUND = rings(9.0, 1, first=45.0)  # [point] from a stop to its number


def draw_assessment_map(assessments: Sequence[Assessment], dpi: int = 120) -> bytes:
    """One or several judged missions on a map, as PNG, in the first one's frame, with its wind.

    A single route is coloured by its ground speed; several are told apart by colour and dash.
    """
    first = assessments[0]
    ground = ground_of(assessments)
    extent = Extent(ground.west, ground.south, ground.east, ground.north)
    figure, axes, beside = sheet.sheet(extent)
    sheet.draw_relief(axes, ground.resampled(_PIXELS, smooth=True))
    for outline in first.outlines:
        if outline.kind.endswith("out") or outline.kind == "obstacle":
            floor, ceiling = (np.nan if height is None else height for height in (outline.floor, outline.ceiling))
            sheet.draw_keep_out(axes, outline.corners, outline.name, floor, ceiling)
        else:
            sheet.draw_keep_in(axes, outline.corners)
    where = f"{first.ground.wind_height:.0f} m above ground"
    sheet.draw_wind(axes, extent, first.ground.wind_places, first.ground.winds, where)
    lines = [_line(one, first) for one in assessments]
    if len(assessments) == 1 and len(lines[0]) > 1:
        route = sheet.draw_by_speed(axes, lines[0], first.profile.ground_speed[1:])
        figure.colorbar(route, cax=beside, label="ground speed [m/s]")
        stops = np.array([(stop.east, stop.north) for stop in first.stops]).reshape(-1, 2)
        sheet.draw_circles(axes, stops)
    else:
        beside.remove()
        names = [f"{one.name}: {words.clock(one.totals.seconds)} min" for one in assessments]
        sheet.draw_side_by_side(axes, lines, names)
    sheet.dress(axes, extent, " and ".join(_title(one) for one in assessments))
    room = Room(axes)
    for letter, one in zip(("A", "B") if len(assessments) > 1 else ("",), assessments, strict=True):
        _draw_findings(axes, room, letter, one, first)
    if len(assessments) == 1:
        for stop in first.stops:
            _draw_name(axes, room, stop.east / 1000, stop.north / 1000, str(stop.number))
    return png_bytes(figure, dpi)


def draw_assessment_profile(assessment: Assessment, dpi: int = 120) -> bytes:
    """Ground, limits, route and findings over the distance flown; below it speeds and wind, as PNG."""
    profile, limits = assessment.profile, assessment.limits
    if not len(profile.distance):
        figure, _, _ = side_figure(_title(assessment))
        return png_bytes(figure, dpi)
    figure, heights, speeds = side_figure(_title(assessment))
    side = Side(
        profile.distance, profile.ground, profile.distance, profile.altitude, limits.clearance, limits.max_height,
        assessment.vertical_datum, marks=False,
    )  # fmt: skip
    draw_heights(heights, side)
    _draw_speeds(speeds, assessment)
    room = Room(heights)
    for i, finding in enumerate(assessment.findings):
        at = place_of(assessment, finding).sample
        if at is not None:
            x, y = float(profile.distance[at]) / 1000, float(profile.altitude[at])
            _sign(heights, room, x, y, finding.severity, str(i + 1))
    return png_bytes(figure, dpi)


def _line(assessment: Assessment, first: Assessment) -> FloatArray:
    """The way flown in the first mission's frame, (n, 2) [m]."""
    places = np.column_stack([assessment.profile.east, assessment.profile.north])
    return moved(places, assessment.frame, first.frame)


def _draw_findings(axes: Any, room: Room, letter: str, assessment: Assessment, first: Assessment) -> None:
    """A numbered sign at each finding's place."""
    for i, finding in enumerate(assessment.findings):
        place = place_of(assessment, finding)
        if place.latitude_deg is not None and place.longitude_deg is not None:
            x, y = first.frame.to_local(place.latitude_deg, place.longitude_deg)[0] / 1000
            _sign(axes, room, x, y, finding.severity, f"{letter}{i + 1}")


def _sign(axes: Any, room: Room, x: float, y: float, severity: str, text: str) -> None:
    """A finding's sign with its number, where it belongs or tied to it from beside."""
    marker, fill, ink, centre = _SIGNS[severity]
    dx, dy = room.beside(x, y, (_SIGN, _SIGN), _RINGS) or (0.0, 0.0)
    if dx or dy:
        axes.annotate("", (x, y), xytext=(dx, dy), textcoords="offset points", arrowprops=_TIE, zorder=13)
    there = axes.transData + ScaledTranslation(dx / 72, dy / 72, axes.figure.dpi_scale_trans)
    axes.plot(x, y, marker, ms=2 * _SIGN, mfc=fill, mec="black", mew=0.9, zorder=14, transform=there)
    axes.annotate(
        text, (x, y), xytext=(dx, dy + centre), textcoords="offset points", ha="center", va="center",
        fontsize=7.5 if len(text) < 3 else 6, fontweight="bold", color=ink, zorder=15,
    )  # fmt: skip


def _draw_name(axes: Any, room: Room, x: float, y: float, text: str) -> None:
    """A stop's number beside it, if there is room."""
    place = room.beside(x, y, (2.5 * len(text) + 1, 4.0), _AROUND)
    if place is not None:
        sheet.label(axes, x, y, text, size=7.5, offset=place, centred=True)


def _draw_speeds(axes: Any, assessment: Assessment) -> None:
    """Ground speed and airspeed, and the wind along the track."""
    profile = assessment.profile
    km = profile.distance / 1000
    axes.plot(km, profile.ground_speed, color="#0072b2", lw=2, label="ground speed")
    axes.plot(km, profile.airspeed, color="#555555", lw=1, ls=":", label="airspeed")
    axes.fill_between(
        km, 0, profile.wind_along, color="#d55e00", lw=0, alpha=0.35, label="tail wind (+), head wind (−)"
    )
    speeds = np.concatenate([profile.ground_speed, profile.airspeed, [1.0]])
    dress_speeds(axes, float(profile.distance[-1]), float(np.nanmax(speeds)))


def _title(assessment: Assessment) -> str:
    found = words.counts(assessment.findings) or "nothing found"
    return f"{assessment.name}: {words.number(assessment.totals.length / 1000, 2)} km, {found}"
