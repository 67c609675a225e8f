"""Planning tells how far it is, and stops when it is told to."""

from __future__ import annotations

from dataclasses import replace
from datetime import UTC, datetime, timedelta

import pytest

from gcs_windplan.errors import CancelledError
from gcs_windplan.planning.departures import sweep
from gcs_windplan.planning.planner import plan_route
from gcs_windplan.planning.request import Site, Uniform
from gcs_windplan.progress import CancelToken, Progress
from tests.ensembles import Corridor, request

ASKED = request(
    wind=Corridor(3.0), graph=Uniform(150.0, 8), via=(Site("via.0", 0.0, 300.0), Site("via.1", 0.0, -300.0))
)
STAGES = (
    "placing the sites", "laying the graph", "sampling the wind", "ordering the vias", "searching by time",
    "shaping the route by time",
)  # fmt: skip


def test_every_stage_is_told_in_turn_and_counted():
    told: list[Progress] = []
    plan_route(replace(ASKED, order="free"), progress=told.append)
    assert tuple(dict.fromkeys(one.stage for one in told)) == STAGES
    assert all(one.total is None or 0 <= one.done < one.total for one in told)
    assert [one.done for one in told if one.stage == "ordering the vias"] == list(range(7))
    assert [(one.done, one.total) for one in told if one.stage == STAGES[-1]] == [(0, 3), (1, 3), (2, 3)]


@pytest.mark.parametrize("stage", STAGES)
def test_it_stops_at_the_next_step(stage):
    token, after = CancelToken(), []

    def listen(progress: Progress) -> None:
        if token.cancelled:
            after.append(progress)
        if progress.stage == stage:
            token.cancel()

    with pytest.raises(CancelledError):
        plan_route(replace(ASKED, order="free"), progress=listen, cancel=token)
    assert not after


def test_a_sweep_stops_between_two_departures():
    begin = datetime(2026, 5, 1, tzinfo=UTC)
    moments = [begin + timedelta(minutes=m) for m in range(5)]
    token, told = CancelToken(), []
    departures = sweep(ASKED, moments, cores=1, progress=told.append, cancel=token)
    found = [next(departures).moment, next(departures).moment]
    token.cancel()
    with pytest.raises(CancelledError):
        next(departures)
    assert found == moments[:2]
    assert [(one.done, one.total) for one in told if one.stage == "departures"] == [(0, 5), (1, 5)]
