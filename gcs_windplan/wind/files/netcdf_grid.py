"""Where the values of a NetCDF variable stand."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from gcs_windplan.arrays import FloatArray
from gcs_windplan.errors import WindError
from gcs_windplan.wind.field_index import Grid
from gcs_windplan.wind.files.cf import Variable
from gcs_windplan.wind.files.cf_axes import Role
from gcs_windplan.wind.files.netcdf_axes import Axes
from gcs_windplan.wind.files.projection import unprojected
from gcs_windplan.wind.files.units import ANGLE, compact


@dataclass(frozen=True, slots=True, eq=False)
class NetcdfLayout:
    """A grid and the dimensions of its rows and columns; None where there is one row or column without a dimension."""

    grid: Grid
    rows: str | None
    columns: str | None


class NetcdfLayouts:
    """The grids of a file: variables on the same coordinates share one."""

    def __init__(self, axes: Axes) -> None:
        self._axes = axes
        self._file = axes.file
        self._regulars: dict[tuple[str, str], Grid] = {}
        self._known: dict[tuple[str, ...], NetcdfLayout] = {}

    def of(self, variable: Variable) -> NetcdfLayout:
        """Where a variable's values stand.

        Raises `WindError`, that says what to do, for staggered and unstructured grids, and for places that the file
        does not tell or that are no numbers.
        """
        staggered = [d for d in variable.dimensions if "stag" in d.lower() and self._file.dimensions[d] > 1]
        if staggered:
            raise WindError(
                f"they stand between the nodes, on a staggered grid ({', '.join(staggered)}): bring them to its centres"
                " first, for example with wrf-python's `destagger`"
            )
        latitudes = self._axes.auxiliary(variable, "latitude")
        longitudes = self._axes.auxiliary(variable, "longitude")
        return (
            self._regular(variable, latitudes, longitudes)
            or self._curved(*(self._node_coordinates(variable, role) for role in ("latitude", "longitude")))
            or self._projected(variable)
            or self._point(variable)
            or self._refuse(variable, latitudes, longitudes)
        )

    def _regular(
        self, variable: Variable, latitudes: list[Variable], longitudes: list[Variable]
    ) -> NetcdfLayout | None:
        """Rows are parallels, columns meridians; one of both may be a single one."""
        rows = next((v for v in latitudes if len(v.dimensions) == 1), None)
        columns = next((v for v in longitudes if len(v.dimensions) == 1), None)
        if rows is None and columns is not None and not latitudes:
            rows = self._axes.single_value(variable, "latitude")
        elif columns is None and rows is not None and not longitudes:
            columns = self._axes.single_value(variable, "longitude")
        if rows is None or columns is None or rows.dimensions == columns.dimensions:
            return None
        return self._layout_on(variable, rows, columns)

    def _point(self, variable: Variable) -> NetcdfLayout | None:
        rows, columns = self._axes.single_value(variable, "latitude"), self._axes.single_value(variable, "longitude")
        return None if rows is None or columns is None else self._layout_on(variable, rows, columns)

    def _layout_on(self, variable: Variable, rows: Variable, columns: Variable) -> NetcdfLayout:
        key = (rows.name, columns.name)
        if key not in self._regulars:
            latitudes, longitudes = (self._degrees(v).ravel() for v in (rows, columns))
            name = f"{len(latitudes)} latitudes x {len(longitudes)} longitudes"
            self._regulars[key] = Grid(latitudes, longitudes, name)
        along = (next((d for d in v.dimensions if d in variable.dimensions), None) for v in (rows, columns))
        return NetcdfLayout(self._regulars[key], *along)

    def _node_coordinates(self, variable: Variable, role: Role) -> list[Variable]:
        """Latitudes or longitudes of each node; WRF repeats them for every time, which a terrain may lack."""
        beside = [v for v in self._axes.auxiliary(variable, role) if len(v.dimensions) > 1]
        repeated = [v for v in self._axes.all(role) if len(v.dimensions) > 2]
        return beside + [v for v in repeated if set(v.dimensions[-2:]) <= set(variable.dimensions)]

    def _curved(self, latitudes: list[Variable], longitudes: list[Variable]) -> NetcdfLayout | None:
        """Each node has its own latitude and longitude."""
        pairs = [(a, b) for a in latitudes for b in longitudes if a.dimensions == b.dimensions]
        if not pairs:
            return None
        key = (pairs[0][0].name, pairs[0][1].name)
        if key not in self._known:
            found = self._nodes(*pairs[0])
            if found is None:
                return None
            self._known[key] = found
        return self._known[key]

    def _nodes(self, latitude: Variable, longitude: Variable) -> NetcdfLayout | None:
        """None where nodes are missing, which a projection may help out with. Raises `WindError` for moving nests."""
        values = [self._degrees(v) for v in (latitude, longitude)]
        for array in values:
            still = array.reshape(-1, *array.shape[-2:])
            if not (still == still[:1]).all() and np.isfinite(still).all():
                raise WindError(f"its nodes ({latitude.name}, {longitude.name}) move with time: cut it at single times")
        latitudes, longitudes = (array.reshape(-1, *array.shape[-2:])[0] for array in values)
        if not (np.isfinite(latitudes).all() and np.isfinite(longitudes).all()):
            return None
        rows, columns = latitude.dimensions[-2:]
        if self._is_x(rows) and not self._is_x(columns):
            rows, columns, latitudes, longitudes = columns, rows, latitudes.T, longitudes.T
        if (latitudes == latitudes[:, :1]).all() and (longitudes == longitudes[:1]).all():
            latitudes, longitudes = latitudes[:, 0], longitudes[0]
        name = f"{latitude.name}, {longitude.name} on {rows}, {columns}"
        return NetcdfLayout(Grid(latitudes, longitudes, name, self._descends(columns)), rows, columns)

    def _descends(self, dimension: str) -> bool:
        """Whether the numbers along a dimension descend."""
        axis = self._file.variables.get(dimension)
        if axis is None or axis.dimensions != (dimension,):
            return False
        try:
            numbers = np.asarray(self._file.values(axis), dtype=np.float64).ravel()
        except (TypeError, ValueError):
            return False
        return bool(len(numbers) > 1 and numbers[-1] < numbers[0])

    def _is_x(self, dimension: str) -> bool:
        axis = self._file.variables.get(dimension)
        said = None if axis is None else self._axes.role(axis)
        return said in ("x", "longitude") or (
            said is None and dimension.lower() in ("x", "lon", "longitude", "west_east")
        )

    def _projected(self, variable: Variable) -> NetcdfLayout | None:
        """The nodes by the grid mapping."""
        ys, xs = (
            [v for v in self._axes.auxiliary(variable, role) if len(v.dimensions) == 1] for role in ("y", "x")
        )  # fmt: skip
        if not xs or not ys or xs[0].dimensions == ys[0].dimensions:
            return None
        mapping = self._mapping(variable)
        if mapping is None:
            raise WindError(
                f"it stands on a projected grid ({ys[0].name}, {xs[0].name}) without latitudes and longitudes, and"
                " without a grid mapping that tells the projection: add them, or regrid it (`cdo remapbil`)"
            )
        key = (ys[0].name, xs[0].name, mapping.name)
        if key not in self._known:
            x, y = (self._file.values(axis).ravel() for axis in (xs[0], ys[0]))
            nodes = unprojected(x, y, mapping, (xs[0].raw_text("units"), ys[0].raw_text("units")))
            grid = Grid(*nodes, mapping.text("grid_mapping_name"), backwards=bool(x[-1] < x[0]))
            self._known[key] = NetcdfLayout(grid, ys[0].dimensions[0], xs[0].dimensions[0])
        return self._known[key]

    def _mapping(self, variable: Variable) -> Variable | None:
        """The variable's grid mapping, or the file's only one."""
        names = [name.rstrip(":") for name in variable.raw_text("grid_mapping").split()]
        for name in names:
            if name in self._file.variables:
                return self._file.variables[name]
        every = [v for v in self._file.variables.values() if v.text("grid_mapping_name")]
        return every[0] if len(every) == 1 else None

    def _refuse(self, variable: Variable, latitudes: list[Variable], longitudes: list[Variable]) -> NetcdfLayout:
        shared = {v.dimensions for v in latitudes} & {v.dimensions for v in longitudes}
        along = next((dimensions for dimensions in shared if len(dimensions) == 1), None)
        if along is not None:
            raise WindError(
                f"they stand at single places along {along[0]}, on an unstructured grid or a path: regrid them to"
                " latitudes and longitudes first, for example with `cdo remapnn,r360x180` or a finer grid"
            )
        if shared:
            raise WindError("its latitudes and longitudes have missing values: fill them, or regrid it")
        raise WindError(
            f"their dimensions ({', '.join(variable.dimensions)}) are no latitudes and longitudes, which the file does"
            " not tell in any other way: add them, or regrid it, for example with `cdo remapbil`"
        )

    def _degrees(self, axis: Variable) -> FloatArray:
        return self._file.values(axis) * ANGLE.factors.get(compact(axis.raw_text("units")), 1.0)
