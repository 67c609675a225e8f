"""A route from the side: heights above ground over speeds, along the way."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure

from gcs_windplan.arrays import FloatArray


@dataclass(frozen=True, slots=True, eq=False)
class Side:
    """What a profile shows: ground along the way (n,) and the route over it (k,), distances level along it [m]."""

    along: FloatArray
    ground: FloatArray
    flown: FloatArray
    altitude: FloatArray
    clearance: float | None
    max_height: float | None
    vertical_datum: str
    marks: bool = True


def side_figure(title: str) -> tuple[Figure, Any, Any]:
    """A figure with axes for heights and, below, for speeds."""
    figure = Figure(figsize=(10.5, 5.6))
    FigureCanvasAgg(figure)
    heights, speeds = figure.subplots(
        2, 1, sharex=True, height_ratios=[2.4, 1],
        gridspec_kw={"left": 0.07, "right": 0.985, "top": 0.94, "bottom": 0.09, "hspace": 0.07},
    )  # fmt: skip
    heights.set_title(title, fontsize=11, loc="left")
    return figure, heights, speeds


def draw_heights(axes: Any, side: Side) -> None:
    """Ground, the band in which legs may lie, and the route."""
    km, ground = side.along / 1000, side.ground
    known = ground[np.isfinite(ground)] if np.isfinite(ground).any() else side.altitude
    floor = min(float(known.min()), float(np.nanmin(side.altitude))) - 15
    axes.fill_between(km, floor, ground, color="#8c7a5b", lw=0, label="ground")
    if side.clearance is not None:
        axes.fill_between(
            km, ground, ground + side.clearance, color="#e8b04a", alpha=0.55, lw=0,
            label=f"clearance {side.clearance:g} m",
        )  # fmt: skip
    if side.max_height is not None:
        axes.plot(km, ground + side.max_height, color="#b22200", lw=1, ls="--", label=f"limit {side.max_height:g} m")
    mark: dict[str, Any] = {"marker": "o", "ms": 4, "mfc": "white"} if side.marks else {}
    axes.plot(side.flown / 1000, side.altitude, color="#0072b2", lw=2, label="route", **mark)
    top = max(float(known.max()) + (side.max_height or side.clearance or 0.0), float(np.nanmax(side.altitude)))
    axes.set_ylim(floor, top + 0.14 * (top - floor))
    axes.set_ylabel(f"height [m], {side.vertical_datum}", fontsize=9)
    axes.legend(loc="upper right", fontsize=8.5, framealpha=0.9, ncols=4)
    axes.grid(alpha=0.25)


def dress_speeds(axes: Any, longest: float, fastest: float) -> None:
    """The lower axes' limits, labels and legend; `longest` [m], `fastest` [m/s]."""
    axes.axhline(0, color="black", lw=0.6)
    axes.set_xlim(0, max(longest, 1.0) / 1000)
    axes.set_ylim(top=1.45 * fastest)
    axes.set_ylabel("[m/s]")
    axes.set_xlabel("distance along the route [km]")
    axes.legend(loc="upper right", fontsize=8.5, framealpha=0.9, ncols=3)
    axes.grid(alpha=0.25)
