"""A map's sheet: relief, areas, wind arrows, routes and labels, in kilometres of the local frame."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.collections import LineCollection
from matplotlib.figure import Figure
from matplotlib.patches import Polygon
from matplotlib.patheffects import Normal, Stroke

from gcs_windplan.arrays import FloatArray
from gcs_windplan.report.relief import Ground, shade
from gcs_windplan.terrain import Extent

ARROWS = 18  # along the longer side
_HEAD, _FOOT = 0.85, 1.05  # [inch] above and below the map
_SIDE = 7.4  # [inch] the longer side of the map itself
_LABEL_ROOM = 0.025  # of the route's extent, between two numbers
_ROUTES = (
    "#0072b2",
    "#d55e00",
    "#cc79a7",
    "#111111",
)  # Okabe and Ito 2008: told apart by colour-blind readers
_DASHES = ("-", (0, (5, 1.5)), (0, (1.5, 1.2)), (0, (6, 1.5, 1.5, 1.5)))


def sheet(extent: Extent) -> tuple[Figure, Any, Any]:
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


def frame_of(lines: Sequence[FloatArray], edge: Extent) -> Extent:
    """A box [m] around all routes (n, 2) with a tenth of air, its sides not too different, within an edge."""
    points = np.concatenate(lines)
    low, high = points.min(axis=0), points.max(axis=0)
    centre, size = (low + high) / 2, high - low
    size = np.maximum(size * 1.2, 0.72 * size.max())
    (west, south), (east, north) = centre - size / 2, centre + size / 2
    return Extent(max(west, edge.west), max(south, edge.south), min(east, edge.east), min(north, edge.north))


def grid(extent: Extent, along: int) -> tuple[FloatArray, FloatArray]:
    """Places on a regular grid of about `along` along the longer side, as two 2-D arrays."""
    width, depth = extent.east - extent.west, extent.north - extent.south
    cell = max(width, depth) / along
    east = np.linspace(extent.west, extent.east, max(2, round(width / cell)))
    north = np.linspace(extent.south, extent.north, max(2, round(depth / cell)))
    x, y = np.meshgrid(east, north)
    return x, y


def draw_relief(axes: Any, ground: Ground) -> None:
    """Shaded relief with contour lines; unknown ground stays blank."""
    axes.imshow(
        shade(ground),
        origin="lower",
        extent=[v / 1000 for v in (ground.west, ground.east, ground.south, ground.north)],
        interpolation="bilinear",
        aspect="equal",
    )


def draw_keep_out(axes: Any, corners: FloatArray, name: str, floor: float, ceiling: float) -> None:
    """A hatched area with its name and heights in its middle, as far as that lies on the map."""
    patch = Polygon(corners / 1000, closed=True, fc=(0.8, 0.2, 0, 0.18), ec="#b22200", hatch="///", lw=1.2)
    axes.add_patch(patch)
    heights = [f"from {floor:.0f} m"] if np.isfinite(floor) else []
    heights += [f"up to {ceiling:.0f} m"] if np.isfinite(ceiling) else []
    x, y = (corners.min(axis=0) + corners.max(axis=0)) / 2000
    axes.text(
        x, y, "\n".join([name, " ".join([*heights, "AMSL"])] if heights else [name]), fontsize=8.5,
        ha="center", va="center", color="#7a1200", zorder=7, clip_on=True,
        path_effects=[Stroke(linewidth=2.4, foreground="white"), Normal()],
    )  # fmt: skip


def draw_keep_in(axes: Any, corners: FloatArray) -> None:
    """An outline."""
    axes.add_patch(Polygon(corners / 1000, closed=True, fill=False, ec="#005a32", lw=1.6, ls="--"))


def draw_wind(axes: Any, extent: Extent, places: FloatArray, winds: FloatArray, where: str) -> None:
    """Arrows (n, 2) towards where the wind blows, and one to compare with."""
    strongest = float(np.hypot(winds[:, 0], winds[:, 1]).max(initial=0.0))
    if strongest == 0:
        return
    arrows = axes.quiver(
        places[:, 0] / 1000, places[:, 1] / 1000, winds[:, 0], winds[:, 1],
        color="#1b2a41", alpha=0.75, pivot="mid", scale=strongest * ARROWS * 1.25, width=0.0022, zorder=3,
    )  # fmt: skip
    nice = float(f"{strongest:.1g}")
    depth = (extent.north - extent.south) / (extent.east - extent.west)
    above_axes = 1 + 0.18 / (_SIDE * min(depth, 1.0))
    axes.quiverkey(
        arrows, 0.05, above_axes, nice, f"{nice:g} m/s wind, {where}", labelpos="E", coordinates="axes",
        fontproperties={"size": 9},
    )  # fmt: skip


def draw_by_speed(axes: Any, line: FloatArray, speeds: FloatArray) -> LineCollection:
    """A route (n, 2) [m] coloured by the ground speeds (n - 1,) between its places."""
    km = line / 1000
    axes.plot(km[:, 0], km[:, 1], color="black", lw=5.5, solid_capstyle="round", zorder=4)
    lines = LineCollection(list(np.stack([km[:-1], km[1:]], axis=1)), cmap="plasma", lw=3.4, capstyle="round", zorder=5)
    lines.set_array(speeds)
    axes.add_collection(lines)
    return lines


def draw_stops(axes: Any, line: FloatArray, names: Sequence[str], taken: Sequence[FloatArray] = ()) -> None:
    """Circles at places (n, 2) [m], with names as far as they do not lie on each other or on a place that is taken."""
    draw_circles(axes, line)
    apart = _LABEL_ROOM * float(np.ptp(line, axis=0).max())
    named = list(taken)
    for name, place in zip(names, line, strict=True):
        if all(np.linalg.norm(place - other) >= apart for other in named):
            label(axes, place[0] / 1000, place[1] / 1000, name, size=7.5, offset=(5, 5))
            named.append(place)


def draw_circles(axes: Any, line: FloatArray) -> None:
    """Circles at places (n, 2) [m]."""
    axes.plot(line[:, 0] / 1000, line[:, 1] / 1000, "o", ms=4.5, mfc="white", mec="black", mew=0.9, zorder=6)


def draw_side_by_side(axes: Any, lines: Sequence[FloatArray], names: Sequence[str]) -> None:
    """Several routes (n, 2) [m], told apart by colour and dash."""
    for i, (line, name) in enumerate(zip(lines, names, strict=True)):
        km, width = line / 1000, 2.2 + 1.6 * (len(lines) - 1 - i)  # where they coincide each shows beside the next
        axes.plot(km[:, 0], km[:, 1], color="white", lw=width + 2, zorder=4)
        axes.plot(
            km[:, 0], km[:, 1], color=_ROUTES[i % 4], ls=_DASHES[i % 4], lw=width, zorder=5 + i, label=name,
            dash_capstyle="butt", path_effects=[Stroke(linewidth=width + 1.2, foreground="white"), Normal()],
        )  # fmt: skip
    below = -0.48 * float(axes.figure.dpi) / float(axes.bbox.height)
    axes.legend(loc="upper left", bbox_to_anchor=(0.0, below), ncols=2, frameon=False, fontsize=9)


def label(
    axes: Any, x: float, y: float, text: str, size: float, offset: tuple[float, float], centred: bool = False
) -> None:
    """A word on the map with a white halo; the offset [point] is to its lower left corner or its centre."""
    aligned = {"ha": "center", "va": "center"} if centred else {}
    axes.annotate(
        text, (x, y), xytext=offset, textcoords="offset points", fontsize=size, zorder=13,
        path_effects=[Stroke(linewidth=2.4, foreground="white"), Normal()], **aligned,
    )  # fmt: skip


def dress(axes: Any, extent: Extent, title: str) -> None:
    """Axes, title and limits."""
    axes.set_facecolor("#d9d9d9")  # where the ground is not known
    axes.set_xlim(extent.west / 1000, extent.east / 1000)
    axes.set_ylim(extent.south / 1000, extent.north / 1000)
    axes.set_xlabel("east of the frame's origin [km]")
    axes.set_ylabel("north [km]")
    axes.set_title(title, fontsize=12, loc="left", pad=24)
