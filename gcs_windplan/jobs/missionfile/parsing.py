"""A mission file as text becomes a checked document."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Final

from gcs_windplan.errors import Problem
from gcs_windplan.jobs.missionfile.checking import check_text, read_text
from gcs_windplan.jobs.missionfile.marks import Marks
from gcs_windplan.jobs.missionfile.model import MissionModel

_KIND: Final = "mission file"
_LARGEST_FILE: Final = 10_000_000  # bytes; a mission with 200 000 corners has less


@dataclass(frozen=True)
class MissionDocument:
    """A checked mission, and where each of its fields stands in the file."""

    model: MissionModel
    file: Path
    marks: Marks

    def place(self, field: str) -> tuple[int, int]:
        """Line and column, from 1, of a field's value (`vehicle.airspeed`, `via.0`, `limits.keep_out.1.polygon`).

        That of the nearest section around it where the field itself is absent.
        """
        return self.marks.place(_split(field))

    def problem(self, field: str, message: str) -> Problem:
        """A problem with a field, with its place in the file."""
        return Problem(message, field, self.file, *self.place(field))

    def beside(self, name: str) -> Path:
        """The path of a file that the mission names: relative names count from the mission file's folder."""
        return self.file.parent / name


def read_document(path: Path) -> MissionDocument:
    """The mission in a file; raises `MissionFileError`."""
    return parse_mission(read_text(path, _KIND, _LARGEST_FILE), path)


def parse_mission(text: str, file: Path) -> MissionDocument:
    """The mission in a YAML text; `file` names it in messages and is where relative names count from.

    Raises `MissionFileError` with every problem, in the order of the lines.
    """
    model, marks = check_text(MissionModel, text, file, _KIND, "name: ridge")
    return MissionDocument(model, file, marks)


def _split(field: str) -> list[str | int]:
    return [int(part) if part.isascii() and part.isdigit() else part for part in field.split(".")]
