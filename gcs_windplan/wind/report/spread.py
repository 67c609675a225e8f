"""How far the winds of an ensemble's members lie apart."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from gcs_windplan.arrays import FloatArray


@dataclass(frozen=True, slots=True)
class Spread:
    """A number of each member: the one in the middle, the least and the most.

    Of directions [deg] least and most are the ends of the smallest arc that holds all of them, clockwise.
    """

    median: float
    least: float
    most: float


def direction_from(winds: FloatArray) -> FloatArray:
    """Where winds (n, 2) towards east and north come from [deg, clockwise from true north], NaN for still air."""
    u, v = winds[..., 0], winds[..., 1]
    directions: FloatArray = np.where(np.hypot(u, v) > 0, np.degrees(np.arctan2(-u, -v)) % 360.0, np.nan)
    return directions


def spread_of(values: FloatArray) -> Spread:
    """The spread of numbers (n,), NaN passed over; of NaN alone NaN."""
    there = values[np.isfinite(values)]
    if not len(there):
        return Spread(np.nan, np.nan, np.nan)
    return Spread(float(np.median(there)), float(np.min(there)), float(np.max(there)))


def spread_of_directions(directions: FloatArray) -> Spread:
    """The spread of directions (n,) [deg], NaN passed over; of NaN alone NaN."""
    there = np.sort(directions[np.isfinite(directions)])
    if not len(there):
        return Spread(np.nan, np.nan, np.nan)
    widest = int(np.argmax(np.diff(there, append=there[0] + 360.0)))
    start = there[(widest + 1) % len(there)]
    turned = np.sort((there - start) % 360.0)
    return Spread(float((start + np.median(turned)) % 360.0), float(start), float((start + turned[-1]) % 360.0))
