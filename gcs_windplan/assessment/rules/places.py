"""Where findings are: on a leg, on a move, at a stop."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace
from typing import TypeAlias

import numpy as np

from gcs_windplan.arrays import FloatArray
from gcs_windplan.assessment.assessment import AssessedLeg, Fact, Finding, Severity
from gcs_windplan.assessment.case import Case
from gcs_windplan.assessment.figures import AssessedMission
from gcs_windplan.assessment.track import is_leg

#: A finding, and the place (3,) in the frame where it still lacks latitude and longitude.
Found: TypeAlias = tuple[Finding, FloatArray | None]


def on_leg(
    mission: AssessedMission,
    leg: AssessedLeg,
    rule: str,
    severity: Severity,
    *,
    at: FloatArray | None = None,
    value: float | None = None,
    limit: float | None = None,
    unit: str = "",
    **facts: Fact,
) -> Found:
    """A finding on a leg, at a place (3,) on it; at its end where none is given."""
    move = int(mission.track.leg_moves[leg.number - 1])
    place = np.array(mission.track.moves[move].end) if at is None else at
    finding = Finding(
        rule, severity, item=leg.item, leg=leg.number, distance=distance_at(mission, move, place), value=value,
        limit=limit, unit=unit, facts=facts,
    )  # fmt: skip
    return finding, place


def on_move(
    mission: AssessedMission,
    move: int,
    rule: str,
    at: FloatArray,
    *,
    value: float | None = None,
    unit: str = "",
    **facts: Fact,
) -> Found:
    """A danger on any move, legs, take-offs and landings, at a place (3,) on it; its limit, if it has any, is 0."""
    here = mission.track.moves[move]
    finding = Finding(
        rule, "danger", item=here.item, leg=int(mission.track.leg_numbers[move]) if is_leg(here) else None,
        distance=distance_at(mission, move, at), value=value, limit=None if value is None else 0.0, unit=unit,
        facts={"move": here.kind, **facts},
    )  # fmt: skip
    return finding, at


def at_stop(
    mission: AssessedMission,
    number: int,
    rule: str,
    severity: Severity,
    *,
    value: float | None = None,
    limit: float | None = None,
    unit: str = "",
    **facts: Fact,
) -> Found:
    """A finding at a stop; the leg is the one that leads there."""
    stop = mission.stops[number]
    finding = Finding(
        rule, severity, item=stop.item, leg=number or None, distance=stop.distance, value=value, limit=limit, unit=unit,
        facts=facts,
    )  # fmt: skip
    return finding, np.array((stop.east, stop.north, stop.altitude))


def located(found: Sequence[Found], case: Case) -> list[Finding]:
    """The findings with their latitudes and longitudes."""
    places = np.array([place for _, place in found if place is not None]).reshape(-1, 3)
    latitudes, longitudes = map(iter, case.scene.frame.to_geographic(places)) if len(places) else (iter(()), iter(()))
    return [
        finding
        if place is None
        else replace(finding, latitude_deg=float(next(latitudes)), longitude_deg=float(next(longitudes)))
        for finding, place in found
    ]


def distance_at(mission: AssessedMission, move: int, place: FloatArray) -> float:
    """How far along the route a place on a move lies, level [m]."""
    track = mission.track
    pieces = np.flatnonzero(track.owners == move)
    starts, vectors = track.starts[pieces], track.ends[pieces] - track.starts[pieces]
    squares = np.maximum((vectors**2).sum(axis=1), 1e-12)
    share = np.clip(((place - starts) * vectors).sum(axis=1) / squares, 0.0, 1.0)
    best = int(np.argmin(np.linalg.norm(starts + share[:, None] * vectors - place, axis=1)))
    before = float(track.levels[pieces[:best]].sum())
    return float(mission.distances[move] + before + share[best] * track.levels[pieces[best]])


def runs(flags: list[bool]) -> Iterator[tuple[int, int]]:
    """The first and the last place of every unbroken run of True."""
    begin: int | None = None
    for i, flag in enumerate([*flags, False]):
        if flag and begin is None:
            begin = i
        elif not flag and begin is not None:
            yield begin, i - 1
            begin = None
