"""What the verbs that talk to a vehicle share: their options, the progress bar, and how they report."""

from __future__ import annotations

import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, TypeAlias

import typer

from gcs_windplan.cli.choices import print_json
from gcs_windplan.errors import InputError, LinkError, NoRouteError, RefusedError, WindplanError

if TYPE_CHECKING:
    from gcs_windplan.jobs.transfers import Transfer
    from gcs_windplan.link.peer import Peer
    from gcs_windplan.link.verified import TransferPart
    from gcs_windplan.progress import Progress, ProgressCallback

EPILOG = (
    "ADDRESS is udpin:HOST:PORT (listen; the way simulators and most autopilots call in), udpout:HOST:PORT, "
    "tcp:HOST:PORT, tcpin:HOST:PORT or a serial DEVICE[:BAUD]. "
    "Exit codes: 0 accepted; 1 no route exists (a mission file to be planned); 2 something handed in cannot be used "
    "(address, port in use, key, file); 3 rejected: the vehicle said no, or holds something else; 4 unknown: nobody "
    "there, no answer, interrupted."
)

System: TypeAlias = Annotated[
    int | None,
    typer.Option("--sysid", min=1, max=255, metavar="N", help="The vehicle's system id, if several share the link."),
]
Component: TypeAlias = Annotated[
    int | None,
    typer.Option("--compid", min=1, max=255, metavar="N", help="Its autopilot's component id; 1 on most."),
]
KeyFile: TypeAlias = Annotated[
    Path | None,
    typer.Option("--sign", metavar="KEYFILE", help="Sign (MAVLink 2): 64 hex digits, a passphrase, or 32 bytes."),
]
Timeout: TypeAlias = Annotated[
    float | None,
    typer.Option(min=0.1, metavar="SECONDS", help="End after so long in all; else 10 s for a vehicle to be heard."),
]
Json: TypeAlias = Annotated[bool, typer.Option("--json", help="Print one JSON object.")]

EXIT_CODES = {"accepted": 0, "rejected": 3, "unknown": 4}
_DEEDS = {"push": "sent", "pull": "read", "clear": "deleted"}


def told(error: WindplanError) -> tuple[str, ...]:
    """The lines that tell an error."""
    return tuple(map(str, error.problems)) if isinstance(error, InputError) else (str(error),)


def code_of(error: WindplanError) -> int:
    """The exit code of an error."""
    if isinstance(error, LinkError):
        return EXIT_CODES["rejected" if isinstance(error, RefusedError) else "unknown"]
    return 1 if isinstance(error, NoRouteError) else 2


@contextmanager
def answering(verb: str, as_json: bool) -> Iterator[None]:
    """Where JSON is wanted, errors print an object as well; they go on to where they are told and end the verb."""
    try:
        yield
    except WindplanError as error:
        if as_json:
            code = code_of(error)
            verdict = next((verdict for verdict, number in EXIT_CODES.items() if number == code), "error")
            document = {"verb": verb, "outcome": verdict, "exit_code": code, "error": "; ".join(told(error))}
            print_json(document)
        raise


@contextmanager
def progress(quiet: bool) -> Iterator[ProgressCallback | None]:
    """A bar on the terminal, None where standard error is none."""
    if quiet or not sys.stderr.isatty():
        yield None
        return
    from rich.console import Console
    from rich.progress import Progress as Bar

    with Bar(console=Console(stderr=True), transient=True) as bar:
        task = bar.add_task("", total=None)

        def show(step: Progress) -> None:
            bar.update(task, description=step.stage, completed=step.done, total=step.total)

        yield show


def note(text: str) -> None:
    """Say something beside the result."""
    typer.echo(f"note: {text}", err=True)


def report(transfer: Transfer, verb: str, as_json: bool, more: dict[str, Any] | None = None) -> None:
    """Print how each part ended, and leave with the exit code; `more` is for the JSON object."""
    parts, skipped, peer, verdict = transfer.parts, transfer.skipped, transfer.peer, transfer.verdict
    code = EXIT_CODES[verdict]
    if as_json:
        described = [_described(part) for part in parts]
        described += [{"type": kind, "outcome": f"not {_DEEDS[verb]}"} for kind in skipped]
        document = {"verb": verb, "vehicle": described_peer(peer), "outcome": verdict, "exit_code": code}
        errors = [
            f"{part.mission_type}: {part.outcome.message}" for part in parts if part.outcome.verdict != "accepted"
        ]
        failed = {"error": "; ".join(errors)} if errors else {}
        print_json({**document, **failed, "parts": described, **(more or {})})
    for part in parts:
        if verb == "pull" and part.outcome.verdict == "accepted":
            note(f"{part.mission_type} was read: {part.outcome.message}")
        else:
            _print(part, peer, as_json)
    for kind in skipped:
        typer.echo(f"error: {kind} not {_DEEDS[verb]}, because of that", err=True)
    if code:
        raise typer.Exit(code)


def described_peer(peer: Peer) -> dict[str, Any]:
    """The vehicle, for JSON."""
    return {
        "system": peer.ident.system,
        "component": peer.ident.component,
        "autopilot": peer.autopilot,
        "type": peer.vehicle_type,
        "mavlink": peer.version,
    }


def _described(part: TransferPart) -> dict[str, Any]:
    outcome, comparison = part.outcome, part.comparison
    described: dict[str, Any] = {
        "type": part.mission_type,
        "outcome": outcome.verdict,
        "reason": outcome.reason,
        "message": outcome.message,
        "code": outcome.code,
        "seq": outcome.seq,
        "parameter": outcome.parameter,
        "items": len(part.items),
        "seconds": round(part.seconds, 3),
        "seconds_sending": round(part.sending, 3),
        "notes": list(outcome.notes),
    }
    if comparison is not None:
        described["differences"] = [str(difference) for difference in comparison.differences]
        described["losses"] = [str(loss) for loss in comparison.losses]
    return described


def _print(part: TransferPart, peer: Peer, as_json: bool) -> None:
    outcome = part.outcome
    if outcome.verdict != "accepted":
        typer.echo(f"error: {part.mission_type} {outcome.verdict}: {outcome.message}", err=True)
    elif not as_json:
        took = f"{part.seconds:.2f} s" if part.seconds == part.sending else _times(part)
        typer.echo(f"{part.mission_type} accepted by {peer}: {outcome.message} ({took})")
        if part.comparison is not None:
            from gcs_windplan.link.comparison import loss_lines

            for line in loss_lines(part.comparison.losses, peer.firmware):
                typer.echo(f"  {line}")
    for line in outcome.notes:
        note(line)


def _times(part: TransferPart) -> str:
    return f"sent in {part.sending:.2f} s, {part.seconds:.2f} s with reading back"
