"""What is in forecast files: times, levels, members, grids, units, gaps, and what would stop planning with them.

Nothing has to be complete: what a file lacks is part of the answer.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path

import numpy as np

from gcs_windplan.errors import WindError
from gcs_windplan.wind.field_index import Field2D, FieldIndex, Grid, Level, Quantity
from gcs_windplan.wind.inspect.grids import GridSummary, summary_of
from gcs_windplan.wind.inspect.trial import PlanningTrial, try_planning
from gcs_windplan.wind.pairing import pair_up

WIND: tuple[Quantity, ...] = ("u", "v", "speed", "direction")
_ORDER: tuple[Quantity, ...] = (
    *WIND, "gust", "height", "terrain", "roughness", "temperature", "humidity", "pressure",
)  # fmt: skip
_DOWNWARDS = ("pressure", "model")  # levels that are numbered from the top

_MOST_FIELDS, _MOST_VALUES = 2000, 50_000_000  # that are all read
_SAMPLED_FIELDS, _SAMPLED_VALUES = 200, 20_000_000  # that are read of more


@dataclass(frozen=True, slots=True)
class FileSummary:
    """A file: its format and title, its number of fields, and what its reader ignored."""

    path: str
    format: str
    title: str
    fields: int
    unused: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class TimeGap:
    """A step between two times [s since 1970, UTC] that is longer than the one before and the one behind it."""

    after: float
    before: float


@dataclass(frozen=True, slots=True)
class QuantitySummary:
    """Fields of one quantity in one unit on one kind of level and one grid.

    `names` are the file's own. `levels` go from the ground up. `times` and `members` count those that are there; `grid`
    is the grid's place in `Inventory.grids`. `missing` of `values` are missing in those fields that were read.
    """

    quantity: Quantity
    names: tuple[str, ...]
    units: str
    levels: tuple[Level, ...]
    times: int
    members: int
    fields: int
    grid: int
    values: int
    missing: int


@dataclass(frozen=True, slots=True)
class Inventory:
    """What is in some files that belong together.

    `times` [s since 1970, UTC] are those for which there is wind, or part of one, `gaps` the steps between them that
    are longer than those around. `with_whole_wind`: how many times have both parts on some level. `members` of an
    ensemble; `also_without_member`: there are also winds without a member. `fields_read`, all or a random sample, to
    count missing values; `broken` tells why some could not be.
    """

    files: tuple[FileSummary, ...]
    runs: tuple[float, ...]
    times: tuple[float, ...]
    gaps: tuple[TimeGap, ...]
    with_whole_wind: int
    members: tuple[int, ...]
    also_without_member: bool
    quantities: tuple[QuantitySummary, ...]
    grids: tuple[GridSummary, ...]
    fields_read: int
    broken: tuple[str, ...]
    planning: PlanningTrial


def take_inventory(paths: Sequence[Path], indexes: Sequence[FieldIndex]) -> Inventory:
    """What is in some open files. Fields are read to count missing values, and to try what planning makes of them."""
    fields = [one for index in indexes for one in index.fields]
    wind = [one for one in fields if one.quantity in WIND] or fields
    grids = list({one.grid.key: one.grid for one in (*wind, *fields)}.values())
    members = {one.member for one in wind}
    times = tuple(sorted({one.time for one in wind if one.time is not None}))
    counts, broken = _count_missing(_sample(fields) if _are_many(fields) else fields)
    return Inventory(
        files=tuple(
            FileSummary(str(path), index.format, index.title, len(index.fields), index.unused)
            for path, index in zip(paths, indexes, strict=True)
        ),
        runs=tuple(sorted({one.run for one in wind if one.run is not None})),
        times=times,
        gaps=gaps_in(times),
        with_whole_wind=len({pair.first.time for pair in pair_up(fields)}),
        members=tuple(sorted(member for member in members if member is not None)),
        also_without_member=None in members,
        quantities=_quantities(fields, grids, counts),
        grids=tuple(summary_of(grid, _is_turned(grid, fields)) for grid in grids),
        fields_read=len(counts),
        broken=broken,
        planning=try_planning(indexes, all_of_them=not _are_many(fields)),
    )


def gaps_in(times: Sequence[float]) -> tuple[TimeGap, ...]:
    """The gaps in ascending times. Where longer steps go on, as forecasts do after some days, there is none."""
    steps = [round(later - earlier) for earlier, later in pairwise(times)]  # files count hours as fractions of days
    longer = [n for n in range(1, len(steps) - 1) if steps[n - 1] < steps[n] > steps[n + 1]]
    return tuple(TimeGap(times[n], times[n + 1]) for n in longer)


def _count_missing(fields: Sequence[Field2D]) -> tuple[dict[int, tuple[int, int]], tuple[str, ...]]:
    """Of some fields, by their id, how many values they have and how many are missing; and why some cannot be read."""
    counts: dict[int, tuple[int, int]] = {}
    broken: dict[str, None] = {}
    for one in fields:
        try:
            values = one.read(*(np.arange(size, dtype=np.int64) for size in one.grid.shape))
        except WindError as error:
            broken[str(error)] = None
        else:
            counts[id(one)] = values.size, values.size - int(np.isfinite(values).sum())
    return counts, tuple(broken)


def _quantities(
    fields: Sequence[Field2D], grids: Sequence[Grid], counts: Mapping[int, tuple[int, int]]
) -> tuple[QuantitySummary, ...]:
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
            values=sum(counts[id(one)][0] for one in group if id(one) in counts),
            missing=sum(counts[id(one)][1] for one in group if id(one) in counts),
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
