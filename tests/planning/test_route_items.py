"""From a route to items, for each autopilot, altitude reference and finish."""

from __future__ import annotations

import itertools
import math
from dataclasses import replace
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from gcs_windplan.errors import InputError
from gcs_windplan.geo.frame import GeoPoint
from gcs_windplan.mission import Command, Frame, Home, MissionItem, MissionItems
from gcs_windplan.planning.route_items import RoutePoint, route_mission

HOME = Home(GeoPoint(46.8134, 9.8437), 1560.0)
ROUTE = (
    RoutePoint(HOME.point, 1600.0),
    RoutePoint(GeoPoint(46.8150, 9.8461), 1642.5, 12.3456),
    RoutePoint(GeoPoint(46.8171, 9.8481), 1650.0, 12.40),  # too near to the last one commanded, 12.35
    RoutePoint(GeoPoint(46.8193, 9.8500), 1633.0, 12.46),
)
a_hundredth = 0.01  # [m/s]
WAYPOINT, SPEED, TAKEOFF = Command.NAV_WAYPOINT, Command.DO_CHANGE_SPEED, Command.NAV_TAKEOFF


def build(route: Any = ROUTE, **wishes: Any) -> MissionItems:
    standard = {
        "autopilot": "ardupilot",
        "vehicle_type": "multicopter",
        "finish": "land",
        "altitude": "relative",
        "speed_changes": True,
        "cruise_speed": 10.0,
        "landing_altitude": 1610.0,
    }
    return route_mission(HOME, route, **{**standard, **wishes})


def commands(mission: MissionItems) -> list[int]:
    return [item.command for item in mission.items]


WISHES = [
    {"autopilot": autopilot, "altitude": altitude, "finish": finish, "speed_changes": speeds}
    for autopilot, altitude, finish, speeds in itertools.product(
        ("ardupilot", "px4"), ("relative", "amsl"), ("land", "return", "hold"), (True, False)
    )
]


@pytest.mark.parametrize("wishes", WISHES, ids=lambda wishes: "-".join(map(str, wishes.values())))
def test_order_frames_and_places(wishes: dict[str, Any]) -> None:
    mission = build(**wishes)
    legs = [SPEED, WAYPOINT, WAYPOINT, SPEED, WAYPOINT] if wishes["speed_changes"] else [WAYPOINT] * 3
    ending = {"land": [Command.NAV_LAND], "return": [Command.NAV_RETURN_TO_LAUNCH], "hold": []}
    assert commands(mission) == [TAKEOFF, *legs, *ending[wishes["finish"]]]
    placed = [item for item in mission.items if item.has_place]
    lower, frame = (1560.0, 3) if wishes["altitude"] == "relative" else (0.0, 0)
    goal_ground = [1610.0] if wishes["finish"] == "land" else []
    assert [item.altitude + lower for item in placed] == [1600.0, 1642.5, 1650.0, 1633.0, *goal_ground]
    assert {item.frame for item in placed} == {frame}
    assert placed[0] is mission.items[0]  # PX4 wants the take-off first
    without = {item.frame for item in mission.items if not item.has_place}
    assert without <= {Frame.MISSION if wishes["autopilot"] == "px4" else Frame.GLOBAL}
    assert (mission.autopilot, mission.home) == (wishes["autopilot"], HOME)


@pytest.mark.parametrize("wishes", WISHES, ids=lambda wishes: "-".join(map(str, wishes.values())))
def test_nan_is_px4s_yaw_and_nothing_else(wishes: dict[str, Any]) -> None:
    for item in build(**wishes).items:
        nan = [math.isnan(param) for param in item.params]
        assert nan == [False, False, False, wishes["autopilot"] == "px4" and item.has_place]


def test_places_keep_full_precision() -> None:
    route = (ROUTE[0], RoutePoint(GeoPoint(46.81234567891, 9.81234567891), 1601.23456, 10.0))
    item = build(route).items[2]
    assert (item.latitude_deg, item.longitude_deg) == (46.81234567891, 9.81234567891)
    assert item.altitude == 1601.23456 - 1560.0


def test_speeds_are_ground_speeds_to_the_hundredth() -> None:
    speeds = [item.params for item in build().items if item.command == SPEED]
    assert speeds == [(1.0, 12.35, -1.0, 0.0), (1.0, 12.46, -1.0, 0.0)]


@given(st.lists(st.floats(0.1, 30), min_size=1, max_size=12))
def test_no_leg_is_flown_a_tenth_off_its_speed(planned: list[float]) -> None:
    points = [RoutePoint(GeoPoint(46.82, 9.85 + n / 1000), 1650.0, speed) for n, speed in enumerate(planned)]
    commanded, flown = math.nan, []
    for item in build((ROUTE[0], *points), finish="hold").items:
        commanded = item.params[1] if item.command == SPEED else commanded
        if item.command == WAYPOINT:
            flown.append(commanded)
    assert flown == pytest.approx(planned, rel=0, abs=0.1 + a_hundredth)


@pytest.mark.parametrize(("moved", "waypoints"), [(0.0, 3), (0.000001, 3), (0.001, 4)])
def test_a_first_point_beside_home_becomes_a_waypoint(moved: float, waypoints: int) -> None:
    start = replace(ROUTE[0], point=GeoPoint(46.8134, 9.8437 + moved))
    mission = build((start, *ROUTE[1:]))
    assert commands(mission).count(WAYPOINT) == waypoints
    if waypoints == 4:
        assert commands(mission)[:3] == [TAKEOFF, WAYPOINT, SPEED]


def test_home_across_the_date_line_is_near() -> None:
    home = Home(GeoPoint(-16.5, 180.0), 10.0)
    route = (RoutePoint(GeoPoint(-16.5, -179.9999999), 50.0),)
    wishes: dict[str, Any] = {"autopilot": "px4", "vehicle_type": "multicopter", "altitude": "amsl"}
    mission = route_mission(home, route, finish="hold", speed_changes=False, **wishes)
    assert commands(mission) == [TAKEOFF]


@pytest.mark.parametrize(("altitude", "height"), [(1560.0, 0.02), (1559.999, 0.02), (1559.9, -0.1)])
def test_ardupilot_is_never_told_to_stay_as_high_as_it_is(altitude: float, height: float) -> None:
    """ArduCopter 4.7 takes a relative z = 0 for "keep the present altitude" (seen in its simulator)."""
    route = (ROUTE[0], replace(ROUTE[1], altitude=altitude))
    (waypoint,) = [item for item in build(route).items if item.command == WAYPOINT]
    assert waypoint.altitude == pytest.approx(height)


def test_a_fixed_wing_takes_off_with_a_pitch() -> None:
    assert build(vehicle_type="fixed-wing").items[0].params[0] == 15
    assert build().items[0].params[0] == 0


def test_land_is_at_the_last_point() -> None:
    land: MissionItem = build().items[-1]
    assert (land.latitude_deg, land.longitude_deg) == (46.8193, 9.85)
    assert land.altitude == 50.0


@pytest.mark.parametrize(
    ("route", "wishes", "message"),
    [
        ((), {}, "the route has no points"),
        (ROUTE, {"landing_altitude": None}, "the height of the ground there is needed"),
        (ROUTE, {"finish": "crash"}, "finish 'crash' is none of"),
        (ROUTE, {"altitude": "agl"}, "altitude 'agl' is neither"),
        (ROUTE, {"autopilot": "apm"}, "autopilot 'apm' is neither"),
        ((replace(ROUTE[0], altitude=1560.0),), {}, r"begins at 1560\.0 m, not above home at 1560\.0 m"),
        (ROUTE, {"cruise_speed": -1.0}, "cruise speed -1.0 m/s is not a positive number"),
    ],
)
def test_contradictions_are_refused(route: Any, wishes: dict[str, Any], message: str) -> None:
    with pytest.raises(InputError, match=message):
        build(route, **wishes)


@pytest.mark.parametrize("speed", [0.0, -1.0, math.nan, math.inf])
def test_a_route_point_needs_a_speed_that_can_be_flown(speed: float) -> None:
    with pytest.raises(InputError, match=r"is not at least 0\.01 m/s"):
        RoutePoint(HOME.point, 1600.0, speed)
    with pytest.raises(InputError, match="is not finite"):
        RoutePoint(HOME.point, math.nan)
