"""A planned mission, flown by the stand-in in the world that it was planned in."""

from __future__ import annotations

import math

import numpy as np
import pytest

from gcs_windplan.jobs.requests import read_request
from gcs_windplan.link.firmware import outgoing_items
from gcs_windplan.link.wire import item_to_message
from gcs_windplan.mission.firmware import firmware_of
from gcs_windplan.planning.export import mission_of
from gcs_windplan.planning.planner import plan_route
from gcs_windplan.standin.flight import SimulatedFlight
from gcs_windplan.standin.items import MISSION, StoredItem, read_item
from gcs_windplan.standin.storage import store
from gcs_windplan.standin.vehicle import planned_profile
from gcs_windplan.standin.world import planned_world

from .scenes import HILL, Scene


@pytest.mark.parametrize("autopilot", ["ardupilot", "px4"])
def test_a_planned_mission_is_flown_as_planned(autopilot, tmp_path) -> None:
    path = tmp_path / "hill.yaml"
    path.write_text(HILL.format(autopilot=autopilot))
    plan = plan_route(read_request(path))
    request = plan.request
    world = planned_world(request)
    assert world.home.altitude == pytest.approx(plan.waypoints[0].altitude - plan.waypoints[0].above_ground, abs=0.01)
    firmware = firmware_of(autopilot, "multicopter")
    sent = outgoing_items(mission_of(plan), "mission", firmware)
    messages = [item_to_message(item, seq, 1, 1, MISSION) for seq, item in enumerate(sent)]
    held = [store(read_item(message), MISSION, firmware) for message in messages]
    if autopilot == "ardupilot":
        held[0] = StoredItem(0, 16, x=held[0].x, y=held[0].y, z=world.home.altitude)
    flown = Scene(
        held, SimulatedFlight(firmware, planned_profile(firmware, request.vehicle), world, lambda: held)
    ).start()
    state = flown.flight.state
    lowest, nearest = math.inf, dict.fromkeys(range(len(plan.waypoints)), math.inf)
    en_route: list[float] = []
    while state.armed and flown.time < 3000:
        flown.advance(0.05)
        body = state.body
        for waypoint in plan.waypoints:
            gap = math.dist(body.place, (waypoint.east, waypoint.north, waypoint.altitude))
            nearest[waypoint.number - 1] = min(nearest[waypoint.number - 1], gap)
        if nearest[0] < 0.5 and nearest[len(plan.waypoints) - 1] > 0.5:
            en_route.append(flown.time)
            ground = float(request.scene.terrain.heights_at(np.array([[body.east, body.north]]))[0])
            lowest = min(lowest, body.altitude - ground)
    assert max(nearest.values()) < 0.5  # [m] a step of the clock, and ArduPilot's centimetres
    assert lowest > 30.0 - 0.05
    # ArduCopter loses some seconds at rest and at corners, which the plan does not count
    seconds = en_route[-1] - en_route[0]
    assert plan.totals.seconds - 1 < seconds < plan.totals.seconds + 4 + 3 * len(plan.waypoints)
    assert body.altitude == pytest.approx(state.ground(body.east, body.north), abs=0.01)
    goal = plan.waypoints[-1]
    assert math.dist(body.place[:2], (goal.east, goal.north)) < 0.1
