"""Naive twins of the flying kernels: plain Python, one formula after the other."""

from __future__ import annotations

import math

import numpy as np


def naive_slowness(vehicle, direction, wind) -> float:
    """Seconds per metre, found by looking for the time that the vehicle's own air velocity needs."""
    e, n, u = direction
    level = math.hypot(e, n)
    if not -vehicle.climb <= wind[2] <= vehicle.descent:
        return math.inf
    climb_rate = vehicle.climb + wind[2] if u > 0 else vehicle.descent - wind[2]
    vertical = abs(u) / climb_rate if u != 0 and climb_rate > 0 else (math.inf if u != 0 else 0.0)
    if level < 1e-9:
        return vertical if vehicle.hovers and math.hypot(*wind[:2]) <= vehicle.airspeed else math.inf
    track = np.array([e, n]) / level
    horizontal_wind = np.array(wind[:2])
    along = float(track @ horizontal_wind)
    across = float(np.linalg.norm(horizontal_wind - along * track))
    if vehicle.speed_model == "paper":
        if math.hypot(*wind[:2]) >= vehicle.airspeed:
            return math.inf
        speeds = (0.0, vehicle.airspeed + along)
    else:
        if across > vehicle.airspeed:
            return math.inf
        own = math.sqrt(vehicle.airspeed**2 - across**2)
        speeds = (along - own, along + own)
    if speeds[1] <= 0:
        return math.inf
    horizontal = level / speeds[1]
    if vertical <= horizontal:
        return horizontal
    if not vehicle.hovers or level / vertical < speeds[0]:
        return math.inf
    return vertical


def naive_edge_time(vehicle, vector, wind_a, wind_b) -> float:
    """The trapezoidal rule over both winds."""
    length = float(np.linalg.norm(vector))
    direction = np.asarray(vector) / length
    return length * (naive_slowness(vehicle, direction, wind_a) + naive_slowness(vehicle, direction, wind_b)) / 2


def naive_angle(direction, wind) -> float:
    """The angle between two vectors by the cosine."""
    norm = np.linalg.norm(direction) * np.linalg.norm(wind)
    return math.pi / 2 if norm == 0 else math.acos(max(-1.0, min(1.0, float(np.dot(direction, wind) / norm))))
