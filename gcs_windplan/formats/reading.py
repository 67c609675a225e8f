"""What the readers of mission files share: the result, the list of repairs, and how a file is opened."""

from __future__ import annotations

import os
from dataclasses import dataclass, field
from pathlib import Path

from gcs_windplan.errors import FormatError, Problem
from gcs_windplan.geo.frame import GeoPoint
from gcs_windplan.mission import Home, MissionItems

_LINES_SHOWN = 5


@dataclass(frozen=True, slots=True)
class ReadMission:
    """A mission read from a file, and what had to be repaired or left out on the way, a sentence each.

    `left_out` are those of the repairs that left out parts of its fence or rally points.

    >>> import gcs_windplan as gw
    >>> gw.ReadMission(gw.MissionItems(())).repairs
    ()
    """

    mission: MissionItems
    repairs: tuple[str, ...] = ()
    left_out: tuple[str, ...] = ()


@dataclass(slots=True)
class Repairs:
    """Collects repairs while a file is read; one sentence for all lines with the same."""

    _lines: dict[str, list[int]] = field(default_factory=dict)
    _left_out: list[str] = field(default_factory=list)

    def add(self, message: str, line: int | None = None) -> None:
        """Note a repair, of the whole file or of a line."""
        lines = self._lines.setdefault(message, [])
        if line is not None:
            lines.append(line)

    def leave_out(self, message: str) -> None:
        """Note that a part of the fence or of the rally points was left out."""
        self.add(message)
        self._left_out.append(message)

    def read(self, mission: MissionItems) -> ReadMission:
        """The mission with its repairs."""
        return ReadMission(mission, self.sentences(), tuple(self._left_out))

    def sentences(self) -> tuple[str, ...]:
        """One sentence for each kind, in the order of first appearance."""
        return tuple(_sentence(message, lines) for message, lines in self._lines.items())


def _sentence(message: str, lines: list[int]) -> str:
    if not lines:
        return message
    shown = ", ".join(str(line) for line in lines[:_LINES_SHOWN])
    more = len(lines) - _LINES_SHOWN
    rest = f" and {more} more" if more > 0 else ""
    return f"line{'s' if len(lines) > 1 else ''} {shown}{rest}: {message}"


def read_text(path: str | os.PathLike[str], repairs: Repairs) -> str:
    """The file's text with its line ends and mark as they are: UTF-8, else Latin-1, which is noted.

    Raises FormatError when it cannot be opened, or is UTF-16 or binary.
    """
    try:
        data = Path(path).read_bytes()
    except OSError as error:
        reason = (error.strerror or str(error)).lower()
        raise FormatError(Problem(f"cannot be read ({reason}): check the name", file=Path(path))) from error
    if b"\0" in data:
        raise FormatError(Problem("is not plain text (it has zero bytes): save it as UTF-8 text", file=Path(path)))
    try:
        return data.decode("utf-8")
    except UnicodeDecodeError:
        repairs.add("the file is not UTF-8; it was read as Latin-1")
        return data.decode("latin-1")


def without_mark(text: str, repairs: Repairs) -> str:
    """The text without a byte order mark at its start; dropping one is noted."""
    if text.startswith("\ufeff"):
        repairs.add("byte order mark dropped", 1)
        return text[1:]
    return text


def home_or_none(latitude_deg: float, longitude_deg: float, altitude: float, repairs: Repairs) -> Home | None:
    """The home of a file, or None where it says 0, 0, as ground stations write when they know none."""
    if latitude_deg == longitude_deg == 0:
        repairs.add("home is a blank (0, 0); it was left out")
        return None
    return Home(GeoPoint(latitude_deg, longitude_deg), altitude)
