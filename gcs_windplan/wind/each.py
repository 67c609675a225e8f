"""Several winds at the same places, the members of an ensemble: what they share is worked out once."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from gcs_windplan.arrays import FloatArray
from gcs_windplan.wind.field import WindField

if TYPE_CHECKING:
    from gcs_windplan.wind.limited import LimitedWind


def at_each(winds: Sequence[WindField], points: FloatArray, seconds: float | FloatArray = 0.0) -> FloatArray:
    """The winds at points (n, 3), one after the other along the last axis: (n, 3) for one, (n, 3 m) for m of them.

    Raises `WindError` as their `at` does.
    """
    if len(winds) == 1:
        return winds[0].at(points, seconds)
    from gcs_windplan.wind.gridded import GriddedWind, at_members
    from gcs_windplan.wind.limited import LimitedWind

    limited = [wind for wind in winds if isinstance(wind, LimitedWind)]
    if len(limited) == len(winds):
        return _limited_at_each(limited, points, seconds)

    grids = [wind for wind in winds if isinstance(wind, GriddedWind)]
    if len(grids) == len(winds) and all(grid.shares_with(grids[0]) for grid in grids):
        return at_members(grids, points, seconds)
    return np.concatenate([wind.at(points, seconds) for wind in winds], axis=1)


def _limited_at_each(winds: Sequence[LimitedWind], points: FloatArray, seconds: float | FloatArray) -> FloatArray:
    """The same where each wind has its limits: fields and gusts are worked out together, then closed one by one."""
    fields = at_each([wind.field for wind in winds], points, seconds)
    counts = [3 * len(wind.gusts) for wind in winds]
    gusts = [gust for wind in winds for gust in wind.gusts]
    blown = at_each(gusts, points, seconds) if gusts else np.empty((len(points), 0))
    parts = np.split(blown, np.cumsum(counts)[:-1], axis=1)
    closed = [
        wind.closing(fields[:, 3 * k : 3 * k + 3], parts[k] if counts[k] else None) for k, wind in enumerate(winds)
    ]
    return np.concatenate(closed, axis=1)
