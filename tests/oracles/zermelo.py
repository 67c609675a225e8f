"""Least times in a plane wind from the theory of optimal control: no graph, no polyline, none of the house's speeds.

Where the wind is smooth: the maximum principle. With the costate p the Hamiltonian is H = max over the control of
p · dx/dt, a best route obeys dx/dt = ∂H/∂p, dp/dt = −∂H/∂x, and p at the start is shot for.

    triangle    dx/dt = V n + w, n any unit vector: H = V |p| + w · p (Zermelo's navigation problem)
    paper (12)  dx/dt = (V + w · d) d, d any unit track: H = max over d of (V + w · d)(p · d)

Where the wind is uniform in layers: straight legs, refracted where the layers meet.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence

import numpy as np
from scipy.integrate import solve_ivp
from scipy.optimize import minimize, root

from gcs_windplan.arrays import FloatArray

PlaneWind = Callable[[FloatArray, FloatArray], tuple[FloatArray, FloatArray]]

_DELTA = 1e-6  # of the central differences of the wind
_STEPS = 400  # of a ray in the fan
_NEAR = 0.05  # of the distance: rays that pass the goal so near are aimed at it


def least_time(
    wind: PlaneWind, airspeed: float, model: str, start: Sequence[float], goal: Sequence[float], horizon: float,
    rays: int = 721,
) -> float:  # fmt: skip
    """The least time from start to goal, at most `horizon`: a fan of rays, the nearest of them aimed at the goal."""
    angles = np.linspace(-math.pi, math.pi, rays)
    misses = _fan(wind, airspeed, model, start, goal, horizon, angles)
    nearest, when = misses.min(axis=0), misses.argmin(axis=0) * horizon / _STEPS
    best = math.inf
    for ray in sorted(_valleys(nearest, _NEAR * math.dist(start, goal)), key=lambda ray: when[ray]):
        if when[ray] > best:
            break
        aimed = root(
            lambda x: _end(wind, airspeed, model, start, x[0], np.clip(x[1], 0.0, horizon)) - goal,
            [angles[ray], when[ray]], tol=1e-9,
        )  # fmt: skip
        if np.linalg.norm(aimed.fun) < 1e-6:
            best = min(best, float(aimed.x[1]))
    return best


def least_time_in_layers(
    borders: Sequence[float], winds: Sequence[float], airspeed: float, model: str,
    start: Sequence[float], goal: Sequence[float],
) -> float:  # fmt: skip
    """The least time across layers of eastward wind between y = `borders`, one wind more than borders.

    Within a layer the best way is straight; so only the places x where the borders are crossed are unknown.
    """
    strips = list(winds)
    if start[1] > goal[1]:
        borders, strips = borders[::-1], strips[::-1]

    def seconds(crossings: FloatArray) -> float:
        xs, ys = [start[0], *crossings, goal[0]], [start[1], *borders, goal[1]]
        return sum(
            _straight(xs[i + 1] - xs[i], ys[i + 1] - ys[i], wind, airspeed, model) for i, wind in enumerate(strips)
        )

    guess = np.linspace(start[0], goal[0], len(strips) + 1)[1:-1]
    found = minimize(seconds, guess, method="Nelder-Mead", options={"xatol": 1e-9, "fatol": 1e-12, "maxiter": 4000})
    return float(found.fun)


def _straight(x: float, y: float, wind: float, airspeed: float, model: str) -> float:
    """The time along a vector (x, y) in an eastward wind."""
    length = math.hypot(x, y)
    along, across = wind * x / length, wind * y / length
    return length / (airspeed + along if model == "paper" else math.sqrt(airspeed**2 - across**2) + along)


def _end(
    wind: PlaneWind, airspeed: float, model: str, start: Sequence[float], angle: float, seconds: float
) -> FloatArray:
    """Where the ray that leaves with the costate's `angle` is after some time."""
    state = np.array([start[0], start[1], math.cos(angle), math.sin(angle)])
    ray = solve_ivp(
        lambda _, s: _motion(wind, airspeed, model, s[:, None])[:, 0],
        (0.0, seconds), state, method="DOP853", rtol=1e-7, atol=1e-9,
    )  # fmt: skip
    return ray.y[:2, -1]


def _fan(
    wind: PlaneWind, airspeed: float, model: str, start: Sequence[float], goal: Sequence[float], horizon: float,
    angles: FloatArray,
) -> FloatArray:  # fmt: skip
    """How far rays are from the goal at each of the steps up to the horizon, shape (steps + 1, rays); Runge-Kutta."""
    state = np.stack([np.full_like(angles, start[0]), np.full_like(angles, start[1]), np.cos(angles), np.sin(angles)])
    h = horizon / _STEPS
    misses = [np.hypot(state[0] - goal[0], state[1] - goal[1])]
    for _ in range(_STEPS):
        k1 = _motion(wind, airspeed, model, state)
        k2 = _motion(wind, airspeed, model, state + h / 2 * k1)
        k3 = _motion(wind, airspeed, model, state + h / 2 * k2)
        k4 = _motion(wind, airspeed, model, state + h * k3)
        state = state + h / 6 * (k1 + 2 * k2 + 2 * k3 + k4)
        misses.append(np.hypot(state[0] - goal[0], state[1] - goal[1]))
    return np.array(misses)


def _valleys(depths: FloatArray, most: float) -> list[int]:
    """The places of the local minima that are not above `most`."""
    lowest = (depths <= np.roll(depths, 1)) & (depths <= np.roll(depths, -1)) & (depths <= most)
    return np.flatnonzero(lowest).tolist()


def _motion(wind: PlaneWind, airspeed: float, model: str, state: FloatArray) -> FloatArray:
    """The time derivative of states (x, y, p), shape (4, rays)."""
    x, y, p, q = state
    u, v = wind(x, y)
    east = [(a - b) / (2 * _DELTA) for a, b in zip(wind(x + _DELTA, y), wind(x - _DELTA, y), strict=True)]
    north = [(a - b) / (2 * _DELTA) for a, b in zip(wind(x, y + _DELTA), wind(x, y - _DELTA), strict=True)]
    size = np.hypot(p, q)
    if model == "triangle":
        return np.stack(
            [
                airspeed * p / size + u,
                airspeed * q / size + v,
                -(east[0] * p + east[1] * q),
                -(north[0] * p + north[1] * q),
            ]
        )
    track = _best_track(u, v, airspeed, np.arctan2(q, p))
    c, s = np.cos(track), np.sin(track)
    speed, gain = airspeed + u * c + v * s, p * c + q * s
    return np.stack([speed * c, speed * s, -gain * (east[0] * c + east[1] * s), -gain * (north[0] * c + north[1] * s)])


def _best_track(u: FloatArray, v: FloatArray, airspeed: float, towards: FloatArray) -> FloatArray:
    """The direction d that makes (V + w · d)(p · d) greatest, p pointing `towards`: a fan, then Newton."""
    strength, blows = np.hypot(u, v), np.arctan2(v, u)
    offsets = np.linspace(-1.5, 1.5, 61)[:, None]
    tried = (airspeed + strength * np.cos(towards + offsets - blows)) * np.cos(offsets)
    track = towards + offsets[np.argmax(tried, axis=0), 0]
    for _ in range(6):
        double = 2 * track - towards - blows
        slope = -airspeed * np.sin(track - towards) - strength * np.sin(double)
        bend = -airspeed * np.cos(track - towards) - 2 * strength * np.cos(double)
        track = track - np.clip(slope / np.minimum(bend, -1e-6), -0.05, 0.05)
    return track
