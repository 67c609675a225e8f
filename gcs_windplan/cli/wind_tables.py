"""An inventory of forecast files and the wind at a place, as tables on the terminal."""

from __future__ import annotations

from textwrap import wrap

import numpy as np
from rich import box
from rich.table import Table
from rich.text import Text

from gcs_windplan.arrays import FloatArray
from gcs_windplan.cli import wind_words as words
from gcs_windplan.cli.tables import make_console
from gcs_windplan.cli.wind_picture import Picture
from gcs_windplan.wind.inspect.inventory import Inventory
from gcs_windplan.wind.inspect.sounding import LevelWind, Sounding

_INDENT = 10  # characters
_FILES = 10  # that are named one by one
_SINGLY = 12  # members that are shown one by one


def print_inventory(inventory: Inventory) -> None:
    """What is in the files: facts, then a table of quantities."""
    files = inventory.files
    facts = [
        *(("file", words.file_line(file)) for file in files[:_FILES]),
        ("", f"and {len(files) - _FILES} more files" if len(files) > _FILES else ""),
        ("runs" if len(inventory.runs) > 1 else "run", words.runs_line(inventory.runs)),
        ("times", words.times_line(inventory)),
        ("members", words.members_line(inventory)),
        *(("grid", words.grid_line(grid)) for grid in inventory.grids),
        *(("broken", text) for text in inventory.broken),
        *(("unused", text) for text in dict.fromkeys(text for file in files for text in file.unused)),
        ("planning", words.planning_line(inventory.planning)),
        ("asks for", words.asks_line(inventory.planning)),
    ]
    for name, text in facts:
        if text:
            _say(text, f"{name:<{_INDENT}}")
    make_console().print(_quantities(inventory))


def print_picture(picture: Picture) -> None:
    """A picture, and what it shows."""
    for line in (*picture.lines, ""):
        _print(line)
    for text in picture.captions:
        _say(text)


def print_sounding(sounding: Sounding) -> None:
    """The wind at a place: a row a level, or the one height asked for; of many members the median and the ends."""
    at_height, members = sounding.at_height, sounding.members
    table = _table() if at_height else _table("level", "m AMSL", "m AGL")
    if members != (None,):
        table.add_column("member", justify="right", no_wrap=True)
    for name in ("u m/s", "v m/s", "speed m/s", "from °"):
        table.add_column(name, justify="right", no_wrap=True)
    for one in sounding.levels if at_height is None else ():
        _add(table, [words.short(one.level), *_heights(one)], members, one.winds)
    if at_height is not None:
        _add(table, [], members, at_height.winds)
    _say(words.heading(sounding))
    make_console().print(table)
    for text in (_gusts(sounding), words.how_found(sounding), f"planning uses {sounding.uses}"):
        if text:
            _say(text)


def direction_from(winds: FloatArray) -> FloatArray:
    """Where winds (n, 2) towards east and north come from [deg, clockwise from true north], NaN for still air."""
    u, v = winds[..., 0], winds[..., 1]
    directions: FloatArray = np.where(np.hypot(u, v) > 0, np.degrees(np.arctan2(-u, -v)) % 360.0, np.nan)
    return directions


def _say(text: str, name: str = "") -> None:
    """A text in as many lines as it takes, with its name in front."""
    indent = " " * (len(name) or 2)
    width = max(make_console().width, len(indent) + 20)
    for line in wrap(text, width, initial_indent=name, subsequent_indent=indent, break_on_hyphens=False):
        _print(line)


def _print(line: str) -> None:
    make_console().print(line, soft_wrap=True, markup=False)


def _table(*names: str) -> Table:
    table = Table(box=box.SIMPLE_HEAD, pad_edge=False, collapse_padding=True)
    for number, name in enumerate(names):
        table.add_column(name, justify="right" if number else "left", no_wrap=True)
    return table


def _quantities(inventory: Inventory) -> Table:
    table = _table("quantity")
    for name in ("in the file", "unit", "levels"):
        table.add_column(name, overflow="fold")
    shown = {"grid": len(inventory.grids) > 1, "times": True, "members": bool(inventory.members), "fields": True}
    numbers = [name for name, there in shown.items() if there]
    sampled = inventory.fields_read < sum(one.fields for one in inventory.quantities)
    for name in numbers:
        table.add_column(name, justify="right", no_wrap=True)
    table.add_column("missing in a sample" if sampled else "missing", justify="right")
    for one in inventory.quantities:
        cells = [one.quantity, words.names_cell(one), words.units_cell(one), words.levels_cell(one.levels)]
        counts = {"grid": one.grid + 1, "times": one.times, "members": one.members, "fields": one.fields}
        numbered = [words.grouped(counts[name]) if counts[name] else "-" for name in numbers]
        table.add_row(*map(Text, cells), *numbered, words.missing_cell(one))
    return table


def _add(table: Table, before: list[str], members: tuple[int | None, ...], winds: FloatArray) -> None:
    """A row a member; of many members the median, the least and the most of each number."""
    numbers = np.column_stack([winds, np.hypot(*winds.T), direction_from(winds)])
    names = [] if members == (None,) else [str(member) for member in members]
    if len(members) > _SINGLY:
        names = [f"median of {len(members)}", "least", "most"]
        numbers = np.column_stack([_median_and_ends(numbers[:, :3]), _arc(numbers[:, 3])])
    for row, values in enumerate(numbers.tolist()):
        cells = [*map(_number, values[:3]), _number(values[3] % 360.0, True)]
        table.add_row(*(before if not row else [""] * len(before)), *names[row : row + 1], *cells)


def _median_and_ends(values: FloatArray) -> FloatArray:
    return np.stack([np.median(values, axis=0), values.min(axis=0), values.max(axis=0)])


def _arc(directions: FloatArray) -> FloatArray:
    """The median and the ends of the smallest arc that holds all directions [deg], clockwise; NaN ignored."""
    there = np.sort(directions[np.isfinite(directions)])
    if not len(there):
        return np.full(3, np.nan)
    start = there[(int(np.argmax(np.diff(there, append=there[0] + 360.0))) + 1) % len(there)]
    arc: FloatArray = start + _median_and_ends((there - start) % 360.0)
    return arc


def _number(value: float, circular: bool = False) -> str:
    """Two decimals, `-` where there is none; 359.999 degrees are 0."""
    if not np.isfinite(value):
        return "-"
    rounded = round(value, 2)
    return f"{rounded % 360.0 if circular else rounded + 0.0:.2f}"


def _heights(one: LevelWind) -> list[str]:
    return [f"{value:.0f}" if np.isfinite(value) else "-" for value in (one.height, one.above_ground)]


def _gusts(sounding: Sounding) -> str:
    gusts, members = sounding.gusts, sounding.members
    if len(gusts) > _SINGLY:
        median, least, most = map(_number, _median_and_ends(gusts).tolist())
        return f"gusts {median} m/s, {least} to {most} m/s"
    values = zip(members, gusts.tolist(), strict=False)
    texts = [_number(gust) + ("" if member is None else f" (member {member})") for member, gust in values]
    return f"gust{'s' if len(texts) > 1 else ''} {', '.join(texts)} m/s" if texts else ""
