"""Departures as JSON, for scripts."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from gcs_windplan.json_text import json_text

if TYPE_CHECKING:
    from gcs_windplan.planning.departures import Departure
    from gcs_windplan.planning.request import Request


def format_departures(request: Request, found: Sequence[Departure]) -> str:
    """The departures as JSON: SI units, times in UTC; members that cannot fly it have null seconds."""
    rows = [
        {
            "departure": one.moment,
            "feasible": one.feasible,
            "seconds": one.seconds,
            "length": one.length,
            "energy": one.energy,
            "member_energies": None if one.spread is None else one.spread.energies,
            "member_seconds": None if one.spread is None else one.spread.seconds,
            "strongest_wind": one.wind,
            "strongest_gust": one.gust,
            "reason": one.reason,
        }
        for one in found
    ]
    return json_text({"name": request.name, "wind": request.scene.wind.name, "departures": rows}) + "\n"
