"""A plan's figures as JSON, for scripts."""

from __future__ import annotations

import json
import math
from dataclasses import asdict
from typing import TYPE_CHECKING, Any

from gcs_windplan.planning.export import flown_duration

if TYPE_CHECKING:
    from gcs_windplan.planning.planner import PlannedRoute


def format_summary(plan: PlannedRoute) -> str:
    """The plan's figures as JSON."""
    return json.dumps(summary_of(plan), indent=1, ensure_ascii=False, allow_nan=False) + "\n"


def summary_of(plan: PlannedRoute) -> dict[str, Any]:
    """The plan's figures: SI units, angles in degrees from true north, wind towards where it blows.

    `search` holds counts only: the same plan gives the same figures, whatever the machine.
    """
    request = plan.request
    return {
        "name": request.name,
        "cost": str(plan.choice),
        "cost_value": plan.cost,
        "graph_cost_value": plan.graph_cost,
        "departure": request.departure.isoformat() if request.departure else None,
        "vehicle": asdict(request.vehicle),
        "wind": request.wind.name,
        "terrain": {"name": request.terrain.name, "vertical_datum": request.terrain.vertical_datum},
        "limits": {"clearance": request.clearance, "max_height": request.max_height, **asdict(request.limits)},
        "finish": request.finish,
        "totals": asdict(plan.totals),
        "ensemble": _ensemble(plan),
        "battery": _battery(plan),
        "ways_home": _ways_home(plan),
        "as_flown": _as_flown(plan),
        "waypoints": [_waypoint(asdict(waypoint)) for waypoint in plan.waypoints],
        "legs": [asdict(leg) for leg in plan.legs],
        "notes": list(plan.notes),
        "search": {
            "nodes": plan.effort.nodes,
            "expanded": plan.effort.expanded,
            "path_vertices": plan.effort.vertices,
        },
    }


def _ensemble(plan: PlannedRoute) -> dict[str, Any] | None:
    """How long the route takes over the members [s]; null where one cannot fly it. None where there is no ensemble."""
    if plan.spread is None:
        return None
    known = [seconds if math.isfinite(seconds) else None for seconds in plan.spread.seconds]
    quantiles = {f"{100 * q:g} %": plan.spread.at(q) for q in (0.1, 0.5, 0.9)}
    return {
        "robust": plan.request.robust,
        "member_seconds": known,
        "quantiles": {name: seconds if math.isfinite(seconds) else None for name, seconds in quantiles.items()},
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
    total = use.total if math.isfinite(use.total) else None
    return {"total": total, "usable": use.usable, "allowed_with_reserve": use.allowed, "left": list(use.left)}


def _ways_home(plan: PlannedRoute) -> dict[str, Any] | None:
    """What flying home, or to the nearest rally point, takes from each waypoint [J], null where there is no way; and
    where home comes out of reach with the reserve. None without an airframe."""
    ways = plan.ways_home
    if ways is None:
        return None
    home, rally = (
        [joules if math.isfinite(joules) else None for joules in one] for one in (ways.energies, ways.diversions)
    )
    lost = None if ways.no_return is None else asdict(ways.no_return)
    return {"home": home, "rally": rally if plan.request.rally else None, "point_of_no_return": lost}


def _waypoint(fields: dict[str, Any]) -> dict[str, Any]:
    """A waypoint with its place spread out."""
    point: dict[str, Any] = fields.pop("point")
    return point | fields
