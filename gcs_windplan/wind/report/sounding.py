"""The wind of forecast files at one place: the column of its levels, or one height in it as planning would have it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from gcs_windplan.arrays import FloatArray
from gcs_windplan.errors import WindError
from gcs_windplan.geo.frame import GeoPoint
from gcs_windplan.wind.gridded import GriddedWind
from gcs_windplan.wind.pairing import Span, Winds, choose, say_time
from gcs_windplan.wind.report.excerpt import Choice, Excerpt, members_for, moment_in, part_at, winds_by_level
from gcs_windplan.wind.sheets import Catalogue, Level


@dataclass(frozen=True, slots=True)
class Altitude:
    """A height above mean sea level [m], or above the ground."""

    metres: float
    above_ground: bool = False

    def __str__(self) -> str:
        return f"{self.metres:g} m above {'ground' if self.above_ground else 'mean sea level'}"


@dataclass(frozen=True, slots=True, eq=False)
class Row:
    """The wind on a level, one a member: `winds` (members, 2) towards true east and north [m/s], NaN where missing.

    `heights` (members,) above mean sea level [m], NaN where unknown. `planned`: planning has it too. `hidden`: it lies
    no higher than the forecast's own ground or its levels above ground, where planning passes over it.
    """

    level: Level
    members: tuple[int | None, ...]
    winds: FloatArray
    heights: FloatArray
    planned: bool
    hidden: bool


@dataclass(frozen=True, slots=True, eq=False)
class Here:
    """Where and when: the moment and the times of the files that have a share in it [s since 1970].

    `ground` is the forecast's own above mean sea level [m], NaN where unknown. `gusts` [m/s] by member, where known.
    """

    place: GeoPoint
    moment: float | None
    times: tuple[float, ...]
    ground: float
    gusts: dict[int | None, float]


@dataclass(frozen=True, slots=True, eq=False)
class Sounding:
    """The column of levels over a place, from the ground up as far as can be told."""

    here: Here
    rows: tuple[Row, ...]


@dataclass(frozen=True, slots=True, eq=False)
class Spot:
    """The wind at a height: `winds` (members, 2) towards true east and north [m/s].

    `height` above mean sea level [m] and `above_ground`, over the forecast's own; NaN where unknown. The wind comes
    from `lower` and `upper`, levels and their heights [m], above ground where `height` is unknown; both are the same
    on a level, and lower is None below the lowest, where `law` leads it down to the ground.
    """

    here: Here
    members: tuple[int | None, ...]
    winds: FloatArray
    height: float
    above_ground: float
    lower: tuple[Level, float] | None
    upper: tuple[Level, float]
    law: str


def sounding_at(catalogues: Sequence[Catalogue], place: GeoPoint, asked: float | None, choice: Choice) -> Sounding:
    """The levels over a place at a moment [s since 1970], None for the first.

    Raises `WindError` for files without wind, and outside of their area and times.
    """
    moment = moment_in(catalogues, asked)
    found, planned = winds_by_level(catalogues, members_for(catalogues, choice), moment)
    columns: dict[int, _Column | None] = {}
    for winds in ([planned] if planned is not None else []) + list(found.values()):
        if id(winds) not in columns:
            columns[id(winds)] = _column(winds, place, moment, needed=winds is planned or not columns)
    first = next(column for column in columns.values() if column is not None)
    rows = [
        _row(column, level, first.here.ground, winds is planned)
        for level, winds in found.items()
        if (column := columns[id(winds)]) is not None
    ]
    return Sounding(first.here, tuple(sorted(rows, key=_upwards)))


def spot_at(
    catalogues: Sequence[Catalogue], place: GeoPoint, altitude: Altitude, asked: float | None, choice: Choice
) -> Spot:
    """The wind at a height over a place, as planning over the forecast's own ground has it.

    Raises `WindError`, as planning does, and where the height is not one that the files know.
    """
    moment = moment_in(catalogues, asked)
    winds = choose(catalogues, members_for(catalogues, choice), Span(moment), None)
    excerpt = Excerpt(winds, part_at(winds.grid, place), moment)
    fields = excerpt.assembly.made("").fields
    here = here_of(excerpt, place)
    spot = _unblown(excerpt, here, altitude)
    found = np.array([_blown(one, spot, here) for one in fields])
    if not np.isfinite(found).all():
        raise WindError(_unknown(spot, here, altitude))
    return replace(spot, winds=found)


def here_of(excerpt: Excerpt, place: GeoPoint) -> Here:
    """Ground and gusts at the place of an excerpt."""
    gusts = {member: excerpt.gust(member) for member in excerpt.winds.members}
    at = {m: float(excerpt.sampled(gust, excerpt.origin)[0]) for m, gust in gusts.items() if gust is not None}
    ground = float(excerpt.sampled(excerpt.terrain, excerpt.origin)[0])
    known = {member: gust for member, gust in at.items() if np.isfinite(gust)}
    return Here(place, excerpt.moment, excerpt.bracket, ground, known)


@dataclass(frozen=True, slots=True, eq=False)
class _Column:
    """Winds over a place, and the heights of their levels, one dictionary a member."""

    excerpt: Excerpt
    here: Here
    heights: tuple[dict[Level, float], ...]


def _column(winds: Winds, place: GeoPoint, moment: float | None, needed: bool) -> _Column | None:
    """The column of some winds, None if they do not reach the place. Raises `WindError` if they are needed there."""
    try:
        excerpt = Excerpt(winds, part_at(winds.grid, place), moment)
    except WindError:
        if needed:
            raise
        return None
    here = here_of(excerpt, place)
    return _Column(excerpt, here, tuple(_heights(excerpt, member, here.ground) for member in winds.members))


def _row(column: _Column, level: Level, ground: float, planned: bool) -> Row:
    excerpt, members = column.excerpt, column.excerpt.winds.members
    winds = np.array([excerpt.sampled(excerpt.wind(member, level), excerpt.origin)[0] for member in members])
    heights = np.array([known.get(level, np.nan) for known in column.heights])
    above = [ground + one.value for one in excerpt.winds.above if one.kind == "height"]
    hidden = level.kind != "height" and bool((heights <= max([ground, *above])).all())
    return Row(level, members, winds, heights, planned, hidden)


def _heights(excerpt: Excerpt, member: int | None, ground: float) -> dict[Level, float]:
    """The heights above mean sea level [m] of the levels at the place, NaN for those above an unknown ground."""
    told = excerpt.heights(member)
    beyond = {level: float(excerpt.sampled(height, excerpt.origin)[0]) for level, height in told.items()}
    return {level: ground + level.value for level in excerpt.winds.above if level.kind == "height"} | beyond


def _upwards(row: Row) -> tuple[float, str, float]:
    """By height; pressures and model levels of unknown height from the ground up behind those above the ground."""
    known = row.heights[np.isfinite(row.heights)]
    if len(known):
        return float(np.mean(known)), row.level.kind, 0.0
    counted = row.level.value if row.level.kind in ("height", "altitude") else 1e9 - row.level.value
    return counted, row.level.kind, 0.0


def _unblown(excerpt: Excerpt, here: Here, altitude: Altitude) -> Spot:
    """The heights of a spot and the levels about it; its winds are still to come. Raises `WindError`."""
    winds = excerpt.winds
    known = np.isfinite(here.ground)
    top = winds.above[-1].value if winds.above else 0.0
    if altitude.above_ground and not known and not altitude.metres <= top:
        raise WindError(_without_ground(excerpt, altitude))
    if not altitude.above_ground and not known and not winds.beyond:
        raise WindError(
            f"its levels count from the ground, and it has no terrain, so that {altitude} cannot be told: write the"
            f" height above ground, for example `{winds.above[-1].value:g} m agl`"
        )
    base = here.ground if known else 0.0
    over_ground = altitude.above_ground and not known
    height = altitude.metres + (base if altitude.above_ground else 0.0)
    levels = _ladder(excerpt, here.ground, over_ground)
    if not levels:
        raise WindError(f"all its levels lie below its own ground there, {here.ground:.0f} m above mean sea level")
    lower, upper = _about(levels, height)
    return Spot(
        here=here,
        members=winds.members,
        winds=np.empty((0, 2)),
        height=np.nan if over_ground else height,
        above_ground=altitude.metres if altitude.above_ground else height - here.ground,
        lower=lower,
        upper=upper,
        law=excerpt.assembly.law()[1],
    )


def _without_ground(excerpt: Excerpt, altitude: Altitude) -> str:
    advice = "write the height above mean sea level, without `agl`"
    if not excerpt.winds.above:
        return f"it has no terrain, so that {altitude} cannot be told: {advice}"
    reason = f"{altitude} is above its highest level above ground, {excerpt.winds.above[-1]}"
    return f"{reason}, and it has no terrain: {advice}" if excerpt.winds.beyond else reason


def _ladder(excerpt: Excerpt, ground: float, over_ground: bool) -> list[tuple[float, Level]]:
    """The levels that count, by height above mean sea level [m] or above the ground, in the first member."""
    if over_ground:
        return [(level.value, level) for level in excerpt.winds.above]
    heights = _heights(excerpt, excerpt.winds.members[0], ground)
    above = [(height, level) for level, height in heights.items() if level.kind == "height" and np.isfinite(height)]
    floor = max(above)[0] if above else ground
    beyond = [(height, level) for level, height in heights.items() if level.kind != "height" and not height <= floor]
    return sorted(above + beyond)


def _about(levels: list[tuple[float, Level]], height: float) -> tuple[tuple[Level, float] | None, tuple[Level, float]]:
    """The levels below and above a height."""
    below = [(level, at) for at, level in levels if at <= height + 1e-6]
    above = [(level, at) for at, level in levels if at >= height - 1e-6]
    return (below[-1] if below else None), (above[0] if above else below[-1])


def _blown(field: GriddedWind, spot: Spot, here: Here) -> FloatArray:
    """u and v of a member at a spot, NaN where not known."""
    places = field.placed(np.zeros((1, 3)))
    over_ground = np.isnan(spot.height)
    z = spot.above_ground if over_ground else spot.height
    ground = 0.0 if over_ground else here.ground
    when = 0.0 if here.moment is None else here.moment
    numbers = (np.array([number], dtype=np.float64) for number in (z, ground, when))
    wind: FloatArray = field.interpolated(places, *numbers)[0, :2]
    return wind


def _unknown(spot: Spot, here: Here, altitude: Altitude) -> str:
    """Why the wind is not known at a height."""
    level, height = spot.upper
    at = f"{level}" if level.kind in ("height", "altitude") else f"{level}, there {height:.0f} m above mean sea level"
    when = "" if here.moment is None else f" at {say_time(here.moment)}"
    if spot.lower is None:
        return f"{altitude} is below its lowest level ({at}){when}, and it has no terrain that tells how far down to go"
    if spot.height <= height:
        return f"{altitude} is above its highest level at one of the nodes about the place ({at}){when}"
    return f"{altitude} is above its highest level ({at}){when}"
