"""`gcs-windplan clear`: delete what a vehicle holds, and look whether it is gone."""

from __future__ import annotations

from typing import Annotated

import typer

from gcs_windplan.cli import linking
from gcs_windplan.jobs.words import Kinds

HELP = "Delete a vehicle's mission, fence or rally points, and read back that nothing is left (but ArduPilot's home)."
EPILOG = linking.EPILOG


def clear(
    on: Annotated[str, typer.Option("--on", metavar="ADDRESS", help="Where the vehicle is.")],
    kinds: Annotated[Kinds, typer.Option("--type", help="What.")] = "mission",
    sysid: linking.System = None,
    compid: linking.Component = None,
    sign: linking.KeyFile = None,
    timeout: linking.Timeout = None,
    verify: Annotated[bool, typer.Option("--verify/--no-verify", help="Look whether it is gone, or believe.")] = True,
    as_json: linking.Json = False,
) -> None:
    """Delete and report."""
    from gcs_windplan.jobs.transfers import clear as clear_vehicle

    with linking.answering("clear", as_json):
        transfer = clear_vehicle(
            on, kinds=kinds, system=sysid, component=compid, key_file=sign, timeout=timeout, verify=verify
        )
    linking.report(transfer, "clear", as_json)
