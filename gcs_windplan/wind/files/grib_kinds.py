"""What a GRIB field is: its quantity, its level, and of what sort of product."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from dataclasses import replace
from typing import TypeAlias

import numpy as np

from gcs_windplan.arrays import FloatArray
from gcs_windplan.wind.field_index import Field2D, Level, LevelKind, Quantity
from gcs_windplan.wind.files.grib_file import DERIVED, ENDS, MEMBERS, PRODUCTS
from gcs_windplan.wind.files.grib_keys import UNKNOWN, Unused, number_of, text_of

#: Names that eccodes gives to parameters: ECMWF's, in capitals Deutscher Wetterdienst's, long ones from CF.
_NAMES: Mapping[Quantity, str] = {
    "u": "u U U_10M eastward_wind",
    "v": "v V V_10M northward_wind",
    "speed": "ws si SP SP_10M wind_speed",
    "direction": "wdir DD DD_10M wind_from_direction",
    "gust": "gust fg VMAX_10M wind_speed_of_gust",
    "height": "z gh h orog mterh FI FIS HSURF geopotential geopotential_height surface_altitude",
    "roughness": "sr fsr Z0 surface_roughness_length",
    "temperature": "t T",
    "humidity": "q QV",
    "pressure": "sp lnsp PS surface_air_pressure",
}
_QUANTITIES = {name: quantity for quantity, names in _NAMES.items() for name in names.split()}
_AT_HEIGHT = re.compile(r"i?(\d+)(u|v|ws|si|wdir|fg)\d*")  # 10u, 100v, i10fg, 10fg3
_OVER_TIME = re.compile("^(avg|max|min|std)_")  # as in max_i10fg
GEOPOTENTIAL = re.compile(r"m(\*\*)?2 ?/?s(\*\*)?-?2")  # its unit, as the centres spell it
_LevelsByCode: TypeAlias = Mapping[int, tuple[LevelKind, float]]
_LEVELS_1: _LevelsByCode = {  # edition 1, table 3
    1: ("surface", 0), 100: ("pressure", 100), 102: ("altitude", 0), 103: ("altitude", 1), 105: ("height", 1),
    109: ("model", 1), 110: ("model", 1), 125: ("height", 0.01), 210: ("pressure", 1),
}  # fmt: skip
_LEVELS_2: _LevelsByCode = {  # edition 2, table 4.5
    1: ("surface", 0), 100: ("pressure", 1), 101: ("altitude", 0), 102: ("altitude", 1), 103: ("height", 1),
    105: ("model", 1), 118: ("model", 1), 119: ("model", 1),
}  # fmt: skip
_LAYERS = (105, 118, 119, 150)  # two of the same enclose a model level; 150 alone is the edge of a layer
WITH_HALF_LEVELS = (105, 109, 110)
_MEANS = (0, 1)  # edition 2, table 4.7
_MAXIMUM = 2  # edition 2, table 4.10; edition 1, table 5
_INSTANT = (0, 1, 10)  # edition 1, table 5
_MEAN_TYPES = ("em", "taem")  # ECMWF's types of fields
_SPREAD_TYPES = ("es", "taes", "ses", "cm", "cs", "cr", "cd", "ep", "ef", "efi", "efic", "fp", "pb", "pd", "sot")


def found_in(handle: int) -> tuple[str, Quantity, Level]:
    """Name, quantity and level of a field. Raises `Unused`, without a reason if it is none of those wanted."""
    name = text_of(handle, "shortName")
    plain = _OVER_TIME.sub("", name)
    at_height = _AT_HEIGHT.fullmatch(plain)
    quantity = _QUANTITIES.get(at_height[2] if at_height else plain) or _QUANTITIES.get(text_of(handle, "cfName"))
    if quantity is None:
        spectral = name in ("vo", "d") and text_of(handle, "gridType") == "sh"
        raise Unused("of vorticity and divergence: make wind of them, for example with `cdo dv2uvl`" * spectral)
    level = Level("height", float(at_height[1])) if at_height else _level(handle)
    if level is None:
        lost = quantity in ("u", "v", "speed", "direction")
        raise Unused(f"of wind at no known height ({text_of(handle, 'typeOfLevel')}): not used" * lost)
    return name, *_placed(quantity, level)


def _placed(quantity: Quantity, level: Level) -> tuple[Quantity, Level]:
    """What a quantity is on its level. Raises `Unused`, without a reason, if it is not wanted there."""
    match quantity, level.kind:
        case "height", "surface":
            return "terrain", level
        case "pressure", "surface" | "model":  # ECMWF has its logarithm on model level 1
            return quantity, Level("surface")
        case ("height", "pressure" | "model") | ("temperature" | "humidity", "model") | ("roughness", "surface"):
            return quantity, level
        case "u" | "v" | "speed" | "direction" | "gust", _:
            return quantity, level
    raise Unused


def surface_of(handle: int) -> int:
    """The code of a level's kind, of the table of its edition."""
    one = number_of(handle, "edition") == 1
    return number_of(handle, "indicatorOfTypeOfLevel" if one else "typeOfFirstFixedSurface")


def _level(handle: int) -> Level | None:
    """The level of a field, None where its height cannot be told.

    It is made of the message's numbers: eccodes' `level` cuts digits off, 92550 Pa become 925 hPa, 1.5 m become 2.
    """
    first = surface_of(handle)
    if number_of(handle, "edition") == 1:
        found, value = _LEVELS_1.get(first), float(number_of(handle, "topLevel" if first == 110 else "level"))
    else:
        second = number_of(handle, "typeOfSecondFixedSurface")
        layer: tuple[LevelKind, float] | None = ("model", 1.0) if first == second and first in _LAYERS else None
        found = _LEVELS_2.get(first) if second == 255 else layer
        scaled, scale = (number_of(handle, f"scale{which}OfFirstFixedSurface") for which in ("dValue", "Factor"))
        known = UNKNOWN not in (scaled, scale)
        value = scaled / 10.0**scale if known else 0.0
        if found is not None and found[1] and not known:
            return None
    return None if found is None else Level(found[0], value * found[1])


def product_of(handle: int, quantity: Quantity) -> tuple[bool, bool]:
    """Whether a field is the mean of an ensemble, or one of its members. Raises `Unused` for other statistics."""
    kind = text_of(handle, "dataType")
    if number_of(handle, "edition") == 1:
        process = number_of(handle, "timeRangeIndicator")
        over_time, derived, member, other = process not in _INSTANT, False, kind in ("pf", "cf"), False
    else:
        template, process = (
            number_of(handle, key) for key in ("productDefinitionTemplateNumber", "typeOfStatisticalProcessing")
        )
        over_time, derived, member = template in ENDS, template in DERIVED, template in MEMBERS
        other = template not in PRODUCTS
    if over_time and not (quantity == "gust" and process == _MAXIMUM):
        raise Unused("of averages or extremes over time: not used")
    mean = kind in _MEAN_TYPES or (derived and number_of(handle, "derivedForecast") in _MEANS)
    if other or kind in _SPREAD_TYPES or (derived and not mean):
        raise Unused("of spreads, probabilities or other statistics of an ensemble: not used")
    return mean, member and not mean


def half_levels_in(pv: FloatArray) -> tuple[FloatArray, FloatArray] | None:
    """The a [Pa] and b of half levels, top down; None where the coefficients are of another kind."""
    a, b = pv[: len(pv) // 2], pv[len(pv) // 2 :]
    fit = len(a) == len(b) > 1 and (a >= 0).all() and (np.diff(b) >= 0).all() and b[0] >= 0 and abs(b[-1] - 1) < 0.01
    return (a, b) if fit else None


def with_terrain(fields: list[Field2D]) -> Iterator[Field2D]:
    """The fields, where a geopotential that is on model level 1 alone is the terrain's, as ECMWF has it."""
    levels = {
        field2d.level.value for field2d in fields if field2d.quantity == "height" and field2d.level.kind == "model"
    }
    for field2d in fields:
        if field2d.name == "z" and field2d.level == Level("model", 1.0) and levels == {1.0}:
            yield replace(field2d, quantity="terrain", level=Level("surface"), time=None, half_levels=None)
        else:
            yield field2d
