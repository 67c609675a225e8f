"""Requests and plans travel between processes."""

from __future__ import annotations

import multiprocessing
import pickle
from concurrent.futures import ProcessPoolExecutor
from pathlib import Path

import numpy as np
import pytest

from gcs_windplan.errors import Problem
from gcs_windplan.jobs.requests import read_request
from gcs_windplan.planning.planner import PlannedRoute, plan_route
from gcs_windplan.planning.request import Request
from gcs_windplan.wind import ConstantWind
from tests.ensembles import request

GALLERY = sorted((Path(__file__).parents[2] / "missions").glob("*.yaml"))


def corners(plan: PlannedRoute) -> list[tuple[float, ...]]:
    return [(w.east, w.north, w.altitude, w.seconds) for w in plan.waypoints]


def answers(asked: Request) -> list:
    """What a request's world says at its sites and between them."""
    sites = np.array([(site.east, site.north, 0.0) for site in asked.sites])
    sites[:, 2] = asked.scene.terrain.heights_at(sites) + 40.0
    scene = asked.scene
    told = [sites[:, 2], scene.terrain.leg_heights(sites[:-1], sites[1:]), *(one.at(sites) for one in scene.gusts)]
    told += [one.at(sites) for one in (scene.wind, *scene.members)]
    told.append(asked.scene.airspace.breaches(sites[:-1], sites[1:]))
    if asked.scene.obstacles is not None:
        told.append(asked.scene.obstacles.leg_margins(sites[:-1], sites[1:]))
    if asked.power is not None:
        told.append(np.asarray(asked.power.watts(12.0, 0.5)))
    problem = asked.locate(Problem("is wrong", "vehicle.airspeed"))
    return [part.tolist() for part in told] + [str(problem), repr(asked)]


@pytest.mark.parametrize("path", GALLERY, ids=lambda path: path.stem)
def test_a_missions_request_is_the_same_after_a_round_trip(path):
    asked = read_request(path)
    assert answers(pickle.loads(pickle.dumps(asked))) == answers(asked)


def test_another_process_plans_the_same_route_and_hands_it_back(gallery):
    asked = read_request(gallery / "keep_out.yaml")
    with ProcessPoolExecutor(1, multiprocessing.get_context("spawn")) as pool:
        there = pool.submit(plan_route, asked).result()
    here = plan_route(asked)
    assert corners(there) == corners(here)
    assert there.totals == here.totals
    assert there.battery == here.battery
    assert repr(there) == repr(here)


def test_a_request_made_in_python_travels_too():
    asked = pickle.loads(pickle.dumps(request(wind=ConstantWind.from_direction(3.0, 200.0))))
    assert asked.locate(Problem("is wrong", "cost")) == Problem("is wrong", "cost")
