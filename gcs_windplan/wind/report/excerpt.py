"""An excerpt of forecast files: the winds of some members on some levels about a place at one moment, node by node.

What is chosen, how it is read, turned to true north and given heights is what planning does (`pairing`, `placement`,
`forecast`); levels that planning cannot use are chosen in the same way, each by itself.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Sequence
from contextlib import suppress
from dataclasses import dataclass, replace
from datetime import UTC, datetime
from functools import cached_property
from typing import Literal, TypeAlias

import numpy as np

from gcs_windplan.arrays import FloatArray, IntArray
from gcs_windplan.errors import WindError
from gcs_windplan.geo.frame import GeoPoint, LocalFrame
from gcs_windplan.wind.forecast import Assembly, Wanted
from gcs_windplan.wind.pairing import STEADY_FOR, Members, Pair, Span, Winds, choose, nothing_found, pair_up, say_time
from gcs_windplan.wind.placement import Box, Part, part_of
from gcs_windplan.wind.report.extent import ways_between
from gcs_windplan.wind.sheets import Catalogue, Grid, Level

#: A member, all of them, or None: what planning takes if nothing is said, and all where it wants to be told.
Choice: TypeAlias = int | Literal["all"] | None

POINT: Box = (0.0, 0.0, 0.0, 0.0)
_ANY_HEIGHT = 10.0  # [m above ground] lets `choose` take a level whose height the file does not tell
_WINDOW = 8  # rows and columns of a projected grid on either side of a place: enough for the fit of its placement
_ON_EDGE = 1.0  # [m] as planning has it


def pairs_of(catalogues: Sequence[Catalogue]) -> list[Pair]:
    """All winds of some files on the grid that planning would take: the one with the most of them.

    Raises `WindError` where there are none.
    """
    pairs = pair_up(sheet for catalogue in catalogues for sheet in catalogue.sheets)
    if not pairs:
        raise WindError(nothing_found(catalogues))
    (most, _), *_ = Counter(pair.first.grid.key for pair in pairs).most_common(1)
    return [pair for pair in pairs if pair.first.grid.key == most]


def members_for(catalogues: Sequence[Catalogue], choice: Choice) -> Members:
    """What `choose` is to be asked for. Raises `WindError` for a member where there is no ensemble."""
    there = {pair.first.member for pair in pairs_of(catalogues)}
    if choice is not None and there == {None}:
        raise WindError("it is no ensemble, so that there are no members to choose from")
    if choice is None:
        return None if None in there else "all"
    return "all" if choice == "all" else (choice,)


def moment_in(catalogues: Sequence[Catalogue], asked: float | None) -> float | None:
    """The moment to look at [s since 1970]: the one asked for, else the first; None where the files tell no time.

    Raises `WindError` if there is no wind at all, and none at the moment asked for, which says by how much.
    """
    times = sorted({pair.first.time for pair in pairs_of(catalogues) if pair.first.time is not None})
    if asked is None or not times:
        return times[0] if times else None
    outside = max(times[0] - asked, asked - times[-1])
    if outside <= (STEADY_FOR if len(times) == 1 else 0.0):
        return asked
    span = f"{say_time(times[0])} to {say_time(times[-1])}" if len(times) > 1 else f"{say_time(times[0])} alone"
    side = "before its first" if asked < times[0] else "after its last"
    raise WindError(f"{say_time(asked)} is {outside / 3600:.1f} h {side} time: it has wind for {span}")


def from_the_ground_up(levels: Iterable[Level]) -> tuple[Level, ...]:
    """Levels of each kind in the order in which a balloon meets them."""
    downwards = ("pressure", "model")
    return tuple(sorted(levels, key=lambda level: (level.kind, level.value * (-1 if level.kind in downwards else 1))))


def winds_by_level(
    catalogues: Sequence[Catalogue], members: Members, moment: float | None
) -> tuple[dict[Level, Winds], Winds | None]:
    """What there is on each level at a moment, and what planning would choose of it, None where it can choose nothing.

    Raises `WindError` where there is nothing on any level.
    """
    span = Span(moment)
    sheets = [sheet for catalogue in catalogues for sheet in catalogue.sheets]
    planned, refused = None, WindError(nothing_found(catalogues))
    try:
        planned = choose(catalogues, members, span, None)
    except WindError as error:
        refused = error
    found = {} if planned is None else dict.fromkeys((*planned.above, *planned.beyond), planned)
    for level in sorted({pair.level for pair in pair_up(sheets)} - set(found)):
        with suppress(WindError):
            winds = choose([_of_level(one, level) for one in catalogues], members, span, _ANY_HEIGHT)
            if planned is None or winds.times == planned.times:
                found[level] = winds
    if not found:
        raise refused
    return found, planned


def _of_level(catalogue: Catalogue, level: Level) -> Catalogue:
    """A catalogue without the winds of other levels."""
    wind = ("u", "v", "speed", "direction")
    return replace(catalogue, sheets=tuple(s for s in catalogue.sheets if s.level == level or s.quantity not in wind))


@dataclass(frozen=True, eq=False)
class Excerpt:
    """Chosen winds on a part of their grid, at a moment [s since 1970]."""

    winds: Winds
    part: Part
    moment: float | None

    def wind(self, member: int | None, level: Level) -> FloatArray:
        """u and v (rows, columns, 2) towards true east and north [m/s], NaN where missing."""
        return self._at_moment(
            [
                None if weight == 0 else self.assembly.wind(self.winds.pairs[time, member, level])
                for time, weight in self._weighted_times
            ]
        )

    def heights(self, member: int | None) -> dict[Level, FloatArray]:
        """Heights of levels above mean sea level [m] (rows, columns), those that are known."""
        try:
            told = self.assembly.heights(member, self.terrain)
        except WindError:
            return {}
        shape = self.terrain.shape
        return {
            level: self._at_moment(list(np.broadcast_to(heights, (len(self.winds.times), *shape))))
            for level, heights in told.items()
        }

    def gust(self, member: int | None) -> FloatArray | None:
        """The gusts (rows, columns) [m/s], None where the files have none."""
        read: list[FloatArray | None] = []
        for time, weight in self._weighted_times:
            sheets = [s for s in self.winds.others if (s.quantity, s.time, s.member) == ("gust", time, member)]
            if weight and not sheets:
                return None
            runs = {pair.first.run for (at, of, _), pair in self.winds.pairs.items() if (at, of) == (time, member)}
            newest = max(sheets, key=lambda sheet: (sheet.run in runs, sheet.run or 0.0)) if weight else None
            read.append(None if newest is None else self.assembly.read(newest))
        return self._at_moment(read)

    @cached_property
    def terrain(self) -> FloatArray:
        """The forecast's own ground above mean sea level [m] (rows, columns), NaN where unknown."""
        return self.assembly.surface("terrain", np.nan)

    @cached_property
    def assembly(self) -> Assembly:
        """The same winds on planning's way to a forecast."""
        departure = None if self.moment is None else datetime.fromtimestamp(self.moment, UTC)
        wanted = Wanted(self.part.placement.frame, departure=departure, lasting=0.0, area=POINT)
        return Assembly(self.winds, wanted, self.part)

    @cached_property
    def origin(self) -> FloatArray:
        """Row and column of the frame's origin, shape (1, 2)."""
        return self.part.placement.at(np.zeros((1, 3)))[:, :2]

    def sampled(self, values: FloatArray, places: FloatArray) -> FloatArray:
        """Values (rows, columns, ...) at places (n, 2: row and column), linear between nodes: (n, ...).

        A missing value counts only where it has a share.
        """
        result = []
        for place in places:
            row, column = (hats(axis, float(at)) for axis, at in zip(self._axes, place, strict=True))
            rows, columns = np.flatnonzero(row), np.flatnonzero(column)
            result.append(np.einsum("r,c,rc...->...", row[rows], column[columns], values[np.ix_(rows, columns)]))
        return np.array(result)

    @property
    def bracket(self) -> tuple[float, ...]:
        """The times that have a share in it [s since 1970]."""
        return tuple(time for time, weight in self._weighted_times if weight and time is not None)

    @property
    def _axes(self) -> tuple[FloatArray, FloatArray]:
        return self.part.placement.rows, self.part.placement.columns

    @cached_property
    def _weighted_times(self) -> list[tuple[float | None, float]]:
        times = self.winds.times
        if self.moment is None or len(times) == 1:
            return [(times[0], 1.0)]
        axis = np.array([time for time in times if time is not None])
        return list(zip(times, hats(axis, self.moment).tolist(), strict=True))

    def _at_moment(self, values: Sequence[FloatArray | None]) -> FloatArray:
        parts = [
            weight * one
            for (_, weight), one in zip(self._weighted_times, values, strict=True)
            if weight and one is not None
        ]
        total: FloatArray = np.sum(parts, axis=0)
        return total


def hats(axis: FloatArray, value: float) -> FloatArray:
    """The shares (n,) of an ascending axis' nodes (n,) in a value between them, by linear interpolation.

    Outside of the axis the node at its end has all.
    """
    if len(axis) == 1:
        return np.ones(1)
    return np.array([np.interp(value, axis, node) for node in np.eye(len(axis))])


def part_at(grid: Grid, place: GeoPoint) -> Part:
    """The part of a grid about a place, whose frame begins there.

    Raises `WindError`, which says by how much, where the place lies outside of the grid.
    """
    frame = LocalFrame(place)
    if grid.regular:
        part = part_of(grid, frame, POINT, anywhere=True)
        outside = float(part.placement.misses(part.placement.at(np.zeros((1, 3))))[0])
        if outside <= _ON_EDGE:
            return part
        raise _outside(outside, place, part_of(grid, frame, None).placement.covers())
    row, column, way = nearest_node(grid, place)
    rows, columns = (_around(at, size) for at, size in zip((row, column), grid.shape, strict=True))
    window = np.ix_(rows, columns)
    small = Grid(grid.latitudes[window], grid.longitudes[window], grid.name)
    node = float(grid.latitudes[row, column]), float(grid.longitudes[row, column])
    if way < ways_between(small.latitudes, small.longitudes, *node).max():
        part = part_of(small, frame, POINT, anywhere=True)
        if float(part.placement.misses(part.placement.at(np.zeros((1, 3))))[0]) <= _ON_EDGE:
            return Part(rows[part.rows], columns[part.columns], part.placement)
    raise _outside(way, place, f"the nearest node of its grid ({grid.name}) is {node[0]:.3f}, {node[1]:.3f}")


def nearest_node(grid: Grid, place: GeoPoint) -> tuple[int, int, float]:
    """Row and column of the node of a projected grid that is nearest to a place, and how far away it is [m].

    Every few nodes are looked at first, then those around the nearest of them.
    """
    stride = max(1, int(np.sqrt(grid.latitudes.size / 40_000)))
    rows, columns = (np.arange(0, size, stride, dtype=np.int64) for size in grid.shape)
    row, column, way = _nearest_of(grid, place, rows, columns)
    if stride == 1:
        return row, column, way
    rows, columns = (
        np.arange(max(0, at - stride), min(size, at + stride + 1), dtype=np.int64)
        for at, size in zip((row, column), grid.shape, strict=True)
    )
    return _nearest_of(grid, place, rows, columns)


def _nearest_of(grid: Grid, place: GeoPoint, rows: IntArray, columns: IntArray) -> tuple[int, int, float]:
    some = np.ix_(rows, columns)
    ways = ways_between(grid.latitudes[some], grid.longitudes[some], place.latitude_deg, place.longitude_deg)
    row, column = divmod(int(np.argmin(ways)), len(columns))
    return int(rows[row]), int(columns[column]), float(ways[row, column])


def _around(at: int, size: int) -> IntArray:
    return np.arange(max(0, at - _WINDOW), min(size, at + _WINDOW + 1), dtype=np.int64)


def _outside(way: float, place: GeoPoint, covers: str) -> WindError:
    where = f"{place.latitude_deg:.5f}, {place.longitude_deg:.5f}"
    far = f"{way / 1000:.1f} km" if way < 100_000 else f"{way / 1000:.0f} km"
    return WindError(f"{where} lies {far} outside of its area: {covers}")
