"""An inventory of forecast files and the wind at a place, as JSON for scripts."""

from __future__ import annotations

import json
import math
from collections.abc import Sequence
from dataclasses import asdict
from datetime import UTC, datetime
from typing import Any

import numpy as np

from gcs_windplan.cli.wind_tables import direction_from
from gcs_windplan.wind.field_index import Level
from gcs_windplan.wind.inspect.inventory import Inventory
from gcs_windplan.wind.inspect.sounding import HeightWind, LevelWind, Sounding


def format_inventory(inventory: Inventory) -> str:
    """What is in the files. Times are ISO 8601 in UTC, levels in m or Pa, spacings in m."""
    planning = inventory.planning
    return _dumped(
        {
            "files": [asdict(file) for file in inventory.files],
            "runs": _times(inventory.runs),
            "times": {
                "count": len(inventory.times),
                "all": _times(inventory.times),
                "gaps": [_times((gap.after, gap.before)) for gap in inventory.gaps],
                "with_whole_wind": inventory.with_whole_wind,
            },
            "members": inventory.members,
            "also_without_member": inventory.also_without_member and bool(inventory.members),
            "quantities": [
                {**asdict(one), "levels": [_level(level) for level in one.levels]} for one in inventory.quantities
            ],
            "grids": [asdict(grid) for grid in inventory.grids],
            "fields_read": inventory.fields_read,
            "broken": inventory.broken,
            "planning": {
                **asdict(planning),
                "possible": not planning.obstacle,
                "departures": planning.departures and _times(planning.departures),
            },
        }
    )


def format_sounding(found: Sounding) -> str:
    """The wind at a place: m, m/s, degrees clockwise from true north."""
    document = {
        "latitude": found.place.latitude_deg,
        "longitude": found.place.longitude_deg,
        "time": None if found.moment is None else _times([found.moment])[0],
        "between_times": _times(found.times),
        "ground": _known(found.ground),
        "gusts": [{"member": m, "gust": gust} for m, gust in zip(found.members, found.gusts.tolist(), strict=False)],
        "uses": found.uses,
    }
    if found.at_height is None:
        levels = [{"level": _level(one.level), **_row(found.members, one)} for one in found.levels]
        return _dumped({**document, "levels": levels})
    lower, upper = found.at_height.lower, found.at_height.upper
    between = [lower and _level(lower.level), _level(upper.level)]
    return _dumped({**document, **_row(found.members, found.at_height), "between": between})


def _row(members: tuple[int | None, ...], one: LevelWind | HeightWind) -> dict[str, Any]:
    numbers = np.column_stack([one.winds, np.hypot(*one.winds.T), direction_from(one.winds)])
    winds = [
        {"member": member, **dict(zip(("u", "v", "speed", "from"), map(_known, row), strict=True))}
        for member, row in zip(members, numbers.tolist(), strict=True)
    ]
    return {"height": _known(one.height), "above_ground": _known(one.above_ground), "winds": winds}


def _dumped(document: dict[str, Any]) -> str:
    return json.dumps(document, indent=2, ensure_ascii=False, allow_nan=False)


def _times(times: Sequence[float]) -> list[str]:
    return [f"{datetime.fromtimestamp(time, UTC):%Y-%m-%dT%H:%M:%SZ}" for time in times]


def _known(value: float) -> float | None:
    return value if math.isfinite(value) else None


def _level(level: Level) -> dict[str, Any]:
    return {**asdict(level), "text": str(level)}
