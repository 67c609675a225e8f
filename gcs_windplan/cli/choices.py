"""Options that several verbs share, and what they change in a request."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, TypeAlias

import typer

if TYPE_CHECKING:
    from gcs_windplan.jobs.mission import Mission

MissionFile: TypeAlias = Annotated[Path, typer.Argument(metavar="MISSION.yaml", help="The mission file.")]
Airspeed: TypeAlias = Annotated[
    str | None, typer.Option(metavar="SPEED", help="Airspeed in place of the file's: 12, '24 kt', free.")
]
Folder: TypeAlias = Annotated[
    Path | None, typer.Option("-o", "--output", metavar="FOLDER", help="Where to write; default out/NAME.")
]


def option_name(name: str) -> str:
    """How the command line calls what the library asks for: `max_gust` is `--max-gust`."""
    return f"--{name.replace('_', '-')}"


@contextmanager
def options_named() -> Iterator[None]:
    """Errors about what the library was asked in words name the option that said it."""
    from gcs_windplan.errors import InputError

    try:
        yield
    except InputError as error:
        named = [
            replace(one, field=option_name(one.field)) if one.field is not None and one.file is None else one
            for one in error.problems
        ]
        raise error.told_as(named) from None


def asked_mission(file: Path, airspeed: str | None) -> Mission:
    """The mission in a mission file, with the command line's airspeed."""
    from gcs_windplan.jobs.missionfile import read_mission

    mission = read_mission(file)
    if airspeed is None:
        return mission
    with options_named():
        return replace(mission, airspeed=airspeed)


def print_json(document: object) -> None:
    """Print a document for scripts."""
    from gcs_windplan.json_text import json_text

    typer.echo(json_text(document))


def output_folder(folder: Path | None, name: str) -> Path:
    """The folder to write into, made if need be."""
    from gcs_windplan.jobs.outputs import file_stem, make_folder

    return make_folder(folder if folder is not None else Path("out") / file_stem(name))
