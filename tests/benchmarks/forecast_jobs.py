"""The jobs about forecasts: interpolation beside scipy's, a plan in changing wind, a sweep of departures."""

from __future__ import annotations

import tempfile
import time
from collections.abc import Callable
from dataclasses import replace
from datetime import UTC, datetime, timedelta
from pathlib import Path
from typing import Any

import numpy as np

from tests.benchmarks.measuring import Measured, timed
from tests.scenes import changed

FRONT = Path(__file__).resolve().parents[2] / "missions" / "front.yaml"
SHAPE = (9, 10, 30, 30)  # times, levels, rows, columns
POINTS = 100_000


def _field(kind: str):
    """A random forecast and points inside of it."""
    from gcs_windplan.kernels.interpolation import Columns

    random = np.random.default_rng(1)
    nt, nl, ny, nx = SHAPE
    levels = np.cumsum(random.uniform(50, 300, nl))
    times, rows, columns = np.arange(nt) * 10800.0, np.linspace(46, 48, ny), np.linspace(8, 10, nx)
    heights = {
        "one": levels.reshape(1, 1, 1, -1),
        "each": np.ascontiguousarray(np.broadcast_to(levels, (nt, ny, nx, nl))),
        "ground": np.empty((nt, ny, nx, 0)),
    }[kind]
    field = Columns(
        random.normal(size=(nt, ny, nx, nl, 2)), levels if kind == "ground" else np.empty(0), heights,
        np.full((ny, nx), -np.inf), np.full((ny, nx), 0.1), times, rows, columns,
    )  # fmt: skip
    axes = (times, levels, rows, columns)
    return field, axes, np.column_stack([random.uniform(axis[0], axis[-1], POINTS) for axis in axes])


def our_interpolation(kind: str) -> Measured:
    """u and v at 100 000 points in four dimensions, on as many cores as there are."""
    from gcs_windplan.cores import available_cores, spread
    from gcs_windplan.kernels.interpolation import LOG, Law, interpolate_columns

    field, _, points = _field(kind)
    law, places = Law(LOG, 0.0, 0.0), np.ascontiguousarray(points[:, 2:])
    z, ground, when = points[:, 1].copy(), np.zeros(POINTS), points[:, 0].copy()
    size = -(-POINTS // available_cores())
    parts = [slice(begin, begin + size) for begin in range(0, POINTS, size)]

    def work() -> dict[str, float]:
        found = spread(lambda p: interpolate_columns(field, law, places[p], z[p], ground[p], when[p]), parts)
        return {"parts": list(found)}  # type: ignore[dict-item]

    work()
    measured = timed(work, list, 50)
    total = sum(float(part[:, :2].sum()) for part in measured.answer["parts"])  # type: ignore[attr-defined]
    return replace(measured, answer={"sum": total})


def scipy_interpolation(kind: str) -> Measured:
    """The same with two of scipy's RegularGridInterpolator."""
    from scipy.interpolate import RegularGridInterpolator

    field, axes, points = _field(kind)
    both = [RegularGridInterpolator(axes, field.winds[..., part].transpose(0, 3, 1, 2)) for part in range(2)]

    def work() -> dict[str, float]:
        return {"sum": float(sum(one(points).sum() for one in both))}

    return timed(work, list, 10)


def changing_plan(spacing: str) -> Measured:
    """A whole plan, shaping too, in the control member of the 3-hourly forecast, kernels warm."""
    from gcs_windplan.planning.planner import plan_route
    from gcs_windplan.planning.request import Uniform

    request = _across(FRONT)
    control = changed(
        request, airframe=None, wind=request.scene.members[0], members=(), robust=0.5, layers=(50.0, 80.0, 110.0),
        graph=Uniform(float(spacing), 16),
    )  # fmt: skip
    plan_route(replace(control, graph=Uniform(400.0, 16)))
    effort = []

    def work() -> dict[str, float]:
        plan = plan_route(control)
        effort.append(plan.effort)
        return {
            "nodes": plan.effort.nodes, "expanded": plan.effort.expanded, "veil": plan.effort.veil_seconds,
            "search": plan.effort.search_seconds, "shaping": plan.effort.shaping_seconds,
        }  # fmt: skip

    return timed(work, list, 3)


def departures(count: str, cores: str) -> Measured:
    """A sweep over a day of departures in all ten members over the Jacksboro fault."""
    from gcs_windplan.planning.departures import moments_between, sweep
    from gcs_windplan.planning.request import Uniform

    first = datetime(2026, 5, 1, 6, tzinfo=UTC)
    every = timedelta(hours=23.5) / (int(count) - 1)
    request = _across(FRONT, first, 24 * 3600.0)
    jacksboro = replace(request, layers=(50.0, 80.0, 110.0), margin=None, graph=Uniform(150.0, 16))
    begin = time.perf_counter()
    found = list(sweep(jacksboro, moments_between(first, first + 23.5 * timedelta(hours=1), every), cores=int(cores)))
    took = time.perf_counter() - begin
    answer = {
        "departures": len(found), "flown": sum(one.seconds is not None for one in found),
        "worked": sum(one.worked for one in found), "members": len(request.scene.members),
    }  # fmt: skip
    return replace(timed(dict, list, 1), seconds=took, answer=answer)


def _across(path: Path, *when: Any):
    """The mission flown 20 km, all across the fault, with all of its terrain around."""
    from gcs_windplan.jobs.requests import read_request

    text = path.read_text().replace("latitude: 36.57, longitude: -84.255", "latitude: 36.52, longitude: -84.34")
    text = text.replace("  layers:", "  margin: 40 km\n  layers:").replace("vehicles/", f"{path.parent}/vehicles/")
    with tempfile.NamedTemporaryFile("w", suffix=".yaml") as file:
        file.write(text.replace("forecast: wind/", f"forecast: {path.parent}/wind/"))
        file.flush()
        return read_request(file.name, *when)


FORECAST_JOBS: dict[str, Callable[..., Measured]] = {
    job.__name__: job for job in (our_interpolation, scipy_interpolation, changing_plan, departures)
}
