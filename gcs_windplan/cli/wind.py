"""`gcs-windplan wind`: what is in forecast files, and the wind at a place."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

if TYPE_CHECKING:
    from gcs_windplan.cli.wind_options import Asked, View
    from gcs_windplan.geo.frame import GeoPoint
    from gcs_windplan.wind.report.inventory import OpenFile
    from gcs_windplan.wind.report.sounding import Altitude
    from gcs_windplan.wind.sheets import Catalogue

HELP = (
    "What is in forecast files that belong together (GRIB, NetCDF, answers of Open-Meteo): times, levels, members,"
    " area, gaps, what would stop planning, and a small picture. With --at the wind at a place."
)


def wind(
    files: Annotated[list[Path], typer.Argument(metavar="FILE", help="The forecast's files.")],
    at: Annotated[
        str | None,
        typer.Option(
            metavar="LAT,LON[,ALT]",
            help="The wind there, ALT above mean sea level: 2100, '7000 ft', or above ground: '80 m agl'; without ALT"
            " on all levels.",
        ),
    ] = None,
    time: Annotated[
        str | None, typer.Option(metavar="TIME", help="When: 2026-05-01T08:00Z; default the first time.")
    ] = None,
    level: Annotated[
        str | None,
        typer.Option(metavar="LEVEL", help="Of the picture: '100 m', '850 hPa'; default the nearest to 100 m."),
    ] = None,
    around: Annotated[
        str | None, typer.Option(metavar="RADIUS", help="Picture the surroundings of --at: '20 km'.")
    ] = None,
    member: Annotated[
        str | None, typer.Option(metavar="N", help="One member of an ensemble, or all; default what planning takes.")
    ] = None,
    json: Annotated[bool, typer.Option("--json", help="Print for scripts, without the picture.")] = False,
) -> None:
    """Look into the files and print."""
    from gcs_windplan.cli.wind_options import Asked, read_member, read_place, read_time, read_view
    from gcs_windplan.wind.report.inventory import open_files

    place = None if at is None else read_place(at)
    asked = Asked(read_time(time), read_member(member))
    view = read_view(level, around, None if place is None else place[0])
    with _named(files), open_files(files) as opened:
        if place is None:
            _inventory(opened, asked, view, json)
        else:
            _wind_at([file.catalogue for file in opened], *place, asked, view, json)


def _inventory(opened: Sequence[OpenFile], asked: Asked, view: View, as_json: bool) -> None:
    """What is in the files, and a picture unless they have no wind to show."""
    from gcs_windplan.cli import wind_json, wind_picture, wind_tables
    from gcs_windplan.cli.wind_options import Asked, View
    from gcs_windplan.errors import WindError
    from gcs_windplan.wind.report.inventory import take_inventory

    if as_json:
        typer.echo(wind_json.format_inventory(take_inventory(opened)))
        return
    try:
        picture = wind_picture.draw([file.catalogue for file in opened], asked, view)
    except WindError as error:
        if asked != Asked() or view != View():
            raise
        picture = wind_picture.Picture([], [f"no picture: {error}"])
    wind_tables.print_inventory(take_inventory(opened))
    wind_tables.print_picture(picture)


def _wind_at(
    catalogues: Sequence[Catalogue], place: GeoPoint, altitude: Altitude | None, asked: Asked, view: View, as_json: bool
) -> None:
    """The wind at a place, and a picture of its surroundings where that is wanted."""
    from gcs_windplan.cli import wind_json, wind_picture, wind_tables
    from gcs_windplan.wind.report.sounding import sounding_at, spot_at

    found = sounding_at(catalogues, place, *asked) if altitude is None else spot_at(catalogues, place, altitude, *asked)
    if as_json:
        typer.echo(wind_json.format_wind(found))
        return
    picture = None if view.radius is None else wind_picture.draw(catalogues, asked, view)
    wind_tables.print_wind(found)
    if picture is not None:
        wind_tables.print_picture(picture)


@contextmanager
def _named(files: Sequence[Path]) -> Iterator[None]:
    """Errors begin with the files, as those of planning do."""
    from gcs_windplan.errors import WindError

    try:
        yield
    except WindError as error:
        if any(str(error).startswith(str(file)) for file in files):
            raise
        more = f" and {len(files) - 1} more" if len(files) > 1 else ""
        raise WindError(f"{files[0]}{more}: {error}") from error
