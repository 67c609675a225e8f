"""The wind as far as it is known: where a field has none, the rest is known all the same."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from gcs_windplan.arrays import BoolArray, FloatArray
from gcs_windplan.errors import WindError
from gcs_windplan.wind.field import WindField

_FEW = 8  # points that are asked for one by one


@dataclass(frozen=True, slots=True, eq=False)
class KnownWind:
    """Winds (n, 3) [m/s], NaN where none is known; where the field refused (n,), and its first reason."""

    winds: FloatArray
    refused: BoolArray
    reason: str | None = None

    @property
    def filled(self) -> FloatArray:
        """The winds with still air where none is known."""
        return np.nan_to_num(self.winds)


def known_wind(field: WindField, points: FloatArray, seconds: FloatArray) -> KnownWind:
    """The wind at points (n, 3), `seconds` (n,) after departure; outside of area or time it is not known."""
    try:
        return KnownWind(field.at(points, seconds), np.zeros(len(points), dtype=np.bool_))
    except WindError as error:
        reason = str(error)
    if len(points) <= 1:
        return KnownWind(np.full((len(points), 3), np.nan), np.ones(len(points), dtype=np.bool_), reason)
    size = 1 if len(points) <= _FEW else max(len(points) // _FEW, 1)
    parts = [known_wind(field, points[i : i + size], seconds[i : i + size]) for i in range(0, len(points), size)]
    reason = next((part.reason for part in parts if part.reason is not None), reason)
    return KnownWind(
        np.concatenate([part.winds for part in parts]), np.concatenate([part.refused for part in parts]), reason
    )
