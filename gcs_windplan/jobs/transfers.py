"""Missions to and from a vehicle: pushed, pulled or cleared, and believed only when they were read back."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Final, TypeAlias

from gcs_windplan.errors import FormatError, InputError, LinkError, Problem, RefusedError
from gcs_windplan.formats import ReadMission, check_writable, write_plan, write_waypoints
from gcs_windplan.geo.frame import GeoPoint
from gcs_windplan.jobs.items import ItemsWords, file_of, items_of
from gcs_windplan.jobs.words import Kinds, Naming
from gcs_windplan.link.firmware import incoming_mission, outgoing_items, with_fence, with_rally
from gcs_windplan.link.home import Homes, counts_from_home
from gcs_windplan.link.outcome import UNSUPPORTED, Verdict
from gcs_windplan.link.peer import Peer
from gcs_windplan.link.session import Session, TransferCallback, open_session
from gcs_windplan.link.verified import TransferPart, clear_items, pull_items, push_items
from gcs_windplan.mission import Home, MissionItems, fence_items, rally_items
from gcs_windplan.mission.firmware import MissionType
from gcs_windplan.progress import CancelToken, Progress, ProgressCallback

Note: TypeAlias = Callable[[str], None]

_ALL: Final[tuple[MissionType, ...]] = ("mission", "fence", "rally")
_NAMES: Final = {"mission": "mission items", "fence": "fence", "rally": "rally points"}


@dataclass(frozen=True, slots=True)
class VehicleLink:
    """Where a vehicle is, and how it is spoken to.

    `address` is udpin:HOST:PORT, udpout:HOST:PORT, tcp:HOST:PORT, tcpin:HOST:PORT or a serial DEVICE[:BAUD]. `system`
    and `component` name the vehicle where several share the link. With a `key_file` it is signed. All ends after
    `timeout` [s]; without one a vehicle has 10 s to be heard.
    """

    address: str
    system: int | None = None
    component: int | None = None
    key_file: Path | None = None
    timeout: float | None = None

    @contextmanager
    def meet(self, cancel: CancelToken | None = None) -> Iterator[tuple[Session, Peer]]:
        """A session with the vehicle that it met. Raises `InputError`, `LinkError`, and `CancelledError` till then."""
        with open_session(self.address, key_file=self.key_file, timeout=self.timeout, cancel=cancel) as session:
            try:
                peer = session.meet(self.system, self.component)
            except LinkError:
                if cancel is not None:
                    cancel.raise_if_cancelled()
                raise
            yield session, peer


@dataclass(frozen=True, slots=True)
class Transfer:
    """How a transfer ended: a part each for mission, fence and rally points, until one was not accepted.

    `skipped` are those that came after it. `homes` are the mission's home and the vehicle's, where altitudes count from
    it and both are known. `mission` is what was read, of a pull. `notes` are what was said on the way.

    >>> import gcs_windplan as gw
    >>> gw.Transfer(peer=None, parts=()).verdict  # nothing travelled, and nothing was refused
    'accepted'
    """

    peer: Peer
    parts: tuple[TransferPart, ...]
    skipped: tuple[MissionType, ...] = ()
    homes: Homes | None = None
    mission: MissionItems | None = None
    notes: tuple[str, ...] = ()

    @property
    def verdict(self) -> Verdict:
        """`unknown` if one part is, else `rejected` if one is, else `accepted`."""
        verdicts = {part.outcome.verdict for part in self.parts}
        known: tuple[Verdict, ...] = ("unknown", "rejected")
        return next((verdict for verdict in known if verdict in verdicts), "accepted")


def push(
    mission: ItemsWords,
    to: str,
    *,
    kinds: Kinds | None = None,
    system: int | None = None,
    component: int | None = None,
    key_file: Path | None = None,
    timeout: float | None = None,
    verify: bool = True,
    progress: ProgressCallback | None = None,
    cancel: CancelToken | None = None,
    on_note: Note | None = None,
    named: Naming = str,
) -> Transfer:
    """Push a mission to a vehicle, read it back and compare.

    `mission` is a ground station's file, `MissionItems`, or what `plan` takes, which is planned first. `to` is
    udpin:HOST:PORT, udpout:HOST:PORT, tcp:HOST:PORT, tcpin:HOST:PORT or a serial DEVICE[:BAUD]; `system` and
    `component` name the vehicle where several share the link; with a `key_file` it is signed; all ends after `timeout`
    [s]. Without `kinds` everything goes that the mission holds; with `all` the vehicle shall hold exactly that, so that
    a fence that it lacks is deleted. `on_note` is called with each remark as it comes; `named` is how the face that
    asks calls its options.

    Raises `InputError` for what cannot be used, `LinkError` where nobody is there, and as `plan` does. A cancelled
    transfer tells the vehicle and ends as `unknown`.

    >>> import gcs_windplan as gw
    >>> gw.push(gw.MissionItems(()), "udpout:127.0.0.1:14550")
    Traceback (most recent call last):
    gcs_windplan.errors.InputError: holds no items: to empty a vehicle there is the verb clear
    """
    notes = _Notes(on_note)
    file = file_of(mission)
    read = items_of(mission, progress=progress, cancel=cancel)
    for repair in read.repairs:
        notes.add(f"{file}: {repair}")
    if kinds != "mission":
        _refuse_parts_left_out(read, file, named)
    items = read.mission
    wanted = _to_send(items, kinds, file, notes, named)
    parts: list[TransferPart] = []
    with VehicleLink(to, system, component, key_file, timeout).meet(cancel) as (session, peer):
        if None not in (items.autopilot, peer.autopilot) and items.autopilot != peer.autopilot:
            notes.add(f"{file or 'the mission'} is for {items.autopilot}, and the vehicle is {peer}")
        for kind in wanted:
            outgoing = outgoing_items(items, kind, peer.firmware)
            watch = _watch(f"{kind} to {peer.ident}", progress)
            parts.append(push_items(session, peer, kind, outgoing, verify=verify, watch=watch))
            if parts[-1].outcome.verdict != "accepted":
                break
        homes = _homes(session, peer, items, parts)
    return Transfer(peer, tuple(parts), wanted[len(parts) :], homes, notes=notes.all)


def pull(
    source: str,
    output: str | os.PathLike[str] | None = None,
    *,
    kinds: Kinds | None = None,
    system: int | None = None,
    component: int | None = None,
    key_file: Path | None = None,
    timeout: float | None = None,
    progress: ProgressCallback | None = None,
    cancel: CancelToken | None = None,
    on_note: Note | None = None,
) -> Transfer:
    """Pull what a vehicle holds; the `mission` of the result is None where a part was not accepted.

    `source` and what follows it are as in `push`. With an `output`, a .plan or .waypoints, the mission is written when
    everything was read, or not at all; a .waypoints gets the mission items alone.

    Raises `InputError` for what cannot be used, `LinkError` where nobody is there or what is held makes no sense, and
    `RefusedError` where the vehicle holds nothing.

    >>> import gcs_windplan as gw
    >>> gw.pull("udpin:127.0.0.1:14550", "mission.txt")
    Traceback (most recent call last):
    gcs_windplan.errors.FormatError: mission.txt: ends neither in .plan nor in .waypoints: name it so
    """
    notes, file = _Notes(on_note), None if output is None else Path(output)
    wanted = _to_read(file, kinds)
    parts: list[TransferPart] = []
    with VehicleLink(source, system, component, key_file, timeout).meet(cancel) as (session, peer):
        for kind in wanted:
            part = pull_items(session, peer, kind, watch=_watch(f"{kind} of {peer.ident}", progress))
            outcome = part.outcome
            lacking = outcome.reason == "mavlink1" or outcome.code == UNSUPPORTED
            if kinds is None and kind != "mission" and lacking:
                notes.add(f"{kind} left out: {outcome.message}")
                continue
            parts.append(part)
            if outcome.verdict != "accepted":
                return Transfer(peer, tuple(parts), notes=notes.all)
        mission = _assembled(session, peer, parts, notes)
        if file is not None:
            (write_plan if file.suffix.lower() == ".plan" else write_waypoints)(mission, file)
    return Transfer(peer, tuple(parts), mission=mission, notes=notes.all)


def clear(
    on: str,
    *,
    kinds: Kinds = "mission",
    system: int | None = None,
    component: int | None = None,
    key_file: Path | None = None,
    timeout: float | None = None,
    verify: bool = True,
    cancel: CancelToken | None = None,
) -> Transfer:
    """Delete what a vehicle holds, type after type until one is not accepted, and look whether it is gone.

    `on` and what follows it are as in `push`. ArduPilot keeps its home.

    Raises `InputError` for what cannot be used, and `LinkError` where nobody is there.

    >>> import gcs_windplan as gw
    >>> gw.clear("udpin:14550", kinds="all")
    Traceback (most recent call last):
    gcs_windplan.errors.AddressError: the address 'udpin:14550' lacks host or port: ...
    """
    wanted = tuple(kind for kind in _ALL if kinds in (kind, "all"))
    parts: list[TransferPart] = []
    with VehicleLink(on, system, component, key_file, timeout).meet(cancel) as (session, peer):
        for kind in wanted:
            parts.append(clear_items(session, peer, kind, verify=verify))
            if parts[-1].outcome.verdict != "accepted":
                break
    return Transfer(peer, tuple(parts), wanted[len(parts) :])


class _Notes:
    """Remarks, told as they come and kept."""

    def __init__(self, tell: Note | None) -> None:
        self._tell = tell
        self._kept: list[str] = []

    def add(self, text: str) -> None:
        self._kept.append(text)
        if self._tell is not None:
            self._tell(text)

    @property
    def all(self) -> tuple[str, ...]:
        return tuple(self._kept)


def _watch(stage: str, progress: ProgressCallback | None) -> TransferCallback | None:
    """What tells a transfer's items to a callback."""
    return None if progress is None else lambda done, total: progress(Progress(stage, done, total or None))


def _refuse_parts_left_out(read: ReadMission, file: Path | None, named: Naming) -> None:
    """A vehicle must not fly with half of a fence that its pilot believes whole."""
    if read.left_out:
        option = f"{named('kinds')} mission"
        text = f"{read.left_out[0]}: mend it, or leave fence and rally points out with {option}"
        raise FormatError(Problem(text, file=file))


def _to_send(
    mission: MissionItems, kinds: Kinds | None, file: Path | None, notes: _Notes, named: Naming
) -> tuple[MissionType, ...]:
    """The types to send."""
    held = {"mission": bool(mission.items), "fence": mission.fence is not None, "rally": bool(mission.rally)}
    if not any(held.values()):
        raise InputError(Problem("holds no items: to empty a vehicle there is the verb clear", file=file))
    if kinds == "all":
        return _ALL
    if kinds is None:
        return tuple(kind for kind in _ALL if held[kind])
    if not held[kinds]:
        raise InputError(Problem(f"holds no {_NAMES[kinds]}, and {named('kinds')} {kinds} asks for them", file=file))
    for kind in _ALL:
        if held[kind] and kind != kinds:
            notes.add(f"the file's {_NAMES[kind]} will not be sent, as {named('kinds')} {kinds} asks")
    return (kinds,)


def _to_read(output: Path | None, kinds: Kinds | None) -> tuple[MissionType, ...]:
    """The types to read; raises `FormatError` for a file that cannot be written, or cannot hold them."""
    suffix = ".plan" if output is None else output.suffix.lower()
    if suffix not in (".plan", ".waypoints"):
        raise FormatError(Problem("ends neither in .plan nor in .waypoints: name it so", file=output))
    if output is not None:
        check_writable(output)
    if suffix == ".waypoints" and kinds not in (None, "mission"):
        text = "is a .waypoints, which holds no fence and no rally points: write a .plan"
        raise FormatError(Problem(text, file=output))
    if kinds == "all" or (kinds is None and suffix == ".plan"):
        return _ALL
    return tuple(kind for kind in _ALL if kind == (kinds or "mission"))


def _homes(session: Session, peer: Peer, mission: MissionItems, parts: Sequence[TransferPart]) -> Homes | None:
    """The mission's home and the vehicle's, None where one is not known or no altitude counts from it."""
    part = next((part for part in parts if part.mission_type == "mission"), None)
    if part is None or part.outcome.verdict != "accepted" or mission.home is None:
        return None
    if not any(map(counts_from_home, mission.items)):
        return None
    held = part.home or session.ask_home(peer)
    return None if held is None else Homes(mission.home, held)


def _assembled(session: Session, peer: Peer, parts: Sequence[TransferPart], notes: _Notes) -> MissionItems:
    """One mission of all parts, with a home, as both formats need one."""
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
    return _with_home(mission, home, notes)


def _with_home(mission: MissionItems, home: Home | None, notes: _Notes) -> MissionItems:
    """The mission with the vehicle's home; else with a made-up one, which is said."""
    if home is None:
        items = (*mission.items, *rally_items(mission.rally), *fence_items(mission.fence))
        place = next((GeoPoint(item.latitude_deg, item.longitude_deg) for item in items if item.has_place), None)
        if place is None:
            raise RefusedError("the vehicle told no home, and nothing that it holds has a place: nothing was written")
        notes.add("the vehicle told no home: the file's is at its first item's place, at 0 m above sea level")
        home = Home(place, 0.0)
    return replace(mission, home=home)
