"""Wind from GRIB files: editions 1 and 2, one or several fields a message, in any order.

eccodes is imported here and nowhere else. What it does slowly, or for the whole process at once, is done here: messages
are found and cut into fields, times and members are taken from their octets, and eccodes is asked only once about all
fields that differ in nothing else. Octets, code and flag tables: WMO-No. 306, volume I.2, FM 92 GRIB.

    file ─ _messages ─ _fields ─ _header ─ kind (what, level, product, grid) ─▶ Sheets, which decode when they are read
"""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass, replace
from datetime import UTC, datetime
from functools import partial
from pathlib import Path
from typing import BinaryIO, NamedTuple, TypeAlias

import eccodes
import numpy as np

from gcs_windplan.arrays import FloatArray, IntArray
from gcs_windplan.constants import STANDARD_GRAVITY
from gcs_windplan.errors import WindError
from gcs_windplan.wind.sheets import Catalogue, Grid, Level, LevelKind, Quantity, Sheet

_CHUNK = 8192  # [bytes] that are searched at a time for the next message
_KEPT = 4  # decoded fields
_MOST = 200_000_000  # nodes of a grid: more than any forecast has, fewer than memory holds
_NOTHING = -1e100  # what a missing value decodes to
_TIMELESS = "without a time that can be read: not used"

#: Names that eccodes gives to parameters: ECMWF's, in capitals Deutscher Wetterdienst's, long ones from CF.
_NAMES: Mapping[Quantity, str] = {
    "u": "u U U_10M eastward_wind",
    "v": "v V V_10M northward_wind",
    "speed": "ws si SP SP_10M wind_speed",
    "direction": "wdir DD DD_10M wind_from_direction",
    "gust": "gust fg VMAX_10M wind_speed_of_gust",
    "height": "z gh h orog mterh FI FIS HSURF geopotential geopotential_height surface_altitude",
    "roughness": "sr fsr Z0 surface_roughness_length",
    "temperature": "t T",
    "humidity": "q QV",
    "pressure": "sp lnsp PS surface_air_pressure",
}
_QUANTITIES = {name: quantity for quantity, names in _NAMES.items() for name in names.split()}
_AT_HEIGHT = re.compile(r"i?(\d+)(u|v|ws|si|wdir|fg)\d*")  # 10u, 100v, i10fg, 10fg3
_OVER_TIME = re.compile("^(avg|max|min|std)_")  # as in max_i10fg
_GEOPOTENTIAL = re.compile(r"m(\*\*)?2 ?/?s(\*\*)?-?2")  # its unit, as the centres spell it

_LevelsByCode: TypeAlias = Mapping[int, tuple[LevelKind, float]]
_LEVELS_1: _LevelsByCode = {  # edition 1, table 3
    1: ("surface", 0), 100: ("pressure", 100), 102: ("altitude", 0), 103: ("altitude", 1), 105: ("height", 1),
    109: ("model", 1), 110: ("model", 1), 125: ("height", 0.01), 210: ("pressure", 1),
}  # fmt: skip
_LEVELS_2: _LevelsByCode = {  # edition 2, table 4.5
    1: ("surface", 0), 100: ("pressure", 1), 101: ("altitude", 0), 102: ("altitude", 1), 103: ("height", 1),
    105: ("model", 1), 118: ("model", 1), 119: ("model", 1),
}  # fmt: skip
_LAYERS = (105, 118, 119, 150)  # two of the same enclose a model level; 150 alone is the edge of a layer
_WITH_HALF_LEVELS = (105, 109, 110)

_MEMBERS, _DERIVED = (1, 11), (2, 12)  # edition 2, table 4.0
_ENDS = {8: 34, 11: 37, 12: 36}  # where products over a time span tell its end in section 4, octets from 0
_PRODUCTS = (0, *_MEMBERS, *_DERIVED, *_ENDS)
_MEANS = (0, 1)  # edition 2, table 4.7
_MAXIMUM = 2  # edition 2, table 4.10; edition 1, table 5
_INSTANT, _ANALYSIS, _LONG_STEP = (0, 1, 10), 1, 10  # edition 1, table 5
_UNITS = {0: 60, 1: 3600, 2: 86400, 10: 10800, 11: 21600, 12: 43200}  # [s] edition 1, table 4; edition 2, table 4.4
_UNITS_1, _UNITS_2 = _UNITS | {13: 900, 14: 1800, 254: 1}, _UNITS | {13: 1}
_MEAN_TYPES = ("em", "taem")  # ECMWF's types of fields
_SPREAD_TYPES = ("es", "taes", "ses", "cm", "cs", "cr", "cd", "ep", "ef", "efi", "efic", "fp", "pb", "pd", "sot")

_GRIDS = {
    "regular_ll": "latitude-longitude", "rotated_ll": "rotated latitude-longitude", "regular_gg": "Gaussian",
    "mercator": "Mercator", "lambert": "Lambert conformal", "polar_stereographic": "polar stereographic",
    "lambert_azimuthal_equal_area": "Lambert equal-area",
}  # fmt: skip
_OTHER_GRIDS = {
    "reduced_gg": ("a reduced Gaussian grid", "cdo setgridtype,regular"),
    "sh": ("spherical harmonics", "cdo sp2gpl"),
    "unstructured_grid": ("an unstructured grid", "cdo remapnn,r360x180"),
}
_WESTWARD, _NORTHWARD, _BY_COLUMNS, _TO_AND_FRO, _STAGGERED = 128, 64, 32, 16, 15  # edition 2, table 3.4
_FLAGS, _ALONG_GRID = "resolutionAndComponentFlags", 8  # edition 1, table 7; edition 2, table 3.3
_ROUNDING = {1: 5e-4, 2: 5e-7}  # [deg] of angles, by edition


@contextmanager
def open_grib(path: Path) -> Iterator[Catalogue]:
    """The sheets of a GRIB file, which can be read as long as the context lasts.

    Grids have their columns along x (mostly eastward) and their rows along y (mostly northward), whichever way the
    file stores them. Raises `WindError`, which begins with the path, for a file that is missing, cut short or no GRIB,
    and when a sheet cannot be decoded.
    """
    if not path.is_file():
        raise WindError(f"{path}: no such file")
    try:
        file = path.open("rb")
    except OSError as error:
        raise WindError(f"{path}: cannot be opened ({error.strerror})") from error
    with file:
        yield _Reader(path, file).catalogue()


class _Unused(Exception):
    """Why a field is passed over, for people: what follows on "12 fields"."""


class _Span(NamedTuple):
    """A part of the file [bytes]."""

    offset: int
    length: int


#: A field: its whole message in edition 1, its sections in edition 2, section 0 first.
_Field: TypeAlias = tuple[_Span, ...]


class _Header(NamedTuple):
    """What tells fields of one kind apart, and what they share.

    Times [s since 1970, UTC], None where they cannot be told; `number` of the member in edition 2.
    """

    shared: bytes
    run: float | None
    time: float | None
    number: int | None = None


@dataclass(frozen=True, slots=True, eq=False)
class _Layout:
    """A grid, and how the file stores the values (rows, columns) of `shape` on it."""

    grid: Grid
    shape: tuple[int, int]
    scanning: int
    mapped: bool


@dataclass(frozen=True, slots=True, eq=False)
class _Kind:
    """What fields have in common that differ in nothing but time and member.

    `mean`: of an ensemble. `number` is the member in edition 1; `ensemble`: it counts, `single`: unless it is 0.
    """

    name: str
    units: str
    quantity: Quantity
    level: Level
    layout: _Layout
    along_grid: bool
    half_levels: tuple[FloatArray, FloatArray] | None
    mean: bool
    ensemble: bool
    single: bool
    number: int

    def member(self, header: _Header) -> int | None:
        """Which member of an ensemble a field is, None where there is no ensemble."""
        number = self.number if header.number is None else header.number
        return number if self.ensemble and not (self.single and number == 0) else None


class _Reader:
    """An open file and what was found in it so far."""

    def __init__(self, path: Path, file: BinaryIO) -> None:
        self.path, self.file = path, file
        self.offset = 0
        self.title = ""
        self.sheets: list[Sheet] = []
        self.means: list[Sheet] = []
        self.unused: Counter[str] = Counter()
        self.kinds: dict[bytes, _Kind | str] = {}
        self.layouts: dict[str, _Layout] = {}
        self.half_levels: dict[bytes, tuple[FloatArray, FloatArray] | None] = {}
        self.decoded: dict[_Field, FloatArray] = {}

    def catalogue(self) -> Catalogue:
        """All sheets of the file. Raises `WindError`."""
        with self.naming_file():
            for message in _messages(self.file):
                self.offset = message.offset
                for field in _fields(self.file, message):
                    self.take_up(field)
        if any(sheet.member is not None for sheet in self.sheets):
            self.unused["of means of an ensemble whose members are there too: not used"] += len(self.means)
        else:
            self.sheets += self.means
        unused = [f"{n} field{'s' if n > 1 else ''} {why}" for why, n in self.unused.items() if why and n]
        return Catalogue(self.path.name, tuple(_with_terrain(self.sheets)), self.title, tuple(unused))

    @contextmanager
    def naming_file(self) -> Iterator[None]:
        """Turns what goes wrong into a `WindError` that begins with the path."""
        try:
            yield
        except WindError as error:
            raise WindError(f"{self.path}: {error}") from error
        except (eccodes.CodesInternalError, OSError, ValueError, LookupError) as error:
            what = f"its message at byte {self.offset} cannot be decoded ({error})"
            raise WindError(f"{self.path}: {what}: download it again, or take another file") from error

    def take_up(self, field: _Field) -> None:
        """Makes a sheet of a field, or counts why not."""
        header = _header(self.file, field)
        if header.shared not in self.kinds:
            with _handle_of(self.file, field) as handle:
                try:
                    self.kinds[header.shared] = self.kind(handle)
                except _Unused as why:
                    self.kinds[header.shared] = str(why)
        kind = self.kinds[header.shared]
        if isinstance(kind, str):
            self.unused[kind] += 1
        elif header.time is None or header.run is None:
            self.unused[_TIMELESS] += 1
        else:
            (self.means if kind.mean else self.sheets).append(self.sheet(field, header, kind))

    def sheet(self, field: _Field, header: _Header, kind: _Kind) -> Sheet:
        """A field's sheet."""
        return Sheet(
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
        """What a field is. Raises `_Unused`, without a reason if it is none of the quantities wanted."""
        name, quantity, level = _found(handle)
        mean, ensemble = _product(handle, quantity)
        layout = self.layout(handle)
        self.title = self.title or _text(handle, "centreDescription")
        return _Kind(
            name=name,
            units=_text(handle, "units"),
            quantity=quantity,
            level=level,
            layout=layout,
            along_grid=quantity in ("u", "v") and layout.mapped and _number(handle, _FLAGS) & _ALONG_GRID != 0,
            half_levels=self.half_levels_of(handle) if level.kind == "model" else None,
            mean=mean,
            ensemble=ensemble,
            single=_text(handle, "dataType") == "fc",
            number=_number(handle, "perturbationNumber"),
        )

    def layout(self, handle: int) -> _Layout:
        """The layout of a field, shared by all fields on the same grid. Raises `_Unused`."""
        key = _text(handle, "md5GridSection")
        if key not in self.layouts:
            self.layouts[key] = _layout(handle)
        return self.layouts[key]

    def half_levels_of(self, handle: int) -> tuple[FloatArray, FloatArray] | None:
        """The a [Pa] and b of the half levels, shared by all fields that have the same."""
        if _surface(handle) not in _WITH_HALF_LEVELS or not _number(handle, "PVPresent"):
            return None
        pv: FloatArray = eccodes.codes_get_double_array(handle, "pv")
        return self.half_levels.setdefault(pv.tobytes(), _half_levels(pv))

    def values(self, field: _Field, kind: _Kind, rows: IntArray, columns: IntArray) -> FloatArray:
        """Rows and columns of a field in its quantity's unit, NaN where missing. Raises `WindError`."""
        if self.file.closed:
            raise WindError(f"{self.path}: it is closed: read its sheets inside of `with open_grib(...)`")
        with self.naming_file():
            whole = self.whole(field, kind.layout)
        values = whole[np.ix_(rows, columns)]
        if _GEOPOTENTIAL.fullmatch(kind.units):
            values /= STANDARD_GRAVITY
        return np.exp(values) if kind.name == "lnsp" else values

    def whole(self, field: _Field, layout: _Layout) -> FloatArray:
        """All values of a field in the order of its grid; the last few are kept."""
        if field not in self.decoded:
            self.offset = field[0].offset
            with _handle_of(self.file, field) as handle:
                nodes = layout.shape[0] * layout.shape[1]
                if eccodes.codes_get_size(handle, "values") != nodes or _number(handle, "numberOfCodedValues") > nodes:
                    raise WindError(f"its message at byte {self.offset} is not as long as its grid: download it again")
                eccodes.codes_set(handle, "missingValue", _NOTHING)
                values: FloatArray = eccodes.codes_get_values(handle)
            if len(self.decoded) == _KEPT:
                del self.decoded[next(iter(self.decoded))]
            values[values == _NOTHING] = np.nan
            self.decoded[field] = _in_order(values, layout.shape, layout.scanning)
        return self.decoded[field]


def _read(file: BinaryIO, span: _Span) -> bytes:
    file.seek(span.offset)
    return file.read(span.length)


def _messages(file: BinaryIO) -> Iterator[_Span]:
    """Every message; what lies between messages is skipped. Raises `WindError` for a file that is not whole."""
    size, position, good = file.seek(0, 2), 0, 0
    while (start := _search(file, position)) is not None:
        span = _Span(start, _length(file, start))
        position = start + (span.length or 4)
        if position > size:
            raise WindError(
                f"it ends {position - size} bytes before its last message does, after {good} whole ones: the download"
                " was cut short, fetch it again"
            )
        if span.length:
            if _read(file, _Span(position - 4, 4)) != b"7777":
                raise WindError(f"its message at byte {start} does not end where it should: download it again")
            good += 1
            yield span
    if not good:
        packed = _read(file, _Span(0, 2)) in (b"BZ", b"\x1f\x8b", b"PK")
        raise WindError("it is compressed: unpack it first" if packed else "it is no GRIB: there is no message in it")


def _search(file: BinaryIO, position: int) -> int | None:
    """Where the next letters GRIB stand."""
    file.seek(position)
    while len(chunk := file.read(_CHUNK)) >= 4:
        if (at := chunk.find(b"GRIB")) >= 0:
            return position + at
        position = file.seek(position + len(chunk) - 3)
    return None


def _length(file: BinaryIO, start: int) -> int:
    """The length of a message [bytes], 0 where the letters GRIB begin none."""
    head = _read(file, _Span(start, 16))
    if len(head) < 16:
        return 16
    if head[7] != 1:
        return int.from_bytes(head[8:16]) if head[7] == 2 else 0
    length, rest = int.from_bytes(head[4:7]), _sections_1(file, start)[-1].length
    if length < 1 << 23 or rest >= 120:
        return length
    return (length - (1 << 23)) * 120 - rest + 4  # beyond 16 MB ECMWF counts in units of 120 bytes


def _sections_1(file: BinaryIO, start: int) -> list[_Span]:
    """Sections 1 to 4 of a message of edition 1, without those that it has not."""
    flags, position, sections = _read(file, _Span(start + 15, 1))[0], start + 8, []
    for there in (True, flags & 128, flags & 64, True):
        if there:
            sections.append(_Span(position, int.from_bytes(_read(file, _Span(position, 3)))))
            position += sections[-1].length
    return sections


def _fields(file: BinaryIO, message: _Span) -> Iterator[_Field]:
    """The fields of a message. Raises `WindError`.

    After its data (section 7) a message of edition 2 may go on with any of sections 2 to 7; those not repeated hold on.
    """
    damaged = WindError(f"the sections of its message at byte {message.offset} do not fit: download it again")
    if _read(file, _Span(message.offset, 8))[7] == 1:
        last = _sections_1(file, message.offset)[-1]
        if last.offset + last.length != message.offset + message.length - 4 and message.length < 1 << 23:
            raise damaged
        yield (message,)
        return
    sections = {0: _Span(message.offset, 16)}
    bitmap, position, end = _Span(0, 0), message.offset + 16, message.offset + message.length - 4
    while position < end:
        head = _read(file, _Span(position, 6))
        span, number = _Span(position, int.from_bytes(head[:4])), head[4]
        position += span.length
        if span.length < 5 or not 1 <= number <= 7 or position > end:
            raise damaged
        if number == 6 and head[5] == 254:  # the bitmap told before
            span = bitmap
        elif number == 6:
            bitmap = span
        sections[number] = span
        if number == 7:
            yield tuple(sections[n] for n in sorted(sections))


def _header(file: BinaryIO, field: _Field) -> _Header:
    """What the first sections of a field say. Raises `WindError`."""
    if len(field) == 1:
        return _header_1(file, field[0].offset)
    if len(field) < 7:
        raise WindError(f"its message at byte {field[0].offset} lacks a section: download it again")
    return _header_2([_read(file, span) for span in field[:-3]])


def _header_1(file: BinaryIO, start: int) -> _Header:
    spans = _sections_1(file, start)
    one = _read(file, spans[0])
    two = _read(file, spans[1]) if one[7] & 128 else b""
    shared = one[:12] + one[17:18] + one[20:24] + one[25:] + two
    run = _moment(100 * (one[24] - 1) + one[12], *one[13:17])
    first, second, span = one[18:21]
    steps = {0: first, _ANALYSIS: 0, _LONG_STEP: 256 * first + second}.get(span, second)
    return _Header(shared, run, _later(run, steps, _UNITS_1.get(one[17])))


def _header_2(sections: list[bytes]) -> _Header:
    zero, one, product = sections[0], sections[1], bytearray(sections[-1])
    run, time, number = _moment(int.from_bytes(one[12:14]), *one[14:19]), None, None
    template = int.from_bytes(product[7:9])
    if template in _PRODUCTS:
        steps = int.from_bytes(product[18:22])
        time = _later(run, steps if steps < 1 << 31 else (1 << 31) - steps, _UNITS_2.get(product[17]))
        product[18:22] = bytes(4)
    if template in _ENDS:
        end = _ENDS[template]
        time = _moment(int.from_bytes(product[end : end + 2]), *product[end + 2 : end + 7])
        product[end : end + 7] = bytes(7)
    if template in _MEMBERS:
        number, product[35] = product[35], 0
    shared = zero[6:7] + one[5:12] + one[19:] + b"".join(sections[2:-1]) + product
    return _Header(shared, run, time, number)


def _moment(year: int, month: int, day: int, hour: int, minute: int, second: int = 0) -> float | None:
    """Seconds since 1970, UTC, None for what is no date."""
    try:
        return datetime(year, month, day, hour, minute, second, tzinfo=UTC).timestamp()
    except ValueError:
        return None


def _later(run: float | None, steps: int, unit: int | None) -> float | None:
    return None if run is None or unit is None else run + steps * unit


@contextmanager
def _handle_of(file: BinaryIO, field: _Field) -> Iterator[int]:
    """A field as a message of its own, in eccodes' hands."""
    message = b"".join(_read(file, span) for span in field)
    if len(field) > 1:
        message = message[:8] + (len(message) + 4).to_bytes(8) + message[16:] + b"7777"
    handle = eccodes.codes_new_from_message(message)
    try:
        yield handle
    finally:
        eccodes.codes_release(handle)


def _text(handle: int, key: str) -> str:
    """A key's text, empty where there is none."""
    try:
        return str(eccodes.codes_get_string(handle, key))
    except eccodes.KeyValueNotFoundError:
        return ""


def _number(handle: int, key: str) -> int:
    """A key's whole number, 0 where there is none."""
    try:
        return int(eccodes.codes_get_long(handle, key))
    except eccodes.KeyValueNotFoundError:
        return 0


def _degrees(handle: int, key: str) -> float:
    return float(eccodes.codes_get_double(handle, f"{key}InDegrees"))


def _found(handle: int) -> tuple[str, Quantity, Level]:
    """Name, quantity and level of a field. Raises `_Unused`, without a reason if it is none of those wanted."""
    name = _text(handle, "shortName")
    plain = _OVER_TIME.sub("", name)
    at_height = _AT_HEIGHT.fullmatch(plain)
    quantity = _QUANTITIES.get(at_height[2] if at_height else plain) or _QUANTITIES.get(_text(handle, "cfName"))
    if quantity is None:
        spectral = name in ("vo", "d") and _text(handle, "gridType") == "sh"
        raise _Unused("of vorticity and divergence: make wind of them, for example with `cdo dv2uvl`" * spectral)
    level = Level("height", float(at_height[1])) if at_height else _level(handle)
    if level is None:
        lost = quantity in ("u", "v", "speed", "direction")
        raise _Unused(f"of wind at no known height ({_text(handle, 'typeOfLevel')}): not used" * lost)
    return name, *_placed(quantity, level)


def _placed(quantity: Quantity, level: Level) -> tuple[Quantity, Level]:
    """What a quantity is on its level. Raises `_Unused`, without a reason, if it is not wanted there."""
    match quantity, level.kind:
        case "height", "surface":
            return "terrain", level
        case "pressure", "surface" | "model":  # ECMWF has its logarithm on model level 1
            return quantity, Level("surface")
        case ("height", "pressure" | "model") | ("temperature" | "humidity", "model") | ("roughness", "surface"):
            return quantity, level
        case "u" | "v" | "speed" | "direction" | "gust", _:
            return quantity, level
    raise _Unused


def _surface(handle: int) -> int:
    """The code of a level's kind, of the table of its edition."""
    one = _number(handle, "edition") == 1
    return _number(handle, "indicatorOfTypeOfLevel" if one else "typeOfFirstFixedSurface")


def _level(handle: int) -> Level | None:
    """The level of a field, None where its height cannot be told.

    It is made of the message's numbers: eccodes' `level` cuts digits off, 92550 Pa become 925 hPa, 1.5 m become 2.
    """
    first = _surface(handle)
    if _number(handle, "edition") == 1:
        found, value = _LEVELS_1.get(first), float(_number(handle, "topLevel" if first == 110 else "level"))
    else:
        second = _number(handle, "typeOfSecondFixedSurface")
        layer: tuple[LevelKind, float] | None = ("model", 1.0) if first == second and first in _LAYERS else None
        found = _LEVELS_2.get(first) if second == 255 else layer
        scaled, scale = (_number(handle, f"scale{which}OfFirstFixedSurface") for which in ("dValue", "Factor"))
        told = eccodes.CODES_MISSING_LONG not in (scaled, scale)
        value = scaled / 10.0**scale if told else 0.0
        if found is not None and found[1] and not told:
            return None
    return None if found is None else Level(found[0], value * found[1])


def _product(handle: int, quantity: Quantity) -> tuple[bool, bool]:
    """Whether a field is the mean of an ensemble, or one of its members. Raises `_Unused` for other statistics."""
    kind = _text(handle, "dataType")
    if _number(handle, "edition") == 1:
        process = _number(handle, "timeRangeIndicator")
        over_time, derived, member, other = process not in _INSTANT, False, kind in ("pf", "cf"), False
    else:
        template, process = (
            _number(handle, key) for key in ("productDefinitionTemplateNumber", "typeOfStatisticalProcessing")
        )
        over_time, derived, member = template in _ENDS, template in _DERIVED, template in _MEMBERS
        other = template not in _PRODUCTS
    if over_time and not (quantity == "gust" and process == _MAXIMUM):
        raise _Unused("of averages or extremes over time: not used")
    mean = kind in _MEAN_TYPES or (derived and _number(handle, "derivedForecast") in _MEANS)
    if other or kind in _SPREAD_TYPES or (derived and not mean):
        raise _Unused("of spreads, probabilities or other statistics of an ensemble: not used")
    return mean, member and not mean


def _half_levels(pv: FloatArray) -> tuple[FloatArray, FloatArray] | None:
    """The a [Pa] and b of half levels, top down; None where the coefficients are of another kind."""
    a, b = pv[: len(pv) // 2], pv[len(pv) // 2 :]
    fit = len(a) == len(b) > 1 and (a >= 0).all() and (np.diff(b) >= 0).all() and b[0] >= 0 and abs(b[-1] - 1) < 0.01
    return (a, b) if fit else None


def _with_terrain(sheets: list[Sheet]) -> Iterator[Sheet]:
    """The sheets, where a geopotential that is on model level 1 alone is the terrain's, as ECMWF has it."""
    levels = {sheet.level.value for sheet in sheets if sheet.quantity == "height" and sheet.level.kind == "model"}
    for sheet in sheets:
        if sheet.name == "z" and sheet.level == Level("model", 1.0) and levels == {1.0}:
            yield replace(sheet, quantity="terrain", level=Level("surface"), time=None, half_levels=None)
        else:
            yield sheet


def _layout(handle: int) -> _Layout:
    """The grid of a field and how it is stored. Raises `_Unused` for grids that are not read."""
    kind, scanning = _text(handle, "gridType"), _number(handle, "scanningMode")
    if kind not in _GRIDS:
        grid, tool = _OTHER_GRIDS.get(kind, (f"a grid of type {kind}", "cdo remapbil,r360x180"))
        raise _Unused(f"on {grid}: not read; ask for a regular grid, or make one, for example with `{tool}`")
    if _number(handle, "edition") == 1:
        scanning &= _WESTWARD | _NORTHWARD | _BY_COLUMNS
    if scanning & _STAGGERED:
        raise _Unused("on a staggered grid: not read; ask for a regular grid")
    shape = _number(handle, "Nj"), _number(handle, "Ni")
    name = f"{_GRIDS[kind]} grid, {shape[0]} x {shape[1]}"
    if not 0 < shape[0] * shape[1] == _number(handle, "numberOfDataPoints") <= _MOST:
        raise WindError(f"its grid ({name}) is damaged, or too large: download it again, or take a part of it")
    nodes = _lines(handle, shape, scanning) if kind.endswith("_ll") else _nodes(handle, kind, shape, scanning)
    if kind == "rotated_ll":
        nodes = _unrotated(handle, *nodes)
    return _Layout(Grid(*nodes, name), shape, scanning, mapped=not kind.startswith("regular"))


def _in_order(stored: FloatArray, shape: tuple[int, int], scanning: int) -> FloatArray:
    """Values (rows, columns) with columns along x and rows along y, from values in the order of the file."""
    rows, columns = shape
    values = stored.reshape((columns, rows) if scanning & _BY_COLUMNS else (rows, columns))
    if scanning & _TO_AND_FRO:
        values = values.copy()
        values[1::2] = values[1::2, ::-1]
    if scanning & _BY_COLUMNS:
        values = values.T
    return values[:: 1 if scanning & _NORTHWARD else -1, :: -1 if scanning & _WESTWARD else 1]


def _lines(handle: int, shape: tuple[int, int], scanning: int) -> tuple[FloatArray, FloatArray]:
    """The latitudes of the rows and the longitudes of the columns [deg] of a latitude-longitude grid.

    They are laid out between the first and the last, since edition 1 rounds their steps to 0.001 degrees; a last
    longitude is not trusted where the steps go just once round the globe. Raises `WindError` where they disagree.
    """
    rows, columns = shape
    south, north = (_degrees(handle, f"latitudeOf{end}GridPoint") for end in ("First", "Last"))
    first, last = (_degrees(handle, f"longitudeOf{end}GridPoint") for end in ("First", "Last"))
    turn = -1 if scanning & _WESTWARD else 1
    width = turn * (last - first) % 360.0 or 360.0 * (columns > 1)
    step = _degrees(handle, "iDirectionIncrement") if _number(handle, "iDirectionIncrementGiven") else 0.0
    if abs(step * columns - 360.0) < 1e-6:
        width = 360.0 - step
    elif step > 0 and abs(step * (columns - 1) - width) > step / 2 + columns * _ROUNDING[_number(handle, "edition")]:
        raise WindError(
            f"its {columns} longitudes in steps of {step:g} degrees do not span {width:g}: take another file"
        )
    longitudes = first + turn * np.linspace(0.0, width, columns)
    return np.linspace(south, north, rows)[:: 1 if scanning & _NORTHWARD else -1], longitudes[::turn]


def _unrotated(handle: int, latitudes: FloatArray, longitudes: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Geographic latitudes and longitudes [deg] (rows, columns) of a grid about another pole. Raises `_Unused`."""
    if _degrees(handle, "angleOfRotation") != 0:
        raise _Unused("on a grid that is turned about its own pole: not read; ask for a regular grid")
    tilt = np.radians(90.0 + _degrees(handle, "latitudeOfSouthernPole"))
    phi, lam = np.radians(latitudes)[:, np.newaxis], np.radians(longitudes)
    x, y, z = np.cos(phi) * np.cos(lam), np.cos(phi) * np.sin(lam), np.sin(phi) + 0.0 * lam
    north = np.degrees(np.arcsin(np.clip(np.sin(tilt) * x + np.cos(tilt) * z, -1.0, 1.0)))
    east = np.degrees(np.arctan2(y, np.cos(tilt) * x - np.sin(tilt) * z))
    return north, east + _degrees(handle, "longitudeOfSouthernPole")


def _nodes(handle: int, kind: str, shape: tuple[int, int], scanning: int) -> tuple[FloatArray, FloatArray]:
    """Latitudes and longitudes [deg] of a grid's rows and columns, or of all its nodes where it is projected."""
    eccodes.codes_set(handle, "jPointsAreConsecutive", 0)
    sign, shift, flip = _mirrored(handle, kind, scanning)
    flags = scanning & (_WESTWARD | _NORTHWARD)
    latitudes = _in_order(flip * eccodes.codes_get_double_array(handle, "latitudes"), shape, flags)
    longitudes = _in_order(sign * (eccodes.codes_get_double_array(handle, "longitudes") - shift), shape, flags)
    if np.ptp(latitudes, axis=1).max() < 1e-9 and np.ptp(longitudes, axis=0).max() < 1e-9:
        return latitudes[:, 0], longitudes[0]
    return latitudes, longitudes


def _mirrored(handle: int, kind: str, scanning: int) -> tuple[float, float, float]:
    """Makes the first node of a projected grid its lower left corner, by mirroring the globe where it is another.

    eccodes (up to 2.42) lays these grids out to the right and upwards from their first node, whichever way they are
    stored. Returns sign, shift [deg] and flip: of what eccodes then gives, sign * (longitude - shift) is the true
    longitude and flip * latitude the true latitude. Raises `_Unused`.
    """
    if kind not in ("lambert", "polar_stereographic", "mercator"):
        return 1.0, 0.0, 1.0
    polar, first = kind == "polar_stereographic", _number(handle, "edition") == 1
    south = polar and _number(handle, "projectionCentreFlag") & 128
    if polar and (_number(handle, "earthIsOblate") or (south and first)):
        raise _Unused("on a polar stereographic grid, southern or on an ellipsoid: not read; ask for a regular grid")
    if kind == "mercator" and _degrees(handle, "orientationOfTheGrid") != 0:
        raise _Unused("on an oblique Mercator grid: not read; ask for a regular grid")
    twice = 0.0 if kind == "mercator" else 2.0 * _degrees(handle, "orientationOfTheGrid" if polar else "LoV")
    sign, shift, flip = (-1.0, twice, 1.0) if scanning & _WESTWARD else (1.0, 0.0, 1.0)
    if not scanning & _NORTHWARD:
        sign, shift, flip = (-sign, twice + 180.0 - shift, 1.0) if polar else (sign, shift, -1.0)
    corner = {key: _degrees(handle, key) for key in ("latitudeOfFirstGridPoint", "longitudeOfFirstGridPoint")}
    latitude, longitude = corner
    changed = {latitude: flip * corner[latitude], longitude: (sign * corner[longitude] + shift) % 360.0}
    if south:
        changed["LaD"] = -abs(_degrees(handle, "LaD"))
    elif kind == "lambert" and flip < 0:
        changed |= {key: -_degrees(handle, key) for key in ("Latin1", "Latin2", *(() if first else ("LaD",)))}
    for key, value in changed.items():
        eccodes.codes_set(handle, f"{key}InDegrees", value)
    return sign, shift, flip
