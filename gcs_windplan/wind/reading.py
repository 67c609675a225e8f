"""Forecast files are read: one or several of any format, one field a member.

paths ─ field indexes ─ pairs of fields ─ part of the grid ─ read, turned to true north, heights ─▶ Forecast
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import ExitStack, contextmanager
from pathlib import Path

from gcs_windplan.errors import WindError
from gcs_windplan.wind.assembly import Assembly
from gcs_windplan.wind.field_index import FieldIndex
from gcs_windplan.wind.files.anyfile import open_index
from gcs_windplan.wind.forecast import Forecast, ForecastQuery
from gcs_windplan.wind.pairing import TimeSpan, select_winds
from gcs_windplan.wind.placement import subset_of


def read_forecast(paths: Sequence[Path | str], query: ForecastQuery) -> Forecast:
    """The winds in one or several forecast files that belong together: NetCDF, GRIB, answers of Open-Meteo.

    `query` says where, when and for which members; only the part of the files that it needs is read. Each field of the
    forecast takes points (n, 3): east, north [m] in the query's local frame and height above mean sea level [m], with
    seconds after the departure, and gives winds (n, 3): east, north, up [m/s] along the frame's axes, NaN above the
    highest level. Heights above ground count from the query's `ground`, or from the forecast's own.

    Raises `WindError`, whose message begins with the file, for files that cannot be read or have no wind; for heights
    of levels that are not known; for places and times that they do not cover (`WindError.reason` is "area" or "time");
    for an ensemble without a choice of `members` (reason "members"); for values that are missing in the part that is
    read.

    >>> from datetime import UTC, datetime
    >>> import numpy as np
    >>> from gcs_windplan.geo.frame import GeoPoint, LocalFrame
    >>> from gcs_windplan.wind import ForecastQuery, read_forecast
    >>> query = ForecastQuery(
    ...     frame=LocalFrame(GeoPoint(36.6, -84.2)),
    ...     ground=lambda points: np.full(len(points), 400.0),
    ...     departure=datetime(2026, 5, 1, 15, tzinfo=UTC),
    ...     lasting=3 * 3600.0,
    ...     members="all",
    ... )
    >>> forecast = read_forecast(["missions/wind/front_synthetic.nc"], query)
    >>> len(forecast.fields), [str(level) for level in forecast.levels[:2]]
    (10, ['10 m above ground', '40 m above ground'])
    >>> forecast.mean.at(np.array([[0.0, 0.0, 480.0]]), seconds=3600.0).round(1).tolist()
    [[3.1, 5.0, 0.0]]
    """
    departure = query.departure
    if departure is not None and departure.tzinfo is None:
        raise WindError(f"the departure {departure:%Y-%m-%d %H:%M} has no time zone: write it in UTC, ending in Z")
    files = [Path(path) for path in paths]
    title = files[0].name if len(files) == 1 else f"{files[0].name} and {len(files) - 1} more"
    with open_indexes(files) as indexes:
        titles = list(dict.fromkeys(index.title for index in indexes if index.title))
        return assemble(indexes, query, f"{title} ({titles[0][:80]})" if titles else title)


def assemble(indexes: Sequence[FieldIndex], query: ForecastQuery, source: str = "") -> Forecast:
    """The forecast in files that are open, named after its `source`. Raises `WindError` as `read_forecast` does."""
    span = TimeSpan(None if query.departure is None else query.departure.timestamp(), query.lasting)
    selection = select_winds(indexes, query.members, span, query.known_height)
    subset = subset_of(selection.grid, query.frame, query.area, query.extend)
    return Assembly(selection, query, subset).build(source)


@contextmanager
def open_indexes(paths: Sequence[Path | str]) -> Iterator[tuple[FieldIndex, ...]]:
    """Files that belong together, which can be read as long as the context lasts.

    Every `WindError` on the way begins with the file that it speaks of, or with all of them.
    """
    files = [Path(path) for path in paths]
    with ExitStack() as stack:
        indexes = tuple(stack.enter_context(open_index(path)) for path in files)
        try:
            yield indexes
        except WindError as error:
            raise error.in_files(files) from error
