"""Linear interpolation in gridded fields whose levels may lie at another height in every column."""

from __future__ import annotations

import numba
import numpy as np

from gcs_windplan.arrays import FloatArray

# Every axis and column ascends strictly, so no divisor is 0. The model is that of `heightfield`: what Numba compiles
# for one of them (min, max, empty) serves the other.
_kernel = numba.njit(cache=True, error_model="numpy", nogil=True)


@_kernel
def interpolate_columns(
    u: FloatArray,
    v: FloatArray,
    heights: FloatArray,
    times: FloatArray,
    latitudes: FloatArray,
    longitudes: FloatArray,
    places: FloatArray,
    z: FloatArray,
    when: FloatArray,
) -> FloatArray:
    """Two fields at n points, shape (n, 3): u, v, and how far the point lies above the columns' tops.

    `u`, `v` and `heights` are (times, levels, latitudes, longitudes), C-contiguous; every axis and every
    column of `heights` ascends strictly. Points are `places` (n, 2 or more: latitude, longitude), height `z`
    (n,) and time `when` (n,), each in the unit of its axis.

    Linear in height inside each of the (at most) eight columns about a point, then bilinear between them and
    linear in time. Along a horizontal axis, in time, and below the lowest level the nearest value holds; so
    does the highest level above the top, and the third result is then above 0. A single level holds at every
    height.
    """
    result = np.empty((len(z), 3))
    levels = u.shape[1]
    lower = 0
    for n in range(len(z)):
        i, east = _bracket(longitudes, places[n, 1])
        j, north = _bracket(latitudes, places[n, 0])
        k, late = _bracket(times, when[n])
        east_wind, north_wind, above = 0.0, 0.0, 0.0
        for corner in range(8):
            di, dj, dk = corner & 1, (corner >> 1) & 1, corner >> 2
            weight = (east if di else 1 - east) * (north if dj else 1 - north) * (late if dk else 1 - late)
            if weight == 0.0:  # also keeps the index inside an axis of length 1
                continue
            t, y, x = k + dk, j + dj, i + di
            share = 0.0
            if levels > 1:
                while lower < levels - 2 and heights[t, lower + 1, y, x] <= z[n]:
                    lower += 1
                while lower > 0 and heights[t, lower, y, x] > z[n]:
                    lower -= 1
                floor, ceiling = heights[t, lower, y, x], heights[t, lower + 1, y, x]
                share = min(max((z[n] - floor) / (ceiling - floor), 0.0), 1.0)
                above = max(above, z[n] - heights[t, levels - 1, y, x])
            upper = min(lower + 1, levels - 1)
            east_wind += weight * ((1 - share) * u[t, lower, y, x] + share * u[t, upper, y, x])
            north_wind += weight * ((1 - share) * v[t, lower, y, x] + share * v[t, upper, y, x])
        result[n, 0], result[n, 1], result[n, 2] = east_wind, north_wind, above
    return result


@_kernel
def _bracket(axis: FloatArray, value: float) -> tuple[int, float]:
    """Index below a value on an ascending axis and share of the way to the next, held at the ends."""
    low, high = 0, len(axis) - 1
    if high == 0:
        return 0, 0.0
    while high - low > 1:
        middle = (low + high) // 2
        if axis[middle] <= value:
            low = middle
        else:
            high = middle
    share = (value - axis[low]) / (axis[low + 1] - axis[low])
    return low, min(max(share, 0.0), 1.0)
