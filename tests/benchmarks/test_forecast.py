"""Forecasts: interpolation in four dimensions beside scipy, a plan in changing wind, a sweep of departures."""

from __future__ import annotations

import pytest

from tests.benchmarks.forecast_jobs import POINTS
from tests.benchmarks.measuring import measure

KINDS = {
    "one": "levels alike in all columns",
    "ground": "levels above ground",
    "each": "each column its own heights",
}


@pytest.mark.parametrize("kind", KINDS)
def test_interpolation(table, kind):
    scipys = measure("scipy_interpolation", kind)
    for cores in (1, 2):
        ours = measure("our_interpolation", kind, cores=cores)
        table(f"Interpolation: u and v at {POINTS:,} random points, 9 times x 10 levels x 30 x 30").row(
            levels=KINDS[kind], cores=cores, ours_ms=f"{1e3 * ours.seconds:.2f}",
            scipy_RegularGridInterpolator_ms=f"{1e3 * scipys.seconds:.1f}",
            scipy_to_ours=f"{scipys.seconds / ours.seconds:.1f}",
        )  # fmt: skip
        assert ours.answer["sum"] == pytest.approx(scipys.answer["sum"], abs=1e-6)


def test_a_plan_in_a_three_hourly_forecast(table):
    for cores in (1, 2):
        one = measure("changing_plan", 100.0, cores=cores)
        table("Plan in a 3-hourly forecast, whole: Jacksboro fault, 16 neighbours, 3 layers").row(
            nodes=f"{one.answer['nodes']:,.0f}", cores=cores, seconds=f"{one.seconds:.2f}",
            veil_s=f"{one.answer['veil']:.2f}", search_s=f"{one.answer['search']:.2f}",
            shaping_s=f"{one.answer['shaping']:.2f}", peak_MB=f"{one.peak_mb:.0f}",
        )  # fmt: skip
        assert one.answer["nodes"] >= 300 * 300 * 3


def test_a_sweep_of_departures(table):
    alone = None
    for cores in (1, 2):
        one = measure("departures", 48, cores, cores=cores)
        alone = alone or one
        table("Departures: 48 x 10 members over the Jacksboro fault, 150 m x 3 layers, workers' start included").row(
            cores=cores, seconds=f"{one.seconds:.1f}", one_cores_work_s=f"{one.answer['worked']:.1f}",
            as_fast=f"{alone.seconds / one.seconds:.2f}", flown=f"{one.answer['flown']:.0f}",
        )  # fmt: skip
        assert (one.answer["departures"], one.answer["members"]) == (48, 10)
        assert one.answer["flown"] == alone.answer["flown"]
