"""The winds of a forecast's files around a place, to look at or to plan in."""

from __future__ import annotations

import os
from collections.abc import Sequence
from datetime import datetime
from pathlib import Path
from typing import TYPE_CHECKING, Final, Literal

from gcs_windplan.errors import InputError, Problem
from gcs_windplan.geo.frame import GeoPoint, LocalFrame
from gcs_windplan.jobs.mission import as_moment
from gcs_windplan.jobs.places import PlaceWords, as_place
from gcs_windplan.jobs.terrains import TerrainWords, as_terrain
from gcs_windplan.jobs.winds import DAY, ForecastFiles, Surroundings, WindProfile, as_profile
from gcs_windplan.jobs.words import read_as
from gcs_windplan.terrain import Extent

if TYPE_CHECKING:
    from gcs_windplan.wind import Forecast

_RADIUS: Final = 10_000.0  # [m]


def read_forecast(
    files: str | os.PathLike[str] | Sequence[str | os.PathLike[str]],
    around: PlaceWords,
    *,
    terrain: TerrainWords,
    radius: float = _RADIUS,
    departure: datetime | str | None = None,
    lasting: float = DAY,
    members: Literal["all"] | Sequence[int] | None = None,
    extend: bool = False,
    profile: WindProfile | str | None = None,
) -> Forecast:
    """Read the winds in a forecast's files (GRIB, NetCDF, answers of Open-Meteo) within `radius` [m] of a place.

    Wind heights count from the `terrain`: its files, `sample:jacksboro`, `flat:120`, or a terrain. They are read from
    the `departure` on, or from the first time, for `lasting` [s]. `members` of an ensemble: `all`, or their numbers.
    `extend`: outside the files' area take the nearest values. `profile` (`power:0.143`, `log:0.1`) says how the wind
    changes below the lowest level. Its `mean` and each of its `fields` are winds (n, 3) [m/s], east, north and up,
    `at` points (n, 3) [m] of the local frame about the place, so many seconds after the departure.

    Raises `WindError` for files that cannot be read or do not cover place and time, or where no members of an ensemble
    were chosen (`reason` "members"), `TerrainError`, and `InputError` for words that say nothing.

    >>> import gcs_windplan as gw
    >>> forecast = gw.read_forecast(
    ...     "missions/wind/front_synthetic.nc", (36.55, -84.25), terrain="sample:jacksboro", members=[0, 1],
    ...     departure="2026-05-01T08:00Z", lasting=3600.0, radius=2000.0,
    ... )
    >>> forecast.members
    (0, 1)
    """
    place = read_as("around", lambda: as_place(around)).point
    if not isinstance(place, GeoPoint):
        raise InputError(Problem("needs a latitude and a longitude", "around"))
    frame, area = LocalFrame(place), Extent(-radius, -radius, radius, radius)
    ground = read_as("terrain", lambda: as_terrain(terrain)).load(frame, area)
    paths = [files] if isinstance(files, str | os.PathLike) else files
    chosen = members if members is None or members == "all" else tuple(map(int, members))
    source = ForecastFiles(tuple(map(Path, paths)), chosen, extend)
    when = read_as("departure", lambda: as_moment(departure))
    law = read_as("profile", lambda: as_profile(profile))
    return source.read(Surroundings(frame, ground, area, when, lasting), law)
