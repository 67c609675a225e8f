"""The route from the side: heights over the ground and speeds along the way, as a PNG."""

from __future__ import annotations

from typing import Any

import numpy as np
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure

from gcs_windplan.arrays import FloatArray
from gcs_windplan.planner import Plan
from gcs_windplan.review.png import png_bytes

_SAMPLES = 1200


def draw_profile(plan: Plan, dpi: int = 120) -> bytes:
    """Ground, clearance, height limit and route over the distance flown; below it ground speed and wind, as PNG."""
    figure = Figure(figsize=(10.5, 5.6))
    FigureCanvasAgg(figure)
    heights, speeds = figure.subplots(
        2, 1, sharex=True, height_ratios=[2.4, 1],
        gridspec_kw={"left": 0.07, "right": 0.985, "top": 0.94, "bottom": 0.09, "hspace": 0.07},
    )  # fmt: skip
    flown = np.concatenate([[0.0], np.cumsum([leg.distance for leg in plan.legs])])
    _draw_heights(heights, plan, flown)
    _draw_speeds(speeds, plan, flown)
    totals = plan.totals
    heights.set_title(
        f"{plan.request.name}: at least {totals.clearance:.1f} m and at most {totals.height:.1f} m above ground",
        fontsize=11,
        loc="left",
    )
    return png_bytes(figure, dpi)


def _draw_heights(axes: Any, plan: Plan, flown: FloatArray) -> None:
    """Ground, the band in which legs may lie, and the route."""
    request = plan.request
    along = np.unique(np.concatenate([np.linspace(0, flown[-1], _SAMPLES), flown]))
    corners = np.array([(w.east, w.north, w.altitude) for w in plan.waypoints])
    places = np.column_stack([np.interp(along, flown, corners[:, i]) for i in range(2)])
    ground = request.terrain.heights_at(places)
    km = along / 1000
    floor = min(float(np.nanmin(ground)), float(corners[:, 2].min())) - 15
    axes.fill_between(km, floor, ground, color="#8c7a5b", lw=0, label="ground")
    axes.fill_between(
        km, ground, ground + request.clearance, color="#e8b04a", alpha=0.55, lw=0,
        label=f"clearance {request.clearance:g} m",
    )  # fmt: skip
    if request.max_height is not None:
        axes.plot(
            km,
            ground + request.max_height,
            color="#b22200",
            lw=1,
            ls="--",
            label=f"limit {request.max_height:g} m",
        )
    axes.plot(flown / 1000, corners[:, 2], color="#0072b2", lw=2, marker="o", ms=4, mfc="white", label="route")
    top = float(np.nanmax(ground)) + (request.max_height or request.clearance)
    axes.set_ylim(floor, top + 0.14 * (top - floor))
    axes.set_ylabel(f"height [m], {request.terrain.vertical_datum}", fontsize=9)
    axes.legend(loc="upper right", fontsize=8.5, framealpha=0.9, ncols=4)
    axes.grid(alpha=0.25)


def _draw_speeds(axes: Any, plan: Plan, flown: FloatArray) -> None:
    """Each leg's ground speed against the airspeed, and its wind along the track."""
    ground = [leg.ground_speed for leg in plan.legs]
    along = [leg.wind_along for leg in plan.legs]
    km = flown / 1000
    axes.stairs(ground, km, color="#0072b2", lw=2, baseline=None, label="ground speed")
    axes.axhline(plan.request.vehicle.airspeed, color="#555555", lw=1, ls=":", label="airspeed")
    axes.stairs(
        along,
        km,
        color="#d55e00",
        lw=1.6,
        baseline=0,
        fill=True,
        alpha=0.35,
        label="tail wind (+), head wind (−)",
    )
    axes.axhline(0, color="black", lw=0.6)
    axes.set_xlim(0, km[-1])
    axes.set_ylim(top=1.45 * max(*ground, plan.request.vehicle.airspeed))
    axes.set_ylabel("[m/s]")
    axes.set_xlabel("distance along the route [km]")
    axes.legend(loc="upper right", fontsize=8.5, framealpha=0.9, ncols=3)
    axes.grid(alpha=0.25)
