"""An inventory of forecast files and the wind at a place, as JSON for scripts."""

from __future__ import annotations

import json
import math
from dataclasses import asdict
from datetime import UTC, datetime
from typing import Any

import numpy as np

from gcs_windplan.arrays import FloatArray
from gcs_windplan.cli.wind_tables import direction_from
from gcs_windplan.wind.field_index import Level
from gcs_windplan.wind.inspect.inventory import Inventory, QuantitySummary
from gcs_windplan.wind.inspect.sounding import HeightWind, LevelWind, Sounding


def format_inventory(inventory: Inventory) -> str:
    """What is in the files. Times are ISO 8601 in UTC, levels in m or Pa, steps in seconds, spacings in degrees, m."""
    series, count, planning = inventory.times, inventory.missing, inventory.planning
    return _dumped(
        {
            "files": [{**asdict(file), "path": str(file.path)} for file in inventory.files],
            "runs": [_time(run) for run in inventory.runs],
            "times": {
                "count": len(series.times),
                "all": [_time(time) for time in series.times],
                "steps": [{"seconds": step, "until": _time(until)} for step, until in series.steps],
                "gaps": [{"first": _time(g.first), "last": _time(g.last), "count": g.count} for g in series.gaps],
                "with_whole_wind": inventory.whole,
            },
            "members": inventory.members,
            "also_without_member": inventory.also_without_member and bool(inventory.members),
            "quantities": [_quantity(one) for one in inventory.quantities],
            "grids": [asdict(grid) for grid in inventory.grids],
            "missing": {
                "fields": count.fields,
                "read": count.read,
                "quantities": {one.quantity: {"values": one.values, "missing": one.missing} for one in count.found},
                "broken": count.broken,
            },
            "planning": {
                **asdict(planning),
                "possible": not planning.obstacle,
                "departures": planning.departures and [_time(time) for time in planning.departures],
            },
        }
    )


def format_sounding(found: Sounding) -> str:
    """The wind at a place: m, m/s, degrees clockwise from true north."""
    document = {
        "latitude": found.place.latitude_deg,
        "longitude": found.place.longitude_deg,
        "time": None if found.moment is None else _time(found.moment),
        "between_times": [_time(time) for time in found.times],
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
    winds = _winds(members, one.winds)
    return {"height": _known(one.height), "above_ground": _known(one.above_ground), "winds": winds}


def _dumped(document: dict[str, Any]) -> str:
    return json.dumps(document, indent=2, ensure_ascii=False, allow_nan=False)


def _time(seconds: float) -> str:
    return f"{datetime.fromtimestamp(seconds, UTC):%Y-%m-%dT%H:%M:%SZ}"


def _known(value: float) -> float | None:
    return value if math.isfinite(value) else None


def _level(level: Level) -> dict[str, Any]:
    return {"kind": level.kind, "value": level.value, "text": str(level)}


def _quantity(one: QuantitySummary) -> dict[str, Any]:
    return {**asdict(one), "levels": [_level(level) for level in one.levels]}


def _winds(members: tuple[int | None, ...], winds: FloatArray) -> list[dict[str, Any]]:
    columns = [*winds.T, np.hypot(*winds.T), direction_from(winds)]
    names = ("u", "v", "speed", "from")
    return [
        {"member": member, **dict(zip(names, map(_known, row), strict=True))}
        for member, row in zip(members, np.stack(columns, axis=-1).tolist(), strict=True)
    ]
