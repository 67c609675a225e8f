"""What stands in an inventory of forecast files, and in a sounding, in words."""

from __future__ import annotations

import math
from collections.abc import Sequence
from itertools import groupby, pairwise

from gcs_windplan.wind.field_index import Level
from gcs_windplan.wind.inspect.grids import GridSummary
from gcs_windplan.wind.inspect.inventory import FileSummary, Inventory, QuantitySummary
from gcs_windplan.wind.inspect.sounding import LevelWind, Sounding, describe
from gcs_windplan.wind.inspect.trial import PlanningTrial
from gcs_windplan.wind.pairing import format_time

_LISTED = 8  # levels, times
_SHORT = 16  # characters of names
_STEPS = ((86400.0, "d"), (3600.0, "h"), (60.0, "min"), (1.0, "s"))
_UNITS = {"height": "m above ground", "altitude": "m above sea level", "pressure": "hPa"}


def file_line(file: FileSummary) -> str:
    """A file: name, format, title, size."""
    parts = [file.format, file.title[:120], f"{grouped(file.fields)} field{'' if file.fields == 1 else 's'}"]
    return f"{file.path}: {', '.join(part for part in parts if part)}"


def times_line(inventory: Inventory) -> str:
    """The times: first, last, steps, gaps."""
    times, whole = inventory.times, inventory.with_whole_wind
    if len(times) < 2:
        return f"{format_time(times[0])} alone" if times else "the files tell none"
    steps = [round(later - earlier) for earlier, later in pairwise(times)]
    every = f"every {say_step(steps[0])}" if len(set(steps)) == 1 else f"every {say_step(min(steps))} or more"
    text = f"{say_span(times[0], times[-1])}, {len(times)} times, {every}"
    if inventory.gaps:
        text += f"; gaps: {few([say_span(gap.after, gap.before) for gap in inventory.gaps])}"
    return text + (f"; {whole or 'none'} of them with both parts of a wind" if whole != len(times) else "")


def runs_line(runs: Sequence[float]) -> str:
    """When the model began."""
    return few([format_time(run) for run in runs], 4) or "not told"


def members_line(inventory: Inventory) -> str:
    """The members of an ensemble."""
    members = inventory.members
    if not members:
        return "none: one forecast"
    even = members == tuple(range(members[0], members[-1] + 1))
    listed = f"{members[0]} to {members[-1]}" if even and len(members) > 2 else few([str(m) for m in members])
    beside = ", beside a forecast without a member" if inventory.also_without_member else ""
    return f"{len(members)}: {listed}{beside}"


def grid_line(grid: GridSummary) -> str:
    """A grid: name, size, spacing, area."""
    named = grid.name
    if (grid.rows, grid.columns) == (1, 1):
        named = "one place"
    elif not all(str(n) in grid.name for n in (grid.rows, grid.columns)):
        named = f"{grid.name}, {grid.rows} x {grid.columns}"
    turned = "u and v follow its rows and columns and are turned to true north" if grid.turned else ""
    return "; ".join(part for part in (named, _spacing(grid), _area(grid), turned) if part)


def planning_line(planning: PlanningTrial) -> str:
    """What planning makes of it."""
    if planning.obstacle:
        return f"stopped: {planning.obstacle}"
    first = " (tried at the first time" + (", first member)" if planning.members else ")")
    return f"ready{'' if planning.all_tried else first}: {planning.uses}"


def asks_line(planning: PlanningTrial) -> str:
    """Which fields of the mission file it takes."""
    asks = []
    if planning.obstacle:
        return ""
    if planning.departures is not None and planning.departures[0] < planning.departures[1]:
        asks.append(f"`departure` from {say_span(*planning.departures)}")
    if planning.members:
        asks.append(f"`members: all`, or some, `members: [{planning.members[0]}]`")
    return "; ".join(asks)


def heading(sounding: Sounding) -> str:
    """Where and when a sounding is."""
    where = f"{sounding.place.latitude_deg:.5f}, {sounding.place.longitude_deg:.5f}"
    at = sounding.at_height
    heights = {} if at is None else {"mean sea level": at.height, "ground": at.above_ground}
    height = ", ".join(f"{value:.0f} m above {datum}" for datum, value in heights.items() if math.isfinite(value))
    moment = "no time given" if sounding.moment is None else format_time(sounding.moment)
    known = math.isfinite(sounding.ground)
    ground = f"the forecast's ground is at {sounding.ground:.0f} m" if known else ""
    return "wind at " + "; ".join(part for part in (where, height, moment, ground) if part)


def how_found(sounding: Sounding) -> str:
    """Between which levels and times the wind was found."""
    at, text = sounding.at_height, "linear"
    if at is not None:
        if at.above_ground < 0:
            text = f"{-at.above_ground:.0f} m below the forecast's own ground, where there is no wind"
        elif at.lower is None:
            text = f"below its lowest level, {describe(at.upper)}"
        elif at.lower is at.upper:
            text = f"on its level {_at(at.upper)}"
        else:
            text = f"linear between {_at(at.lower)} and {_at(at.upper)}"
    times = sounding.times
    if sounding.moment is None or times in ((), (sounding.moment,)):
        when = ""
    elif len(times) == 1:
        when = f"; as at {format_time(times[0])}, the only time"
    else:
        when = f"; in time between {say_span(times[0], times[-1], 'and')}"
    return f"{text}{'; ' if at is not None else ' '}between the nodes about the place{when}"


def between_times(moment: float | None, times: tuple[float, ...]) -> str:
    """A moment, and the times that have a share in it."""
    if moment is None:
        return "no time given"
    if times in ((moment,), ()):
        return format_time(moment)
    if len(times) == 1:
        return f"{format_time(moment)} (as at {format_time(times[0])})"
    return f"{format_time(moment)} (between {say_span(times[0], times[-1], 'and')})"


def units_cell(one: QuantitySummary) -> str:
    """The file's own unit, and what it becomes."""
    converted = one.quantity in ("u", "v", "speed", "gust") and one.units not in ("m/s", "")
    return f"{one.units} → m/s" if converted else one.units


def names_cell(one: QuantitySummary) -> str:
    """The file's own names: all if they are short, else the first."""
    names = [name for name in one.names if name]
    return few(names, 4 if sum(map(len, names)) <= _SHORT else 1)


def missing_cell(one: QuantitySummary) -> str:
    """How many values are missing."""
    if not one.values:
        return "?"
    return f"{100 * one.missing / one.values:.2g} %" if one.missing else "none"


def short(level: Level) -> str:
    """A level's name in a table."""
    if level.kind == "unknown":
        return "height not told"
    return str(level).replace(" above ground", " agl").replace(" above mean sea level", " amsl")


def levels_cell(levels: Sequence[Level]) -> str:
    """Levels, each kind with its unit once."""
    return "; ".join(_of_kind(kind, list(group)) for kind, group in groupby(levels, key=lambda level: level.kind))


def say_span(first: float, last: float, word: str = "to") -> str:
    """The first and the last of some times, the day only once if it is the same."""
    begin, end = format_time(first), format_time(last)
    return f"{begin.removesuffix(' UTC')} {word} {end[11:] if begin[:10] == end[:10] else end}"


def few(words: Sequence[str], most: int = _LISTED) -> str:
    """Some words, and how many more."""
    return ", ".join(words[:most]) + (f" and {len(words) - most} more" if len(words) > most else "")


def grouped(number: int) -> str:
    """A whole number in groups of three digits."""
    return f"{number:,}".replace(",", " ")


def say_step(seconds: float) -> str:
    """A step in time."""
    size, name = next(((s, n) for s, n in _STEPS if seconds >= s and seconds % s == 0), (1.0, "s"))
    return f"{seconds / size:g} {name}" if name != "d" or seconds > size else "24 h"


def _of_kind(kind: str, levels: Sequence[Level]) -> str:
    if kind in ("surface", "unknown"):
        return short(levels[0])
    values = [f"{level.value * (0.01 if kind == 'pressure' else 1.0):g}" for level in levels]
    listed = ", ".join(values) if len(values) <= _LISTED else f"{len(values)} from {values[0]} to {values[-1]}"
    if kind == "model":
        return f"model level{'s' if len(values) > 1 else ''} {listed}"
    return f"{listed} {_UNITS[kind]}"


def _at(one: LevelWind) -> str:
    if math.isfinite(one.height):
        return f"{short(one.level)} ({one.height:.0f} m AMSL)"
    return f"{short(one.level)} ({one.above_ground:.0f} m AGL)"


def _spacing(grid: GridSummary) -> str:
    """Steps from row to row and column to column."""
    steps = [step / 1000 for step in grid.spacing_metres if step is not None]
    known = dict.fromkeys(f"{float(f'{step:.2g}') if step < 100 else round(step):g}" for step in steps)
    return f"every {' x '.join(known)} km" if known else ""


def _area(grid: GridSummary) -> str:
    across = " across the date line" if grid.east > 180.0 else ""
    bounds = (grid.south, grid.north, grid.west, grid.east - (360.0 if across else 0.0))
    south, north, west, east = (f"{round(value, 3):g}" for value in bounds)
    latitudes = f"latitude {south}" if south == north else f"latitudes {south} to {north}"
    if grid.all_longitudes:
        return f"{latitudes}, all longitudes"
    return f"{latitudes}, longitude {west}" if west == east else f"{latitudes}, longitudes {west} to {east}{across}"
