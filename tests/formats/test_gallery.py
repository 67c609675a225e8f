"""Every mission of the gallery: it plans, keeps its limits, and its files are read alike by everyone."""

from __future__ import annotations

import math
from collections.abc import Callable
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from gcs_windplan.formats import read_plan, read_waypoints, write_plan, write_waypoints
from gcs_windplan.mission import Command, MissionItems, fence_items, rally_items
from gcs_windplan.planning.export import mission_of
from tests.oracles.fences import breaches
from tests.plans import planned

MISSIONS = sorted((Path(__file__).resolve().parents[2] / "missions").glob("*.yaml"))
FENCED = [path for path in MISSIONS if "fence: true" in path.read_text()]
one_millimetre = 1e-3


@pytest.mark.parametrize("path", MISSIONS, ids=lambda path: path.stem)
class TestGallery:
    def test_says_what_it_shows(self, path: Path):
        head = path.read_text().splitlines()
        assert sum(line.startswith("#") for line in head) >= 2
        assert "synthetic" in path.read_text()

    def test_keeps_its_limits(self, path: Path):
        plan = planned(path.stem)
        request = plan.request
        points = np.array([(w.east, w.north, w.altitude) for w in plan.waypoints])
        share = np.linspace(0, 1, 2000)[:, None]
        for a, b in pairwise(points):
            along = a + share * (b - a)
            above = along[:, 2] - request.scene.terrain.heights_at(along)
            assert above.min() >= request.clearance - one_millimetre
            assert above.max() <= (request.max_height or math.inf) + one_millimetre
        assert not request.scene.airspace.breaches(points[:-1], points[1:]).any()
        if request.scene.obstacles is not None:
            assert (request.scene.obstacles.leg_margins(points[:-1], points[1:]) >= -one_millimetre).all()
        assert plan.cost <= plan.graph_cost * (1 + 1e-12)

    def test_speeds_follow_the_plan(self, path: Path):
        """Each leg is flown at the ground speed last commanded before it, or within 0.1 m/s of it."""
        plan = planned(path.stem)
        commanded, flown = None, []
        for item in mission_of(plan).items:
            if item.command == Command.DO_CHANGE_SPEED:
                assert item.params[0] == 1  # SPEED_TYPE_GROUNDSPEED
                commanded = item.params[1]
            elif item.command == Command.NAV_WAYPOINT:
                flown.append(commanded)
        assert len(flown) == len(plan.legs)
        level = [(a, leg.ground_speed) for a, leg in zip(flown, plan.legs, strict=True) if leg.distance >= 1.0]
        assert max(abs(a - b) for a, b in level) <= 0.11

    def test_altitudes_and_places_are_the_plans(self, path: Path):
        plan = planned(path.stem)
        mission = mission_of(plan)
        assert mission.home is not None
        route = [item for item in mission.items if item.command == Command.NAV_WAYPOINT]
        for item, waypoint in zip(route, plan.waypoints[1:], strict=True):
            assert item.lat_e7 == round(waypoint.point.latitude_deg * 1e7)
            assert item.lon_e7 == round(waypoint.point.longitude_deg * 1e7)
            above_home = waypoint.altitude - mission.home.altitude
            # ArduPilot takes 0 for "as high as now": a plan's 0 is written as 2 cm
            slack = 0.02 if abs(above_home) < 0.02 else one_millimetre
            assert item.altitude == pytest.approx(above_home, abs=slack)
        home = np.array([[plan.waypoints[0].east, plan.waypoints[0].north]])
        assert mission.home.altitude == pytest.approx(float(plan.request.scene.terrain.heights_at(home)[0]))

    def test_files_are_read_alike_by_everyone(
        self, path: Path, tmp_path: Path, mavwp_load: Callable[[Path], list[Any]], mission_raw: Any
    ):
        mission = mission_of(planned(path.stem))
        sheet, plan = tmp_path / "m.waypoints", tmp_path / "m.plan"
        write_waypoints(mission.without_fence(), sheet)
        write_plan(mission, plan)
        ours = [_row(item) for item in mission.items]
        for read in (read_waypoints(sheet), read_plan(plan)):
            assert read.repairs == ()
            assert _agree(ours, [_row(item) for item in read.mission.items])
        assert _agree(ours, [_their_row(w.command, w.frame, w, w.x, w.y, w.z) for w in mavwp_load(sheet)[1:]])
        by_planner = mission_raw.import_mission_planner_mission(str(sheet)).mission_items[1:]
        by_ground_control = mission_raw.import_qgroundcontrol_mission(str(plan))
        for theirs in (by_planner, by_ground_control.mission_items):
            assert _agree(ours, [_their_row(w.command, w.frame, w, w.x / 1e7, w.y / 1e7, w.z) for w in theirs])
        back = read_plan(plan).mission
        for items, read, imported in (
            (fence_items(mission.fence), fence_items(back.fence), by_ground_control.geofence_items),
            (rally_items(mission.rally), rally_items(back.rally), by_ground_control.rally_items),
        ):
            assert _agree([_row(item) for item in items], [_row(item) for item in read])
            theirs = [_their_row(w.command, w.frame, w, w.x / 1e7, w.y / 1e7, w.z) for w in imported]
            assert _agree([_row(item) for item in items], theirs)


@pytest.mark.parametrize("path", FENCED, ids=lambda path: path.stem)
def test_a_route_keeps_to_its_own_fence(path: Path):
    """Along every leg and at the rally points, as the autopilots themselves test the uploaded items."""
    plan = planned(path.stem)
    mission = mission_of(plan)
    fence = fence_items(mission.fence)
    assert fence
    points = np.array([(w.east, w.north) for w in plan.waypoints])
    share = np.linspace(0, 1, 400)[:, None]
    flown = np.concatenate([a + share * (b - a) for a, b in pairwise(points)])
    places = list(zip(*plan.request.scene.frame.to_geographic(flown), strict=True))
    places += [(rally.point.latitude_deg, rally.point.longitude_deg) for rally in mission.rally]
    assert not [(place, broken) for place in places if (broken := breaches(fence, *place))]


def _row(item) -> tuple[float, ...]:
    return (item.command, item.frame, *item.params, item.lat_e7, item.lon_e7, item.altitude)


def _their_row(command, frame, item, latitude, longitude, altitude) -> tuple[float, ...]:
    places = round(latitude * 1e7), round(longitude * 1e7)
    return (command, frame, item.param1, item.param2, item.param3, item.param4, *places, altitude)


def _agree(ours: list[tuple[float, ...]], theirs: list[tuple[float, ...]]) -> bool:
    """Equal command, frame and 1e7 integers; parameters and altitudes as far as float32 keeps them; NaN equals NaN."""
    return len(ours) == len(theirs) and all(
        np.array_equal(a[:2], b[:2]) and a[6:8] == b[6:8] and np.allclose(a[2:], b[2:], atol=1e-3, equal_nan=True)
        for a, b in zip(ours, theirs, strict=True)
    )


def test_the_gallery_is_whole():
    names = {path.stem for path in MISSIONS}
    assert names >= {
        "paper_case1",
        "paper_case2",
        "paper_case3",
        "jacksboro",
        "village",
        "keep_out",
        "inspection",
        "front",
        "rounds",
    }
    assert isinstance(mission_of(planned(MISSIONS[0].stem)), MissionItems)


def test_a_mission_of_the_gallery_has_a_fence_and_rally_points():
    """Areas with `fence: true` and no other; rally points at whole metres above home, not below what was planned."""
    plan = planned("keep_out")
    mission = mission_of(plan)
    assert mission.fence is not None
    assert [(len(p.corners), p.inclusion) for p in mission.fence.polygons] == [(5, False), (4, True)]
    assert [(c.radius, c.inclusion) for c in mission.fence.circles] == [(350.0, False)]
    terrain = plan.request.scene.terrain
    for rally, site in zip(mission.rally, plan.request.rally, strict=True):
        ground = float(terrain.heights_at(np.array([[site.east, site.north]]))[0])
        planned_height = ground + 200 * 0.3048 - mission.home.altitude
        assert rally.altitude == math.ceil(planned_height)
    assert len(mission.rally) == 2
    inside = mission.fence.polygons[0].corners  # the middle of the reserve is where the fence must speak up
    middle = [sum(getattr(c, name) for c in inside) / 5 for name in ("latitude_deg", "longitude_deg")]
    assert breaches(fence_items(mission.fence), *middle) == ["polygon at item 0"]
    assert "the fence holds 'permitted area' in plan only" in " ".join(plan.notes)
