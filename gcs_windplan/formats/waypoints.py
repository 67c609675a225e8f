"""`QGC WPL 110`, the .waypoints file of Mission Planner, MAVProxy and QGroundControl.

    QGC WPL 110
    0  1  0  16  0  0  0  0   46.8134380    9.8437720   1560.000  1      home
    1  0  3  22  0  0  0  0   46.8134380    9.8437720     40.000  1      take-off
    seq current frame command p1 p2 p3 p4 latitude longitude altitude autocontinue

Written as the strictest reader wants it (QGroundControl: single tabs, 12 fields, no comments, no blank
lines). Read as the most patient ones do, and every repair is said.
"""

from __future__ import annotations

import math
import os
import re
from dataclasses import dataclass
from pathlib import Path

from gcs_windplan.errors import FormatError, InputError, Problem
from gcs_windplan.formats.digits import degrees_text, metres_text, number_text
from gcs_windplan.formats.reading import ReadMission, Repairs, home_or_none, read_text, without_mark
from gcs_windplan.formats.writing import write_atomically
from gcs_windplan.mission import (
    Command,
    Frame,
    Home,
    MissionItem,
    MissionItems,
    command_name,
    is_global,
    plain_frame,
    takes_place,
)

_PARAMS = ("p1", "p2", "p3", "p4")
_PLACE = ("latitude", "longitude", "altitude")
_FIELDS = ("seq", "current", "frame", "command", *_PARAMS, *_PLACE, "autocontinue")
_WHOLE = frozenset(("seq", "current", "frame", "command", "autocontinue"))
_HEADER = re.compile(r"QGC\s+WPL\s+(\d+)", re.IGNORECASE)
_SEPARATORS = re.compile(r"[\s,;]+")

# Version 100 had 13 fields in another order, and commands of its own (pymavlink mavwp.py).
_FIELDS_100 = (
    *("seq", "frame", "command", "p3", "p4", "p1", "p2"),
    *("current", "longitude", "latitude", "altitude", "unused", "autocontinue"),
)
_COMMANDS_100 = {
    2: Command.NAV_TAKEOFF,
    3: Command.NAV_RETURN_TO_LAUNCH,
    4: Command.NAV_LAND,
    24: Command.NAV_TAKEOFF,
    25: Command.NAV_WAYPOINT,
    26: Command.NAV_LAND,
    27: Command.NAV_LOITER_UNLIM,
}


def write_waypoints(mission: MissionItems, path: str | os.PathLike[str]) -> None:
    """Write the mission as a .waypoints file. Raises FormatError: no home, or the file cannot be written."""
    write_atomically(path, format_waypoints(mission))


def format_waypoints(mission: MissionItems) -> str:
    """The text of the mission's .waypoints file.

    Coordinates are rounded to 1e-7 degrees, altitudes to millimetres; the deprecated _INT frames become plain
    ones. Vehicle, autopilot and speeds have no place in this format. Raises FormatError for a mission without home,
    and for one with a fence or rally points: nobody shall take the file for the whole of it.
    `MissionItems.without_fence()` can be written.
    """
    if mission.home is None:
        raise FormatError("a .waypoints file begins with home, and this mission has none: give it one")
    if mission.fence is not None or mission.rally:
        held = " and ".join(["a fence"] * (mission.fence is not None) + ["rally points"] * bool(mission.rally))
        raise FormatError(f"a .waypoints file cannot hold {held}, and this mission has them: write a .plan file")
    rows = [_home_row(mission.home), *(_row(item) for item in mission.items)]
    lines = [f"{seq}\t{int(seq == 0)}\t{row}" for seq, row in enumerate(rows)]
    return "\n".join(["QGC WPL 110", *lines, ""])


def _home_row(home: Home) -> str:
    place = home.point.latitude_deg, home.point.longitude_deg, home.altitude
    return _row(MissionItem(Frame.GLOBAL, Command.NAV_WAYPOINT, (0.0, 0.0, 0.0, 0.0), *place))


def _row(item: MissionItem) -> str:
    fields = [
        str(plain_frame(item.frame)),
        str(int(item.command)),
        *(number_text(param) for param in item.params),
        degrees_text(item.latitude_deg),
        degrees_text(item.longitude_deg),
        metres_text(item.altitude),
        str(int(item.autocontinue)),
    ]
    return "\t".join(fields)


def read_waypoints(path: str | os.PathLike[str]) -> ReadMission:
    """Read a .waypoints file. Raises FormatError with the line and what to do."""
    repairs = Repairs()
    return _parse(read_text(path, repairs), Path(path), repairs)


def parse_waypoints(text: str, name: str = "<text>") -> ReadMission:
    """Read the text of a .waypoints file; `name` stands for the file in messages.

    Separators may be tabs, blanks, commas or semicolons, line ends of any system; comments (#), blank lines,
    a byte order mark, `3.0` for 3, `current` other than 1 on row 0 and rows numbered otherwise are repaired.
    Row 0 is home in versions 100 and 110; version 120 has no home. Raises FormatError.
    """
    return _parse(text, Path(name), Repairs())


def _parse(text: str, file: Path, repairs: Repairs) -> ReadMission:
    lines = _content(without_mark(text, repairs), repairs)
    version = _version(lines[0] if lines else None, file)
    rows = [_Row.parse(number, line, version, file, repairs) for number, line in lines[1:]]
    if not rows:
        raise FormatError(Problem("has no rows after its header: there is no mission in it", file=file))
    _note_numbering(rows, repairs)
    home, items = _split_home(rows, version, repairs)
    shift = 1 if version == 120 else 0
    mission = MissionItems(tuple(_shifted(row.item(repairs), shift) for row in items), home)
    return repairs.read(mission)


def _content(text: str, repairs: Repairs) -> list[tuple[int, str]]:
    """The lines that say something, with their numbers from 1, without comments."""
    if "\r" in text:
        repairs.add("line ends of another system (carriage returns) read as plain ones")
        text = text.replace("\r\n", "\n").replace("\r", "\n")
    lines = text.removesuffix("\n").split("\n")
    found = []
    for number, line in enumerate(lines, start=1):
        content, mark, _ = line.partition("#")
        if mark:
            repairs.add("comment dropped", number)
        elif not content.strip():
            repairs.add("blank line dropped", number)
        if content.strip():
            found.append((number, content if not mark else content.rstrip()))
    return found


def _version(header: tuple[int, str] | None, file: Path) -> int:
    number, line = header or (1, "")
    match = _HEADER.fullmatch(line.strip())
    if match is None:
        message = (
            f"begins with {line.strip()[:40]!r}, not with 'QGC WPL 110': this is no .waypoints mission "
            "(a fence or rally list has no such line); save it as one in your ground station"
        )
        raise FormatError(Problem(message, file=file, line=number))
    if (version := int(match[1])) not in (100, 110, 120):
        message = f"is version {version} of the format, and 100, 110 and 120 are known: save it as 110"
        raise FormatError(Problem(message, file=file, line=number))
    return version


@dataclass(frozen=True, slots=True)
class _Row:
    """A line taken apart."""

    line: int
    file: Path
    values: dict[str, float]

    @classmethod
    def parse(cls, line: int, text: str, version: int, file: Path, repairs: Repairs) -> _Row:
        texts = _SEPARATORS.split(text.strip())
        names = _FIELDS_100 if version == 100 and len(texts) == len(_FIELDS_100) else _FIELDS
        if len(texts) != len(names):
            message = f"has {len(texts)} fields, not {len(names)}: {' '.join(names)}"
            raise FormatError(Problem(message, file=file, line=line))
        if text.split("\t") != texts:
            repairs.add("fields parted by other than single tabs", line)
        row = cls(line, file, {})
        for position, (name, field) in enumerate(zip(names, texts, strict=True), start=1):
            row.values[name] = row._value(position, name, field, repairs)
        return row._from_100(repairs) if names is _FIELDS_100 else row

    def _value(self, position: int, name: str, text: str, repairs: Repairs) -> float:
        whole = name in _WHOLE
        number = _number(text, whole)
        if number is None:
            message = f"field {position} ({name}) is {text!r}, not a {'whole ' if whole else ''}number"
            raise FormatError(Problem(message, file=self.file, line=self.line))
        if whole and not text.isdecimal():
            repairs.add(f"{name} {text!r} read as {number:g}", self.line)
        return number

    def _from_100(self, repairs: Repairs) -> _Row:
        command = _COMMANDS_100.get(int(self.values["command"]))
        if command is None:
            message = (
                f"command {self.values['command']:g} is none of version 100's: "
                f"{', '.join(str(known) for known in _COMMANDS_100)}"
            )
            raise FormatError(Problem(message, file=self.file, line=self.line))
        repairs.add("row of version 100 put into the order of 110", self.line)
        return _Row(self.line, self.file, {**self.values, "command": float(command)})

    def place(self, command: int, repairs: Repairs) -> tuple[float, float, float]:
        """Latitude, longitude and altitude; NaN for latitude and longitude means "here", as 0 does.

        Half a place, or a place without an altitude, is refused: 0 would be somewhere else.
        """
        numbers = [self.values[name] for name in _PLACE]
        unknown = [math.isnan(number) for number in numbers]
        if takes_place(command) and is_global(int(self.values["frame"])) and (unknown[0] != unknown[1] or unknown[2]):
            name = _PLACE[unknown.index(True)]
            message = f"{name} is 'nan', and {command_name(command)} needs one: write the number"
            raise FormatError(Problem(message, file=self.file, line=self.line))
        if any(unknown):
            names = [name for name, gone in zip(_PLACE, unknown, strict=True) if gone]
            repairs.add(f"{' and '.join(names)} 'nan' read as 0", self.line)
        latitude, longitude, altitude = (0.0 if gone else number for number, gone in zip(numbers, unknown, strict=True))
        return latitude, longitude, altitude

    def item(self, repairs: Repairs) -> MissionItem:
        value = self.values
        frame, command = int(value["frame"]), int(value["command"])
        p1, p2, p3, p4 = (value[name] for name in _PARAMS)
        latitude, longitude, altitude = self.place(command, repairs)
        proceed = bool(value["autocontinue"])
        try:
            return MissionItem(frame, command, (p1, p2, p3, p4), latitude, longitude, altitude, proceed)
        except InputError as error:
            raise FormatError(Problem(str(error), file=self.file, line=self.line)) from error

    def home(self, repairs: Repairs) -> Home | None:
        """The row as home, whatever its command says: so does QGroundControl, and ArduPilot overwrites it."""
        command, frame = int(self.values["command"]), int(self.values["frame"])
        if command not in (0, Command.NAV_WAYPOINT):
            repairs.add(f"row 0 is home in this format; its {command_name(command)} is not flown", self.line)
        if plain_frame(frame) != Frame.GLOBAL:
            repairs.add(f"home's altitude read as above sea level, though its frame is {frame}", self.line)
        latitude, longitude, altitude = self.place(Command.NAV_WAYPOINT, repairs)
        try:
            return home_or_none(latitude, longitude, altitude, repairs)
        except InputError as error:
            raise FormatError(Problem(f"home: {error}", file=self.file, line=self.line)) from error


def _number(text: str, whole: bool) -> float | None:
    """The number, or None where the text is none; a whole one may be written `3.0`."""
    try:
        number = float(text)
    except ValueError:
        return None
    if "_" in text or math.isinf(number) or (whole and number != number // 1):
        return None
    return number


def _split_home(rows: list[_Row], version: int, repairs: Repairs) -> tuple[Home | None, list[_Row]]:
    first = rows[0]
    if version == 120:
        repairs.add("version 120 has no home row; every row is an item")
        return None, rows
    if first.values["seq"] != 0:
        repairs.add(f"the first row is number {first.values['seq']:g}, so the file has no home", first.line)
        return None, rows
    return first.home(repairs), rows[1:]


def _note_numbering(rows: list[_Row], repairs: Repairs) -> None:
    """Rows are taken in the order of the file, as every other reader takes them, whatever their numbers."""
    first = rows[0].values["seq"]
    for position, row in enumerate(rows):
        if row.values["seq"] != first + position:
            repairs.add("numbered out of order; the order in the file counts", row.line)
        if row.values["current"] > 1:
            repairs.add(f"current {row.values['current']:g} would mean 'fly there now'; ignored", row.line)


def _shifted(item: MissionItem, shift: int) -> MissionItem:
    """The item with a DO_JUMP's target counted from 1, where the file counts from 0."""
    if not shift or item.command != Command.DO_JUMP:
        return item
    p1, *rest = item.params
    place = item.latitude_deg, item.longitude_deg, item.altitude
    return MissionItem(item.frame, item.command, (p1 + shift, rest[0], rest[1], rest[2]), *place, item.autocontinue)
