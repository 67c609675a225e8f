"""`gcs-windplan check`: what a firmware will make of a mission, by its rules alone."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from gcs_windplan.cli import linking
from gcs_windplan.cli.choices import option_name, print_json
from gcs_windplan.jobs.words import AutopilotName, VehicleKind

if TYPE_CHECKING:
    from gcs_windplan.jobs.check import Check

HELP = """Say what a firmware will reject, drop, round, change or ignore of a mission.

FILE is a .plan or .waypoints, or a mission file (.yaml), which is planned first. The rules are the firmware's own, with
its default parameters: terrain and wind do not come into it. The firmware is what the file says, unless --autopilot
and --vehicle-type do. Items count from 1; home is 0.
"""
EPILOG = (
    "Exit codes: 0 nothing found but roundings of places below a centimetre; 1 something found (or no route exists, of "
    "a mission file to be planned); "
    "2 something handed in cannot be used."
)
_EFFECTS = "rejected, dropped, rounded, changed or ignored"


def check(
    file: Annotated[Path, typer.Argument(metavar="FILE", help="A .plan, a .waypoints, or a mission file.")],
    autopilot: Annotated[AutopilotName | None, typer.Option(help="Whose rules count.")] = None,
    vehicle_type: Annotated[VehicleKind | None, typer.Option(help="The kind of vehicle whose rules count.")] = None,
    as_json: linking.Json = False,
) -> None:
    """Read or plan, look, report."""
    from gcs_windplan.jobs.check import check as check_mission

    with linking.answering("check", as_json):
        found = check_mission(file, autopilot=autopilot, vehicle_type=vehicle_type, named=option_name)
    for line in found.notes:
        linking.note(f"{file}: {line}")
    if as_json:
        _print_json(file, found)
    else:
        _print(file, found)
    if found.matters:
        raise typer.Exit(1)


def _print(file: Path, found: Check) -> None:
    from gcs_windplan.mission.lint import finding_lines

    for line in finding_lines(found.findings):
        typer.echo(f"{line.effect:<8}  {line.line}")
    head = f"{file.name} for {found.firmware.full_name}"
    if not found.findings:
        typer.echo(f"{head}: nothing {_EFFECTS} in {found.items} item{'' if found.items == 1 else 's'}")
        return
    typer.echo(f"{head}: {', '.join(f'{number} {effect}' for effect, number in found.counts.items())}")


def _print_json(file: Path, found: Check) -> None:
    document = {
        "verb": "check",
        "file": str(file),
        "autopilot": found.firmware.autopilot,
        "vehicle_type": found.firmware.vehicle_type,
        "items": found.items,
        "counts": found.counts,
        "findings": [
            {"rule": one.rule, "effect": one.effect, "item": one.item, "message": one.message} for one in found.findings
        ],
        "notes": list(found.notes),
        "exit_code": 1 if found.matters else 0,
    }
    print_json(document)
