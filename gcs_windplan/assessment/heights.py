"""How high a track's legs are above the ground, exactly, and where they are lowest and highest."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from gcs_windplan.arrays import FloatArray, IntArray
from gcs_windplan.assessment.track import Track
from gcs_windplan.terrain import Terrain

_HALVINGS = 30


@dataclass(frozen=True, slots=True, eq=False)
class Heights:
    """Of each move (n,) [m]: the smallest and the largest height above ground and where, as places (n, 3).

    NaN where any part of the move lies over unknown ground; `known` (n, 2) are those over the ground that is known.
    """

    lowest: FloatArray
    highest: FloatArray
    lowest_at: FloatArray
    highest_at: FloatArray
    known: FloatArray
    unknown_at: FloatArray


def heights_of(track: Track, terrain: Terrain) -> Heights:
    """The heights of every move of a track."""
    count = len(track.moves)
    found = terrain.leg_heights(track.starts, track.ends)
    low, at_low = _least(found[:, 0], track, count)
    high, at_high = _least(-found[:, 1], track, count)
    gaps = np.flatnonzero(np.isnan(found[:, 0]))
    unknown = np.full((count, 3), np.nan)
    for piece in gaps[::-1]:
        unknown[track.owners[piece]] = _first_gap(track.starts[piece], track.ends[piece], terrain)
    gap = ~np.isnan(unknown[:, 0])
    return Heights(
        np.where(gap, np.nan, low),
        np.where(gap, np.nan, -high),
        _where(track, at_low, terrain, 0),
        _where(track, at_high, terrain, 1),
        np.column_stack([low, -high]),
        unknown,
    )


def _least(values: FloatArray, track: Track, count: int) -> tuple[FloatArray, IntArray]:
    """The smallest value of the pieces of each move, NaN without any, and its piece."""
    least, piece = np.full(count, np.nan), np.zeros(count, dtype=np.int64)
    for i in np.lexsort((values, track.owners))[::-1]:  # of each move the smallest comes last; NaN sort behind
        if not np.isnan(values[i]):
            least[track.owners[i]], piece[track.owners[i]] = values[i], i
    return least, piece


def _where(track: Track, pieces: IntArray, terrain: Terrain, side: int) -> FloatArray:
    """Where on a piece a height is reached, by halving: the half that reaches it is kept."""
    if not len(track.starts):
        return np.empty((0, 3))
    starts, ends = track.starts[pieces], track.ends[pieces]
    sign = -1.0 if side else 1.0
    for _ in range(_HALVINGS):
        middles = (starts + ends) / 2
        first = sign * terrain.leg_heights(starts, middles)[:, side]
        second = sign * terrain.leg_heights(middles, ends)[:, side]
        early = ~(second < first)
        starts, ends = np.where(early[:, None], starts, middles), np.where(early[:, None], middles, ends)
    return (starts + ends) / 2


def _first_gap(start: FloatArray, end: FloatArray, terrain: Terrain) -> FloatArray:
    """Where a piece first lies over unknown ground."""
    known, unknown = start, end
    if np.isnan(terrain.heights_at(start[None])[0]):
        return start
    for _ in range(_HALVINGS):
        middle = (known + unknown) / 2
        if np.isnan(terrain.leg_heights(start[None], middle[None])[0, 0]):
            unknown = middle
        else:
            known = middle
    return unknown
