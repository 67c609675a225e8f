"""Rules of the wind: as far as it is known, how strong it is, how strong its gusts are."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from gcs_windplan.arrays import BoolArray, FloatArray
from gcs_windplan.assessment.figures import Judged
from gcs_windplan.assessment.known import known_wind
from gcs_windplan.assessment.rules.saying import Found, leg_name, on_leg

_SLACK = 1e-3  # [m/s]


def forecast(mission: Judged) -> Iterator[Found]:
    """Legs where the wind is not known: outside of the forecast's area or times, or above its levels."""
    wind = mission.flown.wind
    unknown = np.isnan(wind.winds[:, 0])
    for number, index in _first(mission, unknown):
        leg = mission.legs[number]
        why = wind.said if wind.refused[index] and wind.said else "it rises above the highest level of the wind"
        yield on_leg(
            mission, leg, "forecast", "danger",
            f"{leg_name(leg)}: the wind is not known there and taken as still air: {why}",
            at=mission.flown.samples.places[index],
        )  # fmt: skip


def wind(mission: Judged) -> Iterator[Found]:
    """Legs in stronger wind than allowed."""
    limit = mission.case.limits.wind
    if limit is None:
        return
    blowing = np.hypot(*mission.flown.wind.winds[:, :2].T)
    yield from _stronger(mission, blowing, limit, "wind")


def gust(mission: Judged) -> Iterator[Found]:
    """Legs in stronger gusts than allowed."""
    limit = mission.case.limits.gust
    gusts = gusts_of(mission)
    if limit is None or gusts is None:
        return
    yield from _stronger(mission, gusts, limit, "gust")


def gusts_of(mission: Judged) -> FloatArray | None:
    """The strongest gust of any member at each sample (k,) [m/s], None where none are known."""
    samples, passed = mission.flown.samples, mission.flown.passed
    members = [known_wind(field, samples.places, passed).winds for field in mission.case.gusts]
    if not members or not len(passed):
        return None
    return np.asarray(np.max([np.hypot(one[:, 0], one[:, 1]) for one in members], axis=0))


def strongest_gust(mission: Judged) -> float | None:
    """The strongest gust met [m/s], None where none are known."""
    gusts = gusts_of(mission)
    return None if gusts is None or np.isnan(gusts).all() else float(np.nanmax(gusts))


def _stronger(mission: Judged, speeds: FloatArray, limit: float, what: str) -> Iterator[Found]:
    """The legs on which speeds at the samples (k,) exceed a limit [m/s]."""
    samples = mission.flown.samples
    for leg, move in zip(mission.legs, mission.track.leg_moves, strict=True):
        part = slice(int(samples.first[move]), int(samples.first[move + 1]))
        here = np.nan_to_num(speeds[part])
        worst = int(np.argmax(here))
        if here[worst] > limit + _SLACK:
            yield on_leg(
                mission, leg, what, "danger",
                f"{leg_name(leg)} meets {'gusts' if what == 'gust' else 'wind'} of {here[worst]:.1f} m/s, more than the"
                f" limit of {limit:g} m/s: another departure or a lower or more sheltered way",
                at=samples.places[part][worst], value=float(here[worst]), limit=limit, unit="m/s",
            )  # fmt: skip


def _first(mission: Judged, flags: BoolArray) -> Iterator[tuple[int, int]]:
    """The legs that have a flagged sample (k,), and the first of these."""
    first = mission.flown.samples.first
    for number, move in enumerate(mission.track.leg_moves):
        found = np.flatnonzero(flags[first[move] : first[move + 1]])
        if len(found):
            yield number, int(first[move] + found[0])
