"""`gcs-windplan diff`: whether two files hold the same mission, as far as a firmware keeps it."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Literal

import typer

from gcs_windplan.cli import linking

if TYPE_CHECKING:
    from gcs_windplan.link.comparison import Comparison
    from gcs_windplan.mission import Mission, MissionItem
    from gcs_windplan.vehicle import Autopilot

HELP = """Compare two missions: what was planned and what a vehicle gave back, in either order.

What the firmware is known not to keep (ArduPilot: parts of a centimetre, some parameters, frames, its own home) is no
difference. The firmware is what the files say, unless --autopilot does; where nobody says, or the files name two,
every number counts.
"""
EPILOG = "Exit codes: 0 the same; 1 different; 2 a file cannot be read."


def diff(
    one: Annotated[Path, typer.Argument(metavar="A", help="A .plan or .waypoints.")],
    other: Annotated[Path, typer.Argument(metavar="B", help="Another.")],
    autopilot: Annotated[Literal["ardupilot", "px4"] | None, typer.Option(help="Whose rules count.")] = None,
    as_json: linking.Json = False,
) -> None:
    """Read both, compare, report."""
    first, second = _read(one), _read(other)
    firmware = autopilot or _agreed(first.autopilot, second.autopilot)
    kinds = {mission.vehicle_type for mission in (first, second)} - {None} or {None}
    comparisons = {
        "mission": max(  # of two kinds of vehicles, the stricter rules
            (_compared(first.items, second.items, "mission", firmware, kind) for kind in sorted(kinds, key=str)),
            key=lambda comparison: len(comparison.differences),
        )
    }
    if firmware is None:
        comparisons["mission"] = _with_home(comparisons["mission"], first, second)
    if ".plan" == one.suffix.lower() == other.suffix.lower():
        from gcs_windplan.mission import fence_items, rally_items

        fences = fence_items(first.fence), fence_items(second.fence)
        rallies = rally_items(first.rally), rally_items(second.rally)
        comparisons["fence"] = _compared(*fences, "fence", firmware, None)
        comparisons["rally"] = _compared(*rallies, "rally", firmware, None)
    else:
        _note_fences(first, second)
    _report(comparisons, firmware, as_json)


def _agreed(one: Autopilot | None, other: Autopilot | None) -> Autopilot | None:
    """The autopilot that the files name; None where they name two."""
    if one is not None and other is not None and one != other:
        linking.note("the files name different autopilots: every number counts")
        return None
    return one or other


def _read(file: Path) -> Mission:
    from gcs_windplan.formats import read_mission

    read = read_mission(file)
    for repair in read.repairs:
        linking.note(f"{file}: {repair}")
    return read.mission


def _compared(
    ours: tuple[MissionItem, ...],
    theirs: tuple[MissionItem, ...],
    kind: Literal["mission", "fence", "rally"],
    autopilot: Autopilot | None,
    vehicle_type: Literal["multicopter", "fixed-wing"] | None,
) -> Comparison:
    from gcs_windplan.link.comparison import compare_either_way
    from gcs_windplan.mission.firmware import known_firmware

    firmware = known_firmware(autopilot, vehicle_type)
    return compare_either_way(ours, theirs, mission_type=kind, firmware=firmware)


def _with_home(comparison: Comparison, first: Mission, second: Mission) -> Comparison:
    """The comparison with home, which no firmware takes from a mission, and which counts where none is named."""
    from gcs_windplan.link.comparison import Difference

    if first.home == second.home:
        return comparison
    ours, theirs = (
        "unknown" if mission.home is None else f"{mission.home.point}, {mission.home.altitude:.3f} m"
        for mission in (first, second)
    )
    return replace(comparison, differences=(Difference(None, "home", ours, theirs), *comparison.differences))


def _note_fences(first: Mission, second: Mission) -> None:
    if any(mission.fence is not None or mission.rally for mission in (first, second)):
        linking.note("fence and rally points were not compared: a .waypoints file has none")


def _report(comparisons: dict[str, Comparison], firmware: Autopilot | None, as_json: bool) -> None:
    same = all(comparison.same for comparison in comparisons.values())
    if as_json:
        parts = {
            kind: {
                "differences": [str(difference) for difference in comparison.differences],
                "losses": [str(loss) for loss in comparison.losses],
            }
            for kind, comparison in comparisons.items()
        }
        typer.echo(json.dumps({"verb": "diff", "same": same, "autopilot": firmware, "parts": parts}, indent=2))
    else:
        _print(comparisons, firmware, same)
    if not same:
        raise typer.Exit(1)


def _print(comparisons: dict[str, Comparison], firmware: Autopilot | None, same: bool) -> None:
    from gcs_windplan.link.comparison import loss_lines
    from gcs_windplan.mission.firmware import known_firmware

    for kind, comparison in comparisons.items():
        for difference in comparison.differences:
            typer.echo(f"{kind}: {difference}")
    for kind, comparison in comparisons.items():
        for line in loss_lines(comparison.losses, known_firmware(firmware)):
            typer.echo(f"{kind}: {line}")
    if same:
        typer.echo("the same")
