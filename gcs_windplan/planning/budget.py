"""The quickest flight that a battery allows: time is weighed against energy until it just fits."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Final, TypeVar

_Flight = TypeVar("_Flight")

_HALVINGS: Final = 6  # of the worths between which the answer lies: down to a few percent of one
_LEAST, _MOST = 0.02, 50.0  # of the power in level flight: who values a second less, or more, flies no otherwise


def quickest_within(
    find: Callable[[float], _Flight], energy: Callable[[_Flight], float], allowed: float, cruise: float
) -> tuple[_Flight, float]:
    """The quickest flight whose energy is at most `allowed` [J], and what it values a second at [W].

    `find` gives the best flight for a cost index, the value of a second [W]: infinite, least time; 0, least energy.
    `energy` is what a flight takes [J], `cruise` a power to begin with [W]. Where even least energy is too much, that
    flight.
    """
    quickest = find(math.inf)
    if energy(quickest) <= allowed:
        return quickest, math.inf
    kept, cost_index = find(0.0), 0.0
    if energy(kept) > allowed:
        return kept, cost_index
    low, high = math.log(_LEAST * cruise), math.log(_MOST * cruise)
    for _ in range(_HALVINGS):
        middle = (low + high) / 2
        tried = find(math.exp(middle))
        if energy(tried) <= allowed:
            low, kept, cost_index = middle, tried, math.exp(middle)
        else:
            high = middle
    return kept, cost_index
