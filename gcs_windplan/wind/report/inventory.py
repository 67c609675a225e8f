"""What is in forecast files: times, levels, members, grids, units, gaps, and what would stop planning with them.

Nothing has to be complete: what a file lacks is part of the answer.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from gcs_windplan.errors import WindError
from gcs_windplan.wind.files.anyfile import open_catalogue
from gcs_windplan.wind.pairing import pair_up
from gcs_windplan.wind.report.excerpt import from_the_ground_up
from gcs_windplan.wind.report.extent import Extent, Spacing, extent_of, spacing_of
from gcs_windplan.wind.report.series import Series, series_of
from gcs_windplan.wind.report.trial import Trial, tried
from gcs_windplan.wind.sheets import Catalogue, Grid, Level, Quantity, Sheet

WIND: tuple[Quantity, ...] = ("u", "v", "speed", "direction")
_ORDER: tuple[Quantity, ...] = (
    *WIND, "gust", "height", "terrain", "roughness", "temperature", "humidity", "pressure",
)  # fmt: skip
_COUNTED = _ORDER[:8]  # what missing values are counted of

_MOST_SHEETS, _MOST_VALUES = 2000, 50_000_000  # that are all read
_SAMPLED_SHEETS, _SAMPLED_VALUES = 200, 20_000_000  # that are read of more


@dataclass(frozen=True, slots=True, eq=False)
class OpenFile:
    """A file that is open, and its format, for people."""

    path: Path
    format: str
    catalogue: Catalogue


@dataclass(frozen=True, slots=True)
class FileFacts:
    """A file: its format and title, its number of sheets, and what its reader passed over."""

    path: Path
    format: str
    title: str
    sheets: int
    unused: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class Holding:
    """Sheets of one quantity in one unit on one kind of level and one grid.

    `names` are the file's own. `levels` go from the ground up. `times` and `members` count those that are there; `grid`
    is the grid's place in `Inventory.grids`.
    """

    quantity: Quantity
    names: tuple[str, ...]
    units: str
    levels: tuple[Level, ...]
    times: int
    members: int
    sheets: int
    grid: int


@dataclass(frozen=True, slots=True)
class GridFacts:
    """A grid: what it is, where it lies, and whether u and v follow its rows and columns and are turned when read."""

    name: str
    rows: int
    columns: int
    extent: Extent
    spacing: Spacing
    turned: bool


@dataclass(frozen=True, slots=True)
class Missing:
    """Missing values of a quantity among those that were read, and the first sheet that misses any."""

    quantity: Quantity
    values: int
    missing: int
    first: Sheet | None


@dataclass(frozen=True, slots=True)
class Count:
    """The values that were read to count what is missing; `read` of `sheets`, all or a random sample.

    `broken` tells in words why sheets could not be read.
    """

    read: int
    sheets: int
    found: tuple[Missing, ...]
    broken: tuple[str, ...]

    @property
    def sampled(self) -> bool:
        """Whether there were too many to read them all."""
        return self.read < self.sheets


@dataclass(frozen=True, slots=True)
class Inventory:
    """What is in some files that belong together.

    `times` are those for which there is wind, or part of one; `whole` how many of them have both parts on some level.
    `members` of an ensemble; `alone` tells that there are also winds without a member. `lone` levels have one part of a
    wind without the other.
    """

    files: tuple[FileFacts, ...]
    runs: tuple[float, ...]
    times: Series
    whole: int
    members: tuple[int, ...]
    alone: bool
    holdings: tuple[Holding, ...]
    lone: tuple[Holding, ...]
    grids: tuple[GridFacts, ...]
    count: Count
    trial: Trial


@contextmanager
def open_files(paths: Sequence[Path | str]) -> Iterator[tuple[OpenFile, ...]]:
    """Files of any format, which can be read as long as the context lasts. Raises `WindError`."""
    with ExitStack() as stack:
        files = [Path(path) for path in paths]
        yield tuple(OpenFile(path, _format(path), stack.enter_context(open_catalogue(path))) for path in files)


def take_inventory(files: Sequence[OpenFile]) -> Inventory:
    """What is in some files. Sheets are read to count missing values, and to try what planning would make of them."""
    sheets = [sheet for file in files for sheet in file.catalogue.sheets]
    wind = [sheet for sheet in sheets if sheet.quantity in WIND] or sheets
    grids = list({sheet.grid.key: sheet.grid for sheet in wind}.values())
    grids += [grid for key, grid in {s.grid.key: s.grid for s in sheets}.items() if key not in {g.key for g in grids}]
    pairs = pair_up(sheets)
    paired = {id(sheet) for pair in pairs for sheet in (pair.first, pair.second)}
    members = {sheet.member for sheet in wind}
    return Inventory(
        files=tuple(_facts(file) for file in files),
        runs=tuple(sorted({sheet.run for sheet in wind if sheet.run is not None})),
        times=series_of(sheet.time for sheet in wind if sheet.time is not None),
        whole=len({pair.first.time for pair in pairs}),
        members=tuple(sorted(member for member in members if member is not None)),
        alone=None in members,
        holdings=_holdings(sheets, grids),
        lone=_holdings([s for s in sheets if s.quantity in WIND and id(s) not in paired], grids) if pairs else (),
        grids=tuple(_grid_facts(grid, sheets) for grid in grids),
        count=count_missing(sheets),
        trial=tried([file.catalogue for file in files], whole=not _many(sheets)),
    )


def count_missing(sheets: Sequence[Sheet]) -> Count:
    """How many values are missing; of many sheets a sample is read, always the same one."""
    all_of_them = [sheet for sheet in sheets if sheet.quantity in _COUNTED]
    values = {quantity: [0, 0] for quantity in _COUNTED}
    first: dict[Quantity, Sheet] = {}
    broken: dict[str, None] = {}
    chosen = _sample(all_of_them) if _many(all_of_them) else all_of_them
    for sheet in chosen:
        try:
            whole = sheet.read(*(np.arange(size, dtype=np.int64) for size in sheet.grid.shape))
        except WindError as error:
            broken[str(error)] = None
            continue
        missing = whole.size - int(np.isfinite(whole).sum())
        values[sheet.quantity][0] += whole.size
        values[sheet.quantity][1] += missing
        if missing:
            first.setdefault(sheet.quantity, sheet)
    found = tuple(Missing(q, read, missing, first.get(q)) for q, (read, missing) in values.items() if read)
    return Count(len(chosen), len(all_of_them), found, tuple(broken))


def _facts(file: OpenFile) -> FileFacts:
    catalogue = file.catalogue
    return FileFacts(file.path, file.format, catalogue.title, len(catalogue.sheets), catalogue.unused)


def _format(path: Path) -> str:
    """The format, as the first bytes tell it; nothing for what is no file, which its reader will say."""
    try:
        with path.open("rb") as file:
            head = file.read(2000)
    except OSError:
        return ""
    if head.startswith(b"\x89HDF"):
        return "NetCDF4"
    if head.startswith(b"CDF"):
        return "NetCDF classic"
    if head.lstrip(b"\xef\xbb\xbf\xff\xfe \r\n\t\0")[:1] in (b"{", b"["):
        return "JSON"
    at = head.find(b"GRIB")
    return f"GRIB edition {head[at + 7]}" if 0 <= at < len(head) - 7 else ""


def _holdings(sheets: Sequence[Sheet], grids: Sequence[Grid]) -> tuple[Holding, ...]:
    """The sheets in groups, wind first."""
    numbers = {grid.key: number for number, grid in enumerate(grids)}
    groups: dict[tuple[int, int, str, str], list[Sheet]] = {}
    for sheet in sheets:
        key = (_ORDER.index(sheet.quantity), numbers[sheet.grid.key], sheet.level.kind, sheet.units)
        groups.setdefault(key, []).append(sheet)
    return tuple(_holding(group, key[1]) for key, group in sorted(groups.items(), key=lambda item: item[0]))


def _holding(sheets: Sequence[Sheet], grid: int) -> Holding:
    return Holding(
        quantity=sheets[0].quantity,
        names=tuple(dict.fromkeys(sheet.name for sheet in sheets)),
        units=sheets[0].units,
        levels=from_the_ground_up({sheet.level for sheet in sheets}),
        times=len({sheet.time for sheet in sheets if sheet.time is not None}),
        members=len({sheet.member for sheet in sheets if sheet.member is not None}),
        sheets=len(sheets),
        grid=grid,
    )


def _grid_facts(grid: Grid, sheets: Sequence[Sheet]) -> GridFacts:
    turned = not grid.regular and any(sheet.along_grid for sheet in sheets if sheet.grid.key == grid.key)
    return GridFacts(grid.name, *grid.shape, extent_of(grid), spacing_of(grid), turned)


def _size(sheet: Sheet) -> int:
    return sheet.grid.shape[0] * sheet.grid.shape[1]


def _many(sheets: Sequence[Sheet]) -> bool:
    """Whether reading all of them would take long."""
    return len(sheets) > _MOST_SHEETS or sum(map(_size, sheets)) > _MOST_VALUES


def _sample(sheets: Sequence[Sheet]) -> list[Sheet]:
    """Some of many sheets, in the order of the file: a stride would meet the same level or time again and again."""
    order = np.random.default_rng(1).permutation(len(sheets))[:_SAMPLED_SHEETS]
    enough = np.cumsum([_size(sheets[number]) for number in order]) <= _SAMPLED_VALUES
    return [sheets[number] for number in sorted(order[enough] if enough.any() else order[:1])]
