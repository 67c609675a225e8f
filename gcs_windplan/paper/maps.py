"""Figures 6 and 7: routes from above over the terrain, with the wind, as PNG."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Final

import numpy as np
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from gcs_windplan.paper.cases import AREA, CASES, VEIL_HEIGHT, PaperCase
from gcs_windplan.paper.comparison import Setup, key_of
from gcs_windplan.paper.flying import SHAPED, Route
from gcs_windplan.paper.published import ANGLE, DISTANCE
from gcs_windplan.planning.cost import CostChoice
from gcs_windplan.report.map import INK, MapPanel, MapPlace, RouteStyle, WindArrows
from gcs_windplan.report.png import png_bytes
from gcs_windplan.report.relief import Ground
from gcs_windplan.terrain import Dem

_RAISED: Final = 0.02  # of the raster under a map
_ARROWS: Final = 15
_RIM: Final = 0.09  # around the area, so that routes on its border are seen
_CONTOURS: Final = 0.1  # of height between two lines


@dataclass(frozen=True, slots=True)
class Line:
    """A route to draw: its name among the routes, its name in the legend, and its style."""

    route: str
    label: str
    style: RouteStyle


# the paper's red and green, in the shades of Okabe and Ito 2008, which colour-blind readers tell apart; and dashes
_RED = Line(str(DISTANCE), "least distance", RouteStyle("#d55e00", "-", 3.0))
_GREEN = Line(str(ANGLE), "least angle", RouteStyle("#00805c", (0, (4.5, 1.6)), 3.0))
_BLUE = Line(SHAPED, "least time (shaped)", RouteStyle("#0a3fb5", (0, (1.1, 1.1)), 2.8))
_MOSTLY_ANGLE = Line(str(CostChoice("hybrid", 0.1, 0.9)), "hybrid", RouteStyle("#7b2d8e", "-", 3.2))
_MOSTLY_DISTANCE = Line(str(CostChoice("hybrid", 0.9, 0.1)), "hybrid", RouteStyle("#7b2d8e", "-", 3.2))
_THIN = Line(str(DISTANCE), "least distance", RouteStyle("#d55e00", (0, (3, 1.5)), 1.8))
_THIN_GREEN = Line(str(ANGLE), "least angle", RouteStyle("#00805c", (0, (1.2, 1.2)), 1.8))


def draw_cases(terrain: Dem, main: Setup, dpi: int = 150) -> bytes:
    """Figure 6: least distance, least angle and least time in the three cases."""
    figure, panels = _new_panels(3)
    lines = (_RED, _GREEN, _BLUE)
    for letter, axes, case in zip("abc", panels, CASES, strict=True):
        _draw_panel(axes, terrain, case, main.routes[key_of(case)], lines)
        axes.set_title(f"({letter}) {case.title}", fontsize=13, pad=8)
    _draw_legend(figure, lines, still=True)
    return png_bytes(figure, dpi)


def draw_hybrid(terrain: Dem, main: Setup, dpi: int = 150) -> bytes:
    """Figure 7: the hybrid cost of case 2 with either weight the larger one."""
    figure, panels = _new_panels(2)
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


def _new_panels(columns: int) -> tuple[Figure, list[Any]]:
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


def _draw_panel(axes: Any, terrain: Dem, case: PaperCase, routes: Mapping[str, Route], lines: Sequence[Line]) -> None:
    """One case: relief, wind, routes, start and goal, and the times below."""
    axes.set(xlim=(AREA.west - _RIM, AREA.east + _RIM), ylim=(AREA.south - _RIM, AREA.north + _RIM), aspect="equal")
    heights, _, _ = terrain.raster(AREA, _RAISED)
    panel = MapPanel(axes, unit=1.0)
    panel.draw_relief(Ground(AREA.west, AREA.south, AREA.east, AREA.north, heights), contours=_CONTOURS)
    panel.draw_wind(_wind_of(case))
    for order, line in enumerate(lines):
        panel.draw_route(routes[line.route].points[:, :2], line.style, order)
    sites = (MapPlace("start", *case.start, marker="^"), MapPlace("goal", *case.goal, marker="s"))
    panel.draw_places(sites, size=11.0)
    times = "   ".join(f"{line.label.removeprefix('least ')} {routes[line.route].seconds:.2f} s" for line in lines)
    axes.text(0.5, -0.135, times, transform=axes.transAxes, ha="center", va="top", fontsize=10.5)
    axes.set_xticks(range(-2, 3))
    axes.set_yticks(range(-2, 3))


def _wind_of(case: PaperCase) -> WindArrows:
    """The field on a grid at the veil's height."""
    side = np.linspace(-2, 2, 2 * _ARROWS + 1)[1::2]
    places = np.column_stack([axis.ravel() for axis in np.meshgrid(side, side)])
    air = case.wind.at(np.column_stack([places, np.full(len(places), VEIL_HEIGHT)]))
    return WindArrows(places, air[:, :2], across=_ARROWS)


def _draw_legend(figure: Figure, lines: Sequence[Line], still: bool) -> None:
    """One legend for all panels, below them."""
    drawn = [
        Line2D([], [], color=line.style.colour, ls=line.style.dashes, lw=line.style.width, label=line.label)
        for line in lines
    ]
    marks = [Line2D([], [], color=INK, marker=r"$\rightarrow$", ls="", ms=15, label="wind, 1 mr/s")]
    if still:
        marks.append(Line2D([], [], color=INK, marker=".", ls="", ms=4, label="still air"))
    figure.legend(handles=[*drawn, *marks], loc="lower center", ncols=5, frameon=False, fontsize=11, handlelength=3.2)
