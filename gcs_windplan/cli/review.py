"""`gcs-windplan review`: any mission judged against terrain and wind, as one page and an exit code."""

from __future__ import annotations

import re
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Literal

import typer

from gcs_windplan.cli.linking import Json, answering
from gcs_windplan.jobs.words import AutopilotName, VehicleKind

if TYPE_CHECKING:
    from gcs_windplan.assessment import Assessment

HELP = """Judge a mission against terrain, wind and limits; write one HTML page for offline use; print what is wrong.

A mission file (.yaml) is planned and judged in its own world. For a .plan or .waypoints say the world with --terrain,
--wind, --vehicle, or take that of a mission file: --by MISSION.yaml. Two missions are compared.
"""
EPILOG = "Exit codes: 0 nothing found; 1 findings, or no route exists; 2 something handed in cannot be used."


def review(
    mission: Annotated[Path, typer.Argument(metavar="MISSION", help="A .plan, a .waypoints, or a mission file.")],
    other: Annotated[Path | None, typer.Argument(metavar="OTHER", help="Another one, to compare.")] = None,
    terrain: Annotated[
        list[str] | None,
        typer.Option(metavar="FILE", help="Heights: GeoTIFF, .hgt; several by repeating; sample:jacksboro, flat:120."),
    ] = None,
    wind: Annotated[
        list[str] | None,
        typer.Option(metavar="FILE", help="Forecast: GRIB, NetCDF, JSON; or '8 m/s from 270'. Default still air."),
    ] = None,
    profile: Annotated[
        str | None,
        typer.Option(metavar="LAW", help="How the wind changes with height: power:0.143 or log:0.1 (roughness in m)."),
    ] = None,
    extend: Annotated[
        Literal["nearest"] | None, typer.Option(help="Outside the forecast's area take the nearest values.")
    ] = None,
    departure: Annotated[str | None, typer.Option(metavar="TIME", help="When it takes off: 2026-05-01T08:00Z.")] = None,
    vehicle: Annotated[
        Path | None, typer.Option(metavar="FILE", help="An airframe file; without one energy is not known.")
    ] = None,
    autopilot: Annotated[AutopilotName | None, typer.Option(help="In place of the mission's.")] = None,
    vehicle_type: Annotated[VehicleKind | None, typer.Option(help="In place of the mission's.")] = None,
    home: Annotated[
        str | None, typer.Option(metavar="LAT,LON[,ALT]", help="In place of the mission's; without ALT on the ground.")
    ] = None,
    by: Annotated[
        Path | None,
        typer.Option(
            metavar="MISSION.yaml", help="Judge by this mission file's terrain, wind, vehicle, limits, areas."
        ),
    ] = None,
    clearance: Annotated[
        str | None, typer.Option(metavar="LENGTH", help="Least height above ground; default 30 m, or the file's.")
    ] = None,
    max_height: Annotated[
        str | None, typer.Option(metavar="LENGTH", help="Largest height above ground: 120, '400 ft'.")
    ] = None,
    max_wind: Annotated[str | None, typer.Option(metavar="SPEED", help="Strongest wind: 10, '20 kt'.")] = None,
    max_gust: Annotated[str | None, typer.Option(metavar="SPEED", help="Strongest gust, of a forecast.")] = None,
    min_battery: Annotated[
        str | None, typer.Option(metavar="SHARE", help="What must be left at the end: '30 %', 0.3.")
    ] = None,
    first_leg: Annotated[
        str | None, typer.Option(metavar="LENGTH", help="How far the first place may be from home; default 500 m.")
    ] = None,
    output: Annotated[
        Path | None, typer.Option("-o", "--output", metavar="FILE", help="The page; default out/NAME/review.html.")
    ] = None,
    also: Annotated[
        str | None, typer.Option(metavar="kml,geojson,csv,png", help="Write these beside the page, by the same name.")
    ] = None,
    as_json: Json = False,
) -> None:
    """Judge, write, print."""
    from gcs_windplan.cli.choices import option_name
    from gcs_windplan.jobs.criteria import Criteria
    from gcs_windplan.jobs.review import judge

    criteria = Criteria(
        terrain=terrain or None,
        wind=wind or None,
        profile=profile,
        extend=extend == "nearest",
        departure=departure,
        vehicle=vehicle,
        autopilot=autopilot,
        vehicle_type=vehicle_type,
        home=home,
        clearance=clearance,
        max_height=max_height,
        max_wind=max_wind,
        max_gust=max_gust,
        min_battery=min_battery,
        first_leg=first_leg,
        named=option_name,
    )
    with answering("review", as_json):
        wanted = _exports(also)
        assessments = judge([mission] if other is None else [mission, other], by, criteria)
        read = [file for file in (mission, other, by, vehicle) if file is not None]
        written = _write(assessments, output, wanted, read)
    code = 1 if any(assessment.findings for assessment in assessments) else 0
    if as_json:
        from gcs_windplan.formats.verdict import format_verdict

        typer.echo(format_verdict(assessments, written, code))
    else:
        _print(assessments, written)
    if code:
        raise typer.Exit(code)


def _exports(also: str | None) -> tuple[str, ...]:
    """The formats that are written beside the page."""
    from gcs_windplan.errors import InputError, Problem
    from gcs_windplan.jobs.outputs import REVIEW_EXPORTS

    wanted = tuple(dict.fromkeys(part.strip().lower() for part in (also or "").split(",") if part.strip()))
    unknown = [name for name in wanted if name not in REVIEW_EXPORTS]
    if unknown:
        raise InputError(Problem(f"{unknown[0]!r} is none of {', '.join(REVIEW_EXPORTS)}", "--also"))
    return wanted


def _write(
    assessments: Sequence[Assessment], output: Path | None, wanted: Sequence[str], read: Sequence[Path]
) -> list[Path]:
    """Write the page and what is wanted beside it, all or nothing, and never over what was read."""
    from gcs_windplan.errors import InputError, Problem
    from gcs_windplan.jobs.outputs import make_folder, review_files, write_files

    page = output if output is not None else _default(assessments)
    if page.is_dir():
        page = page / "review.html"
    if page.suffix.lower() not in (".html", ".htm"):
        raise InputError(Problem(f"{page.name} is no name of a page: give one that ends in .html", "--output"))
    files = review_files(assessments, page.name, wanted)
    over = next((file for file in read if (page.parent / file.name).resolve() == file.resolve()), None)
    if over is not None and over.name in files:
        raise InputError(Problem("is what was read, and would be written over: choose another -o", file=over))
    return write_files(files, make_folder(page.parent))


def _default(assessments: Sequence[Assessment]) -> Path:
    """Where the page goes if nobody says."""
    name = "_and_".join(dict.fromkeys(re.sub(r"[^\w.-]+", "_", one.name.strip().lower()) for one in assessments))
    return Path("out") / name / "review.html"


def _print(assessments: Sequence[Assessment], written: Sequence[Path]) -> None:
    from gcs_windplan.cli.review_words import lines

    for assessment in assessments:
        for line in lines(assessment):
            typer.echo(line)
    for path in written:
        typer.echo(f"wrote {path}")
