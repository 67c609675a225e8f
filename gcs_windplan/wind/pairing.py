"""From the fields of forecast files to winds that belong together: which run, which members, which times, which levels.

u and v (or speed and direction) make a pair when level, time, run, member and grid are the same. Of several grids the
one with the most pairs is taken, of several runs for each time the newest that has all levels and members.
"""

from __future__ import annotations

from collections import Counter, defaultdict
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from datetime import UTC, datetime
from itertools import pairwise
from typing import Literal, TypeAlias

import numpy as np

from gcs_windplan.arrays import FloatArray, IntArray
from gcs_windplan.errors import WindError
from gcs_windplan.wind.field_index import Field2D, FieldIndex, Grid, Level, LevelKind, Quantity

#: All members, these ones, or None: there is to be no choice.
Members: TypeAlias = Literal["all"] | tuple[int, ...] | None

STEADY_FOR = 3 * 3600.0  # [s] how far from its one time a file is used where a departure is told: our choice
_GAP = 2.5  # times the usual step between two times, their median: a longer one is said
_PARTNERS: tuple[tuple[Quantity, Quantity], ...] = (("u", "v"), ("speed", "direction"))
_ASL: tuple[LevelKind, ...] = ("pressure", "model", "altitude")


@dataclass(frozen=True, slots=True, eq=False)
class WindPair:
    """Two fields that make a wind: u and v, or speed and direction (`polar`)."""

    first: Field2D
    second: Field2D

    @property
    def polar(self) -> bool:
        """Whether they are speed and direction."""
        return self.first.quantity == "speed"

    @property
    def level(self) -> Level:
        """Their level."""
        return self.first.level

    def read(self, rows: IntArray, columns: IntArray, angle: FloatArray | float = 0.0) -> FloatArray:
        """u and v (rows, columns, 2) towards true east and north [m/s] at some rows and columns, NaN where missing.

        `angle` from true east to the grid's x axis, anticlockwise [rad], of components that follow the grid.
        """
        first, second = self.first.read(rows, columns), self.second.read(rows, columns)
        if self.polar:
            from_angle = np.radians(second)
            return np.stack([-first * np.sin(from_angle), -first * np.cos(from_angle)], axis=-1)
        if self.along_grid:
            cos, sin = np.cos(angle), np.sin(angle)
            first, second = first * cos - second * sin, first * sin + second * cos
        return np.stack([first, second], axis=-1)

    @property
    def along_grid(self) -> bool:
        """Whether they follow rows and columns that are no parallels and meridians, and have to be turned."""
        return not self.polar and self.first.along_grid and not self.first.grid.regular


@dataclass(frozen=True, slots=True)
class TimeSpan:
    """The moments for which wind is wanted [s since 1970, UTC]; without a departure any single one will do."""

    departure: float | None = None
    lasting: float = 0.0


@dataclass(frozen=True, slots=True, eq=False)
class Selection:
    """The pairs that a flight needs: `pairs[time, member, level]`, and everything else on the same grid (`others`).

    `times` ascend [s since 1970]; one alone may be None where the file does not tell. `above_ground` and `above_sea`
    are the levels that count from there, from the ground up as far as can be told. `notes` are for people.
    """

    grid: Grid
    times: tuple[float | None, ...]
    members: tuple[int | None, ...]
    above_ground: tuple[Level, ...]
    above_sea: tuple[Level, ...]
    pairs: dict[tuple[float | None, int | None, Level], WindPair]
    others: tuple[Field2D, ...]
    runs: tuple[float, ...]
    notes: tuple[str, ...]


def select_winds(
    indexes: Sequence[FieldIndex], members: Members, span: TimeSpan, known_height: float | None = None
) -> Selection:
    """The winds of some files for a span. `known_height` [m above ground] is that of a level the file does not name.

    Raises `WindError` for files without a wind, an ensemble without a choice of members, times that do not reach.
    """
    notes: list[str] = []
    pairs = wind_pairs(indexes, notes)
    pairs = _of_members(pairs, members)
    kept, window_note = choose_times(times_of(pairs), span)
    if kept:
        pairs = [pair for pair in pairs if pair.first.time in kept]
    if window_note:
        notes.append(window_note)
    pairs = _newest(pairs, notes)
    table = {(pair.first.time, pair.first.member, pair.level): pair for pair in pairs}
    above_ground, above_sea = _levels_of_all(table, known_height, notes)
    grid = pairs[0].first.grid
    others = tuple(one for index in indexes for one in index.fields if one.grid.key == grid.key)
    return Selection(
        grid=grid,
        times=tuple(sorted({time for time, _, _ in table}, key=lambda time: time or 0.0)),
        members=tuple(sorted({member for _, member, _ in table}, key=lambda member: -1 if member is None else member)),
        above_ground=above_ground,
        above_sea=above_sea,
        pairs=table,
        others=others,
        runs=tuple(sorted({pair.first.run for pair in pairs if pair.first.run is not None})),
        notes=tuple(notes),
    )


def wind_pairs(indexes: Sequence[FieldIndex], notes: list[str] | None = None) -> list[WindPair]:
    """All winds of some files on the grid that has the most of them; `notes` tell of others.

    Raises `WindError` where there are none.
    """
    pairs = pair_up(field2d for index in indexes for field2d in index.fields)
    if not pairs:
        raise WindError(_no_wind_reason(indexes))
    counts = Counter(pair.first.grid.key for pair in pairs)
    key, _ = counts.most_common(1)[0]
    if len(counts) > 1 and notes is not None:
        notes.append(f"{len(pairs) - counts[key]} winds on other grids left out")
    return [pair for pair in pairs if pair.first.grid.key == key]


def times_of(pairs: Iterable[WindPair]) -> list[float]:
    """The times of some winds [s since 1970], ascending; none where the files do not tell."""
    return sorted({pair.first.time for pair in pairs if pair.first.time is not None})


def pair_up(fields: Iterable[Field2D]) -> list[WindPair]:
    """All winds among some fields; where a level has u and v as well as speed and direction, u and v."""
    found: dict[tuple[object, ...], dict[str, Field2D]] = defaultdict(dict)
    for field2d in fields:
        if field2d.quantity in ("u", "v", "speed", "direction"):
            key = (field2d.level, field2d.time, field2d.run, field2d.member, field2d.grid.key)
            found[key].setdefault(field2d.quantity, field2d)
    pairs = []
    for group in found.values():
        for first, second in _PARTNERS:
            if first in group and second in group:
                pairs.append(WindPair(group[first], group[second]))
                break
    return pairs


def _no_wind_reason(indexes: Sequence[FieldIndex]) -> str:
    """Why there is no wind in some files."""
    fields = [field2d for index in indexes for field2d in index.fields]
    have = Counter(field2d.quantity for field2d in fields)
    named = {field2d.quantity: field2d.name or field2d.quantity for field2d in fields}
    unused = "; ".join(text for index in indexes for text in index.unused)
    for first, second in (*_PARTNERS, ("v", "u"), ("direction", "speed")):
        if have[first] and not have[second]:
            return f"it has {first} ({named[first]}) but no {second}: download it along" + (
                f"; {unused}" if unused else ""
            )
    if (have["u"] and have["v"]) or (have["speed"] and have["direction"]):
        us, vs = (
            sorted({str(s.level) for s in fields if s.quantity in q}) for q in (("u", "speed"), ("v", "direction"))
        )
        return f"u and v share no level, time and member: u has {_listed(us)}, v has {_listed(vs)}"
    names = _listed(sorted({field2d.name for field2d in fields if field2d.name}))
    return (
        "it holds no wind that can be used" + (f"; it has {names}" if names else "") + (f"; {unused}" if unused else "")
    )


def choose_times(times: Sequence[float], span: TimeSpan) -> tuple[tuple[float, ...], str]:
    """The times that a span needs, and a note. Raises `WindError` if they do not reach it."""
    if not times:
        return (), "no time given"
    start = span.departure
    if len(times) == 1:
        if start is not None and abs(times[0] - start) > STEADY_FOR:
            raise WindError(
                f"its only time, {format_time(times[0])}, is {abs(times[0] - start) / 3600:.1f} h from the departure"
                f" {format_time(start)}; at most {STEADY_FOR / 3600:g} h are accepted, or no departure at all",
                reason="time",
            )
        return (times[0],), f"steady as at {format_time(times[0])}"
    if start is None:
        raise WindError(
            f"it holds {len(times)} times, {format_time(times[0])} to {format_time(times[-1])}: give `departure`"
        )
    outside = max(times[0] - start, start - times[-1])
    if outside > 0:
        raise WindError(
            f"the departure {format_time(start)} lies {outside / 3600:.1f} h outside of its times,"
            f" {format_time(times[0])} to {format_time(times[-1])}: choose another departure, or another file",
            reason="time",
        )
    first = max(time for time in times[:-1] if time <= start)  # two at least: one alone would be a steady wind
    after = [time for time in times if time >= start + span.lasting and time > first]
    last = after[0] if after else times[-1]
    kept = tuple(time for time in times if first <= time <= last)
    steps = [later - earlier for earlier, later in pairwise(kept)]
    usual = sorted(later - earlier for earlier, later in pairwise(times))[(len(times) - 1) // 2]
    gap = f", with a gap of {max(steps) / 3600:g} h" if max(steps) > _GAP * usual else ""
    return kept, f"{format_time(kept[0])} to {format_time(kept[-1])}{gap}"


def format_time(seconds: float) -> str:
    """A time [s since 1970] as people write it."""
    return f"{datetime.fromtimestamp(float(seconds), UTC):%Y-%m-%d %H:%M} UTC"


def _of_members(pairs: list[WindPair], members: Members) -> list[WindPair]:
    """The pairs of the wanted members. Raises `WindError` where the choice does not fit the file."""
    there = {pair.first.member for pair in pairs}
    named = sorted(member for member in there if member is not None)
    if not named:
        if members is not None:
            raise WindError("it is no ensemble: leave `members` out")
        return pairs
    if members is None:
        if None in there:  # a deterministic forecast beside the ensemble
            return [pair for pair in pairs if pair.first.member is None]
        raise WindError(
            f"it holds an ensemble of {len(named)} members ({named[0]} to {named[-1]}): say `members: all`, or which,"
            f" for example `members: [{named[0]}]`",
            reason="members",
            members=tuple(named),
        )
    chosen = set(named) if members == "all" else set(members)
    if missing := sorted(chosen - set(named)):
        raise WindError(f"it has no member {', '.join(map(str, missing))}, but {_listed([str(m) for m in named])}")
    return [pair for pair in pairs if pair.first.member in chosen]


def _newest(pairs: list[WindPair], notes: list[str]) -> list[WindPair]:
    """For each time the pairs of one run: the newest of those that have the most levels and members."""
    by_time: dict[float | None, dict[float | None, list[WindPair]]] = defaultdict(lambda: defaultdict(list))
    for pair in pairs:
        by_time[pair.first.time][pair.first.run].append(pair)
    kept = []
    for runs in by_time.values():
        most = max(len(group) for group in runs.values())
        newest = max((run for run, group in runs.items() if len(group) == most), key=lambda run: run or 0.0)
        kept += runs[newest]
    if any(len(runs) > 1 for runs in by_time.values()):
        notes.append("of several runs the newest for each time")
    return kept


def _levels_of_all(
    table: dict[tuple[float | None, int | None, Level], WindPair], known_height: float | None, notes: list[str]
) -> tuple[tuple[Level, ...], tuple[Level, ...]]:
    """The levels that every time and member has: those above the ground, ascending, and those above sea level."""
    sets: dict[tuple[float | None, int | None], set[Level]] = defaultdict(set)
    for time, member, level in table:
        sets[time, member].add(level)
    everywhere = set.intersection(*sets.values())
    if not everywhere:
        raise WindError("no level is there at every time and in every member")
    left = len(set.union(*sets.values()) - everywhere)
    if left:
        notes.append(f"{left} levels that not every time and member has left out")
    above_ground = sorted(level for level in everywhere if level.kind == "height")
    unknown = [level for level in everywhere if level.kind in ("unknown", "surface")]
    above_sea = max(
        ([level for level in everywhere if level.kind == kind] for kind in _ASL), key=len
    )  # of several kinds that with the most levels
    if not above_ground and not above_sea:
        if known_height is None:
            raise WindError(
                "it does not say at what height its wind is: say so with `reference_height`, for example"
                " `profile: {law: log, roughness: 0.1 m, reference_height: 10 m}`"
            )
        above_ground = unknown[:1]
    return tuple(above_ground), tuple(sorted(above_sea, reverse=bool(above_sea) and above_sea[0].kind != "altitude"))


def _listed(words: Sequence[str], most: int = 12) -> str:
    return ", ".join(words[:most]) + (f" and {len(words) - most} more" if len(words) > most else "")
