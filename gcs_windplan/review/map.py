"""The route from above: over shaded relief, with the wind, as a PNG."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import matplotlib as mpl
import numpy as np
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.collections import LineCollection, PolyCollection
from matplotlib.colors import LightSource
from matplotlib.figure import Figure
from matplotlib.patches import Polygon
from matplotlib.patheffects import Normal, Stroke

from gcs_windplan.arrays import FloatArray
from gcs_windplan.flight import clock
from gcs_windplan.planner import Plan
from gcs_windplan.review.png import png_bytes
from gcs_windplan.siting import choose_area
from gcs_windplan.terrain import Extent
from gcs_windplan.veil import Prism

_PIXELS = 500  # of relief along the longer side
_HEAD, _FOOT = 0.85, 1.05  # [inch] above and below the map
_SIDE = 7.4  # [inch] the longer side of the map itself
_ARROWS = 18  # along the longer side
_LABEL_ROOM = 0.025  # of the route's extent, between two numbers
_ROUTES = (
    "#0072b2",
    "#d55e00",
    "#cc79a7",
    "#111111",
)  # Okabe and Ito 2008: told apart by colour-blind readers
_DASHES = ("-", (0, (5, 1.5)), (0, (1.5, 1.2)), (0, (6, 1.5, 1.5, 1.5)))


def draw_map(plans: Sequence[Plan], dpi: int = 120) -> bytes:
    """One or several routes of one request on a map, as PNG.

    A single route is coloured by its ground speed; several are told apart by colour and dash.
    """
    plan = plans[0]
    extent = _frame_of(plans)
    figure, axes, beside = _sheet(extent)
    _draw_relief(axes, plan, extent)
    _draw_areas(axes, plan)
    _draw_wind(axes, plan, extent)
    if len(plans) == 1:
        lines = _draw_by_speed(axes, plan)
        figure.colorbar(lines, cax=beside, label="ground speed [m/s]")
    else:
        beside.remove()
        _draw_side_by_side(axes, plans)
    _draw_sites(axes, plan)
    _dress(axes, plans, extent)
    return png_bytes(figure, dpi)


def _sheet(extent: Extent) -> tuple[Figure, Any, Any]:
    """A figure with axes of the extent's shape, and axes for a colour bar. A layout engine would take 0.3 s more."""
    depth = (extent.north - extent.south) / (extent.east - extent.west)
    width = _SIDE / max(1.0, depth)
    height = width * depth
    whole = np.array([max(width, 6.0) + 1.9, height + _HEAD + _FOOT])
    figure = Figure(figsize=(whole[0], whole[1]))
    FigureCanvasAgg(figure)
    axes = figure.add_axes((0.8 / whole[0], _FOOT / whole[1], width / whole[0], height / whole[1]))
    beside = figure.add_axes(
        ((0.8 + width + 0.15) / whole[0], (_FOOT + 0.12 * height) / whole[1], 0.2 / whole[0], 0.76 * height / whole[1])
    )
    return figure, axes, beside


def _frame_of(plans: Sequence[Plan]) -> Extent:
    """A box [m] around all routes with a tenth of air, its sides not too different."""
    points = np.concatenate([_line(plan) for plan in plans])
    low, high = points.min(axis=0), points.max(axis=0)
    centre, size = (low + high) / 2, high - low
    size = np.maximum(size * 1.2, 0.72 * size.max())
    (west, south), (east, north) = centre - size / 2, centre + size / 2
    edge = plans[0].request.terrain.extent
    return Extent(max(west, edge.west), max(south, edge.south), min(east, edge.east), min(north, edge.north))


def _line(plan: Plan) -> FloatArray:
    """The route in plan, (n, 2) [m]."""
    return np.array([(w.east, w.north) for w in plan.waypoints])


def _grid(extent: Extent, along: int) -> tuple[FloatArray, FloatArray]:
    """Places on a regular grid of about `along` along the longer side, as two 2-D arrays."""
    width, depth = extent.east - extent.west, extent.north - extent.south
    cell = max(width, depth) / along
    east = np.linspace(extent.west, extent.east, max(2, round(width / cell)))
    north = np.linspace(extent.south, extent.north, max(2, round(depth / cell)))
    x, y = np.meshgrid(east, north)
    return x, y


def _draw_relief(axes: Any, plan: Plan, extent: Extent) -> None:
    """Shaded relief, light from the north-west, tinted by height; unknown ground stays blank."""
    x, y = _grid(extent, _PIXELS)
    ground = plan.request.terrain.heights_at(np.column_stack([x.ravel(), y.ravel()])).reshape(x.shape)
    cell = x[0, 1] - x[0, 0]
    known = np.isfinite(ground)
    filled = np.where(known, ground, np.nanmean(ground) if known.any() else 0.0)
    relief = float(np.ptp(filled))
    exaggeration = 1.0 if relief == 0 else min(8.0, max(1.0, 0.12 * max(np.ptp(x), np.ptp(y)) / relief))
    light = LightSource(azdeg=315, altdeg=45)
    shade = light.hillshade(filled, vert_exag=exaggeration, dx=cell, dy=-cell)
    tint = mpl.colormaps["gist_earth"](0.35 + 0.55 * (filled - filled.min()) / max(relief, 1e-9))[..., :3]
    colours = 0.45 + 0.55 * tint
    colours = colours * (0.55 + 0.45 * shade[..., None])
    image = np.dstack([np.clip(colours, 0, 1), known.astype(float)])
    axes.imshow(
        image,
        origin="lower",
        extent=[v / 1000 for v in (extent.west, extent.east, extent.south, extent.north)],
        interpolation="bilinear",
        aspect="equal",
    )


def _draw_areas(axes: Any, plan: Plan) -> None:
    """Keep-out areas hatched, keep-in areas outlined, obstacles filled."""
    for prism in plan.request.airspace.keep_out:
        patch = Polygon(prism.corners / 1000, closed=True, fc=(0.8, 0.2, 0, 0.18), ec="#b22200", hatch="///", lw=1.2)
        axes.add_patch(patch)
        _name_area(axes, prism)
    if plan.request.obstacles is not None:
        seen_from_above = plan.request.obstacles.triangles[:, :, :2] / 1000
        axes.add_collection(PolyCollection(list(seen_from_above), facecolors="#5b3a5e", edgecolors="#2d1d2f", lw=0.4))
    for prism in plan.request.airspace.keep_in:
        patch = Polygon(prism.corners / 1000, closed=True, fill=False, ec="#005a32", lw=1.6, ls="--")
        axes.add_patch(patch)


def _name_area(axes: Any, prism: Prism) -> None:
    """A keep-out's name and heights in its middle, as far as that lies on the map."""
    heights = [f"from {prism.floor:.0f} m"] if np.isfinite(prism.floor) else []
    heights += [f"up to {prism.ceiling:.0f} m"] if np.isfinite(prism.ceiling) else []
    x, y = (prism.corners.min(axis=0) + prism.corners.max(axis=0)) / 2000
    axes.text(
        x, y, "\n".join([prism.name, " ".join([*heights, "AMSL"])] if heights else [prism.name]), fontsize=8.5,
        ha="center", va="center", color="#7a1200", zorder=7, clip_on=True,
        path_effects=[Stroke(linewidth=2.4, foreground="white"), Normal()],
    )  # fmt: skip


def _draw_wind(axes: Any, plan: Plan, extent: Extent) -> None:
    """Arrows towards where the wind blows, at the route's mean height above ground."""
    sites = np.array([(site.east, site.north) for site in plan.request.sites])
    planned = choose_area(plan.request, sites)  # the wind need not be known beyond it
    inset = 0.5 / _ARROWS * max(extent.east - extent.west, extent.north - extent.south)
    inner = Extent(
        max(extent.west + inset, planned.west),
        max(extent.south + inset, planned.south),
        min(extent.east - inset, planned.east),
        min(extent.north - inset, planned.north),
    )
    x, y = _grid(inner, _ARROWS)
    places = np.column_stack([x.ravel(), y.ravel()])
    ground = plan.request.terrain.heights_at(places)
    above = float(np.mean([w.above_ground for w in plan.waypoints]))
    points = np.column_stack([places, ground + above])[np.isfinite(ground)]
    wind = plan.request.wind.at(points)
    points, wind = points[np.isfinite(wind[:, 0])], wind[np.isfinite(wind[:, 0])]
    speed = np.hypot(wind[:, 0], wind[:, 1])
    strongest = float(speed.max(initial=0.0))
    if strongest == 0:
        return
    arrows = axes.quiver(
        points[:, 0] / 1000, points[:, 1] / 1000, wind[:, 0], wind[:, 1],
        color="#1b2a41", alpha=0.75, pivot="mid", scale=strongest * _ARROWS * 1.25, width=0.0022, zorder=3,
    )  # fmt: skip
    nice = float(f"{strongest:.1g}")
    label = f"{nice:g} m/s wind, {above:.0f} m above ground"
    if len(plan.request.wind.times) > 1:
        label += ", at the departure"
    if plan.request.members:
        label += ", mean of all members"
    depth = (extent.north - extent.south) / (extent.east - extent.west)
    above_axes = 1 + 0.18 / (_SIDE * min(depth, 1.0))
    axes.quiverkey(arrows, 0.05, above_axes, nice, label, labelpos="E", coordinates="axes", fontproperties={"size": 9})


def _draw_by_speed(axes: Any, plan: Plan) -> LineCollection:
    """The route coloured by each leg's ground speed, with its waypoints."""
    line = _line(plan) / 1000
    segments = np.stack([line[:-1], line[1:]], axis=1)
    axes.plot(line[:, 0], line[:, 1], color="black", lw=5.5, solid_capstyle="round", zorder=4)
    lines = LineCollection(list(segments), cmap="plasma", lw=3.4, capstyle="round", zorder=5)
    lines.set_array(np.array([leg.ground_speed for leg in plan.legs]))
    axes.add_collection(lines)
    axes.plot(line[:, 0], line[:, 1], "o", ms=4.5, mfc="white", mec="black", mew=0.9, zorder=6)
    _number_waypoints(axes, plan)
    return lines


def _number_waypoints(axes: Any, plan: Plan) -> None:
    """Numbers at the waypoints, as far as they do not lie on each other or on a site's name."""
    line = _line(plan) / 1000
    apart = _LABEL_ROOM * float(np.ptp(line, axis=0).max())
    taken = [np.array([site.east, site.north]) / 1000 for site in plan.request.sites]
    for waypoint, place in zip(plan.waypoints, line, strict=True):
        if min(np.linalg.norm(place - other) for other in taken) >= apart:
            _label(axes, place[0], place[1], str(waypoint.number), size=7.5, offset=(5, 5))
            taken.append(place)


def _draw_side_by_side(axes: Any, plans: Sequence[Plan]) -> None:
    """Several routes, told apart by colour and dash."""
    for i, plan in enumerate(plans):
        line = _line(plan) / 1000
        axes.plot(
            line[:, 0], line[:, 1], color=_ROUTES[i % 4], ls=_DASHES[i % 4], lw=2.4, zorder=5 + i,
            label=f"{plan.choice}: {clock(plan.totals.seconds)} min",
            path_effects=[Stroke(linewidth=4.4, foreground="white"), Normal()],
        )  # fmt: skip
    axes.legend(loc="upper left", bbox_to_anchor=(0.0, _below(axes)), ncols=2, frameon=False, fontsize=9)


def _below(axes: Any) -> float:
    """Where a legend below the axis label begins, as a share of the axes' height."""
    return -0.48 * float(axes.figure.dpi) / float(axes.bbox.height)


def _draw_sites(axes: Any, plan: Plan) -> None:
    """Start, vias and goal, named."""
    for site in plan.request.sites:
        x, y = site.east / 1000, site.north / 1000
        marker = {"start": "^", "goal": "s"}.get(site.field, "D")
        axes.plot(x, y, marker, ms=9, mfc="#f0e442", mec="black", mew=1.2, zorder=12)
        _label(axes, x, y, site.field.replace("via.", "via "), size=10, offset=(8, -12))


def _label(axes: Any, x: float, y: float, text: str, size: float, offset: tuple[int, int]) -> None:
    """A word on the map with a white halo."""
    axes.annotate(
        text, (x, y), xytext=offset, textcoords="offset points", fontsize=size, zorder=13,
        path_effects=[Stroke(linewidth=2.4, foreground="white"), Normal()],
    )  # fmt: skip


def _dress(axes: Any, plans: Sequence[Plan], extent: Extent) -> None:
    """Axes, title and limits."""
    plan = plans[0]
    axes.set_facecolor("#d9d9d9")  # where the ground is not known
    axes.set_xlim(extent.west / 1000, extent.east / 1000)
    axes.set_ylim(extent.south / 1000, extent.north / 1000)
    axes.set_xlabel("east of the frame's origin [km]")
    axes.set_ylabel("north [km]")
    totals = plan.totals
    what = f"least {plan.choice}, {totals.length / 1000:.2f} km in {clock(totals.seconds)} min"
    head = what if len(plans) == 1 else "routes of least " + ", ".join(p.choice.name for p in plans)
    axes.set_title(f"{plan.request.name}: {head}", fontsize=12, loc="left", pad=24)
