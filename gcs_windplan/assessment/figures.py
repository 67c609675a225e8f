"""The stops and legs of a mission as flown, and its totals."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from gcs_windplan.arrays import FloatArray
from gcs_windplan.assessment.assessment import AssessedLeg, MissionTotals, Stop
from gcs_windplan.assessment.case import Case
from gcs_windplan.assessment.flown import Flown
from gcs_windplan.assessment.heights import Heights
from gcs_windplan.assessment.returning import WaysBack, ways_home, ways_to_rally, with_energies
from gcs_windplan.assessment.track import Track


@dataclass(frozen=True, slots=True, eq=False)
class AssessedMission:
    """All that the rules look at: the case, the mission as flown, its stops and legs.

    `legs[i]` leads from `stops[i]` to `stops[i + 1]` and is the move `track.leg_moves[i]`. `distances` (n + 1,) [m] are
    level, at the beginnings of the moves. `back` and `aside` are the ways from the stops home and to a rally point.
    """

    case: Case
    flown: Flown
    heights: Heights
    distances: FloatArray
    stops: tuple[Stop, ...]
    legs: tuple[AssessedLeg, ...]
    back: WaysBack
    aside: WaysBack | None

    @property
    def track(self) -> Track:
        """The track."""
        return self.flown.track


def assessed_mission(flown: Flown, heights: Heights, case: Case) -> AssessedMission:
    """The stops and legs of a mission as flown."""
    track = flown.track
    distances = np.concatenate([[0.0], np.cumsum(track.per_move(track.levels))])
    stops, home = _stops(flown, distances, case), track.course.home
    back, aside = ways_home(stops, home, case), ways_to_rally(stops, home, case)
    return AssessedMission(
        case, flown, heights, distances, with_energies(stops, back, aside), _legs(flown, heights, case), back, aside
    )


def share_used(flown: Flown, case: Case) -> FloatArray | None:
    """The share of the battery that is used before each move, and after all (n + 1,)."""
    if flown.energies is None or case.airframe is None:
        return None
    return np.concatenate([[0.0], np.cumsum(flown.energies)]) / case.airframe.battery.capacity


def _stops(flown: Flown, distances: FloatArray, case: Case) -> tuple[Stop, ...]:
    """Over the take-off, and the ends of all legs."""
    track = flown.track
    first = int(track.leg_moves[0]) if len(track.leg_moves) else len(track.moves)
    over_home = track.moves[first - 1].end if first else track.course.home
    places = np.array([over_home, *(track.moves[i].end for i in track.leg_moves)])
    ground = case.scene.terrain.heights_at(places)
    latitudes, longitudes = case.scene.frame.to_geographic(places)
    stops = []
    for number, after in enumerate([first, *(track.leg_moves + 1)]):
        move = track.moves[after - 1] if number else None  # None: it is over the take-off
        hold = 0.0 if move is None else float(flown.holds[after - 1])
        landing = _lands_here(track, after)
        stops.append(
            Stop(
                number=number,
                item=landing or (0 if move is None else move.item),
                label="land" if landing else "take-off" if move is None else move.label,
                latitude_deg=float(latitudes[number]),
                longitude_deg=float(longitudes[number]),
                altitude=float(places[number, 2]),
                above_ground=float(places[number, 2] - ground[number]),
                east=float(places[number, 0]),
                north=float(places[number, 1]),
                distance=float(distances[after]),
                seconds=float(flown.begins[after] - hold),
                hold=hold + _waiting(flown, after),
                left=_left(flown, after, move is not None, case),
            )
        )
    return tuple(stops)


def _left(flown: Flown, after: int, holds: bool, case: Case) -> float | None:
    """The share of the battery that is left on arrival at the end of a move, before it holds there."""
    used = share_used(flown, case)
    if used is None or case.airframe is None:
        return None
    hold = float(flown.waiting[after - 1]) if holds and flown.waiting is not None else 0.0
    return float(1 - used[after] + hold / case.airframe.battery.capacity)


def _waiting(flown: Flown, after: int) -> float:
    """How long it waits in place before the next leg [s]."""
    track, waited = flown.track, 0.0
    while after < len(track.moves) and track.moves[after].label == "wait":
        waited += float(flown.seconds[after])
        after += 1
    return waited


def _lands_here(track: Track, after: int) -> int:
    """The item that lands where a leg ended, 0 where none does."""
    while after < len(track.moves) and track.moves[after].label == "wait":
        after += 1
    if after < len(track.moves) and track.moves[after].kind == "landing" and track.moves[after - 1].label != "return":
        return track.moves[after].item
    return 0


def _legs(flown: Flown, heights: Heights, case: Case) -> tuple[AssessedLeg, ...]:
    track, motion = flown.track, flown.motion
    means = _Means(
        levels=track.per_move(track.levels),
        lengths=track.per_move(track.lengths),
        along=flown.samples.means(motion.along),
        across=flown.samples.means(motion.across),
        air=flown.in_time(motion.air),
        ground=flown.in_time(motion.ground),
        turns=np.degrees(case.scene.frame.convergence(np.array([np.add(m.start, m.end) / 2 for m in track.moves]))),
    )
    return tuple(_leg(number, int(i), means, flown, heights) for number, i in enumerate(track.leg_moves, start=1))


@dataclass(frozen=True, slots=True, eq=False)
class _Means:
    """Of n moves, (n,) each: lengths [m], mean winds and speeds [m/s], and true north from grid north [deg]."""

    levels: FloatArray
    lengths: FloatArray
    along: FloatArray
    across: FloatArray
    air: FloatArray
    ground: FloatArray
    turns: FloatArray


def _leg(number: int, i: int, means: _Means, flown: Flown, heights: Heights) -> AssessedLeg:
    """The leg that is move i."""
    move, stopped = flown.track.moves[i], flown.stopped[i] > 0
    east, north, climb = np.subtract(move.end, move.start)
    distance, moving = float(means.levels[i]), float(flown.moving[i])
    along, across = float(means.along[i]), float(means.across[i])
    track_deg = math.degrees(math.atan2(east, north)) + float(means.turns[i])
    crab = math.degrees(math.atan2(-across, means.ground[i] - along)) if distance > 0 else 0.0
    return AssessedLeg(
        number=number,
        item=move.item,
        track_deg=track_deg % 360,
        heading_deg=(track_deg + crab) % 360,
        distance=distance,
        length=float(means.lengths[i]),
        climb=float(climb),
        gradient=float(climb / distance) if distance > 0 else 0.0,
        ground_speed=distance / moving if moving > 0 and not stopped else 0.0,
        airspeed=float(means.air[i]),
        wind_along=along,
        wind_across=across,
        seconds=math.inf if stopped else moving,
        clearance=float(heights.lowest[i]),
        height=float(heights.highest[i]),
        energy=None if flown.flying is None else float(flown.flying[i]),
    )


def totals_of(mission: AssessedMission, wind: float, gust: float | None, reserve: float | None) -> MissionTotals:
    """The whole mission; `wind` and `gust` are the strongest met [m/s], `reserve` what must be left."""
    flown, track, legs = mission.flown, mission.track, mission.legs
    kinds = np.array([move.kind for move in track.moves])
    clearances = [leg.clearance for leg in legs if not math.isnan(leg.clearance)]
    peaks = [leg.height for leg in legs if not math.isnan(leg.height)]
    used = share_used(flown, mission.case)
    return MissionTotals(
        seconds=math.inf if flown.stopped.any() else float(flown.begins[-1]),
        takeoff_seconds=float(flown.seconds[kinds == "take-off"].sum()),
        landing_seconds=float(flown.seconds[kinds == "landing"].sum()),
        distance=math.fsum(leg.distance for leg in legs),
        length=math.fsum(leg.length for leg in legs),
        climb=math.fsum(max(leg.climb, 0.0) for leg in legs),
        descent=math.fsum(max(-leg.climb, 0.0) for leg in legs),
        clearance=min(clearances, default=math.nan),
        height=max(peaks, default=math.nan),
        wind=wind,
        gust=gust,
        energy=None if flown.energies is None else math.fsum(flown.energies),
        left=None if used is None else float(1 - used[-1]),
        reserve=reserve,
    )
