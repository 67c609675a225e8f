"""`gcs-windplan plan`: a mission file becomes a route, mission files and pictures."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Annotated

import typer

from gcs_windplan.cli.choices import Airspeed, Folder, MissionFile, asked_mission, output_folder

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
    from gcs_windplan.jobs.outputs import file_notes, plan_files, write_files
    from gcs_windplan.jobs.plans import plan as plan_mission

    if cost is not None and cost != as_cost(asked.cost).name:
        asked = replace(asked, cost=cost)
    if speed_changes is not None:
        asked = replace(asked, export=replace(asked.export, speed_changes=speed_changes))
    planned = plan_mission(asked, keep_reserve=not force)
    files = plan_files(planned)
    folder = output_folder(output, asked.name)
    written = write_files(files, folder)
    print_legs(planned)
    report(written)
    for note in file_notes(planned.request, files, folder):
        typer.echo(f"note: {note}")


def report(paths: list[Path]) -> None:
    """Say what was written."""
    for path in paths:
        typer.echo(f"wrote {path}")
