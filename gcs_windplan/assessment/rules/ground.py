"""Rules of the ground: whether it is known, how near legs come, how high above it they lead, what stands on it."""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np

from gcs_windplan.arrays import FloatArray
from gcs_windplan.assessment.assessment import JudgedLeg
from gcs_windplan.assessment.figures import Judged
from gcs_windplan.assessment.rules.saying import Found, leg_name, metres, move_name, on_leg, on_move

_SLACK = 0.02  # [m] what rounding to 1e-7 degrees and centimetres may have taken
_CHORDS = 72  # of a circle
_TOUCH = 2.0  # [m] a fixed-wing may be so far below the terrain model's ground where it lands


def ground(mission: Judged) -> Iterator[Found]:
    """Legs over ground that is not known."""
    terrain = mission.case.terrain
    for leg, move in _legs(mission):
        place = mission.heights.unknown_at[move]
        if np.isnan(place[0]):
            continue
        end = mission.track.moves[move].end
        outside = max(terrain.extent.misses(place[0], place[1]), terrain.extent.misses(end[0], end[1]))
        where = "leads over a gap in" if outside <= 0 else "leaves"
        far = "" if outside <= 0 else f" by {metres(outside)}"
        yield on_leg(
            mission, leg, "terrain", "danger",
            f"{leg_name(leg)} {where} the terrain ({terrain.name}){far}; nothing is known of the ground there: add a"
            " tile that covers it, or move the leg",
            at=place, value=outside, limit=0.0, unit="m",
        )  # fmt: skip


def clearance(mission: Judged) -> Iterator[Found]:
    """Legs too near to the ground, or below it."""
    limit = mission.case.limits.clearance
    for leg, move in _legs(mission):
        lowest = float(mission.heights.known[move, 0])
        least = 0.0 if limit is None else limit
        if not mission.case.hovers and mission.track.moves[move].label == "land":
            least = -_TOUCH
        if math.isnan(lowest) or lowest >= least - _SLACK:
            continue
        raised = f"raise it there by {math.ceil(least - lowest):.0f} m" if least > 0 else "raise it"
        if lowest < 0:
            said = f"runs {-lowest:.1f} m below the ground"
        else:
            said = f"comes within {lowest:.1f} m of the ground, less than the clearance of {least:g} m"
        yield on_leg(
            mission, leg, "clearance", "danger", f"{leg_name(leg)} {said}: {raised}, or lead it around",
            at=mission.heights.lowest_at[move], value=lowest, limit=least, unit="m",
        )  # fmt: skip


def circles(mission: Judged) -> Iterator[Found]:
    """Circles at loiters, too near to the ground."""
    limit, terrain = mission.case.limits.clearance or 0.0, mission.case.terrain
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
                mission, leg, "circle", "danger",
                f"the circles of {radius:g} m at the end of {leg_name(leg)} come within {low[worst]:.1f} m of the"
                f" ground (clearance {limit:g} m): raise item {leg.item}, or circle elsewhere",
                at=ring[worst], value=float(low[worst]), limit=limit, unit="m",
            )  # fmt: skip


def height(mission: Judged) -> Iterator[Found]:
    """Legs too high above the ground."""
    limit = mission.case.limits.max_height
    if limit is None:
        return
    for leg, move in _legs(mission):
        highest = float(mission.heights.known[move, 1])
        if not math.isnan(highest) and highest > limit + _SLACK:
            yield on_leg(
                mission, leg, "height", "danger",
                f"{leg_name(leg)} is {highest:.1f} m above ground, more than the limit of {limit:g} m:"
                f" {_lower(mission, move, highest - limit)}",
                at=mission.heights.highest_at[move], value=highest, limit=limit, unit="m",
            )  # fmt: skip


def _lower(mission: Judged, move: int, excess: float) -> str:
    """What to do about a leg that is too high."""
    if mission.track.moves[move].label == "return":
        return "let it fly back by waypoints in place of the return"
    return f"lower it there by {math.ceil(excess):.0f} m, or add a waypoint where the ground falls"


def obstacles(mission: Judged) -> Iterator[Found]:
    """Legs, take-offs and landings too near to an obstacle."""
    standing, track = mission.case.obstacles, mission.track
    if standing is None or not len(track.starts):
        return
    margins = standing.leg_margins(track.starts, track.ends)
    for move in np.unique(track.owners[margins < -_SLACK]):
        pieces = np.flatnonzero(track.owners == move)
        worst = int(pieces[np.argmin(margins[pieces])])
        message = f"{move_name(mission, int(move))} comes {-margins[worst]:.1f} m closer to an obstacle than its margin"
        said = f"{message}: raise it or lead it around"
        yield on_move(mission, int(move), "obstacle", said, _nearest(mission, worst), float(margins[worst]), "m")


def _nearest(mission: Judged, piece: int) -> FloatArray:
    """Where a piece is nearest to an obstacle: the half that is nearer is kept."""
    standing, track = mission.case.obstacles, mission.track
    assert standing is not None
    start, end = track.starts[piece], track.ends[piece]
    for _ in range(20):
        middle = (start + end) / 2
        first, second = standing.leg_margins(np.array([start, middle]), np.array([middle, end]))
        start, end = (middle, end) if second < first else (start, middle)
    return np.asarray((start + end) / 2)


def _legs(mission: Judged) -> Iterator[tuple[JudgedLeg, int]]:
    for leg, move in zip(mission.legs, mission.track.leg_moves, strict=True):
        yield leg, int(move)
