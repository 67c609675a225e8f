"""`gcs-windplan push`: a mission goes to a vehicle, and is read back before anybody believes it."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Literal, TypeAlias

import typer

from gcs_windplan.cli import linking

if TYPE_CHECKING:
    from gcs_windplan.link.home import Homes
    from gcs_windplan.link.peer import Peer
    from gcs_windplan.link.session import Session
    from gcs_windplan.link.verified import TransferPart
    from gcs_windplan.mission import Mission
    from gcs_windplan.mission.firmware import MissionType

HELP = """Push a mission to a vehicle, read it back and compare.

FILE is a .plan or .waypoints, or a mission file (.yaml), which is planned first. It ends in one of three words:
accepted (the vehicle said so, and what was read back is what was sent, as far as its firmware keeps it), rejected,
or unknown. Without --type everything goes that the file holds: its mission, and its fence and rally points if it has
any; what the vehicle has of kinds that the file lacks stays. Ctrl-C cancels the transfer and tells the vehicle.
"""

_ALL: tuple[MissionType, ...] = ("mission", "fence", "rally")
_NAMES = {"mission": "mission items", "fence": "fence", "rally": "rally points"}
_PLANNED = (".yaml", ".yml")

Kinds: TypeAlias = Annotated[
    Literal["mission", "fence", "rally", "all"] | None,
    typer.Option(
        "--type",
        help="Send this alone; with all, the vehicle shall hold exactly what the file holds, so that a fence and "
        "rally points that the file lacks are deleted.",
    ),
]


def push(
    file: Annotated[Path, typer.Argument(metavar="FILE", help="A .plan, a .waypoints, or a mission file.")],
    to: Annotated[str, typer.Option("--to", metavar="ADDRESS", help="Where the vehicle is.")],
    kinds: Kinds = None,
    sysid: linking.System = None,
    compid: linking.Component = None,
    sign: linking.KeyFile = None,
    timeout: linking.Timeout = None,
    verify: Annotated[bool, typer.Option("--verify/--no-verify", help="Read back and compare, or believe.")] = True,
    as_json: linking.Json = False,
) -> None:
    """Read or plan, push, report."""
    with linking.answering("push", as_json):
        mission = _mission(file, kinds)
        wanted = _wanted(mission, kinds, file)
        with linking.vehicle(to, sysid, compid, sign, timeout) as (session, peer):
            _note_kind(mission, peer, file)
            parts = _push(session, peer, mission, wanted, verify, as_json)
            homes = _homes(session, peer, mission, parts)
    if homes is not None and homes.apart:
        typer.echo(f"WARNING: {homes}", err=True)
    more = {} if homes is None else {"home": homes.described()}
    linking.report(parts, wanted[len(parts) :], peer, "push", as_json, more)


def _mission(file: Path, kinds: str | None) -> Mission:
    if file.suffix.lower() in _PLANNED:
        from gcs_windplan.cli.choices import read_request
        from gcs_windplan.planning.export import mission_of
        from gcs_windplan.planning.planner import plan_route

        return mission_of(plan_route(read_request(file, None)))
    from gcs_windplan.formats import read_mission

    read = read_mission(file)
    for repair in read.repairs:
        linking.note(f"{file}: {repair}")
    if kinds != "mission":
        _refuse_parts_left_out(read.repairs, file)
    return read.mission


def _refuse_parts_left_out(repairs: tuple[str, ...], file: Path) -> None:
    """A vehicle must not fly with half of a fence that its pilot believes whole."""
    from gcs_windplan.errors import FormatError, Problem

    broken = [line for line in repairs if line.startswith(("geoFence", "rallyPoints")) and "left out" in line]
    if broken:
        message = f"{broken[0]}: mend it, or leave fence and rally points out with --type mission"
        raise FormatError(Problem(message, file=file))


def _wanted(mission: Mission, kinds: str | None, file: Path) -> tuple[MissionType, ...]:
    """The types to send."""
    from gcs_windplan.errors import InputError, Problem

    held = {"mission": bool(mission.items), "fence": mission.fence is not None, "rally": bool(mission.rally)}
    if not any(held.values()):
        raise InputError(Problem("holds no items: to empty a vehicle there is the verb clear", file=file))
    if kinds == "all":
        return _ALL
    if kinds is None:
        return tuple(kind for kind in _ALL if held[kind])
    if not held[kinds]:
        raise InputError(Problem(f"holds no {_NAMES[kinds]}, and --type {kinds} asks for them", file=file))
    for kind in _ALL:
        if held[kind] and kind != kinds:
            linking.note(f"the file's {_NAMES[kind]} will not be sent, as --type {kinds} asks")
    return tuple(kind for kind in _ALL if kind == kinds)


def _note_kind(mission: Mission, peer: Peer, file: Path) -> None:
    if None not in (mission.autopilot, peer.autopilot) and mission.autopilot != peer.autopilot:
        linking.note(f"{file} is for {mission.autopilot}, and the vehicle is {peer}")


def _push(
    session: Session, peer: Peer, mission: Mission, wanted: tuple[MissionType, ...], verify: bool, as_json: bool
) -> list[TransferPart]:
    """Push type after type, until one is not accepted."""
    from gcs_windplan.link.firmware import outgoing_items
    from gcs_windplan.link.verified import push_items

    parts: list[TransferPart] = []
    for kind in wanted:
        items = outgoing_items(mission, kind, peer.firmware)
        with linking.progress(f"{kind} to {peer.ident}", as_json) as watch:
            parts.append(push_items(session, peer, kind, items, verify=verify, watch=watch))
        if parts[-1].outcome.verdict != "accepted":
            break
    return parts


def _homes(session: Session, peer: Peer, mission: Mission, parts: list[TransferPart]) -> Homes | None:
    """The file's home and the vehicle's, None where one is not known or no altitude counts from it."""
    from gcs_windplan.link.home import Homes, counts_from_home

    part = next((part for part in parts if part.mission_type == "mission"), None)
    if part is None or part.outcome.verdict != "accepted" or mission.home is None:
        return None
    if not any(map(counts_from_home, mission.items)):
        return None
    held = part.home or session.ask_home(peer)
    return None if held is None else Homes(mission.home, held)
