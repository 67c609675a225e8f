"""`gcs-windplan pull`: what a vehicle holds becomes a file."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from gcs_windplan.cli import linking
from gcs_windplan.cli.choices import print_json
from gcs_windplan.jobs.words import Kinds

if TYPE_CHECKING:
    from gcs_windplan.jobs.transfers import Transfer
    from gcs_windplan.mission import MissionItems

HELP = """Pull a vehicle's mission into a .plan or .waypoints file.

Without --type a .plan gets mission, fence and rally points, a .waypoints the mission, which is all that it can hold.
The file is written when everything was read, or not at all.
"""
EPILOG = linking.EPILOG


def pull(
    source: Annotated[str, typer.Option("--from", metavar="ADDRESS", help="Where the vehicle is.")],
    output: Annotated[Path, typer.Option("-o", "--output", metavar="FILE", help="The .plan or .waypoints to write.")],
    kinds: Annotated[Kinds | None, typer.Option("--type", help="Read this alone, or all.")] = None,
    sysid: linking.System = None,
    compid: linking.Component = None,
    sign: linking.KeyFile = None,
    timeout: linking.Timeout = None,
    as_json: linking.Json = False,
) -> None:
    """Read, and write what was read."""
    from gcs_windplan.jobs.transfers import pull as pull_mission

    with linking.answering("pull", as_json), linking.progress(as_json) as progress:
        transfer = pull_mission(
            source,
            output,
            kinds=kinds,
            system=sysid,
            component=compid,
            key_file=sign,
            timeout=timeout,
            progress=progress,
            on_note=linking.note,
        )
    if transfer.mission is None:
        linking.note(f"nothing was written to {output}")
        linking.report(transfer, "pull", as_json)
    else:
        _report(transfer, transfer.mission, output, as_json)


def _report(transfer: Transfer, mission: MissionItems, output: Path, as_json: bool) -> None:
    peer = transfer.peer
    counts: dict[str, int] = {part.mission_type: len(part.items) for part in transfer.parts}
    counts["mission"] = len(mission.items)
    if as_json:
        vehicle = linking.described_peer(peer)
        document = {"verb": "pull", "vehicle": vehicle, "outcome": "accepted", "exit_code": 0, "file": str(output)}
        print_json({**document, "items": counts})
        return
    held = ", ".join(f"{kind} {counts[kind]}" for kind in ("mission", "fence", "rally") if kind in counts)
    typer.echo(f"read from {peer}: items of {held}")
    typer.echo(f"wrote {output}")
