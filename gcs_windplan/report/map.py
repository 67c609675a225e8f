"""The route from above: over shaded relief, with the wind, as a PNG."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from matplotlib.collections import PolyCollection

from gcs_windplan.arrays import FloatArray
from gcs_windplan.flight import clock
from gcs_windplan.planning.planner import PlannedRoute
from gcs_windplan.planning.sites import choose_area
from gcs_windplan.png import png_bytes
from gcs_windplan.report import sheet
from gcs_windplan.report.relief import Ground
from gcs_windplan.terrain import Extent

_PIXELS = 500  # of relief along the longer side


def draw_map(plans: Sequence[PlannedRoute], dpi: int = 120) -> bytes:
    """One or several routes of one request on a map, as PNG.

    A single route is coloured by its ground speed; several are told apart by colour and dash.
    """
    plan = plans[0]
    lines = [_line(one) for one in plans]
    extent = sheet.frame_of(lines, plan.request.terrain.extent)
    figure, axes, beside = sheet.sheet(extent)
    sheet.draw_relief(axes, _ground(plan, extent).resampled(_PIXELS, smooth=True))
    _draw_areas(axes, plan)
    _draw_wind(axes, plan, extent)
    if len(plans) == 1:
        route = sheet.draw_by_speed(axes, lines[0], np.array([leg.ground_speed for leg in plan.legs]))
        sites = [np.array([site.east, site.north]) for site in plan.request.sites]
        sheet.draw_stops(axes, lines[0], [str(waypoint.number) for waypoint in plan.waypoints], sites)
        figure.colorbar(route, cax=beside, label="ground speed [m/s]")
    else:
        beside.remove()
        sheet.draw_side_by_side(axes, lines, [f"{one.choice}: {clock(one.totals.seconds)} min" for one in plans])
    _draw_sites(axes, plan)
    sheet.dress(axes, extent, _title(plans))
    return png_bytes(figure, dpi)


def _line(plan: PlannedRoute) -> FloatArray:
    """The route in plan, (n, 2) [m]."""
    return np.array([(w.east, w.north) for w in plan.waypoints])


def _ground(plan: PlannedRoute, extent: Extent) -> Ground:
    """The terrain in an extent."""
    x, y = sheet.grid(extent, _PIXELS)
    heights = plan.request.terrain.heights_at(np.column_stack([x.ravel(), y.ravel()])).reshape(x.shape)
    return Ground(extent.west, extent.south, extent.east, extent.north, heights)


def _draw_areas(axes: Any, plan: PlannedRoute) -> None:
    """Keep-out areas hatched, keep-in areas outlined, obstacles filled."""
    for prism in plan.request.airspace.keep_out:
        sheet.draw_keep_out(axes, prism.corners, prism.name, prism.floor, prism.ceiling)
    if plan.request.obstacles is not None:
        seen_from_above = plan.request.obstacles.triangles[:, :, :2] / 1000
        axes.add_collection(PolyCollection(list(seen_from_above), facecolors="#5b3a5e", edgecolors="#2d1d2f", lw=0.4))
    for prism in plan.request.airspace.keep_in:
        sheet.draw_keep_in(axes, prism.corners)


def _draw_wind(axes: Any, plan: PlannedRoute, extent: Extent) -> None:
    """Arrows towards where the wind blows, at the route's mean height above ground."""
    sites = np.array([(site.east, site.north) for site in plan.request.sites])
    planned = choose_area(plan.request, sites)  # the wind need not be known beyond it
    inset = 0.5 / sheet.ARROWS * max(extent.east - extent.west, extent.north - extent.south)
    inner = Extent(
        max(extent.west + inset, planned.west),
        max(extent.south + inset, planned.south),
        min(extent.east - inset, planned.east),
        min(extent.north - inset, planned.north),
    )
    x, y = sheet.grid(inner, sheet.ARROWS)
    places = np.column_stack([x.ravel(), y.ravel()])
    ground = plan.request.terrain.heights_at(places)
    above = float(np.mean([w.above_ground for w in plan.waypoints]))
    points = np.column_stack([places, ground + above])[np.isfinite(ground)]
    wind = plan.request.wind.at(points)
    points, wind = points[np.isfinite(wind[:, 0])], wind[np.isfinite(wind[:, 0])]
    where = f"{above:.0f} m above ground"
    if len(plan.request.wind.times) > 1:
        where += ", at the departure"
    if plan.request.members:
        where += ", mean of all members"
    sheet.draw_wind(axes, extent, points, wind, where)


def _draw_sites(axes: Any, plan: PlannedRoute) -> None:
    """Start, vias and goal, named."""
    for site in plan.request.sites:
        x, y = site.east / 1000, site.north / 1000
        marker = {"start": "^", "goal": "s"}.get(site.field, "D")
        axes.plot(x, y, marker, ms=9, mfc="#f0e442", mec="black", mew=1.2, zorder=12)
        sheet.label(axes, x, y, site.field.replace("via.", "via "), size=10, offset=(8, -12))


def _title(plans: Sequence[PlannedRoute]) -> str:
    plan = plans[0]
    what = f"least {plan.choice}, {plan.totals.length / 1000:.2f} km in {clock(plan.totals.seconds)} min"
    head = what if len(plans) == 1 else "routes of least " + ", ".join(p.choice.name for p in plans)
    return f"{plan.request.name}: {head}"
