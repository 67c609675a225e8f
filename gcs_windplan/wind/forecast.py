"""What is asked of forecast files, and what comes of them: winds of one or more members."""

from __future__ import annotations

import math
from dataclasses import dataclass, field, replace
from datetime import datetime
from functools import cached_property

from gcs_windplan.geo.frame import LocalFrame
from gcs_windplan.wind.field import Ground
from gcs_windplan.wind.field_index import Level
from gcs_windplan.wind.gridded import GriddedWind, mean_of
from gcs_windplan.wind.pairing import Members
from gcs_windplan.wind.placement import Box


@dataclass(frozen=True, slots=True)
class ForecastQuery:
    """What a reader of forecasts is asked for.

    `area` (west, south, east, north in the local frame [m]) is where wind will be asked for: what lies more than a cell
    outside of it is not read. `departure`, with its time zone, and `lasting` [s] choose the times. `ground` is the
    terrain under the route. `extend` takes the wind at the edge for places outside of the grid.

    `exponent` or `roughness` [m], one of them, is the law below the lowest level; without either it is a log law with
    the file's own roughness, or 0.1 m. `carried`: the law also carries the wind above levels that are all above the
    ground. `known_height` [m above ground] is that of a level whose height the file does not tell.
    """

    frame: LocalFrame
    ground: Ground | None = None
    departure: datetime | None = None
    lasting: float = 24 * 3600.0
    area: Box | None = None
    extend: bool = False
    members: Members = None
    exponent: float | None = None
    roughness: float | None = None
    carried: bool = False
    known_height: float | None = None
    ground_resolution: float = math.inf


@dataclass(frozen=True, eq=False)
class Forecast:
    """Winds of one or more members on one grid; `fields` in the order of `members`.

    A forecast without an ensemble has one field, its member is None. `levels` are those of the fields' columns. `gusts`
    (times, rows, columns) [m/s] is one field a member, as `Columns` with the gust in place of u, or empty where the
    files have none. `notes` tell what was made of the files.

    >>> import gcs_windplan as gw
    >>> forecast = gw.read_forecast(
    ...     "missions/wind/front_synthetic.nc", (36.55, -84.25), terrain="sample:jacksboro", members=[0, 1],
    ...     departure="2026-05-01T08:00Z", lasting=3600.0, radius=2000.0,
    ... )
    >>> len(forecast.fields)
    2
    """

    name: str
    members: tuple[int | None, ...]
    fields: tuple[GriddedWind, ...]
    levels: tuple[Level, ...] = ()
    runs: tuple[float, ...] = ()
    notes: tuple[str, ...] = ()
    gusts: tuple[GriddedWind, ...] = field(default=(), repr=False)

    @cached_property
    def mean(self) -> GriddedWind:
        """The mean of all members: winds and heights averaged."""
        if len(self.fields) == 1:
            return self.fields[0]
        return replace(mean_of(self.fields), name=f"{self.name}, mean of {len(self.fields)} members")
