"""Planning as a whole: routes that hold their promises, and errors that say what to do."""

from __future__ import annotations

import math
from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import gcs_windplan as gw
from gcs_windplan.errors import RequestError
from gcs_windplan.jobs.missionfile.airframe import read_airframe
from gcs_windplan.paper import SampledTest
from gcs_windplan.planning.cost import COSTS
from gcs_windplan.planning.planner import plan_route, plan_routes
from gcs_windplan.planning.request import Limits, Request, Roadmap, Site, Uniform
from gcs_windplan.scene import Airspace, Prism
from gcs_windplan.terrain import Dem
from gcs_windplan.vehicle import Vehicle
from gcs_windplan.wind import Calm, ConstantWind, PowerLaw, ProfileWind
from tests.scenes import in_scene
from tests.worlds import WavyWind, rough_dem

FRAME = gw.LocalFrame(gw.GeoPoint(46.8, 9.8))


def request(dem: Dem, **changes) -> Request:
    start, goal = Site("start", -700.0, -650.0), Site("goal", 720.0, 680.0)
    whole = {
        "name": "test", "frame": FRAME, "terrain": dem, "wind": Calm(), "vehicle": Vehicle(12.0), "start": start,
        "goal": goal, "clearance": 25.0, "max_height": 110.0, "graph": Uniform(60.0), "layers": (40.0, 80.0),
    } | changes  # fmt: skip
    return Request(**in_scene(**whole))


def smallest_height(dem: Dem, plan) -> float:
    """The smallest height over ground along the route, by dense sampling."""
    corners = np.array([(w.east, w.north, w.altitude) for w in plan.waypoints])
    share = np.linspace(0, 1, 8000)[:, None]
    return min(
        float(np.min((a + share * (b - a))[:, 2] - dem.heights_at(a + share * (b - a)))) for a, b in pairwise(corners)
    )


@pytest.mark.parametrize("graph", [Uniform(60.0, 8), Uniform(60.0, 32), Roadmap(nodes=600, seed=2), Roadmap()])
@pytest.mark.parametrize("cost", COSTS)
def test_a_route_keeps_every_limit(graph, cost, gallery):
    dem = rough_dem(4, relief=70.0)
    airframe = read_airframe(gallery / "vehicles" / "large_multirotor.yaml") if cost == "energy" else None
    asked = request(dem, wind=WavyWind(4), graph=graph, cost=gw.CostChoice(cost), airframe=airframe)
    plan = plan_route(asked)
    assert plan.totals.clearance >= 25.0 - 1e-6
    assert plan.totals.height <= 110.0 + 1e-6
    assert smallest_height(dem, plan) == pytest.approx(plan.totals.clearance, abs=0.5)
    assert smallest_height(dem, plan) >= 25.0 - 1e-6
    first, last = plan.waypoints[0], plan.waypoints[-1]
    assert (first.east, first.north) == (-700.0, -650.0)
    assert (last.east, last.north) == (720.0, 680.0)
    assert plan.cost <= plan.graph_cost * (1 + 1e-12)
    assert last.seconds == pytest.approx(plan.totals.seconds)


@settings(max_examples=8, deadline=None)
@given(seed=st.integers(0, 10_000), strength=st.floats(0, 6))
def test_least_time_is_never_slower_than_least_distance(seed, strength):
    asked = request(rough_dem(seed), wind=WavyWind(seed, strength=strength))
    by_time, by_distance = plan_routes(asked, [gw.CostChoice("time"), gw.CostChoice("distance")])
    shaping = 1.03  # it finds the best route near the graph's path, and over rough ground not always the best of all
    assert by_time.totals.seconds <= by_distance.totals.seconds * shaping
    assert by_distance.totals.length <= by_time.totals.length * shaping


def test_in_still_air_over_flat_ground_the_route_is_the_straight_line():
    plan = plan_route(request(rough_dem(1, relief=0.0), layers=(40.0,)))
    straight = math.hypot(1420.0, 1330.0)
    assert len(plan.waypoints) == 2
    assert plan.totals.distance == pytest.approx(straight, abs=1e-6)
    assert plan.totals.seconds == pytest.approx(straight / 12.0)
    assert plan.legs[0].ground_speed == pytest.approx(12.0)


def test_low_in_a_head_wind_high_in_a_tail_wind():
    """Wind that grows with height, over flat ground: the layers are used as a pilot would."""
    dem = rough_dem(1, relief=0.0)
    for blows_from, high in ((180.0, True), (0.0, False)):
        wind = ProfileWind(ConstantWind.from_direction(5.0, blows_from), dem.heights_at, PowerLaw(10.0, 0.25))
        sites = {"start": Site("start", 0.0, -800.0), "goal": Site("goal", 0.0, 800.0)}
        plan = plan_route(request(dem, wind=wind, vehicle=Vehicle(10.0, climb=5.0, descent=5.0), **sites))
        middle = [w.above_ground for w in plan.waypoints[1:-1]]
        if high:
            assert max(middle) == pytest.approx(110.0, abs=1.0)  # up to the limit
        else:
            assert min(middle) == pytest.approx(25.0, abs=1.0)  # down to the clearance
            assert max(middle) <= 40.0 + 1e-6


def test_heading_and_ground_speed_make_good_the_track():
    """Velocity through the air plus wind gives the velocity over ground, leg by leg."""
    wind = ConstantWind.from_direction(6.0, 250.0)
    plan = plan_route(request(rough_dem(2, relief=0.0), wind=wind, layers=(40.0,)))
    for leg in plan.legs:
        heading, track = math.radians(leg.heading_deg), math.radians(leg.track_deg)
        blows = math.radians(250.0 + 180.0)
        east = 12.0 * math.sin(heading) + 6.0 * math.sin(blows)
        north = 12.0 * math.cos(heading) + 6.0 * math.cos(blows)
        assert east == pytest.approx(leg.ground_speed * math.sin(track), abs=0.01)
        assert north == pytest.approx(leg.ground_speed * math.cos(track), abs=0.01)
        assert leg.wind_along == pytest.approx(6.0 * math.cos(blows - track), abs=1e-3)


def test_tracks_are_true_north_at_high_latitude():
    """At 65° and 50 km east of the origin grid north lies 0.96° off true north (sin φ · Δλ)."""
    frame = gw.LocalFrame(gw.GeoPoint(65.0, 20.0))
    heights = np.zeros((21, 21))
    dem = Dem.local(heights, 49_000.0, 1000.0, 100.0)
    sites = {"start": Site("start", 50_000.0, -800.0), "goal": Site("goal", 50_000.0, 800.0)}
    plan = plan_route(request(dem, frame=frame, layers=(40.0,), **sites))
    a, b = plan.waypoints[0].point, plan.waypoints[-1].point
    meridian = (b.longitude_deg - a.longitude_deg) * math.cos(math.radians(65.0))
    expected = math.degrees(math.atan2(meridian, b.latitude_deg - a.latitude_deg))
    assert plan.legs[0].track_deg == pytest.approx(expected % 360, abs=0.02)
    assert plan.legs[0].track_deg == pytest.approx(0.96, abs=0.02)


def test_via_points_are_passed_in_order():
    vias = (Site("via.0", 600.0, -600.0, above_ground=60.0), Site("via.1", -600.0, 600.0))
    plan = plan_route(request(rough_dem(3), via=vias))
    places = [(w.east, w.north) for w in plan.waypoints]
    assert places.index((600.0, -600.0)) < places.index((-600.0, 600.0))
    assert plan.waypoints[places.index((600.0, -600.0))].above_ground == pytest.approx(60.0)


def test_a_keep_out_is_flown_around():
    corners = np.array([[-200.0, -200], [200, -200], [200, 200], [-200, 200]])
    asked = request(rough_dem(1, relief=10.0), airspace=Airspace(keep_out=(Prism("school", corners),)))
    plan = plan_route(asked)
    points = np.array([(w.east, w.north, w.altitude) for w in plan.waypoints])
    assert not asked.scene.airspace.breaches(points[:-1], points[1:]).any()
    assert plan.totals.distance > math.hypot(1420.0, 1330.0) + 10


def test_same_request_same_plan():
    asked = request(rough_dem(5), wind=WavyWind(5))
    assert plan_route(asked).flight == plan_route(asked).flight


@pytest.mark.parametrize(
    ("changes", "field", "text"),
    [
        ({"start": Site("start", -5000.0, 0.0)}, "start", "4.00 km outside of the terrain"),
        ({"goal": Site("goal", 0.0, 0.0, altitude=-20.0)}, "goal", "below the ground"),
        ({"goal": Site("goal", 0.0, 0.0, above_ground=10.0)}, "goal", "less than the clearance"),
        ({"start": Site("start", 0.0, 0.0, above_ground=300.0)}, "start", "above limits.max_height"),
        ({"clearance": 200.0}, "limits.max_height", "is below the clearance of 200 m"),
        ({"layers": (10.0, 80.0)}, "graph.layers.0", "is below the clearance"),
        ({"layers": (80.0, 40.0)}, "graph.layers.1", "layers go upwards"),
        ({"limits": Limits(battery=0.3)}, "limits.battery", "needs vehicle.airframe"),
    ],
)
def test_contradictions_name_their_field(changes, field, text):
    with pytest.raises(RequestError) as caught:
        plan_route(request(rough_dem(1), **changes))
    assert field in [problem.field for problem in caught.value.problems]
    assert text in str(caught.value)


def test_every_contradiction_at_once():
    asked = request(rough_dem(1), start=Site("start", -5000.0, 0.0), goal=Site("goal", 0.0, 5000.0), layers=(1.0,))
    with pytest.raises(RequestError) as caught:
        plan_route(asked)
    assert [problem.field for problem in caught.value.problems] == ["graph.layers.0", "start", "goal"]


def test_take_off_and_landing_columns_are_judged():
    """A keep-out that ends below the site's height still stands in the way straight up."""
    corners = np.array([[-800.0, -750], [-600, -750], [-600, -550], [-800, -550]])
    low = Airspace(keep_out=(Prism("school", corners, 0.0, 30.0),))
    dem = rough_dem(1, relief=0.0)
    with pytest.raises(RequestError, match="straight up from the ground there crosses 'school'") as caught:
        plan_route(request(dem, airspace=low))
    assert [problem.field for problem in caught.value.problems] == ["start"]
    moved = request(dem, airspace=low, start=Site("start", 0.0, -700.0), goal=Site("goal", -700.0, -650.0))
    with pytest.raises(RequestError, match="school"):
        plan_route(moved)
    assert plan_route(replace(moved, finish="hold")).totals.distance > 0


def test_a_return_through_a_hill_is_refused():
    heights = np.zeros((41, 41))
    heights[18:23, 15:26] = 200.0
    dem = Dem.local(heights, -1000.0, 1000.0, 50.0)
    sites = {"start": Site("start", 0.0, -700.0), "goal": Site("goal", 0.0, 700.0)}
    asked = request(dem, finish="return", max_height=None, **sites)
    with pytest.raises(RequestError, match="`return_height` to 225 m") as caught:
        plan_route(asked)
    assert [problem.field for problem in caught.value.problems] == ["finish"]
    assert plan_route(replace(asked, return_height=225.0)).totals.clearance >= 25.0 - 1e-6


@pytest.mark.parametrize(
    ("graph", "field"),
    [
        (Uniform(0.05), "graph.uniform.spacing"),
        (Uniform(50_000.0), "graph.uniform.spacing"),
        (Roadmap(nodes=9_000_000), "graph.prm"),
        (Roadmap(nodes=50_000, radius=3000.0), "graph.prm"),
    ],
)
def test_a_graph_that_does_not_fit_is_refused_before_it_is_laid(graph, field):
    with pytest.raises(RequestError) as caught:
        plan_route(request(rough_dem(1), graph=graph))
    assert [problem.field for problem in caught.value.problems] == [field]


def test_unknown_ground_under_a_site():
    dem = rough_dem(1)
    heights = dem.heights.copy()
    heights[:10] = np.nan
    north = Site("goal", 0.0, 900.0)
    with pytest.raises(RequestError, match="no data there"):
        plan_route(request(Dem.local(heights, -1000.0, 1000.0, 50.0), goal=north))


def test_a_gale_leaves_no_route():
    gale = ConstantWind.from_direction(25.0, 45.0)
    with pytest.raises(gw.NoRouteError, match="wind"):
        plan_route(request(rough_dem(1), wind=gale))


@pytest.mark.parametrize("field", ["airspeed", "climb", "descent"])
@pytest.mark.parametrize("value", [0.0, -1.0, math.nan, math.inf])
def test_speeds_that_cannot_be_flown(field, value):
    with pytest.raises(gw.InputError, match="no speed to fly at"):
        replace(Vehicle(12.0), **{field: value})


def test_waypoints_stay_inside_the_area():
    """Beyond it the wind need not be known: here it is not, and a tail wind just outside beckons."""

    class Corridor(WavyWind):
        def at(self, points, seconds=0.0):
            assert (np.abs(points[:, 0]) <= 100.0 + 1e-6).all(), "asked for wind outside of the area"
            return np.column_stack([np.zeros(len(points)), points[:, 0] / 20.0, np.zeros(len(points))])

    dem = rough_dem(1, relief=0.0)
    sites = {"start": Site("start", 0.0, -700.0), "goal": Site("goal", 0.0, 700.0)}
    plan = plan_route(request(dem, wind=Corridor(1), margin=100.0, layers=(40.0,), graph=Uniform(50.0), **sites))
    assert max(w.east for w in plan.waypoints) == pytest.approx(100.0, abs=5.0)


def test_models_that_flatter_are_noted():
    dem = rough_dem(1, relief=0.0)
    asked = request(dem, wind=ConstantWind.from_direction(7.0, 250.0), vehicle=Vehicle(12.0, speed_model="paper"))
    (note,) = plan_route(replace(asked, layers=(40.0,))).notes
    assert "cross wind for free" in note
    assert "up to 7.0 m/s" in note
    (note,) = plan_route(request(dem, collision_test=SampledTest(), layers=(40.0,))).notes
    assert "thin ridge" in note


def test_plan_has_a_tidy_repr():
    text = repr(plan_route(request(rough_dem(1, relief=0.0), layers=(40.0,))))
    assert text == "PlannedRoute('test', time: 2 waypoints, 1.95 km in 2:42 min, clearance 40.0 m)"


def test_a_return_above_the_height_limit_is_refused():
    """Home on a hill of 150 m, the goal in the plain: the flight back is 190 m above the plain."""
    heights = np.zeros((41, 41))
    heights[20, 5] = 100.0
    dem = Dem.local(heights, -1000.0, 1000.0, 50.0)
    start, goal = Site("start", -750.0, 0.0), Site("goal", 700.0, 0.0)
    with pytest.raises(RequestError, match=r"is \d+\.\d m above ground, more than limits.max_height"):
        plan_route(request(dem, start=start, goal=goal, finish="return", return_height=40.0))
