"""The one drawer of maps: relief, areas, wind, routes, sites, stops and findings, from above."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, Final

import numpy as np
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.collections import LineCollection, PolyCollection
from matplotlib.figure import Figure
from matplotlib.patches import Polygon
from matplotlib.patheffects import Normal, Stroke

from gcs_windplan.arrays import FloatArray
from gcs_windplan.assessment import Outline
from gcs_windplan.report.labels import LabelPlacer, MapSign, draw_name, draw_number, draw_sign
from gcs_windplan.report.png import png_bytes
from gcs_windplan.report.relief import Ground, shade
from gcs_windplan.terrain import Extent

INK: Final = "#1b2a41"  # of the wind
_KM: Final = 1000.0  # [m]
_PIXELS: Final = 600  # of relief along the longer side
_HEAD, _FOOT = 0.85, 1.05  # [inch] above and below the map
_SIDE = 7.4  # [inch] the longer side of the map itself
_SHAFT: Final = 0.0163  # [inch] an arrow's width


@dataclass(frozen=True, slots=True)
class RouteStyle:
    """How a route is drawn among others: colour, dashes and width [point]."""

    colour: str
    dashes: Any
    width: float


# Okabe and Ito 2008: told apart by colour-blind readers; where routes coincide each shows beside the next
_STYLES: Final = (
    ("#0072b2", "-"),
    ("#d55e00", (0, (5, 1.5))),
    ("#cc79a7", (0, (1.5, 1.2))),
    ("#111111", (0, (6, 1.5, 1.5, 1.5))),
)


@dataclass(frozen=True, slots=True, eq=False)
class WindArrows:
    """Winds (n, 2) [m/s], towards where it blows, at places (n, 2) [m], about `across` of them on the longer side."""

    places: FloatArray
    winds: FloatArray
    where: str = ""
    across: int = 18


@dataclass(frozen=True, slots=True, eq=False)
class MapRoute:
    """A route (n, 2) [m] and what it is called; its ground speeds (n - 1,) [m/s] colour it where it is alone."""

    name: str
    line: FloatArray
    speeds: FloatArray


@dataclass(frozen=True, slots=True)
class MapPlace:
    """A place to name [m]: a site with a marker, or a stop, which gets a circle and its number."""

    name: str
    east: float
    north: float
    marker: str = ""


@dataclass(frozen=True, slots=True, eq=False)
class MapView:
    """What a map shows, in metres of the local frame; `solids` are obstacles seen from above, (k, 2) each."""

    title: str
    extent: Extent
    ground: Ground
    wind: WindArrows
    routes: Sequence[MapRoute]
    areas: Sequence[Outline] = ()
    solids: Sequence[FloatArray] = ()
    places: Sequence[MapPlace] = ()
    signs: Sequence[MapSign] = ()


def draw_view(view: MapView, dpi: int = 120) -> bytes:
    """A map as PNG. A single route is coloured by its ground speed; several are told apart by colour and dash."""
    figure, axes, beside = new_map(view.extent)
    style_axes(axes, view.extent, view.title)
    panel = MapPanel(axes)
    panel.draw_relief(view.ground.resampled(_PIXELS, smooth=True))
    for outline in view.areas:
        panel.draw_area(outline)
    panel.draw_solids(view.solids)
    panel.draw_wind(view.wind)
    if len(view.routes) == 1 and len(view.routes[0].line) > 1:
        coloured = panel.draw_by_speed(view.routes[0])
        figure.colorbar(coloured, cax=beside, label="ground speed [m/s]")
    else:
        beside.remove()
        panel.draw_side_by_side(view.routes)
    for sign in view.signs:
        draw_sign(panel.placer, MapSign(sign.text, sign.severity, sign.x / _KM, sign.y / _KM))
    panel.draw_places(view.places)
    return png_bytes(figure, dpi)


def new_map(extent: Extent) -> tuple[Figure, Any, Any]:
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


def style_axes(axes: Any, extent: Extent, title: str) -> None:
    """Axes, title and limits, in kilometres."""
    axes.set_facecolor("#d9d9d9")  # where the ground is not known
    axes.set_xlim(extent.west / _KM, extent.east / _KM)
    axes.set_ylim(extent.south / _KM, extent.north / _KM)
    axes.set_xlabel("east of the frame's origin [km]")
    axes.set_ylabel("north [km]")
    axes.set_title(title, fontsize=12, loc="left", pad=24)


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


class MapPanel:
    """One map's axes, whose limits are set, and the room for words on it; a `unit` of the axes is so long [m]."""

    def __init__(self, axes: Any, unit: float = _KM) -> None:
        self.axes = axes
        self.unit = unit
        self.placer = LabelPlacer(axes)

    def draw_relief(self, ground: Ground, contours: float | None = None) -> None:
        """Shaded relief with contour lines, so far apart [m] or as it suits; unknown ground stays blank."""
        self.axes.imshow(
            shade(ground, contours),
            origin="lower",
            extent=[v / self.unit for v in (ground.west, ground.east, ground.south, ground.north)],
            interpolation="bilinear",
            aspect="equal",
        )

    def draw_area(self, outline: Outline) -> None:
        """What is kept out of, hatched, with its name and heights in its middle; what is kept inside of, outlined."""
        corners = outline.corners / self.unit
        if outline.kind.endswith("in"):
            self.axes.add_patch(Polygon(corners, closed=True, fill=False, ec="#005a32", lw=1.6, ls="--"))
            return
        patch = Polygon(corners, closed=True, fc=(0.8, 0.2, 0, 0.18), ec="#b22200", hatch="///", lw=1.2)
        self.axes.add_patch(patch)
        x, y = (corners.min(axis=0) + corners.max(axis=0)) / 2
        self.axes.text(
            x, y, _area_text(outline), fontsize=8.5, ha="center", va="center", color="#7a1200", zorder=7, clip_on=True,
            path_effects=[Stroke(linewidth=2.4, foreground="white"), Normal()],
        )  # fmt: skip

    def draw_solids(self, solids: Sequence[FloatArray]) -> None:
        """Obstacles seen from above (k, 2), filled."""
        shapes = [solid / self.unit for solid in solids]
        self.axes.add_collection(PolyCollection(shapes, facecolors="#5b3a5e", edgecolors="#2d1d2f", lw=0.4))

    def draw_wind(self, wind: WindArrows) -> None:
        """Arrows towards where the wind blows, dots in still air, and, where it is said, one arrow to compare with."""
        speeds = np.hypot(wind.winds[:, 0], wind.winds[:, 1])
        strongest = float(speeds.max(initial=0.0))
        if strongest == 0:
            return
        still, blows = wind.places[speeds == 0] / self.unit, speeds > 0
        self.axes.plot(still[:, 0], still[:, 1], ".", color=INK, alpha=0.5, ms=2.5, zorder=3)
        arrows = self.axes.quiver(
            *(wind.places[blows] / self.unit).T, *wind.winds[blows].T, color=INK, alpha=0.75, pivot="mid",
            scale=strongest * wind.across * 1.25, width=_SHAFT / self._longer_side, zorder=3,
        )  # fmt: skip
        if not wind.where:
            return
        nice = float(f"{strongest:.1g}")
        above = 1 + 0.18 * self.axes.figure.dpi / self.axes.bbox.height  # [inch]
        self.axes.quiverkey(
            arrows, 0.05, above, nice, f"{nice:g} m/s wind, {wind.where}", labelpos="E", coordinates="axes",
            fontproperties={"size": 9},
        )  # fmt: skip

    @property
    def _longer_side(self) -> float:
        """The axes' longer side [inch]."""
        return float(max(self.axes.bbox.width, self.axes.bbox.height) / self.axes.figure.dpi)

    def draw_by_speed(self, route: MapRoute) -> LineCollection:
        """A route coloured by its ground speeds."""
        places = route.line / self.unit
        self.placer.keep_free(places)
        self.axes.plot(places[:, 0], places[:, 1], color="black", lw=5.5, solid_capstyle="round", zorder=4)
        pieces = list(np.stack([places[:-1], places[1:]], axis=1))
        lines = LineCollection(pieces, cmap="plasma", lw=3.4, capstyle="round", zorder=5)
        lines.set_array(route.speeds)
        self.axes.add_collection(lines)
        return lines

    def draw_route(self, line: FloatArray, style: RouteStyle, order: int, name: str = "") -> None:
        """A route (n, 2) with a white halo; those of higher order lie above it."""
        places, halo = line / self.unit, [Stroke(linewidth=style.width + 1.2, foreground="white"), Normal()]
        self.placer.keep_free(places)
        self.axes.plot(places[:, 0], places[:, 1], color="white", lw=style.width + 2, zorder=4)
        self.axes.plot(
            places[:, 0], places[:, 1], color=style.colour, ls=style.dashes, lw=style.width, zorder=5 + order,
            label=name, dash_capstyle="butt", solid_joinstyle="round", path_effects=halo,
        )  # fmt: skip

    def draw_side_by_side(self, routes: Sequence[MapRoute]) -> None:
        """Several routes, told apart by colour and dash, and a legend below."""
        for i, route in enumerate(routes):
            colour, dashes = _STYLES[i % len(_STYLES)]
            self.draw_route(route.line, RouteStyle(colour, dashes, 2.2 + 1.6 * (len(routes) - 1 - i)), i, route.name)
        below = -0.48 * float(self.axes.figure.dpi) / float(self.axes.bbox.height)
        self.axes.legend(loc="upper left", bbox_to_anchor=(0.0, below), ncols=2, frameon=False, fontsize=9)

    def draw_places(self, places: Sequence[MapPlace], size: float = 10.0) -> None:
        """Sites with their marks and names, then stops, whose numbers stand where there is room."""
        at = [(place, place.east / self.unit, place.north / self.unit) for place in places]
        for place, x, y in at:
            style = {"ms": 9, "mfc": "#f0e442", "mew": 1.2, "zorder": 12, "clip_on": False}
            stop = {"ms": 4.5, "mfc": "white", "mew": 0.9, "zorder": 6}
            self.axes.plot(x, y, place.marker or "o", mec="black", **(style if place.marker else stop))
        for place, x, y in at:
            if place.marker:
                self.placer.beside(x, y, (4.5, 4.5), [(0.0, 0.0)])
                draw_name(self.placer, x, y, place.name, size)
        for place, x, y in at:
            if not place.marker:
                draw_number(self.placer, x, y, place.name)


def _area_text(outline: Outline) -> str:
    """An area's name and, on a second line, between which heights it is one."""
    heights = [] if outline.floor is None else [f"from {outline.floor:.0f} m"]
    heights += [] if outline.ceiling is None else [f"up to {outline.ceiling:.0f} m"]
    return "\n".join([outline.name, " ".join([*heights, "AMSL"])] if heights else [outline.name])
