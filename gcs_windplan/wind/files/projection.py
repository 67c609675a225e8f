"""From a projected or rotated grid's x and y to latitudes and longitudes, by its CF grid mapping.

Latitudes and longitudes are those on the mapping's own sphere or ellipsoid: weather services take them as they are for
WGS 84, so that there is no shift of datum. rasterio is imported when it is needed.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping

import numpy as np

from gcs_windplan.arrays import FloatArray
from gcs_windplan.errors import WindError
from gcs_windplan.wind.files.cf import Variable
from gcs_windplan.wind.files.units import ANGLE, LENGTH, unit_factor

_EARTH = 6371229.0  # [m] where the file does not tell: WMO-No. 306, volume I.2, code table 3.2, entry 6
_ELLIPSOIDS = {"wgs 84": "WGS84", "wgs84": "WGS84", "grs 1980": "GRS80", "grs80": "GRS80"}
_ROWS = 200  # of the grid that are worked out at a time: rasterio takes lists, which need much memory


def unprojected(
    x: FloatArray, y: FloatArray, mapping: Variable, units: tuple[str, str]
) -> tuple[FloatArray, FloatArray]:
    """Latitudes and longitudes [deg] (ny, nx) of a grid with axes x (nx,) and y (ny,) in their `units`.

    Raises `WindError` for mappings and units that are not known, and places that no projection reaches.
    """
    name = mapping.text("grid_mapping_name")
    if name not in _PROJECTIONS:
        raise WindError(
            f"its grid mapping {mapping.name} is {name or 'of no name'!r}; known are {', '.join(sorted(_PROJECTIONS))}:"
            " add latitudes and longitudes of all nodes, or regrid it"
        )
    table = ANGLE if name == "rotated_latitude_longitude" else LENGTH
    across, along = (unit_factor(axis, unit, table) for axis, unit in zip(("x", "y"), units, strict=True))
    earth = _earth(mapping)
    origin = "" if table is ANGLE else _false_origin(mapping, across, along)
    projection = f"{_PROJECTIONS[name](mapping)} {origin} {earth} +no_defs"
    try:
        latitudes, longitudes = _transformed(projection, f"+proj=longlat {earth} +no_defs", x * across, y * along)
    except Exception as error:  # GDAL's own errors, which rasterio lets through, share no public ancestor
        raise WindError(f"its grid mapping {mapping.name} ({projection}) cannot be worked out: {error}") from error
    if not np.isfinite(latitudes).all() or not np.isfinite(longitudes).all():
        raise WindError(f"parts of its grid lie where its grid mapping {mapping.name} ({name}) cannot reach")
    return latitudes, longitudes


def _transformed(source: str, target: str, x: FloatArray, y: FloatArray) -> tuple[FloatArray, FloatArray]:
    from rasterio.crs import CRS
    from rasterio.warp import transform

    latitudes, longitudes = np.empty((len(y), len(x))), np.empty((len(y), len(x)))
    for first in range(0, len(y), _ROWS):
        rows = slice(first, first + _ROWS)
        xs, ys = np.meshgrid(x, y[rows])
        east, north = transform(CRS.from_proj4(source), CRS.from_proj4(target), xs.ravel(), ys.ravel())
        longitudes[rows], latitudes[rows] = np.reshape(east, xs.shape), np.reshape(north, xs.shape)
    return latitudes, longitudes


def _number(mapping: Variable, *names: str, otherwise: float | None = None) -> float:
    for name in names:
        if found := mapping.numbers(name):
            return found[0]
    if otherwise is None:
        raise WindError(f"its grid mapping {mapping.name} has no {' or '.join(names)}: set it")
    return otherwise


def _earth(mapping: Variable) -> str:
    """The sphere or ellipsoid."""
    radius = mapping.numbers("earth_radius")
    major = mapping.numbers("semi_major_axis")
    minor = mapping.numbers("semi_minor_axis")
    flattening = mapping.numbers("inverse_flattening")
    if radius or (major and not minor and not any(flattening)):
        return f"+R={(radius or major)[0]:.12g}"
    if major:
        return f"+a={major[0]:.12g} " + (f"+b={minor[0]:.12g}" if minor else f"+rf={flattening[0]:.12g}")
    named = _ELLIPSOIDS.get(mapping.text("reference_ellipsoid_name"))
    return f"+ellps={named}" if named else f"+R={_EARTH}"


def _false_origin(mapping: Variable, across: float, along: float) -> str:
    """The false easting and northing, which are in the units of x and y (CF appendix F)."""
    east = _number(mapping, "false_easting", otherwise=0.0) * across
    north = _number(mapping, "false_northing", otherwise=0.0) * along
    return f"+x_0={east:.12g} +y_0={north:.12g} +units=m"


def _parallels(mapping: Variable) -> str:
    found = mapping.numbers("standard_parallel")
    if not 1 <= len(found) <= 2:
        raise WindError(f"its grid mapping {mapping.name} has {len(found)} standard parallels, not one or two")
    return f"+lat_1={found[0]:.12g} +lat_2={found[-1]:.12g}"


def _conic(proj: str) -> Callable[[Variable], str]:
    def written(mapping: Variable) -> str:
        centre = _number(mapping, "longitude_of_central_meridian", "longitude_of_projection_origin")
        origin = _number(mapping, "latitude_of_projection_origin")
        return f"+proj={proj} {_parallels(mapping)} +lat_0={origin:.12g} +lon_0={centre:.12g}"

    return written


def _polar(mapping: Variable) -> str:
    centre = _number(mapping, "straight_vertical_longitude_from_pole", "longitude_of_projection_origin")
    pole = _number(mapping, "latitude_of_projection_origin")
    return f"+proj=stere +lat_0={pole:.12g} +lon_0={centre:.12g} {_true_scale(mapping)}"


def _mercator(mapping: Variable) -> str:
    centre = _number(mapping, "longitude_of_projection_origin", "longitude_of_central_meridian")
    return f"+proj=merc +lon_0={centre:.12g} {_true_scale(mapping)}"


def _true_scale(mapping: Variable) -> str:
    if parallel := mapping.numbers("standard_parallel"):
        return f"+lat_ts={parallel[0]:.12g}"
    return f"+k_0={_number(mapping, 'scale_factor_at_projection_origin', otherwise=1.0):.12g}"


def _azimuthal(mapping: Variable) -> str:
    centre = _number(mapping, "longitude_of_projection_origin")
    origin = _number(mapping, "latitude_of_projection_origin")
    return f"+proj=laea +lat_0={origin:.12g} +lon_0={centre:.12g}"


def _transverse(mapping: Variable) -> str:
    centre = _number(mapping, "longitude_of_central_meridian")
    origin = _number(mapping, "latitude_of_projection_origin")
    scale = _number(mapping, "scale_factor_at_central_meridian", otherwise=1.0)
    return f"+proj=tmerc +lat_0={origin:.12g} +lon_0={centre:.12g} +k={scale:.12g}"


def _rotated(mapping: Variable) -> str:
    latitude = _number(mapping, "grid_north_pole_latitude")
    longitude = _number(mapping, "grid_north_pole_longitude")
    turn = _number(mapping, "north_pole_grid_longitude", otherwise=0.0)
    return f"+proj=ob_tran +o_proj=longlat +o_lon_p={turn:.12g} +o_lat_p={latitude:.12g} +lon_0={longitude + 180:.12g}"


_PROJECTIONS: Mapping[str, Callable[[Variable], str]] = {
    "lambert_conformal_conic": _conic("lcc"),
    "albers_conical_equal_area": _conic("aea"),
    "lambert_azimuthal_equal_area": _azimuthal,
    "mercator": _mercator,
    "polar_stereographic": _polar,
    "rotated_latitude_longitude": _rotated,
    "transverse_mercator": _transverse,
}
