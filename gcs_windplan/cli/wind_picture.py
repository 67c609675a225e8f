"""The wind as a small picture of characters: arrows that point where it blows to, and its speed."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from gcs_windplan.arrays import BoolArray, FloatArray
from gcs_windplan.cli.wind_options import Asked, View
from gcs_windplan.cli.wind_words import say_span, short
from gcs_windplan.wind.pairing import say_time
from gcs_windplan.wind.report.level_map import LevelMap, TimeMap, map_around, map_of, single_place, times_of
from gcs_windplan.wind.sheets import Catalogue

_ARROWS = "↑↗→↘↓↙←↖"  # clockwise from north
_CELL = 8  # characters
_CALM = 0.05  # [m/s] what is shown as 0.0 blows nowhere


@dataclass(frozen=True, slots=True)
class Picture:
    """Its lines, and sentences about it."""

    lines: list[str]
    captions: list[str]


def draw(catalogues: Sequence[Catalogue], asked: Asked, view: View) -> Picture:
    """The picture that is asked for. Raises `WindError`."""
    moment, choice = asked
    if view.place is not None and view.radius is not None:
        return _of_level(map_around(catalogues, view.place, view.radius, moment, view.level, choice))
    if single_place(catalogues) and moment is None and view.level is None:
        return _of_times(times_of(catalogues, choice))
    return _of_level(map_of(catalogues, moment, view.level, choice))


def _of_level(found: LevelMap) -> Picture:
    scale = 1.0 if found.about is None else 1e-3
    rows, columns = _numbers(found.rows * scale, found.about), _numbers(found.columns * scale, found.about)
    corner = "lat\\lon" if found.about is None else "km"
    lines = _lattice(corner, rows, columns, found.winds, found.outside)
    extremes = _extremes(found.winds, lambda row, column: f"{rows[row].strip()}, {columns[column].strip()}")
    blank = ["blank: outside of its area"] if found.outside.any() else []
    return Picture(
        lines,
        [
            f"wind at {found.level}, {_when(found.moment, found.times)}{_member(found)}; {_where(found)}",
            "; ".join([extremes, "arrows point where it blows to, north is up", *blank]),
        ],
    )


def _of_times(found: TimeMap) -> Picture:
    rows = [short(level) for level in found.levels]
    columns = [say_time(time)[11:16] for time in found.times] or ["any time"]
    lines = _lattice("UTC", rows, columns, found.winds, np.zeros(found.winds.shape[:2], dtype=np.bool_))
    span = f", {say_span(found.times[0], found.times[-1])}" if found.times else ""
    extremes = _extremes(found.winds, lambda row, column: f"{found.levels[row]}, {columns[column]}")
    place = f"{found.place.latitude_deg:.4f}, {found.place.longitude_deg:.4f}"
    return Picture(
        lines,
        [
            f"wind at {place}, levels upwards, times to the right{span}{_member(found)}",
            f"{extremes}; arrows point where it blows to, up is north",
        ],
    )


def _lattice(corner: str, rows: list[str], columns: list[str], winds: FloatArray, outside: BoolArray) -> list[str]:
    """A line a row, under a line of columns' names."""
    wide = max(_CELL, *(len(name) for name in (corner, *rows)))
    lines = [f"{corner:>{wide}}" + "".join(f"{name:>{_CELL}}" for name in columns)]
    for name, row, out in zip(rows, winds, outside, strict=True):
        cells = ["" if gone else _cell(*wind) for wind, gone in zip(row, out, strict=True)]
        lines.append((f"{name:>{wide}}" + "".join(f"{cell:>{_CELL}}" for cell in cells)).rstrip())
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


def _extremes(winds: FloatArray, name: Callable[[int, int], str]) -> str:
    """The largest and the smallest speed, and where they are."""
    speeds = np.hypot(winds[..., 0], winds[..., 1])
    if not np.isfinite(speeds).any():
        return "no wind is known at any of these places"
    told = []
    for at in (np.nanargmin(speeds), np.nanargmax(speeds)):
        row, column = (int(number) for number in np.unravel_index(int(at), speeds.shape))
        told.append(f"{speeds[row, column]:.1f} m/s at {name(row, column)}")
    return f"from {told[0]} to {told[1]}" if speeds.size > 1 else told[0]


def _when(moment: float | None, times: tuple[float, ...]) -> str:
    if moment is None:
        return "no time given"
    if times in ((moment,), ()):
        return say_time(moment)
    if len(times) == 1:
        return f"{say_time(moment)} (as at {say_time(times[0])})"
    return f"{say_time(moment)} (between {say_span(times[0], times[-1], 'and')})"


def _member(found: LevelMap | TimeMap) -> str:
    if found.member is None:
        return ""
    return f", member {found.member}" + (f", the first of {found.members}" if found.members > 1 else "")


def _where(found: LevelMap) -> str:
    """Which places are shown."""
    if found.about is not None:
        about = f"{found.about.latitude_deg:g}, {found.about.longitude_deg:g}"
        return f"km north and east of {about}, between the grid's nodes"
    if found.between:
        return "between the grid's nodes"
    if found.stride == (1, 1):
        return "all nodes of the grid"
    rows, columns = (f"every {_ordinal(stride)}" if stride > 1 else "every" for stride in found.stride)
    return f"{rows} row and {columns} column of the grid"


def _ordinal(number: int) -> str:
    if number % 100 in (11, 12, 13):
        return f"{number}th"
    return f"{number}{ {1: 'st', 2: 'nd', 3: 'rd'}.get(number % 10, 'th') }"
