"""`gcs-windplan plan`: a mission file becomes a route, mission files and pictures."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from gcs_windplan.cli.choices import Airspeed, Folder, MissionFile, asked_mission, file_stem, output_folder

if TYPE_CHECKING:
    from gcs_windplan.planning.planner import PlannedRoute
    from gcs_windplan.planning.request import Request

HELP = "Plan a route; write .waypoints, .plan, summary.json, map.png and profile.png; print its legs."


def plan(
    mission: MissionFile,
    cost: Annotated[
        str | None,
        typer.Option(metavar="COST", help="distance, angle, hybrid, time or energy in place of the file's."),
    ] = None,
    airspeed: Airspeed = None,
    output: Folder = None,
    speed_changes: Annotated[
        bool | None,
        typer.Option("--speed-changes/--no-speed-changes", help="Command each leg's ground speed, or none."),
    ] = None,
    force: Annotated[bool, typer.Option("--force", help="Write it even if it breaks the battery's reserve.")] = False,
) -> None:
    """Plan and write."""
    asked = asked_mission(mission, airspeed)

    from gcs_windplan.cli.tables import print_legs
    from gcs_windplan.jobs.mission import as_cost
    from gcs_windplan.jobs.plans import plan as plan_mission

    if cost is not None and cost != as_cost(asked.cost).name:
        asked = replace(asked, cost=cost)
    if speed_changes is not None:
        asked = replace(asked, export=replace(asked.export, speed_changes=speed_changes))
    planned = plan_mission(asked, keep_reserve=not force)
    request = planned.request
    files = render(planned)
    folder = output_folder(output, request.name)
    written = write(files, folder)
    print_legs(planned)
    report(written)
    beside = [name for name, there in (("fence", request.fence), ("rally points", request.rally)) if there]
    if request.export.waypoints and beside:
        stem = file_stem(request.name)
        typer.echo(f"note: {stem}.waypoints has no place for {' and '.join(beside)}: upload {stem}.plan")
    for path in stale(folder, request, files):
        typer.echo(f"note: {path} is of an earlier plan; this one does not write it")


def render(planned: PlannedRoute) -> dict[str, str | bytes]:
    """The content of every file of a plan, by file name; nothing is written yet."""
    from gcs_windplan.formats import format_plan, format_waypoints
    from gcs_windplan.formats.summary import format_summary
    from gcs_windplan.planning.export import mission_of
    from gcs_windplan.report import draw_map, draw_profile

    request = planned.request
    stem = file_stem(request.name)
    mission = mission_of(planned)
    files: dict[str, str | bytes] = {}
    if request.export.waypoints:
        files[f"{stem}.waypoints"] = format_waypoints(mission.without_fence())
    if request.export.plan:
        files[f"{stem}.plan"] = format_plan(mission)
    files["summary.json"] = format_summary(planned)
    files["map.png"] = draw_map([planned])
    files["profile.png"] = draw_profile(planned)
    return files


def write(files: dict[str, str | bytes], folder: Path) -> list[Path]:
    """Write files into a folder, each whole or not at all; nothing if one of the names is taken by a folder."""
    from gcs_windplan.errors import InputError, Problem
    from gcs_windplan.formats import write_atomically

    for name in files:
        if (folder / name).is_dir():
            raise InputError(
                Problem("is a folder, and a file of this name is to be written: move it", file=folder / name)
            )
    for name, content in files.items():
        write_atomically(folder / name, content)
    return [folder / name for name in files]


def report(paths: list[Path]) -> None:
    """Say what was written."""
    for path in paths:
        typer.echo(f"wrote {path}")


def stale(folder: Path, request: Request, files: dict[str, str | bytes]) -> list[Path]:
    """Mission files of an earlier plan in the same folder, which somebody might upload in place of this one's."""
    names = (f"{file_stem(request.name)}.waypoints", f"{file_stem(request.name)}.plan")
    return [folder / name for name in names if name not in files and (folder / name).exists()]
