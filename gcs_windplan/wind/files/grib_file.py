"""The messages of a GRIB file, cut into fields, and what their first octets say; without eccodes.

eccodes does this slowly, and cuts messages by a switch that holds for the whole process. Octets, code and flag tables:
WMO-No. 306, volume I.2, FM 92 GRIB.
"""

from __future__ import annotations

from collections.abc import Iterator
from datetime import UTC, datetime
from typing import BinaryIO, NamedTuple, TypeAlias

from gcs_windplan.errors import WindError

_CHUNK = 8192  # [bytes] that are searched at a time for the next message
MEMBERS, DERIVED = (1, 11), (2, 12)  # edition 2, table 4.0
ENDS = {8: 34, 11: 37, 12: 36}  # where products over a time span tell its end in section 4, octets from 0
PRODUCTS = (0, *MEMBERS, *DERIVED, *ENDS)
_UNITS = {0: 60, 1: 3600, 2: 86400, 10: 10800, 11: 21600, 12: 43200}  # [s] edition 1, table 4; edition 2, table 4.4
_UNITS_1, _UNITS_2 = _UNITS | {13: 900, 14: 1800, 254: 1}, _UNITS | {13: 1}
_ANALYSIS, _LONG_STEP = 1, 10  # edition 1, table 5


class ByteRange(NamedTuple):
    """A part of the file [bytes]."""

    offset: int
    length: int


#: A field: its whole message in edition 1, its sections in edition 2, section 0 first.
RawField: TypeAlias = tuple[ByteRange, ...]


class Header(NamedTuple):
    """What tells fields of one kind apart, and what they share.

    Times [s since 1970, UTC], None where they cannot be told; `number` of the member in edition 2.
    """

    shared: bytes
    run: float | None
    time: float | None
    number: int | None = None


def read_bytes(file: BinaryIO, span: ByteRange) -> bytes:
    """The octets of a part of the file."""
    file.seek(span.offset)
    return file.read(span.length)


def messages_in(file: BinaryIO) -> Iterator[ByteRange]:
    """Every message; what lies between messages is skipped. Raises `WindError` for a file that is not whole."""
    size, position, good = file.seek(0, 2), 0, 0
    while (start := _search(file, position)) is not None:
        span = ByteRange(start, _length(file, start))
        position = start + (span.length or 4)
        if position > size:
            raise WindError(
                f"it ends {position - size} bytes before its last message does, after {good} whole ones: the download"
                " was cut short, fetch it again"
            )
        if span.length:
            if read_bytes(file, ByteRange(position - 4, 4)) != b"7777":
                raise WindError(f"its message at byte {start} does not end where it should: download it again")
            good += 1
            yield span
    if not good:
        packed = read_bytes(file, ByteRange(0, 2)) in (b"BZ", b"\x1f\x8b", b"PK")
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
    head = read_bytes(file, ByteRange(start, 16))
    if len(head) < 16:
        return 16
    if head[7] != 1:
        return int.from_bytes(head[8:16]) if head[7] == 2 else 0
    length, rest = int.from_bytes(head[4:7]), _sections_1(file, start)[-1].length
    if length < 1 << 23 or rest >= 120:
        return length
    return (length - (1 << 23)) * 120 - rest + 4  # beyond 16 MB ECMWF counts in units of 120 bytes


def _sections_1(file: BinaryIO, start: int) -> list[ByteRange]:
    """Sections 1 to 4 of a message of edition 1, without those that it has not."""
    flags, position, sections = read_bytes(file, ByteRange(start + 15, 1))[0], start + 8, []
    for there in (True, flags & 128, flags & 64, True):
        if there:
            sections.append(ByteRange(position, int.from_bytes(read_bytes(file, ByteRange(position, 3)))))
            position += sections[-1].length
    return sections


def fields_of(file: BinaryIO, message: ByteRange) -> Iterator[RawField]:
    """The fields of a message. Raises `WindError`.

    After its data (section 7) a message of edition 2 may go on with any of sections 2 to 7; those not repeated hold on.
    """
    damaged = WindError(f"the sections of its message at byte {message.offset} do not fit: download it again")
    if read_bytes(file, ByteRange(message.offset, 8))[7] == 1:
        last = _sections_1(file, message.offset)[-1]
        if message.length < 1 << 23 and last.offset + last.length != message.offset + message.length - 4:
            raise damaged
        yield (message,)
        return
    sections = {0: ByteRange(message.offset, 16)}
    bitmap, position, end = ByteRange(0, 0), message.offset + 16, message.offset + message.length - 4
    while position < end:
        head = read_bytes(file, ByteRange(position, 6))
        span, number = ByteRange(position, int.from_bytes(head[:4])), head[4]
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


def header_of(file: BinaryIO, field: RawField) -> Header:
    """What the first sections of a field say. Raises `WindError`."""
    if len(field) == 1:
        return _header_1(file, field[0].offset)
    if len(field) < 7:
        raise WindError(f"its message at byte {field[0].offset} lacks a section: download it again")
    return _header_2([read_bytes(file, span) for span in field[:-3]])


def _header_1(file: BinaryIO, start: int) -> Header:
    spans = _sections_1(file, start)
    one = read_bytes(file, spans[0])
    two = read_bytes(file, spans[1]) if one[7] & 128 else b""
    shared = one[:12] + one[17:18] + one[20:24] + one[25:] + two
    run = _moment(100 * (one[24] - 1) + one[12], *one[13:17])
    first, second, span = one[18:21]
    steps = {0: first, _ANALYSIS: 0, _LONG_STEP: 256 * first + second}.get(span, second)
    return Header(shared, run, _later(run, steps, _UNITS_1.get(one[17])))


def _header_2(sections: list[bytes]) -> Header:
    zero, one, product = sections[0], sections[1], bytearray(sections[-1])
    run, time, number = _moment(int.from_bytes(one[12:14]), *one[14:19]), None, None
    template = int.from_bytes(product[7:9])
    if template in PRODUCTS:
        steps = int.from_bytes(product[18:22])
        time = _later(run, steps if steps < 1 << 31 else (1 << 31) - steps, _UNITS_2.get(product[17]))
        product[18:22] = bytes(4)
    if template in ENDS:
        end = ENDS[template]
        time = _moment(int.from_bytes(product[end : end + 2]), *product[end + 2 : end + 7])
        product[end : end + 7] = bytes(7)
    if template in MEMBERS:
        number, product[35] = product[35], 0
    shared = zero[6:7] + one[5:12] + one[19:] + b"".join(sections[2:-1]) + product
    return Header(shared, run, time, number)


def _moment(year: int, month: int, day: int, hour: int, minute: int, second: int = 0) -> float | None:
    """Seconds since 1970, UTC, None for what is no date."""
    try:
        return datetime(year, month, day, hour, minute, second, tzinfo=UTC).timestamp()
    except ValueError:
        return None


def _later(run: float | None, steps: int, unit: int | None) -> float | None:
    return None if run is None or unit is None else run + steps * unit
