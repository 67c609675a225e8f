"""Travel in changing wind, written down in the most straightforward way."""

from __future__ import annotations

import heapq
import math
from collections.abc import Callable

import numpy as np
from scipy.integrate import solve_ivp

from gcs_windplan.vehicle import Vehicle
from tests.oracles.flying import naive_slowness

#: Seconds from a node to another when it is left at a time.
Lasting = Callable[[int, int, float], float]


def _in_one(vehicle: Vehicle, vector, wind) -> float:
    """Seconds along a vector in one wind."""
    length = float(np.linalg.norm(vector))
    return length * naive_slowness(vehicle, np.asarray(vector) / length, wind)


def edge_lasting(vehicle: Vehicle, points, wind) -> Lasting:
    """The trapezoidal rule between the winds at both ends, each when the vehicle is there; iterated for long.

    The winds are asked for once, at their knots: in between they are linear.
    """
    knots = [float(time) for time in wind.times]
    winds = np.stack([wind.at(points, time) for time in knots])

    def wind_at(node: int, clock: float):
        return [float(np.interp(clock, knots, winds[:, node, axis])) for axis in range(3)]

    def lasting(i: int, j: int, begin: float) -> float:
        vector = points[j] - points[i]
        outset = _in_one(vehicle, vector, wind_at(i, begin))
        seconds = outset
        for _ in range(200):
            if not math.isfinite(seconds) or begin + seconds > knots[-1]:
                return math.inf
            before, seconds = seconds, 0.5 * (outset + _in_one(vehicle, vector, wind_at(j, begin + seconds)))
            if abs(seconds - before) < 1e-9:
                break
        return seconds

    return lasting


def best_of_all_paths(nodes: int, legs: dict[int, list[int]], lasting: Lasting, begin: float) -> float:
    """The least duration from node 0 to the last one over every path that passes no node twice."""
    best = math.inf

    def go(node: int, clock: float, passed: frozenset[int]) -> None:
        nonlocal best
        if clock >= best:
            return
        if node == nodes - 1:
            best = clock
            return
        for to in legs[node]:
            if to not in passed:
                go(to, clock + lasting(node, to, clock), passed | {to})

    go(0, begin, frozenset([0]))
    return best - begin


def best_with_waiting(nodes: int, legs: dict[int, list[int]], lasting: Lasting, begin: float, step: float) -> float:
    """The least duration in the time-expanded graph: at every node one may wait for one `step` [s] and more.

    Arrivals are rounded up to whole steps, so it is too long by less than a step an edge.
    """
    heap, done = [(0, 0)], set()
    while heap:
        tick, node = heapq.heappop(heap)
        if (tick, node) in done:
            continue
        done.add((tick, node))
        if node == nodes - 1:
            return tick * step
        clock = begin + tick * step
        heapq.heappush(heap, (tick + 1, node))
        for to in legs[node]:
            seconds = lasting(node, to, clock)
            if math.isfinite(seconds):
                heapq.heappush(heap, (tick + math.ceil(seconds / step - 1e-9), to))
    return math.inf


def leg_by_ode(vehicle: Vehicle, wind, start, end, begin: float) -> float:
    """The duration of a straight leg by integrating its speed, ds/dt = v(s, t), with scipy."""
    vector = np.asarray(end) - np.asarray(start)
    length = float(np.linalg.norm(vector))

    def speed(clock: float, share) -> list[float]:
        here = (np.asarray(start) + share[0] * vector)[None]
        seconds = _in_one(vehicle, vector, wind.at(here, min(clock, wind.times[-1]))[0])
        return [1.0 / seconds]

    def arrived(clock: float, share) -> float:
        return share[0] - 1.0

    arrived.terminal = True
    found = solve_ivp(speed, (begin, begin + 100 * length), [0.0], events=arrived, rtol=1e-10, atol=1e-12, max_step=2.0)
    return float(found.t_events[0][0]) - begin
