"""Rules of areas: keep-out, keep-in, and the mission's own fence; each says where it is first broken."""

from __future__ import annotations

import math
from collections.abc import Iterator
from itertools import pairwise

import numpy as np

from gcs_windplan.arrays import FloatArray
from gcs_windplan.assessment.assessment import Outline
from gcs_windplan.assessment.figures import AssessedMission
from gcs_windplan.assessment.outlines import outlines_of
from gcs_windplan.assessment.rules.places import Found, on_move
from gcs_windplan.assessment.track import is_leg
from gcs_windplan.kernels.airspace import inside, legs_leaving, legs_through

_SLACK = 0.02  # [m] what rounding to 1e-7 degrees and centimetres may have moved
_INSIDE = np.linspace(0.125, 0.875, 7)  # shares of a way between two borders


def areas(mission: AssessedMission) -> Iterator[Found]:
    """Legs inside of what they must keep out of, or outside of what they must keep in; take-offs and landings inside.

    These begin and end below what a keep-in may have for a floor.
    """
    track = mission.track
    for outline in outlines_of(mission.case):
        if outline.kind == "obstacle":
            continue  # these are no prisms, and have a rule of their own
        rule = "fence" if outline.kind.startswith("fence") else outline.kind
        found: set[int] = set()
        for piece in np.flatnonzero(_broken(outline, track.starts, track.ends)):
            move = int(track.owners[piece])
            if move in found or not (is_leg(track.moves[move]) or outline.kind.endswith("out")):
                continue
            place = _first_break(outline, track.starts[piece], track.ends[piece])
            if place is None:
                continue
            found.add(move)
            yield on_move(mission, move, rule, place, kind=outline.kind, area=outline.name)


def _broken(outline: Outline, starts: FloatArray, ends: FloatArray) -> FloatArray:
    """Which pieces break an area (m,)."""
    floor = -math.inf if outline.floor is None else outline.floor
    ceiling = math.inf if outline.ceiling is None else outline.ceiling
    test = legs_through if outline.kind.endswith("out") else legs_leaving
    return np.asarray(test(np.ascontiguousarray(outline.corners), floor, ceiling, starts, ends))


def _first_break(outline: Outline, start: FloatArray, end: FloatArray) -> FloatArray | None:
    """Where a piece that breaks an area first does; None where it only grazes it."""
    cuts = np.unique(np.clip(_cuts(outline, start, end), 0.0, 1.0))
    for before, after in pairwise(np.concatenate([[0.0], cuts, [1.0]])):
        between = start + (before + _INSIDE[:, None] * (after - before)) * (end - start)
        if any(_breaks(outline, place) for place in between):
            return np.asarray(start + before * (end - start))
    return None


def _cuts(outline: Outline, start: FloatArray, end: FloatArray) -> FloatArray:
    """The shares of a piece at which it crosses the area's border, its floor or its ceiling."""
    vector = end - start
    corners, sides = outline.corners, np.roll(outline.corners, -1, axis=0) - outline.corners
    from_start = corners - start[:2]
    turn = vector[0] * sides[:, 1] - vector[1] * sides[:, 0]
    with np.errstate(divide="ignore", invalid="ignore"):
        along = (from_start[:, 0] * sides[:, 1] - from_start[:, 1] * sides[:, 0]) / turn
        across = (from_start[:, 0] * vector[1] - from_start[:, 1] * vector[0]) / turn
    found = along[(turn != 0) & (across >= 0) & (across <= 1) & (along > 0) & (along < 1)]
    levels = [level for level in (outline.floor, outline.ceiling) if level is not None and vector[2] != 0]
    return np.concatenate([found, [(level - start[2]) / vector[2] for level in levels]])


def _breaks(outline: Outline, place: FloatArray) -> bool:
    """Whether a place is where the area forbids it, by more than rounding."""
    floor = -math.inf if outline.floor is None else outline.floor
    ceiling = math.inf if outline.ceiling is None else outline.ceiling
    deep = min(place[2] - floor, ceiling - place[2], _depth(outline.corners, place))
    return bool(deep > _SLACK if outline.kind.endswith("out") else deep < -_SLACK)


def _depth(corners: FloatArray, place: FloatArray) -> float:
    """How far inside of a polygon a place lies [m], negative outside."""
    sides = np.roll(corners, -1, axis=0) - corners
    away = place[:2] - corners
    share = np.clip((away * sides).sum(axis=1) / np.maximum((sides**2).sum(axis=1), 1e-12), 0.0, 1.0)
    border = float(np.hypot(*(away - share[:, None] * sides).T).min())
    return border if inside(corners, place[0], place[1]) else -border
