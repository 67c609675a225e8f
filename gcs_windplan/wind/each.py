"""Several winds at the same places, the members of an ensemble: what they share is worked out once."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, Protocol, runtime_checkable

import numpy as np

from gcs_windplan.arrays import FloatArray
from gcs_windplan.wind.field import WindField


@runtime_checkable
class Sharing(Protocol):
    """A kind of wind whose members can share work."""

    @classmethod
    def at_members(cls, members: Sequence[Any], points: FloatArray, seconds: float | FloatArray) -> FloatArray:
        """The winds (n, 3 m) of m members of this kind at points (n, 3), one after the other along the last axis."""


def at_each(winds: Sequence[WindField], points: FloatArray, seconds: float | FloatArray = 0.0) -> FloatArray:
    """The winds at points (n, 3), one after the other along the last axis: (n, 3) for one, (n, 3 m) for m of them.

    Raises `WindError` as their `at` does.
    """
    first = winds[0]
    if len(winds) == 1:
        return np.ascontiguousarray(first.at(points, seconds))
    if isinstance(first, Sharing) and all(type(wind) is type(first) for wind in winds):
        return first.at_members(winds, points, seconds)
    return np.concatenate([wind.at(points, seconds) for wind in winds], axis=1)
