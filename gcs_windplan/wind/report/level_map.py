"""The wind of forecast files on one level at one moment, at few places: what fits into a small picture.

Three kinds of pictures: of the whole area, of the surroundings of a place, and, of forecasts for a single place, of its
levels and times.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from gcs_windplan.arrays import BoolArray, FloatArray, IntArray
from gcs_windplan.errors import WindError
from gcs_windplan.geo.frame import GeoPoint, LocalFrame
from gcs_windplan.wind.pairing import Winds
from gcs_windplan.wind.placement import LatLonPlacement, Part, part_of
from gcs_windplan.wind.report.excerpt import (
    Choice,
    Excerpt,
    from_the_ground_up,
    members_for,
    moment_in,
    pairs_of,
    part_at,
    winds_by_level,
)
from gcs_windplan.wind.report.extent import extent_of
from gcs_windplan.wind.sheets import Catalogue, Grid, Level

ROWS, COLUMNS = 7, 11  # of places
_MOST_ROWS = 9  # of nodes
_LEVELS = 20  # at most
_POLE = 89.999  # [deg]
_USUAL = 100.0  # [m above ground] where drones fly: our choice
_ORDER = ("height", "pressure", "model", "altitude", "surface", "unknown")


@dataclass(frozen=True, slots=True, eq=False)
class LevelMap:
    """Winds (rows, columns, 2) towards true east and north [m/s] on a level, NaN where missing.

    Rows go from north to south: `rows` and `columns` are latitudes and longitudes [deg], or where `about` is a place
    distances from it to the north and east [m]. `outside`: of the forecast's area. `between`: places between nodes,
    otherwise every `stride`-th row and column of the nodes.
    """

    level: Level
    moment: float | None
    times: tuple[float, ...]
    member: int | None
    members: int
    rows: FloatArray
    columns: FloatArray
    winds: FloatArray
    outside: BoolArray
    about: GeoPoint | None
    between: bool
    stride: tuple[int, int]


@dataclass(frozen=True, slots=True, eq=False)
class TimeMap:
    """Winds (levels, times, 2) towards true east and north [m/s] at a place, the highest level first."""

    place: GeoPoint
    member: int | None
    members: int
    levels: tuple[Level, ...]
    times: tuple[float, ...]
    winds: FloatArray


def single_place(catalogues: Sequence[Catalogue]) -> bool:
    """Whether the files know the wind at one place only, at several times or levels."""
    grids = {sheet.grid.key: sheet.grid for catalogue in catalogues for sheet in catalogue.sheets}
    return all(grid.regular and grid.shape == (1, 1) for grid in grids.values())


def map_of(catalogues: Sequence[Catalogue], asked: float | None, level: Level | None, choice: Choice) -> LevelMap:
    """The wind over the whole area. Raises `WindError` where there is none on the level, at the moment."""
    winds, chosen, moment = _chosen(catalogues, asked, level, choice)
    return (_of_nodes if winds.grid.regular else _of_lattice)(winds, chosen, moment)


def map_around(
    catalogues: Sequence[Catalogue], place: GeoPoint, radius: float, asked: float | None, level: Level | None,
    choice: Choice,
) -> LevelMap:  # fmt: skip
    """The wind up to `radius` [m] from a place to all four sides. Raises `WindError`, as `map_of` does."""
    winds, chosen, moment = _chosen(catalogues, asked, level, choice)
    part_at(winds.grid, place)  # which raises outside of it
    frame = LocalFrame(place)
    excerpt = Excerpt(winds, part_of(winds.grid, frame, (-radius, -radius, radius, radius), anywhere=True), moment)
    north, east = np.linspace(radius, -radius, ROWS), np.linspace(-radius, radius, COLUMNS)
    x, y = np.meshgrid(east, north)
    places = excerpt.part.placement.at(np.stack([x.ravel(), y.ravel()], axis=-1))
    outside = excerpt.part.placement.misses(places) > 1.0
    found = excerpt.sampled(excerpt.wind(winds.members[0], chosen), places[:, :2])
    found[outside] = np.nan
    return LevelMap(
        chosen, moment, excerpt.bracket, winds.members[0], len(winds.members), north, east,
        found.reshape(ROWS, COLUMNS, 2), outside.reshape(ROWS, COLUMNS), place, True, (1, 1),
    )  # fmt: skip


def times_of(catalogues: Sequence[Catalogue], choice: Choice) -> TimeMap:
    """The wind on the levels at up to eleven times, where there is a single place. Raises `WindError`."""
    members = members_for(catalogues, choice)
    found, _ = winds_by_level(catalogues, members, moment_in(catalogues, None))
    every = sorted({pair.first.time for pair in pairs_of(catalogues) if pair.first.time is not None})
    times = tuple(every[:: max(1, math.ceil(len(every) / COLUMNS))])
    levels = sorted(found, key=_height_of, reverse=True)
    levels = levels[(len(levels) - 1) % (stride := math.ceil(len(levels) / _LEVELS)) :: stride]
    one = next(iter(found.values()))
    place = GeoPoint(float(one.grid.latitudes[0]), float((one.grid.longitudes[0] + 180.0) % 360.0 - 180.0))
    columns = [_column(winds_by_level(catalogues, members, time)[0], levels, place, time) for time in times or (None,)]
    return TimeMap(place, one.members[0], len(one.members), tuple(levels), times, np.stack(columns, axis=1))


def _column(found: dict[Level, Winds], levels: Sequence[Level], place: GeoPoint, time: float | None) -> FloatArray:
    """The first member's winds (levels, 2) at a place, NaN on levels without any."""
    column = np.full((len(levels), 2), np.nan)
    for row, level in enumerate(levels):
        if level in found:
            excerpt = Excerpt(found[level], part_at(found[level].grid, place), time)
            column[row] = excerpt.wind(found[level].members[0], level)[0, 0]
    return column


def usual_level(levels: Sequence[Level]) -> Level:
    """The level nearest to 100 m above ground, else the lowest."""
    return min(levels, key=lambda level: (_ORDER.index(level.kind), _below(level)))


def _below(level: Level) -> float:
    if level.kind == "height":
        return abs(level.value - _USUAL)
    return level.value if level.kind == "altitude" else -level.value


def _height_of(level: Level) -> tuple[int, float]:
    """Something that grows upwards: levels above ground first."""
    return (0, level.value) if level.kind in ("height", "unknown", "surface") else (1, _below(level))


def _chosen(
    catalogues: Sequence[Catalogue], asked: float | None, level: Level | None, choice: Choice
) -> tuple[Winds, Level, float | None]:
    """The winds, the level and the moment of a picture. Raises `WindError`."""
    moment = moment_in(catalogues, asked)
    found, _ = winds_by_level(catalogues, members_for(catalogues, choice), moment)
    if level is None:
        level = usual_level(list(found))
    for there in found:
        if there.kind == level.kind and math.isclose(there.value, level.value, rel_tol=1e-6):
            return found[there], there, moment
    raise WindError(f"it has no wind at {level}, but at {', '.join(map(str, from_the_ground_up(found)))}")


def _of_nodes(winds: Winds, level: Level, moment: float | None) -> LevelMap:
    """Of a grid of parallels and meridians: nodes, as they stand in the file."""
    grid = winds.grid
    rows, row_stride = _strided(_from_north(grid), _MOST_ROWS)
    columns, column_stride = _strided(_from_west(grid), COLUMNS)
    latitudes, longitudes = grid.latitudes[rows], (grid.longitudes[columns] + 180.0) % 360.0 - 180.0
    middle = GeoPoint(float(np.clip(latitudes[len(rows) // 2], -90, 90)), float(longitudes[len(columns) // 2]))
    part = Part(rows, columns, LatLonPlacement(LocalFrame(middle), latitudes, longitudes))
    excerpt = Excerpt(winds, part, moment)
    return LevelMap(
        level, moment, excerpt.bracket, winds.members[0], len(winds.members), latitudes, longitudes,
        excerpt.wind(winds.members[0], level), np.zeros((len(rows), len(columns)), dtype=np.bool_), None, False,
        (row_stride, column_stride),
    )  # fmt: skip


def _of_lattice(winds: Winds, level: Level, moment: float | None) -> LevelMap:
    """Of any other grid: places of a lattice of latitudes and longitudes, each as planning sees it."""
    extent = extent_of(winds.grid)
    latitudes = _middles(extent.north, extent.south, ROWS)
    longitudes = (_middles(extent.west, extent.east, COLUMNS) + 180.0) % 360.0 - 180.0
    found = np.full((ROWS, COLUMNS, 2), np.nan)
    outside = np.ones((ROWS, COLUMNS), dtype=np.bool_)
    times: tuple[float, ...] = ()
    for row, column in np.ndindex(ROWS, COLUMNS):
        try:
            part = part_at(winds.grid, GeoPoint(float(latitudes[row]), float(longitudes[column])))
        except WindError:
            continue
        excerpt = Excerpt(winds, part, moment)
        found[row, column] = excerpt.sampled(excerpt.wind(winds.members[0], level), excerpt.origin)[0]
        outside[row, column], times = False, excerpt.bracket
    return LevelMap(
        level, moment, times, winds.members[0], len(winds.members), latitudes, longitudes, found, outside, None, True,
        (1, 1),
    )  # fmt: skip


def _strided(numbers: IntArray, most: int) -> tuple[IntArray, int]:
    """Every so many of some numbers, as many as fit, with as much left over on either side."""
    stride = math.ceil(len(numbers) / most)
    return np.ascontiguousarray(numbers[(len(numbers) - 1) % stride // 2 :: stride]), stride


def _from_north(grid: Grid) -> IntArray:
    """The numbers of the rows from north to south, without the poles, where all columns meet, if others are there."""
    order: IntArray = np.argsort(-grid.latitudes, kind="stable")
    inside = order[np.abs(grid.latitudes[order]) < _POLE]
    return inside if len(inside) else order


def _from_west(grid: Grid) -> IntArray:
    """The numbers of the columns from the western end of the area on."""
    west = extent_of(grid).west
    order: IntArray = np.argsort(np.round((grid.longitudes - west) % 360.0, 6) % 360.0, kind="stable")
    return order


def _middles(first: float, last: float, count: int) -> FloatArray:
    """The middles of equal parts."""
    return first + (np.arange(count) + 0.5) / count * (last - first)
