"""Vertices that move while the cost falls: from the graph's directions to those that the wind and the ground ask for.

A graph knows 8 to 64 directions and a few heights; a route through it is a percent or so from the best. Here each
vertex tries places around it, all that are no neighbours at once, and moves where the two legs at it become cheaper
and stay clear. Steps grow with success and shrink without. When nothing moves any more, the legs are halved and the
finer polyline is relaxed again, until that gains nothing twice.

The directions turn by the golden angle from sweep to sweep. Where the wind jumps, the best route has a kink on the
jump's line, and all around it the cost rises: only a step along that line, wherever it lies, gains anything. So few
vertices try many directions: with 8 each they stuck up to 1.5 % above the best.
"""

from __future__ import annotations

from typing import Final

import numpy as np

from gcs_windplan.arrays import BoolArray, FloatArray, IntArray
from gcs_windplan.planning.cost import SectionCost
from gcs_windplan.scene import Clearance

_SWEEPS: Final = 120  # on one polyline, every other vertex at a time
_LONG: Final = 64  # vertices, from which on half as many must do: halving and thinning follow
_FIRST_STEP: Final = 0.25  # of the mean length of the two legs at a vertex
_TOUCH: Final = 0.05  # the first step where vertices are nearly at rest
_LAST_STEP: Final = 1.5e-3  # of the same, where a vertex comes to rest
_WORTH: Final = 1.5e-4  # of the cost, that halving all legs must gain
_PATIENCE: Final = 2  # halvings that are not worth it, one after the other, before it is given up
_MOST_VERTICES: Final = 129
_GROW, _SHRINK = 1.5, 0.6
_DIRECTIONS: Final = 64  # level ones that all vertices try in one sweep; each has its share, but at least 8
_GOLDEN: Final = 2.399963  # [rad] the golden angle: no direction comes twice
_RISE: Final = 0.1  # of a level step: heights differ less than places do
_LOOKS: Final = 16  # sweeps between two looks at the cost
_REST: Final = 5e-6  # of the cost: gaining less between two looks, vertices are at rest
_SPARE: Final = 5e-4  # of the cost, that fewer waypoints may take
_SHARE: Final = 0.05  # of what moving has gained, that they may take as well
_WITHIN: Final = 1e-3  # of the cost, that they may take in all


def relax(points: FloatArray, cost: SectionCost, clearance: Clearance, spare: float = _SPARE) -> FloatArray:
    """A polyline (m, 3) with the same ends that is never dearer than the given one (n, 3), all legs clear.

    Of all those found, the one with the fewest waypoints whose cost lies within 0.1 % of the cheapest, less where
    little was gained: within `spare` and a twentieth of the gain.
    """
    given = cost.of_polyline(points)
    if not np.isfinite(given):
        return points
    best, best_cost = settle(points, cost, clearance)
    if not best_cost <= given:  # in changing wind moves may come too late
        best, best_cost = points, given
    finer, patience = best, _PATIENCE
    while 2 * len(finer) - 1 <= _MOST_VERTICES and patience:
        finer, finer_cost = settle(_halve(finer), cost, clearance)
        patience = patience - 1 if best_cost - finer_cost < _WORTH * best_cost else _PATIENCE
        if finer_cost < best_cost:
            best, best_cost = finer, finer_cost
    allowed = min(spare * best_cost + _SHARE * (given - best_cost), _WITHIN * best_cost)
    limit = min(given, best_cost + allowed)
    while True:
        thinned = thin(best, cost, clearance, limit)
        if len(thinned) == len(best):
            break
        settled, price = settle(thinned, cost, clearance, _TOUCH)  # those left find better places, and free others
        if not price <= given:
            break
        best = settled
    if cost.waypoint_penalty > 0:
        best = _without_idle(best, cost, clearance, given)
    return best if cost.of_polyline(best) <= given else points


def _without_idle(points: FloatArray, cost: SectionCost, clearance: Clearance, limit: float) -> FloatArray:
    """The polyline without the vertices that gain less than slowing down at them takes, those left settled again."""
    while True:
        thinned = thin(points, cost, clearance, limit, cost.waypoint_penalty)
        if len(thinned) == len(points):
            return points
        settled, price = settle(thinned, cost, clearance, _TOUCH)
        if not price <= limit:
            return points
        points = settled


def thin(points: FloatArray, cost: SectionCost, clearance: Clearance, limit: float, gain: float = np.inf) -> FloatArray:
    """Drop the vertices that matter least, one after the other, as long as the polyline costs at most `limit`.

    A vertex that saves more than `gain` stays.
    """
    legs, times = cost.priced(points)
    while len(points) > 2:
        when = np.column_stack([times[:-2], times[2:]]) if cost.changing else None
        skip = cost.of_legs(points[:-2], points[2:], when)
        skip[clearance.breaches(points[:-2], points[2:]) != 0] = np.inf
        extra = skip - legs[:-1] - legs[1:]
        least = int(np.argmin(extra))
        if not (extra[least] <= gain and legs.sum() + extra[least] <= limit):
            break
        points, times = np.delete(points, least + 1, axis=0), np.delete(times, least + 1)
        legs = np.concatenate([legs[:least], skip[least : least + 1], legs[least + 2 :]])
    return points


def _pattern(sweep: int, vertices: int) -> FloatArray:
    """Where each of some vertices tries to go, (k, 3) in steps: level, turned each sweep; up, down and slanted."""
    quarter = max(8, _DIRECTIONS // vertices) // 4
    turns = sweep * _GOLDEN + np.arange(4 * quarter) * (np.pi / 2 / quarter)
    level = np.column_stack([np.cos(turns), np.sin(turns), np.zeros(4 * quarter)])
    slanted = level[::quarter] + np.array([0.0, 0.0, _RISE])
    upright = np.array([[0.0, 0.0, _RISE], [0.0, 0.0, -_RISE]])
    return np.concatenate([level, upright, slanted, slanted * (1.0, 1.0, -1.0)])


def _halve(points: FloatArray) -> FloatArray:
    """The polyline with a vertex more in the middle of each leg."""
    finer = np.empty((2 * len(points) - 1, 3))
    finer[::2] = points
    finer[1::2] = (points[:-1] + points[1:]) / 2
    return finer


def settle(
    points: FloatArray, cost: SectionCost, clearance: Clearance, first_step: float = _FIRST_STEP
) -> tuple[FloatArray, float]:
    """Move the inner vertices until none gains any more; the polyline and its cost."""
    points = points.copy()
    legs, times = cost.priced(points)
    n = len(points)
    size = np.full(n, first_step)
    total = float(legs.sum())
    for sweep in range(_SWEEPS if n < _LONG else _SWEEPS // 2):
        if sweep % _LOOKS == 0 and sweep > 0:
            if cost.changing:  # all have moved a little: so have the times, and with them the winds
                legs, times = cost.priced(points, times)
            before, total = total, float(legs.sum())
            if before - total < _REST * total:
                break
        moving = np.arange(1 + sweep % 2, n - 1, 2)
        moving = moving[size[moving] >= _LAST_STEP]
        if len(moving) == 0:
            if not (size[1:-1] >= _LAST_STEP).any():
                break
            continue
        moved = _try_around(points, legs, times, moving, size[moving], cost, clearance, sweep)
        size[moving] *= np.where(moved, _GROW, _SHRINK)
        np.minimum(size, _FIRST_STEP, out=size)
    return points, cost.of_polyline(points) if cost.changing else float(legs.sum())


def _spans(cost: SectionCost, times: FloatArray, moving: IntArray, tries: int) -> FloatArray | None:
    """When the legs to the vertices `moving` and from them begin and end, each tried so often, where it matters."""
    if not cost.changing:
        return None
    legs = np.concatenate([np.tile(moving - 1, tries), np.tile(moving, tries)])
    return np.column_stack([times[legs], times[legs + 1]])


def _try_around(
    points: FloatArray,
    legs: FloatArray,
    times: FloatArray,
    moving: IntArray,
    size: FloatArray,
    cost: SectionCost,
    clearance: Clearance,
    sweep: int,
) -> BoolArray:
    """Move each of the vertices `moving`, no two of them neighbours, to the best place around it; which have moved.

    `points` and the costs of the `legs` are changed in place. The `times` (n,) at the points are taken as they are: a
    move changes them by seconds, in which no forecast changes.
    """
    before, after = points[moving - 1], points[moving + 1]
    lengths = np.sqrt(((points[1:] - points[:-1]) ** 2).sum(axis=1))
    reach = 0.5 * (lengths[moving - 1] + lengths[moving])
    tried = points[moving] + size[:, None] * reach[:, None] * _pattern(sweep, len(moving))[:, None, :]
    shape = tried.shape[:2]
    places = tried.reshape(-1, 3)
    into = (np.broadcast_to(before, tried.shape).reshape(-1, 3), places)
    out_of = (places, np.broadcast_to(after, tried.shape).reshape(-1, 3))
    starts, ends = np.concatenate([into[0], out_of[0]]), np.concatenate([into[1], out_of[1]])
    price = np.full(len(starts), np.inf)
    clear = clearance.breaches(starts, ends) == 0
    clear = np.tile(clear[: len(places)] & clear[len(places) :], 2)
    when = _spans(cost, times, moving, shape[0])
    price[clear] = cost.of_legs(starts[clear], ends[clear], None if when is None else when[clear])
    first, second = price[: len(places)].reshape(shape), price[len(places) :].reshape(shape)
    choice = np.argmin(first + second, axis=0)
    pick = np.arange(len(moving))
    gained: BoolArray = first[choice, pick] + second[choice, pick] < legs[moving - 1] + legs[moving] - 1e-12
    kept = moving[gained]
    points[kept] = tried[choice, pick][gained]
    legs[kept - 1] = first[choice, pick][gained]
    legs[kept] = second[choice, pick][gained]
    return gained
