"""A track as flown: when each move is flown, in what wind, at what airspeed, and what that takes."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import Final

import numpy as np

from gcs_windplan.arrays import FloatArray, IntArray
from gcs_windplan.assessment.case import Case
from gcs_windplan.assessment.known import KnownWind, known_wind
from gcs_windplan.assessment.motion import (
    Motion,
    MotionCommand,
    circling_watts,
    energy,
    motion_in,
    waiting_watts,
    watts,
)
from gcs_windplan.assessment.track import Track
from gcs_windplan.flight.duration import circling_seconds, circling_speed, time_course

_FEWEST, _MOST = 4, 160  # samples of a piece
_MOST_ALL: Final = 60_000  # samples of a mission
_ROUNDS: Final = 6  # of putting the clock in again
_SAME_TIME: Final = 0.05  # [s]
_HOP: Final = 2.8  # [s] measured: the least that a return takes to come to rest above home


@dataclass(frozen=True, slots=True, eq=False)
class Samples:
    """Places along the moves, in the middles of equal parts of the pieces.

    k of them: their `piece` and `move`, the `share` of the move's length that each stands for, how far `along` the move
    it is (0 to 1), the place (k, 3) and direction (k, 3). `first` (n + 1,) is where each move's samples begin.
    """

    piece: IntArray
    move: IntArray
    share: FloatArray
    along: FloatArray
    places: FloatArray
    direction: FloatArray
    first: IntArray

    def sums(self, values: FloatArray) -> FloatArray:
        """The sums of values (k,) over each move (n,)."""
        return np.asarray(np.bincount(self.move, weights=values, minlength=len(self.first) - 1), dtype=np.float64)

    def means(self, values: FloatArray) -> FloatArray:
        """The means of values (k,) along each move (n,)."""
        return self.sums(self.share * values)


@dataclass(frozen=True, slots=True, eq=False)
class Flown:
    """The track as flown, n moves and k samples.

    `begins` (n + 1,) is when each move begins [s since departure], the last one when all is over; of a move that cannot
    be flown the time without wind is counted, and `stopped` (n,) says so. `moving` (n,) is a move's time without its
    hold. `passed` (k,) is when each sample is passed. `energies` (n,) [J] with those of the holds, `waiting`, both None
    where the airframe is not known. `peaks` (n,) [m/s] along the slope.
    """

    track: Track
    samples: Samples
    wind: KnownWind
    motion: Motion
    begins: FloatArray
    moving: FloatArray
    holds: FloatArray
    passed: FloatArray
    stopped: FloatArray
    peaks: FloatArray
    energies: FloatArray | None = None
    waiting: FloatArray | None = None

    def in_time(self, values: FloatArray) -> FloatArray:
        """The means of the samples' values (k,) over each move's time (n,)."""
        pace = self.samples.share / np.where(self.motion.speed > 0, self.motion.speed, 1.0)
        return np.asarray(self.samples.sums(pace * values) / self.samples.sums(pace))

    @property
    def flying(self) -> FloatArray | None:
        """What each move takes without its hold (n,) [J]."""
        return None if self.energies is None or self.waiting is None else self.energies - self.waiting

    @property
    def seconds(self) -> FloatArray:
        """What each move takes, its hold included (n,)."""
        return np.diff(self.begins)


def fly_track(track: Track, case: Case) -> Flown:
    """Fly a track; the wind is that of the moment when each place is passed."""
    samples = sample(track, case)
    passed = np.zeros(len(samples.move))
    begins = np.zeros(len(track.moves) + 1)
    for _ in range(_ROUNDS if len(case.scene.wind.times) > 1 else 1):
        wind = known_wind(case.scene.wind, samples.places, passed)
        flown = _timed(track, samples, wind, case)
        moved = float(np.abs(flown.begins - begins).max(initial=0.0))
        begins, passed = flown.begins, flown.passed
        if moved < _SAME_TIME:
            break
    return _with_energies(flown, case)


def sample(track: Track, case: Case) -> Samples:
    """The samples of a track: four in each cell of the wind, at least four in a piece of a leg."""
    apart = case.scene.wind.resolution / 4
    whole = np.array([len(path) == 2 for path in track.paths])[track.owners]  # the pieces of curves are short already
    counts = np.clip(np.ceil(track.levels / apart), np.where(whole, _FEWEST, 1), _MOST)
    while counts.sum() > _MOST_ALL and counts.max() > 1:
        counts = np.maximum(np.ceil(counts / 2), 1)
    counts = counts.astype(np.int64)
    piece = np.repeat(np.arange(len(counts)), counts)
    nth = np.arange(len(piece)) - (np.cumsum(counts) - counts)[piece]
    t = (nth + 0.5) / counts[piece]
    vectors = track.ends - track.starts
    totals = track.per_move(track.lengths)
    flat = totals[track.owners] <= 0  # a move of no length: all of its samples count alike
    lengths = np.where(flat, 1.0, track.lengths)
    totals = np.where(totals > 0, totals, track.per_move(np.ones(len(lengths))))
    before = np.cumsum(lengths) - lengths
    before -= before[track.firsts[:-1]][track.owners]
    owner = track.owners[piece]
    share = lengths[piece] / counts[piece] / totals[owner]
    along = (before[piece] + t * lengths[piece]) / totals[owner]
    direction = vectors / np.where(track.lengths > 0, track.lengths, 1.0)[:, None]
    of_move = np.bincount(owner, minlength=len(track.moves))
    first = np.concatenate([[0], np.cumsum(of_move)]).astype(np.int64)
    return Samples(
        piece, owner, share, along, track.starts[piece] + t[:, None] * vectors[piece], direction[piece], first
    )


def commands_of(track: Track, moves: IntArray, direction: FloatArray, peaks: FloatArray, case: Case) -> MotionCommand:
    """How samples of moves are commanded; `peaks` (n,) [m/s] are the moves' speeds along the slope."""
    told = [move.told for move in track.moves]
    ground = np.array([math.nan if one.ground is None else one.ground for one in told])
    air = np.array([case.cruise if one.air is None else one.air for one in told])
    return MotionCommand(direction, peaks[moves], np.nan_to_num(ground)[moves], air[moves])


def _timed(track: Track, samples: Samples, wind: KnownWind, case: Case) -> Flown:
    """The track in the winds at its samples."""
    winds = wind.filled
    moving, peaks = _moving(track, samples, winds, case)
    command = commands_of(track, samples.move, samples.direction, peaks, case)
    motion = motion_in(winds, command, case)
    lengths = track.per_move(track.lengths)
    stopped = np.zeros(len(track.moves))
    np.maximum.at(stopped, samples.move, motion.stopped.astype(np.float64))
    stopped[(lengths <= 0) & ~np.isfinite(moving)] = 1
    moving = _slowed(moving, samples, motion, peaks, lengths, case)
    holds = np.array([move.hold for move in track.moves]) + _circling(track, case) + _hops(track, moving)
    begins = np.concatenate([[0.0], np.cumsum(moving + holds)])
    pace = samples.share / np.where(motion.speed > 0, motion.speed, 1.0)
    whole = samples.sums(pace)
    part = pace / whole[samples.move]
    gone = np.cumsum(part) - part / 2
    starts = np.concatenate([[0.0], np.cumsum(samples.sums(part))])[:-1]
    passed = begins[:-1][samples.move] + (gone - starts[samples.move]) * moving[samples.move]
    return Flown(track, samples, wind, motion, begins, moving, holds, passed, stopped, peaks)


def _moving(track: Track, samples: Samples, winds: FloatArray, case: Case) -> tuple[FloatArray, FloatArray]:
    """What each move takes without its hold [s], infinite where the wind is too strong, and its speed."""
    means = np.column_stack([samples.means(winds[:, axis]) for axis in range(3)])
    lengths = track.per_move(track.lengths)
    if case.hovers:
        course = replace(track.course, moves=track.moves)
        times = time_course(course, means, case.pace)
        seconds = times.seconds - np.array([move.hold for move in track.moves]) - _circling(track, case)
        straight = np.linalg.norm([np.subtract(move.end, move.start) for move in track.moves], axis=1)
        peaks = np.where(times.peaks > 0, times.peaks, _speeds_upright(track, case))
        curves = np.maximum(lengths - straight, 0.0) / np.maximum(peaks, 0.01)  # by how much a curve is longer
        return seconds + np.where(np.isfinite(seconds), curves, 0.0), peaks
    command = commands_of(track, samples.move, samples.direction, _speeds_upright(track, case), case)
    motion = motion_in(winds, command, case)
    with np.errstate(divide="ignore"):
        seconds = samples.sums(samples.share / np.where(motion.stopped, 0.0, motion.speed)) * lengths
    return np.where(lengths > 0, seconds, 0.0), command.slope[samples.first[:-1].clip(max=len(samples.move) - 1)]


def _speeds_upright(track: Track, case: Case) -> FloatArray:
    """The speed [m/s] of each move if it were straight up or down (n,)."""
    up = np.array([move.end[2] >= move.start[2] for move in track.moves])
    climbs = np.array([case.pace.climb if move.told.climb is None else move.told.climb for move in track.moves])
    descents = np.array([case.pace.descent if move.told.descent is None else move.told.descent for move in track.moves])
    return np.where(up, climbs, descents)


def _slowed(
    moving: FloatArray, samples: Samples, motion: Motion, peaks: FloatArray, lengths: FloatArray, case: Case
) -> FloatArray:
    """The times with what stronger wind in places costs beyond that in the mean; without wind where it is stopped."""
    if not case.hovers:
        still = samples.sums(samples.share / np.maximum(motion.air, 0.01)) * lengths
        return np.where(np.isfinite(moving), moving, still)
    still = lengths / np.maximum(peaks, 0.01)
    local = samples.sums(samples.share / np.where(motion.stopped, np.inf, np.maximum(motion.speed, 0.01))) * lengths
    reached = samples.sums(samples.share / np.maximum(peaks[samples.move], 0.01)) * lengths
    steady = np.where(np.isfinite(moving), moving, still)
    return np.asarray(steady + np.maximum(local - reached, 0.0))


def _hops(track: Track, moving: FloatArray) -> FloatArray:
    """What a return that begins next to home takes more than its way (n,) [s]."""
    back = np.array([move.label == "return" and move.hold > 0 for move in track.moves])
    return np.where(back, np.maximum(_HOP - moving, 0.0), 0.0)


def _circling(track: Track, case: Case) -> FloatArray:
    """How long it circles at the ends of its moves (n,) [s]; wind makes circles no shorter."""
    if case.hovers:
        return np.array([circling_seconds(move, case.pace) for move in track.moves])
    metres = np.array([move.circling for move in track.moves])
    airspeeds = np.array([case.cruise if move.told.air is None else move.told.air for move in track.moves])
    return np.asarray(metres / airspeeds)


def _with_energies(flown: Flown, case: Case) -> Flown:
    """The same with what each move and its hold take from the battery."""
    samples, track = flown.samples, flown.track
    power = watts(flown.motion, samples.places[:, 2], case)
    if power is None:
        return flown
    last = samples.first[1:] - 1
    ends = np.array([move.end for move in track.moves])
    hovering = waiting_watts(flown.wind.filled[last], ends[:, 2], np.zeros(len(ends)), case)
    assert hovering is not None
    waiting = energy(hovering, flown.holds)
    if case.hovers:
        speeds = np.array([circling_speed(move, case.pace) if move.circling > 0 else 0.0 for move in track.moves])
        turning = circling_watts(flown.wind.filled[last], ends[:, 2], speeds, case)
        assert turning is not None
        waiting += (turning - hovering) * _circling(track, case)
    return replace(flown, energies=energy(flown.in_time(power), flown.moving) + waiting, waiting=waiting)
