"""Linear interpolation in forecasts whose levels may lie at another height in every column.

A column has levels at fixed heights above the ground, then levels at heights above mean sea level; either of them may
be missing. Between the two, the wind is linear as well. Below the lowest level a law leads it down to the ground:

      z ▲      ── level above sea level
        │      ── level above sea level          a forecast level below the forecast's own ground (or below the levels
        │      ·                                 above the ground) is a fiction of the model's and ignored
        │      ── level above ground, at ground + 100 m
        │      ── level above ground, at ground + 10 m
        │      ·  law: log or power
        ┴──────── ground

Without levels above the ground the law counts from the higher one of the two grounds, the terrain's and the forecast's
own, to the lowest level: the wind at 50 m over the ground is what the forecast has at 50 m over its own.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from gcs_windplan.arrays import FloatArray
from gcs_windplan.kernels.compiled import compiled, inlined

LOG, POWER = 0.0, 1.0
_NOTHING = 1e-7  # a share so small is rounding: the column need not even be known
_TOP = 0.01  # [m] a point may lie this far above the highest level and still be taken as on it

# Every axis and column ascends strictly, so no divisor is 0. The model is that of `heightfield`: what Numba compiles
# for one of them (min, max, empty) serves the other.


class Law(NamedTuple):
    """How the wind falls to 0 at the ground."""

    code: float  # LOG or POWER
    exponent: float  # of the power law
    carry: float  # [m above ground] up to here it also carries the wind above the highest level above the ground


class Columns(NamedTuple):
    """A forecast on rows and columns, at times and levels: those above the ground first, then those above sea level."""

    winds: FloatArray  # (times, rows, columns, levels, 2) u and v [m/s]
    above: FloatArray  # (na,) [m above ground] ascending, perhaps none
    heights: (
        FloatArray  # (times, rows, columns, levels - na) [m above mean sea level] ascending; (1, 1, 1, ...): in all
    )
    terrain: FloatArray  # (rows, columns) the forecast's own ground [m above mean sea level], -inf where unknown
    roughness: FloatArray  # (rows, columns) [m]
    times: FloatArray  # (times,) ascending, as are the next two
    rows: FloatArray
    columns: FloatArray


@compiled
def interpolate_columns(
    field: Columns, law: Law, places: FloatArray, z: FloatArray, ground: FloatArray, when: FloatArray
) -> FloatArray:
    """u and v at n points, shape (n, 3) with a third column of zeros; NaN where the wind is not known.

    Points are `places` (n, 2 or more: row, column, in the unit of the axes), heights `z` (n,) above mean sea level, the
    `ground` (n,) under them (NaN: take the forecast's own) and the time `when` (n,). Linear in height inside each of
    the (at most) eight columns about a point, then bilinear between them and linear in time. Along rows, columns and in
    time the nearest value holds outside of the axes.
    """
    winds, above, heights = field.winds, field.above, field.heights  # as parts of a tuple they would be slow
    terrain, roughness = field.terrain, field.roughness
    times, rows, columns = field.times, field.rows, field.columns
    na, levels = above.size, winds.shape[3]
    top = above[na - 1] if na > 0 else 0.0
    highest = -math.inf  # of the forecast's own ground: levels above it count in all columns
    for j in range(terrain.shape[0]):
        for i in range(terrain.shape[1]):
            highest = max(highest, terrain[j, i])
    scales = _scale(columns), _scale(rows), _scale(times)
    same = levels > na and heights.shape[0] == heights.shape[1] == heights.shape[2] == 1
    flat, tall = winds.reshape(winds.size), heights.reshape(heights.size)  # views of columns would be slow, too
    beyond = levels - na
    eastward = 2 * levels  # numbers from one column to the next
    northward = eastward * columns.size
    later = northward * rows.size
    result = np.zeros((z.size, 3))
    guess = 0
    for n in range(z.size):
        x, east = _bracket(columns, scales[0], places[n, 1])
        y, north = _bracket(rows, scales[1], places[n, 0])
        t, late = _bracket(times, scales[2], when[n])
        x1, y1, t1 = min(x + 1, columns.size - 1), min(y + 1, rows.size - 1), min(t + 1, times.size - 1)
        height = z[n] - ground[n]
        lower, share, common = 0, 0.0, False
        if na > 0 and above[0] <= height <= top:
            lower, share = _level(above, height)
            common = True
        elif same and not height <= top:
            lower, share = _level(heights[0, 0, 0], z[n])
            base = heights[0, 0, 0, lower]
            common = base > highest + top and base <= z[n] <= heights[0, 0, 0, levels - na - 1]
            common = common and (na == 0 or base > ground[n] + top)
            lower += na
        u, v = 0.0, 0.0
        if common:
            step = 2 if lower < levels - 1 else 0
            first = (((t * rows.size + y) * columns.size + x) * levels + lower) * 2
            for corner in range(8):
                at = first + (corner & 1) * (x1 - x) * eastward
                at += ((corner >> 1) & 1) * (y1 - y) * northward + (corner >> 2) * (t1 - t) * later
                weight = (east if corner & 1 else 1.0 - east) * (north if corner & 2 else 1.0 - north)
                weight *= late if corner & 4 else 1.0 - late
                low, high = weight * (1.0 - share), weight * share
                u += low * flat[at] + high * flat[at + step]
                v += low * flat[at + 1] + high * flat[at + step + 1]
        else:
            for corner in range(8):
                weight = (east if corner & 1 else 1.0 - east) * (north if corner & 2 else 1.0 - north)
                weight *= late if corner & 4 else 1.0 - late
                if weight < _NOTHING:
                    continue
                k, j, i = t1 if corner & 4 else t, y1 if corner & 2 else y, x1 if corner & 1 else x
                column = 0 if same else ((k * rows.size + j) * columns.size + i) * beyond
                own, upper = terrain[j, i], guess + 1
                below = tall[column + guess - na] if na <= guess < levels - 1 else math.inf
                counts = below > own + top and (na == 0 or below > ground[n] + top)
                if counts and below <= z[n] < tall[column + upper - na]:
                    lower = guess  # as in the column before: nearly always
                    share = (z[n] - below) / (tall[column + upper - na] - below)
                else:
                    lower, upper, share, factor = _in_column(
                        above, tall, column, beyond, own, roughness[j, i], law, z[n], ground[n], guess
                    )
                    guess = lower
                    weight *= factor
                low, high = weight * (1.0 - share), weight * share
                u += low * winds[k, j, i, lower, 0] + high * winds[k, j, i, upper, 0]
                v += low * winds[k, j, i, lower, 1] + high * winds[k, j, i, upper, 1]
        result[n, 0], result[n, 1] = u, v
    return result


@inlined
def _in_column(
    above: FloatArray, heights: FloatArray, column: int, beyond: int, own: float, roughness: float, law: Law,
    z: float, ground: float, guess: int,
) -> tuple[int, int, float, float]:  # fmt: skip
    """Two levels, the share of the upper one, and a factor on both; the factor is NaN where the wind is not known.

    The column's heights above sea level are `beyond` numbers from `column` on.
    """
    na, levels = above.size, above.size + beyond
    base = column - na  # a level's height stands at base + its number
    if math.isnan(ground):
        ground = own
    floor = own  # levels at or below it do not count
    anchor = floor
    if na > 0:
        top = above[na - 1]
        if z - ground <= top or na == levels:
            return _over_ground(above, law, z - ground, roughness)
        anchor = ground + top
        floor = max(anchor, own + top)
    lowest = na
    while lowest < levels and heights[base + lowest] <= floor:
        lowest += 1
    if lowest == levels or z > heights[base + levels - 1] + _TOP:
        return 0, 0, 0.0, math.nan
    height = heights[base + lowest]
    if z < height:
        if na > 0:
            return na - 1, lowest, (z - anchor) / (height - anchor), 1.0
        if ground == -math.inf:  # nobody knows it
            return 0, 0, 0.0, math.nan
        return lowest, lowest, 0.0, min(_share_of(law, z - ground, height - max(ground, own), roughness), 1.0)
    lower = min(max(guess, lowest), levels - 1)
    while lower < levels - 1 and heights[base + lower + 1] <= z:
        lower += 1
    while lower > lowest and heights[base + lower] > z:
        lower -= 1
    if lower == levels - 1:
        return lower, lower, 0.0, 1.0
    under, over = heights[base + lower], heights[base + lower + 1]
    return lower, lower + 1, (z - under) / (over - under), 1.0


@inlined
def _over_ground(above: FloatArray, law: Law, height: float, roughness: float) -> tuple[int, int, float, float]:
    """What `_in_column` returns, among the levels above the ground."""
    last = above.size - 1
    if height < above[0]:
        return 0, 0, 0.0, _share_of(law, height, above[0], roughness)
    if height >= above[last]:
        if height <= above[last] + _TOP:
            return last, last, 0.0, 1.0
        carried = _share_of(law, height, above[last], roughness) if height <= law.carry else math.nan
        return last, last, 0.0, carried
    lower = 0
    while above[lower + 1] <= height:
        lower += 1
        if lower == last:  # the height is not a number
            return 0, 0, 0.0, math.nan
    return lower, lower + 1, (height - above[lower]) / (above[lower + 1] - above[lower]), 1.0


@inlined
def _share_of(law: Law, height: float, reference: float, roughness: float) -> float:
    """The wind at a height above the ground as a share of that at the reference height; 0 at and below the ground."""
    if height <= 0.0:
        return 0.0
    if law.code == POWER:
        share: float = (height / reference) ** law.exponent
        return share
    if height <= roughness:
        return 0.0
    if reference <= 1.001 * roughness:
        return 1.0
    return math.log(height / roughness) / math.log(reference / roughness)


@inlined
def _scale(axis: FloatArray) -> float:
    """Nodes a unit of an axis, on the average."""
    return (axis.size - 1) / (axis[axis.size - 1] - axis[0]) if axis.size > 1 else 0.0


@inlined
def _bracket(axis: FloatArray, scale: float, value: float) -> tuple[int, float]:
    """Index below a value on an ascending axis and share of the way to the next, held at the ends."""
    last = axis.size - 1
    if last == 0 or not value > axis[0]:
        return 0, 0.0
    if value >= axis[last]:
        return last - 1, 1.0
    low = min(int((value - axis[0]) * scale), last - 1)  # right at once where the spacing is even
    while axis[low] > value:
        low -= 1
    while axis[low + 1] <= value:
        low += 1
    return low, (value - axis[low]) / (axis[low + 1] - axis[low])


@inlined
def _level(levels: FloatArray, height: float) -> tuple[int, float]:
    """The same on a short axis with uneven spacing: counting all that lie below is faster than branching."""
    low = 0
    for k in range(1, levels.size - 1):
        low += levels[k] <= height
    if levels.size == 1:
        return 0, 0.0
    return low, (height - levels[low]) / (levels[low + 1] - levels[low])
