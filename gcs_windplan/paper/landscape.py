"""Figure 3: the terrain as a triangulated surface, with the veil's nodes above it, as PNG."""

from __future__ import annotations

from typing import Any, Final

import matplotlib as mpl
import numpy as np
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.colors import LightSource
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from mpl_toolkits.mplot3d.art3d import Poly3DCollection  # type: ignore[import-untyped]

from gcs_windplan.arrays import FloatArray
from gcs_windplan.paper.cases import AREA, CASES, CELL, HILLS, PaperCase, make_rules
from gcs_windplan.paper.flying import sites_of
from gcs_windplan.paper.graphs import lay_roadmap, lay_uniform
from gcs_windplan.report.png import png_bytes
from gcs_windplan.terrain import Dem

_NODES: Final = {"uniform": ("#0051a2", "o"), "PRM": ("#a3195b", "D")}
_START, _GOAL = "#f0e442", "#d55e00"  # Okabe and Ito 2008: told apart by colour-blind readers
_FACET: Final = 2 * CELL  # of the drawn surface


def draw_landscape(terrain: Dem, dpi: int = 150) -> bytes:
    """The uniform nodes on the left, the random ones on the right, start and goal of case 1 in both."""
    rules, case = make_rules(terrain), CASES[0]
    sites = sites_of(rules, [case])
    figure = Figure(figsize=(13.0, 5.6))
    FigureCanvasAgg(figure)
    for i, (name, veil) in enumerate((("uniform", lay_uniform(rules, sites)), ("PRM", lay_roadmap(rules, sites)))):
        axes: Any = figure.add_axes((0.5 * i, 0.05, 0.49, 0.97), projection="3d", computed_zorder=False)
        _draw_ground(axes, terrain)
        colour, marker = _NODES[name]
        nodes = veil.points[len(sites) :]
        axes.scatter(*nodes.T, s=9, c=colour, marker=marker, lw=0, depthshade=False, zorder=3)
        _draw_sites(axes, terrain, case)
        _style_axes(axes, f"({'ab'[i]}) {name} graph, {veil.size} nodes")
    figure.legend(handles=_legend(), loc="lower center", ncols=4, frameon=False, fontsize=10.5)
    return png_bytes(figure, dpi)


def _draw_ground(axes: Any, terrain: Dem) -> None:
    """The surface in triangles, tinted by height and lit from the north-west."""
    heights, east, north = terrain.raster(AREA, _FACET)
    x, y = np.meshgrid(east, north)
    shade = LightSource(azdeg=315, altdeg=50).hillshade(heights, vert_exag=1.0, dx=_FACET, dy=-_FACET)
    tint = mpl.colormaps["gist_earth"](0.38 + 0.5 * heights / heights.max())[..., :3]
    colours = (0.35 + 0.65 * tint) * (0.6 + 0.4 * shade[..., None])
    triangles = _triangles(x, y, heights)
    lit = _triangles(colours[..., 0], colours[..., 1], colours[..., 2]).mean(axis=1)
    surface = Poly3DCollection(list(triangles), facecolors=np.clip(lit, 0, 1), edgecolors=(0, 0, 0, 0.10), lw=0.3)
    surface.set_zorder(1)
    axes.add_collection3d(surface)


def _triangles(x: FloatArray, y: FloatArray, z: FloatArray) -> FloatArray:
    """The two triangles of each cell of a grid, (m, 3, 3)."""
    points = np.stack([x, y, z], axis=-1)
    a, b, c, d = points[:-1, :-1], points[:-1, 1:], points[1:, :-1], points[1:, 1:]
    both = np.stack([np.stack([a, b, d], axis=-2), np.stack([a, d, c], axis=-2)])
    return both.reshape(-1, 3, 3)


def _draw_sites(axes: Any, terrain: Dem, case: PaperCase) -> None:
    """Start and goal as pins with their names."""
    for place, word, colour in ((case.start, "start", _START), (case.goal, "goal", _GOAL)):
        ground = float(terrain.heights_at(np.array([place]))[0])
        axes.plot([place[0]] * 2, [place[1]] * 2, [ground, ground + 0.38], color="black", lw=1.4, zorder=5)
        axes.scatter(*place, ground + 0.38, s=110, c=colour, edgecolors="black", lw=1.2, depthshade=False, zorder=6)
        axes.text(*place, ground + 0.50, word, fontsize=11, fontweight="bold", ha="center", zorder=7)


def _style_axes(axes: Any, title: str) -> None:
    """View, proportions and labels."""
    top = max(hill.height for hill in HILLS) + 0.25
    axes.set(xlim=(-2, 2), ylim=(-2, 2), zlim=(0, top))
    axes.set_box_aspect((4, 4, 2.0 * top), zoom=1.02)
    axes.view_init(elev=36, azim=-60)
    axes.set_xlabel("x [mr]", labelpad=4)
    axes.set_ylabel("y [mr]", labelpad=4)
    axes.set_zlabel("z [mr]", labelpad=-2)
    for axis in (axes.xaxis, axes.yaxis):
        axis.set_ticks(range(-2, 3))
    axes.zaxis.set_ticks([0.0, 0.3, 0.6])
    for axis in (axes.xaxis, axes.yaxis, axes.zaxis):
        axis.pane.set_facecolor((0.97, 0.97, 0.97, 1.0))
        axis._axinfo["grid"].update(color=(0.85, 0.85, 0.85, 1.0), linewidth=0.6)
    axes.set_title(title, fontsize=13, y=0.94)


def _legend() -> list[Line2D]:
    """What the marks mean."""
    words = {"uniform": "node of the uniform graph", "PRM": "node of the PRM graph"}
    marks = [
        Line2D([], [], ls="", marker=_NODES[name][1], color=_NODES[name][0], ms=5, label=word)
        for name, word in words.items()
    ]
    sites = [
        Line2D([], [], ls="", marker="o", mfc=colour, mec="black", ms=9, label=word)
        for word, colour in (("start", _START), ("goal", _GOAL))
    ]
    return [*marks, *sites]
