"""`gcs-windplan diff`: whether two files hold the same mission, as far as a firmware keeps it."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from gcs_windplan.cli import linking
from gcs_windplan.cli.choices import print_json
from gcs_windplan.jobs.words import AutopilotName

if TYPE_CHECKING:
    from gcs_windplan.jobs.diff import MissionDiff

HELP = """Compare two missions: what was planned and what a vehicle gave back, in either order.

What the firmware is known not to keep (ArduPilot: parts of a centimetre, some parameters, frames, its own home) is no
difference. The firmware is what the files say, unless --autopilot does; where nobody says, or the files name two,
every number counts.
"""
EPILOG = "Exit codes: 0 the same; 1 different; 2 a file cannot be read."


def diff(
    one: Annotated[Path, typer.Argument(metavar="A", help="A .plan or .waypoints.")],
    other: Annotated[Path, typer.Argument(metavar="B", help="Another.")],
    autopilot: Annotated[AutopilotName | None, typer.Option(help="Whose rules count.")] = None,
    as_json: linking.Json = False,
) -> None:
    """Read both, compare, report."""
    from gcs_windplan.jobs.diff import diff as compare_missions

    found = compare_missions(one, other, autopilot=autopilot)
    for line in found.notes:
        linking.note(line)
    if as_json:
        parts = {
            kind: {
                "differences": [str(difference) for difference in comparison.differences],
                "losses": [str(loss) for loss in comparison.losses],
            }
            for kind, comparison in found.parts.items()
        }
        document = {"verb": "diff", "same": found.same, "autopilot": found.autopilot, "parts": parts}
        print_json(document)
    else:
        _print(found)
    if not found.same:
        raise typer.Exit(1)


def _print(found: MissionDiff) -> None:
    from gcs_windplan.link.comparison import loss_lines

    for kind, comparison in found.parts.items():
        for difference in comparison.differences:
            typer.echo(f"{kind}: {difference}")
    for kind, comparison in found.parts.items():
        for line in loss_lines(comparison.losses, found.firmware):
            typer.echo(f"{kind}: {line}")
    if found.same:
        typer.echo("the same")
