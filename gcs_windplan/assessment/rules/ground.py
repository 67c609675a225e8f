"""Rules of the ground: whether it is known, how near legs come, how high above it they lead, what stands on it."""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np

from gcs_windplan.arrays import FloatArray
from gcs_windplan.assessment.assessment import AssessedLeg
from gcs_windplan.assessment.figures import AssessedMission
from gcs_windplan.assessment.rules.places import Found, on_leg, on_move

_SLACK = 0.02  # [m] what rounding to 1e-7 degrees and centimetres may have taken
_CHORDS = 72  # of a circle
_TOUCH = 2.0  # [m] a fixed-wing may be so far below the terrain model's ground where it lands


def ground(mission: AssessedMission) -> Iterator[Found]:
    """Legs over ground that is not known."""
    terrain = mission.case.scene.terrain
    for leg, move in _legs(mission):
        place = mission.heights.unknown_at[move]
        if np.isnan(place[0]):
            continue
        end = mission.track.moves[move].end
        outside = max(terrain.extent.misses(place[0], place[1]), terrain.extent.misses(end[0], end[1]))
        yield on_leg(
            mission, leg, "terrain", "danger", at=place, value=outside, limit=0.0, unit="m", terrain=terrain.name
        )


def clearance(mission: AssessedMission) -> Iterator[Found]:
    """Legs too near to the ground, or below it."""
    limit = mission.case.limits.clearance
    for leg, move in _legs(mission):
        lowest = float(mission.heights.known[move, 0])
        least = 0.0 if limit is None else limit
        if not mission.case.hovers and mission.track.moves[move].label == "land":
            least = -_TOUCH
        if math.isnan(lowest) or lowest >= least - _SLACK:
            continue
        place = mission.heights.lowest_at[move]
        yield on_leg(mission, leg, "clearance", "danger", at=place, value=lowest, limit=least, unit="m")


def circles(mission: AssessedMission) -> Iterator[Found]:
    """Circles at loiters, too near to the ground."""
    limit, terrain = mission.case.limits.clearance or 0.0, mission.case.scene.terrain
    for leg, move in _legs(mission):
        radius = mission.track.moves[move].radius
        if radius <= 0:
            continue
        centre = np.array(mission.track.moves[move].end)
        turned = np.append(np.arange(_CHORDS), 0) * (2 * math.pi / _CHORDS)
        ring = centre + radius * np.column_stack([np.sin(turned), np.cos(turned), 0 * turned])
        low = terrain.leg_heights(ring[:-1].copy(), ring[1:].copy())[:, 0]
        worst = int(np.argmin(np.where(np.isnan(low), np.inf, low)))
        if low[worst] < limit - _SLACK:
            yield on_leg(
                mission, leg, "circle", "danger", at=ring[worst], value=float(low[worst]), limit=limit, unit="m",
                radius=radius,
            )  # fmt: skip


def height(mission: AssessedMission) -> Iterator[Found]:
    """Legs too high above the ground."""
    limit = mission.case.limits.max_height
    if limit is None:
        return
    for leg, move in _legs(mission):
        highest = float(mission.heights.known[move, 1])
        if not math.isnan(highest) and highest > limit + _SLACK:
            yield on_leg(
                mission, leg, "height", "danger", at=mission.heights.highest_at[move], value=highest, limit=limit,
                unit="m", returning=mission.track.moves[move].label == "return",
            )  # fmt: skip


def obstacles(mission: AssessedMission) -> Iterator[Found]:
    """Legs, take-offs and landings too near to an obstacle."""
    standing, track = mission.case.scene.obstacles, mission.track
    if standing is None or not len(track.starts):
        return
    margins = standing.leg_margins(track.starts, track.ends)
    for move in np.unique(track.owners[margins < -_SLACK]):
        pieces = np.flatnonzero(track.owners == move)
        worst = int(pieces[np.argmin(margins[pieces])])
        place = _nearest(mission, worst)
        yield on_move(mission, int(move), "obstacle", place, value=float(margins[worst]), unit="m")


def _nearest(mission: AssessedMission, piece: int) -> FloatArray:
    """Where a piece is nearest to an obstacle: the half that is nearer is kept."""
    standing, track = mission.case.scene.obstacles, mission.track
    assert standing is not None
    start, end = track.starts[piece], track.ends[piece]
    for _ in range(20):
        middle = (start + end) / 2
        first, second = standing.leg_margins(np.array([start, middle]), np.array([middle, end]))
        start, end = (middle, end) if second < first else (start, middle)
    return np.asarray((start + end) / 2)


def _legs(mission: AssessedMission) -> Iterator[tuple[AssessedLeg, int]]:
    for leg, move in zip(mission.legs, mission.track.leg_moves, strict=True):
        yield leg, int(move)
