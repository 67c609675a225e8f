"""An inventory of forecast files and the wind at a place, as JSON for scripts."""

from __future__ import annotations

import math
from datetime import UTC, datetime
from typing import Any

import numpy as np

from gcs_windplan.arrays import FloatArray
from gcs_windplan.json_text import json_text
from gcs_windplan.wind.report.inventory import Count, FileFacts, GridFacts, Holding, Inventory
from gcs_windplan.wind.report.series import Series
from gcs_windplan.wind.report.sounding import Here, Sounding, Spot
from gcs_windplan.wind.report.spread import direction_from
from gcs_windplan.wind.report.trial import Trial
from gcs_windplan.wind.sheets import Level


def format_inventory(inventory: Inventory) -> str:
    """What is in the files. Times are ISO 8601 in UTC, levels in m or Pa, steps in seconds, spacings in degrees, m."""
    return _dumped(
        {
            "files": [_file(file) for file in inventory.files],
            "runs": [_time(run) for run in inventory.runs],
            "times": {**_series(inventory.times), "with_whole_wind": inventory.whole},
            "members": list(inventory.members),
            "also_without_member": inventory.alone and bool(inventory.members),
            "quantities": [_holding(holding) for holding in inventory.holdings],
            "lone": [_holding(holding) for holding in inventory.lone],
            "grids": [_grid(grid) for grid in inventory.grids],
            "missing": _count(inventory.count),
            "planning": _trial(inventory.trial),
        }
    )


def format_wind(found: Sounding | Spot) -> str:
    """The wind at a place: m, m/s, degrees clockwise from true north."""
    document = _here(found.here)
    if isinstance(found, Spot):
        winds = _winds(found.members, found.winds)
        lower = None if found.lower is None else _level(found.lower[0])
        height = {"height": _known(found.height), "above_ground": _known(found.above_ground)}
        return _dumped({**document, **height, "between": [lower, _level(found.upper[0])], "winds": winds})
    levels = [
        {
            "level": _level(row.level),
            "heights": [_known(height) for height in row.heights.tolist()],
            "used_in_planning": row.planned and not row.hidden,
            "below_ground": row.hidden,
            "winds": _winds(row.members, row.winds),
        }
        for row in found.rows
    ]
    return _dumped({**document, "levels": levels})


def _dumped(document: dict[str, Any]) -> str:
    return json_text(document)


def _time(seconds: float) -> str:
    return f"{datetime.fromtimestamp(seconds, UTC):%Y-%m-%dT%H:%M:%SZ}"


def _known(value: float) -> float | None:
    return value if math.isfinite(value) else None


def _level(level: Level) -> dict[str, Any]:
    return {"kind": level.kind, "value": level.value, "text": str(level)}


def _file(file: FileFacts) -> dict[str, Any]:
    return {
        "path": str(file.path), "format": file.format, "title": file.title, "sheets": file.sheets,
        "unused": list(file.unused),
    }  # fmt: skip


def _series(series: Series) -> dict[str, Any]:
    return {
        "count": len(series.times),
        "all": [_time(time) for time in series.times],
        "steps": [{"seconds": step, "until": _time(until)} for step, until in series.steps],
        "gaps": [{"first": _time(g.first), "last": _time(g.last), "count": g.count} for g in series.gaps],
    }


def _holding(holding: Holding) -> dict[str, Any]:
    return {
        "quantity": holding.quantity, "names": list(holding.names), "units": holding.units,
        "levels": [_level(level) for level in holding.levels], "times": holding.times, "members": holding.members,
        "sheets": holding.sheets, "grid": holding.grid,
    }  # fmt: skip


def _grid(grid: GridFacts) -> dict[str, Any]:
    extent, spacing = grid.extent, grid.spacing
    return {
        "name": grid.name, "rows": grid.rows, "columns": grid.columns,
        "south": extent.south, "north": extent.north, "west": extent.west, "east": extent.east,
        "all_longitudes": extent.round,
        "spacing_degrees": None if spacing.degrees is None else list(spacing.degrees),
        "spacing_metres": list(spacing.metres), "u_v_turned": grid.turned,
    }  # fmt: skip


def _count(count: Count) -> dict[str, Any]:
    return {
        "sheets": count.sheets, "read": count.read, "sampled": count.sampled,
        "quantities": {one.quantity: {"values": one.values, "missing": one.missing} for one in count.found},
        "broken": list(count.broken),
    }  # fmt: skip


def _trial(trial: Trial) -> dict[str, Any]:
    return {
        "possible": not trial.obstacle, "obstacle": trial.obstacle or None, "uses": trial.said or None,
        "departures": None if trial.departures is None else [_time(time) for time in trial.departures],
        "choose_members_of": list(trial.members), "all_tried": trial.whole,
    }  # fmt: skip


def _here(here: Here) -> dict[str, Any]:
    return {
        "latitude": here.place.latitude_deg, "longitude": here.place.longitude_deg,
        "time": None if here.moment is None else _time(here.moment),
        "between_times": [_time(time) for time in here.times],
        "ground": _known(here.ground),
        "gusts": [{"member": member, "gust": gust} for member, gust in here.gusts.items()],
    }  # fmt: skip


def _winds(members: tuple[int | None, ...], winds: FloatArray) -> list[dict[str, Any]]:
    speeds, directions = np.hypot(winds[:, 0], winds[:, 1]), direction_from(winds)
    return [
        {"member": member, "u": _known(u), "v": _known(v), "speed": _known(speed), "from": _known(direction)}
        for member, (u, v), speed, direction in zip(
            members, winds.tolist(), speeds.tolist(), directions.tolist(), strict=True
        )
    ]
