"""Wind from answers of Open-Meteo's forecast and ensemble APIs, JSON as it was downloaded.

Source: https://open-meteo.com/en/docs. An answer knows one place; several places come as a list of answers.
"""

from __future__ import annotations

import json
import math
import re
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass
from datetime import UTC, datetime, timedelta
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

from gcs_windplan.arrays import FloatArray, IntArray
from gcs_windplan.errors import WindError
from gcs_windplan.wind.field_index import SURFACE, Field2D, FieldIndex, Grid, Level, Quantity
from gcs_windplan.wind.files.units import converted

_NAME = re.compile(
    r"(?P<what>wind_?speed|wind_?direction|wind_?gusts|wind_[uv]_component|geopotential_height)"
    r"_(?P<number>\d+)(?P<unit>m|hPa)(?:_member(?P<member>\d+))?(?P<model>_(?!spread|mean)[a-z]\w*)?"
)
_QUANTITIES: Mapping[str, Quantity] = {
    "windspeed": "speed",
    "winddirection": "direction",
    "windgusts": "gust",
    "winducomponent": "u",
    "windvcomponent": "v",
    "geopotentialheight": "height",
}
_PARTNERS: Mapping[Quantity, Quantity] = {"speed": "direction", "direction": "speed", "u": "v", "v": "u"}
_SAME_PLACE = 1e-4  # [deg], 11 m: single precision; cells are never so small
_ASK = "ask for `hourly=wind_speed_10m,wind_direction_10m`"


@dataclass(frozen=True, slots=True, order=True)
class _Series:
    """What one series of values holds; the control run of an ensemble is member 0."""

    quantity: Quantity
    level: Level
    member: int | None
    name: str
    units: str


@dataclass(frozen=True, slots=True, eq=False)
class _Point:
    """One answer: a place, its times [s since 1970, UTC], its series in the units of their quantities."""

    latitude: float
    longitude: float
    elevation: float
    times: tuple[float, ...]
    series: Mapping[_Series, FloatArray]
    unused: tuple[str, ...]


@contextmanager
def open_openmeteo(path: Path) -> Iterator[FieldIndex]:
    """The fields of an answer, or of a list of answers for places that form a lattice of latitudes and longitudes.

    Raises `WindError` that begins with the path: for a file that is no such answer, or that tells an error; for series
    without units or of different lengths; for speed without a direction at all heights; for places in no lattice.
    """
    try:
        index = _index(path)
    except WindError as error:
        raise error.in_files([path]) from error
    yield index


def _index(path: Path) -> FieldIndex:
    answers = _loaded(path)
    points = [_point(answer) for answer in (answers if isinstance(answers, list) else [answers])]
    if not points:
        raise WindError("is an empty list: no place was asked for")
    first = points[0]
    for point in points[1:]:
        if point.times != first.times:
            raise WindError("its places have different times: ask for all of them at once, in UTC")
    grid, numbers = _lattice(points)
    missing = np.full(len(first.times), np.nan)
    fields = [
        Field2D(
            quantity=series.quantity,
            level=series.level,
            grid=grid,
            read=partial(_cut, values[:, :, number]),
            name=series.name,
            units=series.units,
            time=time,
            member=series.member,
        )
        for series in dict.fromkeys(series for point in points for series in point.series)
        for values in [np.stack([point.series.get(series, missing) for point in points])[numbers]]
        for number, time in enumerate(first.times)
    ]
    elevations = np.array([point.elevation for point in points])[numbers]
    if np.isfinite(elevations).any():
        fields.append(Field2D("terrain", SURFACE, grid, partial(_cut, elevations), "elevation", "m"))
    unused = dict.fromkeys(note for point in points for note in point.unused)
    return FieldIndex(path.name, tuple(fields), "Open-Meteo", tuple(unused), "JSON")


def _loaded(path: Path) -> Any:
    try:
        return json.loads(path.read_bytes())
    except OSError as error:
        raise WindError(f"cannot be read ({error})") from error
    except (ValueError, RecursionError) as error:
        raise WindError(f"is no complete JSON ({error}): download it again") from error


def _cut(values: FloatArray, rows: IntArray, columns: IntArray) -> FloatArray:
    part: FloatArray = values[np.ix_(rows, columns)].copy()
    return part


def _point(answer: Any) -> _Point:
    """One answer. Raises `WindError` if it is none, or tells an error."""
    if not isinstance(answer, dict):
        raise WindError(f"is JSON, but no answer of Open-Meteo: {_ASK}")
    if answer.get("error"):
        raise WindError(f"is an error that Open-Meteo tells: {answer.get('reason', 'without a reason')}")
    latitude, longitude = (_float(answer.get(name), name) for name in ("latitude", "longitude"))
    if not (math.isfinite(latitude) and math.isfinite(longitude)):
        raise WindError(f"is JSON, but no answer of Open-Meteo, for it has no latitude and longitude: {_ASK}")
    section = _section(answer)
    block, units = answer[section], answer.get(f"{section}_units")
    if not isinstance(units, dict):
        raise WindError(f"has no `{section}_units`: leave the answer as it was downloaded")
    times = _times(block.get("time"), units.get("time"), answer)
    series, unused = _complete(*_all_series(block, units, len(times)))
    elevation = _float(answer.get("elevation"), "elevation")
    return _Point(latitude, longitude, elevation, times, series, tuple(unused))


def _section(answer: Mapping[str, Any]) -> str:
    """Where the wind is: by the hour, otherwise by the quarter of an hour."""
    for section in ("hourly", "minutely_15"):
        block = answer.get(section)
        if isinstance(block, dict) and any(re.match(r"wind_?(speed|u_component)_", name) for name in block):
            return section
    raise WindError(f"has no wind by the hour or the quarter of an hour: {_ASK}")


def _times(values: Any, units: Any, answer: Mapping[str, Any]) -> tuple[float, ...]:
    """Times [s since 1970, UTC] of local times, or of unix times, which are UTC already."""
    if not isinstance(values, list) or not values:
        raise WindError("has no times: leave the answer as it was downloaded")
    if units == "unixtime":
        times = tuple(_float(value, "time") for value in values)
        if not all(map(math.isfinite, times)):
            raise WindError("has a time that is none")
        return times
    if units != "iso8601":
        raise WindError(f"has times in {units!r}, which are neither iso8601 nor unixtime")
    offset = _float(answer.get("utc_offset_seconds"), "utc_offset_seconds")
    if not math.isfinite(offset):
        raise WindError("has no `utc_offset_seconds`, so that its local times cannot be told: ask for `timezone=UTC`")
    return tuple(_moment(value, offset) for value in values)


def _moment(value: Any, offset: float) -> float:
    """UTC seconds since 1970 of a time, a local one where it names no zone."""
    try:
        moment = datetime.fromisoformat(value)
        if moment.tzinfo is None:
            moment = moment.replace(tzinfo=UTC) - timedelta(seconds=offset)
    except (TypeError, ValueError, OverflowError) as error:
        raise WindError(f"has a time {str(value)[:40]!r} that cannot be read") from error
    return moment.timestamp()


def _all_series(
    block: Mapping[str, Any], units: Mapping[str, Any], length: int
) -> tuple[dict[_Series, FloatArray], list[str]]:
    """All series that are known by their names, and words about others."""
    found: dict[_Series, FloatArray] = {}
    models, empty = set(), []
    names = {name: match for name in block if (match := _NAME.fullmatch(name))}
    ensemble = any(match["member"] for match in names.values() if not match["model"])
    for name, match in names.items():
        if match["model"]:
            models.add(match["model"][1:])
            continue
        values = _values(name, block[name], length)
        if np.isnan(values).all():
            empty.append(name)
            continue
        quantity = _QUANTITIES[match["what"].replace("_", "")]
        unit = str(units.get(name) or "")
        member = int(match["member"] or 0) if ensemble else None
        series = _Series(quantity, _level(match), member, name, unit)
        found[series] = converted(values, quantity, name, unit)
    notes = [f"{', '.join(empty)}: without any value"] if empty else []
    if models:
        notes.append(f"fields of several models ({', '.join(sorted(models))}): ask for one model")
    return found, notes


def _level(match: re.Match[str]) -> Level:
    number = float(match["number"])
    return Level("height", number) if match["unit"] == "m" else Level("pressure", number * 100)


def _complete(series: dict[_Series, FloatArray], unused: list[str]) -> tuple[dict[_Series, FloatArray], list[str]]:
    """The series without speeds that lack a direction and the like. Raises `WindError` if no wind is left."""
    there = {(one.quantity, one.level, one.member) for one in series}
    kept, lone = {}, []
    for one, values in series.items():
        partner = _PARTNERS.get(one.quantity)
        if partner is None or (partner, one.level, one.member) in there:
            kept[one] = values
        else:
            lone.append(f"{one.name}: without {partner}")
    if not any(one.quantity in ("speed", "u") for one in kept):
        raise WindError(f"has no wind of known direction ({'; '.join([*lone, *unused]) or 'no wind at all'}): {_ASK}")
    return kept, [*unused, *lone]


def _values(name: str, values: Any, length: int) -> FloatArray:
    if not isinstance(values, list) or len(values) != length:
        count = len(values) if isinstance(values, list) else "no"
        raise WindError(f"has {count} values of {name} for {length} times: download it again")
    return np.array([_float(value, name) for value in values])


def _float(value: Any, name: str) -> float:
    """A number, NaN for null."""
    if value is None:
        return math.nan
    if isinstance(value, bool) or not isinstance(value, int | float):
        raise WindError(f"has {name} {str(value)[:40]!r}, which is no number")
    try:
        return float(value)
    except OverflowError as error:
        raise WindError(f"has {name} beyond all numbers") from error


def _lattice(points: list[_Point]) -> tuple[Grid, IntArray]:
    """The grid of all places, and which of them stands at each row and column."""
    rows, latitudes = _sorted(np.array([point.latitude for point in points]))
    columns, longitudes = _sorted(np.array([point.longitude for point in points]))
    numbers = np.full((len(latitudes), len(longitudes)), -1, dtype=np.int64)
    for number in reversed(range(len(points))):  # places moved to the same cell have the same wind
        numbers[rows[number], columns[number]] = number
    if (numbers < 0).any():
        raise WindError(
            f"its {len(points)} places form no lattice of latitudes and longitudes: {int((numbers < 0).sum())} of"
            f" {numbers.size} nodes are missing. Ask for every latitude with every longitude, of a model that has them"
            " (Open-Meteo moves places to its cells), or for one place"
        )
    one = f"one place, {latitudes[0]:.4f}, {longitudes[0]:.4f}"
    name = one if numbers.size == 1 else f"{len(latitudes)} latitudes x {len(longitudes)} longitudes"
    return Grid(latitudes, longitudes, name), numbers


def _sorted(values: FloatArray) -> tuple[IntArray, FloatArray]:
    """Which of the ascending places along an axis each value is, and these places."""
    order = np.argsort(values)
    groups = np.cumsum(np.diff(values[order], prepend=values[order[0]]) > _SAME_PLACE)
    which = np.empty(len(values), dtype=np.int64)
    which[order] = groups
    return which, values[order][np.unique(groups, return_index=True)[1]]
