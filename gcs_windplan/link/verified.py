"""Upload and deletion that are believed only when what was read back proves them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

from gcs_windplan.link.clear import Clear
from gcs_windplan.link.comparison import Comparison, compare_items
from gcs_windplan.link.download import Download
from gcs_windplan.link.exchange import Ends
from gcs_windplan.link.outcome import CANCELLED, Outcome
from gcs_windplan.link.peer import Peer
from gcs_windplan.link.session import Session, Watch
from gcs_windplan.link.upload import Upload
from gcs_windplan.link.wire import MissionType
from gcs_windplan.mission import MissionItem

_SHOWN = 3  # differences in a message
_READINGS = 2  # while another ground station writes


@dataclass(frozen=True, slots=True)
class Part:
    """What became of the mission, the fence or the rally points.

    `items` are those that travelled, home among them on ArduPilot: sent, or read. `seconds` is how long it took
    in all, `sending` until the vehicle's acknowledgement. `comparison` is None where nothing was compared.
    """

    mission_type: MissionType
    outcome: Outcome
    items: tuple[MissionItem, ...] = ()
    seconds: float = 0.0
    sending: float = 0.0
    comparison: Comparison | None = None


def push_items(
    session: Session,
    peer: Peer,
    mission_type: MissionType,
    items: Sequence[MissionItem],
    *,
    verify: bool = True,
    watch: Watch | None = None,
) -> Part:
    """Upload items as they are to travel, read them back and compare; none at all deletes what is there.

    Raises InputError for items that MAVLink cannot carry.
    """
    if not items:
        return clear_items(session, peer, mission_type, verify=verify)
    if (refused := _unable(peer, mission_type)) is not None:
        return Part(mission_type, refused, tuple(items))
    start = session.clock()
    upload = Upload(Ends(session.own, peer, mission_type), items, session.contact(peer))
    session.run(upload, watch)
    sending = session.clock() - start
    outcome, comparison = _with_aftermath(upload, session), None
    if verify and (outcome.verdict == "accepted" or outcome.reason == "unconfirmed"):
        outcome, comparison = _proved(session, upload.ends, tuple(items), outcome, watch)
    return Part(mission_type, outcome, tuple(items), session.clock() - start, sending, comparison)


def clear_items(session: Session, peer: Peer, mission_type: MissionType, *, verify: bool = True) -> Part:
    """Delete what the vehicle holds of one type, and look whether it is gone; ArduPilot keeps home."""
    if (refused := _unable(peer, mission_type)) is not None:
        return Part(mission_type, refused)
    start = session.clock()
    clear = Clear(Ends(session.own, peer, mission_type), session.contact(peer))
    session.run(clear)
    sending = session.clock() - start
    outcome, comparison = _hinted(clear.outcome, session), None
    if verify and outcome.verdict == "accepted":
        outcome, comparison = _proved(session, clear.ends, (), outcome, None)
    return Part(mission_type, outcome, (), session.clock() - start, sending, comparison)


def pull_items(session: Session, peer: Peer, mission_type: MissionType, *, watch: Watch | None = None) -> Part:
    """Read what the vehicle holds of one type, in its own form."""
    if (refused := _unable(peer, mission_type)) is not None:
        return Part(mission_type, refused)
    start = session.clock()
    download = _read(session, Ends(session.own, peer, mission_type), watch)
    seconds = session.clock() - start
    return Part(mission_type, _hinted(download.outcome, session), download.items, seconds, seconds)


def _unable(peer: Peer, mission_type: MissionType) -> Outcome | None:
    """The refusal to speak of fence and rally points in MAVLink 1, which would take them for the mission."""
    if peer.version == 2 or mission_type == "mission":
        return None
    message = f"the vehicle speaks MAVLink 1 only, which has no {mission_type}: nothing was sent"
    return Outcome("rejected", "mavlink1", message)


def _read(session: Session, ends: Ends, watch: Watch | None) -> Download:
    download = Download(ends, session.contact(ends.peer))
    session.run(download, watch)
    return download


def _proved(
    session: Session, ends: Ends, items: tuple[MissionItem, ...], sent: Outcome, watch: Watch | None
) -> tuple[Outcome, Comparison | None]:
    """The outcome after reading back; a reading during which somebody else wrote proves nothing."""
    for _ in range(_READINGS):
        download = _read(session, ends, watch)
        read = download.outcome
        if read.verdict != "accepted":
            message = f"{sent.message}, but it could not be read back: {read.message}"
            return Outcome("unknown", read.reason, message, read.code, notes=(*sent.notes, *read.notes)), None
        comparison = _compared(ends, items, download.items)
        sent = sent.noted(*read.notes)
        if not comparison.same:
            return _differing(sent, comparison), comparison
        if not download.overheard:
            held = f"{len(items)} items sent and read back" if items else "nothing is left"
            return Outcome("accepted", "done", held, notes=sent.notes), comparison
    message = f"{sent.message}, but another ground station was sending while it was read back"
    return Outcome("unknown", "changed", message, notes=sent.notes), comparison


def _compared(ends: Ends, sent: tuple[MissionItem, ...], held: tuple[MissionItem, ...]) -> Comparison:
    peer = ends.peer
    home = 1 if peer.autopilot == "ardupilot" and ends.mission_type == "mission" else 0
    return compare_items(
        sent[home:],
        held[home:],
        mission_type=ends.mission_type,
        autopilot=peer.autopilot,
        vehicle_type=peer.vehicle_type,
        first=home,
    )


def _differing(sent: Outcome, comparison: Comparison) -> Outcome:
    shown = "; ".join(map(str, comparison.differences[:_SHOWN]))
    more = len(comparison.differences) - _SHOWN
    rest = f"; and {more} more" if more > 0 else ""
    message = f"{sent.message}, but the vehicle holds something else: {shown}{rest}"
    seq = comparison.differences[0].seq
    return Outcome("rejected", "differs", message, seq=seq, notes=sent.notes)


def _with_aftermath(upload: Upload, session: Session) -> Outcome:
    """The outcome of an upload, and what a broken one leaves behind."""
    outcome = _hinted(upload.outcome, session)
    if outcome.verdict == "accepted" or outcome.reason == "unconfirmed":
        return outcome
    kind, (asked, count) = upload.ends.mission_type, upload.progress
    if outcome.verdict == "rejected" and outcome.code != CANCELLED and asked == 0:
        return outcome
    put_together_first = upload.ends.peer.autopilot == "px4" or kind == "fence"
    if put_together_first and (asked < count or outcome.verdict == "rejected"):
        return outcome.noted(f"the vehicle keeps its former {kind}")
    if put_together_first:
        return outcome
    return outcome.noted(f"the vehicle's {kind} may now be a mixture of old and new: push again, or clear it")


def _hinted(outcome: Outcome, session: Session) -> Outcome:
    hint = session.hint() if outcome.reason == "no-answer" else ""
    return replace(outcome, message=f"{outcome.message}; {hint}") if hint else outcome
