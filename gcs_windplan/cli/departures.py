"""`gcs-windplan departures`: when to fly."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING, Annotated

import typer

from gcs_windplan.cli.choices import Airspeed, MissionFile, asked_mission

if TYPE_CHECKING:
    from gcs_windplan.planning.departures import Departure

HELP = (
    "When to fly: the best route at each departure in the mission's forecast; time, its spread over the ensemble's"
    " members, the strongest wind and gust on the way. Each is planned in the members' mean and shaped quickly; `plan`"
    " takes more care."
)
_MOST = 2000  # departures
_OPTIONS = {"first": "--from", "last": "--to", "every": "--every"}


def departures(
    mission: MissionFile,
    first: Annotated[
        str,
        typer.Option(
            "--from", metavar="TIME", help="The first departure: 06:00 (UTC, on the mission's day) or a date and time."
        ),
    ],
    last: Annotated[
        str,
        typer.Option("--to", metavar="TIME", help="The last one: the same forms; 06:00 after 18:00 is the next day."),
    ],
    every: Annotated[str, typer.Option(metavar="STEP", help="Between two departures: 30min, 1h, 600s.")] = "30min",
    airspeed: Airspeed = None,
    cores: Annotated[int | None, typer.Option(metavar="N", min=1, help="How many cores to use; default all.")] = None,
    json_output: Annotated[bool, typer.Option("--json", help="Print for scripts.")] = False,
) -> None:
    """Plan at each departure and print a table."""
    import time

    from gcs_windplan.jobs.plans import departures_request
    from gcs_windplan.planning.departures import sweep

    asked = asked_mission(mission, airspeed)
    request, moments = departures_request(asked, first, last, every, most=_MOST, named=_OPTIONS.__getitem__)
    since = time.monotonic()
    found = list(_shown(sweep(request, moments, cores=cores), len(moments), not json_output))
    took = time.monotonic() - since
    if json_output:
        from gcs_windplan.formats.departures import format_departures

        typer.echo(format_departures(request, found), nl=False)
        raise typer.Exit(0 if any(one.feasible for one in found) else 1)
    from gcs_windplan.cli.departures_table import print_departures

    print_departures(request, found, took, cores)
    if not any(one.feasible for one in found):
        raise typer.Exit(1)


def _shown(found: Iterator[Departure], count: int, visible: bool) -> Iterator[Departure]:
    """The departures as they come, with a progress bar on a terminal."""
    from rich.console import Console
    from rich.progress import track

    console = Console(stderr=True)
    yield from track(
        found, "departures", total=count, console=console, transient=True, disable=not (visible and console.is_terminal)
    )
