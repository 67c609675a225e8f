"""Writes small wind files that are odd in one chosen way."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import netCDF4
import numpy as np

from gcs_windplan.arrays import FloatArray

FROM_WEST = [[10.0, 0.0, 0.0]]  # [m/s] what an unchanged file holds everywhere: it blows towards east
LATITUDES = np.array([49.0, 50.0, 51.0, 52.0, 53.0])
LONGITUDES = np.array([-2.0, -1.0, 0.0, 1.0, 2.0])
_LEVELS = {
    "height": {"standard_name": "height", "units": "m"},
    "altitude": {"standard_name": "altitude", "units": "m"},
    "pressure": {"standard_name": "air_pressure", "units": "hPa"},
    "hybrid": {"long_name": "model level", "units": "1"},
    "number": {"long_name": "ensemble member", "units": "1"},
}


def write_trap(
    path: Path,
    names: tuple[str, str] = ("u", "v"),
    standard_names: tuple[str, str] | None = ("eastward_wind", "northward_wind"),
    units: str | None = "m s-1",
    hours: Sequence[float] = (0.0,),
    levels: Sequence[float] | None = (10.0, 100.0),
    v_levels: Sequence[float] | None = None,
    level_name: str = "height",
    geopotential: tuple[str, str] | None = None,
    without: Sequence[str] = (),
    gap: str | None = None,
    packed: bool = False,
    descending: bool = False,
    whole_circle: bool = False,
    projected: bool = False,
    slope: bool = False,
    shear: bool = False,
    gusty: bool = False,
) -> Path:
    """A file with u = 10 and v = 0 on 5 x 5 nodes about 51 N, 0 E, from 2026-05-01 12:00 UTC.

    `slope` adds 1 m/s to u for every degree east and 10 m/s to v for every degree north of 50; `shear` adds
    10 m/s to u on all levels but the last; `gusty` adds 5 m/s an hour to u.
    """
    latitudes = LATITUDES[::-1] if descending else LATITUDES
    longitudes = np.sort(LONGITUDES % 360) if whole_circle else LONGITUDES
    with netCDF4.Dataset(path, "w") as file:
        names_of_axes = ("y", "x") if projected else ("latitude", "longitude")
        _axis(file, "time", hours, {"units": "hours since 2026-05-01 12:00:00"})
        for name, values, unit in zip(names_of_axes, (latitudes, longitudes), ("north", "east"), strict=True):
            _axis(file, name, values, {"units": "km" if projected else f"degrees_{unit}"})
        for component, name in enumerate(names):
            if name in without:
                continue
            heights = v_levels if component and v_levels is not None else levels
            axis = level_name if heights is levels else f"other_{level_name}"
            if heights is not None and axis not in file.dimensions:
                _axis(file, axis, heights, _LEVELS[level_name])
            dimensions = ("time", *(() if heights is None else (axis,)), *names_of_axes)
            base = np.zeros((len(hours), 1 if heights is None else len(heights), 5, 5))
            if slope:
                east = (longitudes + 180.0) % 360.0 - 180.0
                base = base + (10 * (latitudes[:, np.newaxis] - 50) if component else 10 + east)
            elif component == 0:
                base = base + 10.0
            if shear and component == 0:
                base[:, :-1] += 10.0
            if gusty and component == 0:
                base += 5.0 * np.asarray(hours)[:, np.newaxis, np.newaxis, np.newaxis]
            _component(file, name, dimensions, base, gap if component == 0 else None, packed)
            if standard_names is not None:
                file[name].standard_name = standard_names[component]
            if units is not None:
                file[name].units = units
        if geopotential is not None and levels is not None:
            name, unit = geopotential
            z = np.linspace(1000.0, 100.0, len(levels)) * (9.80665 if unit == "m2 s-2" else 1.0)
            variable = file.createVariable(name, "f8", ("time", level_name, *names_of_axes))
            variable.units = unit
            variable[:] = z[np.newaxis, :, np.newaxis, np.newaxis] * np.ones((len(hours), 1, 5, 5))
    return path


def _axis(file: netCDF4.Dataset, name: str, values: Sequence[float] | FloatArray, attributes: dict[str, str]) -> None:
    file.createDimension(name, len(values))
    variable = file.createVariable(name, "f8", (name,))
    variable.setncatts(attributes)
    variable[:] = values


def _component(
    file: netCDF4.Dataset,
    name: str,
    dimensions: tuple[str, ...],
    values: FloatArray,
    gap: str | None,
    packed: bool,
) -> None:
    variable = file.createVariable(name, "i2" if packed else "f4", dimensions, fill_value=-9999)
    if packed:
        variable.scale_factor, variable.add_offset = 0.01, 3.0
    shaped = values.reshape([len(file.dimensions[d]) for d in dimensions])
    if gap is not None:
        shaped[(-1,) * shaped.ndim] = np.nan
        shaped = np.ma.masked_invalid(shaped) if gap == "masked" else shaped
    variable[:] = shaped
