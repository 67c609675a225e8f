"""Plans of the gallery, judged: their figures are the planner's own."""

from __future__ import annotations

import math

import numpy as np
import pytest

from gcs_windplan.assessment import Stop, assess_plan
from gcs_windplan.planning.export import flown_duration
from gcs_windplan.wind import WindField
from tests.plans import planned

one_millimetre = 1e-3
three_cm_a_second = 0.03  # the planner's quadrature is off by that where the ground's edges shape the wind
one_cm_a_second = 0.01
a_hundredth = 0.01  # [s]


def sampled_wind(wind: WindField, start: Stop, end: Stop) -> tuple[float, float]:
    """The mean wind along and across a leg by 5000 samples [m/s]."""
    a, b = (np.array([stop.east, stop.north, stop.altitude]) for stop in (start, end))
    blows = wind.at(a + ((np.arange(5000) + 0.5) / 5000)[:, None] * (b - a))
    east, north = (b - a)[:2] / np.hypot(*(b - a)[:2])
    along, across = blows[:, 0] * east + blows[:, 1] * north, blows[:, 0] * north - blows[:, 1] * east
    return float(along.mean()), float(across.mean())


@pytest.mark.parametrize("name", ["front", "inspection", "jacksboro", "keep_out", "village"])
def test_a_plan_keeps_its_figures(name):
    plan = planned(name)
    request = plan.request
    review = assess_plan(plan)
    flown = flown_duration(plan)
    steady = len(request.scene.wind.times) <= 1
    for leg, meant, start, end in zip(review.legs, plan.legs, review.stops, review.stops[1:], strict=False):
        assert leg.clearance == pytest.approx(meant.clearance, abs=one_millimetre)
        assert leg.height == pytest.approx(meant.height, abs=one_millimetre)
        assert leg.track_deg == pytest.approx(meant.track_deg, abs=1e-3)
        assert leg.distance == pytest.approx(meant.distance, abs=one_millimetre)
        if steady:
            assert leg.wind_along == pytest.approx(meant.wind_along, abs=three_cm_a_second)
            assert leg.wind_across == pytest.approx(meant.wind_across, abs=three_cm_a_second)
            assert (leg.wind_along, leg.wind_across) == pytest.approx(
                sampled_wind(request.scene.wind, start, end), abs=one_cm_a_second
            )
    assert [leg.seconds for leg in review.legs[: len(flown.legs)]] == pytest.approx(
        [leg.seconds - leg.hold for leg in flown.legs], abs=a_hundredth
    )
    assert review.totals.seconds == pytest.approx(flown.total, abs=a_hundredth)
    assert review.totals.clearance >= request.clearance - one_millimetre
    assert [finding for finding in review.findings if finding.rule not in ("return", "reach", "height")] == []
    if plan.battery is not None:
        assert review.totals.energy == pytest.approx(plan.battery.total, rel=0.03)
        assert review.stops[-1].left == pytest.approx(plan.battery.left[-1], abs=0.03)
    assert math.isfinite(review.profile.seconds[-1])
