"""`gcs-windplan clear`: delete what a vehicle holds, and look whether it is gone."""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated, Literal

import typer

from gcs_windplan.cli import linking

if TYPE_CHECKING:
    from gcs_windplan.link.verified import TransferPart
    from gcs_windplan.mission.firmware import MissionType

HELP = "Delete a vehicle's mission, fence or rally points, and read back that nothing is left (but ArduPilot's home)."

_ALL: tuple[MissionType, ...] = ("mission", "fence", "rally")


def clear(
    on: Annotated[str, typer.Option("--on", metavar="ADDRESS", help="Where the vehicle is.")],
    kinds: Annotated[Literal["mission", "fence", "rally", "all"], typer.Option("--type", help="What.")] = "mission",
    sysid: linking.System = None,
    compid: linking.Component = None,
    sign: linking.KeyFile = None,
    timeout: linking.Timeout = None,
    verify: Annotated[bool, typer.Option("--verify/--no-verify", help="Look whether it is gone, or believe.")] = True,
    as_json: linking.Json = False,
) -> None:
    """Delete type after type, until one is not accepted."""
    wanted = tuple(kind for kind in _ALL if kinds in (kind, "all"))
    parts: list[TransferPart] = []
    with linking.answering("clear", as_json), linking.vehicle(on, sysid, compid, sign, timeout) as (session, peer):
        from gcs_windplan.link.verified import clear_items

        for kind in wanted:
            parts.append(clear_items(session, peer, kind, verify=verify))
            if parts[-1].outcome.verdict != "accepted":
                break
    linking.report(parts, wanted[len(parts) :], peer, "clear", as_json)
