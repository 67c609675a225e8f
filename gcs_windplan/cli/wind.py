"""`gcs-windplan wind`: what is in forecast files, and the wind at a place."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

if TYPE_CHECKING:
    from collections.abc import Sequence

    from gcs_windplan.cli.wind_options import WindOptions
    from gcs_windplan.wind.field_index import FieldIndex

HELP = (
    "What is in forecast files that belong together (GRIB, NetCDF, answers of Open-Meteo): times, levels, members,"
    " area, gaps, what would stop planning, and a small picture. With --at the wind that planning has at a place."
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
    from gcs_windplan.cli.wind_options import read_options
    from gcs_windplan.wind.reading import open_indexes

    options = read_options(at, time, level, around, member)
    with open_indexes(files) as indexes:
        if options.place is None:
            _inventory(files, indexes, options, json)
        else:
            _wind_at(indexes, options, json)


def _inventory(files: Sequence[Path], indexes: Sequence[FieldIndex], options: WindOptions, as_json: bool) -> None:
    """What is in the files, and a picture unless they have no wind to show."""
    from gcs_windplan.cli import wind_json, wind_picture, wind_tables
    from gcs_windplan.cli.wind_options import WindOptions
    from gcs_windplan.errors import WindError
    from gcs_windplan.wind.inspect.inventory import take_inventory

    if as_json:
        typer.echo(wind_json.format_inventory(take_inventory(files, indexes)))
        return
    try:
        picture = wind_picture.draw(indexes, options)
    except WindError as error:
        if options != WindOptions():
            raise
        picture = wind_picture.Picture([], [f"no picture: {error}"])
    wind_tables.print_inventory(take_inventory(files, indexes))
    wind_tables.print_picture(picture)


def _wind_at(indexes: Sequence[FieldIndex], options: WindOptions, as_json: bool) -> None:
    """The wind at a place, and a picture of its surroundings where that is wanted."""
    from gcs_windplan.cli import wind_json, wind_picture, wind_tables
    from gcs_windplan.wind.inspect.sounding import take_sounding

    assert options.place is not None
    sounding = take_sounding(indexes, options.place, options.moment, options.members, options.height)
    if as_json:
        typer.echo(wind_json.format_sounding(sounding))
        return
    picture = None if options.radius is None else wind_picture.draw(indexes, options)
    wind_tables.print_sounding(sounding)
    if picture is not None:
        wind_tables.print_picture(picture)
