"""The wind of forecast files on one level at few places: what fits into a small picture.

Of the whole area at nodes of the grid, as planning reads them, or of the surroundings of a place, as planning has it
between the nodes.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from gcs_windplan.arrays import BoolArray, FloatArray, IntArray
from gcs_windplan.errors import WindError
from gcs_windplan.geo.frame import GeoPoint
from gcs_windplan.wind.field_index import FieldIndex, Grid, Level
from gcs_windplan.wind.inspect.grids import great_circle, summary_of, unit_vectors, wrapped
from gcs_windplan.wind.inspect.sounding import forecast_about, level_field
from gcs_windplan.wind.inspect.trial import members_or_all
from gcs_windplan.wind.pairing import Members, Selection, TimeSpan, select_winds, times_of, wind_pairs
from gcs_windplan.wind.placement import axes_directions

ROWS, COLUMNS = 7, 11  # of places
_MOST_ROWS = 9  # of nodes
_POLE = 89.999  # [deg]
_ANY_HEIGHT = 10.0  # [m above ground] of a level whose height the file does not tell: it is shown all the same
_USUAL = 100.0  # [m above ground] where drones fly: our choice
_ORDER = ("height", "pressure", "model", "altitude", "surface", "unknown")


@dataclass(frozen=True, slots=True, eq=False)
class WindMap:
    """Winds (rows, columns, 2) towards true east and north [m/s], NaN where missing, in the first of some members.

    Rows go from north to south: `rows` and `columns` are latitudes and longitudes [deg], where `about` is a place
    distances from it to the north and east [m]. `outside`: of the forecast's area. `times` have a share in it [s since
    1970]. `stride`: every second, third ... row and column of the grid; None where the places are not its nodes.
    """

    level: Level
    moment: float | None
    times: tuple[float, ...]
    members: tuple[int | None, ...]
    rows: FloatArray
    columns: FloatArray
    winds: FloatArray
    outside: BoolArray
    about: GeoPoint | None = None
    stride: tuple[int, int] | None = None


def map_of_area(indexes: Sequence[FieldIndex], moment: float | None, level: Level | None, members: Members) -> WindMap:
    """The wind over the whole area. Raises `WindError` where there is none on the level, at the moment."""
    times = times_of(wind_pairs(indexes))
    moment = (times[0] if moment is None else moment) if times else None
    selection = select_winds(indexes, members_or_all(indexes, members), TimeSpan(moment), _ANY_HEIGHT)
    level = _find(level, [*selection.above_ground, *selection.above_sea])
    grid = selection.grid
    if grid.regular:
        rows, row_stride = _every_few(_from_north(grid), _MOST_ROWS)
        columns, column_stride = _every_few(_from_west(grid), COLUMNS)
        winds, shares = _winds_at(selection, level, moment, rows, columns)
        return WindMap(
            level, moment, shares, selection.members, grid.latitudes[rows], wrapped(grid.longitudes[columns]), winds,
            np.zeros(winds.shape[:2], dtype=np.bool_), stride=(row_stride, column_stride),
        )  # fmt: skip
    latitudes, longitudes, nodes, outside = _nearest_nodes(grid)
    winds, shares = _winds_at(selection, level, moment, *(np.arange(size, dtype=np.int64) for size in grid.shape))
    found = np.where(outside[..., np.newaxis], np.nan, winds[nodes])
    return WindMap(level, moment, shares, selection.members, latitudes, longitudes, found, outside)


def map_around(
    indexes: Sequence[FieldIndex],
    place: GeoPoint,
    radius: float,
    moment: float | None,
    level: Level | None,
    members: Members,
) -> WindMap:
    """The wind up to `radius` [m] from a place to all four sides. Raises `WindError`, as `map_of_area` does."""
    box = (-radius, -radius, radius, radius)
    forecast, moment = forecast_about(indexes, place, box, moment, members, _ANY_HEIGHT)
    level = _find(level, forecast.levels)
    field = level_field(forecast.fields[0], forecast.levels.index(level))
    north, east = np.linspace(radius, -radius, ROWS), np.linspace(-radius, radius, COLUMNS)
    x, y = (values.ravel() for values in np.meshgrid(east, north))
    points = np.column_stack([x, y, np.full(len(x), 1e6)])
    field.true_wind(np.array([[0.0, 0.0, 1e6]]))  # which raises outside of the area
    outside = field.placement.misses(field.placement.at(points)) > 1.0
    winds = np.full((len(points), 2), np.nan)
    winds[~outside] = field.true_wind(points[~outside])[:, :2]
    times = () if moment is None else tuple(field.columns.times.tolist())
    return WindMap(
        level, moment, (moment,) if moment in times else times, forecast.members, north, east,
        winds.reshape(ROWS, COLUMNS, 2), outside.reshape(ROWS, COLUMNS), place,
    )  # fmt: skip


def usual_level(levels: Sequence[Level]) -> Level:
    """The level nearest to 100 m above ground, else the lowest."""
    sign = {"height": 0.0, "altitude": 1.0}
    return min(
        levels,
        key=lambda one: (
            _ORDER.index(one.kind),
            abs(one.value - _USUAL) if one.kind == "height" else one.value * sign.get(one.kind, -1.0),
        ),
    )


def _find(asked: Level | None, levels: Sequence[Level]) -> Level:
    """The level that is meant. Raises `WindError` where there is no such."""
    if asked is None:
        return usual_level(levels)
    for level in levels:
        if level.kind == asked.kind and math.isclose(level.value, asked.value, rel_tol=1e-6):
            return level
    raise WindError(f"it has no wind at {asked}, but at {', '.join(map(str, levels))}")


def _winds_at(
    selection: Selection, level: Level, moment: float | None, rows: IntArray, columns: IntArray
) -> tuple[FloatArray, tuple[float, ...]]:
    """Winds (rows, columns, 2) of the first member on a level at a moment, and the times that have a share in them."""
    grid, times = selection.grid, selection.times
    shares = [(times[0], 1.0)]
    if moment is not None and len(times) == 2 and times[0] is not None and times[1] is not None:
        late = (moment - times[0]) / (times[1] - times[0])
        shares = [(time, share) for time, share in zip(times, (1.0 - late, late), strict=True) if share]
    pairs = [(selection.pairs[time, selection.members[0], level], share) for time, share in shares]
    angle = axes_directions(grid, rows, columns) if pairs[0][0].along_grid else 0.0
    winds: FloatArray = np.sum([share * pair.read(rows, columns, angle) for pair, share in pairs], axis=0)
    return winds, tuple(time for time, _ in shares if time is not None)


def _every_few(numbers: IntArray, most: int) -> tuple[IntArray, int]:
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
    west = summary_of(grid).west
    order: IntArray = np.argsort(np.round((grid.longitudes - west) % 360.0, 6) % 360.0, kind="stable")
    return order


def _nearest_nodes(grid: Grid) -> tuple[FloatArray, FloatArray, tuple[IntArray, IntArray], BoolArray]:
    """Latitudes and longitudes of a lattice over a projected grid, rows and columns of the nodes nearest to its places.

    Also which places lie outside: farther from any node than the nodes from each other.
    """
    from scipy.spatial import cKDTree

    area = summary_of(grid)
    latitudes = area.north + (np.arange(ROWS) + 0.5) / ROWS * (area.south - area.north)
    longitudes = wrapped(area.west + (np.arange(COLUMNS) + 0.5) / COLUMNS * (area.east - area.west))
    places = unit_vectors(*np.broadcast_arrays(latitudes[:, np.newaxis], longitudes))
    tree = cKDTree(unit_vectors(grid.latitudes, grid.longitudes).reshape(-1, 3))
    chords, nearest = tree.query(places)
    cell = max((step for step in area.spacing_metres if step is not None), default=0.0)
    rows, columns = np.unravel_index(nearest, grid.shape)
    return latitudes, longitudes, (rows, columns), great_circle(np.asarray(chords)) > cell
