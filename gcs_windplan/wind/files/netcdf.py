"""Wind from NetCDF files, classic and NetCDF4: what CF files, ECMWF, NCEP, DWD, wgrib2, NetCDF-Java and WRF write.

netCDF4 is imported here and in `cf_time` alone.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path

import netCDF4
import numpy as np

from gcs_windplan.arrays import FloatArray, IntArray
from gcs_windplan.errors import Problem, WindError
from gcs_windplan.wind.field_index import SURFACE, Field2D, FieldIndex, Level, Quantity
from gcs_windplan.wind.files.cf import Variable
from gcs_windplan.wind.files.cf_axes import CLOCK, Role, role
from gcs_windplan.wind.files.cf_names import WIND, Meaning, looks_like_wind, meaning
from gcs_windplan.wind.files.netcdf_axes import Axes, Levels
from gcs_windplan.wind.files.netcdf_file import NetcdfFile, refuse_cut_short
from gcs_windplan.wind.files.netcdf_grid import NetcdfLayout, NetcdfLayouts
from gcs_windplan.wind.files.units import check_units, converted, unlogged

_ON_MODEL_LEVELS = ("temperature", "humidity")
_FEW = 6  # variables that are named one by one


@contextmanager
def open_netcdf(path: Path) -> Iterator[FieldIndex]:
    """The fields of a NetCDF file, which can be read as long as it is open.

    Raises `WindError`, here and in `Field2D.read`, that begins with the path: for a file that cannot be read; for wind
    whose times, levels or units cannot be told, if there is no other in the file. What else cannot be used stands in
    `FieldIndex.unused`.
    """
    refuse_cut_short(path)
    try:
        dataset = netCDF4.Dataset(path)
    except (OSError, RuntimeError) as error:
        raise WindError(Problem(f"cannot be read as NetCDF ({error})", file=path)) from error
    try:
        kind = "NetCDF4" if dataset.data_model.startswith("NETCDF4") else "NetCDF classic"
        yield replace(_NetcdfReader(path, NetcdfFile(dataset)).index(), format=kind)
    finally:
        dataset.close()


@dataclass(frozen=True, slots=True, eq=False)
class _Source:
    """A variable, what it holds, and where.

    `column` is the variable at one node, for which times and levels are asked: there are fields of times, of the
    strongest gust. `version` is ERA5's dimension `expver`.
    """

    variable: Variable
    column: Variable
    meaning: Meaning
    quantity: Quantity
    layout: NetcdfLayout
    version: str | None


class _NetcdfReader:
    """An open file on its way to a index."""

    def __init__(self, path: Path, file: NetcdfFile) -> None:
        self._path = path
        self._file = file
        self._axes = Axes(file)
        self._layouts = NetcdfLayouts(self._axes)
        self._unused: dict[str, list[str]] = {}
        self._broken = False

    def index(self) -> FieldIndex:
        """All fields. Raises `WindError` where times, levels or units of wind cannot be told and no wind is left."""
        with self._naming_file("it"):
            fields = [field2d for variable in self._file.variables.values() for field2d in self._fields_of(variable)]
            fields = self._on_one_grid(fields)
            if self._file.groups:
                self._note_unused(", ".join(self._file.groups), "groups are not read: lift them with `ncks -G :`")
            unused = tuple(_unused_note(names, reason) for reason, names in self._unused.items())
            if self._broken and not any(field2d.quantity in ("u", "v", "speed") for field2d in fields):
                raise WindError("; ".join(unused))
        return FieldIndex(self._path.name, tuple(fields), self._file.title, unused)

    def _fields_of(self, variable: Variable) -> list[Field2D]:
        """The fields of a variable; none where it is no wind, or cannot be used, which is noted."""
        if not self._file.is_numeric(variable) or variable.dimensions == (variable.name,):
            return []
        found = meaning(variable)
        if found is None:
            if looks_like_wind(variable) and len(variable.dimensions) > 1:
                self._note_unused(variable.name, "by name or attributes no wind at a height, or a statistic of it")
            return []
        if any(self._role(variable, dimension) == "depth" for dimension in variable.dimensions):
            return []
        is_wind = found.quantity in WIND
        try:
            source = self._source(variable, found)
            try:
                return list(self._fields(source))
            except WindError:
                self._broken = self._broken or is_wind
                raise
        except WindError as error:
            if is_wind or len(variable.dimensions) > 1:
                self._note_unused(variable.name, str(error))
            return []

    def _note_unused(self, name: str, reason: str) -> None:
        self._unused.setdefault(reason, []).append(name)

    def _source(self, variable: Variable, found: Meaning) -> _Source:
        """Where a variable's values stand. Raises `WindError` for other grids, and axes that are not known."""
        if 0 in variable.shape:
            raise WindError("it is empty: nothing was written into it")
        if found.quantity not in WIND:  # which say so when they are read: the rest can be done without
            check_units(variable.name, variable.raw_text("units"), found.quantity, found.logarithm)
        layout = self._layouts.of(variable)
        free = tuple(d for d in variable.dimensions if d not in (layout.rows, layout.columns))
        column = replace(variable, dimensions=free, shape=tuple(self._file.dimensions[d] for d in free))
        version = next((d for d in free if self._role(column, d) == "version"), None)
        self._check_axes(column)
        return _Source(variable, column, found, found.quantity, layout, version)

    def _check_axes(self, column: Variable) -> None:
        """Raise `WindError` for axes that are not known."""
        timed = {d for time in self._axes.auxiliary(column, *CLOCK) for d in time.dimensions} | {"Time"}  # WRF's
        for dimension, size in zip(column.dimensions, column.shape, strict=True):
            if size > 1 and dimension not in timed and self._role(column, dimension) is None:
                raise WindError(
                    f"an axis {dimension} of {size} values counts nothing that is known: set the `units` (hPa, m) or"
                    " the `standard_name` (air_pressure, height, altitude, realization) of its coordinate"
                )

    def _role(self, variable: Variable, dimension: str) -> Role | None:
        """What a dimension counts; members and versions need no numbers to be known."""
        axis = self._axes.coordinate_along(variable, dimension)
        if axis is not None:
            return self._axes.role(axis)
        named = role(self._file.variables.get(dimension, Variable(dimension, (dimension,), (1,), {})))
        return named if named in ("member", "version") else None

    def _fields(self, source: _Source) -> Iterator[Field2D]:
        """The fields of a variable. Raises `WindError` for times and levels that cannot be told."""
        variable, column = source.variable, source.column
        levels = self._axes.levels(column, source.meaning)
        quantity = _at(levels, source.quantity)
        if quantity is None:
            return
        time, run = self._axes.times(column, source.meaning)
        members = self._members(column)
        made = partial(
            Field2D,
            quantity=quantity,
            grid=source.layout.grid,
            name=variable.name,
            units=variable.raw_text("units"),
            along_grid=self._along_grid(source),
            half_levels=levels.half_levels,
        )
        source = replace(source, quantity=quantity)
        free = [d for d in column.dimensions if d != source.version]
        for numbers in np.ndindex(*(self._file.dimensions[d] for d in free)):
            place = dict(zip(free, numbers, strict=True))
            level = levels.levels[place[levels.dimension] if levels.dimension else 0]
            yield made(
                level=SURFACE if quantity == "terrain" else level,
                read=partial(self._read, source, place),
                time=None if time is None else time.at(place),
                run=None if run is None else run.at(place),
                member=None if members is None else members[1][place[members[0]]],
            )

    def _members(self, variable: Variable) -> tuple[str, list[int]] | None:
        """The dimension of an ensemble and its members; one member is none."""
        for dimension in variable.dimensions:
            size = self._file.dimensions[dimension]
            if size > 1 and self._role(variable, dimension) == "member":
                axis = self._axes.coordinate_along(variable, dimension)
                values = np.arange(size) if axis is None else self._file.values(axis)
                known = bool((np.abs(values) < 2**31).all()) and len(np.unique(values.astype(np.int64))) == size
                return dimension, [int(value) for value in (values if known else np.arange(size))]
        return None

    def _along_grid(self, source: _Source) -> bool:
        """Whether u or v follow the grid: on grids of their own kind weather models write them so by custom."""
        if source.quantity not in ("u", "v") or source.layout.grid.regular:
            return False
        along_grid = source.meaning.along_grid
        if along_grid is None and "south_north" not in source.variable.dimensions:  # WRF is known for it
            self._note_unused(
                source.variable.name,
                "used as following the grid, not true north, as most models write it, for the file does not tell: if"
                " that is wrong, set the `standard_name` to eastward_wind and northward_wind",
            )
        return True if along_grid is None else along_grid

    def _on_one_grid(self, fields: list[Field2D]) -> list[Field2D]:
        """Without u and v of levels where they share no grid: those stand on the sides of their cells."""
        grids: dict[tuple[str, Level], set[object]] = defaultdict(set)
        for field2d in fields:
            grids[field2d.quantity, field2d.level].add(field2d.grid.key)
        apart = {
            level
            for quantity, level in grids
            if quantity == "u" and ("v", level) in grids and not grids["u", level] & grids["v", level]
        }
        torn = {s.name for s in fields if s.quantity in ("u", "v") and s.level in apart}
        for name in sorted(torn):
            self._note_unused(name, "u and v stand at different places, on a staggered grid: bring them to one first")
        return [s for s in fields if not (s.quantity in ("u", "v") and s.level in apart)]

    def _read(self, source: _Source, place: dict[str, int], rows: IntArray, columns: IntArray) -> FloatArray:
        """The values of a field in the unit of its quantity."""
        variable, quantity, units = source.variable, source.quantity, source.variable.raw_text("units")
        with self._naming_file(variable.name):
            values = self._plane(source, place, rows, columns)
            if source.meaning.logarithm:
                return unlogged(values, variable.name)
            values = converted(values, quantity, variable.name, units)
        if quantity == "direction":
            values = np.mod(values + (180.0 if source.meaning.towards else 0.0), 360.0)
        return values

    def _plane(self, source: _Source, place: dict[str, int], rows: IntArray, columns: IntArray) -> FloatArray:
        """The values as they stand in the file; of ERA5's versions the first that has any."""
        variable, layout = source.variable, source.layout
        across = (
            None if layout.rows is None else (layout.rows, rows),
            None if layout.columns is None else (layout.columns, columns),
        )
        if source.version is None:
            return self._file.plane(variable, place, *across)
        size = self._file.dimensions[source.version]
        axis = self._axes.coordinate_along(variable, source.version)
        order = np.arange(size) if axis is None else np.argsort(self._file.values(axis))
        planes = [self._file.plane(variable, {**place, source.version: int(one)}, *across) for one in order]
        first = planes[0]
        for other in planes[1:]:
            first = np.where(np.isfinite(first), first, other)
        return first

    @contextmanager
    def _naming_file(self, what: str) -> Iterator[None]:
        """Every error on the way begins with the path."""
        try:
            yield
        except WindError as error:
            raise error.in_files([self._path]) from error
        except (OSError, RuntimeError) as error:
            raise WindError(
                Problem(f"{what} cannot be read ({error}): it is damaged, or packed in an unknown way", file=self._path)
            ) from error


def _at(levels: Levels, quantity: Quantity) -> Quantity | None:
    """What a quantity is on such levels: a geopotential on none is the terrain's; None if it is of no use there."""
    kind = levels.levels[0].kind
    if quantity == "height" and levels.dimension is None and kind in ("unknown", "surface"):
        return "terrain"
    return None if quantity in _ON_MODEL_LEVELS and kind != "model" else quantity


def _unused_note(names: list[str], reason: str) -> str:
    """Which variables are ignored and why."""
    if reason.startswith(f"{names[0]} "):
        return reason
    more = f" and {len(names) - _FEW} more" if len(names) > _FEW else ""
    return f"{', '.join(names[:_FEW])}{more}: {reason}"
