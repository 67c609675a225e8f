"""What every grammar of words shares: a value that does not read becomes an error with the name of what was asked."""

from __future__ import annotations

from collections.abc import Callable
from typing import TypeAlias, TypeVar

from gcs_windplan.errors import InputError, Problem

_T = TypeVar("_T")

#: How a face calls what it is asked: `max_gust` in Python, `--max-gust` on the command line.
Naming: TypeAlias = Callable[[str], str]


def read_as(field: str | None, read: Callable[[], _T]) -> _T:
    """What `read` gives; its `ValueError` becomes an `InputError` of the field."""
    try:
        return read()
    except ValueError as error:
        raise InputError(Problem(str(error), field)) from None
