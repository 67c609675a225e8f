"""What a forecast file holds, field by field: one quantity on one level at one time in one member.

Each reader (`grib`, `netcdf`, `openmeteo`) only says which fields its file has and how to read one. What is made of
them, whatever the format, is the business of `forecast`.

    file ─ open_grib / open_netcdf / open_openmeteo ─▶ FieldIndex of 2D fields ─ assemble ─▶ Forecast ─▶ GriddedWind
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from functools import cached_property
from typing import Literal, TypeAlias

import numpy as np

from gcs_windplan.arrays import FloatArray, IntArray
from gcs_windplan.errors import WindError

#: What a field holds, always in these units once read:
#: u, v           wind [m/s] towards true east and north, or along the grid's axes (`along_grid`)
#: speed          of the wind [m/s]
#: direction      that the wind blows from [degrees, clockwise from true north]
#: gust           strongest wind [m/s]
#: height         of the level above mean sea level [m]: geopotential / 9.80665, or geopotential height
#: terrain        the forecast's own ground above mean sea level [m], a surface field
#: roughness      surface roughness length [m], a surface field
#: temperature    [K], and humidity, specific [kg/kg]: on model levels, for their heights
#: pressure       at the surface [Pa], a surface field, for the same
Quantity: TypeAlias = Literal[
    "u", "v", "speed", "direction", "gust", "height", "terrain", "roughness", "temperature", "humidity", "pressure"
]

#: height [m above ground], altitude [m above mean sea level], pressure [Pa], model [level number, 1 at the top],
#: surface [0], unknown [0]: the file does not say
LevelKind: TypeAlias = Literal["height", "altitude", "pressure", "model", "surface", "unknown"]


@dataclass(frozen=True, slots=True, order=True)
class Level:
    """A level: what it counts, and how much."""

    kind: LevelKind
    value: float = 0.0

    def __str__(self) -> str:
        match self.kind:
            case "height":
                return f"{self.value:g} m above ground"
            case "altitude":
                return f"{self.value:g} m above mean sea level"
            case "pressure":
                return f"{self.value / 100:g} hPa"
            case "model":
                return f"model level {self.value:g}"
            case "surface":
                return "surface"
        return "a height that the file does not tell"


SURFACE = Level("surface")


@dataclass(frozen=True, eq=False)
class Grid:
    """Where a field's values stand: `latitudes` and `longitudes` [deg] in the field's own order.

    Either one a row (ny,) and one a column (nx,), in any order, longitudes in any turn; or both (ny, nx) where rows and
    columns are no parallels and meridians (projected and rotated grids). `name` says what it is, for people.

    Winds along the grid: u goes along the columns, from the first to the last unless `backwards`, and v a right angle
    to the left of u, seen from above.
    """

    latitudes: FloatArray
    longitudes: FloatArray
    name: str
    backwards: bool = False

    def __post_init__(self) -> None:
        for axis in (self.latitudes, self.longitudes):
            if not axis.size or not np.isfinite(axis).all():
                raise WindError(f"the grid ({self.name}) has places that are no numbers")
        if self.latitudes.ndim != self.longitudes.ndim or (
            self.latitudes.ndim == 2 and self.latitudes.shape != self.longitudes.shape
        ):
            raise WindError(f"the grid ({self.name}) has latitudes and longitudes that do not fit together")
        if np.abs(self.latitudes).max() > 90.001:
            raise WindError(f"the grid ({self.name}) has latitudes beyond the poles")

    @property
    def regular(self) -> bool:
        """Whether rows are parallels and columns meridians."""
        return self.latitudes.ndim == 1

    @property
    def shape(self) -> tuple[int, int]:
        """Rows and columns."""
        return (len(self.latitudes), self.longitudes.shape[-1])

    @cached_property
    def key(self) -> tuple[object, ...]:
        """Equal for grids whose nodes are the same."""
        return (
            self.shape,
            self.regular,
            self.backwards,
            np.round(self.latitudes, 5).tobytes(),
            np.round(self.longitudes % 360.0, 5).tobytes(),
        )


#: Reads rows and columns, by number, of a field: (rows, columns) in the unit of its quantity, NaN where missing.
Read: TypeAlias = Callable[[IntArray, IntArray], FloatArray]


@dataclass(frozen=True, slots=True, eq=False)
class Field2D:
    """One quantity on one level at one time in one member.

    `name` and `units` as in the file. `time` is when it holds and `run` when the model that made it began [s since
    1970, UTC]; None where the file does not tell (a terrain holds always). `member` tells the members of an ensemble
    apart; None where there are none. `along_grid`: u and v follow the grid's rows and columns, not east and north.
    `half_levels` are the a [Pa] and b of all model half levels from the top down, where the file has them: model level
    k lies between half levels k - 1 and k.
    """

    quantity: Quantity
    level: Level
    grid: Grid
    read: Read = field(repr=False)
    name: str = ""
    units: str = ""
    time: float | None = None
    run: float | None = None
    member: int | None = None
    along_grid: bool = False
    half_levels: tuple[FloatArray, FloatArray] | None = field(default=None, repr=False)


@dataclass(frozen=True, slots=True, eq=False)
class FieldIndex:
    """The fields of an open file, its title and format, and what in it is no wind or cannot be used, for people.

    Only quantities named in `Quantity` are listed; `unused` says in words what was ignored for a reason that a
    pilot might want to know ("12 fields on a reduced Gaussian grid: regrid them"), not what simply is no wind.
    """

    source: str
    fields: tuple[Field2D, ...]
    title: str = ""
    unused: tuple[str, ...] = ()
    format: str = ""
