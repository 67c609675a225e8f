"""Options that several verbs share, and what they change in a request."""

from __future__ import annotations

from dataclasses import replace
from datetime import datetime
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, TypeAlias

import typer

if TYPE_CHECKING:
    from gcs_windplan.planning.request import Request

MissionFile: TypeAlias = Annotated[Path, typer.Argument(metavar="MISSION.yaml", help="The mission file.")]
Airspeed: TypeAlias = Annotated[
    str | None, typer.Option(metavar="SPEED", help="Airspeed in place of the file's: 12, '24 kt', free.")
]
Folder: TypeAlias = Annotated[
    Path | None, typer.Option("-o", "--output", metavar="FOLDER", help="Where to write; default out/NAME.")
]


def read_request(
    mission: Path, airspeed: str | None, departure: datetime | None = None, lasting: float | None = None
) -> Request:
    """The request of a mission file, with the command line's airspeed and departure; `lasting` [s] as in it."""
    from gcs_windplan.errors import InputError, Problem
    from gcs_windplan.jobs.missionfile import read_mission
    from gcs_windplan.jobs.missionfile.values import AIRSPEED_OR_FREE, FREE

    speed = None
    if airspeed is not None:
        try:
            speed = AIRSPEED_OR_FREE.read(airspeed)
        except ValueError as error:
            raise InputError(Problem(str(error), "--airspeed")) from None
    request = read_mission(mission, departure) if lasting is None else read_mission(mission, departure, lasting)
    if speed is None:
        return request
    if speed == FREE:
        if request.airframe is None:
            raise InputError(Problem("to be free to choose asks for the mission's vehicle.airframe", "--airspeed"))
        return replace(request, free_airspeed=True)
    return replace(request, vehicle=replace(request.vehicle, airspeed=float(speed)), free_airspeed=False)


def output_folder(folder: Path | None, request: Request) -> Path:
    """The folder to write into, made if need be."""
    from gcs_windplan.errors import InputError, Problem

    chosen = folder if folder is not None else Path("out") / file_stem(request)
    try:
        chosen.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise InputError(Problem(f"the folder cannot be made ({error.strerror})", file=chosen)) from None
    return chosen


def file_stem(request: Request) -> str:
    """The mission's name as the name of files."""
    return request.name.strip().lower().replace(" ", "_")
