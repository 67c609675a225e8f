"""The wind as a small picture of characters: arrows that point where it blows to, and its speed."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from gcs_windplan.arrays import FloatArray
from gcs_windplan.cli.wind_options import WindOptions
from gcs_windplan.cli.wind_words import between_times
from gcs_windplan.wind.field_index import FieldIndex
from gcs_windplan.wind.inspect.wind_map import WindMap, map_around, map_of_area

_ARROWS = "↑↗→↘↓↙←↖"  # clockwise from north
_CELL = 8  # characters
_CALM = 0.05  # [m/s] what is shown as 0.0 blows nowhere


@dataclass(frozen=True, slots=True)
class Picture:
    """Its lines, and sentences about it."""

    lines: list[str]
    captions: list[str]


def draw(indexes: Sequence[FieldIndex], options: WindOptions) -> Picture:
    """The picture that is asked for. Raises `WindError`."""
    asked = (options.moment, options.level, options.members)
    if options.place is not None and options.radius is not None:
        found = map_around(indexes, options.place, options.radius, *asked)
    else:
        found = map_of_area(indexes, *asked)
    scale = 1.0 if found.about is None else 1e-3
    rows, columns = _numbers(found.rows * scale, found.about), _numbers(found.columns * scale, found.about)
    member = "" if found.members[0] is None else f", member {found.members[0]}"
    member += f", the first of {len(found.members)}" if len(found.members) > 1 else ""
    blank = ["blank: outside of its area"] if found.outside.any() else []
    return Picture(
        _lines(found, rows, columns),
        [
            f"wind at {found.level}, {between_times(found.moment, found.times)}{member}; {_where(found)}",
            "; ".join([_extremes(found.winds, rows, columns), "arrows point where it blows to, north is up", *blank]),
        ],
    )


def _lines(found: WindMap, rows: list[str], columns: list[str]) -> list[str]:
    """A line a row, under a line of columns' names."""
    corner = "lat\\lon" if found.about is None else "km"
    lines = [f"{corner:>{_CELL}}" + "".join(f"{name:>{_CELL}}" for name in columns)]
    for name, row, outside in zip(rows, found.winds, found.outside, strict=True):
        cells = ["" if gone else _cell(*wind) for wind, gone in zip(row, outside, strict=True)]
        lines.append((f"{name:>{_CELL}}" + "".join(f"{cell:>{_CELL}}" for cell in cells)).rstrip())
    return lines


def _cell(u: float, v: float) -> str:
    speed = float(np.hypot(u, v))
    if not np.isfinite(speed):
        return "--"
    arrow = "·" if speed < _CALM else _ARROWS[round(float(np.degrees(np.arctan2(u, v))) / 45.0) % 8]
    return f"{arrow} {speed:4.1f}"


def _numbers(values: FloatArray, about: object) -> list[str]:
    """Degrees as exact as there is room for, distances with as few decimals as tell them apart."""
    steps = np.abs(np.diff(values))
    off = (1e-3 if about is None else 0.02) * float(steps.min()) if len(steps) else 1e-4
    decimals = next((d for d in range(3) if np.abs(values - np.round(values, d)).max() <= off), 3)
    most = _CELL - 2 - len(f"{np.abs(values).max():.0f}") - int((values < 0).any())
    decimals, sign = min(decimals, max(most, 0)), "" if about is None else "+"
    return [f"{round(value, decimals) + 0.0:{sign}.{decimals}f}" for value in values.tolist()]


def _extremes(winds: FloatArray, rows: list[str], columns: list[str]) -> str:
    """The largest and the smallest speed, and where they are."""
    speeds = np.hypot(winds[..., 0], winds[..., 1])
    if not np.isfinite(speeds).any():
        return "no wind is known at any of these places"
    ends = []
    for at in (np.nanargmin(speeds), np.nanargmax(speeds)):
        row, column = np.unravel_index(int(at), speeds.shape)
        ends.append(f"{speeds[row, column]:.1f} m/s at {rows[row].strip()}, {columns[column].strip()}")
    return f"from {ends[0]} to {ends[1]}" if speeds.size > 1 else ends[0]


def _where(found: WindMap) -> str:
    """Which places are shown."""
    if found.about is not None:
        about = f"{found.about.latitude_deg:g}, {found.about.longitude_deg:g}"
        return f"km north and east of {about}, between the grid's nodes"
    if found.stride is None:
        return "the nearest nodes of the grid"
    if found.stride == (1, 1):
        return "all nodes of the grid"
    rows, columns = found.stride
    return f"1 of {rows} rows and 1 of {columns} columns of the grid"
