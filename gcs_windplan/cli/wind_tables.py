"""An inventory of forecast files and the wind at a place, as tables on the terminal."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import astuple
from textwrap import wrap

import numpy as np
from rich import box
from rich.table import Table
from rich.text import Text

from gcs_windplan.arrays import FloatArray
from gcs_windplan.cli import wind_words as words
from gcs_windplan.cli.tables import make_console
from gcs_windplan.cli.wind_picture import Picture
from gcs_windplan.wind.pairing import say_time
from gcs_windplan.wind.report.inventory import Inventory
from gcs_windplan.wind.report.sounding import Here, Row, Sounding, Spot
from gcs_windplan.wind.report.spread import direction_from, spread_of, spread_of_directions
from gcs_windplan.wind.sheets import Level

_INDENT = 10  # characters
_FILES = 10  # that are named one by one
_SINGLY = 12  # members that are shown one by one


def print_inventory(inventory: Inventory) -> None:
    """What is in the files: facts, then a table of quantities."""
    console = make_console()
    for name, text in _facts(inventory):
        _say(text, f"{name:<{_INDENT}}")
    console.print(_quantities(inventory))


def print_picture(picture: Picture) -> None:
    """A picture, and what it shows."""
    for line in picture.lines:
        _print(line)
    _print("")
    for text in picture.captions:
        _say(text)


def print_wind(found: Sounding | Spot) -> None:
    """The wind at a place."""
    if isinstance(found, Spot):
        _print_spot(found)
    else:
        _print_sounding(found)


def _say(text: str, name: str = "") -> None:
    """A text in as many lines as it takes, with its name in front."""
    indent = " " * (len(name) or 2)
    width = max(make_console().width, len(indent) + 20)
    for line in wrap(text, width, initial_indent=name, subsequent_indent=indent, break_on_hyphens=False):
        _print(line)


def _print(line: str) -> None:
    make_console().print(line, soft_wrap=True, markup=False)


def _facts(inventory: Inventory) -> list[tuple[str, str]]:
    """Names and texts, without those that have nothing to tell."""
    count, trial, files = inventory.count, inventory.trial, inventory.files
    lines = [
        *(("file", words.file_line(file)) for file in files[:_FILES]),
        ("", f"and {len(files) - _FILES} more files" if len(files) > _FILES else ""),
        ("runs" if len(inventory.runs) > 1 else "run", words.runs_line(inventory.runs)),
        ("times", words.times_line(inventory.times, inventory.whole)),
        ("members", words.members_line(inventory)),
        *(("grid", words.grid_line(grid)) for grid in inventory.grids),
        ("also", words.beside_line(inventory)),
        ("lone", words.lone_line(inventory.lone)),
        ("missing", words.missing_line(count)),
        *(("broken", text) for text in count.broken),
        *(("unused", text) for text in dict.fromkeys(text for file in files for text in file.unused)),
        ("planning", words.trial_line(trial)),
        ("asks for", words.asks_line(trial)),
    ]
    return [(name, text) for name, text in lines if text]


def _quantities(inventory: Inventory) -> Table:
    table = Table(box=box.SIMPLE_HEAD, pad_edge=False, collapse_padding=True)
    for name in ("quantity", "in the file", "unit", "levels"):
        table.add_column(name, no_wrap=name == "quantity", overflow="fold")
    numbers = [name for name, shown in (("grid", len(inventory.grids) > 1), ("times", True),
                                        ("members", bool(inventory.members)), ("sheets", True)) if shown]  # fmt: skip
    for name in numbers:
        table.add_column(name, justify="right", no_wrap=True)
    for one in inventory.holdings:
        cells = [one.quantity, words.names_cell(one), words.units_cell(one), words.levels_cell(one.levels)]
        counts = {"grid": one.grid + 1, "times": one.times, "members": one.members, "sheets": one.sheets}
        table.add_row(*map(Text, cells), *(words.grouped(counts[name]) if counts[name] else "-" for name in numbers))
    return table


def _print_spot(spot: Spot) -> None:
    _say(_heading(spot.here, spot))
    table = _wind_table(spot.members)
    _add(table, [], spot.members, spot.winds)
    make_console().print(table)
    for text in (*_gusts(spot.here), _how(spot)):
        _say(text)


def _print_sounding(sounding: Sounding) -> None:
    _say(_heading(sounding.here, None))
    table = _wind_table(sounding.rows[0].members, "level", "m AMSL", "m AGL")
    for row in sounding.rows:
        _add(table, _level_cells(row, sounding.here.ground), row.members, row.winds)
    make_console().print(table)
    marks = {_mark(row) for row in sounding.rows}
    notes = [note for mark, note in _MARKS.items() if mark in marks]
    for text in (*_gusts(sounding.here), f"linear between the nodes about the place{_between(sounding.here)}", *notes):
        _say(text)


_MARKS = {
    "*": "* no higher than the forecast's own ground or its levels above ground: planning passes over it",
    "+": "+ planning has no use for it: its height is not known, or other times, members or levels fit better",
}


def _mark(row: Row) -> str:
    return "*" if row.hidden else "" if row.planned else "+"


def _heading(here: Here, spot: Spot | None) -> str:
    where = f"{here.place.latitude_deg:.5f}, {here.place.longitude_deg:.5f}"
    when = "no time given" if here.moment is None else say_time(here.moment)
    ground = f"the forecast's ground is at {here.ground:.0f} m" if np.isfinite(here.ground) else ""
    height = ""
    if spot is not None:
        over = f"{spot.above_ground:.0f} m above ground" if np.isfinite(spot.above_ground) else ""
        sea = f"{spot.height:.0f} m above mean sea level" if np.isfinite(spot.height) else ""
        height = ", ".join(part for part in (sea, over) if part)
    return "wind at " + "; ".join(part for part in (where, height, when, ground) if part)


def _wind_table(members: Sequence[int | None], *before: str) -> Table:
    table = Table(box=box.SIMPLE_HEAD, pad_edge=False, collapse_padding=True)
    for name in before:
        table.add_column(name, justify="left" if name == "level" else "right", no_wrap=True)
    if len(members) > 1 or members[0] is not None:
        table.add_column("member", justify="right", no_wrap=True)
    for name in ("u m/s", "v m/s", "speed m/s", "from °"):
        table.add_column(name, justify="right", no_wrap=True)
    return table


def _add(table: Table, before: Sequence[str], members: Sequence[int | None], winds: FloatArray) -> None:
    """A row a member; of many members the median, the least and the most of each number."""
    columns = [winds[:, 0], winds[:, 1], np.hypot(winds[:, 0], winds[:, 1])]
    directions = direction_from(winds)
    names = [] if len(members) == 1 and members[0] is None else ["-" if m is None else str(m) for m in members]
    if len(members) > _SINGLY:
        spreads = [astuple(spread_of(column)) for column in columns]
        columns = [np.array(spread) for spread in spreads]
        directions = np.array(astuple(spread_of_directions(directions)))
        names = [f"median of {len(members)}", "least", "most"]
    for number in range(len(directions)):
        cells = [*(_number(column[number]) for column in columns), _number(directions[number], True)]
        table.add_row(*(before if not number else [""] * len(before)), *names[number : number + 1], *cells)


def _number(value: float, circular: bool = False) -> str:
    """Two decimals, `-` where there is none; 359.999 degrees are 0."""
    if not np.isfinite(value):
        return "-"
    rounded = round(float(value), 2)
    return f"{rounded % 360.0 if circular else rounded + 0.0:.2f}"


def _level_cells(row: Row, ground: float) -> list[str]:
    known = row.heights[np.isfinite(row.heights)]
    height = float(np.mean(known)) if len(known) else np.nan
    above = row.level.value if row.level.kind == "height" else height - ground
    sea, over = (f"{value:.0f}" if np.isfinite(value) else "-" for value in (height, above))
    return [f"{words.short(row.level)}{_mark(row)}", sea, over]


def _gusts(here: Here) -> list[str]:
    if not here.gusts:
        return []
    values = np.array(list(here.gusts.values()))
    if len(values) > _SINGLY:
        median, least, most = (_number(value) for value in astuple(spread_of(values)))
        return [f"gusts {median} m/s, {least} to {most} m/s"]
    told = [_number(value) + ("" if member is None else f" (member {member})") for member, value in here.gusts.items()]
    return [f"gust{'s' if len(told) > 1 else ''} {', '.join(told)} m/s"]


def _between(here: Here) -> str:
    if here.moment is None or here.times in ((), (here.moment,)):
        return ""
    if len(here.times) == 1:
        return f"; as at {say_time(here.times[0])}, the only time"
    return f"; in time between {words.say_span(here.times[0], here.times[-1], 'and')}"


def _how(spot: Spot) -> str:
    """Between which levels and times the wind was found."""
    datum = "AGL" if np.isnan(spot.height) else "AMSL"
    lower, upper = spot.lower, spot.upper
    if np.isfinite(spot.above_ground) and spot.above_ground < 0:
        text = f"{-spot.above_ground:.0f} m below the forecast's own ground, where there is no wind"
    elif lower is None:
        text = f"{_at(upper, datum)} is its lowest level, {spot.law}"
    elif lower[0] == upper[0]:
        text = f"on its level {_at(upper, datum)}"
    else:
        text = f"linear between {_at(lower, datum)} and {_at(upper, datum)}"
    return f"{text}; between the nodes about the place{_between(spot.here)}"


def _at(level: tuple[Level, float], datum: str) -> str:
    return f"{words.short(level[0])} ({level[1]:.0f} m {datum})"
