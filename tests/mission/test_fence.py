"""Fences and rally points check themselves, become items, and come back from them."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from gcs_windplan.errors import InputError
from gcs_windplan.geo.frame import GeoPoint
from gcs_windplan.mission import (
    Command,
    Fence,
    FenceCircle,
    FencePolygon,
    Frame,
    MissionItem,
    MissionItems,
    RallyPoint,
    ReturnPoint,
    degrees_e7,
    fence_items,
    fence_of,
    rally_items,
    rally_of,
)

from .fences import BACK, FENCE, FIELD, MAST, RALLY, RANGE, WOOD, circles, fences, polygons, rally_points

HERE = GeoPoint(46.8, 9.8)
ITEMS = fence_items(FENCE)


def test_items_come_in_the_order_and_frames_of_qgroundcontrol() -> None:
    """GeoFenceManager.cc: polygons, circles, return point; only the last is relative to home; none continues."""
    commands = [5001] * 4 + [5002] * 3 + [5003, 5004, 5000]
    assert [item.command for item in ITEMS] == commands
    assert [item.params for item in ITEMS] == [
        *[(4.0, 0.0, 0.0, 0.0)] * 4,
        *[(3.0, 0.0, 0.0, 0.0)] * 3,
        (2500.5, 0.0, 0.0, 0.0),
        (80.0, 0.0, 0.0, 0.0),
        (0.0, 0.0, 0.0, 0.0),
    ]
    assert [item.frame for item in ITEMS] == [Frame.GLOBAL] * 9 + [Frame.GLOBAL_RELATIVE_ALT]
    assert [item.altitude for item in ITEMS] == [0.0] * 9 + [40.25]
    assert not any(item.autocontinue for item in ITEMS)


def test_places_travel_as_rounded_integers() -> None:
    assert (ITEMS[5].x, ITEMS[5].y) == (468150000, 98512346)
    assert all(item.has_place for item in ITEMS)
    assert [(item.x, item.y) for item in rally_items(RALLY)] == [(468060000, 98460000), (468266667, 98660000)]


def test_rally_items_keep_frame_and_altitude() -> None:
    high = RallyPoint(HERE, 1800.0, Frame.GLOBAL)
    items = rally_items((*RALLY, high))
    assert [(item.command, item.frame, item.altitude) for item in items] == [
        (5100, 3, 35.0),
        (5100, 3, 52.5),
        (5100, 0, 1800.0),
    ]
    assert not any(item.autocontinue for item in items)


def over_the_wire(item: MissionItem) -> MissionItem:
    """As MISSION_ITEM_INT brings it: integer places."""
    return replace(item, latitude_deg=item.x / 1e7, longitude_deg=item.y / 1e7)


def rounded(point: GeoPoint) -> tuple[int, int]:
    return degrees_e7(point.latitude_deg), degrees_e7(point.longitude_deg)


def substance(fence: Fence | None) -> Any:
    """A fence as far as a vehicle keeps it exactly."""
    assert fence is not None
    back = fence.return_point
    return (
        [(polygon.inclusion, list(map(rounded, polygon.corners))) for polygon in fence.polygons],
        [(circle.inclusion, circle.radius, rounded(circle.centre)) for circle in fence.circles],
        None if back is None else (rounded(back.point), back.altitude),
    )


@given(fences)
def test_a_fence_comes_back_from_its_items(fence: Fence) -> None:
    items = fence_items(fence)
    assert fence_of(items) == fence
    assert substance(fence_of([over_the_wire(item) for item in items])) == substance(fence)


@given(st.lists(polygons(), max_size=3), st.lists(circles, max_size=3), st.randoms())
def test_areas_may_come_in_any_order(areas: list[FencePolygon], rounds: list[FenceCircle], random: Any) -> None:
    parts = [fence_items(Fence((area,))) for area in areas] + [fence_items(Fence((), (circle,))) for circle in rounds]
    random.shuffle(parts)
    read = fence_of([item for part in parts for item in part])
    if not parts:
        assert read is None
    else:
        assert read is not None
        assert sorted(map(repr, read.polygons)) == sorted(map(repr, areas))
        assert sorted(map(repr, read.circles)) == sorted(map(repr, rounds))


@given(st.lists(rally_points, max_size=5).map(tuple))
def test_rally_points_come_back_from_their_items(points: tuple[RallyPoint, ...]) -> None:
    assert rally_of(rally_items(points)) == points


def test_without_a_fence_there_are_no_items() -> None:
    assert fence_items(None) == rally_items(()) == rally_of([]) == ()
    assert fence_of([]) is None


def test_the_deprecated_int_frames_are_plain_ones() -> None:
    """ArduPilot before 4.1 and PX4 send GLOBAL_INT and GLOBAL_RELATIVE_ALT_INT."""
    assert fence_of([replace(item, frame=Frame.GLOBAL_INT) for item in ITEMS]) == FENCE
    assert rally_of([replace(item, frame=6) for item in rally_items(RALLY)]) == RALLY


def changed(index: int, **changes: Any) -> list[MissionItem]:
    return [replace(item, **changes) if i == index else item for i, item in enumerate(ITEMS)]


WAYPOINT = MissionItem(Frame.GLOBAL, Command.NAV_WAYPOINT, latitude_deg=46.8, longitude_deg=9.8)
BROKEN = [
    (list(ITEMS[:3]), "fence item 0: only 3 of its polygon's 4 corners are there"),
    (list(ITEMS[:6]), "fence item 4: only 2 of its polygon's 3 corners are there"),
    (
        list(ITEMS[1:]),
        r"fence item 0: corner 4 of 4 is missing; in its place is NAV_FENCE_POLYGON_VERTEX_EXCLUSION \(3\)",
    ),
    (changed(2, params=(5.0, 0, 0, 0)), r"item 0: corner 3 of 4 is missing; in its place is .*INCLUSION \(5\)"),
    (changed(0, params=(2.0, 0, 0, 0)), "item 0: its number of corners, 2, is not a whole number of at least 3"),
    (changed(4, params=(math.nan, 0, 0, 0)), "item 4: its number of corners, nan, is not"),
    (changed(4, params=(3.5, 0, 0, 0)), "item 4: its number of corners, 3.5, is not"),
    (changed(0, params=(1e9, 0, 0, 0)), "item 0: corner 2 of 1000000000 is missing"),
    (changed(1, latitude_deg=46.79, longitude_deg=9.85), "item 0: a fence polygon of 4 corners is no simple polygon"),
    (changed(7, params=(0.0, 0, 0, 0)), "item 7: the radius 0 m of a fence circle is not a positive number"),
    (changed(7, params=(math.nan, 0, 0, 0)), "item 7: the radius nan m"),
    (changed(7, params=(5.0, 1.0, 0, 0)), "item 7: it belongs to the inclusion group 1; neither"),
    (changed(6, frame=Frame.MISSION), "item 4: MISSION is not a frame of latitudes and longitudes"),
    ([*ITEMS, ITEMS[-1]], "item 10: it is a second return point, and a fence has one at most"),
    ([*ITEMS, WAYPOINT], "item 10: NAV_WAYPOINT does not belong to a fence"),
]


@pytest.mark.parametrize(("items", "message"), BROKEN, ids=lambda value: value[:40] if isinstance(value, str) else "")
def test_items_that_are_no_fence_are_refused_by_number(items: list[MissionItem], message: str) -> None:
    with pytest.raises(InputError, match=message):
        fence_of(items)


def test_items_that_are_no_rally_points_are_refused_by_number() -> None:
    good = rally_items(RALLY)
    with pytest.raises(InputError, match="rally item 2: NAV_WAYPOINT is no rally point"):
        rally_of([*good, WAYPOINT])
    with pytest.raises(
        InputError, match=r"rally item 1: the rally point at .* is in MISSION, which is no place on Earth"
    ):
        rally_of([good[0], replace(good[1], frame=Frame.MISSION)])


SQUARE = ((46.8, 9.8), (46.9, 9.8), (46.9, 9.9), (46.8, 9.9))


@pytest.mark.parametrize(
    ("places", "message"),
    [
        (SQUARE[:2], "at least 3 corners, not 2"),
        ((), "at least 3 corners, not 0"),
        (
            [SQUARE[i] for i in (0, 2, 1, 3)],
            r"4 corners is no simple polygon \(Self-intersection at 46.8500000, 9.8500000\)",
        ),
        ([(46.8, 9.8), (46.9, 9.9), (46.85, 9.85)], "no simple polygon"),
        ([(46.8, 9.8), (46.80000001, 9.8), (46.8, 9.80000001)], "no simple polygon"),  # one place in 1e-7 degrees
        ([*SQUARE, (46.85, 9.75), (46.85, 9.95)], "no simple polygon"),
    ],
)
def test_a_polygon_that_encloses_no_one_area_is_refused(places: Any, message: str) -> None:
    with pytest.raises(InputError, match=message):
        FencePolygon(tuple(GeoPoint(*place) for place in places))


def test_polygons_may_be_closed_bent_and_lie_across_the_date_line() -> None:
    corners = tuple(GeoPoint(*place) for place in SQUARE)
    assert FencePolygon((*corners, corners[0])).inclusion
    assert FencePolygon((*corners, GeoPoint(46.85, 9.88)))
    FencePolygon((GeoPoint(-17, 179.9), GeoPoint(-17, -179.9), GeoPoint(-17.1, -179.9), GeoPoint(-17.1, 179.9)))


@pytest.mark.parametrize("radius", [0.0, -5.0, math.inf, math.nan])
def test_a_circle_needs_a_radius(radius: float) -> None:
    with pytest.raises(InputError, match="is not a positive number"):
        FenceCircle(HERE, radius)


def test_what_lies_nowhere_is_refused() -> None:
    with pytest.raises(InputError, match="latitude nan is not between"):
        FenceCircle(GeoPoint(math.nan, 9.8), 50.0)
    with pytest.raises(InputError, match="altitude nan of the fence's return point is not finite"):
        ReturnPoint(HERE, math.nan)
    with pytest.raises(InputError, match=r"altitude inf of the rally point at 46.8000000, 9.8000000 is not finite"):
        RallyPoint(HERE, math.inf)
    with pytest.raises(InputError, match="the fence is empty: give it an area, or leave it out"):
        Fence()


def test_a_return_point_alone_is_a_fence() -> None:
    """ArduPlane's own tests upload one."""
    assert fence_of(fence_items(Fence((), (), BACK))) == Fence((), (), BACK)


def test_a_mission_can_leave_its_fence_behind() -> None:
    mission = MissionItems((WAYPOINT,), fence=Fence((FIELD, WOOD), (RANGE, MAST)), rally=RALLY)
    assert mission.without_fence() == MissionItems((WAYPOINT,))
    assert repr(mission) == "<Mission of 1 items, no home, a fence, 2 rally points>"
