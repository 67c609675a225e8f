"""The command `gcs-windplan`: one verb a file, errors turned into exit codes in one place."""

from __future__ import annotations

import io
import os
import signal
import sys
from collections.abc import Container
from types import ModuleType
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

#: One verb a file: `HELP`, the function of the file's name, and `EPILOG` where its exit codes are others.
VERBS = (
    plan, push, pull, diff, check, clear, vehicle, compare, departures, wind, review, reproduce, schema, help,
)  # fmt: skip


def add_verb(target: typer.Typer, module: ModuleType) -> None:
    """Make a verb of a file."""
    name = module.__name__.rpartition(".")[2]
    epilog = getattr(module, "EPILOG", _EPILOG)
    target.command(name, help=module.HELP, epilog=epilog)(getattr(module, name))


def _print_version(wanted: bool) -> None:
    """Print the installed version and leave."""
    if wanted:
        from importlib.metadata import version

        typer.echo(f"gcs-windplan {version('gcs-windplan')}")
        raise typer.Exit


def _root(
    version: Annotated[
        bool, typer.Option("--version", callback=_print_version, is_eager=True, help="Print the version.")
    ] = False,
) -> None:
    """Take the options that come before the verb."""


def command_line(asked: Container[str] | None = None) -> typer.Typer:
    """The command line with all its verbs; those that are not `asked` for have no options yet, which take long to read.

    Without `asked` all are whole.
    """
    line = typer.Typer(
        help="Drone missions that know the wind and the ground.",
        epilog=_ALL_CODES,
        rich_markup_mode=None,
        add_completion=False,
        pretty_exceptions_enable=False,
        no_args_is_help=True,
    )
    line.callback()(_root)
    for module in VERBS:
        name = module.__name__.rpartition(".")[2]
        if asked is None or name in asked:
            add_verb(line, module)
        else:
            line.command(name, help=module.HELP)(_not_asked)
    return line


def _not_asked() -> None:
    """Stand for a verb in the list of verbs."""


app = command_line()


def run() -> None:
    """Run the command line and exit with its code; raises KeyboardInterrupt."""
    for stream in (sys.stdout, sys.stderr):
        if isinstance(stream, io.TextIOWrapper):
            stream.reconfigure(errors="replace")  # a terminal without ° shows ?
    if hasattr(signal, "SIGPIPE"):
        signal.signal(signal.SIGPIPE, signal.SIG_DFL)  # `| head` ends us as it ends any tool; files are written before
    try:
        command_line(sys.argv[1:])()
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
