"""From the sheets of forecast files to winds that belong together: which run, which members, which times, which levels.

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

from gcs_windplan.errors import EnsembleError, WindError
from gcs_windplan.wind.sheets import Catalogue, Grid, Level, LevelKind, Quantity, Sheet

#: All members, these ones, or None: there is to be no choice.
Members: TypeAlias = Literal["all"] | tuple[int, ...] | None

STEADY_FOR = 3 * 3600.0  # [s] how far from its one time a file is used where a departure is told: our choice
_GAP = 2.5  # times the usual step between two times, their median: a longer one is said
_PARTNERS: tuple[tuple[Quantity, Quantity], ...] = (("u", "v"), ("speed", "direction"))
_ASL: tuple[LevelKind, ...] = ("pressure", "model", "altitude")


@dataclass(frozen=True, slots=True, eq=False)
class Pair:
    """Two sheets that make a wind: u and v, or speed and direction (`polar`)."""

    first: Sheet
    second: Sheet

    @property
    def polar(self) -> bool:
        """Whether they are speed and direction."""
        return self.first.quantity == "speed"

    @property
    def level(self) -> Level:
        """Their level."""
        return self.first.level


@dataclass(frozen=True, slots=True)
class Span:
    """The moments for which wind is wanted [s since 1970, UTC]; without a departure any single one will do."""

    departure: float | None = None
    lasting: float = 0.0


@dataclass(frozen=True, slots=True, eq=False)
class Winds:
    """The pairs that a flight needs: `pairs[time, member, level]`, and everything else on the same grid (`others`).

    `times` ascend [s since 1970]; one alone may be None where the file does not tell. `levels` are those above the
    ground first, then those above sea level from the ground up as far as can be told. `notes` are for people.
    """

    grid: Grid
    times: tuple[float | None, ...]
    members: tuple[int | None, ...]
    above: tuple[Level, ...]
    beyond: tuple[Level, ...]
    pairs: dict[tuple[float | None, int | None, Level], Pair]
    others: tuple[Sheet, ...]
    runs: tuple[float, ...]
    notes: tuple[str, ...]


def choose(catalogues: Sequence[Catalogue], members: Members, span: Span, known_height: float | None) -> Winds:
    """The winds of some files for a span. `known_height` [m above ground] is that of a level the file does not name.

    Raises `WindError` for files without a wind, an ensemble without a choice of members, times that do not reach.
    """
    pairs = pair_up(sheet for catalogue in catalogues for sheet in catalogue.sheets)
    if not pairs:
        raise WindError(nothing_found(catalogues))
    notes: list[str] = []
    pairs = _of_one_grid(pairs, notes)
    pairs = _of_members(pairs, members)
    kept, window_note = choose_times(sorted({p.first.time for p in pairs if p.first.time is not None}), span)
    if kept:
        pairs = [pair for pair in pairs if pair.first.time in kept]
    if window_note:
        notes.append(window_note)
    pairs = _newest(pairs, notes)
    table = {(pair.first.time, pair.first.member, pair.level): pair for pair in pairs}
    above, beyond = _levels_of_all(table, known_height, notes)
    grid = pairs[0].first.grid
    others = tuple(s for c in catalogues for s in c.sheets if s.grid.key == grid.key)
    return Winds(
        grid=grid,
        times=tuple(sorted({time for time, _, _ in table}, key=lambda time: time or 0.0)),
        members=tuple(sorted({member for _, member, _ in table}, key=lambda member: -1 if member is None else member)),
        above=above,
        beyond=beyond,
        pairs=table,
        others=others,
        runs=tuple(sorted({pair.first.run for pair in pairs if pair.first.run is not None})),
        notes=tuple(notes),
    )


def pair_up(sheets: Iterable[Sheet]) -> list[Pair]:
    """All winds among some sheets; where a level has u and v as well as speed and direction, u and v."""
    found: dict[tuple[object, ...], dict[str, Sheet]] = defaultdict(dict)
    for sheet in sheets:
        if sheet.quantity in ("u", "v", "speed", "direction"):
            key = (sheet.level, sheet.time, sheet.run, sheet.member, sheet.grid.key)
            found[key].setdefault(sheet.quantity, sheet)
    pairs = []
    for group in found.values():
        for first, second in _PARTNERS:
            if first in group and second in group:
                pairs.append(Pair(group[first], group[second]))
                break
    return pairs


def nothing_found(catalogues: Sequence[Catalogue]) -> str:
    """Why there is no wind in some files."""
    sheets = [sheet for catalogue in catalogues for sheet in catalogue.sheets]
    have = Counter(sheet.quantity for sheet in sheets)
    named = {sheet.quantity: sheet.name or sheet.quantity for sheet in sheets}
    unused = "; ".join(text for catalogue in catalogues for text in catalogue.unused)
    for first, second in (*_PARTNERS, ("v", "u"), ("direction", "speed")):
        if have[first] and not have[second]:
            return f"it has {first} ({named[first]}) but no {second}: download it along" + (
                f"; {unused}" if unused else ""
            )
    if (have["u"] and have["v"]) or (have["speed"] and have["direction"]):
        us, vs = (
            sorted({str(s.level) for s in sheets if s.quantity in q}) for q in (("u", "speed"), ("v", "direction"))
        )
        return f"u and v share no level, time and member: u has {_few(us)}, v has {_few(vs)}"
    names = _few(sorted({sheet.name for sheet in sheets if sheet.name}))
    return (
        "it holds no wind that can be used" + (f"; it has {names}" if names else "") + (f"; {unused}" if unused else "")
    )


def choose_times(times: Sequence[float], span: Span) -> tuple[tuple[float, ...], str]:
    """The times that a span needs, and a note. Raises `WindError` if they do not reach it."""
    if not times:
        return (), "no time given"
    start = span.departure
    if len(times) == 1:
        if start is not None and abs(times[0] - start) > STEADY_FOR:
            raise WindError(
                f"its only time, {say_time(times[0])}, is {abs(times[0] - start) / 3600:.1f} h from the departure"
                f" {say_time(start)}; at most {STEADY_FOR / 3600:g} h are accepted, or no departure at all"
            )
        return (times[0],), f"steady as at {say_time(times[0])}"
    if start is None:
        raise WindError(f"it holds {len(times)} times, {say_time(times[0])} to {say_time(times[-1])}: give `departure`")
    outside = max(times[0] - start, start - times[-1])
    if outside > 0:
        raise WindError(
            f"the departure {say_time(start)} lies {outside / 3600:.1f} h outside of its times, {say_time(times[0])} to"
            f" {say_time(times[-1])}: choose another departure, or a file that reaches it"
        )
    first = max(time for time in times[:-1] if time <= start)  # two at least: one alone would be a steady wind
    after = [time for time in times if time >= start + span.lasting and time > first]
    last = after[0] if after else times[-1]
    kept = tuple(time for time in times if first <= time <= last)
    steps = [later - earlier for earlier, later in pairwise(kept)]
    usual = sorted(later - earlier for earlier, later in pairwise(times))[(len(times) - 1) // 2]
    gap = f", with a gap of {max(steps) / 3600:g} h" if max(steps) > _GAP * usual else ""
    return kept, f"{say_time(kept[0])} to {say_time(kept[-1])}{gap}"


def say_time(seconds: float) -> str:
    """A time [s since 1970] as people write it."""
    return f"{datetime.fromtimestamp(float(seconds), UTC):%Y-%m-%d %H:%M} UTC"


def _of_one_grid(pairs: list[Pair], notes: list[str]) -> list[Pair]:
    counts = Counter(pair.first.grid.key for pair in pairs)
    key, _ = counts.most_common(1)[0]
    if len(counts) > 1:
        notes.append(f"{len(pairs) - counts[key]} winds on other grids left out")
    return [pair for pair in pairs if pair.first.grid.key == key]


def _of_members(pairs: list[Pair], members: Members) -> list[Pair]:
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
        raise EnsembleError.of(named)
    wanted = set(named) if members == "all" else set(members)
    if missing := sorted(wanted - set(named)):
        raise WindError(f"it has no member {', '.join(map(str, missing))}, but {_few([str(m) for m in named])}")
    return [pair for pair in pairs if pair.first.member in wanted]


def _newest(pairs: list[Pair], notes: list[str]) -> list[Pair]:
    """For each time the pairs of one run: the newest of those that have the most levels and members."""
    by_time: dict[float | None, dict[float | None, list[Pair]]] = defaultdict(lambda: defaultdict(list))
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
    table: dict[tuple[float | None, int | None, Level], Pair], known_height: float | None, notes: list[str]
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
    above = sorted(level for level in everywhere if level.kind == "height")
    unknown = [level for level in everywhere if level.kind in ("unknown", "surface")]
    beyond = max(
        ([level for level in everywhere if level.kind == kind] for kind in _ASL), key=len
    )  # of several kinds that with the most levels
    if not above and not beyond:
        if known_height is None:
            raise WindError(
                "it does not say at what height its wind is: say so with `reference_height`, for example"
                " `profile: {law: log, roughness: 0.1 m, reference_height: 10 m}`"
            )
        above = unknown[:1]
    return tuple(above), tuple(sorted(beyond, reverse=bool(beyond) and beyond[0].kind != "altitude"))


def _few(words: Sequence[str], most: int = 12) -> str:
    return ", ".join(words[:most]) + (f" and {len(words) - most} more" if len(words) > most else "")
