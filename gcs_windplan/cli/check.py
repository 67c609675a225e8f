"""`gcs-windplan check`: what a firmware will make of a mission, by its rules alone."""

from __future__ import annotations

import json
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Literal

import typer

from gcs_windplan.cli import linking

if TYPE_CHECKING:
    from gcs_windplan.formats import ReadMission
    from gcs_windplan.mission import Mission
    from gcs_windplan.mission.firmware import Firmware
    from gcs_windplan.mission.lint import FirmwareFinding

HELP = """Say what a firmware will reject, drop, round, change or ignore of a mission.

FILE is a .plan or .waypoints, or a mission file (.yaml), which is planned first. The rules are the firmware's own, with
its default parameters: terrain and wind do not come into it. The firmware is what the file says, unless --autopilot
and --vehicle-type do. Items count from 1; home is 0.
"""
EPILOG = (
    "Exit codes: 0 nothing found but roundings of places below a centimetre; 1 something found (or no route exists, of "
    "a mission file to be planned); "
    "2 something handed in cannot be used."
)
_PLANNED = (".yaml", ".yml")
_EFFECTS = "rejected, dropped, rounded, changed or ignored"


def check(
    file: Annotated[Path, typer.Argument(metavar="FILE", help="A .plan, a .waypoints, or a mission file.")],
    autopilot: Annotated[Literal["ardupilot", "px4"] | None, typer.Option(help="Whose rules count.")] = None,
    vehicle_type: Annotated[
        Literal["multicopter", "fixed-wing"] | None, typer.Option(help="The kind of vehicle whose rules count.")
    ] = None,
    as_json: linking.Json = False,
) -> None:
    """Read or plan, look, report."""
    with linking.answering("check", as_json):
        read = _read(file)
        notes = list(read.repairs)
        firmware = _firmware(read.mission, autopilot, vehicle_type, file, notes)
        from gcs_windplan.mission.lint import lint

        findings = lint(read.mission, firmware)
    for line in notes:
        linking.note(f"{file}: {line}")
    if as_json:
        _print_json(file, firmware, len(read.mission.items), findings, notes)
    else:
        _print(file, firmware, len(read.mission.items), findings)
    if _counts_as_found(findings):
        raise typer.Exit(1)


def _counts_as_found(findings: tuple[FirmwareFinding, ...]) -> bool:
    """Whether more was found than places that are kept to a centimetre, which no vehicle flies."""
    from gcs_windplan.mission.lint import FINER_THAN_FLOWN

    return any(finding.rule not in FINER_THAN_FLOWN for finding in findings)


def _read(file: Path) -> ReadMission:
    from gcs_windplan.formats import ReadMission, read_mission

    if file.suffix.lower() in _PLANNED:
        from gcs_windplan.cli.choices import read_request
        from gcs_windplan.planning.export import mission_of
        from gcs_windplan.planning.planner import plan_route

        return ReadMission(mission_of(plan_route(read_request(file, None))))
    return read_mission(file)


def _firmware(
    mission: Mission,
    autopilot: Literal["ardupilot", "px4"] | None,
    vehicle_type: Literal["multicopter", "fixed-wing"] | None,
    file: Path,
    notes: list[str],
) -> Firmware:
    """Whose rules count; what was decided on the way goes to the notes."""
    from gcs_windplan.errors import InputError, Problem
    from gcs_windplan.mission.firmware import firmware_of

    pilot = autopilot or mission.autopilot
    if pilot is None:
        message = "does not say for which autopilot it is: give --autopilot ardupilot or --autopilot px4"
        raise InputError(Problem(message, file=file))
    if mission.autopilot not in (None, pilot):
        notes.append(f"the file is for {mission.autopilot}, and --autopilot {pilot} asks for other rules")
    kind = vehicle_type or mission.vehicle_type
    if kind is None:
        notes.append("for which kind of vehicle is not said: only what all have in common was looked for; say it with "
                     "--vehicle-type")  # fmt: skip
    return firmware_of(pilot, kind)


def _print(file: Path, firmware: Firmware, items: int, findings: tuple[FirmwareFinding, ...]) -> None:
    from gcs_windplan.mission.lint import finding_lines

    for line in finding_lines(findings):
        typer.echo(f"{line.effect:<8}  {line.line}")
    head = f"{file.name} for {firmware.full_name}"
    if not findings:
        typer.echo(f"{head}: nothing {_EFFECTS} in {items} item{'' if items == 1 else 's'}")
        return
    counts = _counts(findings)
    typer.echo(f"{head}: {', '.join(f'{number} {effect}' for effect, number in counts.items())}")


def _counts(findings: tuple[FirmwareFinding, ...]) -> dict[str, int]:
    """How many findings of each effect there are, worst first."""
    from gcs_windplan.mission.lint import EFFECTS

    counted = {effect: sum(finding.effect == effect for finding in findings) for effect in EFFECTS}
    return {effect: number for effect, number in counted.items() if number}


def _print_json(
    file: Path, firmware: Firmware, items: int, findings: tuple[FirmwareFinding, ...], notes: list[str]
) -> None:
    document = {
        "verb": "check",
        "file": str(file),
        "autopilot": firmware.autopilot,
        "vehicle_type": firmware.vehicle_type,
        "items": items,
        "counts": _counts(findings),
        "findings": [
            {"rule": found.rule, "effect": found.effect, "item": found.item, "message": found.message}
            for found in findings
        ],
        "notes": notes,
        "exit_code": 1 if _counts_as_found(findings) else 0,
    }
    typer.echo(json.dumps(document, indent=2, ensure_ascii=False))
