"""`gcs-windplan departures`: when to fly."""

from __future__ import annotations

import re
from collections.abc import Iterator
from datetime import datetime, timedelta
from typing import TYPE_CHECKING, Annotated

import typer

from gcs_windplan.cli.choices import Airspeed, MissionFile, read_request

if TYPE_CHECKING:
    from gcs_windplan.planning.departures import Departure

HELP = (
    "When to fly: the best route at each departure in the mission's forecast; time, its spread over the ensemble's"
    " members, the strongest wind and gust on the way. Each is planned in the members' mean and shaped quickly; `plan`"
    " takes more care."
)
_MOST = 2000  # departures


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

    from gcs_windplan.jobs.missionfile import read_document
    from gcs_windplan.planning.departures import moments_between, sweep

    day = read_document(mission).model.departure
    begin = _moment("--from", first, day)
    end = _moment("--to", last, day if day is None else begin)
    moments = moments_between(begin, _after(begin, end, last), _step(every))
    _refuse_odd(len(moments))
    lasting = (moments[-1] - begin).total_seconds() + _DAY
    request = read_request(mission, airspeed, begin, lasting)
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


_DAY = 24 * 3600.0
_LONGEST_STEP = 30 * _DAY
_CLOCK = re.compile(r"([01]?\d|2[0-3]):([0-5]\d)Z?")
_STEPS = {"s": 1.0, "sec": 1.0, "min": 60.0, "m": 60.0, "h": 3600.0}


def _moment(option: str, text: str, day: datetime | None) -> datetime:
    """A time of day in UTC on the mission's day, or a date and time with its offset."""
    from gcs_windplan.errors import InputError, Problem
    from gcs_windplan.jobs.missionfile.values import Moment

    clock = _CLOCK.fullmatch(text.strip())
    if clock is not None:
        if day is None:
            raise InputError(
                Problem("the mission has no departure, so the day is not known; write 2026-05-01T06:00Z", option)
            )
        return day.replace(hour=int(clock[1]), minute=int(clock[2]), second=0, microsecond=0)
    try:
        return Moment().read(text)
    except ValueError as error:
        raise InputError(Problem(f"{error}, or a time of day in UTC such as 06:00", option)) from None


def _after(begin: datetime, end: datetime, text: str) -> datetime:
    """The end, on the next day where a time of day lies before the begin."""
    from gcs_windplan.errors import InputError, Problem

    if end >= begin:
        return end
    if _CLOCK.fullmatch(text.strip()) and end.year < 9999:
        return end + timedelta(days=1)
    raise InputError(Problem(f"{end:%Y-%m-%d %H:%M} UTC lies before --from, {begin:%Y-%m-%d %H:%M} UTC", "--to"))


def _step(text: str) -> timedelta:
    """The time between two departures."""
    from gcs_windplan.errors import InputError, Problem

    found = re.fullmatch(r"(\d+(?:\.\d+)?)\s*([a-z]+)", text.strip().lower())
    seconds = float(found[1]) * _STEPS[found[2]] if found is not None and found[2] in _STEPS else 0.0
    if not 1.0 <= seconds <= _LONGEST_STEP:
        raise InputError(Problem(f"{text!r} is no step; write for example 30min, 1h or 600s", "--every"))
    return timedelta(seconds=seconds)


def _refuse_odd(count: int) -> None:
    """Raise for more departures than anyone reads."""
    from gcs_windplan.errors import InputError, Problem

    if count > _MOST:
        raise InputError(Problem(f"makes {count} departures; at most {_MOST}: a longer step", "--every"))


def _shown(found: Iterator[Departure], count: int, visible: bool) -> Iterator[Departure]:
    """The departures as they come, with a progress bar on a terminal."""
    from rich.console import Console
    from rich.progress import track

    console = Console(stderr=True)
    yield from track(
        found, "departures", total=count, console=console, transient=True, disable=not (visible and console.is_terminal)
    )
