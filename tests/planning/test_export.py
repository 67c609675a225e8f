"""How long the autopilot takes for a plan."""

from __future__ import annotations

from dataclasses import replace

import gcs_windplan as gw
from gcs_windplan.cli.tables import flown_line
from gcs_windplan.flight import clock
from gcs_windplan.mission import Command
from gcs_windplan.planning.export import flown_duration, mission_of
from gcs_windplan.planning.planner import plan_route
from gcs_windplan.wind import Calm
from tests.ensembles import Everywhere, request


def test_corners_and_acceleration_come_on_top():
    """1.8 km straight in still air at 10 m/s: from rest, and to a stop for the landing."""
    plan = plan_route(request(wind=Calm()))
    flown = flown_duration(plan)
    assert 2.0 < flown.en_route - plan.totals.seconds < 9.0
    assert flown.total > flown.en_route + plan.totals.takeoff_seconds + plan.totals.landing_seconds
    assert clock(flown.en_route) in flown_line(plan)


def test_the_plans_wind_is_in_its_speeds():
    """With a tail wind of 4 m/s the mission commands 14 m/s over ground, and takes that much less."""
    calm, windy = (flown_duration(plan_route(request(wind=wind))) for wind in (Calm(), Everywhere(4.0)))
    assert abs((calm.en_route - windy.en_route) - (1800 / 10 - 1800 / 14)) < 3.0


def test_of_a_fixed_wing_it_is_not_known():
    plan = plan_route(request(wind=Calm(), vehicle=gw.Vehicle(15.0, type="fixed-wing")))
    assert flown_duration(plan) is None
    assert flown_line(plan) is None


def test_px4_is_told_with_less_certainty():
    plan = plan_route(request(wind=Calm(), vehicle=replace(gw.Vehicle(10.0), autopilot="px4")))
    assert "PX4 may fly" in flown_line(plan)


def test_a_fixed_wing_is_told_the_airspeed_that_it_holds():
    plan = plan_route(request(wind=Everywhere(5.0), vehicle=gw.Vehicle(15.0, type="fixed-wing")))
    told = [item.params for item in mission_of(plan).items if item.command == Command.DO_CHANGE_SPEED]
    assert told == [(0.0, 15.0, -1.0, 0.0)]
    hovering = plan_route(request(wind=Everywhere(5.0), vehicle=gw.Vehicle(15.0)))
    told = [item.params for item in mission_of(hovering).items if item.command == Command.DO_CHANGE_SPEED]
    assert told == [(1.0, 20.0, -1.0, 0.0)]
