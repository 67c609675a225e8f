"""Whether a mission can be planned in forecast files: what planning makes of them in the middle of their grid."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from datetime import UTC, datetime

import numpy as np

from gcs_windplan.errors import WindError
from gcs_windplan.geo.frame import GeoPoint, LocalFrame
from gcs_windplan.wind.field_index import FieldIndex, Grid
from gcs_windplan.wind.forecast import ForecastQuery
from gcs_windplan.wind.inspect.grids import wrapped
from gcs_windplan.wind.pairing import Members, WindPair, times_of, wind_pairs
from gcs_windplan.wind.placement import Box
from gcs_windplan.wind.reading import assemble

POINT: Box = (0.0, 0.0, 0.0, 0.0)


@dataclass(frozen=True, slots=True)
class PlanningTrial:
    """What stops planning (`obstacle`), in planning's words, or else what it would use (`uses`).

    `departures` are the first and the last that may be chosen [s since 1970], None where the files tell no time.
    `members` are those among which the mission has to choose, none if it has not. `all_tried`: all times and members
    were tried, not only the first.
    """

    obstacle: str
    uses: str
    departures: tuple[float, float] | None
    members: tuple[int, ...]
    all_tried: bool


def try_planning(indexes: Sequence[FieldIndex], all_of_them: bool) -> PlanningTrial:
    """Plans, as far as the wind goes: with all times and members, or the first of each."""
    departures: tuple[float, float] | None = None
    members: tuple[int, ...] = ()
    try:
        pairs = wind_pairs(indexes)
        times, members = times_of(pairs), members_to_choose(pairs)
        first = None
        if times:
            departures, first = (times[0], times[-1]), datetime.fromtimestamp(times[0], UTC)
        forecast = assemble(
            indexes,
            ForecastQuery(
                LocalFrame(_middle(pairs[0].first.grid)),
                departure=first,
                lasting=times[-1] - times[0] if all_of_them and times else 0.0,
                area=POINT,
                members=(members if all_of_them else members[:1]) or None,
            ),
        )
        return PlanningTrial("", forecast.name, departures, members, all_of_them)
    except WindError as error:
        return PlanningTrial(str(error), "", departures, members, all_of_them)


def members_to_choose(pairs: Sequence[WindPair]) -> tuple[int, ...]:
    """The members among which a mission has to choose; none beside a forecast without a member."""
    found = {pair.first.member for pair in pairs}
    return () if None in found else tuple(sorted(member for member in found if member is not None))


def members_or_all(indexes: Sequence[FieldIndex], members: Members) -> Members:
    """The members asked for, else all among which a mission would have to choose."""
    return members if members is not None or not members_to_choose(wind_pairs(indexes)) else "all"


def _middle(grid: Grid) -> GeoPoint:
    """The node in the middle."""
    row, column = grid.shape[0] // 2, grid.shape[1] // 2
    latitude = grid.latitudes[row] if grid.regular else grid.latitudes[row, column]
    longitude = grid.longitudes[column] if grid.regular else grid.longitudes[row, column]
    return GeoPoint(float(np.clip(latitude, -90.0, 90.0)), float(wrapped(longitude)))
