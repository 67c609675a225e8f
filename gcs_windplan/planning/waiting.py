"""Where waiting pays: the wind closes a way now and opens it later.

Where every way stays open nobody who leaves later arrives earlier (first in, first out), and nothing is tried.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Final, TypeAlias

import numpy as np

from gcs_windplan.flight import clock

#: How long the quickest route takes that begins at a time [s]; infinite where there is none.
Lasting: TypeAlias = Callable[[float], float]

_WAITS: Final = tuple(k / 8 for k in range(1, 9))  # of the flight's duration: who waits longer cannot arrive earlier
_WORTH: Final = 0.01  # of the flight's duration
_TRIED_EVERY: Final = 600.0  # [s] later departures that are tried where no route exists
_MOST_TRIED: Final = 24


def later_departure_note(now: float, begin: float, lasting: Lasting) -> tuple[str, ...]:
    """A note if leaving later than `begin` [s] arrives earlier than a flight of `now` [s] that begins there."""
    waits = [share * now for share in _WAITS]
    arrivals = [wait + lasting(begin + wait) for wait in waits]
    least = int(np.argmin(arrivals))
    if now - arrivals[least] < _WORTH * now:
        return ()
    return (
        f"waiting pays: leaving {clock(waits[least])} min later arrives {clock(now - arrivals[least])} min earlier,"
        " since the wind closes the best way until then.",
    )


def next_feasible_departure(begin: float, ends: float, lasting: Lasting) -> str:
    """When a route exists if none does at `begin` [s], up to the forecast's end at `ends` [s], in words; or nothing."""
    if not np.isfinite(ends):
        return ""
    step = max(_TRIED_EVERY, (ends - begin) / _MOST_TRIED)
    waits = np.arange(step, ends - begin, step)
    wait = next((float(wait) for wait in waits if np.isfinite(lasting(begin + float(wait)))), None)
    return "" if wait is None else f" It can be flown when leaving {wait / 60:.0f} min later."
