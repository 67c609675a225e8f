"""Departures as JSON, for scripts."""

from __future__ import annotations

import json
from collections.abc import Sequence
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from gcs_windplan.planning.departures import Departure
    from gcs_windplan.planning.request import Request


def _finite(numbers: Sequence[float]) -> list[float | None]:
    """The numbers, None for those that are infinite."""
    return [number if number < float("inf") else None for number in numbers]


def format_departures(request: Request, found: Sequence[Departure]) -> str:
    """The departures as JSON: SI units, times in UTC; members that cannot fly it have null seconds."""
    rows = [
        {
            "departure": one.moment.isoformat(),
            "feasible": one.feasible,
            "seconds": one.seconds,
            "length": one.length,
            "energy": one.energy,
            "member_energies": _finite(one.spread.energies) if one.spread is not None else None,
            "member_seconds": _finite(one.spread.seconds) if one.spread is not None else None,
            "strongest_wind": one.wind,
            "strongest_gust": one.gust,
            "reason": one.reason,
        }
        for one in found
    ]
    summary = {"name": request.name, "wind": request.wind.name, "departures": rows}
    return json.dumps(summary, indent=1, ensure_ascii=False, allow_nan=False) + "\n"
