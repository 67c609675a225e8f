"""Airspeeds free for each leg: least energy, and the quickest flight that the battery allows."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from gcs_windplan.errors import BatteryError, MissionFileError, RequestError
from gcs_windplan.jobs.missionfile.airframe import read_airframe
from gcs_windplan.jobs.requests import read_request
from gcs_windplan.mission import Command
from gcs_windplan.planning.budget import quickest_within
from gcs_windplan.planning.cost import CostChoice
from gcs_windplan.planning.export import mission_of
from gcs_windplan.planning.planner import plan_route, plan_routes
from gcs_windplan.planning.route import _merge_short_legs
from gcs_windplan.scene import Clearance
from gcs_windplan.vehicle import air_density
from gcs_windplan.vehicle.power_grid import airspeed_choices
from tests.planning.test_returns import with_battery
from tests.worlds import rough_dem


@pytest.fixture(scope="module")
def asked(gallery):
    return read_request(gallery / "shear.yaml")


@pytest.fixture(scope="module")
def plans(asked):
    return dict(zip(("time", "energy"), plan_routes(asked, [CostChoice("time"), CostChoice("energy")]), strict=True))


def test_it_is_faster_in_head_wind_and_slower_in_tail_wind_and_low_and_high(plans):
    legs = plans["energy"].legs
    head = [leg for leg in legs if leg.wind_along < -4]
    tail = [leg for leg in legs if leg.wind_along > 4]
    assert min(leg.airspeed for leg in head) > max(leg.airspeed for leg in tail) + 2
    assert np.mean([leg.height for leg in head]) < 60
    assert np.mean([leg.height for leg in tail]) > 80


def test_the_cost_is_the_energy_of_the_flight(plans):
    """The table and nine airspeeds in search and shaping, models and any airspeed in the flight."""
    plan = plans["energy"]
    assert plan.totals.energy == pytest.approx(plan.cost, rel=2e-3)
    assert plan.totals.energy <= plan.cost * (1 + 1e-3)


def test_no_held_airspeed_takes_less(asked, plans):
    held = []
    for airspeed in (13.0, 15.0, 18.0):
        request = replace(asked, free_airspeed=False, vehicle=replace(asked.vehicle, airspeed=airspeed))
        held.append(plan_routes(request, [CostChoice("energy")])[0].totals.energy)
    assert plans["energy"].totals.energy < min(held) * 0.999
    assert plans["energy"].totals.seconds > plans["time"].totals.seconds


def test_least_time_uses_what_the_battery_gives(asked, plans):
    """With less than full speed takes it slows down just so far; with less than any flight takes it is refused."""
    fast, thrifty = plans["time"], plans["energy"]
    assert {leg.airspeed for leg in fast.legs} == {asked.airframe.maximum_airspeed}
    between = (fast.battery.total + 2 * thrifty.battery.total) / 3
    plan = plan_route(replace(with_battery(asked, between), cost=CostChoice("time")))
    assert 0.975 * between < plan.battery.total <= between
    assert fast.totals.seconds < plan.totals.seconds < thrifty.totals.seconds
    with pytest.raises(BatteryError, match="breaks the reserve"):
        plan_route(replace(with_battery(asked, 0.97 * thrifty.battery.total), cost=CostChoice("time")))


def test_quickest_within_on_a_curve():
    """Energy falls as time is worth less: the answer lies where it is all used, as closely as six halvings find it."""

    def find(cost_index: float) -> tuple[float, float]:
        speed = min((cost_index / 2 + 1.0) ** (1 / 3), 20.0)  # over 1 km 1000 v² J and 1000/v s: dE/dv = worth/v²
        return 1000.0 / speed, 1000.0 * speed**2

    for allowed in (5e3, 2e4, 1e5, 1.6e5):
        (seconds, joules), _ = quickest_within(find, lambda one: one[1], allowed, 100.0)
        assert joules <= allowed
        assert 1000.0 / seconds == pytest.approx((allowed / 1000.0) ** 0.5, rel=0.06)
    assert quickest_within(find, lambda one: one[1], 1e6, 100.0) == ((50.0, 4e5), float("inf"))
    assert quickest_within(find, lambda one: one[1], 10.0, 100.0)[1] == 0.0


def test_the_mission_commands_each_legs_ground_speed(plans):
    items = mission_of(plans["energy"]).items
    speeds = [item.params[1] for item in items if item.command == Command.DO_CHANGE_SPEED]
    assert len(speeds) > 10
    ground = [leg.ground_speed for leg in plans["energy"].legs]
    assert min(ground) - 0.2 < min(speeds) < max(speeds) < max(ground) + 0.2


def test_free_without_an_airframe_is_told_with_its_line(tmp_path, gallery):
    text = (gallery / "jacksboro.yaml").read_text().replace("airspeed: 14 m/s", "airspeed: free")
    file = tmp_path / "free.yaml"
    file.write_text(text)
    with pytest.raises(MissionFileError, match=r"vehicle\.airspeed: to be free to choose asks for .* `airframe`"):
        read_request(file)


def test_energy_without_an_airframe_is_told(gallery):
    asked = read_request(gallery / "village.yaml")
    with pytest.raises(RequestError, match="energy asks for the vehicle's power"):
        plan_route(replace(asked, cost=CostChoice("energy")))
    shear = read_request(gallery / "shear.yaml")
    with pytest.raises(RequestError, match="the paper's speed model has no airspeed"):
        plan_route(replace(shear, vehicle=replace(shear.vehicle, speed_model="paper")))


def test_a_wing_keeps_away_from_its_stall(gallery):
    """In a tail wind the airspeed of least power lies below 1.2 times the stall of the Aerosonde."""
    airframe = read_airframe(gallery / "vehicles" / "fixed_wing.yaml")
    stall = airframe.power.airspeeds(float(air_density(1000.0)))[0]
    assert stall == pytest.approx(15.7 * (1.225 / float(air_density(1000.0))) ** 0.5)
    choices = airspeed_choices(airframe, 1000.0)
    assert choices[0] == pytest.approx(1.2 * stall)
    assert choices[-1] == airframe.maximum_airspeed


def test_a_leg_of_a_hair_is_joined_where_what_is_left_stays_clear():
    rules = Clearance(rough_dem(1, relief=0.0), 20.0)
    line = np.array([[0.0, 0, 30], [100, 0, 30], [100, 0.1, 30], [200, 0, 30]])
    assert len(_merge_short_legs(line, rules)) == 3
    low = np.array([[0.0, 0, 30], [100, 0, 20], [100, 0.1, 20], [200, 0, 30], [300, 0, 30]])
    assert _merge_short_legs(low, rules).tolist() == np.delete(low, 1, axis=0).tolist()
    ends = np.array([[0.0, 0, 30], [0, 0.1, 30], [200, 0, 30]])
    assert (_merge_short_legs(ends, rules) == ends).all()  # take-off and landing stay where they are
