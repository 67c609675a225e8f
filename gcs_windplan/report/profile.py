"""The one drawer of profiles: a flight from the side, heights over speeds, along the way."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure

from gcs_windplan.arrays import FloatArray
from gcs_windplan.report.labels import LabelPlacer, MapSign, draw_sign
from gcs_windplan.report.png import png_bytes


@dataclass(frozen=True, slots=True, eq=False)
class ProfileView:
    """What a profile shows: ground along the way (n,), the route over it (k,), speeds (m,); distances level [m].

    `marks`: whether each place of the route is one to see. `signs` are at distances [m] and altitudes [m].
    """

    title: str
    along: FloatArray
    ground: FloatArray
    flown: FloatArray
    altitude: FloatArray
    clearance: float | None
    max_height: float | None
    vertical_datum: str
    speeds_at: FloatArray
    ground_speed: FloatArray
    airspeed: FloatArray
    wind_along: FloatArray
    marks: bool = True
    signs: Sequence[MapSign] = ()


def draw_view(view: ProfileView, dpi: int = 120) -> bytes:
    """Ground, clearance, height limit, route and findings; below them ground speed, airspeed and wind, as PNG."""
    figure, heights, speeds = _new_profile(view.title)
    if len(view.along):
        _draw_heights(heights, view)
        _draw_speeds(speeds, view)
        placer = LabelPlacer(heights)
        for sign in view.signs:
            draw_sign(placer, MapSign(sign.text, sign.severity, sign.x / 1000, sign.y))
    return png_bytes(figure, dpi)


def _new_profile(title: str) -> tuple[Figure, Any, Any]:
    """A figure with axes for heights and, below, for speeds."""
    figure = Figure(figsize=(10.5, 5.6))
    FigureCanvasAgg(figure)
    heights, speeds = figure.subplots(
        2, 1, sharex=True, height_ratios=[2.4, 1],
        gridspec_kw={"left": 0.07, "right": 0.985, "top": 0.94, "bottom": 0.09, "hspace": 0.07},
    )  # fmt: skip
    heights.set_title(title, fontsize=11, loc="left")
    return figure, heights, speeds


def _draw_heights(axes: Any, view: ProfileView) -> None:
    """Ground, the band in which legs may lie, and the route."""
    km, ground = view.along / 1000, view.ground
    known = ground[np.isfinite(ground)] if np.isfinite(ground).any() else view.altitude
    floor = min(float(known.min()), float(np.nanmin(view.altitude))) - 15
    axes.fill_between(km, floor, ground, color="#8c7a5b", lw=0, label="ground")
    if view.clearance is not None:
        axes.fill_between(
            km, ground, ground + view.clearance, color="#e8b04a", alpha=0.55, lw=0,
            label=f"clearance {view.clearance:g} m",
        )  # fmt: skip
    if view.max_height is not None:
        axes.plot(km, ground + view.max_height, color="#b22200", lw=1, ls="--", label=f"limit {view.max_height:g} m")
    mark: dict[str, Any] = {"marker": "o", "ms": 4, "mfc": "white"} if view.marks else {}
    axes.plot(view.flown / 1000, view.altitude, color="#0072b2", lw=2, label="route", **mark)
    top = max(float(known.max()) + (view.max_height or view.clearance or 0.0), float(np.nanmax(view.altitude)))
    axes.set_ylim(floor, top + 0.14 * (top - floor))
    axes.set_ylabel(f"height [m], {view.vertical_datum}", fontsize=9)
    axes.legend(loc="upper right", fontsize=8.5, framealpha=0.9, ncols=4)
    axes.grid(alpha=0.25)


def _draw_speeds(axes: Any, view: ProfileView) -> None:
    """Ground speed and airspeed, and the wind along the track."""
    km = view.speeds_at / 1000
    axes.plot(km, view.ground_speed, color="#0072b2", lw=2, label="ground speed")
    axes.plot(km, view.airspeed, color="#555555", lw=1, ls=":", label="airspeed")
    axes.fill_between(km, 0, view.wind_along, color="#d55e00", lw=0, alpha=0.35, label="tail wind (+), head wind (−)")
    axes.axhline(0, color="black", lw=0.6)
    axes.set_xlim(0, max(float(view.speeds_at[-1]), 1.0) / 1000)
    axes.set_ylim(top=1.45 * float(np.nanmax([*view.ground_speed, *view.airspeed, 1.0])))
    axes.set_ylabel("[m/s]")
    axes.set_xlabel("distance along the route [km]")
    axes.legend(loc="upper right", fontsize=8.5, framealpha=0.9, ncols=3)
    axes.grid(alpha=0.25)
