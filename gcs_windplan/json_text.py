"""Values as JSON: the one writer behind files, pages and `--json`."""

from __future__ import annotations

import json
import math
from collections.abc import Iterable, Mapping
from dataclasses import fields, is_dataclass
from datetime import UTC, datetime
from enum import Enum
from os import PathLike, fspath
from typing import Any, Final

import numpy as np
from numpy.typing import ArrayLike

_DIGITS: Final = 12  # significant: 0.1 mm of a longitude, and none of the noise of a sum


def json_text(value: Any, indent: int | None = 1) -> str:
    """A value as JSON; without an indent on one line, as short as can be."""
    separators = (",", ":") if indent is None else None
    return json.dumps(json_value(value), indent=indent, separators=separators, ensure_ascii=False, allow_nan=False)


def json_value(value: Any) -> Any:
    """A value in JSON's own types.

    Numbers have 12 significant digits, those that are not known or infinite are null; moments are in UTC (ISO 8601),
    dataclasses objects with their fields, arrays and sets lists, paths text. Raises TypeError for anything else.
    """
    if value is None or (isinstance(value, bool | str) and not isinstance(value, Enum)):
        return value
    if isinstance(value, Enum):
        return json_value(value.value)
    if isinstance(value, int):
        return value
    if isinstance(value, float):
        return float(f"{value:.{_DIGITS}g}") if math.isfinite(value) else None
    if isinstance(value, np.generic | np.ndarray):
        return json_value(value.tolist())
    if isinstance(value, datetime):
        return value.astimezone(UTC).isoformat()
    if is_dataclass(value) and not isinstance(value, type):
        return {field.name: json_value(getattr(value, field.name)) for field in fields(value)}
    if isinstance(value, Mapping):
        return {str(key): json_value(one) for key, one in value.items()}
    if isinstance(value, PathLike):
        return fspath(value)
    if isinstance(value, Iterable):
        return [json_value(one) for one in value]
    raise TypeError(f"{type(value).__name__} has no form in JSON")


def rounded(values: ArrayLike, digits: int) -> list[Any]:
    """Numbers (n,) with so many decimals: whole ones as such, null where not known or infinite."""
    with np.errstate(over="ignore", invalid="ignore"):  # the largest numbers have no digits to round
        listed = (np.round(np.asarray(values, dtype=np.float64), digits) + 0.0).tolist()
    return [None if not math.isfinite(x) else int(x) if x == int(x) else x for x in listed]


def rounded_number(value: float | None, digits: int) -> Any:
    """One number, rounded likewise."""
    return None if value is None else rounded([value], digits)[0]
