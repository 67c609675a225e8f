"""`gcs-windplan push`: a mission goes to a vehicle, and is read back before anybody believes it."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from gcs_windplan.cli import linking
from gcs_windplan.jobs.words import Kinds

HELP = """Push a mission to a vehicle, read it back and compare.

FILE is a .plan or .waypoints, or a mission file (.yaml), which is planned first. It ends in one of three words:
accepted (the vehicle said so, and what was read back is what was sent, as far as its firmware keeps it), rejected,
or unknown. Without --type everything goes that the file holds: its mission, and its fence and rally points if it has
any; what the vehicle has of kinds that the file lacks stays. Ctrl-C cancels the transfer and tells the vehicle.
"""
EPILOG = linking.EPILOG

_TYPE_HELP = (
    "Send this alone; with all, the vehicle shall hold exactly what the file holds, so that a fence and rally points"
    " that the file lacks are deleted."
)


def push(
    file: Annotated[Path, typer.Argument(metavar="FILE", help="A .plan, a .waypoints, or a mission file.")],
    to: Annotated[str, typer.Option("--to", metavar="ADDRESS", help="Where the vehicle is.")],
    kinds: Annotated[Kinds | None, typer.Option("--type", help=_TYPE_HELP)] = None,
    sysid: linking.System = None,
    compid: linking.Component = None,
    sign: linking.KeyFile = None,
    timeout: linking.Timeout = None,
    verify: Annotated[bool, typer.Option("--verify/--no-verify", help="Read back and compare, or believe.")] = True,
    as_json: linking.Json = False,
) -> None:
    """Read or plan, push, report."""
    from gcs_windplan.jobs.transfers import push as push_mission

    with linking.answering("push", as_json), linking.progress(as_json) as progress:
        transfer = push_mission(
            file,
            to,
            kinds=kinds,
            system=sysid,
            component=compid,
            key_file=sign,
            timeout=timeout,
            verify=verify,
            progress=progress,
            on_note=linking.note,
            named={"kinds": "--type"}.__getitem__,
        )
    homes = transfer.homes
    if homes is not None and homes.apart:
        typer.echo(f"WARNING: {homes}", err=True)
    linking.report(transfer, "push", as_json, {} if homes is None else {"home": homes.described()})
