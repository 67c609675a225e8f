"""The wind at one place, by the field that planning uses there: on its levels, or at a height."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from datetime import UTC, datetime

import numpy as np

from gcs_windplan.arrays import FloatArray
from gcs_windplan.errors import WindError
from gcs_windplan.geo.frame import GeoPoint, LocalFrame
from gcs_windplan.wind.field_index import FieldIndex, Level
from gcs_windplan.wind.forecast import Forecast, ForecastQuery
from gcs_windplan.wind.gridded import GriddedWind
from gcs_windplan.wind.inspect.trial import POINT, members_or_all
from gcs_windplan.wind.pairing import Members, times_of, wind_pairs
from gcs_windplan.wind.placement import Box
from gcs_windplan.wind.reading import assemble

_HIGH = np.array([[0.0, 0.0, 1e6]])  # over the origin, where fields that are the same at all heights are asked


@dataclass(frozen=True, slots=True)
class HeightAsked:
    """A height above mean sea level [m], or above the ground."""

    metres: float
    above_ground: bool = False

    def __str__(self) -> str:
        return f"{self.metres:g} m above {'ground' if self.above_ground else 'mean sea level'}"


@dataclass(frozen=True, slots=True, eq=False)
class LevelWind:
    """The wind over a place on a level, one a member: `winds` (members, 2) towards true east and north [m/s].

    `height` above mean sea level and `above_ground`, over the forecast's own [m], in the first member; NaN where
    unknown.
    """

    level: Level
    height: float
    above_ground: float
    winds: FloatArray


@dataclass(frozen=True, slots=True, eq=False)
class HeightWind:
    """The wind over a place at a height, as a `LevelWind` has it, and the levels about it.

    `lower` is None below the lowest level, where a law leads the wind down to the ground; on a level both are the same.
    """

    height: float
    above_ground: float
    winds: FloatArray
    lower: LevelWind | None
    upper: LevelWind


@dataclass(frozen=True, slots=True, eq=False)
class Sounding:
    """The wind over a place at a moment, and the times that have a share in it [s since 1970].

    `levels` are those that planning has there, from the ground up, and `at_height` the wind at the height asked for.
    `ground` is the forecast's own above mean sea level [m], NaN where unknown. `gusts` (members,) [m/s], empty where
    there are none. `uses` says what planning makes of the files.
    """

    place: GeoPoint
    moment: float | None
    times: tuple[float, ...]
    members: tuple[int | None, ...]
    ground: float
    gusts: FloatArray
    levels: tuple[LevelWind, ...]
    at_height: HeightWind | None
    uses: str


def take_sounding(
    indexes: Sequence[FieldIndex],
    place: GeoPoint,
    moment: float | None = None,
    members: Members = None,
    height: HeightAsked | None = None,
) -> Sounding:
    """The wind over a place at a moment [s since 1970], by default the first, in members, by default all.

    Raises `WindError` as planning does, and where the wind at the height is not known.
    """
    forecast, moment = forecast_about(indexes, place, POINT, moment, members)
    first = forecast.fields[0]
    first.true_wind(_HIGH)  # which raises outside of the area
    ground = float(_over(first, first.columns.terrain[np.newaxis]))
    ground = ground if np.isfinite(ground) else np.nan
    levels = tuple(sorted(_levels(forecast, ground), key=_upwards))
    if not levels:
        raise WindError(f"all its levels lie below its own ground there, {ground:.0f} m above mean sea level")
    times = () if moment is None else tuple(first.columns.times.tolist())
    return Sounding(
        place=place,
        moment=moment,
        times=(moment,) if moment in times else times,
        members=forecast.members,
        ground=ground,
        gusts=np.array([gust.true_wind(_HIGH)[0, 0] for gust in map(_without_ground, forecast.gusts)]),
        levels=levels,
        at_height=None if height is None else _at_height(forecast, levels, ground, height),
        uses=forecast.name,
    )


def forecast_about(
    indexes: Sequence[FieldIndex],
    place: GeoPoint,
    area: Box,
    moment: float | None,
    members: Members,
    known_height: float | None = None,
) -> tuple[Forecast, float | None]:
    """What planning has about a place, and the moment of its departure: the one asked for, else the first time.

    `known_height` [m above ground] is that of a level whose height the file does not tell.
    """
    times = times_of(wind_pairs(indexes))
    moment = (times[0] if moment is None else moment) if times else None
    query = ForecastQuery(
        LocalFrame(place),
        departure=None if moment is None else datetime.fromtimestamp(moment, UTC),
        lasting=0.0,
        area=area,
        members=members_or_all(indexes, members),
        known_height=known_height,
    )
    return assemble(indexes, query), moment


def level_field(field: GriddedWind, number: int) -> GriddedWind:
    """The wind of one level of a field, at all heights."""
    return _without_ground(field.at_all_heights(np.ascontiguousarray(field.columns.winds[:, :, :, number])))


def _without_ground(field: GriddedWind) -> GriddedWind:
    """The field over a plain at mean sea level."""
    return replace(field, ground=None, columns=field.columns._replace(terrain=np.zeros_like(field.columns.terrain)))


def _over(field: GriddedWind, values: FloatArray) -> float:
    """Values (times or 1, rows, columns), or (1, 1, 1), over the origin."""
    everywhere = np.broadcast_to(values, field.columns.winds.shape[:3])
    known = np.isfinite(everywhere)
    pair = np.stack([np.where(known, everywhere, 0.0), ~known], axis=-1)
    value, unknown, _ = _without_ground(field.at_all_heights(pair)).true_wind(_HIGH)[0].tolist()
    return float(value) if unknown == 0 else np.nan


def _levels(forecast: Forecast, ground: float) -> list[LevelWind]:
    """The levels of a forecast that count over the place: none below its own ground or its levels above ground."""
    first = forecast.fields[0]
    count = len(first.columns.above)
    found = []
    for number, level in enumerate(forecast.levels):
        if number < count:
            above = float(first.columns.above[number])
            height = ground + above
        else:
            height = _over(first, first.columns.heights[..., number - count])
            above = height - ground
            if above <= (first.columns.above[-1] if count else 0.0):
                continue
        winds = np.array([level_field(one, number).true_wind(_HIGH)[0, :2] for one in forecast.fields])
        found.append(LevelWind(level, height, above, winds))
    return found


def _upwards(one: LevelWind) -> float:
    return one.height if np.isfinite(one.height) else one.above_ground


def _at_height(forecast: Forecast, levels: Sequence[LevelWind], ground: float, asked: HeightAsked) -> HeightWind:
    """The wind at a height. Raises `WindError` where it is not known."""
    base = ground
    if np.isnan(ground):
        _check_datum(levels, asked)
        base = 0.0 if asked.above_ground else np.nan  # without a terrain heights above ground are told all the same
        levels = [one for one in levels if np.isfinite(one.above_ground if asked.above_ground else one.height)]
    z = asked.metres + (base if asked.above_ground else 0.0)
    points = np.array([[0.0, 0.0, z]])
    winds = np.array([_over_ground(field, base).true_wind(points)[0, :2] for field in forecast.fields])
    heights = [one.above_ground if asked.above_ground and np.isnan(ground) else one.height for one in levels]
    below = [one for one, height in zip(levels, heights, strict=True) if height <= z + 1e-6]
    above = [one for one, height in zip(levels, heights, strict=True) if height >= z - 1e-6]
    if not np.isfinite(winds).all():
        raise WindError(f"{asked} is {_where(below, above)}: the wind is not known there")
    return HeightWind(
        height=asked.metres + ground if asked.above_ground else asked.metres,
        above_ground=asked.metres if asked.above_ground else asked.metres - ground,
        winds=winds,
        lower=below[-1] if below else None,
        upper=above[0] if above else below[-1],
    )


def _over_ground(field: GriddedWind, base: float) -> GriddedWind:
    """The field over level ground at a height [m], over its own where that is NaN."""
    return field if np.isnan(base) else replace(field, ground=lambda points: np.full(len(points), base))


def _check_datum(levels: Sequence[LevelWind], asked: HeightAsked) -> None:
    """Raise `WindError` for a height that counts from the other datum than all levels, of which there is no terrain."""
    fitting = [one for one in levels if np.isfinite(one.above_ground if asked.above_ground else one.height)]
    if not fitting:
        other = "above mean sea level, without `agl`" if asked.above_ground else "above ground, for example `100 m agl`"
        raise WindError(f"it has no terrain, so that {asked} cannot be told: write the height {other}")
    if asked.above_ground and asked.metres > fitting[-1].above_ground:
        raise WindError(f"{asked} is above its highest level above ground, {fitting[-1].level}, and it has no terrain")


def _where(below: Sequence[LevelWind], above: Sequence[LevelWind]) -> str:
    if not above and below:
        return f"above its highest level ({describe(below[-1])})"
    if not below and above:
        return f"below its lowest level ({describe(above[0])}), and it has no terrain that tells how far down to go"
    return "above the highest level at one of the nodes about the place"


def describe(one: LevelWind) -> str:
    """A level, and how high it is there."""
    if one.level.kind == "height" or np.isnan(one.height):
        return str(one.level)
    return f"{one.level}, there {one.height:.0f} m above mean sea level"
