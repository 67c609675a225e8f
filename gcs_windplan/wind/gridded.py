"""Wind on a grid in four dimensions: what forecasts and reanalyses hold, at work in the local frame."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from gcs_windplan.arrays import FloatArray
from gcs_windplan.cores import available_cores, spread
from gcs_windplan.errors import WindError
from gcs_windplan.geo.inverse import to_grid_north
from gcs_windplan.kernels.interpolation import POWER, Columns, Law, interpolate_columns
from gcs_windplan.wind.field import STEADY, Ground
from gcs_windplan.wind.placement import Placement, advice, may_extend

_EDGE = 1.0  # [m] a point may lie this far outside of the grid and still be taken as on its edge
_MANY = 50_000  # points that are worth more than one core


@dataclass(frozen=True, slots=True, eq=False)
class GriddedWind:
    """Wind at the nodes of a grid, at times and levels; linear between them.

    `columns` holds what `kernels.interpolation` says, its times in seconds since 1970, UTC; `departure` is
    the one among them from which `at` counts. `law` leads the wind below the lowest level down to the ground. Above the
    highest level (or where `law` carries it to) the wind is not known: NaN.

    Everything else outside raises `WindError`: outside of the area unless `extend` (then the nearest edge's wind is
    taken), and outside of `window` [s since 1970]. `ground` is the terrain under the route; without one the forecast's
    own counts. `ground_resolution` [m] is the terrain's, where known: wind at levels above the ground changes with it.
    """

    name: str
    placement: Placement
    columns: Columns
    law: Law
    departure: float
    window: tuple[float, float] = (-math.inf, math.inf)
    ground: Ground | None = None
    extend: bool = False
    ground_resolution: float = math.inf

    def __post_init__(self) -> None:
        check_columns(self.columns, self.name)
        contiguous = Columns(*(np.ascontiguousarray(part, dtype=np.float64) for part in self.columns))
        object.__setattr__(self, "columns", contiguous)
        rows, columns = len(self.columns.rows), len(self.columns.columns)
        if (rows, columns) != (len(self.placement.rows), len(self.placement.columns)):
            raise WindError(f"the wind's {rows} rows and {columns} columns are not those of its grid ({self.name})")

    @property
    def resolution(self) -> float:
        """Half of the smallest spacing of the grid [m], or the ground's own where the levels follow it."""
        across = self.placement.spacing / 2
        return min(across, self.ground_resolution) if len(self.columns.above) else across

    @property
    def times(self) -> FloatArray:
        """Its times [s since departure] where it has more than one."""
        return self.columns.times - self.departure if len(self.columns.times) > 1 else STEADY

    def at(self, points: FloatArray, seconds: float | FloatArray = 0.0) -> FloatArray:
        """The wind (n, 3) [m/s] at points (n, 3), `seconds` (one, or (n,)) after departure; its upward part is 0.

        NaN where the height is above what is known. Raises `WindError` outside of the area or time.
        """
        wind, convergence = self._true_wind(points, seconds)
        return to_grid_north(wind, convergence)

    def true_wind(self, points: FloatArray, seconds: float | FloatArray = 0.0) -> FloatArray:
        """The same as `at`, but towards true east and north."""
        return self._true_wind(points, seconds)[0]

    def at_all_heights(self, values: FloatArray) -> GriddedWind:
        """A field of two other values (times, rows, columns, 2) on the same grid, the same at all heights above ground.

        It is not known what lies below the ground: there they are 0.
        """
        columns = self.columns._replace(
            winds=values[:, :, :, np.newaxis, :], above=np.array([10.0]), heights=np.empty((*values.shape[:3], 0))
        )
        return replace(self, columns=columns, law=Law(POWER, 0.0, math.inf))

    def _true_wind(self, points: FloatArray, seconds: float | FloatArray) -> tuple[FloatArray, FloatArray]:
        """The wind (n, 3) towards true east and north, and the convergence (n,)."""
        when = self._when(seconds, len(points))
        places = self.placed(points)
        z = np.ascontiguousarray(points[:, 2], dtype=np.float64)
        ground = ground_under(self.ground, points)
        return self.interpolated(places, z, ground, when), places[:, 2]

    @classmethod
    def at_members(cls, members: Sequence[GriddedWind], points: FloatArray, seconds: float | FloatArray) -> FloatArray:
        """The winds (n, 3 m) of members as their `at`, one after the other; places and ground are looked up once."""
        one = members[0]
        if not all(member.shares_with(one) for member in members):
            return np.concatenate([member.at(points, seconds) for member in members], axis=1)
        when = one._when(seconds, len(points))
        places = one.placed(points)
        z = np.ascontiguousarray(points[:, 2], dtype=np.float64)
        ground = ground_under(one.ground, points)
        turned = [to_grid_north(member.interpolated(places, z, ground, when), places[:, 2]) for member in members]
        return np.concatenate(turned, axis=1)

    def shares_with(self, other: GriddedWind) -> bool:
        """Whether places, ground and clock are the other's: two members of one ensemble."""
        return (
            self.placement is other.placement
            and self.ground == other.ground
            and self.departure == other.departure
            and self.window == other.window
            and self.extend == other.extend
        )

    def placed(self, points: FloatArray) -> FloatArray:
        """Row, column and convergence of points (n, 3), shape (n, 3). Raises `WindError` outside of the area."""
        if not np.isfinite(points).all():
            raise WindError("the wind is asked for at a place that is not finite")
        places = self.placement.at(points)
        self._check_area(points, places)
        return np.ascontiguousarray(places)

    def interpolated(self, places: FloatArray, z: FloatArray, ground: FloatArray, when: FloatArray) -> FloatArray:
        """The wind towards true east and north at what the kernel takes, on as many cores as are worth it."""
        if len(z) < _MANY or available_cores() == 1:
            return interpolate_columns(self.columns, self.law, places, z, ground, when)
        size = -(-len(z) // available_cores())
        parts = [slice(begin, begin + size) for begin in range(0, len(z), size)]
        work = spread(lambda p: interpolate_columns(self.columns, self.law, places[p], z[p], ground[p], when[p]), parts)
        return np.concatenate(list(work))

    def _when(self, seconds: float | FloatArray, count: int) -> FloatArray:
        """The time of each point [s since 1970]. Raises `WindError` outside of the usable times."""
        when = np.broadcast_to(np.asarray(seconds, dtype=np.float64) + self.departure, count)
        first, last = self.window
        if count and not (when.min() >= first and when.max() <= last):
            early = first - float(when.min())
            late = float(when.max()) - last
            gap, side = (early, "before its first") if early > late else (late, "after its last")
            asked = (float(when.min()) if early > late else float(when.max())) - self.departure
            raise WindError(
                f"the wind is asked for {asked / 3600:.2f} h after departure, {gap / 3600:.2f} h {side} usable time"
                f" ({self.name}): choose another departure, or a file that reaches further",
                reason="time",
            )
        return np.ascontiguousarray(when)

    def _check_area(self, points: FloatArray, places: FloatArray) -> None:
        missing = self.placement.misses(places)
        if not len(missing) or missing.max() <= (may_extend(self.placement) if self.extend else _EDGE):
            return
        worst = int(np.argmax(missing))
        latitude, longitude = self.placement.frame.to_geographic(points[worst : worst + 1])
        raise WindError(
            f"the wind ends {missing[worst] / 1000:.1f} km short of {latitude[0]:.5f}, {longitude[0]:.5f}:"
            f" {self.placement.covers()} ({self.name}); {advice(self.placement, float(missing[worst]))}",
            reason="area",
        )


def mean_of(members: Sequence[GriddedWind]) -> GriddedWind:
    """The mean of members: winds and heights averaged; all else is the first one's."""
    parts = [one.columns for one in members]
    columns = parts[0]._replace(
        winds=np.mean([part.winds for part in parts], axis=0),
        heights=np.mean([part.heights for part in parts], axis=0),
    )
    return replace(members[0], columns=columns)


def ground_under(ground: Ground | None, points: FloatArray) -> FloatArray:
    """The ground's height under points (n, 3), shape (n,); NaN where nobody knows."""
    if ground is None:
        return np.full(len(points), np.nan)
    return np.ascontiguousarray(ground(points), dtype=np.float64)


def check_columns(columns: Columns, name: str) -> None:
    """Raise `WindError` unless the shapes fit and every axis and column ascends."""
    nt, ny, nx, levels, _ = columns.winds.shape
    na = len(columns.above)
    shared = columns.heights.shape[:3] == (1, 1, 1)
    for what, found, right in (
        ("rows", columns.rows.shape, (ny,)),
        ("columns", columns.columns.shape, (nx,)),
        ("times", columns.times.shape, (nt,)),
        ("terrain", columns.terrain.shape, (ny, nx)),
        ("roughness", columns.roughness.shape, (ny, nx)),
        ("heights", columns.heights.shape, ((1, 1, 1) if shared else (nt, ny, nx)) + (levels - na,)),
    ):
        if found != right:
            raise WindError(f"the wind's {what} have the shape {found}, not {right} ({name})")
    for what, axis in (
        ("rows", columns.rows), ("columns", columns.columns), ("times", columns.times), ("levels", columns.above),
    ):  # fmt: skip
        if not np.isfinite(axis).all() or not (np.diff(axis) > 0).all():
            raise WindError(f"the wind's {what} have to be finite and ascend, each value once ({name})")
    if not np.isfinite(columns.winds).all() or not np.isfinite(columns.heights).all():
        raise WindError(f"the wind is not finite everywhere ({name})")
    if not (np.diff(columns.heights, axis=3) > 0).all():
        raise WindError(f"the levels of {name} do not ascend in every column")
    if not (columns.roughness > 0).all():
        raise WindError(f"the roughness length is not above 0 everywhere ({name})")
