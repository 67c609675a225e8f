"""Where the nodes of a GRIB grid are, and in which order its values are stored."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from gcs_windplan.arrays import FloatArray
from gcs_windplan.errors import WindError
from gcs_windplan.wind.field_index import Grid
from gcs_windplan.wind.files.grib_keys import Unused, degrees_of, number_of, numbers_of, put, text_of

_MOST = 200_000_000  # nodes of a grid: more than any forecast has, fewer than memory holds
_GRIDS = {
    "regular_ll": "latitude-longitude", "rotated_ll": "rotated latitude-longitude", "regular_gg": "Gaussian",
    "mercator": "Mercator", "lambert": "Lambert conformal", "polar_stereographic": "polar stereographic",
    "lambert_azimuthal_equal_area": "Lambert equal-area",
}  # fmt: skip
_OTHER_GRIDS = {
    "reduced_gg": ("a reduced Gaussian grid", "cdo setgridtype,regular"),
    "sh": ("spherical harmonics", "cdo sp2gpl"),
    "unstructured_grid": ("an unstructured grid", "cdo remapnn,r360x180"),
}
_WESTWARD, _NORTHWARD, _BY_COLUMNS, _TO_AND_FRO, _STAGGERED = 128, 64, 32, 16, 15  # edition 2, table 3.4
_ROUNDING = {1: 5e-4, 2: 5e-7}  # [deg] of angles, by edition


@dataclass(frozen=True, slots=True, eq=False)
class GribLayout:
    """A grid, and how the file stores the values (rows, columns) of `shape` on it."""

    grid: Grid
    shape: tuple[int, int]
    scanning: int
    mapped: bool


def layout_of(handle: int) -> GribLayout:
    """The grid of a field and how it is stored. Raises `Unused` for grids that are not read."""
    kind, scanning = text_of(handle, "gridType"), number_of(handle, "scanningMode")
    if kind not in _GRIDS:
        grid, tool = _OTHER_GRIDS.get(kind, (f"a grid of type {kind}", "cdo remapbil,r360x180"))
        raise Unused(f"on {grid}: not read; ask for a regular grid, or make one, for example with `{tool}`")
    if number_of(handle, "edition") == 1:
        scanning &= _WESTWARD | _NORTHWARD | _BY_COLUMNS
    if scanning & _STAGGERED:
        raise Unused("on a staggered grid: not read; ask for a regular grid")
    shape = number_of(handle, "Nj"), number_of(handle, "Ni")
    name = f"{_GRIDS[kind]} grid, {shape[0]} x {shape[1]}"
    if not 0 < shape[0] * shape[1] == number_of(handle, "numberOfDataPoints") <= _MOST:
        raise WindError(f"its grid ({name}) is damaged, or too large: download it again, or take a part of it")
    nodes = _lines(handle, shape, scanning) if kind.endswith("_ll") else _nodes(handle, kind, shape, scanning)
    if kind == "rotated_ll":
        nodes = _unrotated(handle, *nodes)
    return GribLayout(Grid(*nodes, name), shape, scanning, mapped=not kind.startswith("regular"))


def in_order(stored: FloatArray, shape: tuple[int, int], scanning: int) -> FloatArray:
    """Values (rows, columns) with columns along x and rows along y, from values in the order of the file."""
    rows, columns = shape
    values = stored.reshape((columns, rows) if scanning & _BY_COLUMNS else (rows, columns))
    if scanning & _TO_AND_FRO:
        values = values.copy()
        values[1::2] = values[1::2, ::-1]
    if scanning & _BY_COLUMNS:
        values = values.T
    return values[:: 1 if scanning & _NORTHWARD else -1, :: -1 if scanning & _WESTWARD else 1]


def _lines(handle: int, shape: tuple[int, int], scanning: int) -> tuple[FloatArray, FloatArray]:
    """The latitudes of the rows and the longitudes of the columns [deg] of a latitude-longitude grid.

    They are laid out between the first and the last, since edition 1 rounds their steps to 0.001 degrees; a last
    longitude is not trusted where the steps go just once round the globe. Raises `WindError` where they disagree.
    """
    rows, columns = shape
    south, north = (degrees_of(handle, f"latitudeOf{end}GridPoint") for end in ("First", "Last"))
    first, last = (degrees_of(handle, f"longitudeOf{end}GridPoint") for end in ("First", "Last"))
    turn = -1 if scanning & _WESTWARD else 1
    width = turn * (last - first) % 360.0 or 360.0 * (columns > 1)
    step = degrees_of(handle, "iDirectionIncrement") if number_of(handle, "iDirectionIncrementGiven") else 0.0
    if abs(step * columns - 360.0) < 1e-6:
        width = 360.0 - step
    elif step > 0 and abs(step * (columns - 1) - width) > step / 2 + columns * _ROUNDING[number_of(handle, "edition")]:
        raise WindError(
            f"its {columns} longitudes in steps of {step:g} degrees do not span {width:g}: take another file"
        )
    longitudes = first + turn * np.linspace(0.0, width, columns)
    return np.linspace(south, north, rows)[:: 1 if scanning & _NORTHWARD else -1], longitudes[::turn]


def _unrotated(handle: int, latitudes: FloatArray, longitudes: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Geographic latitudes and longitudes [deg] (rows, columns) of a grid about another pole. Raises `Unused`."""
    if degrees_of(handle, "angleOfRotation") != 0:
        raise Unused("on a grid that is turned about its own pole: not read; ask for a regular grid")
    tilt = np.radians(90.0 + degrees_of(handle, "latitudeOfSouthernPole"))
    phi, lam = np.radians(latitudes)[:, np.newaxis], np.radians(longitudes)
    x, y, z = np.cos(phi) * np.cos(lam), np.cos(phi) * np.sin(lam), np.sin(phi) + 0.0 * lam
    north = np.degrees(np.arcsin(np.clip(np.sin(tilt) * x + np.cos(tilt) * z, -1.0, 1.0)))
    east = np.degrees(np.arctan2(y, np.cos(tilt) * x - np.sin(tilt) * z))
    return north, east + degrees_of(handle, "longitudeOfSouthernPole")


def _nodes(handle: int, kind: str, shape: tuple[int, int], scanning: int) -> tuple[FloatArray, FloatArray]:
    """Latitudes and longitudes [deg] of a grid's rows and columns, or of all its nodes where it is projected."""
    put(handle, "jPointsAreConsecutive", 0)
    sign, shift, flip = _mirrored(handle, kind, scanning)
    flags = scanning & (_WESTWARD | _NORTHWARD)
    latitudes = in_order(flip * numbers_of(handle, "latitudes"), shape, flags)
    longitudes = in_order(sign * (numbers_of(handle, "longitudes") - shift), shape, flags)
    if np.ptp(latitudes, axis=1).max() < 1e-9 and np.ptp(longitudes, axis=0).max() < 1e-9:
        return latitudes[:, 0], longitudes[0]
    return latitudes, longitudes


def _mirrored(handle: int, kind: str, scanning: int) -> tuple[float, float, float]:
    """Makes the first node of a projected grid its lower left corner, by mirroring the globe where it is another.

    eccodes (up to 2.42) lays these grids out to the right and upwards from their first node, whichever way they are
    stored. Returns sign, shift [deg] and flip: of what eccodes then gives, sign * (longitude - shift) is the true
    longitude and flip * latitude the true latitude. Raises `Unused`.
    """
    if kind not in ("lambert", "polar_stereographic", "mercator"):
        return 1.0, 0.0, 1.0
    polar, first = kind == "polar_stereographic", number_of(handle, "edition") == 1
    south = polar and number_of(handle, "projectionCentreFlag") & 128
    if polar and (number_of(handle, "earthIsOblate") or (south and first)):
        raise Unused("on a polar stereographic grid, southern or on an ellipsoid: not read; ask for a regular grid")
    if kind == "mercator" and degrees_of(handle, "orientationOfTheGrid") != 0:
        raise Unused("on an oblique Mercator grid: not read; ask for a regular grid")
    twice = 0.0 if kind == "mercator" else 2.0 * degrees_of(handle, "orientationOfTheGrid" if polar else "LoV")
    sign, shift, flip = (-1.0, twice, 1.0) if scanning & _WESTWARD else (1.0, 0.0, 1.0)
    if not scanning & _NORTHWARD:
        sign, shift, flip = (-sign, twice + 180.0 - shift, 1.0) if polar else (sign, shift, -1.0)
    corner = {key: degrees_of(handle, key) for key in ("latitudeOfFirstGridPoint", "longitudeOfFirstGridPoint")}
    latitude, longitude = corner
    changed = {latitude: flip * corner[latitude], longitude: (sign * corner[longitude] + shift) % 360.0}
    if south:
        changed["LaD"] = -abs(degrees_of(handle, "LaD"))
    elif kind == "lambert" and flip < 0:
        changed |= {key: -degrees_of(handle, key) for key in ("Latin1", "Latin2", *(() if first else ("LaD",)))}
    for key, value in changed.items():
        put(handle, f"{key}InDegrees", value)
    return sign, shift, flip
