"""What the coordinates of a NetCDF file count: by CF standard name first, then by units, then by names in common use.

Sources: CF Conventions 1.11, section 4 and appendix D; the names that ECMWF's, NCEP's, DWD's and Unidata's tools write.
"""

from __future__ import annotations

import re
from typing import Literal, TypeAlias

from gcs_windplan.wind.files.cf import Variable
from gcs_windplan.wind.files.units import PRESSURE, compact

#: x and y: along a grid that is not made of parallels and meridians. run: when a model began. period: hours since then.
#: height: above the ground; altitude: above mean sea level. version: ERA5's `expver`.
Role: TypeAlias = Literal[
    "latitude", "longitude", "x", "y", "time", "run", "period", "member", "version", "height", "altitude", "pressure",
    "model", "depth",
]  # fmt: skip

LEVELS: tuple[Role, ...] = ("height", "altitude", "pressure", "model")
CLOCK: tuple[Role, ...] = ("time", "run", "period")

_STANDARD: dict[str, Role] = {
    "latitude": "latitude", "longitude": "longitude",
    "grid_latitude": "y", "projection_y_coordinate": "y", "grid_longitude": "x", "projection_x_coordinate": "x",
    "time": "time", "forecast_reference_time": "run", "forecast_period": "period", "realization": "member",
    "height": "height", "altitude": "altitude", "height_above_mean_sea_level": "altitude",
    "height_above_geopotential_datum": "altitude", "air_pressure": "pressure", "depth": "depth",
    "model_level_number": "model", "hybrid_sigma_pressure": "model",
}  # fmt: skip
_NAMES: tuple[tuple[str, Role], ...] = (
    (r"x?lat(itude)?s?(_[a-z])?|nav_lat|gridlat_\d+", "latitude"),
    (r"x?long?(itude)?s?(_[a-z])?|nav_lon|gridlon_\d+", "longitude"),
    (r"y|yc|y_?\d+|rlat|grid_latitude|south_north|projection_y_coordinate", "y"),
    (r"x|xc|x_?\d+|rlon|grid_longitude|west_east|projection_x_coordinate", "x"),
    (r"number|member|realization|ensemble|ensemble_member|ens\d*", "member"),
    (r"expver", "version"),
    (r"step|lead|lead_?time|forecast_period|forecast_hour|fhour|prediction_timedelta|time_?offset\d*", "period"),
    (r"plev\d*|isobaric.*|pressure(_level)?s?", "pressure"),
    (r"alt(itude)?(_above_msl)?\d*|heightabovesea", "altitude"),
    (r"height.*|hag|agl", "height"),
    (r"hybrid\d*|mlev|model_?level(_number)?s?|generalvertical(layer)?", "model"),
    (r"depth.*", "depth"),
)
_RUN = r"(forecast_)?ref(erence)?_?time\d*|run_?time|run|base_?time|analysis_time|init(ial)?(ization)?_?time"


def role(variable: Variable) -> Role | None:
    """What a coordinate counts, None where that is not known."""
    standard = variable.text("standard_name")
    if standard == "height" and "generalized" in variable.text("long_name"):
        return "model"  # the numbers of ICON's levels
    if standard in _STANDARD:
        return _STANDARD[standard]
    if standard.startswith("atmosphere_"):  # CF appendix D: sigma and hybrid coordinates
        return "model"
    if standard and standard != "unknown":
        return None
    return _by_units(variable) or _by_name(variable)


def _by_units(variable: Variable) -> Role | None:
    units, description = variable.text("units"), variable.text("long_name").replace("_", " ")
    if re.fullmatch(r"degrees?_?n(orth)?", units):
        return "latitude"
    if re.fullmatch(r"degrees?_?e(ast)?", units):
        return "longitude"
    if " since " in units:
        runs = re.fullmatch(_RUN, variable.name.lower()) or "reference time" in description
        return "run" if runs or variable.text("_CoordinateAxisType") == "runtime" else "time"
    if "hybrid" in description or "model level" in description:
        return "model"
    if compact(units) in PRESSURE.factors:
        return "pressure"
    return None


def _by_name(variable: Variable) -> Role | None:
    name, description = variable.name.lower(), variable.text("long_name").replace("_", " ")
    if "ellipsoid" in name + description:
        return None
    axis = variable.text("_CoordinateAxisType")
    if axis in ("geox", "geoy"):
        return "x" if axis == "geox" else "y"
    for pattern, found in _NAMES:
        if re.fullmatch(pattern, name):
            return "altitude" if found == "height" and "sea level" in description else found
    if "sea level" in description:
        return "altitude"
    axes: dict[str, Role] = {"x": "x", "y": "y"}
    return axes.get(variable.text("axis"))
