"""Figures 6 and 7: routes from above over the terrain, with the wind, as PNG."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Final

import matplotlib as mpl
import numpy as np
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.colors import LightSource
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patheffects import Normal, Stroke

from gcs_windplan.arrays import FloatArray
from gcs_windplan.paper.cases import AREA, CASES, VEIL_HEIGHT, Case
from gcs_windplan.paper.comparison import Setup, key_of
from gcs_windplan.paper.flying import SHAPED, Route
from gcs_windplan.paper.published import ANGLE, DISTANCE
from gcs_windplan.planning.cost import CostChoice
from gcs_windplan.png import png_bytes
from gcs_windplan.terrain import Dem
from gcs_windplan.wind.field import WindField

_RAISED: Final = 0.02  # of the raster under a map
_ARROWS: Final = 15
_INK: Final = "#1b2a41"  # of the wind
_RIM: Final = 0.09  # around the area, so that routes on its border are seen
_CONTOURS: Final = np.arange(0.1, 0.8, 0.1)


@dataclass(frozen=True, slots=True)
class Style:
    """How a route is drawn: its name in the routes, in the legend, its colour, dashes and width."""

    route: str
    label: str
    colour: str
    dashes: Any
    width: float


# the paper's red and green, in the shades of Okabe and Ito 2008, which colour-blind readers tell apart; and dashes
_RED = Style(str(DISTANCE), "least distance", "#d55e00", "-", 3.0)
_GREEN = Style(str(ANGLE), "least angle", "#00805c", (0, (4.5, 1.6)), 3.0)
_BLUE = Style(SHAPED, "least time (shaped)", "#0a3fb5", (0, (1.1, 1.1)), 2.8)
_MOSTLY_ANGLE = Style(str(CostChoice("hybrid", 0.1, 0.9)), "hybrid", "#7b2d8e", "-", 3.2)
_MOSTLY_DISTANCE = Style(str(CostChoice("hybrid", 0.9, 0.1)), "hybrid", "#7b2d8e", "-", 3.2)
_THIN = Style(str(DISTANCE), "least distance", "#d55e00", (0, (3, 1.5)), 1.8)
_THIN_GREEN = Style(str(ANGLE), "least angle", "#00805c", (0, (1.2, 1.2)), 1.8)


def draw_cases(terrain: Dem, main: Setup, dpi: int = 150) -> bytes:
    """Figure 6: least distance, least angle and least time in the three cases."""
    figure, panels = _sheet(3)
    styles = (_RED, _GREEN, _BLUE)
    for letter, axes, case in zip("abc", panels, CASES, strict=True):
        _draw_panel(axes, terrain, case, main.routes[key_of(case)], styles)
        axes.set_title(f"({letter}) {case.title}", fontsize=13, pad=8)
    _draw_legend(figure, styles, still=True)
    return png_bytes(figure, dpi)


def draw_hybrid(terrain: Dem, main: Setup, dpi: int = 150) -> bytes:
    """Figure 7: the hybrid cost of case 2 with either weight the larger one."""
    figure, panels = _sheet(2)
    case = next(case for case in CASES if case.number == "2")
    choices = (
        ("(a) w₁ > w₂: angle 0.9, distance 0.1", _MOSTLY_ANGLE),
        ("(b) w₂ > w₁: angle 0.1, distance 0.9", _MOSTLY_DISTANCE),
    )
    for axes, (title, hybrid) in zip(panels, choices, strict=True):
        _draw_panel(axes, terrain, case, main.routes[key_of(case)], (hybrid, _THIN, _THIN_GREEN))
        axes.set_title(title, fontsize=13, pad=8)
    _draw_legend(figure, (_MOSTLY_ANGLE, _THIN, _THIN_GREEN), still=False)
    return png_bytes(figure, dpi)


def _sheet(columns: int) -> tuple[Figure, list[Any]]:
    """A figure with square panels side by side and room for a legend below."""
    side, left, gap, below, above = 4.5, 0.62, 0.35, 1.22, 0.5  # [inch]
    width, height = left + columns * side + (columns - 1) * gap + 0.15, below + side + above
    figure = Figure(figsize=(width, height))
    FigureCanvasAgg(figure)
    panels = []
    for i in range(columns):
        box = ((left + i * (side + gap)) / width, below / height, side / width, side / height)
        axes = figure.add_axes(box)
        axes.set_xlabel("x [mr]")
        axes.set_ylabel("y [mr]" if i == 0 else "", labelpad=-2)
        panels.append(axes)
    return figure, panels


def _draw_panel(axes: Any, terrain: Dem, case: Case, routes: Mapping[str, Route], styles: Sequence[Style]) -> None:
    """One case: relief, wind, routes, start and goal, and the times below."""
    _draw_relief(axes, terrain)
    _draw_wind(axes, case.wind)
    for order, style in enumerate(styles):
        x, y = routes[style.route].points[:, :2].T
        halo = [Stroke(linewidth=style.width + 1.8, foreground="white", alpha=0.85), Normal()]
        axes.plot(
            x, y, color=style.colour, ls=style.dashes, lw=style.width, path_effects=halo if order == 0 else None,
            zorder=6 + order, solid_joinstyle="round", dash_capstyle="butt",
        )  # fmt: skip
    _draw_sites(axes, case, np.concatenate([_dense(routes[style.route].points) for style in styles]))
    times = "   ".join(f"{style.label.removeprefix('least ')} {routes[style.route].seconds:.2f} s" for style in styles)
    axes.text(0.5, -0.135, times, transform=axes.transAxes, ha="center", va="top", fontsize=10.5)
    axes.set(xlim=(AREA.west - _RIM, AREA.east + _RIM), ylim=(AREA.south - _RIM, AREA.north + _RIM), aspect="equal")
    axes.set_xticks(range(-2, 3))
    axes.set_yticks(range(-2, 3))


def _draw_relief(axes: Any, terrain: Dem) -> None:
    """Shaded and tinted heights with contours every 0.1 mr."""
    heights, east, north = terrain.raster(AREA, _RAISED)
    shade = LightSource(azdeg=315, altdeg=50).hillshade(heights, vert_exag=1.0, dx=_RAISED, dy=-_RAISED)
    tint = mpl.colormaps["gist_earth"](0.40 + 0.5 * heights / heights.max())[..., :3]
    colours = (0.55 + 0.45 * tint) * (0.66 + 0.34 * shade[..., None])
    box = (AREA.west, AREA.east, AREA.south, AREA.north)
    axes.imshow(np.clip(colours, 0, 1), origin="lower", extent=box, interpolation="bilinear")
    axes.contour(east, north, heights, levels=_CONTOURS, colors="#5b4a32", linewidths=0.5, alpha=0.6)


def _draw_wind(axes: Any, wind: WindField) -> None:
    """Arrows towards where the wind blows; dots in still air."""
    side = np.linspace(-2, 2, 2 * _ARROWS + 1)[1::2]
    x, y = (grid.ravel() for grid in np.meshgrid(side, side))
    air = wind.at(np.column_stack([x, y, np.full(len(x), VEIL_HEIGHT)]))
    blows = np.hypot(air[:, 0], air[:, 1]) > 0
    axes.quiver(
        x[blows], y[blows], air[blows, 0], air[blows, 1], color=_INK, alpha=0.72, pivot="mid", angles="xy",
        scale_units="xy", scale=5.2, width=0.0034, headwidth=4.2, headlength=4.6, zorder=3,
    )  # fmt: skip
    axes.plot(x[~blows], y[~blows], ".", color=_INK, alpha=0.5, ms=2.5, zorder=3)


def _dense(points: FloatArray) -> FloatArray:
    """Places close together along a route, (n, 2)."""
    share = np.linspace(0, 1, 40)[:, None, None]
    places: FloatArray = (points[:-1, :2] + share * np.diff(points[:, :2], axis=0)).reshape(-1, 2)
    return places


def _draw_sites(axes: Any, case: Case, taken: FloatArray) -> None:
    """Start and goal, their names where they hide no route."""
    for place, word, marker in ((case.start, "start", "^"), (case.goal, "goal", "s")):
        axes.plot(*place, marker, ms=10, mfc="#f0e442", mec="black", mew=1.3, zorder=12, clip_on=False)
        axes.text(
            *_free_place(np.array(place), taken), word, fontsize=11, fontweight="bold", zorder=13, ha="center",
            va="center", path_effects=[Stroke(linewidth=2.8, foreground="white"), Normal()],
        )  # fmt: skip


def _free_place(site: FloatArray, taken: FloatArray) -> FloatArray:
    """A place for a word beside a site: inside of the map, as far from all routes as there is."""
    turns = np.arange(16) * (np.pi / 8)
    around = site + np.column_stack([0.30 * np.cos(turns), 0.20 * np.sin(turns)])
    inside = (np.abs(around) < (1.88, 1.98)).all(axis=1)
    away = np.array([np.min(np.hypot((taken[:, 0] - x) / 1.5, taken[:, 1] - y)) for x, y in around])
    return np.asarray(around[np.argmax(np.where(inside, away, -1.0))])


def _draw_legend(figure: Figure, styles: Sequence[Style], still: bool) -> None:
    """One legend for all panels, below them."""
    lines = [Line2D([], [], color=style.colour, ls=style.dashes, lw=style.width, label=style.label) for style in styles]
    marks = [Line2D([], [], color=_INK, marker=r"$\rightarrow$", ls="", ms=15, label="wind, 1 mr/s")]
    if still:
        marks.append(Line2D([], [], color=_INK, marker=".", ls="", ms=4, label="still air"))
    figure.legend(handles=[*lines, *marks], loc="lower center", ncols=5, frameon=False, fontsize=11, handlelength=3.2)
