"""What is in forecast files: times, levels, members, grids, units, gaps, and what would stop planning with them.

Nothing has to be complete: what a file lacks is part of the answer.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from gcs_windplan.errors import WindError
from gcs_windplan.wind.field_index import Field2D, FieldIndex, Grid, Level, Quantity
from gcs_windplan.wind.inspect.grids import GridSummary, summary_of
from gcs_windplan.wind.inspect.time_series import TimeSeries, series_of
from gcs_windplan.wind.inspect.trial import Feasibility, try_planning
from gcs_windplan.wind.pairing import pair_up

WIND: tuple[Quantity, ...] = ("u", "v", "speed", "direction")
_ORDER: tuple[Quantity, ...] = (
    *WIND, "gust", "height", "terrain", "roughness", "temperature", "humidity", "pressure",
)  # fmt: skip
_COUNTED = _ORDER[:8]  # what missing values are counted of
_DOWNWARDS = ("pressure", "model")  # levels that are numbered from the top

_MOST_FIELDS, _MOST_VALUES = 2000, 50_000_000  # that are all read
_SAMPLED_FIELDS, _SAMPLED_VALUES = 200, 20_000_000  # that are read of more


@dataclass(frozen=True, slots=True)
class FileSummary:
    """A file: its format and title, its number of fields, and what its reader passed over."""

    path: Path
    format: str
    title: str
    fields: int
    unused: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class QuantitySummary:
    """Fields of one quantity in one unit on one kind of level and one grid.

    `names` are the file's own. `levels` go from the ground up. `times` and `members` count those that are there; `grid`
    is the grid's place in `Inventory.grids`.
    """

    quantity: Quantity
    names: tuple[str, ...]
    units: str
    levels: tuple[Level, ...]
    times: int
    members: int
    fields: int
    grid: int


@dataclass(frozen=True, slots=True)
class MissingValues:
    """Missing values of a quantity among those that were read, and the first field that misses any."""

    quantity: Quantity
    values: int
    missing: int
    first: Field2D | None


@dataclass(frozen=True, slots=True)
class MissingCount:
    """The values that were read to count what is missing; `read` of `fields`, all or a random sample.

    `broken` tells in words why fields could not be read.
    """

    read: int
    fields: int
    found: tuple[MissingValues, ...]
    broken: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class Inventory:
    """What is in some files that belong together.

    `times` are those for which there is wind, or part of one; `whole` how many of them have both parts on some level.
    `members` of an ensemble; `also_without_member`: there are also winds without a member.
    """

    files: tuple[FileSummary, ...]
    runs: tuple[float, ...]
    times: TimeSeries
    whole: int
    members: tuple[int, ...]
    also_without_member: bool
    quantities: tuple[QuantitySummary, ...]
    grids: tuple[GridSummary, ...]
    missing: MissingCount
    planning: Feasibility


def take_inventory(paths: Sequence[Path], indexes: Sequence[FieldIndex]) -> Inventory:
    """What is in some open files. Fields are read to count missing values, and to try what planning makes of them."""
    fields = [one for index in indexes for one in index.fields]
    wind = [one for one in fields if one.quantity in WIND] or fields
    grids = list({one.grid.key: one.grid for one in (*wind, *fields)}.values())
    members = {one.member for one in wind}
    return Inventory(
        files=tuple(
            FileSummary(path, _format(path), index.title, len(index.fields), index.unused)
            for path, index in zip(paths, indexes, strict=True)
        ),
        runs=tuple(sorted({one.run for one in wind if one.run is not None})),
        times=series_of(one.time for one in wind if one.time is not None),
        whole=len({pair.first.time for pair in pair_up(fields)}),
        members=tuple(sorted(member for member in members if member is not None)),
        also_without_member=None in members,
        quantities=_quantities(fields, grids),
        grids=tuple(summary_of(grid, _is_turned(grid, fields)) for grid in grids),
        missing=_count_missing([one for one in fields if one.quantity in _COUNTED]),
        planning=try_planning(indexes, all_of_them=not _are_many(fields)),
    )


def _count_missing(fields: Sequence[Field2D]) -> MissingCount:
    """How many values are missing; of many fields a sample is read, always the same one."""
    values = {quantity: [0, 0] for quantity in _COUNTED}
    first: dict[Quantity, Field2D] = {}
    broken: dict[str, None] = {}
    chosen = _sample(fields) if _are_many(fields) else fields
    for one in chosen:
        try:
            whole = one.read(*(np.arange(size, dtype=np.int64) for size in one.grid.shape))
        except WindError as error:
            broken[str(error)] = None
            continue
        missing = whole.size - int(np.isfinite(whole).sum())
        values[one.quantity][0] += whole.size
        values[one.quantity][1] += missing
        if missing:
            first.setdefault(one.quantity, one)
    found = tuple(MissingValues(q, read, missing, first.get(q)) for q, (read, missing) in values.items() if read)
    return MissingCount(len(chosen), len(fields), found, tuple(broken))


def _format(path: Path) -> str:
    """The format of a file that a reader has opened, as its first bytes tell it."""
    with path.open("rb") as file:
        head = file.read(2000)
    if head.startswith(b"\x89HDF"):
        return "NetCDF4"
    if head.startswith(b"CDF"):
        return "NetCDF classic"
    at = head.find(b"GRIB")
    is_json = head.lstrip(b"\xef\xbb\xbf\xff\xfe \r\n\t\0")[:1] in (b"{", b"[")
    return "JSON" if is_json else f"GRIB edition {head[at + 7]}"


def _quantities(fields: Sequence[Field2D], grids: Sequence[Grid]) -> tuple[QuantitySummary, ...]:
    """The fields in groups, wind first."""
    numbers = {grid.key: number for number, grid in enumerate(grids)}
    groups: dict[tuple[int, int, str, str], list[Field2D]] = {}
    for one in fields:
        key = (_ORDER.index(one.quantity), numbers[one.grid.key], one.level.kind, one.units)
        groups.setdefault(key, []).append(one)
    return tuple(
        QuantitySummary(
            quantity=group[0].quantity,
            names=tuple(dict.fromkeys(one.name for one in group)),
            units=group[0].units,
            levels=_from_the_ground_up({one.level for one in group}),
            times=len({one.time for one in group if one.time is not None}),
            members=len({one.member for one in group if one.member is not None}),
            fields=len(group),
            grid=key[1],
        )
        for key, group in sorted(groups.items(), key=lambda item: item[0])
    )


def _from_the_ground_up(levels: Iterable[Level]) -> tuple[Level, ...]:
    """Levels of one kind in the order in which a balloon meets them."""
    return tuple(sorted(levels, key=lambda level: level.value * (-1 if level.kind in _DOWNWARDS else 1)))


def _is_turned(grid: Grid, fields: Sequence[Field2D]) -> bool:
    return not grid.regular and any(one.along_grid for one in fields if one.grid.key == grid.key)


def _size(field2d: Field2D) -> int:
    return field2d.grid.shape[0] * field2d.grid.shape[1]


def _are_many(fields: Sequence[Field2D]) -> bool:
    """Whether reading all of them would take long."""
    return len(fields) > _MOST_FIELDS or sum(map(_size, fields)) > _MOST_VALUES


def _sample(fields: Sequence[Field2D]) -> list[Field2D]:
    """Some of many fields, in the order of the file: a stride would meet the same level or time again and again."""
    order = np.random.default_rng(1).permutation(len(fields))[:_SAMPLED_FIELDS]
    enough = np.cumsum([_size(fields[number]) for number in order]) <= _SAMPLED_VALUES
    return [fields[number] for number in sorted(order[enough] if enough.any() else order[:1])]
