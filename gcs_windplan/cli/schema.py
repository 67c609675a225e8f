"""`gcs-windplan schema`: what may stand in a mission file."""

from __future__ import annotations

from typing import Annotated

import typer

from gcs_windplan.cli.choices import print_json

HELP = "Print every field of the mission file with its unit, default and meaning."
EPILOG = None


def schema(
    json: Annotated[bool, typer.Option("--json", help="As JSON Schema, for editors.")] = False,
) -> None:
    """Print the schema's reference."""
    from gcs_windplan.jobs.missionfile.reference import json_schema, schema_reference

    if json:
        print_json(json_schema())
    else:
        typer.echo(schema_reference())
