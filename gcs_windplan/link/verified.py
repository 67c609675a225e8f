"""Upload and deletion that are believed only when what was read back proves them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

from gcs_windplan.link.clear import Clear
from gcs_windplan.link.comparison import Comparison, compare_items
from gcs_windplan.link.download import Download
from gcs_windplan.link.exchange import Ends
from gcs_windplan.link.firmware import has_home_item, incoming_mission
from gcs_windplan.link.outcome import CANCELLED, Outcome
from gcs_windplan.link.peer import Peer
from gcs_windplan.link.session import ProgressCallback, Session
from gcs_windplan.link.upload import Upload
from gcs_windplan.mission import Home, MissionItem
from gcs_windplan.mission.firmware import MissionType

_SHOWN = 3  # differences in a message
_READINGS = 2  # while another ground station writes
_NAMES: dict[MissionType, str] = {"mission": "mission", "fence": "fence", "rally": "rally points"}
_NOT_KNOWN: dict[MissionType, str] = {
    "mission": "it is not known which mission the vehicle holds: pull it",
    "fence": "it is not known which fence the vehicle holds: pull it",
    "rally": "it is not known which rally points the vehicle holds: pull them",
}


@dataclass(frozen=True, slots=True)
class TransferPart:
    """What became of the mission, the fence or the rally points.

    `items` are those that travelled, home among them on ArduPilot: sent, or read. `seconds` is how long it took
    in all, `sending` until the vehicle's acknowledgement. `comparison` is None where nothing was compared. `home` is
    the vehicle's, where reading back showed it.
    """

    mission_type: MissionType
    outcome: Outcome
    items: tuple[MissionItem, ...] = ()
    seconds: float = 0.0
    sending: float = 0.0
    comparison: Comparison | None = None
    home: Home | None = None


@dataclass(frozen=True, slots=True)
class _Proof:
    """What reading back showed; `comparison` and `home` are None where there was none."""

    outcome: Outcome
    comparison: Comparison | None = None
    home: Home | None = None


def push_items(
    session: Session,
    peer: Peer,
    mission_type: MissionType,
    items: Sequence[MissionItem],
    *,
    verify: bool = True,
    watch: ProgressCallback | None = None,
) -> TransferPart:
    """Upload items as they are to travel, read them back and compare; none at all deletes what is there.

    Raises InputError for items that MAVLink cannot carry.
    """
    if not items:
        return clear_items(session, peer, mission_type, verify=verify)
    if (refused := _unable(peer, mission_type, "sent")) is not None:
        return TransferPart(mission_type, refused, tuple(items))
    start = session.clock()
    upload = Upload(Ends(session.own, peer, mission_type), items, session.contact(peer))
    most = _run(session, upload, watch)
    sending = session.clock() - start
    proof = _Proof(_hinted(upload.outcome, session))
    if verify and (proof.outcome.verdict == "accepted" or proof.outcome.reason == "unconfirmed"):
        proof = _proved(session, upload.ends, tuple(items), proof.outcome, watch)
    outcome = _with_aftermath(proof.outcome, upload, most)
    seconds = session.clock() - start
    return TransferPart(mission_type, outcome, tuple(items), seconds, sending, proof.comparison, proof.home)


def clear_items(session: Session, peer: Peer, mission_type: MissionType, *, verify: bool = True) -> TransferPart:
    """Delete what the vehicle holds of one type, and look whether it is gone; ArduPilot keeps home."""
    if (refused := _unable(peer, mission_type, "deleted")) is not None:
        return TransferPart(mission_type, refused)
    start = session.clock()
    clear = Clear(Ends(session.own, peer, mission_type), session.contact(peer))
    session.run(clear)
    sending = session.clock() - start
    proof = _Proof(_hinted(clear.outcome, session))
    if verify and proof.outcome.verdict == "accepted":
        proof = _proved(session, clear.ends, (), proof.outcome, None)
    outcome = proof.outcome
    if outcome.verdict == "unknown":
        outcome = outcome.noted(_NOT_KNOWN[mission_type])
    return TransferPart(mission_type, outcome, (), session.clock() - start, sending, proof.comparison, proof.home)


def pull_items(
    session: Session, peer: Peer, mission_type: MissionType, *, watch: ProgressCallback | None = None
) -> TransferPart:
    """Read what the vehicle holds of one type, in its own form."""
    if (refused := _unable(peer, mission_type, "read")) is not None:
        return TransferPart(mission_type, refused)
    start = session.clock()
    download = _read(session, Ends(session.own, peer, mission_type), watch)
    seconds = session.clock() - start
    return TransferPart(mission_type, _hinted(download.outcome, session), download.items, seconds, seconds)


def _unable(peer: Peer, mission_type: MissionType, deed: str) -> Outcome | None:
    """The refusal to speak of fence and rally points in MAVLink 1, which would take them for the mission."""
    if peer.version == 2 or mission_type == "mission":
        return None
    message = f"the vehicle speaks MAVLink 1 only, which has no {mission_type}: nothing was {deed}"
    return Outcome("rejected", "mavlink1", message)


def _run(session: Session, upload: Upload, watch: ProgressCallback | None) -> int:
    """Run an upload; gives how many items the vehicle asked for at most, as an upload may begin again."""
    most = 0

    def see(done: int, total: int) -> None:
        nonlocal most
        most = max(most, done)
        if watch is not None:
            watch(done, total)

    session.run(upload, see)
    return max(most, upload.progress[0])


def _read(session: Session, ends: Ends, watch: ProgressCallback | None) -> Download:
    download = Download(ends, session.contact(ends.peer))
    session.run(download, watch)
    return download


def _proved(
    session: Session, ends: Ends, items: tuple[MissionItem, ...], sent: Outcome, watch: ProgressCallback | None
) -> _Proof:
    """The outcome after reading back; a reading during which somebody else wrote proves nothing."""
    for _ in range(_READINGS):
        download = _read(session, ends, watch)
        read = download.outcome
        if read.verdict != "accepted":
            message = f"{sent.message}, but it could not be read back: {read.message}"
            return _Proof(Outcome("unknown", read.reason, message, read.code, notes=(*sent.notes, *read.notes)))
        comparison, home = _compared(ends, items, download.items), _home(ends, download.items)
        sent = sent.noted(*read.notes)
        if not comparison.same:
            return _Proof(_differing(sent, comparison), comparison, home)
        if not download.overheard:
            held = f"{len(items)} items sent and read back" if items else "nothing is left"
            return _Proof(Outcome("accepted", "done", held, notes=sent.notes), comparison, home)
    message = f"{sent.message}, but another ground station was sending while it was read back"
    return _Proof(Outcome("unknown", "changed", message, notes=sent.notes), comparison, home)


def _home(ends: Ends, held: tuple[MissionItem, ...]) -> Home | None:
    """Home as ArduPilot gives it in item 0."""
    if not has_home_item(ends.peer.firmware) or ends.mission_type != "mission":
        return None
    return incoming_mission(held[:1], ends.peer.firmware).home


def _compared(ends: Ends, sent: tuple[MissionItem, ...], held: tuple[MissionItem, ...]) -> Comparison:
    firmware = ends.peer.firmware
    home = 1 if has_home_item(firmware) and ends.mission_type == "mission" else 0
    return compare_items(sent[home:], held[home:], mission_type=ends.mission_type, firmware=firmware, first=home)


def _differing(sent: Outcome, comparison: Comparison) -> Outcome:
    shown = "; ".join(map(str, comparison.differences[:_SHOWN]))
    more = len(comparison.differences) - _SHOWN
    rest = f"; and {more} more" if more > 0 else ""
    message = f"{sent.message}, but the vehicle holds something else: {shown}{rest}"
    seq = comparison.differences[0].seq
    return Outcome("rejected", "differs", message, seq=seq, notes=sent.notes)


def _with_aftermath(outcome: Outcome, upload: Upload, most: int) -> Outcome:
    """The outcome of an upload, and what a broken one leaves behind.

    `most` is how many items the vehicle asked for. That its former ones are still there is certain only where it
    refused before it took the new ones over.
    """
    if outcome.verdict == "accepted" or outcome.reason == "differs":
        return outcome
    ends = upload.ends
    kind, firmware = ends.mission_type, ends.peer.firmware
    refused = outcome.verdict == "rejected" and not upload.overheard
    if refused and outcome.code != CANCELLED and most == 0:
        return outcome
    put_together_first = firmware is not None and kind in firmware.transfers.whole
    if refused and put_together_first:
        return outcome.noted(f"the vehicle keeps its former {_NAMES[kind]}")
    notes = () if outcome.verdict == "rejected" and most else (_NOT_KNOWN[kind],)
    if not put_together_first and most > 0 and outcome.reason != "unconfirmed":
        mixture = f"the vehicle's {_NAMES[kind]} may now be a mixture of old and new: push again, or clear it"
        return outcome.noted(mixture, *notes)
    return outcome.noted(*notes)


def _hinted(outcome: Outcome, session: Session) -> Outcome:
    hint = session.hint() if outcome.reason == "no-answer" else ""
    return replace(outcome, message=f"{outcome.message}; {hint}") if hint else outcome
