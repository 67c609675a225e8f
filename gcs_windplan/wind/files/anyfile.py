"""A wind file of whatever format: which one, its first bytes tell. Each reader is imported when it is needed."""

from __future__ import annotations

import codecs
import importlib
from collections.abc import Callable
from contextlib import AbstractContextManager
from pathlib import Path
from typing import Any, NamedTuple

from gcs_windplan.errors import Problem, WindError
from gcs_windplan.wind.field_index import FieldIndex

_HEAD = 1000  # [bytes] that are looked at; in front of GRIB there may be a header of the message switch
_READ = "NetCDF, GRIB and answers of Open-Meteo (JSON) are read"
_PACKED = {
    b"\x1f\x8b": ("gzip", "gunzip"),
    b"BZh": ("bzip2", "bunzip2"),
    b"PK\x03\x04": ("zip", "unzip"),
    b"\xfd7zXZ": ("xz", "unxz"),
    b"\x28\xb5\x2f\xfd": ("zstd", "unzstd"),
}


class ForecastFormat(NamedTuple):
    """A format: whether a file's first bytes, also as text in small letters, are of it; who opens it, by module."""

    recognises: Callable[[bytes, str], bool]
    module: str
    opener: str


_HERE = "gcs_windplan.wind.files"
#: The formats, in the order in which they are tried; modules are imported when they are needed.
FORMATS: tuple[ForecastFormat, ...] = (
    ForecastFormat(lambda head, text: head.startswith((b"CDF", b"\x89HDF")), f"{_HERE}.netcdf", "open_netcdf"),
    ForecastFormat(lambda head, text: text.startswith(("{", "[")), f"{_HERE}.openmeteo", "open_openmeteo"),
    ForecastFormat(lambda head, text: b"GRIB" in head, f"{_HERE}.grib", "open_grib"),
)


def open_index(path: Path) -> AbstractContextManager[FieldIndex]:
    """The fields of a forecast file of one of the `FORMATS`, which can be read as long as it is open.

    Raises `WindError` that begins with the path: for a file that is missing, empty or of another format, and whatever
    its reader raises.
    """
    head = _head(path)
    text = _text(head)
    _refuse_others(path, head, text)
    for one in FORMATS:
        if one.recognises(head, text):
            reader: Any = importlib.import_module(one.module)
            index: AbstractContextManager[FieldIndex] = getattr(reader, one.opener)(path)
            return index
    raise WindError(Problem(f"is of no format that is known here; {_READ}", file=path))


def _head(path: Path) -> bytes:
    if path.is_dir():
        raise WindError(Problem(f"is a folder; name one file: {_READ}", file=path))
    try:
        with path.open("rb") as file:
            head = file.read(_HEAD + 4)
    except FileNotFoundError as error:
        raise WindError(Problem(f"no such file; {_READ}", file=path)) from error
    except OSError as error:
        raise WindError(Problem(f"cannot be read ({error.strerror}); {_READ}", file=path)) from error
    if not head.strip(b"\0 \r\n\t"):
        raise WindError(Problem(f"is empty: download it again; {_READ}", file=path))
    return head


def _text(head: bytes) -> str:
    """The head as text without a byte order mark and white space, empty if it is none."""
    encoding = "utf-16" if head.startswith((codecs.BOM_UTF16_LE, codecs.BOM_UTF16_BE)) else "utf-8-sig"
    return head.decode(encoding, errors="replace").lstrip().lower()


def _refuse_others(path: Path, head: bytes, text: str) -> None:
    """Raise `WindError` for files that are not what was meant, and say what they are."""
    for magic, (name, command) in _PACKED.items():
        if head.startswith(magic):
            raise WindError(Problem(f"is packed with {name}: unpack it first (`{command}`); {_READ}", file=path))
    if text.startswith("<?xml") and "<html" not in text:
        raise WindError(Problem(f"is XML, often a server's error: open it to see what went wrong; {_READ}", file=path))
    if text.startswith("<"):
        raise WindError(
            Problem(f"is a web page: the download went wrong, open it in a browser to see why; {_READ}", file=path)
        )
