"""An open NetCDF file: what it says about its variables, and numbers out of them, NaN where they are missing."""

from __future__ import annotations

import warnings
from collections import OrderedDict
from collections.abc import Mapping
from pathlib import Path
from typing import Any, TypeAlias

import numpy as np
import numpy.typing as npt

from gcs_windplan.arrays import FloatArray, IntArray
from gcs_windplan.errors import WindError
from gcs_windplan.wind.files.cf import Variable

#: The places wanted along a dimension.
Places: TypeAlias = tuple[str, IntArray]

_BLOCK = 4_000_000  # numbers that are read at once at most
_KEPT = 256_000_000  # [bytes] that are kept for the next fields

#: Single precision is kept as it is.
_Block: TypeAlias = npt.NDArray[np.floating[Any]]


def refuse_cut_short(path: Path) -> None:
    """Raise `WindError` for a classic file that ends before its values do: netCDF4 reads what is missing as zeros."""
    with path.open("rb") as file:
        classic = file.read(4) in (b"CDF\x01", b"CDF\x02")
    if not classic:
        return
    from scipy.io import netcdf_file

    try:
        netcdf_file(path, "r", mmap=False).close()
    except Exception as error:  # its parser fails in as many ways as a file can end
        raise WindError(
            f"{path}: the file was cut short, or is damaged: it ends before its values do; fetch it again"
        ) from error


class NetcdfFile:
    """An open dataset.

    Compressed files are cut in chunks that can only be read whole, and one often holds many times and levels. So what
    is read for one field is read for all fields that share its chunks, and the last such blocks are kept.
    """

    def __init__(self, dataset: Any) -> None:
        self._dataset = dataset
        self.dimensions: dict[str, int] = {name: len(size) for name, size in dataset.dimensions.items()}
        self.variables: dict[str, Variable] = {
            name: Variable(name, tuple(v.dimensions), tuple(v.shape), _attributes(v))
            for name, v in dataset.variables.items()
        }
        self.groups: tuple[str, ...] = tuple(dataset.groups)
        self.title = Variable("", (), (), _attributes(dataset)).raw_text("title")[:80]
        self._values: dict[str, FloatArray] = {}
        self._blocks: OrderedDict[tuple[object, ...], _Block] = OrderedDict()

    def is_numeric(self, variable: Variable) -> bool:
        """Whether a variable holds numbers, not letters."""
        return getattr(self._dataset.variables[variable.name].dtype, "kind", "O") in "iuf"

    def values(self, variable: Variable) -> FloatArray:
        """All values of a variable of numbers, in its shape and unit."""
        if variable.name not in self._values:
            self._values[variable.name] = _plain(self._dataset.variables[variable.name], (...,)).astype(np.float64)
        return self._values[variable.name]

    def letters(self, variable: Variable) -> Any:
        """All values of a variable of letters, as it stands."""
        return np.ma.getdata(self._dataset.variables[variable.name][...])

    def plane(
        self, variable: Variable, fixed: Mapping[str, int], rows: Places | None, columns: Places | None
    ) -> FloatArray:
        """Values (rows, columns) of a variable at one place along each other dimension, `fixed`.

        Without `rows` or `columns` there is one of them.
        """
        wanted = dict(places for places in (rows, columns) if places is not None)
        ranges = self._ranges(variable, fixed, wanted)
        block = self._block(variable, ranges, wanted)
        index = tuple(slice(None) if d in wanted else fixed[d] - ranges[d].start for d in variable.dimensions)
        plane = block[index]
        across = [d for d in variable.dimensions if d in wanted]
        if rows is not None and columns is not None and across[0] == columns[0]:
            plane = plane.T
        shape = (1 if rows is None else len(rows[1]), 1 if columns is None else len(columns[1]))
        return np.array(plane.reshape(shape), dtype=np.float64)

    def _ranges(self, variable: Variable, fixed: Mapping[str, int], wanted: Mapping[str, IntArray]) -> dict[str, slice]:
        """What to read along the other dimensions: the chunks that hold the place, as far as memory allows."""
        chunks = self._dataset.variables[variable.name].chunking()
        sizes = dict(zip(variable.dimensions, chunks, strict=True)) if isinstance(chunks, list) else {}
        room = _BLOCK // max(1, int(np.prod([len(places) for places in wanted.values()])))
        ranges = {}
        for dimension in reversed([d for d in variable.dimensions if d not in wanted]):
            size = sizes.get(dimension, 1)
            step = size if size <= room else 1
            room //= step
            first = fixed[dimension] // step * step
            ranges[dimension] = slice(first, min(first + step, self.dimensions[dimension]))
        return ranges

    def _block(self, variable: Variable, ranges: Mapping[str, slice], wanted: Mapping[str, IntArray]) -> _Block:
        """The values in all ranges at the wanted places, kept for the next time."""
        firsts = tuple(range_.start for range_ in ranges.values())
        key = (variable.name, firsts, *(places.tobytes() for places in wanted.values()))
        if key not in self._blocks:
            self._blocks[key] = self._read(variable, ranges, wanted)
            while len(self._blocks) > 1 and sum(block.nbytes for block in self._blocks.values()) > _KEPT:
                self._blocks.popitem(last=False)
        self._blocks.move_to_end(key)
        return self._blocks[key]

    def _read(self, variable: Variable, ranges: Mapping[str, slice], wanted: Mapping[str, IntArray]) -> _Block:
        parts = {dimension: _parts(places) for dimension, places in wanted.items()}
        source = self._dataset.variables[variable.name]
        block = _joined(source, variable.dimensions, dict(ranges), parts)
        for dimension, places in wanted.items():
            there = np.concatenate([np.arange(part.start, part.stop) for part in parts[dimension]])
            block = np.take(block, np.searchsorted(there, places), axis=variable.dimensions.index(dimension))
        return block


def _joined(
    source: Any, dimensions: tuple[str, ...], ranges: dict[str, slice], parts: Mapping[str, tuple[slice, ...]]
) -> _Block:
    """The values in all ranges and in all parts of the dimensions that have several, one behind the other."""
    for dimension, several in parts.items():
        if dimension not in ranges:
            pieces = [_joined(source, dimensions, {**ranges, dimension: part}, parts) for part in several]
            return np.concatenate(pieces, axis=dimensions.index(dimension))
    return _plain(source, tuple(ranges[dimension] for dimension in dimensions))


def _parts(places: IntArray) -> tuple[slice, ...]:
    """One or two slices that hold all places: two where they lie at both ends of a dimension, as across a meridian."""
    there = np.unique(places)
    steps = np.diff(there)
    cut = int(np.argmax(steps)) + 1 if len(steps) else 0
    if not len(steps) or steps[cut - 1] <= (there[-1] - there[0]) / 2 + 1:
        return (slice(int(there[0]), int(there[-1]) + 1),)
    return slice(int(there[0]), int(there[cut - 1]) + 1), slice(int(there[cut]), int(there[-1]) + 1)


def _plain(source: Any, index: tuple[Any, ...]) -> _Block:
    """What netCDF4 reads, unpacked, NaN where it masks."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # of attributes that do not fit the variable: they mask nothing
        values = source[index]
    data = np.ma.getdata(values)
    array: _Block = np.array(data, dtype=np.float32 if data.dtype == np.float32 else np.float64)
    array[np.ma.getmaskarray(values)] = np.nan
    return array


def _attributes(source: Any) -> dict[str, object]:
    """All attributes that can be read at all."""
    found: dict[str, object] = {}
    for name in source.ncattrs():
        try:
            found[name] = source.getncattr(name)
        except (KeyError, ValueError, RuntimeError, AttributeError):  # types of the file's own
            continue
    return found
