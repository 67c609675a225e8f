"""Rules of the wind: as far as it is known, how strong it is, how strong its gusts are."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from gcs_windplan.arrays import BoolArray, FloatArray
from gcs_windplan.assessment.assessment import Severity
from gcs_windplan.assessment.figures import AssessedMission
from gcs_windplan.assessment.known import known_wind
from gcs_windplan.assessment.rules.places import Found, on_leg, runs

_SLACK = 1e-3  # [m/s]
_ROUNDING = 1e-9  # of a number of members


def forecast(mission: AssessedMission) -> Iterator[Found]:
    """Legs where the wind is not known: outside of the forecast's area or times, or above its levels."""
    wind = mission.flown.wind
    unknown = np.isnan(wind.winds[:, 0])
    for number, index in _first(mission, unknown):
        leg = mission.legs[number]
        reason = wind.reason if wind.refused[index] else None
        yield on_leg(mission, leg, "forecast", "danger", at=mission.flown.samples.places[index], reason=reason)


def wind(mission: AssessedMission) -> Iterator[Found]:
    """Legs in stronger wind than allowed."""
    limit = mission.case.limits.wind
    if limit is not None:
        yield from _stronger(mission, winds_of(mission), limit, "wind")


def gust(mission: AssessedMission) -> Iterator[Found]:
    """Legs in stronger gusts than allowed, in whatever member."""
    limit = mission.case.limits.gust
    gusts = gusts_of(mission)
    if limit is None or gusts is None:
        return
    yield from _stronger(mission, gusts[None], limit, "gust")


def winds_of(mission: AssessedMission) -> FloatArray:
    """The wind at each sample (m, k) [m/s] in each member of an ensemble, or the one wind."""
    flown = mission.flown
    members = [known_wind(field, flown.samples.places, flown.passed).winds for field in mission.case.scene.members]
    return np.array([np.hypot(one[:, 0], one[:, 1]) for one in members or [flown.wind.winds]])


def strongest_wind(mission: AssessedMission) -> float:
    """The strongest wind met in any member [m/s], 0 where none is known."""
    return float(np.nanmax(winds_of(mission), initial=0.0))


def gusts_of(mission: AssessedMission) -> FloatArray | None:
    """The strongest gust of any member at each sample (k,) [m/s], None where none are known."""
    samples, passed = mission.flown.samples, mission.flown.passed
    members = [known_wind(field, samples.places, passed).winds for field in mission.case.scene.gusts]
    if not members or not len(passed):
        return None
    return np.asarray(np.max([np.hypot(one[:, 0], one[:, 1]) for one in members], axis=0))


def strongest_gust(mission: AssessedMission) -> float | None:
    """The strongest gust met [m/s], None where none are known."""
    gusts = gusts_of(mission)
    return None if gusts is None or np.isnan(gusts).all() else float(np.nanmax(gusts))


def _stronger(mission: AssessedMission, speeds: FloatArray, limit: float, what: str) -> Iterator[Found]:
    """The legs on which speeds at the samples in members (m, k) exceed a limit [m/s]; one finding for all in a row."""
    samples, moves = mission.flown.samples, mission.track.leg_moves
    parts = [np.nan_to_num(speeds[:, samples.first[move] : samples.first[move + 1]]) for move in moves]
    peaks = np.array([part.max(axis=1) for part in parts]).reshape(len(moves), len(speeds))
    broken = (peaks > limit + _SLACK).sum(axis=1)
    for first, last in runs([bool(count) for count in broken]):
        worst = first + int(np.argmax(peaks[first : last + 1].max(axis=1)))
        leg, most = mission.legs[worst], float(peaks[worst].max())
        count, members = int(broken[first : last + 1].max()), len(speeds)
        at = int(samples.first[moves[worst]]) + int(np.argmax(parts[worst].max(axis=0)))
        yield on_leg(
            mission, leg, what, severity_in(count, members, mission.case.robust), at=samples.places[at], value=most,
            limit=limit, unit="m/s", first_leg=first + 1, last_leg=last + 1, members=members, broken_in=count,
        )  # fmt: skip


def severity_in(count: int, members: int, robust: float) -> Severity:
    """What breaks in so many of the members: a warning in as many as the share `robust` leaves over."""
    return "warning" if members > 1 and count <= (1 - robust) * members + _ROUNDING else "danger"


def _first(mission: AssessedMission, flags: BoolArray) -> Iterator[tuple[int, int]]:
    """The legs that have a flagged sample (k,), and the first of these."""
    first = mission.flown.samples.first
    for number, move in enumerate(mission.track.leg_moves):
        found = np.flatnonzero(flags[first[move] : first[move + 1]])
        if len(found):
            yield number, int(first[move] + found[0])
