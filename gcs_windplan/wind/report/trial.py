"""What planning would make of forecast files, tried in the middle of their grid."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from datetime import UTC, datetime

import numpy as np

from gcs_windplan.errors import WindError
from gcs_windplan.geo.frame import GeoPoint, LocalFrame
from gcs_windplan.wind.forecast import Assembly, Wanted
from gcs_windplan.wind.pairing import Span, Winds, choose
from gcs_windplan.wind.placement import part_of
from gcs_windplan.wind.report.excerpt import POINT, members_for, pairs_of
from gcs_windplan.wind.sheets import Catalogue, Grid


@dataclass(frozen=True, slots=True)
class Trial:
    """What stops planning (`obstacle`), in planning's words, or else what it would use (`said`).

    `departures` are the first and the last that may be chosen [s since 1970], None where the files tell no time.
    `members` are those among which the mission has to choose, none if it has not. `whole`: all times and members were
    tried, not only the first.
    """

    obstacle: str
    said: str
    departures: tuple[float, float] | None
    members: tuple[int, ...]
    whole: bool


def tried(catalogues: Sequence[Catalogue], whole: bool) -> Trial:
    """Plans, as far as the wind goes: all times and members (`whole`), or the first of each."""
    departures: tuple[float, float] | None = None
    members: tuple[int, ...] = ()
    try:
        pairs = pairs_of(catalogues)
        times = sorted({pair.first.time for pair in pairs if pair.first.time is not None})
        departures = (times[0], times[-1]) if times else None
        if members_for(catalogues, None) == "all":
            members = tuple(sorted({pair.first.member for pair in pairs if pair.first.member is not None}))
        lasting = times[-1] - times[0] if whole and times else 0.0
        chosen = members if whole else members[:1]
        winds = choose(catalogues, chosen or None, Span(times[0] if times else None, lasting), None)
        return Trial("", _made(winds, times[0] if times else None, lasting), departures, members, whole)
    except WindError as error:
        return Trial(str(error), "", departures, members, whole)


def _made(winds: Winds, first: float | None, lasting: float) -> str:
    """What planning says of the winds."""
    frame = LocalFrame(_middle(winds.grid))
    moment = None if first is None else datetime.fromtimestamp(first, UTC)
    wanted = Wanted(frame, departure=moment, lasting=lasting, area=POINT)
    made = Assembly(winds, wanted, part_of(winds.grid, frame, POINT, anywhere=True)).made("")
    return made.name.removeprefix(": ")


def _middle(grid: Grid) -> GeoPoint:
    """The node in the middle."""
    row, column = grid.shape[0] // 2, grid.shape[1] // 2
    node = (row, column)
    latitude = grid.latitudes[row] if grid.regular else grid.latitudes[node]
    longitude = grid.longitudes[column] if grid.regular else grid.longitudes[node]
    return GeoPoint(float(np.clip(latitude, -90.0, 90.0)), float((longitude + 180.0) % 360.0 - 180.0))
