"""What a NetCDF file says about one of its variables. Nothing here opens a file."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True, slots=True)
class Variable:
    """What a file says about one variable, without its values."""

    name: str
    dimensions: tuple[str, ...]
    shape: tuple[int, ...]
    attributes: Mapping[str, object]

    def text(self, attribute: str) -> str:
        """A text attribute in lower case, empty where there is none."""
        return self.raw_text(attribute).lower()

    def raw_text(self, attribute: str) -> str:
        """A text attribute as it stands, empty where there is none."""
        value = self.attributes.get(attribute, "")
        if isinstance(value, list | tuple | np.ndarray) and np.size(value) == 1:
            value = np.ravel(np.asarray(value, dtype=object))[0]
        if isinstance(value, bytes):
            value = value.decode("latin-1")
        return value.strip() if isinstance(value, str) else ""

    def numbers(self, attribute: str) -> tuple[float, ...]:
        """The numbers of an attribute, empty where there are none."""
        value = self.attributes.get(attribute, ())
        words = value.replace(",", " ").split() if isinstance(value, str) else np.atleast_1d(np.asarray(value)).ravel()
        try:
            return tuple(float(word) for word in words)
        except (TypeError, ValueError):
            return ()
