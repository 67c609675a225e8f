"""Fence and rally points in the mission file: what the request holds, and that the route can keep to its fence."""

from __future__ import annotations

import math
from dataclasses import replace
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import gcs_windplan as gw
from gcs_windplan.errors import InputError, MissionFileError, RequestError
from gcs_windplan.geo.frame import GeoPoint, LocalFrame
from gcs_windplan.jobs.areas import Area, fence_area_of, prism_of
from gcs_windplan.jobs.missionfile.areas import AreaModel
from gcs_windplan.jobs.missionfile.mission import area_of
from gcs_windplan.jobs.requests import read_request
from gcs_windplan.mission import Fence, FenceCircle, FencePolygon, Frame, fence_items
from gcs_windplan.planning.export import mission_of
from gcs_windplan.planning.planner import plan_route
from gcs_windplan.planning.request import FenceArea, Request, Site, Uniform
from gcs_windplan.scene import Airspace, Prism, Scene
from gcs_windplan.terrain import Dem
from gcs_windplan.vehicle import Vehicle
from gcs_windplan.wind import Calm
from tests.oracles.fences import breaches
from tests.scenes import changed

from .missions import FIELDS, complaints, mission

GROUND = "{surface: {size: 4 km, cell: 50 m}, origin: {latitude: 47.0, longitude: 9.0, altitude: 600}}"
SQUARE = "{east_north: [[-900, -900], [900, -900], [900, 900], [-900, 900]]}"
FENCED = f"[{{name: field, polygon: {SQUARE}, fence: true}}]"
WORLD = {
    **FIELDS,
    "terrain": GROUND,
    "start": "{east: -700, north: -700}",
    "goal": "{east: 700, north: 700}",
    "graph": "{uniform: {spacing: 100}}",
    "limits": f"{{keep_in: {FENCED}}}",
}
one_millimetre = 1e-3


def areas(keep_out: str = "[]", keep_in: str = FENCED) -> str:
    """The limits of a mission file with these areas."""
    return f"{{keep_out: {keep_out}, keep_in: {keep_in}}}"


def asked(folder: Path, **fields: str | None) -> Request:
    path = folder / "m.yaml"
    path.write_text(mission(**{**WORLD, **fields}))
    return read_request(path)


def refusals(folder: Path, **fields: str | None) -> list[str]:
    with pytest.raises(RequestError) as caught:
        plan_route(asked(folder, **fields))
    return [str(problem).removeprefix(f"{folder / 'm.yaml'}:") for problem in caught.value.problems]


def test_areas_become_the_fence_only_where_they_are_marked(tmp_path: Path) -> None:
    request = asked(
        tmp_path,
        limits=areas(
            "[{name: mast, circle: {east: 0, north: 0, radius: 80}, fence: true},"
            " {name: field, circle: {east: 500, north: 0, radius: 80}}]"
        ),
    )
    mast, field = request.fence
    assert (mast.name, mast.radius, mast.inclusion, mast.heights_lost) == ("mast", 80.0, False, False)
    assert mast.places.tolist() == [[0.0, 0.0]]
    assert (field.name, field.radius, field.inclusion) == ("field", None, True)
    assert field.places.tolist() == [[-900, -900], [900, -900], [900, 900], [-900, 900]]
    assert [len(request.scene.airspace.keep_out), len(request.scene.airspace.keep_in)] == [2, 1]


def test_the_mission_carries_fence_return_point_and_rally_points(tmp_path: Path) -> None:
    request = asked(
        tmp_path,
        limits=areas("[{name: mast, circle: {latitude: 47.001, longitude: 9.0015, radius: 80}, fence: true}]"),
        fence="{return_point: {east: -600, north: -600, height: 45}}",
        rally="[{latitude: 47.0012345, longitude: 8.9976543}, {east: 400, north: 500, altitude: 655.5}]",
    )
    mission = mission_of(plan_route(request))
    assert mission.home is not None
    assert mission.home.altitude == pytest.approx(600.0)
    assert mission.fence is not None
    (circle,) = mission.fence.circles
    assert (circle.radius, circle.inclusion) == (80.0, False)
    assert (circle.centre.latitude_deg, circle.centre.longitude_deg) == pytest.approx((47.001, 9.0015), abs=1e-9)
    (polygon,) = mission.fence.polygons
    assert (len(polygon.corners), polygon.inclusion) == (4, True)
    assert request.scene.frame.to_local(polygon.corners[2].latitude_deg, polygon.corners[2].longitude_deg)[0] == (
        pytest.approx([900, 900], abs=one_millimetre)
    )
    assert mission.fence.return_point is not None
    assert mission.fence.return_point.altitude == pytest.approx(45.0)
    first, second = mission.rally
    assert (first.point.latitude_deg, first.point.longitude_deg) == pytest.approx((47.0012345, 8.9976543), abs=1e-9)
    assert first.frame == second.frame == Frame.GLOBAL_RELATIVE_ALT
    assert (first.altitude, second.altitude) == (48, 56)  # the lowest layer, 30 + 0.2 · 90 m; 55.5 m, not cut to 55


def test_px4_keeps_fractions_of_a_metre(tmp_path: Path) -> None:
    request = asked(
        tmp_path, vehicle="{airspeed: 12, autopilot: px4}", rally="[{east: 400, north: 500, altitude: 655.5}]"
    )
    (rally,) = mission_of(plan_route(request)).rally
    assert rally.altitude == pytest.approx(55.5)


def test_without_marks_there_is_no_fence(tmp_path: Path) -> None:
    request = asked(tmp_path, limits=f"{{keep_in: [{{name: field, polygon: {SQUARE}}}]}}")
    assert (request.fence, request.rally, request.fence_return) == ((), (), None)
    mission = mission_of(plan_route(request))
    assert (mission.fence, mission.rally) == (None, ())


def test_a_keep_in_with_heights_is_held_in_plan_and_the_pilot_is_told(tmp_path: Path) -> None:
    request = asked(tmp_path, limits=areas(keep_in=f"[{{name: field, polygon: {SQUARE}, ceiling: 900, fence: true}}]"))
    plan = plan_route(request)
    (note,) = plan.notes
    assert note == (
        "the fence holds 'field' in plan only, without floor and ceiling: set the vehicle's own limits of altitude."
    )


def test_what_cannot_reach_the_vehicle_is_refused() -> None:
    square = "[[36.4, -84.4], [36.4, -84.1], [36.7, -84.1], [36.7, -84.4]]"
    fenced = f"[{{name: a, polygon: {square}, fence: true}}]"
    rally = "[{latitude: 36.5, longitude: -84.3}]"
    line = "8:16: export.plan: fence and rally points fit only into a .plan file: leave this out"
    assert complaints(mission(limits=areas(keep_in=fenced), export="{plan: false}")) == [line]
    assert complaints(mission(rally=rally, export="{plan: false}")) == [line]
    corners = [[36.5 + 0.1 * math.cos(a), -84.3 + 0.1 * math.sin(a)] for a in np.linspace(0, 2 * math.pi, 256)]
    many = {"limits": f"{{keep_in: [{{name: a, polygon: {[*corners, [36.5, -84.3]]}, fence: true}}]}}"}
    text = "257 corners are more than the 255 of ArduPilot's fence polygons: simplify it"
    assert complaints(mission(**many)) == [f"7:39: limits.keep_in.0.polygon: {text}"]
    assert complaints(mission(**many, vehicle="{airspeed: 9, autopilot: px4, speed: 5}")) == [
        "2:40: vehicle.speed: unknown field; did you mean 'airspeed'?"  # and nothing of the fence
    ]


@pytest.mark.parametrize(
    ("rally", "line"),
    [
        ("{east: 2500, north: 0}", "lies 0.50 km outside of the terrain (flat ground): move it or add a tile"),
        (
            "{east: 898, north: 0}",
            "lies where 'field' forbids it: move the site",
        ),  # inside the fence, within its margin
        ("{east: 0, north: 60}", "lies where 'mast' forbids it: move the site"),
        ("{east: 0, north: 300, altitude: 610}", "is 10.0 m above ground, less than the clearance of 30 m"),
        ("{east: 0, north: 300, altitude: 590}", "lies 10.0 m below the ground (600.0 m above sea level there)"),
        ("{east: -300, north: 0, height: 60}", "the way straight up from the ground there crosses 'wires'"),
    ],
)
def test_rally_points_lie_inside_the_fence_and_over_known_ground(tmp_path: Path, rally: str, line: str) -> None:
    places = (
        "[{name: mast, circle: {east: 0, north: 0, radius: 80}, fence: true},"
        " {name: wires, circle: {east: -300, north: 0, radius: 50}, ceiling: 630}]"
    )
    (found,) = refusals(tmp_path, limits=areas(places), rally=f"[{rally}]")
    assert found.startswith(f"9:9: rally.0: {line}")


def test_the_return_point_lies_inside_the_fence_too(tmp_path: Path) -> None:
    (found,) = refusals(tmp_path, fence="{return_point: {east: 0, north: 950}}")
    assert found.startswith("9:23: fence.return_point: lies where 'field' forbids it")


def test_a_fixed_wing_circles_over_its_rally_point_and_does_not_land(tmp_path: Path) -> None:
    wires = "[{name: wires, circle: {east: -300, north: 0, radius: 50}, ceiling: 630}]"
    plane = {"vehicle": "{airspeed: 12, type: fixed-wing}", "limits": areas(wires), "finish": "hold"}
    plan = plan_route(asked(tmp_path, **plane, rally="[{east: -300, north: 0, height: 60}]"))
    assert len(mission_of(plan).rally) == 1


def test_the_flight_back_to_a_rally_point_is_looked_at_too(tmp_path: Path) -> None:
    wall = "[{name: wall, polygon: {east_north: [[0, 200], [850, 200], [850, 260], [0, 260]]}}]"
    fields = {"limits": areas(wall), "finish": "return", "start": "{east: -700, north: 700}"}
    good = asked(tmp_path, **fields, rally="[{east: -600, north: 600}]")
    notes = plan_route(good).notes
    assert "at the end the vehicle returns to the rally point nearest to it, or home if that is nearer." in notes
    (found,) = refusals(tmp_path, **fields, rally="[{east: -600, north: 600}, {east: 500, north: 0}]")
    text = "the straight flight from the goal to it breaks 'wall': land at the goal instead"
    assert found.endswith(f"rally.1: {text}")


def test_terrain_is_read_as_far_as_the_rally_points_lie(tmp_path: Path) -> None:
    path = tmp_path / "m.yaml"
    rally = "[{latitude: 36.65, longitude: -84.1}]"  # 16 km east of the route
    path.write_text(mission(rally=rally))
    with_rally = read_request(path)
    place = with_rally.scene.frame.to_local(36.65, -84.1)
    assert np.isfinite(with_rally.scene.terrain.heights_at(place)).all()
    assert with_rally.scene.terrain.extent.misses(*place[0]) == 0
    path.write_text(mission(rally="[{latitude: 36.65, longitude: -83.0}]"))
    with pytest.raises(RequestError, match=r"7:9: rally\.0: lies .* km outside of the terrain"):
        plan_route(read_request(path))


def test_a_rally_point_on_another_continent_is_a_slip(tmp_path: Path) -> None:
    path = tmp_path / "m.yaml"
    path.write_text(mission(rally="[{latitude: 36.5, longitude: 84.3}]"))
    with pytest.raises(MissionFileError, match=r"7:9: rally\.0: lies \d+ km from the start"):
        read_request(path)


def circle_area(frame: LocalFrame, radius: float, margin: float, fence: bool = True) -> Area:
    here = {"latitude": frame.origin.latitude_deg, "longitude": frame.origin.longitude_deg, "radius": radius}
    return area_of(AreaModel.model_validate({"name": "a", "circle": here, "margin": margin, "fence": fence}))


def border(prism: Prism, pieces: int = 7) -> np.ndarray[Any, Any]:
    """Places along the whole border."""
    share = np.arange(pieces)[:, None] / pieces
    sides = zip(prism.corners, np.roll(prism.corners, -1, axis=0), strict=True)
    return np.concatenate([a + share * (b - a) for a, b in sides])


def fence_of_area(area: FenceArea, frame: LocalFrame) -> Fence:
    points = tuple(GeoPoint(float(a), float(b)) for a, b in zip(*frame.to_geographic(area.places), strict=True))
    if area.radius is not None:
        return Fence((), (FenceCircle(points[0], area.radius, area.inclusion),))
    return Fence((FencePolygon(points, area.inclusion),))


def breaches_along(area: Area, frame: LocalFrame, keep_out: bool) -> list[Any]:
    """What the autopilots break who fly along the very border that the planner keeps to."""
    items = fence_items(fence_of_area(fence_area_of(area, frame, keep_out), frame))
    places = zip(*frame.to_geographic(border(prism_of(area, frame, keep_out))), strict=True)
    return [(place, broken) for place in places if (broken := breaches(items, *place))]


frames = st.builds(LocalFrame, st.builds(GeoPoint, st.floats(-80, 80), st.floats(-179, 179)))


@settings(max_examples=60, deadline=None)
@given(frames, st.floats(30, 20_000), st.floats(2, 20), st.booleans())
def test_circles_hold_by_the_metre_of_every_autopilot(frame: LocalFrame, radius: float, margin: float, out: bool):
    """ArduPilot and PX4 measure up to 0.7 % too far or too short; the route keeps to both."""
    area = circle_area(frame, radius, margin)
    assert breaches_along(area, frame, out) == []
    distances = np.hypot(*border(prism_of(area, frame, out)).T)
    room = margin + 0.007 * radius
    assert (distances >= radius + room - 1e-6).all() if out else (distances <= radius - room + 1e-6).all()
    assert np.abs(distances - radius).max() <= room + max(0.5, 0.02 * radius) + 1e-6


def test_the_autopilots_metres_matter() -> None:
    """On the equator ArduPilot measures 1000 m northwards as 1006.7: the margin of 5 m alone would break the fence."""
    frame = LocalFrame(GeoPoint(0.0, 10.0))
    items = fence_items(Fence((), (FenceCircle(frame.origin, 1000.0),)))
    (latitude,), (longitude,) = frame.to_geographic(np.array([[0.0, 995.0]]))
    assert breaches(items, latitude, longitude) == [
        "circle at item 0 by ardupilot_distance",
        "circle at item 0 by px4_distance",
    ]


@pytest.mark.parametrize("out", [True, False], ids=["keep-out", "keep-in"])
@pytest.mark.parametrize("latitude", [-65.0, 3.0, 47.0, 65.0])
def test_long_sides_hold_where_the_autopilots_see_them(latitude: float, out: bool) -> None:
    """Sides straight in latitude and longitude: 60 km along 65° bow 151 m off the straight line on the ground."""
    frame = LocalFrame(GeoPoint(latitude, 9.0))
    wide = 60_000 / (111_320 * math.cos(math.radians(latitude))) / 2
    corners = [
        (latitude + n, 9.0 + e) for n, e in ((-0.1, -wide), (0.1, -wide), (0.15, 0.2), (0.1, wide), (-0.1, wide))
    ]
    area = area_of(AreaModel.model_validate({"name": "a", "polygon": corners, "margin": 2.0, "fence": True}))
    assert breaches_along(area, frame, out) == []
    if abs(latitude) > 40:
        plain = replace(area, fence=False)
        items = fence_items(fence_of_area(fence_area_of(area, frame, out), frame))
        places = zip(*frame.to_geographic(border(prism_of(plain, frame, out))), strict=True)
        assert any(breaches(items, *place) for place in places)  # corners alone would not do


def test_areas_outside_of_the_fence_stay_as_they_were_drawn() -> None:
    frame = LocalFrame(GeoPoint(47.0, 9.0))
    corners = ((46.9, 8.0), (46.9, 10.0), (47.1, 10.0), (47.1, 8.0))
    area = area_of(AreaModel.model_validate({"name": "a", "polygon": corners, "margin": 0.0}))
    places = np.array(corners)
    assert prism_of(area, frame, True).corners == pytest.approx(frame.to_local(places[:, 0], places[:, 1]))
    ring = prism_of(circle_area(frame, 100.0, 0.0, fence=False), frame, False)
    assert np.hypot(*ring.corners.T) == pytest.approx(100.0)


def test_a_circle_narrower_than_its_margin(tmp_path: Path) -> None:
    limits = "{keep_in: [{name: a, circle: {east: 0, north: 0, radius: 5}}], max_height: 99}"
    with pytest.raises(MissionFileError, match=r"8:38: limits\.keep_in\.0\.circle: area 'a' is too narrow"):
        asked(tmp_path, clearance="30", limits=limits)


def test_a_fence_across_the_date_line_is_refused() -> None:
    frame = LocalFrame(GeoPoint(-17.0, 179.9))
    corners = [(-17.1, 179.7), (-17.1, -179.9), (-16.9, -179.9), (-16.9, 179.7)]
    area = area_of(AreaModel.model_validate({"name": "reef", "polygon": corners, "fence": True}))
    with pytest.raises(InputError, match="area 'reef' lies across the date line, where no autopilot's fence works"):
        prism_of(area, frame, True)
    assert prism_of(replace(area, fence=False), frame, True).corners.shape == (4, 2)


@settings(max_examples=8, deadline=None)
@given(st.lists(st.tuples(st.integers(-600, 600), st.integers(-600, 600), st.integers(40, 220)), max_size=4))
def test_routes_never_break_their_own_fence(masts: list[tuple[int, int, int]]) -> None:
    """Over flat ground among round keep-outs, inside a square: the uploaded items, tested every few metres."""
    frame = LocalFrame(GeoPoint(47.0, 9.0))
    areas = [
        area_of(
            AreaModel.model_validate({"name": f"{i}", "circle": {"east": e, "north": n, "radius": r}, "fence": True})
        )
        for i, (e, n, r) in enumerate(masts)
        if min(math.hypot(e + 700, n + 700), math.hypot(e - 700, n - 700)) > r + 60
    ]
    square = [[-900, -900], [900, -900], [900, 900], [-900, 900]]
    field = area_of(AreaModel.model_validate({"name": "field", "polygon": {"east_north": square}, "fence": True}))
    request = flat_request(frame)
    request = changed(
        request,
        airspace=Airspace(tuple(prism_of(a, frame, True) for a in areas), (prism_of(field, frame, False),)),
        fence=(*(fence_area_of(a, frame, True) for a in areas), fence_area_of(field, frame, False)),
    )
    try:
        plan = plan_route(request)
    except gw.NoRouteError:
        return
    items = fence_items(mission_of(plan).fence)
    points = np.array([(w.east, w.north) for w in plan.waypoints])
    share = np.linspace(0, 1, 300)[:, None]
    flown = np.concatenate([a + share * (b - a) for a, b in pairwise(points)])
    assert not [place for place in zip(*frame.to_geographic(flown), strict=True) if breaches(items, *place)]


def flat_request(frame: LocalFrame) -> Request:
    return Request(
        name="flat",
        scene=Scene(frame, Dem.local(np.zeros((41, 41)), -1000.0, 1000.0, 50.0), Calm()),
        vehicle=Vehicle(12.0),
        start=Site("start", -700.0, -700.0),
        goal=Site("goal", 700.0, 700.0),
        graph=Uniform(60.0),
        layers=(40.0,),
    )
