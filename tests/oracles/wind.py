"""The wind at one point, worked out step by step with numpy's one-dimensional interpolation."""

from __future__ import annotations

import math

import numpy as np

from gcs_windplan.arrays import FloatArray
from gcs_windplan.kernels.interpolation import POWER, Columns, Law


def naive_interpolate_columns(
    field: Columns, law: Law, places: FloatArray, z: FloatArray, ground: FloatArray, when: FloatArray
) -> FloatArray:
    """What `kernels.interpolation.interpolate_columns` computes (n, 2), one axis after the other, height first."""
    rows = []
    for (row, column), height, below, time in zip(places[:, :2], z, ground, when, strict=True):
        found = np.zeros(2)
        shares = [
            _shares(axis, value) for axis, value in ((field.times, time), (field.rows, row), (field.columns, column))
        ]
        for t, late in enumerate(shares[0]):
            for y, north in enumerate(shares[1]):
                for x, east in enumerate(shares[2]):
                    if late * north * east >= 1e-7:
                        found += late * north * east * np.array(naive_column(field, law, (t, y, x), height, below))
        rows.append(found)
    return np.array(rows)


def _shares(axis: FloatArray, value: float) -> list[float]:
    """How much each node of an axis counts."""
    return [float(np.interp(value, axis, node)) for node in np.eye(len(axis))]


def naive_column(field: Columns, law: Law, node: tuple[int, int, int], z: float, ground: float) -> tuple[float, float]:
    """u and v at a height above sea level in one column."""
    t, y, x = node
    own, roughness, above = field.terrain[y, x], field.roughness[y, x], field.above
    shared = field.heights.shape[:3] == (1, 1, 1)
    heights = field.heights[0, 0, 0] if shared else field.heights[t, y, x]
    winds = field.winds[t, y, x]
    if math.isnan(ground):
        ground = own
    agl = z - ground
    na = len(above)
    unknown = (math.nan, math.nan)
    if na and (agl <= above[-1] or len(heights) == 0):
        if agl < above[0]:
            share = _law(law, agl, above[0], roughness)
            return share * winds[0, 0], share * winds[0, 1]
        if agl <= above[-1] + 0.01:
            return tuple(float(np.interp(agl, above, winds[:na, part])) for part in range(2))
        if agl > law.carry:
            return unknown
        share = _law(law, agl, above[-1], roughness)
        return share * winds[na - 1, 0], share * winds[na - 1, 1]
    top = above[-1] if na else 0.0
    counts = heights > own + top
    if na:
        counts &= heights > ground + top
    knots, values = heights[counts], winds[na:][counts]
    if len(knots) == 0 or z > knots[-1] + 0.01:
        return unknown
    if z < knots[0] and not math.isfinite(ground):
        return unknown
    if na:
        knots, values = np.append(ground + top, knots), np.vstack([winds[na - 1 : na], values])
    elif z < knots[0]:
        share = min(_law(law, agl, knots[0] - max(ground, own), roughness), 1.0)
        return share * values[0, 0], share * values[0, 1]
    return tuple(float(np.interp(z, knots, values[:, part])) for part in range(2))


def _law(law: Law, height: float, reference: float, roughness: float) -> float:
    if height <= 0:
        return 0.0
    if law.code == POWER:
        return (height / reference) ** law.exponent
    if height <= roughness:
        return 0.0
    if reference <= 1.001 * roughness:
        return 1.0
    return math.log(height / roughness) / math.log(reference / roughness)
