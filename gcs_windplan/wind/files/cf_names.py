"""What the variables of a NetCDF file hold: by CF standard name first, then by names in common use.

Sources: CF standard name table 86; the names that ECMWF's, NCEP's, DWD's and Unidata's tools, wgrib2, GrADS and WRF
write. A name falls in two, what is meant and at which level: `UGRD_80maboveground`, `u10`, `10u`, `u_component_of_wind_
isobaric`. What is left over in no such way (`wind_speed_sd`, `UGRD_tropopause`) is no wind that can be used.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping
from dataclasses import dataclass

from gcs_windplan.wind.field_index import SURFACE, Level, Quantity
from gcs_windplan.wind.files.cf import Variable
from gcs_windplan.wind.files.units import is_something_else

WIND: tuple[Quantity, ...] = ("u", "v", "speed", "direction")


@dataclass(frozen=True, slots=True)
class Meaning:
    """What a variable holds.

    `level` as its name states with a unit, `guess` as it tells less clearly, if they do. `along_grid` as far as told.
    `towards`: the direction is where the wind goes; `logarithm`: of the pressure.
    """

    quantity: Quantity
    level: Level | None = None
    guess: Level | None = None
    along_grid: bool | None = None
    towards: bool = False
    logarithm: bool = False


_STANDARD: Mapping[str, Quantity] = {
    "eastward_wind": "u", "x_wind": "u", "grid_eastward_wind": "u",
    "northward_wind": "v", "y_wind": "v", "grid_northward_wind": "v",
    "wind_speed": "speed", "wind_from_direction": "direction", "wind_to_direction": "direction",
    "wind_speed_of_gust": "gust", "geopotential": "height", "geopotential_height": "height",
    "geometric_height_at_full_level_center": "height",
    "surface_altitude": "terrain", "surface_geopotential": "terrain", "surface_geopotential_height": "terrain",
    "surface_roughness_length": "roughness", "surface_roughness_length_for_momentum_in_air": "roughness",
    "air_temperature": "temperature", "specific_humidity": "humidity", "surface_air_pressure": "pressure",
}  # fmt: skip
_BASES: Mapping[Quantity, str] = {
    "u": r"u|ua|uas|uu|u_?grd(prs)?|u_?wnd|u_?wind|wind_?u|u_component|u_component_of_wind|u_wind_component"
    r"|wind_u_component|zonal_wind|eastward_wind|x_wind",
    "v": r"v|va|vas|vv|v_?grd(prs)?|v_?wnd|v_?wind|wind_?v|v_component|v_component_of_wind|v_wind_component"
    r"|wind_v_component|meridional_wind|northward_wind|y_wind",
    "speed": r"ws|wspd|wind|wspeed|wind_?sp(ee)?d|si|sfcwind|ff",
    "direction": r"wd|wdir|wind_?dir(ection)?|wind_(from|to)_direction|wind_direction_from_which_blowing|dd",
    "gust": r"(wind_?)?gusts?|gust_?speed|wind_?(speed_)?(of_)?gusts?(_speed)?|vmax|i?fg\d?|i10fg|wsgsmax",
    "height": r"z|gh|zg|hgt(prs)?|geop(ot(ential)?)?h?|geopotential(_height)?|phi|z_mc",
    "terrain": r"orog(raphy)?|h_?surf|topo(graphy)?(_c)?|terrain(_height)?|surface_(altitude|geopotential)|phis|hgt_m"
    r"|geopotential_at_surface|elevation",
    "roughness": r"fsr|sr|z0m?|znt|sfcr|(forecast_)?surface_roughness(_length)?|roughness(_length)?",
    "temperature": r"t|ta|temp(erature)?|tmp(prs)?|air_temperature",
    "humidity": r"q|hus|qv|spfh(prs)?|specific_humidity",
    "pressure": r"sp|ps|aps|psfc|lnsp|surface_(air_)?pressure",
}
_ON_THE_GROUND = r"pres(sure)?"  # of which only the one at the surface is a quantity of ours
_AXIS_SUFFIX = r"_(height_above_ground|specified_height_level_above_ground|isobaric|altitude_above_msl|hybrid|ml|pl)"
_NUMBER = r"(?P<number>\d+(d\d+)?)"
_LEVELS: tuple[tuple[str, Callable[[float], Level]], ...] = (
    (rf"(?P<base>.+?)_?{_NUMBER}_?m_?above_?ground", lambda number: Level("height", number)),
    (rf"(?P<base>.+?)_?{_NUMBER}_?m_?above_?mean_?sea_?level", lambda number: Level("altitude", number)),
    (rf"(?P<base>.+?)_?{_NUMBER}_?(mb|hpa)", lambda number: Level("pressure", number * 100)),
    (rf"(?P<base>.+?)_?{_NUMBER}_?m(et(er|re)s?)?", lambda number: Level("height", number)),
    (rf"{_NUMBER}_?m_(?P<base>.+)", lambda number: Level("height", number)),
)
_BARE = (
    r"(?P<base>ua?|va?|wspd|wdir|ws|wd|si|ff|dd|zg?|gh|hgt|gust)_?(?P<number>\d{2,4})",
    r"(?P<base>fg)3?(?P<number>10)",
    r"(?P<number>\d{2,3})(?P<base>u|v|si|ws|wdir|fg)3?",
    r"i(?P<number>10)(?P<base>fg)",
)
_ODD_WORDS = (
    "sd", "std", "stddev", "stdev", "spread", "error", "err", "stderr", "uncertainty", "variance", "percent",
    "percentile", "pct", "quantile", "prob", "probability", "anomaly", "anom", "tendency", "qc", "flag", "count",
    "bias", "increment", "min", "minimum",
)  # fmt: skip
_MODIFIERS = ("standard_error", "detection_minimum", "number_of_observations", "status_flag")  # CF, appendix C
_ODD_PHRASES = re.compile(
    r"standard deviation|\bstd\b|\bspread\b|\berror|uncertaint|variance|percent|quantile|probabilit|anomal|\bneutral\b"
    r"|stokes|current|sea water|ocean|stress|tendency|\bshear\b|geostrophic|increment|minimum|\bstatus\b"
)
_ODD_METHODS = re.compile(r"standard_deviation|variance|minimum|\brange\b|\bmode\b|median")
_WINDY = re.compile(r"[uv]_?(grd|wnd|wind|component).*|.*wind.*(speed|dir|comp).*|.*gust.*|[uv]a?_.*|w(sp?d?|dir)_.*")


def meaning(variable: Variable) -> Meaning | None:
    """What a variable holds, None if it is none of our quantities or only tells how sure one is."""
    base, level, guess = _split_name(variable)
    quantity = _quantity(variable, base, level)
    if quantity is None or _is_odd(variable, quantity) or is_something_else(variable.raw_text("units"), quantity):
        return None
    description = f"{variable.text('long_name')} {variable.name.lower()} {variable.text('standard_name')}"
    description = re.sub("[_-]", " ", description)
    return Meaning(
        quantity=quantity,
        level=level,
        guess=guess,
        along_grid=_along_grid(variable, description) if quantity in ("u", "v") else None,
        towards=quantity == "direction" and bool(re.search(r"wind to direction|towards?\b|to which", description)),
        logarithm=quantity == "pressure" and bool(re.search(r"\blnsp\b|logarithm", description)),
    )


def looks_like_wind(variable: Variable) -> bool:
    """Whether a variable without a meaning will be missed by those who read its name."""
    standard = variable.text("standard_name")
    return standard.split(" ")[0] in _STANDARD or (not standard and bool(_WINDY.fullmatch(_plain(variable.name))))


def _quantity(variable: Variable, base: str, level: Level | None) -> Quantity | None:
    standard = variable.text("standard_name")
    if standard in _STANDARD:
        return _STANDARD[standard]
    if standard not in ("", "unknown") and ("wind" not in standard or standard.endswith(_MODIFIERS)):
        return None  # the ocean's currents are called u and v too
    if re.fullmatch(_ON_THE_GROUND, base):
        return "pressure" if level == SURFACE else None
    for quantity, pattern in _BASES.items():
        if re.fullmatch(pattern, base):
            return "terrain" if quantity == "height" and level == SURFACE else quantity
    return None


def _is_odd(variable: Variable, quantity: Quantity) -> bool:
    """Whether a variable is a statistic of the quantity, or of water."""
    words = set(re.split(r"[\W_]+", variable.name.lower()))
    description = f"{variable.text('long_name')} {variable.text('standard_name')}".replace("_", " ")
    methods = f"{variable.text('cell_methods')} {variable.text('GRIB_stepType')}"
    statistics = variable.text("Grib_Statistical_Interval_Type")
    if words & set(_ODD_WORDS) or _ODD_PHRASES.search(description) or _ODD_METHODS.search(methods):
        return True
    strongest = words & {"max", "maximum"} or "max" in f"{description} {methods} {statistics}"
    return bool(strongest) and quantity != "gust"


def _along_grid(variable: Variable, description: str) -> bool | None:
    """Whether a component follows the grid, None where nothing tells. What the GRIB message said goes first."""
    relative = variable.numbers("GRIB_uvRelativeToGrid")
    if relative:
        return bool(relative[0])
    if re.search(r"\b(grid (east|north)ward|[xy] wind|[xy] component|grid relative|along the grid)", description):
        return True
    if re.search(r"\b(east|north)ward|\bzonal|\bmeridional|earth relative|true (east|north)", description):
        return False
    return None


def _split_name(variable: Variable) -> tuple[str, Level | None, Level | None]:
    """What is meant, the level that the name or wgrib2's `level` states with its unit, and one that can be guessed."""
    name = _plain(variable.name)
    for pattern, made in _LEVELS:
        match = re.fullmatch(pattern, name)
        if match and (number := float(match["number"].replace("d", "."))) > 0:
            return match["base"], made(number), None
    match = re.fullmatch(r"(?P<base>.+?)_?(surface|sfc)", name)
    if match and name != "psfc":
        return match["base"], SURFACE, None
    name = re.sub(rf"{_AXIS_SUFFIX}\d*$", "", name)
    for pattern in _BARE:
        match = re.fullmatch(pattern, name)
        if match:
            return (
                match["base"],
                _level_in_attribute(variable),
                _level_of_number(variable, match["base"], float(match["number"])),
            )
    return name, _level_in_attribute(variable), _level_in_long_name(variable, name)


def _level_of_number(variable: Variable, base: str, number: float) -> Level:
    """The level of `u10`, `u100`, `u850` or `z500`: hPa where no metres can be meant or the text says so."""
    pressure = number >= 250 or base in ("z", "zg", "gh", "hgt")
    if pressure or re.search(r"hpa|\bmb|mbar|pressure", variable.text("long_name")):
        return Level("pressure", number * 100)
    return Level("height", number)


def _level_in_attribute(variable: Variable) -> Level | None:
    """What wgrib2 writes into `level`."""
    text = variable.text("level")
    if text == "surface":
        return SURFACE
    match = re.fullmatch(r"(\d+(?:\.\d+)?) (m above ground|mb|m above mean sea level)", text)
    if not match:
        return None
    number = float(match[1])
    if match[2] == "mb":
        return Level("pressure", number * 100)
    return Level("height" if match[2] == "m above ground" else "altitude", number)


def _level_in_long_name(variable: Variable, base: str) -> Level | None:
    """What a long name tells of heights or pressures: `10 metre U wind component`, `U at 10 M`, `at 850 mb`."""
    text = variable.text("long_name") or variable.text("description")  # WRF's word for it
    match = re.search(r"(?<![\d.])(\d+)[ -]?(m|met(?:er|re)s?|hpa|mb|mbar|millibars?)\b(?! ?(s|/))", text)
    if match:
        number = float(match[1])
        return (
            Level("height", number)
            if match[2].startswith("m") and match[2][1:2] not in ("b", "i")
            else Level("pressure", number * 100)
        )
    near_surface = base in ("uas", "vas", "sfcwind")  # CMIP: "near-surface (usually, 10 meters)"
    return Level("height", 10.0) if near_surface else None


def _plain(name: str) -> str:
    return name.lower().replace("-", "_").replace(".", "_")
