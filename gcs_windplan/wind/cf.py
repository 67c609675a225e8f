"""What the variables of a wind file are: by CF standard names first, then by names and units in common use.

Sources: CF Conventions 1.11, sections 4 and appendix on standard names; the names that ECMWF's, NCEP's and
Unidata's tools write. Nothing here opens a file.
"""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Literal, TypeAlias

import numpy as np

from gcs_windplan.errors import WindError
from gcs_windplan.wind.units import LENGTH, PRESSURE, SPEED, compact, unit_of

#: What an axis counts: heights are above the ground, altitudes above mean sea level.
AxisKind: TypeAlias = Literal["latitude", "longitude", "time", "height", "altitude", "pressure"]

LEVEL_KINDS: tuple[AxisKind, ...] = ("height", "altitude", "pressure")


@dataclass(frozen=True, slots=True)
class Variable:
    """What a file says about one variable, without its values."""

    name: str
    dimensions: tuple[str, ...]
    shape: tuple[int, ...]
    attributes: Mapping[str, object]

    def text(self, attribute: str) -> str:
        """A text attribute in lower case, empty where there is none."""
        return self.told(attribute).lower()

    def told(self, attribute: str) -> str:
        """A text attribute as it stands, empty where there is none."""
        value = self.attributes.get(attribute, "")
        if isinstance(value, list | tuple | np.ndarray) and np.size(value) == 1:
            value = np.ravel(np.asarray(value, dtype=object))[0]
        if isinstance(value, bytes):
            value = value.decode("latin-1")
        return value.strip() if isinstance(value, str) else ""

    def numbers(self, attribute: str) -> tuple[float, ...]:
        """The numbers of an attribute, empty where there are none."""
        value = self.attributes.get(attribute, ())
        words = value.replace(",", " ").split() if isinstance(value, str) else np.atleast_1d(np.asarray(value)).ravel()
        try:
            return tuple(float(word) for word in words)
        except (TypeError, ValueError):
            return ()


File: TypeAlias = Mapping[str, Variable]

_STANDARD_AXES: dict[str, AxisKind] = {
    "latitude": "latitude",
    "longitude": "longitude",
    "time": "time",
    "height": "height",
    "altitude": "altitude",
    "height_above_mean_sea_level": "altitude",
    "height_above_geopotential_datum": "altitude",
    "air_pressure": "pressure",
}
_COMPONENTS = {
    "u": re.compile(r"u|ua|uas|uu|u\d+m?|\d+u|u_?grd.*|u_?wind.*|wind_?u.*|u[-_]component_of_wind.*"),
    "v": re.compile(r"v|va|vas|vv|v\d+m?|\d+v|v_?grd.*|v_?wind.*|wind_?v.*|v[-_]component_of_wind.*"),
}
_STANDARD_WINDS = {"u": ("eastward_wind", "x_wind"), "v": ("northward_wind", "y_wind")}
_SWAPS = (("eastward", "northward"), ("x_wind", "y_wind"), ("u", "v"))


def speed_unit(variable: Variable) -> float:
    """The unit of a wind component [m/s]. Raises `WindError` if it is missing or unknown."""
    return unit_of(variable.name, variable.told("units"), SPEED)


def axis_unit(variable: Variable, kind: AxisKind) -> float:
    """The unit of an axis in degrees, metres or pascals. Raises `WindError` if a level's is unknown."""
    if kind == "pressure":
        return unit_of(variable.name, variable.told("units"), PRESSURE)
    if kind in LEVEL_KINDS:
        return unit_of(variable.name, variable.told("units"), LENGTH)
    return 1.0


def is_geopotential(variable: Variable) -> bool:
    """Whether the variable is the geopotential [m²/s²] rather than a height."""
    return compact(variable.text("units")) in {"m2s-2", "m2/s2", "j/kg", "jkg-1"}


def axis_kind(variable: Variable) -> AxisKind | None:
    """What a coordinate counts, None where that is not known."""
    standard, units, name = variable.text("standard_name"), variable.text("units"), variable.name.lower()
    if standard:
        return _STANDARD_AXES.get(standard)
    if re.fullmatch(r"degrees?_?n(orth)?", units) or name in ("lat", "latitude"):
        return "latitude"
    if re.fullmatch(r"degrees?_?e(ast)?", units) or name in ("lon", "long", "longitude"):
        return "longitude"
    if " since " in units:
        return "time"
    if units in PRESSURE.sizes:
        return "pressure"
    if name in ("altitude", "alt") or "sea level" in variable.text("long_name"):
        return "altitude"
    if re.match(r"height|hag|agl", name):
        return "height"
    return None


def coordinate_of(file: File, dimension: str) -> tuple[AxisKind, Variable] | None:
    """The coordinate variable along a dimension and what it counts; the one of the same name goes first."""
    named = [file[dimension]] if dimension in file else []
    for variable in [*named, *file.values()]:
        long = [d for d, size in zip(variable.dimensions, variable.shape, strict=True) if size > 1]
        along = dimension in variable.dimensions and set(long) <= {dimension}
        kind = axis_kind(variable) if along else None
        if kind is not None:
            return kind, variable
    return None


def scalar_time(file: File) -> Variable | None:
    """The one time that holds for the whole file, where there is just one."""
    found = [v for v in file.values() if not v.dimensions and axis_kind(v) == "time"]
    return found[0] if len(found) == 1 else None


def find_winds(file: File) -> tuple[Variable, Variable]:
    """The eastward and the northward wind of a file.

    Of several pairs the one with the most values is taken, then the one that names the greater height (u100
    before u10). Raises `WindError` where one or both are missing.
    """
    us, vs = ([v for v in file.values() if _is_component(v, c)] for c in ("u", "v"))
    if not us and not vs:
        raise WindError(_nothing_found(file))
    for have, lack, which in ((us, vs, ("u", "v")), (vs, us, ("v", "u"))):
        if not lack:
            raise WindError(f"has {which[0]} ({have[0].name}) but no {which[1]}")
    pairs = [(u, v) for u in us for v in vs if v.name.lower() in _partners(u.name.lower())]
    return max(pairs or [(us[0], vs[0])], key=_rank)


def find_geopotential(file: File, levels: str) -> Variable | None:
    """The geopotential or geopotential height on the pressure levels of dimension `levels`."""
    for variable in file.values():
        standard = variable.text("standard_name")
        known = standard in ("geopotential", "geopotential_height") or (
            not standard and re.fullmatch(r"z|gh|zg|hgt.*|hgtprs|geopotential.*", variable.name.lower())
        )
        if known and levels in variable.dimensions:
            return variable
    return None


def _is_component(variable: Variable, component: str) -> bool:
    standard = variable.text("standard_name")
    if len(variable.dimensions) < 2:
        return False
    if standard and standard != "unknown":  # the ocean's currents are called u and v too
        return standard in _STANDARD_WINDS[component]
    name = variable.name.lower()
    return name in _STANDARD_WINDS[component] or bool(_COMPONENTS[component].fullmatch(name))


def _partners(name: str) -> list[str]:
    """The names that the northward wind may bear where the eastward one is called `name`."""
    return [
        name[: match.start()] + north + name[match.end() :]
        for east, north in _SWAPS
        for match in re.finditer(east, name)
    ]


def _rank(pair: Sequence[Variable]) -> tuple[int, int]:
    values = 1
    for size in pair[0].shape:
        values *= size
    number = re.search(r"\d+", pair[0].name)
    return values, int(number.group()) if number else 0


def _nothing_found(file: File) -> str:
    polar = [name for name in file if re.search(r"wind.*(dir|speed)|(dir|speed).*wind", name.lower())]
    if polar:
        return f"has speed and direction ({', '.join(polar)}) but no u and v: convert it first"
    names = ", ".join(list(file)[:20]) or "nothing"
    return f"has no eastward and northward wind (eastward_wind, u, u10, ugrd ...); it has {names}"
