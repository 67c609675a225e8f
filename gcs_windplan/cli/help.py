"""`gcs-windplan help`: the manual."""

from __future__ import annotations

from typing import Annotated

import typer

HELP = "Show a page of the manual; without TOPIC, what pages there are."
EPILOG = None


def help(
    topic: Annotated[str | None, typer.Argument(metavar="TOPIC", help="Such as planning or before-you-fly.")] = None,
) -> None:
    """Show a page of the manual, or what pages there are."""
    from gcs_windplan.manual import read_page, topics

    if topic is None:
        known = topics()
        width = max(map(len, known))
        for name, title in known.items():
            typer.echo(f"{name:{width}}  {title.partition(': ')[2] or title}")
        typer.echo("\ngcs-windplan help TOPIC shows a page; gcs-windplan VERB --help the options of a verb.")
    else:
        _show(read_page(topic))


def _show(page: str) -> None:
    """Set out for a terminal; as it is written where there is none."""
    import sys

    if not sys.stdout.isatty():
        typer.echo(page, nl=False)
        return
    import re

    from rich.console import Console
    from rich.markdown import Markdown

    without_pictures = re.sub(r"^!\[.*\]\(.*\)\n", "", page, flags=re.MULTILINE)
    Console().print(Markdown(without_pictures, hyperlinks=False))
