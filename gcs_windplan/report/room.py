"""Room for signs and words on a drawing: what is taken, and where the next one fits."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

import numpy as np

from gcs_windplan.arrays import FloatArray

Offset = tuple[float, float]
_POINTS = 72.0  # in an inch


class Room:
    """The boxes that are taken on a drawing [point]; its axes have their limits already."""

    def __init__(self, axes: Any) -> None:
        self._axes = axes
        self._taken: list[tuple[FloatArray, Offset]] = []

    def beside(self, x: float, y: float, half: Offset, offsets: Iterable[Offset]) -> Offset | None:
        """The first offset [point] from a place at which a box of a half width and height is free, which it takes.

        None where nothing is free: then nothing is taken.
        """
        axes = self._axes
        scale = _POINTS / axes.figure.dpi
        here = axes.transData.transform((x, y)) * scale
        edge = axes.bbox.get_points() * scale
        for offset in offsets:
            centre = here + offset
            if np.any(centre - half < edge[0]) or np.any(centre + half > edge[1]):
                continue
            if not any(np.all(np.abs(centre - place) < np.add(half, size)) for place, size in self._taken):
                self._taken.append((centre, half))
                return offset
        return None


def rings(radius: float, count: int, first: float = 0.0) -> tuple[Offset, ...]:
    """Offsets on rings about a place, eight on the first and as densely on the others, from a first bearing [deg]."""
    turns = [(n, np.radians(first - 360 * i / (8 * n))) for n in range(1, count + 1) for i in range(8 * n)]
    return tuple((float(n * radius * np.cos(turn)), float(n * radius * np.sin(turn))) for n, turn in turns)
