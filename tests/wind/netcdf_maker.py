"""Writes small NetCDF files of any shape, and reads all fields of one."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import netCDF4
import numpy as np

from gcs_windplan.arrays import FloatArray
from gcs_windplan.wind.field_index import Field2D, FieldIndex
from gcs_windplan.wind.files.netcdf import open_netcdf

#: Dimensions separated by blanks, values, attributes.
Content = tuple[str, Any, Mapping[str, Any]]

MS = {"units": "m s-1"}
LAT: Content = ("lat", [50.0, 51.0, 52.0], {"units": "degrees_north"})
LON: Content = ("lon", [-1.0, 0.0, 1.0, 2.0], {"units": "degrees_east"})
AXES: dict[str, Content] = {"lat": LAT, "lon": LON}
HOURS = "hours since 2026-05-01 12:00:00"
NOON = 1777636800.0  # 2026-05-01 12:00 UTC


def write_netcdf(path: Path, variables: Mapping[str, Content], format: Any = "NETCDF4", **attributes: Any) -> Path:
    """A file of variables, whose dimensions have the lengths of their values."""
    with netCDF4.Dataset(path, "w", format=format) as file:
        file.setncatts(attributes)
        for name, (text, values, said) in variables.items():
            array = np.asarray(values)
            for dimension, size in zip(text.split(), array.shape, strict=True):
                if dimension not in file.dimensions:
                    file.createDimension(dimension, size)
            said = dict(said)
            options = {key[1:]: said.pop(key) for key in list(said) if key.startswith("+")}
            kind = str if array.dtype.kind == "U" else options.pop("dtype", array.dtype)
            variable = file.createVariable(name, kind, text.split(), **options)
            variable.setncatts(said)
            variable[...] = array.astype(object) if kind is str else array
    return path


def wind(dimensions: str, *shape: int, value: Any = 10.0, **attributes: Any) -> Content:
    """A variable that holds `value` everywhere, in m/s if nothing else is said."""
    return dimensions, np.full(shape, value), {**MS, **attributes}


def everything(path: Path) -> tuple[FieldIndex, list[tuple[Field2D, FloatArray]]]:
    """The index of a file, and all its fields with their whole values."""
    with open_netcdf(path) as index:
        return index, [(field2d, whole(field2d)) for field2d in index.fields]


def whole(field2d: Field2D) -> FloatArray:
    """All values of a field."""
    return field2d.read(np.arange(field2d.grid.shape[0]), np.arange(field2d.grid.shape[1]))
