"""Plans as tables on the terminal."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from rich import box
from rich.console import Console
from rich.table import Table

from gcs_windplan.flight import clock

if TYPE_CHECKING:
    from gcs_windplan.planner import Plan

_WIDTH = 100  # where the output is no terminal


def make_console() -> Console:
    """The terminal, or 100 columns where there is none."""
    console = Console(highlight=False)
    return console if console.is_terminal else Console(highlight=False, width=_WIDTH)


def print_legs(plan: Plan) -> None:
    """The legs of a plan, a row each, and the totals."""
    table = Table(box=box.SIMPLE_HEAD, pad_edge=False, collapse_padding=True)
    for name in ("leg", "track °", "heading °", "length m", "climb m", "to m AMSL", "ground m/s", "wind along",
                 "across m/s", "time", "AGL m", *(["battery %"] if plan.battery else [])):  # fmt: skip
        table.add_column(name, justify="right")
    left = [[f"{100 * share:.0f}"] for share in plan.battery.left[1:]] if plan.battery else [[]] * len(plan.legs)
    for leg, target, rest in zip(plan.legs, plan.waypoints[1:], left, strict=True):
        table.add_row(
            f"{leg.number}", f"{leg.track_deg:03.0f}", f"{leg.heading_deg:03.0f}", f"{leg.length:.0f}",
            f"{leg.climb:+.0f}", f"{target.altitude:.1f}", f"{leg.ground_speed:.1f}", f"{leg.wind_along:+.1f}",
            f"{leg.wind_across:+.1f}", clock(leg.seconds), f"{leg.clearance:.0f} - {leg.height:.0f}", *rest,
        )  # fmt: skip
    console = make_console()
    console.print(table)
    for line in summary_lines(plan):
        console.print(line, soft_wrap=True, markup=False)
    if (flown := flown_line(plan)) is not None:
        console.print(flown, soft_wrap=True, markup=False)
    for note in plan.notes:
        console.print(f"note: {note}", soft_wrap=True, markup=False)


def flown_line(plan: Plan) -> str | None:
    """How long the autopilot takes for the mission, in words; None where that is not known."""
    from gcs_windplan.mission.planned import flown_duration

    if not plan.request.export.speed_changes or (flown := flown_duration(plan)) is None:
        return None
    who = "PX4 may fly" if plan.request.vehicle.autopilot == "px4" else "ArduCopter flies"
    return (
        f"as {who} it, corners and acceleration counted: {clock(flown.en_route)} min en route,"
        f" {clock(flown.total)} min in all"
    )


def summary_lines(plan: Plan) -> list[str]:
    """The totals of a plan, in words."""
    totals, effort = plan.totals, plan.effort
    return [
        *_head(plan),
        *_energy(plan),
        f"above ground {totals.clearance:.1f} to {totals.height:.1f} m; climbs {totals.climb:.0f} m,"
        f" descends {totals.descent:.0f} m; wind: {plan.request.wind.name}",
        f"{effort.nodes} nodes laid in {effort.veil_seconds:.2f} s, {effort.expanded} expanded in"
        f" {effort.search_seconds:.2f} s, {effort.vertices} vertices shaped in {effort.shaping_seconds:.2f} s",
    ]


def _head(plan: Plan) -> list[str]:
    """What the route is, and how long it takes; over an ensemble in its members, too."""
    totals = plan.totals
    lines = [
        f"{plan.request.name}, least {plan.choice}: {len(plan.waypoints)} waypoints, {totals.length / 1000:.2f} km,"
        f" {clock(totals.seconds)} min en route, {_ends(plan)}"
    ]
    if plan.spread is not None:
        low, median, high = (spread_clock(plan.spread.at(quantile)) for quantile in (0.1, 0.5, 0.9))
        stopped = f"; {plan.spread.unflyable} of them cannot fly it" if plan.spread.unflyable else ""
        lines.append(
            f"in the {len(plan.spread.seconds)} members, planned for {100 * plan.request.robust:g} %: median {median}"
            f" min, 10 - 90 % {low} - {high} min{stopped}; the legs above are in their mean"
        )
    return lines


def _energy(plan: Plan) -> list[str]:
    """What the route takes from the battery, where that is known."""
    totals, airframe, use = plan.totals, plan.request.airframe, plan.battery
    if airframe is None or use is None or totals.energy is None:
        return []
    line = f"energy {watt_hours(totals.energy)} Wh en route"
    if plan.spread is not None:
        low, median, high = (watt_hours(plan.spread.energy_at(quantile)) for quantile in (0.1, 0.5, 0.9))
        line += f" (in the members: median {median}, 10 - 90 % {low} - {high} Wh)"
    over = f", {watt_hours(use.missing)} Wh into the reserve" if use.missing else ", the reserve stays"
    return [
        f"{line}; {watt_hours(use.total)} Wh with take-off{' and landing' * (plan.request.finish == 'land')}, of"
        f" {watt_hours(use.usable)} usable Wh{over} ({airframe.name})"
    ]


def watt_hours(joules: float) -> str:
    """An energy [J] in Wh, which may be infinite."""
    return f"{joules / 3600:.1f}" if joules < float("inf") else "never"


def spread_clock(seconds: float) -> str:
    """A member's time, which may be infinite."""
    return clock(seconds) if seconds < float("inf") else "never"


def _ends(plan: Plan) -> str:
    """What comes before and after the route."""
    takeoff = f"take-off {clock(plan.totals.takeoff_seconds)}"
    if plan.request.finish == "land":
        return f"{takeoff} and landing {clock(plan.totals.landing_seconds)} more"
    if plan.request.finish == "return":
        return f"{takeoff} more; the return to launch is not counted"
    return f"{takeoff} more"


def print_comparison(plans: Sequence[Plan]) -> None:
    """Several plans of one request, a row each."""
    table = Table(box=box.SIMPLE_HEAD, pad_edge=False, collapse_padding=True)
    table.add_column("least", justify="left", no_wrap=True)
    for name in ("time min", "against best", "length km", "points", "climb m", "AGL m",
                 "expanded", "search s"):  # fmt: skip
        table.add_column(name, justify="right")
    best = min(plan.totals.seconds for plan in plans)
    for plan in plans:
        totals, effort = plan.totals, plan.effort
        table.add_row(
            plan.choice.name, clock(totals.seconds), f"+{100 * (totals.seconds / best - 1):.1f} %",
            f"{totals.length / 1000:.2f}", f"{len(plan.waypoints)}", f"{totals.climb:.0f}",
            f"{totals.clearance:.0f} - {totals.height:.0f}", f"{effort.expanded}", f"{effort.search_seconds:.3f}",
        )  # fmt: skip
    console = make_console()
    console.print(table)
    hybrid = next((plan.choice for plan in plans if plan.choice.name == "hybrid"), None)
    if hybrid is not None:
        console.print(f"hybrid weighs distance {hybrid.distance:g} and angle {hybrid.angle:g}", soft_wrap=True)
