"""Where local places lie on a forecast's grid, and which part of the grid an area needs.

On a grid of parallels and meridians a place's row and column are its latitude and longitude. On any other (Lambert,
polar stereographic, rotated) they are the numbers of the rows and columns, by a polynomial fitted to the places of the
nodes themselves: no projection's parameters are needed, and no earth's shape can be mistaken.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import Protocol, TypeAlias

import numpy as np

from gcs_windplan.arrays import BoolArray, FloatArray, IntArray
from gcs_windplan.errors import WindError
from gcs_windplan.geo.fit import PolynomialFit
from gcs_windplan.geo.frame import LocalFrame
from gcs_windplan.geo.inverse import InverseProjection
from gcs_windplan.wind.field_index import Grid

#: west, south, east, north in the local frame [m]
Box: TypeAlias = tuple[float, float, float, float]

METRES_PER_DEGREE = 111_195.0  # [m] of a meridian on the mean earth radius, 6371 km (IUGG 1980)
EXTENDED = 50_000.0  # [m] how far beyond the grid's edge the edge's wind is taken where asked for, or one spacing
POINT_REACH = 15_000.0  # [m] how far from its place a forecast for one place is used: our choice, a model's cell or two
_LATTICE = 17  # points a side of the area whose latitudes and longitudes have to be read
_WHOLE = 300_000.0  # [m] about the origin that is kept of a projected grid where no area is told
_FARTHEST = 500_000.0  # [m] from the area that a projected grid is laid out in its local frame
_FEWEST = 6  # rows and columns kept of a projected grid, so that the polynomial has enough to hold on to
_LARGEST_ERROR = 1e-3  # of a cell
_DEGREES = {5: 60, 3: 20, 1: 0}  # of the polynomial, and the fewest nodes that it takes


class Placement(Protocol):
    """How a grid's rows and columns lie about the local frame."""

    @property
    def frame(self) -> LocalFrame:
        """The local frame."""

    @property
    def rows(self) -> FloatArray:
        """The rows' coordinate, ascending."""

    @property
    def columns(self) -> FloatArray:
        """The columns' coordinate, ascending."""

    @property
    def spacing(self) -> float:
        """The smallest distance between neighbouring nodes [m], infinite where there is one alone."""

    def at(self, points: FloatArray) -> FloatArray:
        """Row, column and convergence [rad] of local points (n, 2 or more), shape (n, 3)."""

    def misses(self, places: FloatArray) -> FloatArray:
        """How far places (n, 2 or more: row, column) lie outside of the grid [m], shape (n,)."""

    def covers(self) -> str:
        """The area, for people."""


@dataclass(frozen=True, slots=True)
class LatLonPlacement:
    """Rows are latitudes, columns longitudes [deg], both ascending, the latter running on from the origin's."""

    frame: LocalFrame
    rows: FloatArray
    columns: FloatArray
    _inverse: InverseProjection = field(init=False, repr=False, compare=False)

    def __post_init__(self) -> None:
        object.__setattr__(self, "_inverse", InverseProjection(self.frame))

    @property
    def spacing(self) -> float:
        """The smallest distance between neighbouring nodes [m], infinite where there is one alone."""
        widest = math.cos(math.radians(min(float(np.abs(self.rows).max()), 89.0)))
        south_north = np.min(np.diff(self.rows), initial=math.inf)
        west_east = np.min(np.diff(self.columns), initial=math.inf) * widest
        return float(min(south_north, west_east)) * METRES_PER_DEGREE

    def at(self, points: FloatArray) -> FloatArray:
        """Latitude, longitude [deg] and convergence [rad] of local points (n, 2 or more), shape (n, 3)."""
        return self._inverse.at(points)

    def misses(self, places: FloatArray) -> FloatArray:
        """How far places lie outside of the grid [m], shape (n,)."""
        south_north = _outside_by(places[:, 0], self.rows, POINT_REACH / METRES_PER_DEGREE)
        narrow = np.cos(np.radians(places[:, 0]))
        west_east = (
            _outside_by(places[:, 1], self.columns, POINT_REACH / METRES_PER_DEGREE / narrow.clip(0.01)) * narrow
        )
        distance: FloatArray = np.hypot(south_north, west_east) * METRES_PER_DEGREE
        return distance

    def covers(self) -> str:
        """The area, for people."""
        if len(self.rows) == len(self.columns) == 1:
            return f"it knows {self.rows[0]:.4f}, {self.columns[0]:.4f} and {POINT_REACH / 1000:g} km around"
        return (
            f"it covers latitudes {self.rows[0]:.3f} to {self.rows[-1]:.3f} and longitudes {self.columns[0]:.3f} to"
            f" {self.columns[-1]:.3f}"
        )


@dataclass(frozen=True, slots=True)
class MappedPlacement:
    """Rows and columns are numbers from 0; `nodes` (rows, columns, 2) are the nodes' local places [m].

    Raises `WindError` where the grid is so bent that a polynomial is off by a thousandth of a cell.
    """

    frame: LocalFrame
    nodes: FloatArray
    name: str
    _inverse: InverseProjection = field(init=False, repr=False, compare=False)
    _fit: PolynomialFit = field(init=False, repr=False, compare=False)

    def __post_init__(self) -> None:
        places = self.nodes.reshape(-1, 2)
        middle = (places.min(axis=0) + places.max(axis=0)) / 2
        reach = float(np.abs(places - middle).max()) or 1.0
        numbers = np.indices(self.nodes.shape[:2]).reshape(2, -1).T.astype(np.float64)
        degree = next(degree for degree, fewest in _DEGREES.items() if len(places) >= fewest)
        fit = PolynomialFit.least_squares(middle, np.full(2, reach), degree, places, numbers)
        error = float(np.abs(fit.residual(places, numbers)).max())
        if not error < _LARGEST_ERROR:
            raise WindError(f"its grid ({self.name}) is too uneven: a fit is off by {error:.2g} cells; regrid it")
        object.__setattr__(self, "_inverse", InverseProjection(self.frame))
        object.__setattr__(self, "_fit", fit)

    @property
    def rows(self) -> FloatArray:
        """The numbers of the rows."""
        return np.arange(self.nodes.shape[0], dtype=np.float64)

    @property
    def columns(self) -> FloatArray:
        """The numbers of the columns."""
        return np.arange(self.nodes.shape[1], dtype=np.float64)

    @property
    def spacing(self) -> float:
        """The smallest distance between neighbouring nodes [m], infinite where there is one alone."""
        steps = [np.linalg.norm(np.diff(self.nodes, axis=axis), axis=2) for axis in (0, 1)]
        return float(min(np.min(step, initial=math.inf) for step in steps))

    def at(self, points: FloatArray) -> FloatArray:
        """Row and column (numbers) and convergence [rad] of local points (n, 2 or more), shape (n, 3)."""
        result = self._inverse.at(points)
        result[:, :2] = self._fit.at(points)
        return result

    def misses(self, places: FloatArray) -> FloatArray:
        """How far places lie outside of the grid [m], shape (n,)."""
        cells: FloatArray = np.hypot(_outside_by(places[:, 0], self.rows), _outside_by(places[:, 1], self.columns))
        return cells * self.spacing

    def covers(self) -> str:
        """The area, for people."""
        latitudes, longitudes = self.frame.to_geographic(self.nodes.reshape(-1, 2))
        return (
            f"it covers, within latitudes {latitudes.min():.3f} to {latitudes.max():.3f} and longitudes"
            f" {longitudes.min():.3f} to {longitudes.max():.3f}, a part of its own grid ({self.name})"
        )


@dataclass(frozen=True, slots=True, eq=False)
class Subset:
    """The part of a grid that is wanted: rows and columns by number, ascending in the placement."""

    rows: IntArray
    columns: IntArray
    placement: Placement


def subset_of(grid: Grid, frame: LocalFrame, area: Box | None, extend: bool = False) -> Subset:
    """The rows and columns that the area needs and a cell more, everything near where no area is told.

    Raises `WindError` if the grid lies wholly outside of the area, with `extend` if it does so by more than 50 km and a
    spacing.
    """
    subset = _regular_subset(grid, frame, area) if grid.regular else _mapped_subset(grid, frame, area)
    if area is not None:
        gap = float(subset.placement.misses(subset.placement.at(_points_of(area))).min())
        if gap > (may_extend(subset.placement) if extend else 1.0):
            whole = subset_of(grid, frame, None).placement.covers()
            raise WindError(
                f"the wind ends {gap / 1000:.0f} km short of the area: {whole}; {advice(subset.placement, gap)}",
                reason="area",
            )
    return subset


def may_extend(placement: Placement) -> float:
    """How far beyond its edge a grid's wind may be taken [m]."""
    return max(EXTENDED, placement.spacing if math.isfinite(placement.spacing) else 0.0)


def advice(placement: Placement, gap: float) -> str:
    """What to do about a gap [m] between a grid and a place."""
    if gap > may_extend(placement):
        return "take another file"
    return "take another file, or say `extend: nearest` to take the wind at its edge"


def _regular_subset(grid: Grid, frame: LocalFrame, area: Box | None) -> Subset:
    rows = np.argsort(grid.latitudes)
    columns = _west_to_east(grid.longitudes, frame)
    latitudes, longitudes = grid.latitudes[rows], continuous(grid.longitudes[columns], frame)
    if area is not None:
        latitude, longitude = frame.to_geographic(_points_of(area))
        longitude = continuous(longitude, frame)
        rows = rows[_enclosing(latitudes, float(latitude.min()), float(latitude.max()))]
        columns = columns[_enclosing(longitudes, float(longitude.min()), float(longitude.max()))]
    latitudes, longitudes = grid.latitudes[rows], continuous(grid.longitudes[columns], frame)
    for what, axis in (("latitudes", latitudes), ("longitudes", longitudes)):
        if not (np.diff(axis) > 0).all():
            raise WindError(f"its {what} do not go one way, each value once ({grid.name})")
    return Subset(
        rows.astype(np.int64),
        columns.astype(np.int64),
        LatLonPlacement(frame, np.ascontiguousarray(latitudes), np.ascontiguousarray(longitudes)),
    )


def _mapped_subset(grid: Grid, frame: LocalFrame, area: Box | None) -> Subset:
    nodes = frame.to_local(grid.latitudes.ravel(), grid.longitudes.ravel()).reshape(*grid.shape, 2)
    nodes[_on_far_side(grid, frame)] = np.inf
    box = (-_WHOLE, -_WHOLE, _WHOLE, _WHOLE) if area is None else area
    beyond = np.maximum(np.abs(nodes - _middle_of(box)) - _half_of(box), 0.0).max(axis=2)
    gap = float(beyond.min())
    if not gap < _FARTHEST:
        away = f"{gap / 1000:.0f} km short of the area" if math.isfinite(gap) else "on the other side of the globe"
        raise WindError(
            f"the wind ends {away}: it covers a part of its own grid ({grid.name}); take another file", "area"
        )
    nearest = np.unravel_index(int(np.argmin(beyond)), grid.shape)
    cell = _cell_at(nodes, nearest)
    close = beyond <= max(1.5 * cell, gap)
    rows = _at_least_six(np.flatnonzero(close.any(axis=1)), grid.shape[0])
    columns = _at_least_six(np.flatnonzero(close.any(axis=0)), grid.shape[1])
    kept = nodes[np.ix_(rows, columns)]
    if not np.isfinite(kept).all():
        raise WindError(f"its grid ({grid.name}) is too far away from the area to be laid out")
    return Subset(rows, columns, MappedPlacement(frame, np.ascontiguousarray(kept), grid.name))


def _on_far_side(grid: Grid, frame: LocalFrame) -> BoolArray:
    """Which nodes lie on the other half of the globe, where the frame cannot place them."""
    latitudes, origin = np.radians(grid.latitudes), np.radians(frame.origin.latitude_deg)
    apart = np.cos(np.radians(grid.longitudes - frame.origin.longitude_deg))
    behind: BoolArray = np.sin(latitudes) * np.sin(origin) + np.cos(latitudes) * np.cos(origin) * apart < 0
    return behind


def axes_directions(grid: Grid, rows: IntArray, columns: IntArray) -> FloatArray:
    """The angle from true east to the grid's x axis, anticlockwise [rad], at some of its nodes (rows, columns).

    The x axis runs along the columns, against their order where the grid says so.
    """
    latitudes = np.radians(grid.latitudes[np.ix_(rows, columns)])
    longitudes = np.unwrap(np.radians(grid.longitudes[np.ix_(rows, columns)]), axis=1)
    if min(latitudes.shape) < 2:
        raise WindError(f"its grid ({grid.name}) has too few nodes to tell where its axes point")
    east = np.cos(latitudes) * _slope(longitudes)
    north = _slope(latitudes)
    turn = -1.0 if grid.backwards else 1.0
    angle: FloatArray = np.arctan2(turn * north, turn * east)
    return angle


def _slope(values: FloatArray) -> FloatArray:
    """The change from column to column, of the second order where there are three of them."""
    slope: FloatArray = (
        np.gradient(values, axis=1, edge_order=2) if values.shape[1] > 2 else np.gradient(values, axis=1, edge_order=1)
    )
    return slope


def continuous(longitudes: FloatArray, frame: LocalFrame) -> FloatArray:
    """Longitudes [deg] within 180 degrees of the frame's origin."""
    origin = frame.origin.longitude_deg
    turned: FloatArray = origin + (longitudes - origin + 180.0) % 360.0 - 180.0
    return turned


def _west_to_east(longitudes: FloatArray, frame: LocalFrame) -> IntArray:
    """The numbers of an axis of longitudes from west to east about the frame's origin.

    An axis that lies across the meridian opposite to the origin falls in two: the part nearer to the origin is kept. A
    meridian that stands at both ends of the axis (0 and 360) counts once.
    """
    turned = np.round(continuous(longitudes, frame), 9)
    _, order = np.unique(turned, return_index=True)
    steps = np.abs((np.diff(longitudes) + 180.0) % 360.0 - 180.0)
    gaps = np.flatnonzero(np.diff(turned[order]) > 1.5 * steps.max(initial=0.0) + 1e-9)
    parts = np.split(order, gaps + 1)
    nearest: IntArray = min(parts, key=lambda subset: np.abs(turned[subset] - frame.origin.longitude_deg).min())
    return nearest


def _enclosing(axis: FloatArray, low: float, high: float) -> slice:
    """The nodes of an ascending axis that enclose an interval, and one more on either side."""
    first = min(max(int(np.searchsorted(axis, low, side="right")) - 2, 0), len(axis) - 1)
    last = min(max(int(np.searchsorted(axis, high, side="left")) + 2, first + 1), len(axis))
    return slice(first, last)


def _at_least_six(numbers: IntArray, size: int) -> IntArray:
    """All numbers from the first to the last, and more on both sides if they are few."""
    first, last = int(numbers[0]), int(numbers[-1]) + 1
    more = max(0, _FEWEST - (last - first) + 1) // 2
    return np.arange(max(0, first - more), min(size, last + more), dtype=np.int64)


def _cell_at(nodes: FloatArray, node: tuple[np.intp, ...]) -> float:
    """The longest way from a node to its neighbours [m]."""
    row, column = (int(number) for number in node)
    around = nodes[max(row - 1, 0) : row + 2, max(column - 1, 0) : column + 2].reshape(-1, 2)
    ways = np.hypot(*(around - nodes[row, column]).T)
    return float(np.max(ways[np.isfinite(ways)], initial=0.0))


def _outside_by(values: FloatArray, axis: FloatArray, reach: FloatArray | float = 0.0) -> FloatArray:
    """How far values lie outside of an axis; one of a single node reaches so far on both sides."""
    outside: FloatArray = values - np.clip(values, axis[0], axis[-1])
    return np.maximum(np.abs(outside) - (reach if len(axis) == 1 else 0.0), 0.0)


def _points_of(box: Box) -> FloatArray:
    """Points of an area (n, 2), its corners among them."""
    x, y = np.meshgrid(np.linspace(box[0], box[2], _LATTICE), np.linspace(box[1], box[3], _LATTICE))
    return np.stack([x.ravel(), y.ravel()], axis=-1)


def _middle_of(box: Box) -> FloatArray:
    return np.array([(box[0] + box[2]) / 2, (box[1] + box[3]) / 2])


def _half_of(box: Box) -> FloatArray:
    return np.array([(box[2] - box[0]) / 2, (box[3] - box[1]) / 2])
