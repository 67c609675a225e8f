"""Several winds at the same places, the members of an ensemble: what they share is worked out once."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from gcs_windplan.arrays import FloatArray
from gcs_windplan.wind.field import WindField


def at_each(winds: Sequence[WindField], points: FloatArray, seconds: float | FloatArray = 0.0) -> FloatArray:
    """The winds at points (n, 3), one after the other along the last axis: (n, 3) for one, (n, 3 m) for m of them.

    Raises `WindError` as their `at` does.
    """
    if len(winds) == 1:
        return winds[0].at(points, seconds)
    from gcs_windplan.wind.gridded import GriddedWind, at_members

    grids = [wind for wind in winds if isinstance(wind, GriddedWind)]
    if len(grids) == len(winds) and all(grid.shares_with(grids[0]) for grid in grids):
        return at_members(grids, points, seconds)
    return np.concatenate([wind.at(points, seconds) for wind in winds], axis=1)
