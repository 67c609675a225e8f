"""Planning over an ensemble, and where waiting pays."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

import gcs_windplan as gw
from gcs_windplan.flight import fly_legs
from gcs_windplan.planning.ensemble import Spread
from gcs_windplan.planning.planner import PlannedRoute, plan_route
from tests.ensembles import Corridor, Everywhere, Gate, divided, request
from tests.scenes import changed


def seconds_in(plan: PlannedRoute, wind) -> float:
    points = np.array([(w.east, w.north, w.altitude) for w in plan.waypoints])
    return float(fly_legs(points, wind, plan.request.vehicle)[1][-1])


def test_the_robust_route_is_better_at_its_quantile_than_the_median_one():
    """The median route takes the corridor, which three of ten members close; the robust one stays out of it."""
    median, robust = plan_route(divided(0.5)), plan_route(divided(0.9))
    assert max(w.north for w in median.waypoints) > 200.0
    assert max(w.north for w in robust.waypoints) < 150.0
    assert median.spread.at(0.5) < 0.85 * robust.spread.at(0.5)
    assert robust.spread.at(0.9) < 0.6 * median.spread.at(0.9)


def test_the_spread_is_the_same_route_flown_in_every_member():
    plan = plan_route(divided(0.5))
    each = [seconds_in(plan, member) for member in plan.request.scene.members]
    assert plan.spread.seconds == pytest.approx(each, rel=1e-9)
    assert plan.spread.at(0.5) == pytest.approx(sorted(each)[4])
    assert plan.spread.at(0.1) == pytest.approx(sorted(each)[0])
    assert plan.spread.at(0.9) == pytest.approx(sorted(each)[8])


def test_members_that_cannot_fly_it_come_last():
    spread = Spread((3.0, math.inf, 1.0, 2.0))
    assert (spread.at(0.5), spread.at(0.75), spread.at(0.9)) == (2.0, 3.0, math.inf)
    assert spread.unflyable == 1


def test_without_an_ensemble_there_is_no_spread():
    assert plan_route(divided().in_the_mean()).spread is None


def test_where_waiting_pays_a_note_says_so():
    """The gale in the way ends after the flight would reach it: flying around takes longer than waiting."""
    plan = plan_route(request(wind=Gate(opens=90.0), margin=1300.0))
    (note,) = [note for note in plan.notes if "waiting pays" in note]
    assert "arrives" in note
    open_way = plan_route(request(wind=Gate(opens=1.0)))
    assert not [note for note in open_way.notes if "waiting pays" in note]


def test_where_no_way_is_open_the_error_says_when_one_will_be():
    with pytest.raises(gw.NoRouteError, match=r"leaving \d+ min later"):
        plan_route(request(wind=Gate(opens=1800.0)))


def test_a_route_that_too_few_members_can_fly_is_refused():
    """Three of ten members have a gale all over: no route is good for nine of them."""
    calm, gale = Corridor(2.0), Everywhere(-20.0)
    members = (calm,) * 7 + (gale,) * 3
    asked = changed(divided(0.7), members=members, wind=calm)
    plan = plan_route(asked)
    assert plan.spread.unflyable == 3
    with pytest.raises(gw.NoRouteError, match=r"no route|members only"):
        plan_route(replace(asked, robust=0.9))
