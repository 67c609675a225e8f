"""What stands in an inventory of forecast files, in words."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import groupby, pairwise

from gcs_windplan.wind.pairing import say_time
from gcs_windplan.wind.report.extent import Extent, Spacing
from gcs_windplan.wind.report.inventory import Count, FileFacts, GridFacts, Holding, Inventory, Missing
from gcs_windplan.wind.report.series import Gap, Series
from gcs_windplan.wind.report.trial import Trial
from gcs_windplan.wind.sheets import Level

_LISTED = 8  # levels, times
_SHORT = 16  # characters of names
_STEPS = ((86400.0, "d"), (3600.0, "h"), (60.0, "min"), (1.0, "s"))
_BASES = {"height": "m above ground", "altitude": "m above sea level", "pressure": "hPa", "model": ""}
_PARTNERS = {"u": "v", "v": "u", "speed": "direction", "direction": "speed"}
_BESIDE = (
    ("height", "heights of its levels"), ("terrain", "terrain"), ("gust", "gusts"), ("roughness", "roughness"),
)  # fmt: skip


def file_line(file: FileFacts) -> str:
    """A file: name, format, title, size."""
    parts = [file.format, file.title[:120], counted(file.sheets, "sheet")]
    return f"{file.path}: {', '.join(part for part in parts if part)}"


def times_line(series: Series, whole: int) -> str:
    """The times: first, last, steps, gaps."""
    times = series.times
    if not times:
        return "the files tell none"
    if len(times) == 1:
        return f"{say_time(times[0])} alone"
    text = f"{say_span(times[0], times[-1])}, {len(times)} times, {_steps(series)}"
    if series.gaps:
        text += f"; missing: {few([_gap(gap) for gap in series.gaps])}"
    return text + (f"; {whole or 'none'} of them with both parts of a wind" if whole != len(times) else "")


def runs_line(runs: Sequence[float]) -> str:
    """When the model began."""
    return few([say_time(run) for run in runs], 4) or "not told"


def members_line(inventory: Inventory) -> str:
    """The members of an ensemble."""
    members = inventory.members
    if not members:
        return "none: one forecast"
    even = members == tuple(range(members[0], members[-1] + 1))
    told = f"{members[0]} to {members[-1]}" if even and len(members) > 2 else few([str(m) for m in members])
    return f"{len(members)}: {told}" + (", beside a forecast without a member" if inventory.alone else "")


def grid_line(grid: GridFacts) -> str:
    """A grid: name, size, spacing, area."""
    size = f"{grid.rows} x {grid.columns}"
    named = grid.name if all(str(n) in grid.name for n in (grid.rows, grid.columns)) else f"{grid.name}, {size}"
    if (grid.rows, grid.columns) == (1, 1):
        named = "one place"
    parts = [named, _spacing(grid.spacing), _extent(grid.extent)]
    turned = "u and v follow its rows and columns and are turned to true north" if grid.turned else ""
    return "; ".join(part for part in (*parts, turned) if part)


def beside_line(inventory: Inventory) -> str:
    """What else there is that planning makes use of."""
    there = {holding.quantity for holding in inventory.holdings}
    counted = {level.kind for holding in inventory.holdings for level in holding.levels}
    worked_out = "height" not in there and there >= {"temperature", "pressure"}
    useful = [
        (quantity, word)
        for quantity, word in _BESIDE
        if quantity != "height" or (counted & {"pressure", "model"} and not worked_out)
    ]
    have = [word for quantity, word in useful if quantity in there]
    have += ["temperature and pressure, for the heights of its levels"] if worked_out else []
    lack = [f"no {word}" for quantity, word in useful if quantity not in there]
    return "; ".join(", ".join(words) for words in (have, lack) if words)


def missing_line(count: Count) -> str:
    """How many values are missing."""
    values = sum(one.values for one in count.found)
    if not values:
        return "not counted: no sheet can be read"
    read = f"a sample of {count.read} of its" if count.sampled else "all" if count.read > 1 else "its"
    whence = f"{grouped(values)} values in {read} {'sheets' if count.sheets > 1 else 'sheet'}"
    lacking = [_missing(one) for one in count.found if one.missing]
    return f"{'; '.join(lacking)}; counted {whence}" if lacking else f"none of {whence}"


def trial_line(trial: Trial) -> str:
    """What planning makes of it."""
    if trial.obstacle:
        return f"stopped: {trial.obstacle}"
    tried = "" if trial.whole else " (tried at the first time" + (", first member)" if trial.members else ")")
    return f"ready{tried}: {trial.said}"


def asks_line(trial: Trial) -> str:
    """Which fields of the mission file it takes."""
    asks = []
    if trial.obstacle:
        return ""
    if trial.departures is not None and trial.departures[0] < trial.departures[1]:
        asks.append(f"`departure` from {say_span(*trial.departures)}")
    if trial.members:
        asks.append(f"`members: all`, or some, `members: [{trial.members[0]}]`")
    return "; ".join(asks)


def units_cell(holding: Holding) -> str:
    """The file's own unit, and what it becomes."""
    if holding.quantity not in ("u", "v", "speed", "gust"):
        return holding.units
    return holding.units if holding.units in ("m/s", "") else f"{holding.units} → m/s"


def names_cell(holding: Holding) -> str:
    """The file's own names: all if they are short, else the first."""
    names = [name for name in holding.names if name]
    return few(names, 4 if sum(map(len, names)) <= _SHORT else 1)


def short(level: Level) -> str:
    """A level's name in a table."""
    if level.kind == "unknown":
        return "height not told"
    return str(level).replace(" above ground", " agl").replace(" above mean sea level", " amsl")


def levels_cell(levels: Sequence[Level]) -> str:
    """Levels, each kind with its unit once."""
    return "; ".join(_of_kind(kind, list(group)) for kind, group in groupby(levels, key=lambda level: level.kind))


def lone_line(lone: Sequence[Holding]) -> str:
    """Levels that have one part of a wind without the other."""
    return "; ".join(f"{one.quantity} without {_PARTNERS[one.quantity]}: {levels_cell(one.levels)}" for one in lone)


def say_span(first: float, last: float, word: str = "to") -> str:
    """The first and the last of some times, the day only once if it is the same."""
    begin, end = say_time(first), say_time(last)
    return f"{begin.removesuffix(' UTC')} {word} {end[11:] if begin[:10] == end[:10] else end}"


def few(words: Sequence[str], most: int = _LISTED) -> str:
    """Some words, and how many more."""
    return ", ".join(words[:most]) + (f" and {len(words) - most} more" if len(words) > most else "")


def counted(number: int, word: str) -> str:
    """A number of things."""
    return f"{grouped(number)} {word}{'' if number == 1 else 's'}"


def grouped(number: int) -> str:
    """A whole number in groups of three digits."""
    return f"{number:,}".replace(",", " ")


def say_step(seconds: float) -> str:
    """A step in time."""
    size, name = next(((s, n) for s, n in _STEPS if seconds >= s and seconds % s == 0), (1.0, "s"))
    return f"{seconds / size:g} {name}" if name != "d" or seconds > size else "24 h"


def _steps(series: Series) -> str:
    if series.uneven and len(series.times) <= _LISTED:
        return f"uneven: {', '.join(say_time(time)[5:16] for time in series.times)}"
    if series.uneven:
        steps = [later - earlier for earlier, later in pairwise(series.times)]
        return f"in uneven steps of {say_step(min(steps))} to {say_step(max(steps))}"
    first, *rest = (f"every {say_step(step)}" for step, _ in series.steps)
    until = [say_time(end) for _, end in series.steps]
    return first + "".join(f" until {end}, then {step}" for end, step in zip(until, rest, strict=False))


def _gap(gap: Gap) -> str:
    if gap.count == 1:
        return say_time(gap.first)
    return f"{say_time(gap.first)} to {say_time(gap.last)} ({gap.count})"


def _missing(one: Missing) -> str:
    where = ""
    if one.first is not None:
        when = "" if one.first.time is None else f", {say_time(one.first.time)}"
        where = f", first at {one.first.level}{when}"
    share = 100 * one.missing / one.values
    return f"{one.quantity}: {grouped(one.missing)} ({share:.2g} %{where})"


def _of_kind(kind: str, levels: Sequence[Level]) -> str:
    if kind in ("surface", "unknown"):
        return short(levels[0])
    scale = 0.01 if kind == "pressure" else 1.0
    values = [f"{level.value * scale:g}" for level in levels]
    listed = ", ".join(values) if len(values) <= _LISTED else f"{len(values)} from {values[0]} to {values[-1]}"
    if kind == "model":
        return f"model level{'s' if len(values) > 1 else ''} {listed}"
    return f"{listed} {_BASES[kind]}"


def _spacing(spacing: Spacing) -> str:
    kilometres = _by("km", tuple(None if step is None else step / 1000 for step in spacing.metres), 2)
    if spacing.degrees is None or not kilometres:
        return f"every {kilometres}" if kilometres else ""
    return f"every {_by('°', spacing.degrees, 4)} ({kilometres})"


def _by(unit: str, steps: tuple[float | None, ...], digits: int) -> str:
    """Steps from row to row and column to column."""
    known = [f"{float(f'{step:.{digits}g}') if step < 100 else round(step):g}" for step in steps if step is not None]
    blank = "" if unit == "°" else " "
    return f"{' x '.join(dict.fromkeys(known))}{blank}{unit}" if known else ""


def _extent(extent: Extent) -> str:
    east = extent.east - 360.0 if extent.east > 180.0 else extent.east
    bounds = (extent.south, extent.north, extent.west, east)
    south, north, west, east_end = (f"{round(value, 3):g}" for value in bounds)
    latitudes = f"latitude {south}" if south == north else f"latitudes {south} to {north}"
    if extent.round:
        return f"{latitudes}, all longitudes"
    across = " across the date line" if extent.east > 180.0 else ""
    return (
        f"{latitudes}, longitude {west}"
        if west == east_end
        else f"{latitudes}, longitudes {west} to {east_end}{across}"
    )
