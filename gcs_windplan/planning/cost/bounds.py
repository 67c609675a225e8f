"""How little energy can remain: planes that no flight climbs faster than it spends energy.

Whatever the wind, it lies in a disc (centre c, radius r) with draughts up to some strength, and the air is left at some
speed V with some climb rate. A plane s n · d + β dz over displacements d (n a level unit vector) is a lower bound of
the price of every displacement if no velocity over ground gains on it faster than power is spent: that is

    s (V + r + n · c) + β (climb rate + draught) ≤ P(V, climb rate)    for all V and climb rates,

so s is the smallest P_β(V) / (V + r + n · c), where P_β(V) is the least of P − β · climb rate, less β times the
draught. Each plane is linear, and the largest of several is a consistent lower bound: what A* needs to be optimal.
"""

from __future__ import annotations

import math
from typing import Final

import numpy as np

from gcs_windplan.arrays import FloatArray
from gcs_windplan.kernels.edges import Setting
from gcs_windplan.kernels.power import PowerGrid

_DIRECTIONS: Final = 64  # a bound between two of them loses 0.1 % at most
_SLOPES: Final = np.linspace(-2.0, 2.0, 17)  # β, in what lifting the weight by momentum theory alone might take
_BATCH: Final = 50_000  # nodes at a time, so that memory stays bounded
_ROUNDING: Final = 1.0 - 1e-9  # keeps a bound below what it bounds to the last digit


def least_prices(points: FloatArray, setting: Setting, grid: PowerGrid, start: FloatArray) -> FloatArray:
    """A consistent lower bound of the price [J] from points (n, 3) to the setting's goal, (n,); NaN heights count as 0.

    Of all slopes β those are taken that bound the way from the start (3,), level and as it is, best.
    """
    goal = np.array([setting.goal_e, setting.goal_n, setting.goal_z])
    planes = best_planes(setting, grid, goal - start)
    bounds = np.zeros(len(points))
    for begin in range(0, len(points), _BATCH):
        ahead = np.nan_to_num(goal - points[begin : begin + _BATCH])
        bounds[begin : begin + _BATCH] = np.maximum((ahead @ planes.T).max(axis=1), 0.0)
    return bounds * _ROUNDING


def best_planes(setting: Setting, grid: PowerGrid, way: FloatArray) -> FloatArray:
    """The planes (k, 3) [J/m] of the slopes that bound a way (3,) best, as it is and if it were level."""
    level = way * (1.0, 1.0, 0.0)
    lift = _lift(grid)
    sheaves = [sheaf for slope in _SLOPES * lift if (sheaf := planes_of(setting, grid, float(slope))) is not None]
    if not sheaves:
        return np.zeros((1, 3))
    chosen = {int(np.argmax([(sheaf @ one).max() for sheaf in sheaves])) for one in (way, level)}
    return np.concatenate([sheaves[i] for i in sorted(chosen)])


def planes_of(setting: Setting, grid: PowerGrid, slope: float) -> FloatArray | None:
    """The planes (64, 3) [J/m] of one slope β [J per metre of height]; None where it bounds nothing.

    The table is linear between its knots, so the least quotient lies at a knot.
    """
    _, climbs, speeds = grid.watts.shape
    rates = grid.lowest_climb + grid.climb_step * np.arange(climbs)
    draught = setting.ball_up if slope > 0 else setting.ball_down
    spare = (grid.watts - slope * rates[:, None]).min(axis=(0, 1)) + grid.cost_index - abs(slope) * draught
    if not (spare > 0).all():
        return None
    turns = np.arange(_DIRECTIONS) * (2 * math.pi / _DIRECTIONS)
    level = np.column_stack([np.cos(turns), np.sin(turns)])
    gains = grid.airspeed_step * np.arange(speeds) + setting.ball_radius
    gains = gains[None] + (level @ [setting.ball_e, setting.ball_n])[:, None]
    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
        quotients = np.where(gains > 0, spare / gains, np.inf)
    least = quotients.min(axis=1)
    steep = np.where(np.isfinite(least), least, 0.0)
    return np.column_stack([steep[:, None] * level, np.full(_DIRECTIONS, slope)])


def _lift(grid: PowerGrid) -> float:
    """A power by climb rate [J/m]: of the table, in the middle of the airspeeds that it knows power for."""
    known = np.flatnonzero(np.isfinite(grid.watts).all(axis=(0, 1)))
    if not len(known):
        return 0.0
    middle = grid.watts[:, :, known[len(known) // 2]]
    span = grid.climb_step * (grid.watts.shape[1] - 1)
    return float(np.abs(middle[:, -1] - middle[:, 0]).max() / span)
