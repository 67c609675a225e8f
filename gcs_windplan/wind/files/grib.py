"""Wind from GRIB files: editions 1 and 2, one or several fields a message, in any order.

eccodes is slow to open a message: it is asked only once about all fields that differ in nothing but time and member.

    file ─ messages ─ fields ─ header ─ kind (what, level, product, grid) ─▶ 2D fields, which decode when they are read
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import BinaryIO

import numpy as np

from gcs_windplan.arrays import FloatArray, IntArray
from gcs_windplan.constants import STANDARD_GRAVITY
from gcs_windplan.errors import Problem, WindError
from gcs_windplan.wind.field_index import Field2D, FieldIndex, Level, Quantity
from gcs_windplan.wind.files.grib_file import Header, RawField, fields_of, header_of, messages_in
from gcs_windplan.wind.files.grib_grid import GribLayout, in_order, layout_of
from gcs_windplan.wind.files.grib_keys import GribError, Unused, handle_of, number_of, numbers_of, text_of, values_of
from gcs_windplan.wind.files.grib_kinds import (
    GEOPOTENTIAL,
    WITH_HALF_LEVELS,
    found_in,
    half_levels_in,
    product_of,
    surface_of,
    with_terrain,
)

_KEPT = 4  # decoded fields
_TIMELESS = "without a time that can be read: not used"
_FLAGS, _ALONG_GRID = "resolutionAndComponentFlags", 8  # edition 1, table 7; edition 2, table 3.3


@contextmanager
def open_grib(path: Path) -> Iterator[FieldIndex]:
    """The fields of a GRIB file, which can be read as long as the context lasts.

    Grids have their columns along x (mostly eastward) and their rows along y (mostly northward), whichever way the
    file stores them. Raises `WindError`, which begins with the path, for a file that is missing, cut short or no GRIB,
    and when a field cannot be decoded.
    """
    if not path.is_file():
        raise WindError(Problem("no such file", file=path))
    try:
        file = path.open("rb")
    except OSError as error:
        raise WindError(Problem(f"cannot be opened ({error.strerror})", file=path)) from error
    with file:
        yield _GribReader(path, file).index()


@dataclass(frozen=True, slots=True, eq=False)
class _Kind:
    """What fields have in common that differ in nothing but time and member.

    `mean`: of an ensemble. `number` is the member in edition 1; `ensemble`: it counts, `single`: unless it is 0.
    """

    name: str
    units: str
    quantity: Quantity
    level: Level
    layout: GribLayout
    along_grid: bool
    half_levels: tuple[FloatArray, FloatArray] | None
    mean: bool
    ensemble: bool
    single: bool
    number: int

    def member(self, header: Header) -> int | None:
        """Which member of an ensemble a field is, None where there is no ensemble."""
        number = self.number if header.number is None else header.number
        return number if self.ensemble and not (self.single and number == 0) else None


class _GribReader:
    """An open file and what was found in it so far."""

    def __init__(self, path: Path, file: BinaryIO) -> None:
        self.path, self.file = path, file
        self.offset = 0
        self.title = ""
        self.fields: list[Field2D] = []
        self.means: list[Field2D] = []
        self.unused: Counter[str] = Counter()
        self.kinds: dict[bytes, _Kind | str] = {}
        self.layouts: dict[str, GribLayout] = {}
        self.half_levels: dict[bytes, tuple[FloatArray, FloatArray] | None] = {}
        self.decoded: dict[RawField, FloatArray] = {}

    def index(self) -> FieldIndex:
        """All fields of the file. Raises `WindError`."""
        with self.naming_file():
            for message in messages_in(self.file):
                self.offset = message.offset
                for field in fields_of(self.file, message):
                    self.take_up(field)
        if any(field2d.member is not None for field2d in self.fields):
            self.unused["of means of an ensemble whose members are there too: not used"] += len(self.means)
        else:
            self.fields += self.means
        unused = [f"{n} field{'s' if n > 1 else ''} {why}" for why, n in self.unused.items() if why and n]
        return FieldIndex(self.path.name, tuple(with_terrain(self.fields)), self.title, tuple(unused), "GRIB")

    @contextmanager
    def naming_file(self) -> Iterator[None]:
        """Turns what goes wrong into a `WindError` that begins with the path."""
        try:
            yield
        except WindError as error:
            raise error.in_files([self.path]) from error
        except (GribError, OSError, ValueError, LookupError) as error:
            what = f"its message at byte {self.offset} cannot be decoded ({error})"
            raise WindError(Problem(f"{what}: download it again, or take another file", file=self.path)) from error

    def take_up(self, field: RawField) -> None:
        """Makes a field of a field, or counts why not."""
        header = header_of(self.file, field)
        if header.shared not in self.kinds:
            with handle_of(self.file, field) as handle:
                try:
                    self.kinds[header.shared] = self.kind(handle)
                except Unused as why:
                    self.kinds[header.shared] = str(why)
        kind = self.kinds[header.shared]
        if isinstance(kind, str):
            self.unused[kind] += 1
        elif header.time is None or header.run is None:
            self.unused[_TIMELESS] += 1
        else:
            (self.means if kind.mean else self.fields).append(self.field2d(field, header, kind))

    def field2d(self, field: RawField, header: Header, kind: _Kind) -> Field2D:
        """A field's field."""
        return Field2D(
            quantity=kind.quantity,
            level=kind.level,
            grid=kind.layout.grid,
            read=partial(self.values, field, kind),
            name=kind.name,
            units=kind.units,
            time=None if kind.quantity == "terrain" else header.time,
            run=header.run,
            member=kind.member(header),
            along_grid=kind.along_grid,
            half_levels=kind.half_levels,
        )

    def kind(self, handle: int) -> _Kind:
        """What a field is. Raises `Unused`, without a reason if it is none of the quantities wanted."""
        name, quantity, level = found_in(handle)
        mean, ensemble = product_of(handle, quantity)
        layout = self.layout(handle)
        self.title = self.title or text_of(handle, "centreDescription")
        return _Kind(
            name=name,
            units=text_of(handle, "units"),
            quantity=quantity,
            level=level,
            layout=layout,
            along_grid=quantity in ("u", "v") and layout.mapped and number_of(handle, _FLAGS) & _ALONG_GRID != 0,
            half_levels=self.half_levels_of(handle) if level.kind == "model" else None,
            mean=mean,
            ensemble=ensemble,
            single=text_of(handle, "dataType") == "fc",
            number=number_of(handle, "perturbationNumber"),
        )

    def layout(self, handle: int) -> GribLayout:
        """The layout of a field, shared by all fields on the same grid. Raises `Unused`."""
        key = text_of(handle, "md5GridSection")
        if key not in self.layouts:
            self.layouts[key] = layout_of(handle)
        return self.layouts[key]

    def half_levels_of(self, handle: int) -> tuple[FloatArray, FloatArray] | None:
        """The a [Pa] and b of the half levels, shared by all fields that have the same."""
        if surface_of(handle) not in WITH_HALF_LEVELS or not number_of(handle, "PVPresent"):
            return None
        pv = numbers_of(handle, "pv")
        return self.half_levels.setdefault(pv.tobytes(), half_levels_in(pv))

    def values(self, field: RawField, kind: _Kind, rows: IntArray, columns: IntArray) -> FloatArray:
        """Rows and columns of a field in its quantity's unit, NaN where missing. Raises `WindError`."""
        if self.file.closed:
            raise WindError(Problem("it is closed: read its fields inside of `with open_grib(...)`", file=self.path))
        with self.naming_file():
            whole = self.whole(field, kind.layout)
        values = whole[np.ix_(rows, columns)]
        if GEOPOTENTIAL.fullmatch(kind.units):
            values /= STANDARD_GRAVITY
        return np.exp(values) if kind.name == "lnsp" else values

    def whole(self, field: RawField, layout: GribLayout) -> FloatArray:
        """All values of a field in the order of its grid; the last few are kept."""
        if field not in self.decoded:
            self.offset = field[0].offset
            with handle_of(self.file, field) as handle:
                values = values_of(handle, layout.shape[0] * layout.shape[1])
            if len(self.decoded) == _KEPT:
                del self.decoded[next(iter(self.decoded))]
            self.decoded[field] = in_order(values, layout.shape, layout.scanning)
        return self.decoded[field]
