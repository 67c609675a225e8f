"""A field in the hands of eccodes, which is imported here and nowhere else."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from typing import BinaryIO

import eccodes
import numpy as np

from gcs_windplan.arrays import FloatArray
from gcs_windplan.wind.files.grib_file import RawField, read_bytes

GribError = eccodes.CodesInternalError
UNKNOWN = eccodes.CODES_MISSING_LONG
_NOTHING = -1e100  # what a missing value decodes to


class Unused(Exception):
    """Why a field is ignored, for people: what follows on "12 fields"."""


@contextmanager
def handle_of(file: BinaryIO, field: RawField) -> Iterator[int]:
    """A field as a message of its own, in eccodes' hands."""
    message = b"".join(read_bytes(file, span) for span in field)
    if len(field) > 1:
        message = message[:8] + (len(message) + 4).to_bytes(8) + message[16:] + b"7777"
    handle = eccodes.codes_new_from_message(message)
    try:
        yield handle
    finally:
        eccodes.codes_release(handle)


def text_of(handle: int, key: str) -> str:
    """A key's text, empty where there is none."""
    try:
        return str(eccodes.codes_get_string(handle, key))
    except eccodes.KeyValueNotFoundError:
        return ""


def number_of(handle: int, key: str) -> int:
    """A key's whole number, 0 where there is none."""
    try:
        return int(eccodes.codes_get_long(handle, key))
    except eccodes.KeyValueNotFoundError:
        return 0


def degrees_of(handle: int, key: str) -> float:
    """An angle [deg]."""
    return float(eccodes.codes_get_double(handle, f"{key}InDegrees"))


def numbers_of(handle: int, key: str) -> FloatArray:
    """All numbers of a key."""
    numbers: FloatArray = eccodes.codes_get_double_array(handle, key)
    return numbers


def put(handle: int, key: str, value: float) -> None:
    """Changes a key of the handle, not of the file."""
    eccodes.codes_set(handle, key, value)


def values_of(handle: int, nodes: int) -> FloatArray:
    """The values (nodes,) in the order of the file, NaN where missing. Raises `ValueError` if there are others."""
    if eccodes.codes_get_size(handle, "values") != nodes or number_of(handle, "numberOfCodedValues") > nodes:
        raise ValueError("its values are not as many as its grid has nodes")
    put(handle, "missingValue", _NOTHING)
    values: FloatArray = eccodes.codes_get_values(handle)
    values[values == _NOTHING] = np.nan
    return values
