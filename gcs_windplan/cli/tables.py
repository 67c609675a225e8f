"""Plans as tables on the terminal."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from rich import box
from rich.console import Console
from rich.table import Table

from gcs_windplan.flight import clock
from gcs_windplan.mission.firmware import firmware_of

if TYPE_CHECKING:
    from gcs_windplan.planning.planner import PlannedRoute

_WIDTH, _WIDE = 100, 120  # where the output is no terminal


def make_console(width: int = _WIDTH) -> Console:
    """The terminal, or so many columns where there is none."""
    console = Console(highlight=False)
    return console if console.is_terminal else Console(highlight=False, width=width)


def print_legs(plan: PlannedRoute) -> None:
    """The legs of a plan, a row each, and the totals."""
    table = Table(box=box.SIMPLE_HEAD, pad_edge=False, collapse_padding=True)
    for name in ("leg", "track °", "heading °", "length m", "climb m", "to m AMSL", "ground m/s", "wind along",
                 "across m/s", "time", "AGL m", *_power_columns(plan)):  # fmt: skip
        table.add_column(name, justify="right")
    for leg, target, rest in zip(plan.legs, plan.waypoints[1:], _power_cells(plan), strict=True):
        table.add_row(
            f"{leg.number}", f"{leg.track_deg:03.0f}", f"{leg.heading_deg:03.0f}", f"{leg.length:.0f}",
            f"{leg.climb:+.0f}", f"{target.altitude:.1f}", f"{leg.ground_speed:.1f}", f"{leg.wind_along:+.1f}",
            f"{leg.wind_across:+.1f}", clock(leg.seconds), f"{leg.clearance:.0f}-{leg.height:.0f}", *rest,
        )  # fmt: skip
    console = make_console(_WIDE)
    console.print(table)
    for line in summary_lines(plan):
        console.print(line, soft_wrap=True, markup=False)
    if (flown := flown_line(plan)) is not None:
        console.print(flown, soft_wrap=True, markup=False)
    for note in plan.notes:
        console.print(f"note: {note}", soft_wrap=True, markup=False)


def _power_columns(plan: PlannedRoute) -> list[str]:
    """What the table says of airspeeds and the battery, where that is known."""
    free = ["air m/s"] if plan.request.free_airspeed else []
    return free + (["left %", "home Wh"] if plan.battery and plan.ways_home else [])


def _power_cells(plan: PlannedRoute) -> list[list[str]]:
    """The same for each leg."""
    free = [[f"{leg.airspeed:.1f}"] if plan.request.free_airspeed else [] for leg in plan.legs]
    if plan.battery is None or plan.ways_home is None:
        return free
    known = zip(free, plan.battery.left[1:], plan.ways_home.energies[1:], strict=True)
    return [[*cells, f"{100 * left:.0f}", _whole_watt_hours(home)] for cells, left, home in known]


def _whole_watt_hours(joules: float) -> str:
    return f"{joules / 3600:.0f}" if joules < float("inf") else "no way"


def flown_line(plan: PlannedRoute) -> str | None:
    """How long the autopilot takes for the mission, in words; None where that is not known."""
    from gcs_windplan.planning.export import flown_duration

    if not plan.request.export.speed_changes or (flown := flown_duration(plan)) is None:
        return None
    vehicle = plan.request.vehicle
    firmware = firmware_of(vehicle.autopilot, vehicle.type)
    sure = "flies" if firmware.motion_measured else "may fly"
    return (
        f"as {firmware.name} {sure} it, corners and acceleration counted: {clock(flown.en_route)} min en route,"
        f" {clock(flown.total)} min in all"
    )


def summary_lines(plan: PlannedRoute) -> list[str]:
    """The totals of a plan, in words."""
    totals, effort = plan.totals, plan.effort
    return [
        *_head(plan),
        *_energy(plan),
        *_way_home(plan),
        f"above ground {totals.clearance:.1f} to {totals.height:.1f} m; climbs {totals.climb:.0f} m,"
        f" descends {totals.descent:.0f} m; wind: {plan.request.scene.wind.name}",
        *_strongest(plan),
        f"{effort.nodes} nodes laid in {effort.veil_seconds:.2f} s, {effort.expanded} expanded in"
        f" {effort.search_seconds:.2f} s, {effort.vertices} vertices shaped in {effort.shaping_seconds:.2f} s",
    ]


def _head(plan: PlannedRoute) -> list[str]:
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


def _energy(plan: PlannedRoute) -> list[str]:
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
        f"{line}; {watt_hours(use.total)} Wh as flown, with take-off{_last(plan)}, of"
        f" {watt_hours(use.usable)} usable Wh{over} ({airframe.name})"
    ]


def _strongest(plan: PlannedRoute) -> list[str]:
    """The strongest wind and gust met, where they have limits."""
    met, limits = plan.strongest, plan.request.limits
    if met is None:
        return []
    members = len(met.winds)
    where = f" in any of the {members} members" if members > 1 else ""
    known = [("wind", met.wind, limits.wind)] + ([] if met.gust is None else [("gust", met.gust, limits.gust)])
    told = [
        f"{name} {speed:.1f} m/s" + (f" (limits.{name} {limit:g} m/s)" if limit is not None else "")
        for name, speed, limit in known
    ]
    kept = f"; {met.within_limits(limits)} of {members} keep the limits" if members > 1 else ""
    return [f"strongest{where}: {', '.join(told)}{kept}"]


def _last(plan: PlannedRoute) -> str:
    """What comes after the route and counts."""
    return {"land": " and landing", "return": " and return", "hold": ""}[plan.request.finish]


def _way_home(plan: PlannedRoute) -> list[str]:
    """How far home stays within reach, where that is known."""
    ways = plan.ways_home
    if ways is None:
        return []
    most = f"the minimum-energy return takes at most {watt_hours(max(ways.energies))} Wh"
    if plan.request.rally:
        most += f", to a rally point at most {watt_hours(max(ways.alternates))} Wh"
    if ways.point_of_no_return is None:
        return [f"{most}; it is in reach with the reserve from every waypoint"]
    point = ways.point_of_no_return
    if point.distance == 0:
        return [f"{most}; it is not in reach with the reserve from any waypoint"]
    where = f"{point.distance / 1000:.2f} km, {clock(point.seconds)} min, on leg {point.leg}"
    return [f"{most}; point of no return with the reserve: {where}"]


def watt_hours(joules: float) -> str:
    """An energy [J] in Wh, which may be infinite."""
    return f"{joules / 3600:.1f}" if joules < float("inf") else "never"


def spread_clock(seconds: float) -> str:
    """A member's time, which may be infinite."""
    return clock(seconds) if seconds < float("inf") else "never"


def _ends(plan: PlannedRoute) -> str:
    """What comes before and after the route."""
    takeoff = f"take-off {clock(plan.totals.takeoff_seconds)}"
    if plan.request.finish == "land":
        return f"{takeoff} and landing {clock(plan.totals.landing_seconds)} more"
    if plan.request.finish == "return":
        return f"{takeoff} and the return to launch more"
    return f"{takeoff} more"


def print_comparison(plans: Sequence[PlannedRoute]) -> None:
    """Several plans of one request, a row each."""
    table = Table(box=box.SIMPLE_HEAD, pad_edge=False, collapse_padding=True)
    table.add_column("least", justify="left", no_wrap=True)
    powered = all(plan.totals.energy is not None for plan in plans)
    for name in ("time min", "more", *(["energy Wh", "more"] if powered else []), "length km", "points", "climb m",
                 "AGL m", "expanded", "search s"):  # fmt: skip
        table.add_column(name, justify="right")
    best = min(plan.totals.seconds for plan in plans)
    least = min(plan.totals.energy or 0.0 for plan in plans)
    for plan in plans:
        totals, effort = plan.totals, plan.effort
        energy: list[str] = []
        if powered and totals.energy is not None:
            energy = [f"{totals.energy / 3600:.1f}", f"+{100 * (totals.energy / least - 1):.1f} %"]
        table.add_row(
            plan.choice.name, clock(totals.seconds), f"+{100 * (totals.seconds / best - 1):.1f} %", *energy,
            f"{totals.length / 1000:.2f}", f"{len(plan.waypoints)}", f"{totals.climb:.0f}",
            f"{totals.clearance:.0f}-{totals.height:.0f}", f"{effort.expanded}", f"{effort.search_seconds:.3f}",
        )  # fmt: skip
    console = make_console(_WIDE)
    console.print(table)
    for line in _gain(plans) if powered else []:
        console.print(line, soft_wrap=True)
    hybrid = next((plan.choice for plan in plans if plan.choice.name == "hybrid"), None)
    if hybrid is not None:
        console.print(f"hybrid weighs distance {hybrid.distance:g} and angle {hybrid.angle:g}", soft_wrap=True)


def _gain(plans: Sequence[PlannedRoute]) -> list[str]:
    """What least energy gains against the shortest way, and how high it flies in which wind."""
    by_name = {plan.choice.name: plan for plan in plans}
    shortest, least = by_name["distance"].totals.energy, by_name["energy"].totals.energy
    if shortest is None or least is None:
        return []
    heights = [mean_height(by_name["energy"], sign) for sign in (-1, 1)]
    line = f"energy takes {watt_hours(shortest - least)} Wh less than distance"
    if None in heights:
        return [line]
    return [f"{line}; it flies {heights[0]:.0f} m above ground in head wind and {heights[1]:.0f} m in tail wind (mean)"]


def mean_height(plan: PlannedRoute, sign: int) -> float | None:
    """The mean height above ground [m], by length, of the legs with the wind from behind (1) or from ahead (-1)."""
    legs = [leg for leg in plan.legs if leg.wind_along * sign > 0 and leg.distance > 0]
    total = sum(leg.distance for leg in legs)
    return sum(leg.distance * (leg.clearance + leg.height) / 2 for leg in legs) / total if total else None
