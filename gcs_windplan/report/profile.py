"""The route from the side: heights over the ground and speeds along the way, as a PNG."""

from __future__ import annotations

from typing import Any

import numpy as np

from gcs_windplan.arrays import FloatArray
from gcs_windplan.planning.planner import PlannedRoute
from gcs_windplan.png import png_bytes
from gcs_windplan.report.side import Side, draw_heights, dress_speeds, side_figure

_SAMPLES = 1200


def draw_profile(plan: PlannedRoute, dpi: int = 120) -> bytes:
    """Ground, clearance, height limit and route over the distance flown; below it ground speed and wind, as PNG."""
    totals = plan.totals
    figure, heights, speeds = side_figure(
        f"{plan.request.name}: at least {totals.clearance:.1f} m and at most {totals.height:.1f} m above ground"
    )
    flown = np.concatenate([[0.0], np.cumsum([leg.distance for leg in plan.legs])])
    draw_heights(heights, _side(plan, flown))
    _draw_speeds(speeds, plan, flown)
    return png_bytes(figure, dpi)


def _side(plan: PlannedRoute, flown: FloatArray) -> Side:
    """The ground under the route and its corners."""
    request = plan.request
    along = np.unique(np.concatenate([np.linspace(0, flown[-1], _SAMPLES), flown]))
    corners = np.array([(w.east, w.north, w.altitude) for w in plan.waypoints])
    places = np.column_stack([np.interp(along, flown, corners[:, i]) for i in range(2)])
    ground = request.terrain.heights_at(places)
    return Side(
        along, ground, flown, corners[:, 2], request.clearance, request.max_height, request.terrain.vertical_datum
    )


def _draw_speeds(axes: Any, plan: PlannedRoute, flown: FloatArray) -> None:
    """Each leg's ground speed against the airspeed, and its wind along the track."""
    ground = [leg.ground_speed for leg in plan.legs]
    along = [leg.wind_along for leg in plan.legs]
    km = flown / 1000
    axes.stairs(ground, km, color="#0072b2", lw=2, baseline=None, label="ground speed")
    air = [leg.airspeed for leg in plan.legs]
    axes.stairs(air, km, color="#555555", lw=1, ls=":", baseline=None, label="airspeed")
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
    dress_speeds(axes, float(flown[-1]), max(*ground, *air))
