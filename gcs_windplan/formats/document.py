"""A JSON document, looked at place by place, so that every complaint names the place."""

from __future__ import annotations

import json
import math
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any, NoReturn

from gcs_windplan.errors import FormatError, Problem

_ABSENT = object()


@dataclass(frozen=True, slots=True)
class Node:
    """A value in a JSON document, with the dotted path to it and the file; absent ones have a path too."""

    value: Any
    path: str
    file: Path

    @property
    def present(self) -> bool:
        """Whether the document has this place at all; null counts."""
        return self.value is not _ABSENT

    def at(self, key: str) -> Node:
        """The member of this object; raises FormatError if this is no object."""
        if not isinstance(self.value, dict):
            self.refuse("is not an object")
        path = f"{self.path}.{key}" if self.path else key
        return Node(self.value.get(key, _ABSENT), path, self.file)

    def elements(self) -> Iterator[Node]:
        """The elements of this array; raises FormatError if this is none."""
        if not isinstance(self.value, list):
            self.refuse("is not an array")
        for index, value in enumerate(self.value):
            yield Node(value, f"{self.path}[{index}]", self.file)

    def number(self) -> float:
        """This number; raises FormatError if it is none, or too large for a double."""
        if isinstance(self.value, bool) or not isinstance(self.value, int | float):
            self.refuse("is not a number")
        try:
            number = float(self.value)
        except OverflowError:
            number = math.inf
        return number if math.isfinite(number) else self.refuse("is too large")

    def number_or_nan(self) -> float:
        """This number, or NaN for null, as QGroundControl writes it."""
        return math.nan if self.value is None else self.number()

    def whole(self) -> int:
        """This whole number; raises FormatError for any other."""
        number = self.number()
        return int(number) if number == int(number) else self.refuse("is not a whole number")

    def refuse(self, message: str) -> NoReturn:
        """Raise FormatError about this place."""
        what = message if self.present else "is missing: the file is cut short, or of another kind"
        raise FormatError(Problem(what, field=self.path or None, file=self.file))


def parse_document(text: str, file: Path) -> Node:
    """The document's root; raises FormatError with line and column where it is no JSON.

    `NaN` and `Infinity`, which Python would take, are refused: no other reader takes them.
    """
    try:
        value = json.loads(text, parse_constant=_refuse_constant)
    except json.JSONDecodeError as error:
        message = f"is not JSON ({error.msg}): it may be cut short or edited by hand"
        raise FormatError(Problem(message, file=file, line=error.lineno, column=error.colno)) from error
    except (ValueError, RecursionError) as error:
        raise FormatError(Problem(f"is not JSON that can be read: {error}", file=file)) from error
    return Node(value, "", file)


def _refuse_constant(name: str) -> NoReturn:
    raise ValueError(f"{name} is not JSON, write null")
