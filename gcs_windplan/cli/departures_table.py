"""Departures as a table on the terminal."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from rich import box
from rich.table import Table

from gcs_windplan.cli.tables import make_console, spread_clock
from gcs_windplan.cores import available_cores
from gcs_windplan.flight import clock

if TYPE_CHECKING:
    from gcs_windplan.planning.departures import Departure
    from gcs_windplan.planning.request import Request

_BAR = 10  # characters of the longest time


def print_departures(request: Request, found: Sequence[Departure], took: float, cores: int | None) -> None:
    """A row for each departure, the quickest one marked, and what the sweep took."""
    flown = [one for one in found if one.feasible]
    best = min(flown, key=lambda one: one.key, default=None)
    longest = max((one.seconds or 0.0 for one in flown), default=1.0)
    table = Table(box=box.SIMPLE_HEAD, pad_edge=False, collapse_padding=True)
    table.add_column("departure UTC", min_width=11)
    ensemble, known = bool(request.scene.members), request.power is not None
    spread = {"10 - 90 %": 13, "flown in": 5} if ensemble else {}
    energy = {f"Wh{' (90 %)' * ensemble}": 11} if known else {}
    for name, width in {"time min": 5, **spread, **energy, "wind m/s": 4, "gust m/s": 4}.items():
        table.add_column(name, justify="right", min_width=width)
    table.add_column("", no_wrap=True, overflow="ellipsis", max_width=20 if ensemble else 40)
    for one in found:
        mark = "  best" if one is best else ""
        table.add_row(f"{one.moment:%m-%d %H:%M}", *_cells(one, ensemble, known), _last(one, longest) + mark)
    console = make_console()
    console.print(table)
    for line in _summary(request, found, flown, best, took, cores):
        console.print(line, soft_wrap=True, markup=False)


def _cells(one: Departure, ensemble: bool, known: bool) -> list[str]:
    if one.seconds is None:
        return ["-"] * (3 + 2 * ensemble + known)
    spread = []
    if ensemble:
        low, high = (one.spread.at(q) if one.spread is not None else one.seconds for q in (0.1, 0.9))
        able = f"{len(one.spread.seconds) - one.spread.unflyable}/{len(one.spread.seconds)}" if one.spread else "-"
        spread = [f"{spread_clock(low)} - {spread_clock(high)}", able]
    gust = "-" if one.gust is None else f"{one.gust:.1f}"
    energy = [] if one.energy is None else [_energy_of(one)]
    return [clock(one.seconds), *spread, *energy, f"{one.wind:.1f}", gust]


def _energy_of(one: Departure) -> str:
    """The energy en route, and over an ensemble that of the member at 90 %."""
    mean = f"{(one.energy or 0.0) / 3600:.0f}"
    if one.spread is None:
        return mean
    high = one.spread.energy_at(0.9)
    return f"{mean} ({high / 3600:.0f})" if high < float("inf") else f"{mean} (never)"


def _last(one: Departure, longest: float) -> str:
    """A bar as long as the flight, or why there is none."""
    if not one.feasible or one.seconds is None:
        return f"no: {one.brief or one.reason}"
    return "█" * max(1, round(_BAR * one.seconds / longest))


def _summary(
    request: Request, found: Sequence[Departure], flown: Sequence[Departure], best: Departure | None, took: float,
    cores: int | None,
) -> list[str]:  # fmt: skip
    """What to make of it, and what it took."""
    if best is None:
        lines = [f"{request.name}: no departure can be flown"]
    else:
        lines = [
            f"{request.name}: quickest when leaving {best.moment:%Y-%m-%d %H:%M} UTC, {clock(best.seconds or 0.0)} min;"
            f" {len(flown)} of {len(found)} departures can be flown"
        ]
    told: dict[str, Departure] = {}
    for one in found:
        if one.seconds is None and one.reason is not None:
            told.setdefault(one.reason, one)
    lines += [f"no route when leaving {one.moment:%m-%d %H:%M}: {reason}" for reason, one in list(told.items())[:3]]
    lines.append(f"wind: {request.scene.wind.name}")
    members = f" x {len(request.scene.members)} members" if request.scene.members else ""
    worked = sum(one.worked for one in found)
    used = min(available_cores() if cores is None else cores, len(found))
    lines.append(
        f"{len(found)} departures{members} in {took:.1f} s on {used} {'core' if used == 1 else 'cores'}: {worked:.1f} s"
        f" of one core's work, {worked / took:.1f} times as fast"
    )
    return lines
