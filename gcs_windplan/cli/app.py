"""The command `gcs-windplan`: one verb a file, errors turned into exit codes in one place."""

from __future__ import annotations

import io
import os
import signal
import sys
from typing import Annotated

import typer

from gcs_windplan.cli import (
    check,
    clear,
    compare,
    departures,
    diff,
    help,
    linking,
    plan,
    pull,
    push,
    reproduce,
    review,
    schema,
    vehicle,
    wind,
)
from gcs_windplan.errors import WindplanError

_EPILOG = "Exit codes: 0 done; 1 no route exists; 2 something handed in cannot be used."
_ALL_CODES = _EPILOG + " Verbs that talk to a vehicle: 3 the vehicle said no; 4 what it holds is unknown."
_INTERRUPTED = 130  # what typer makes of Ctrl-C

app = typer.Typer(
    help="Drone missions that know the wind and the ground.",
    epilog=_ALL_CODES,
    rich_markup_mode=None,
    add_completion=False,
    pretty_exceptions_enable=False,
    no_args_is_help=True,
)
app.command("plan", help=plan.HELP, epilog=_EPILOG)(plan.plan)
app.command("push", help=push.HELP, epilog=linking.EPILOG)(push.push)
app.command("pull", help=pull.HELP, epilog=linking.EPILOG)(pull.pull)
app.command("diff", help=diff.HELP, epilog=diff.EPILOG)(diff.diff)
app.command("check", help=check.HELP, epilog=check.EPILOG)(check.check)
app.command("clear", help=clear.HELP, epilog=linking.EPILOG)(clear.clear)
app.command("vehicle", help=vehicle.HELP, epilog=vehicle.EPILOG)(vehicle.vehicle)
app.command("compare", help=compare.HELP, epilog=_EPILOG)(compare.compare)
app.command("departures", help=departures.HELP, epilog=_EPILOG)(departures.departures)
app.command("wind", help=wind.HELP, epilog=_EPILOG)(wind.wind)
app.command("review", help=review.HELP, epilog=review.EPILOG)(review.review)
app.command("reproduce", help=reproduce.HELP, epilog=_EPILOG)(reproduce.reproduce)
app.command("schema", help=schema.HELP)(schema.schema)
app.command("help", help=help.HELP)(help.help)


def _print_version(wanted: bool) -> None:
    """Print the installed version and leave."""
    if wanted:
        from importlib.metadata import version

        typer.echo(f"gcs-windplan {version('gcs-windplan')}")
        raise typer.Exit


@app.callback()
def _root(
    version: Annotated[
        bool, typer.Option("--version", callback=_print_version, is_eager=True, help="Print the version.")
    ] = False,
) -> None:
    """Take the options that come before the verb."""


def run() -> None:
    """Run the command line and exit with its code; raises KeyboardInterrupt."""
    for stream in (sys.stdout, sys.stderr):
        if isinstance(stream, io.TextIOWrapper):
            stream.reconfigure(errors="replace")  # a terminal without ° shows ?
    if hasattr(signal, "SIGPIPE"):
        signal.signal(signal.SIGPIPE, signal.SIG_DFL)  # `| head` ends us as it ends any tool; files are written before
    try:
        app()
    except SystemExit as end:
        if end.code == _INTERRUPTED:
            raise KeyboardInterrupt from None
        raise
    except OSError as error:
        sys.stdout = open(os.devnull, "w")  # noqa: SIM115 (what is left in the old one cannot be written)
        typer.echo(f"error: the output cannot be written ({error.strerror})", err=True)
        sys.exit(2)
    except WindplanError as error:
        for line in linking.told(error):
            typer.echo(f"error: {line}", err=True)
        sys.exit(linking.code_of(error))
