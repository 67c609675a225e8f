"""`gcs-windplan reproduce`: the paper's tables and figures, with our numbers beside the printed ones."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

if TYPE_CHECKING:
    from gcs_windplan.paper import Table

_WIDTH = 140  # where the output is no terminal

HELP = "Fly the paper's cases again; print Tables 1-4 beside its numbers; write Figures 3, 6, 7 and report.md."


def reproduce(
    output: Annotated[Path, typer.Option("-o", "--output", metavar="FOLDER", help="Where to write.")] = Path(
        "out/paper"
    ),
    quick: Annotated[bool, typer.Option("--quick", help="Sweep over a few starts and goals only.")] = False,
) -> None:
    """Reproduce and write."""
    from gcs_windplan.jobs.outputs import make_folder, write_files
    from gcs_windplan.paper import reproduce as fly_again

    make_folder(output)  # before minutes are spent on what goes into it
    done = fly_again(quick)
    for table in done.tables:
        _print(table)
    for path in write_files(done.files, output):
        typer.echo(f"wrote {path}")


def _print(table: Table) -> None:
    """A table on the terminal: words to the left, numbers to the right."""
    from rich import box
    from rich.console import Console
    from rich.table import Table as Grid
    from rich.text import Text

    grid = Grid(title=Text(table.title), title_justify="left", box=box.SIMPLE_HEAD, pad_edge=False)
    for i, name in enumerate(table.header):
        words = i < table.words
        grid.add_column(Text(name), justify="left" if words else "right", no_wrap=words)
    for row in table.rows:
        grid.add_row(*map(Text, row))
    console = Console(highlight=False)
    console = console if console.is_terminal else Console(highlight=False, width=_WIDTH)
    console.print(grid)
    if table.note:
        console.print(Text(table.note))
        console.print()
