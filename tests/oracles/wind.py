"""The wind at one point, worked out step by step with numpy's one-dimensional interpolation."""

from __future__ import annotations

import numpy as np

from gcs_windplan.arrays import FloatArray


def naive_interpolate_columns(
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
    """What `kernels.interpolation.interpolate_columns` computes, one axis after the other, height first."""
    rows = []
    for (latitude, longitude), height, time in zip(places[:, :2], z, when, strict=True):
        row = []
        for values in (u, v):
            nt, _, ny, nx = values.shape
            at_height = np.empty((nt, ny, nx))
            for t, y, x in np.ndindex(nt, ny, nx):
                at_height[t, y, x] = np.interp(height, heights[t, :, y, x], values[t, :, y, x])
            at_longitude = np.array([[np.interp(longitude, longitudes, line) for line in plane] for plane in at_height])
            at_latitude = np.array([np.interp(latitude, latitudes, line) for line in at_longitude])
            row.append(float(np.interp(time, times, at_latitude)))
        rows.append(row)
    return np.array(rows)
