"""Writes small GRIB messages that are odd in one chosen way."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import eccodes
import numpy as np

from gcs_windplan.arrays import FloatArray

_EDGES = (
    "latitudeOfFirstGridPoint",
    "latitudeOfLastGridPoint",
    "longitudeOfFirstGridPoint",
    "longitudeOfLastGridPoint",
)


def box(
    north: float = 52.0,
    south: float = 50.0,
    west: float = 8.0,
    east: float = 11.0,
    step: float | None = 1.0,
    **keys: Any,
) -> dict[str, Any]:
    """A latitude-longitude grid, stored from north to south and from west to east unless `keys` say otherwise."""
    wide = (east - west) % 360.0 or 360.0
    columns = round(wide / (step or 1.0)) + 1
    rows = round((north - south) / (step or 1.0)) + 1
    edges = {f"{key}InDegrees": value for key, value in zip(_EDGES, (north, south, west, east), strict=True)}
    steps = {} if step is None else {f"{axis}DirectionIncrementInDegrees": step for axis in "ij"}
    return {"Ni": columns, "Nj": rows, **edges, **steps, **keys}


def message(
    name: str = "u",
    values: Sequence[float] | FloatArray | float = 5.0,
    edition: int = 2,
    grid: Mapping[str, Any] | None = None,
    sample: str | None = None,
    pv: Sequence[float] | None = None,
    missing: float | None = None,
    **keys: Any,
) -> bytes:
    """One field. `keys` are set one after the other, then the `name` (empty: what `keys` say), then the values."""
    handle = eccodes.codes_grib_new_from_samples(sample or f"regular_ll_pl_grib{edition}")
    try:
        start = {"dataDate": 20260501, "dataTime": 1200, "typeOfLevel": "isobaricInhPa", "level": 850}
        for key, value in {**start, **(box() if grid is None else grid), **keys}.items():
            eccodes.codes_set(handle, key, value)
        if name:
            eccodes.codes_set(handle, "shortName", name)
        if pv is not None:
            eccodes.codes_set(handle, "PVPresent", 1)
            eccodes.codes_set_array(handle, "pv", np.asarray(pv, dtype=np.float64))
        if missing is not None:
            eccodes.codes_set(handle, "bitmapPresent", 1)
            eccodes.codes_set(handle, "missingValue", missing)
        if sample is None:
            size = eccodes.codes_get_long(handle, "Ni") * eccodes.codes_get_long(handle, "Nj")
            eccodes.codes_set(handle, "bitsPerValue", 24)
            eccodes.codes_set_values(handle, np.broadcast_to(np.asarray(values, dtype=np.float64), size).copy())
        return bytes(eccodes.codes_get_message(handle))
    finally:
        eccodes.codes_release(handle)


def in_one_message(path: Path, fields: Sequence[bytes], section: int = 4) -> Path:
    """A file with one message of several fields, each of which repeats the sections from `section` on."""
    several = eccodes.codes_grib_multi_new()
    for number, field in enumerate(fields):
        handle = eccodes.codes_new_from_message(field)
        eccodes.codes_grib_multi_append(handle, section if number else 0, several)
        eccodes.codes_release(handle)
    with path.open("wb") as file:
        eccodes.codes_grib_multi_write(several, file)
    eccodes.codes_grib_multi_release(several)
    eccodes.codes_grib_multi_support_off()  # which codes_grib_multi_new has turned on for the whole process
    return path


def stored(values: FloatArray, scanning: int) -> FloatArray:
    """The values of a grid (rows to the north, columns to the east) in the order that a scanning mode wants.

    Written out as flag table 3.4 of FM 92 says it: bit 1 i negatively, 2 j positively, 3 j runs first, 4 every second
    line backwards.
    """
    rows, columns = values.shape
    along_i = range(columns - 1, -1, -1) if scanning & 128 else range(columns)
    along_j = range(rows) if scanning & 64 else range(rows - 1, -1, -1)
    lines = (
        [[(j, i) for j in along_j] for i in along_i] if scanning & 32 else [[(j, i) for i in along_i] for j in along_j]
    )
    if scanning & 16:
        lines = [line[::-1] if number % 2 else line for number, line in enumerate(lines)]
    return np.array([values[place] for line in lines for place in line])
