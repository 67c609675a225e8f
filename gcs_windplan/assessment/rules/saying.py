"""How findings are put: where they are, and in which words a leg or a stop is named."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import replace
from typing import TypeAlias

import numpy as np

from gcs_windplan.arrays import FloatArray
from gcs_windplan.assessment.assessment import Finding, JudgedLeg, Severity
from gcs_windplan.assessment.case import Case
from gcs_windplan.assessment.figures import Judged
from gcs_windplan.assessment.track import is_leg

#: A finding, and the place (3,) in the frame where it still has to be told latitude and longitude.
Found: TypeAlias = tuple[Finding, FloatArray | None]


def on_leg(
    mission: Judged,
    leg: JudgedLeg,
    rule: str,
    severity: Severity,
    message: str,
    *,
    at: FloatArray | None = None,
    value: float | None = None,
    limit: float | None = None,
    unit: str = "",
) -> Found:
    """A finding on a leg, at a place (3,) on it; at its end where none is given."""
    move = int(mission.track.leg_moves[leg.number - 1])
    place = np.array(mission.track.moves[move].end) if at is None else at
    distance = distance_at(mission, move, place)
    finding = Finding(rule, severity, message, leg.item, leg.number, distance, value=value, limit=limit, unit=unit)
    return finding, place


def on_move(
    mission: Judged, move: int, rule: str, message: str, at: FloatArray, value: float | None = None, unit: str = ""
) -> Found:
    """A danger on any move, legs, take-offs and landings, at a place (3,) on it; its limit, if it has any, is 0."""
    here = mission.track.moves[move]
    leg = int(mission.track.leg_numbers[move]) if is_leg(here) else None
    limit = None if value is None else 0.0
    distance = distance_at(mission, move, at)
    return Finding(rule, "danger", message, here.item, leg, distance, value=value, limit=limit, unit=unit), at


def move_name(mission: Judged, move: int) -> str:
    """A move for people, with its item."""
    here = mission.track.moves[move]
    if is_leg(here):
        return f"leg {mission.track.leg_numbers[move]} (to item {here.item})"
    return f"the {here.kind} (item {here.item})"


def at_stop(
    mission: Judged,
    number: int,
    rule: str,
    severity: Severity,
    message: str,
    *,
    value: float | None = None,
    limit: float | None = None,
    unit: str = "",
) -> Found:
    """A finding at a stop; the leg is the one that leads there."""
    stop = mission.stops[number]
    place = np.array((stop.east, stop.north, stop.altitude))
    return (
        Finding(rule, severity, message, stop.item, number or None, stop.distance, None, None, value, limit, unit),
        place,
    )


def located(found: Sequence[Found], case: Case) -> list[Finding]:
    """The findings with their latitudes and longitudes."""
    places = np.array([place for _, place in found if place is not None]).reshape(-1, 3)
    latitudes, longitudes = map(iter, case.frame.to_geographic(places)) if len(places) else (iter(()), iter(()))
    return [
        finding
        if place is None
        else replace(finding, latitude_deg=float(next(latitudes)), longitude_deg=float(next(longitudes)))
        for finding, place in found
    ]


def distance_at(mission: Judged, move: int, place: FloatArray) -> float:
    """How far along the route a place on a move lies, level [m]."""
    track = mission.track
    pieces = np.flatnonzero(track.owners == move)
    starts, vectors = track.starts[pieces], track.ends[pieces] - track.starts[pieces]
    squares = np.maximum((vectors**2).sum(axis=1), 1e-12)
    share = np.clip(((place - starts) * vectors).sum(axis=1) / squares, 0.0, 1.0)
    best = int(np.argmin(np.linalg.norm(starts + share[:, None] * vectors - place, axis=1)))
    before = float(track.levels[pieces[:best]].sum())
    return float(mission.distances[move] + before + share[best] * track.levels[pieces[best]])


def leg_name(leg: JudgedLeg) -> str:
    """A leg for people, with the item that it leads to."""
    return f"leg {leg.number} (to item {leg.item})"


def runs(flags: list[bool]) -> Iterator[tuple[int, int]]:
    """The first and the last place of every unbroken run of True."""
    begin: int | None = None
    for i, flag in enumerate([*flags, False]):
        if flag and begin is None:
            begin = i
        elif not flag and begin is not None:
            yield begin, i - 1
            begin = None


def metres(value: float) -> str:
    """A length for people: 12.3 m, 4.20 km."""
    if not math.isfinite(value):
        return "an unknown length"
    return f"{value / 1000:.2f} km" if abs(value) >= 2000 else f"{value:.1f} m"
