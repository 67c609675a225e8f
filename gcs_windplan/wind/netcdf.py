"""Wind from NetCDF files, classic and NetCDF4: ERA5, GFS, all that keeps u and v on latitudes and longitudes.

netCDF4 is imported here and nowhere else.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from datetime import UTC, datetime
from pathlib import Path
from typing import Any

import netCDF4
import numpy as np

from gcs_windplan.arrays import FloatArray, IntArray
from gcs_windplan.constants import STANDARD_GRAVITY
from gcs_windplan.errors import WindError
from gcs_windplan.geodesy import LocalFrame
from gcs_windplan.wind import cf, selection
from gcs_windplan.wind.field import Ground
from gcs_windplan.wind.gridded import GriddedWind
from gcs_windplan.wind.selection import Axes, Axis, Box, Wanted

_ENSEMBLES = ("number", "member", "realization", "ensemble", "ens")
_ORDER: tuple[cf.AxisKind, ...] = ("time", *cf.LEVEL_KINDS, "latitude", "longitude")


def read_netcdf(
    path: Path | str,
    frame: LocalFrame,
    ground: Ground | None = None,
    departure: datetime | None = None,
    area: Box | None = None,
    extend: bool = False,
) -> GriddedWind:
    """The wind in a NetCDF file.

    `area` (west, south, east, north in the local frame [m]) is where it will be asked for: what lies more
    than a cell outside of it is not read. `departure`, with its time zone, chooses the time in a file with
    several; a file with one time is used at any time if no departure is told, and otherwise within three
    hours of it. `ground` is needed for levels above the ground. `extend` takes the wind at the edge for
    places outside of the grid.

    Levels may be heights above the ground, altitudes, or pressures with a geopotential in the file, whose
    heights are taken as above mean sea level. A file with one level or none gives the same wind at every
    height. Where u and v have different levels the common ones are used. What was taken stands in the `name`.

    Raises `WindError` for a file that cannot be read; u without v; unknown units or axes, projected grids,
    ensembles; a departure that is missing or outside of the file's times; values missing inside the part that
    is read.
    """
    if departure is not None and departure.tzinfo is None:
        raise WindError(f"the departure {departure:%Y-%m-%d %H:%M} has no time zone: write it in UTC, ending in Z")
    path = Path(path)
    with _opened(path) as dataset:
        return _Reader(dataset).wind(path.name, frame, ground, departure, area, extend)


@contextmanager
def _opened(path: Path) -> Iterator[Any]:
    """The open dataset; every error on the way names the file."""
    if not path.is_file():
        raise WindError(f"{path}: no such file")
    try:
        with netCDF4.Dataset(path) as dataset:
            yield dataset
    except WindError as error:
        raise WindError(f"{path}: {error}") from error
    except (OSError, RuntimeError) as error:
        raise WindError(f"{path}: cannot be read as NetCDF ({error})") from error


class _Reader:
    """An open dataset and what it says about its variables."""

    def __init__(self, dataset: Any) -> None:
        self.dataset = dataset
        self.file: dict[str, cf.Variable] = {
            name: cf.Variable(name, v.dimensions, v.shape, {a: v.getncattr(a) for a in v.ncattrs()})
            for name, v in dataset.variables.items()
        }

    def wind(
        self,
        name: str,
        frame: LocalFrame,
        ground: Ground | None,
        departure: datetime | None,
        area: Box | None,
        extend: bool,
    ) -> GriddedWind:
        u, v = cf.find_winds(self.file)
        axes = {variable.name: self.axes(variable) for variable in (u, v)}
        u_axes, v_axes = axes[u.name], axes[v.name]
        wanted = selection.horizontal(u_axes, frame, area, extend)
        times = selection.choose_times(self.all_times(u_axes), departure)
        if "time" in u_axes:
            wanted["time"] = times.values
        kind = selection.level_kind(u_axes, v_axes)
        if kind is not None:
            wanted[kind] = selection.common_levels(kind, u_axes[kind].values, v_axes[kind].values)
        levels = np.zeros(1) if kind is None else wanted[kind]
        over_ground = kind == "height" and len(levels) > 1
        if over_ground and ground is None:
            raise WindError("its levels are heights above the ground: it can only be used with a terrain")
        title = str(getattr(self.dataset, "title", "")).strip()[:80]
        source = f"{name} ({title})" if title else name
        said = selection.say_levels(kind, levels, u_axes, v_axes)
        return GriddedWind(
            name=f"{source}: {u.name}, {v.name}, {said}, {times.note}{', extended' if extend else ''}",
            frame=frame,
            latitudes=wanted["latitude"],
            longitudes=selection.continuous(wanted["longitude"], frame),
            heights=self.heights(kind, levels, wanted, u_axes),
            times=times.values - times.zero,
            u=self.values(u, u_axes, wanted) * cf.speed_unit(u),
            v=self.values(v, v_axes, wanted) * cf.speed_unit(v),
            ground=ground if over_ground else None,
            window=times.window,
            extend=extend,
        )

    def axes(self, variable: cf.Variable) -> Axes:
        """The axes of a variable by what they count, without dimensions of length 1 that count nothing."""
        axes: Axes = {}
        unknown = []
        for dimension, size in zip(variable.dimensions, variable.shape, strict=True):
            found = cf.coordinate_of(self.file, dimension)
            if found is not None and found[0] not in axes:
                axes[found[0]] = Axis(dimension, self.coordinate(*found))
            elif size > 1:
                unknown.append((dimension, size))
        if not {"latitude", "longitude"} <= set(axes):
            raise WindError(
                f"{variable.name} ({', '.join(variable.dimensions)}) has no latitude and longitude axis: "
                "other grids are not read; regrid it first, for example with `cdo remapbil`"
            )
        if unknown:
            raise WindError(_unknown_axis(variable, *unknown[0]))
        return axes

    def coordinate(self, kind: cf.AxisKind, variable: cf.Variable) -> FloatArray:
        """The values of a coordinate (n,) in degrees, UTC seconds since 1970, metres or pascals."""
        values = _plain(self.dataset.variables[variable.name][...]).ravel()
        if not np.isfinite(values).all():
            raise WindError(f"its coordinate {variable.name} has missing values")
        return _decoded(variable, values) if kind == "time" else values * cf.axis_unit(variable, kind)

    def all_times(self, axes: Axes) -> FloatArray:
        """Every time of the file (n,) [s since 1970, UTC], empty where it knows none."""
        if "time" in axes:
            return axes["time"].values
        scalar = cf.scalar_time(self.file)
        return np.empty(0) if scalar is None else self.coordinate("time", scalar)

    def heights(self, kind: cf.AxisKind | None, levels: FloatArray, wanted: Wanted, u: Axes) -> FloatArray:
        """Heights of the levels [m]: (levels,), or (time, level, latitude, longitude) on pressure levels."""
        if kind != "pressure" or len(levels) == 1:
            return levels if len(levels) > 1 else np.zeros(1)
        variable = cf.find_geopotential(self.file, u[kind].dimension)
        if variable is None:
            raise WindError(
                "its levels are pressures and it has no geopotential (z or gh) on them, so that their "
                "heights are unknown: download it along with u and v"
            )
        if cf.is_geopotential(variable):
            return self.values(variable, self.axes(variable), wanted) / STANDARD_GRAVITY
        return self.values(variable, self.axes(variable), wanted) * cf.axis_unit(variable, "altitude")

    def values(self, variable: cf.Variable, axes: Axes, wanted: Wanted) -> FloatArray:
        """The wanted part of a variable: (time, level, latitude, longitude), in its own unit."""
        for kind in wanted:
            if kind not in axes:
                raise WindError(f"{variable.name} has no {kind} axis")
        for kind, axis in axes.items():
            if kind not in wanted and len(axis.values) > 1:
                raise WindError(f"{variable.name} has a {kind} axis that the wind has not")
        ordered = [kind for kind in _ORDER if kind in wanted]
        places = {kind: selection.positions(axes[kind].values, wanted[kind], kind) for kind in ordered}
        array = self.block(variable, {axes[kind].dimension: places[kind] for kind in ordered})
        _check_complete(variable.name, array, [(kind, wanted[kind]) for kind in ordered])
        levels = [len(wanted[kind]) for kind in cf.LEVEL_KINDS if kind in wanted] or [1]
        return array.reshape(len(wanted.get("time", [0])), *levels, *array.shape[-2:])

    def block(self, variable: cf.Variable, places: dict[str, IntArray]) -> FloatArray:
        """The values at `places` along each named dimension, in that order; at 0 along the others.

        Reads the smallest block that holds them, which is far faster than to let the library pick one by one.
        """
        index = tuple(slice(places[d].min(), places[d].max() + 1) if d in places else 0 for d in variable.dimensions)
        block = _plain(self.dataset.variables[variable.name][index])
        present = [d for d in variable.dimensions if d in places]
        block = block.transpose([present.index(d) for d in places])
        return block[np.ix_(*(place - place.min() for place in places.values()))]


def _plain(values: Any) -> FloatArray:
    """What netCDF4 read, NaN where it masked."""
    array: FloatArray = np.array(np.ma.getdata(values), dtype=np.float64)
    array[np.ma.getmaskarray(values)] = np.nan
    return array


def _decoded(variable: cf.Variable, values: FloatArray) -> FloatArray:
    """UTC seconds since 1970 of the values of a time axis."""
    units, calendar = str(variable.attributes["units"]), str(variable.attributes.get("calendar", "standard"))
    try:
        moments: Any = netCDF4.num2date(
            values, units, calendar, only_use_cftime_datetimes=False, only_use_python_datetimes=True
        )
    except (ValueError, OverflowError) as error:
        raise WindError(f"its times {variable.name} ({units}, {calendar}) cannot be read: {error}") from error
    return np.array([moment.replace(tzinfo=UTC).timestamp() for moment in np.atleast_1d(moments)])


def _check_complete(name: str, values: FloatArray, axes: list[tuple[cf.AxisKind, FloatArray]]) -> None:
    """Raises `WindError` that tells the first place where a value is missing."""
    missing = np.argwhere(~np.isfinite(values))
    if not len(missing):
        return
    place = ", ".join(selection.say(kind, axis[index]) for (kind, axis), index in zip(axes, missing[0], strict=True))
    count = f"{len(missing)} of {values.size} values"
    raise WindError(f"{name} misses {count}, the first at {place}: fill them or cut them off")


def _unknown_axis(variable: cf.Variable, dimension: str, size: int) -> str:
    if dimension.lower() in _ENSEMBLES:
        return f"{variable.name} has {size} members along {dimension}: keep one of them in the file"
    return (
        f"{variable.name} has an axis {dimension} of {size} values that is not known as latitude, longitude, "
        "time, height above ground, altitude or pressure (model levels and projected grids cannot be placed)"
    )
