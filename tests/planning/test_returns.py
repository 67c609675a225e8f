"""The way home from every waypoint, the point of no return, and missions that cannot come home."""

from __future__ import annotations

from dataclasses import dataclass, field, replace

import numpy as np
import pytest

from gcs_windplan.errors import BatteryError
from gcs_windplan.flight import fly_legs
from gcs_windplan.flight.energy import leg_energies
from gcs_windplan.jobs.missionfile.airframe import read_airframe
from gcs_windplan.jobs.requests import read_request
from gcs_windplan.planning.cost import CostChoice
from gcs_windplan.planning.planner import plan_route, plan_routes, refuse_unsafe
from gcs_windplan.planning.request import Limits, Site
from gcs_windplan.terrain import Dem
from gcs_windplan.vehicle import air_density
from gcs_windplan.wind import Calm
from tests.ensembles import Everywhere, request

a_graph_path = 1.01  # 16 directions and no shaping: so much longer than straight at most, here along a row


@pytest.fixture
def airframe(gallery):
    return read_airframe(gallery / "vehicles" / "small_quadcopter.yaml")


def landing(airframe, height: float) -> float:
    return float(airframe.power.watts(0.0, -airframe.vehicle.descent, air_density(height))) * 40.0 / 1.5


def with_battery(asked, usable: float):
    """The same with so much [J] to draw when the reserve stays."""
    battery = replace(asked.airframe.battery, capacity=usable / 0.64)
    return replace(asked, airframe=replace(asked.airframe, battery=battery))


@dataclass(frozen=True)
class Freshening:
    """A wind along east that grows from nothing to 6 m/s within 400 s, and holds."""

    times: np.ndarray = field(default_factory=lambda: np.array([0.0, 400.0, 9000.0]))
    name: str = "freshening"
    resolution: float = 1000.0

    def at(self, points, seconds=0.0):
        when = np.broadcast_to(np.asarray(seconds, dtype=float), len(points))
        return np.column_stack([np.interp(when, self.times, [0.0, 6.0, 6.0]), *np.zeros((2, len(points)))])


@pytest.mark.parametrize("wind", [Calm(), Everywhere(5.0), Everywhere(-4.0), Freshening()], ids=lambda w: w.name)
def test_over_flat_ground_it_is_the_straight_flight_and_the_landing(airframe, wind):
    """Each way home flown again leg by leg, in the wind of its own time."""
    asked = request(wind=wind, airframe=airframe, via=(Site("via.0", 0.0, 0.0), Site("via.1", 600.0, 0.0)))
    plan = plan_routes(asked, [asked.cost])[0]
    assert len(plan.waypoints) >= 4
    down = landing(airframe, 40.0)
    assert plan.ways_home.energies[0] == pytest.approx(down)
    for waypoint, energy in zip(plan.waypoints[1:], plan.ways_home.energies[1:], strict=True):
        straight = np.array([[waypoint.east, waypoint.north, waypoint.altitude], [-900.0, 0.0, 40.0]])
        times = fly_legs(straight, wind, asked.vehicle, waypoint.seconds)[1]
        expected = float(leg_energies(straight, times, wind, asked.vehicle, airframe.power).sum())
        assert expected * (1 - 1e-3) <= energy - down <= expected * a_graph_path


def test_the_point_of_no_return_by_hand(airframe):
    """With 5 m/s behind: what is drawn plus what home takes grows linearly, and crosses what may be drawn once."""
    asked = request(wind=Everywhere(5.0), airframe=airframe)
    plan = plan_routes(asked, [asked.cost])[0]
    power = plan.totals.energy / plan.totals.seconds  # level at one airspeed: the same out and back
    drawn = (1 - np.array(plan.battery.left)) * airframe.battery.capacity
    out, back = (drawn[-1] - drawn[0]) / 1800.0, power / 5.0  # [J/m]: the way out as flown, with its start and stop
    fixed = drawn[0] + landing(airframe, 40.0)
    allowed = fixed + 1000.0 * (out + back)
    tight = with_battery(replace(asked, limits=Limits(way_home=False)), allowed)
    found = plan_route(tight).ways_home.point_of_no_return
    assert found.distance == pytest.approx(1000.0, rel=0.01)
    assert found.seconds == pytest.approx(found.distance / 15.0, rel=1e-3)
    assert plan_route(with_battery(asked, fixed + 1900.0 * (out + back))).ways_home.point_of_no_return is None


def test_home_lies_beyond_a_ridge(airframe):
    """A wall between waypoint and home, higher than the limit above its foot allows to step over: around it."""
    heights = np.zeros((61, 61))
    heights[20:41, 30] = 300.0  # at east 0, from south -500 to north 500
    walled = request(wind=Calm(), airframe=airframe, terrain=Dem.local(heights, -1500.0, 1500.0, 50.0), margin=800.0)
    plan, flat = plan_route(walled), plan_route(request(wind=Calm(), airframe=airframe))
    assert plan.ways_home.energies[-1] > 1.1 * flat.ways_home.energies[-1]


def test_the_nearest_rally_point_counts_where_home_is_far(airframe):
    rally = Site("rally.0", 850.0, 100.0, above_ground=40.0)
    asked = request(wind=Everywhere(6.0), airframe=airframe, rally=(rally,), limits=Limits(way_home=True))
    plan = plan_route(asked)
    assert plan.ways_home.alternates[-1] < 0.4 * plan.ways_home.energies[-1]
    needed = plan.battery.total + plan.ways_home.alternates[-1]
    plan_route(with_battery(asked, needed))
    with pytest.raises(BatteryError, match="neither home nor a rally point can be reached with the reserve"):
        plan_route(with_battery(replace(asked, rally=()), needed))


def test_a_mission_that_returns_at_the_end_counts_the_return(airframe):
    asked = request(wind=Everywhere(5.0), airframe=airframe, finish="return")
    plan = plan_routes(asked, [asked.cost])[0]
    totals = plan.totals
    drawn = (1 - plan.battery.left[-1]) * airframe.battery.capacity
    assert drawn > totals.takeoff_energy + totals.energy
    assert plan.battery.total == pytest.approx(drawn + plan.ways_home.energies[-1], rel=1e-9)
    assert plan.ways_home.energies[-1] > 2 * totals.energy  # 5 against 15 m/s over ground
    with pytest.raises(BatteryError, match="breaks the reserve by"):
        plan_route(with_battery(asked, totals.takeoff_energy + totals.energy * 1.5))


def test_wind_that_closes_the_way_back_is_no_way_home(airframe):
    """11 m/s behind and 10 m/s of airspeed: out it goes, but never back."""
    asked = request(wind=Everywhere(11.0), airframe=airframe, limits=Limits(way_home=True))
    with pytest.raises(BatteryError, match="closes every way back"):
        plan_route(asked)
    plan = plan_route(replace(asked, limits=Limits()))
    assert plan.ways_home.energies[-1] == float("inf")
    assert plan.ways_home.point_of_no_return.leg == 1


def test_the_shortest_mission_cannot_return_and_the_thriftiest_does(gallery):
    """There and back in shear: the shortest way flies back too high, against too much wind."""
    asked = read_request(gallery / "shear.yaml")
    shortest, thriftiest = plan_routes(asked, [CostChoice("distance"), CostChoice("energy")])
    between = (shortest.battery.total + thriftiest.battery.total) / 2
    weak = with_battery(asked, between)
    with pytest.raises(BatteryError) as error:
        plan_route(replace(weak, cost=CostChoice("distance")))
    assert "breaks the reserve by" in str(error.value)
    assert "Planned by `energy` it takes" in str(error.value)
    plan = plan_route(weak)
    refuse_unsafe(plan)
    assert plan.battery.total <= between
    home, last = plan.waypoints[0].point, plan.waypoints[-1].point
    assert (last.latitude_deg, last.longitude_deg) == pytest.approx((home.latitude_deg, home.longitude_deg), abs=1e-7)
