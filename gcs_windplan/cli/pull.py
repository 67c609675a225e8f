"""`gcs-windplan pull`: what a vehicle holds becomes a file."""

from __future__ import annotations

import json
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Literal

import typer

from gcs_windplan.cli import linking

if TYPE_CHECKING:
    from gcs_windplan.link.peer import Peer
    from gcs_windplan.link.session import Session
    from gcs_windplan.link.verified import TransferPart
    from gcs_windplan.mission import Home, Mission
    from gcs_windplan.mission.firmware import MissionType

HELP = """Pull a vehicle's mission into a .plan or .waypoints file.

Without --type a .plan gets mission, fence and rally points, a .waypoints the mission, which is all that it can hold.
The file is written when everything was read, or not at all.
"""

_ALL: tuple[MissionType, ...] = ("mission", "fence", "rally")


def pull(
    source: Annotated[str, typer.Option("--from", metavar="ADDRESS", help="Where the vehicle is.")],
    output: Annotated[Path, typer.Option("-o", "--output", metavar="FILE", help="The .plan or .waypoints to write.")],
    kinds: Annotated[
        Literal["mission", "fence", "rally", "all"] | None, typer.Option("--type", help="Read this alone, or all.")
    ] = None,
    sysid: linking.System = None,
    compid: linking.Component = None,
    sign: linking.KeyFile = None,
    timeout: linking.Timeout = None,
    as_json: linking.Json = False,
) -> None:
    """Read, and write what was read."""
    with linking.answering("pull", as_json):
        wanted = _wanted(output, kinds)
        with linking.vehicle(source, sysid, compid, sign, timeout) as (session, peer):
            parts = _pull(session, peer, wanted, optional=kinds is None, as_json=as_json)
            if all(part.outcome.verdict == "accepted" for part in parts):
                mission = _assembled(session, peer, parts)
                _write(mission, output)
    if any(part.outcome.verdict != "accepted" for part in parts):
        linking.note(f"nothing was written to {output}")
        linking.report(parts, (), peer, "pull", as_json)
    _report(mission, parts, peer, output, as_json)


def _wanted(output: Path, kinds: str | None) -> tuple[MissionType, ...]:
    from gcs_windplan.errors import FormatError, Problem

    suffix = output.suffix.lower()
    if suffix not in (".plan", ".waypoints"):
        raise FormatError(Problem("ends neither in .plan nor in .waypoints: name it so", file=output))
    _refuse_unwritable(output)
    if suffix == ".waypoints" and kinds not in (None, "mission"):
        raise FormatError(
            Problem("is a .waypoints, which holds no fence and no rally points: write a .plan", file=output)
        )
    if kinds == "all" or (kinds is None and suffix == ".plan"):
        return _ALL
    return tuple(kind for kind in _ALL if kind == (kinds or "mission"))


def _refuse_unwritable(output: Path) -> None:
    """See before anything is read whether the file can be written."""
    import os

    from gcs_windplan.errors import FormatError, Problem

    problem = ""
    try:
        if not output.parent.is_dir():
            problem = "its folder is not there: make it first"
        elif output.is_dir():
            problem = "is a folder: add a file name"
        elif not os.access(Path(os.path.realpath(output)).parent, os.W_OK | os.X_OK):
            problem = "its folder cannot be written: choose another, or make it writable"
    except OSError as error:
        problem = f"cannot be written ({(error.strerror or str(error)).lower()}): choose another name"
    if problem:
        raise FormatError(Problem(problem, file=output))


def _pull(
    session: Session, peer: Peer, wanted: tuple[MissionType, ...], optional: bool, as_json: bool
) -> list[TransferPart]:
    """Read type after type, until one fails; a vehicle that has no fence or rally points at all is no failure."""
    from gcs_windplan.link.outcome import UNSUPPORTED
    from gcs_windplan.link.verified import pull_items

    parts: list[TransferPart] = []
    for kind in wanted:
        with linking.progress(f"{kind} of {peer.ident}", as_json) as watch:
            part = pull_items(session, peer, kind, watch=watch)
        outcome = part.outcome
        if optional and kind != "mission" and (outcome.reason == "mavlink1" or outcome.code == UNSUPPORTED):
            linking.note(f"{kind} left out: {outcome.message}")
            continue
        parts.append(part)
        if outcome.verdict != "accepted":
            break
    return parts


def _assembled(session: Session, peer: Peer, parts: list[TransferPart]) -> Mission:
    """One mission of all parts, with a home, as both formats need one."""
    from gcs_windplan.errors import InputError, LinkError, RefusedError
    from gcs_windplan.link.firmware import incoming_mission, with_fence, with_rally

    items = {part.mission_type: part.items for part in parts}
    try:
        mission = incoming_mission(items.get("mission", ()), peer.firmware, peer.vehicle_type)
        mission = with_rally(with_fence(mission, items.get("fence", ())), items.get("rally", ()))
    except InputError as error:
        raise LinkError(f"what the vehicle holds makes no sense: {error}") from error
    if not mission.items and mission.fence is None and not mission.rally:
        raise RefusedError(f"the vehicle holds no {', no '.join(items)}: nothing was written")
    if mission.home is not None:
        return mission
    home = session.ask_home(peer)
    if session.interrupted:
        raise LinkError("interrupted: nothing was written")
    return _with_home(mission, home)


def _with_home(mission: Mission, home: Home | None) -> Mission:
    """The mission with the vehicle's home; else with a made-up one, which is said."""
    from dataclasses import replace

    from gcs_windplan.errors import RefusedError
    from gcs_windplan.geo.frame import GeoPoint
    from gcs_windplan.mission import Home, fence_items, rally_items

    if home is None:
        items = (*mission.items, *rally_items(mission.rally), *fence_items(mission.fence))
        place = next((GeoPoint(item.latitude_deg, item.longitude_deg) for item in items if item.has_place), None)
        if place is None:
            raise RefusedError("the vehicle told no home, and nothing that it holds has a place: nothing was written")
        linking.note("the vehicle told no home: the file's is at its first item's place, at 0 m above sea level")
        home = Home(place, 0.0)
    return replace(mission, home=home)


def _write(mission: Mission, output: Path) -> None:
    from gcs_windplan.formats import write_plan, write_waypoints

    (write_plan if output.suffix.lower() == ".plan" else write_waypoints)(mission, output)


def _report(mission: Mission, parts: list[TransferPart], peer: Peer, output: Path, as_json: bool) -> None:
    counts = {part.mission_type: len(part.items) for part in parts}
    counts["mission"] = len(mission.items)
    if as_json:
        vehicle = linking.described_peer(peer)
        document = {"verb": "pull", "vehicle": vehicle, "outcome": "accepted", "exit_code": 0, "file": str(output)}
        typer.echo(json.dumps({**document, "items": counts}, indent=2))
        return
    held = ", ".join(f"{kind} {counts[kind]}" for kind in _ALL if kind in counts)
    typer.echo(f"read from {peer}: items of {held}")
    typer.echo(f"wrote {output}")
