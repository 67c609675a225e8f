"""A plan's figures as JSON, for scripts."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from gcs_windplan.json_text import json_text, json_value
from gcs_windplan.planning.export import flown_duration

if TYPE_CHECKING:
    from gcs_windplan.flight.flight import Waypoint
    from gcs_windplan.planning.planner import PlannedRoute


def format_summary(plan: PlannedRoute) -> str:
    """The plan's figures as JSON."""
    return json_text(summary_of(plan)) + "\n"


def summary_of(plan: PlannedRoute) -> dict[str, Any]:
    """The plan's figures: SI units, angles in degrees from true north, wind towards where it blows.

    None for what is not known, or infinite: the time of a member that cannot fly it, the energy of a way that is none.
    `search` holds counts only: the same plan gives the same figures, whatever the machine.
    """
    request = plan.request
    figures = {
        "name": request.name,
        "cost": str(plan.choice),
        "cost_value": plan.cost,
        "graph_cost_value": plan.graph_cost,
        "departure": request.scene.departure,
        "vehicle": request.vehicle,
        "wind": request.scene.wind.name,
        "terrain": {"name": request.scene.terrain.name, "vertical_datum": request.scene.terrain.vertical_datum},
        "limits": {"clearance": request.clearance, "max_height": request.max_height, **json_value(request.limits)},
        "finish": request.finish,
        "totals": plan.totals,
        "ensemble": _ensemble(plan),
        "battery": _battery(plan),
        "ways_home": _ways_home(plan),
        "as_flown": _as_flown(plan),
        "waypoints": [_waypoint(waypoint) for waypoint in plan.waypoints],
        "legs": plan.legs,
        "notes": plan.notes,
        "search": {
            "nodes": plan.effort.nodes,
            "expanded": plan.effort.expanded,
            "path_vertices": plan.effort.vertices,
        },
    }
    value: dict[str, Any] = json_value(figures)
    return value


def _ensemble(plan: PlannedRoute) -> dict[str, Any] | None:
    """How long the route takes over the members [s]; None where there is no ensemble."""
    if plan.spread is None:
        return None
    return {
        "robust": plan.request.robust,
        "member_seconds": plan.spread.seconds,
        "quantiles": {f"{100 * q:g} %": plan.spread.at(q) for q in (0.1, 0.5, 0.9)},
    }


def _as_flown(plan: PlannedRoute) -> dict[str, Any] | None:
    """How long the autopilot takes en route and in all [s], corners and acceleration counted; None for a fixed-wing."""
    flown = flown_duration(plan)
    return None if flown is None else {"en_route_seconds": flown.en_route, "total_seconds": flown.total}


def _battery(plan: PlannedRoute) -> dict[str, Any] | None:
    """What the flight takes from the battery [J], and the share left at each waypoint; None without an airframe."""
    use = plan.battery
    if use is None:
        return None
    return {"total": use.total, "usable": use.usable, "allowed_with_reserve": use.allowed, "left": use.left}


def _ways_home(plan: PlannedRoute) -> dict[str, Any] | None:
    """What flying home, or to the nearest rally point, takes from each waypoint [J]; and where home comes out of reach
    with the reserve. None without an airframe."""
    ways = plan.ways_home
    if ways is None:
        return None
    return {
        "home": ways.energies,
        "rally": ways.alternates if plan.request.rally else None,
        "point_of_no_return": ways.point_of_no_return,
    }


def _waypoint(waypoint: Waypoint) -> dict[str, Any]:
    """A waypoint with its place spread out."""
    row = json_value(waypoint)
    return {**row.pop("point"), **row}
