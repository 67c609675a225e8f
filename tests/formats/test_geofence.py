"""Fences and rally points in .plan files: strict when written, patient when read, and as MAVSDK imports them."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from gcs_windplan.errors import FormatError
from gcs_windplan.formats import format_plan, format_waypoints, parse_plan, read_plan, write_plan
from gcs_windplan.geo.frame import GeoPoint
from gcs_windplan.mission import Fence, Frame, MissionItem, RallyPoint, fence_items, rally_items
from tests.mission.fences import BACK, FENCE, FIELD, MAST, RALLY, RANGE, WOOD, fences, rally_points

from .conftest import MISSIONS, same_number
from .specimens import BUILT, HOME
from .test_corpus import MAVSDK_REFUSES, PLANS, REFUSED, name

FENCED = replace(BUILT["ardupilot-relative-land-speeds"], fence=FENCE, rally=RALLY)
half_a_millimetre = 5e-4
eighth_decimal = 1.1e-8  # [deg] see degrees_text
single_precision = 1e-7  # relative


def on_the_wire(items: tuple[MissionItem, ...]) -> list[tuple[Any, ...]]:
    return [(item.command, item.frame, item.x, item.y, item.params[0]) for item in items]


@given(st.one_of(st.none(), fences), st.lists(rally_points, max_size=4).map(tuple))
def test_fence_and_rally_points_come_back(fence: Fence | None, rally: tuple[RallyPoint, ...]) -> None:
    mission = replace(FENCED, fence=fence, rally=rally)
    read = parse_plan(format_plan(mission))
    assert read.repairs == ()
    back = read.mission
    assert on_the_wire(fence_items(back.fence)) == on_the_wire(fence_items(fence))
    assert [(point.x, point.y) for point in rally_items(back.rally)] == [(p.x, p.y) for p in rally_items(rally)]
    for found, written in zip(back.rally, rally, strict=True):
        above_home = written.altitude - (HOME.altitude if written.frame == Frame.GLOBAL else 0.0)
        assert found.frame == Frame.GLOBAL_RELATIVE_ALT
        assert abs(found.altitude - above_home) <= half_a_millimetre + 1e-9
    if fence is not None and fence.return_point is not None:
        assert back.fence is not None
        assert back.fence.return_point is not None
        assert abs(back.fence.return_point.altitude - fence.return_point.altitude) <= half_a_millimetre


def test_written_as_qgroundcontrol_demands() -> None:
    """Its readers: GeoFenceController.cc, QGCFencePolygon.cc, QGCFenceCircle.cc, RallyPointController.cc."""
    root = json.loads(format_plan(FENCED))
    fence, rally = root["geoFence"], root["rallyPoints"]
    assert sorted(fence) == ["breachReturn", "circles", "polygons", "version"]
    assert fence["version"] == rally["version"] == 2
    first, second = fence["polygons"]
    assert sorted(first) == sorted(second) == ["inclusion", "polygon", "version"]
    assert (first["inclusion"], first["version"], second["inclusion"]) == (True, 1, False)
    corners = [[46.8, 9.84], [46.83, 9.84], [46.83, 9.87], [46.8, 9.87]]
    assert np.asarray(first["polygon"]) == pytest.approx(np.array(corners), abs=eighth_decimal)
    assert fence["circles"][0] == {
        "circle": {"center": [46.815, 9.855], "radius": 2500.5},
        "inclusion": True,
        "version": 1,
    }
    assert fence["breachReturn"] == [46.805, 9.845, 40.25]
    assert sorted(rally) == ["points", "version"]
    points = np.array([[46.806, 9.846, 35], [46.8266667, 9.866, 52.5]])
    assert np.asarray(rally["points"]) == pytest.approx(points, abs=eighth_decimal)
    assert all(len(place) == 2 for polygon in fence["polygons"] for place in polygon["polygon"])


def test_without_a_return_point_there_is_none() -> None:
    root = json.loads(format_plan(replace(FENCED, fence=Fence((FIELD,)))))
    assert sorted(root["geoFence"]) == ["circles", "polygons", "version"]


def test_rally_points_above_ground_have_no_place_in_a_plan() -> None:
    low = RallyPoint(HOME.point, 30.0, Frame.GLOBAL_TERRAIN_ALT)
    with pytest.raises(FormatError, match=r"the rally point at 46\.8134380, 9\.8437720 is 30 m above ground, and"):
        format_plan(replace(FENCED, rally=(low,)))


@pytest.mark.parametrize(
    ("changes", "held"),
    [({"rally": ()}, "a fence"), ({"fence": None}, "rally points"), ({}, "a fence and rally points")],
)
def test_a_waypoints_file_does_not_lose_a_fence_silently(changes: dict[str, Any], held: str) -> None:
    with pytest.raises(FormatError, match=f"cannot hold {held}, and this mission has them: write a .plan file"):
        format_waypoints(replace(FENCED, **changes))
    bare = format_waypoints(FENCED.without_fence())
    assert bare == format_waypoints(BUILT["ardupilot-relative-land-speeds"])


def assert_imported(ours: tuple[MissionItem, ...], theirs: list[Any], mission_type: int) -> None:
    for seq, (item, other) in enumerate(zip(ours, theirs, strict=True)):
        assert (other.seq, other.mission_type) == (seq, mission_type)
        assert (other.command, other.frame, other.x, other.y) == (item.command, item.frame, item.x, item.y)
        assert other.param1 == pytest.approx(item.params[0], rel=single_precision)
        assert other.z == pytest.approx(item.altitude, abs=half_a_millimetre, rel=single_precision)
        assert other.autocontinue == item.autocontinue
        rest = (other.param2, other.param3, other.param4)
        assert all(same_number(a, b, 0) for a, b in zip(item.params[1:], rest, strict=True))


def test_mavsdk_imports_what_we_write(mission_raw: Any, tmp_path: Path) -> None:
    """All but the return point, which MAVSDK 4.1 passes over."""
    path = tmp_path / "fenced.plan"
    write_plan(FENCED, path)
    imported = mission_raw.import_qgroundcontrol_mission(str(path))
    assert_imported(fence_items(FENCE)[:-1], imported.geofence_items, 1)
    assert_imported(rally_items(RALLY), imported.rally_items, 2)
    assert len(imported.geofence_items) == 9
    assert len(imported.rally_items) == 2


def qgc_text(fence: dict[str, Any], rally: dict[str, Any] | None = None) -> str:
    root = json.loads(format_plan(BUILT["px4-relative-land-speeds"]))
    root["geoFence"] = fence
    if rally is not None:
        root["rallyPoints"] = rally
    return json.dumps(root)


DRAWN = {
    "breachReturn": [47.3977, 8.5456, 50],
    "circles": [
        {"circle": {"center": [47.39781011327583, 8.5460037], "radius": 151.95331}, "inclusion": False, "version": 1}
    ],
    "polygons": [
        {
            "inclusion": True,
            "polygon": [
                [47.40171024799682, 8.540160954818305],
                [47.40171024799682, 8.550847048263],
                [47.39377215200317, 8.550846],
            ],
            "version": 1,
        }
    ],
    "version": 2,
}
GATHERED = {"points": [[47.39760, 8.54311, 50], [47.39874, 8.549, 20.5]], "version": 2}


def test_a_plan_as_qgroundcontrol_writes_it_is_read_as_mavsdk_reads_it(mission_raw: Any, tmp_path: Path) -> None:
    path = tmp_path / "drawn.plan"
    path.write_text(qgc_text(DRAWN, GATHERED))
    read = read_plan(path)
    assert read.repairs == ()
    fence = read.mission.fence
    assert fence is not None
    assert fence.return_point is not None
    assert (fence.return_point.point, fence.return_point.altitude) == (GeoPoint(47.3977, 8.5456), 50.0)
    imported = mission_raw.import_qgroundcontrol_mission(str(path))
    assert_imported(fence_items(replace(fence, return_point=None)), imported.geofence_items, 1)
    assert_imported(rally_items(read.mission.rally), imported.rally_items, 2)
    assert [item.command for item in imported.geofence_items] == [5001] * 3 + [5004]


@pytest.mark.parametrize("path", [path for path in PLANS if path.name not in REFUSED], ids=name)
def test_fences_found_in_the_wild(path: Path, mission_raw: Any) -> None:
    """Against the JSON itself, and MAVSDK where that takes the file."""
    mission = read_plan(path).mission
    drawn = json.loads(path.read_text(encoding="utf-8-sig"))["geoFence"]
    polygons = drawn.get("polygons", [])
    items = fence_items(mission.fence)
    corners = [(corner, polygon) for polygon in polygons for corner in polygon["polygon"]]
    assert len(items) == len(corners) + len(drawn.get("circles", []))
    for item, ((latitude, longitude), polygon) in zip(items, corners, strict=True):
        assert item.command == (5001 if polygon["inclusion"] else 5002)
        assert item.params[0] == len(polygon["polygon"])
        assert (item.x, item.y) == (round(latitude * 1e7), round(longitude * 1e7))
    if path.name not in MAVSDK_REFUSES:
        imported = mission_raw.import_qgroundcontrol_mission(str(path))
        assert_imported(items, imported.geofence_items, 1)
        assert_imported(rally_items(mission.rally), imported.rally_items, 2)


@pytest.mark.skipif(not PLANS, reason="the shared corpus of missions is not here")
def test_the_fence_of_a_plan_is_read() -> None:
    read = read_plan(MISSIONS / "qgc" / "ce_geofence_rd_2.plan")
    fence = read.mission.fence
    assert fence is not None
    assert [(polygon.inclusion, len(polygon.corners)) for polygon in fence.polygons] == [(True, 4), (False, 4)]
    assert not any("geoFence" in repair or "rally" in repair for repair in read.repairs)
    assert on_the_wire(fence_items(parse_plan(format_plan(read.mission)).mission.fence)) == on_the_wire(
        fence_items(fence)
    )


def polygon(**changes: Any) -> dict[str, Any]:
    whole = {"inclusion": True, "polygon": [[46.8, 9.8], [46.9, 9.8], [46.9, 9.9]], "version": 1}
    return {**whole, **changes}


def circle(radius: Any = 50, center: Any = (46.8, 9.8), **changes: Any) -> dict[str, Any]:
    return {"circle": {"center": center, "radius": radius}, "inclusion": True, "version": 1, **changes}


LEFT_OUT = [
    ("polygons", polygon(polygon=[[46.8, 9.8], [46.9, 9.8]]), "a fence polygon needs at least 3 corners, not 2"),
    ("polygons", polygon(polygon=[[46.8, 9.8], [46.9, 9.9], [46.9, 9.8], [46.8, 9.9]]), "is no simple polygon"),
    ("polygons", polygon(polygon=[[46.8, 9.8], [96.9, 9.9], [46.9, 9.8]]), "latitude 96.9 is not between -90 and 90"),
    ("polygons", polygon(polygon=[[46.8, 9.8], [46.9], [46.9, 9.8]]), "polygon[1] has 1 numbers, not latitude and"),
    ("polygons", polygon(polygon=[[46.8, 9.8], [46.9, "x"], [46.9, 9.8]]), "polygon[1][1] is not a number"),
    ("polygons", polygon(polygon=[[46.8, None], [46.9, 9.9], [46.9, 9.8]]), "longitude nan is not between"),
    ("polygons", polygon(polygon=7), "polygon is not an array"),
    ("polygons", polygon(version=2), "version is 2, and only 1 is known"),
    ("polygons", polygon(inclusion=None), "inclusion is neither true nor false"),
    ("polygons", {"polygon": [], "version": 1}, "inclusion is missing"),
    ("polygons", 5, "is not an object"),
    ("circles", circle(radius=0), "the radius 0 m of a fence circle is not a positive number"),
    ("circles", circle(radius="5"), "circle.radius is not a number"),
    ("circles", circle(center=[46.8]), "circle.center has 1 numbers, not latitude and longitude"),
    ("circles", circle(inclusion=1), "inclusion is neither true nor false"),
    ("circles", {"center": [46.8, 9.8], "radius": 5, "inclusion": True}, "circle is missing"),
    ("circles", circle(version=3), "version is 3, and only 1 is known"),
    ("circles", {"circle": [], "inclusion": True}, "circle is not an object"),
]


@pytest.mark.parametrize(("key", "part", "reason"), LEFT_OUT, ids=lambda value: value if isinstance(value, str) else "")
def test_what_cannot_be_used_is_left_out_with_a_reason_and_the_rest_is_read(key: str, part: Any, reason: str) -> None:
    fence = {"circles": [circle()], "polygons": [polygon()], "version": 2}
    fence[key].append(part)  # type: ignore[attr-defined]
    read = parse_plan(qgc_text(fence))
    assert len(read.repairs) == 1
    assert read.repairs[0].startswith(f"geoFence.{key}[1] was left out: ")
    assert reason in read.repairs[0]
    assert read.mission.fence is not None
    assert (len(read.mission.fence.polygons), len(read.mission.fence.circles)) == (1, 1)


@pytest.mark.parametrize(
    ("point", "reason"),
    [
        ([46.8, 9.8], "has 2 numbers, not latitude, longitude and altitude"),
        ([46.8, 9.8, None], "the altitude nan of the rally point at 46.8000000, 9.8000000 is not finite"),
        ([46.8, 190, 5], "longitude 190.0 is not between -180 and 180 degrees"),
        ({"lat": 5}, "is not an array"),
    ],
)
def test_rally_points_that_cannot_be_used_are_left_out_with_a_reason(point: Any, reason: str) -> None:
    read = parse_plan(qgc_text(DRAWN, {"points": [point, [46.8, 9.8, 25]], "version": 2}))
    assert read.repairs == (f"rallyPoints.points[0] was left out: {reason}",)
    assert read.mission.rally == (RallyPoint(GeoPoint(46.8, 9.8), 25.0),)


@pytest.mark.parametrize(
    ("fence", "rally", "repairs"),
    [
        ({"polygon": [], "version": 1}, {"points": [], "version": 1}, ()),
        (
            {"polygon": [[46.8, 9.8]], "breachReturn": [46.8, 9.8], "version": 1},
            {"points": [[46.8, 9.8, 5]]},
            (
                "geoFence is of version 1, and only 2 is known; its polygon and breachReturn were left out",
                "rallyPoints has no version, and only 2 is known; its points were left out",
            ),
        ),
        ({"version": 2}, {"version": 2}, ()),
        ({"circles": None, "polygons": None, "breachReturn": None, "version": 2}, {"points": None, "version": 2}, ()),
        (None, None, ()),
        ([], 5, ("geoFence is not an object; it was left out", "rallyPoints is not an object; it was left out")),
        (
            {"circles": {}, "polygons": [], "version": 2},
            {"points": "x", "version": 2},
            (
                "geoFence.circles is not an array; it was left out",
                "rallyPoints.points is not an array; it was left out",
            ),
        ),
        (
            {"circles": [], "polygons": [], "breachReturn": 5, "version": 2},
            {"points": [], "version": 2},
            ("geoFence.breachReturn was left out: is not an array",),
        ),
    ],
)
def test_other_versions_and_kinds_are_left_out(fence: Any, rally: Any, repairs: tuple[str, ...]) -> None:
    root = json.loads(qgc_text(fence))
    root["rallyPoints"] = rally
    read = parse_plan(json.dumps(root))
    assert read.repairs == repairs
    assert read.mission.fence is None
    assert read.mission.rally == ()


def test_a_plan_without_them_is_one_without_them() -> None:
    root = json.loads(format_plan(FENCED))
    del root["geoFence"], root["rallyPoints"]
    read = parse_plan(json.dumps(root))
    assert (read.repairs, read.mission.fence, read.mission.rally) == ((), None, ())


def test_heights_and_their_absence_are_repaired() -> None:
    tall = polygon(polygon=[[46.8, 9.8, 30], [46.9, 9.8, None], [46.9, 9.9, 1]])
    for back in ([46.85, 9.85], [46.85, 9.85, None]):
        read = parse_plan(qgc_text({"circles": [], "polygons": [tall], "breachReturn": back, "version": 2}))
        assert read.repairs == (
            "heights in the fence were dropped: its areas have none",
            "geoFence.breachReturn has no altitude; it was read as 0 m above home",
        )
        assert read.mission.fence is not None
        assert read.mission.fence.return_point is not None
        assert read.mission.fence.return_point.altitude == 0.0


def test_each_kind_of_part_can_stand_alone() -> None:
    for fence in (Fence((FIELD, WOOD)), Fence((), (RANGE, MAST)), Fence((), (), BACK)):
        back = parse_plan(format_plan(replace(FENCED, fence=fence))).mission.fence
        assert on_the_wire(fence_items(back)) == on_the_wire(fence_items(fence))
