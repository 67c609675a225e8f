"""What a firmware keeps is compared, what it does not keep is a loss, and nothing else passes."""

from __future__ import annotations

import math
from dataclasses import replace

import pytest
from hypothesis import given
from hypothesis import strategies as st

from gcs_windplan.link.comparison import compare_either_way, compare_items
from gcs_windplan.mission import Command, Frame, MissionItem

from .autopilots import PX4, ArduPilot, Refused, Stored

WAYPOINT = MissionItem(3, Command.NAV_WAYPOINT, (2.0, 5.0, 0.0, 90.0), 46.8, 9.8, 61.999)
SPEED = MissionItem(0, Command.DO_CHANGE_SPEED, (1.0, 14.5, -1.0, 0.0))

items = st.builds(
    MissionItem,
    st.sampled_from([0, 3]),
    st.sampled_from([Command.NAV_WAYPOINT, Command.NAV_LAND, Command.NAV_LOITER_TIME, Command.NAV_TAKEOFF]),
    st.tuples(
        st.floats(0, 300, width=32),
        st.integers(0, 5).map(float),
        st.floats(-100, 100, width=32),
        st.floats(0, 359, width=32),
    ),
    st.integers(-900_000_000, 900_000_000).map(lambda e7: e7 / 1e7),
    st.integers(-1_800_000_000, 1_800_000_000).map(lambda e7: e7 / 1e7),
    st.floats(-400, 9000),
)


def kept(item: MissionItem, profile) -> MissionItem:
    """The item as a scripted autopilot gives it back."""
    held = profile.kept(
        Stored(item.command, item.frame, item.params, item.x, item.y, item.altitude, int(item.autocontinue)), 0
    )
    return MissionItem(
        held.frame, held.command, held.params, held.x / 1e7, held.y / 1e7, held.z, bool(held.autocontinue)
    )


@pytest.mark.parametrize("profile", [ArduPilot, PX4])
@given(item=items)
def test_what_the_firmware_makes_of_an_item_is_no_difference(profile, item):
    autopilot = "px4" if profile is PX4 else "ardupilot"
    found = compare_items([item], [kept(item, profile)], autopilot=autopilot, vehicle_type="multicopter")
    assert found.differences == ()


@pytest.mark.parametrize("autopilot", ["ardupilot", "px4", None])
@given(item=items, change=st.sampled_from(["latitude_deg", "longitude_deg", "altitude", "frame", "command"]))
def test_any_other_place_is_a_difference(autopilot, item, change):
    changed = {
        "latitude_deg": item.latitude_deg - math.copysign(1e-7, item.latitude_deg),
        "longitude_deg": item.longitude_deg - math.copysign(1e-7, item.longitude_deg),
        "altitude": item.altitude + 0.03,
        "frame": 3 - item.frame,
        "command": int(Command.NAV_LOITER_UNLIM),
    }
    found = compare_items([item], [replace(item, **{change: changed[change]})], autopilot=autopilot)
    assert len(found.differences) == 1
    assert found.differences[0].seq == 0


@pytest.mark.parametrize(
    ("sent", "held", "fate"),
    [
        (61.999, 61.99, "lost"),  # measured on ArduCopter 4.7
        (61.999, 61.98, "differs"),
        (-12.345, -12.34, "lost"),
        (-12.345, -12.36, "differs"),
        (50.3, 50.29, "lost"),  # the float just below 50.3
        (8848.86, 8848.86, "same"),
    ],
)
def test_centimetres_of_ardupilot(sent, held, fate):
    found = compare_items([replace(WAYPOINT, altitude=sent)], [replace(WAYPOINT, altitude=held)], autopilot="ardupilot")
    assert ("differs" if found.differences else "lost" if found.losses else "same") == fate
    exact = compare_items([replace(WAYPOINT, altitude=sent)], [replace(WAYPOINT, altitude=held)], autopilot="px4")
    assert exact.same == (fate == "same")


@pytest.mark.parametrize(
    ("item", "params", "autopilot", "vehicle_type", "same"),
    [
        (WAYPOINT, (2, 0, 0, 0), "ardupilot", "multicopter", True),
        (WAYPOINT, (0, 0, 0, 0), "ardupilot", "multicopter", False),
        (WAYPOINT, (0, 5, 0, 0), "ardupilot", "fixed-wing", True),
        (WAYPOINT, (0, 4, 0, 0), "ardupilot", "fixed-wing", False),
        (replace(WAYPOINT, params=(-1, 0, 0, 0)), (65535, 0, 0, 0), "ardupilot", "multicopter", False),
        (replace(WAYPOINT, params=(2.7, 0, 0, math.nan)), (2, 0, 0, 0), "ardupilot", "multicopter", True),
        (WAYPOINT, (2, 5, 0, 90.00001), "px4", None, True),
        (WAYPOINT, (2, 5, 0, -270), "px4", None, True),
        (WAYPOINT, (2, 5, 0, 91), "px4", None, False),
        (WAYPOINT, (2, 5, 0, math.nan), "px4", None, False),
        (WAYPOINT, (2, 0, 0, 90), "px4", None, False),
        (SPEED, (1, 14.5, -1, 0), "ardupilot", None, True),
        (SPEED, (1, 14, -1, 0), "ardupilot", None, False),
        (SPEED, (1, 14.5, 0, 0), "ardupilot", None, False),
        (SPEED, (0, 14.5, -1, 0), "px4", None, False),
        (SPEED, (1, 14.5, -1, 0), None, None, True),
        (replace(SPEED, params=(1, 0.1, -1, 0)), (1, 0.10000000149011612, -1, 0), "px4", None, True),
    ],
)
def test_parameters(item, params, autopilot, vehicle_type, same):
    held = replace(item, params=params)
    assert compare_items([item], [held], autopilot=autopilot, vehicle_type=vehicle_type).same == same


def test_frames_without_a_place_do_not_matter():
    for autopilot in ("ardupilot", "px4"):
        assert compare_items([SPEED], [replace(SPEED, frame=Frame.MISSION)], autopilot=autopilot).same


def test_a_place_in_frame_mission_is_not_the_place_that_ardupilot_makes_of_it():
    sent = replace(WAYPOINT, frame=Frame.MISSION)
    held = replace(WAYPOINT, frame=Frame.GLOBAL, latitude_deg=47e-7, longitude_deg=10e-7)  # x = 47, y = 10
    assert not compare_items([sent], [held], autopilot="ardupilot").same


def test_numbers_of_items():
    found = compare_items([WAYPOINT, SPEED], [WAYPOINT], autopilot="px4")
    assert [str(difference) for difference in found.differences] == ["the number of items 2 became 1"]
    assert not compare_items([], [WAYPOINT]).same


def test_differences_are_said_with_the_number_of_the_item():
    found = compare_items([SPEED, WAYPOINT], [SPEED, replace(WAYPOINT, latitude_deg=46.9)], first=1)
    assert str(found.differences[0]) == "item 2: latitude 46.8000000 became 46.9000000"


def test_fences_have_no_heights_and_no_frames():
    circle = MissionItem(3, Command.NAV_FENCE_CIRCLE_INCLUSION, (120.5, 0, 0, 0), 46.8, 9.8, 30.0)
    held = replace(circle, frame=0, altitude=0.0)
    for autopilot in ("ardupilot", "px4"):
        assert compare_items([circle], [held], mission_type="fence", autopilot=autopilot).same
        smaller = replace(held, params=(120.0, 0, 0, 0))
        assert not compare_items([circle], [smaller], mission_type="fence", autopilot=autopilot).same


def test_rally_points_of_ardupilot_are_whole_metres():
    rally = MissionItem(3, Command.NAV_RALLY_POINT, (0, 0, 0, 0), 46.8, 9.8, 60.75)
    for altitude, same in ((60.0, True), (60.75, True), (59.0, False)):
        held = replace(rally, altitude=altitude)
        assert compare_items([rally], [held], mission_type="rally", autopilot="ardupilot").same == same


def test_either_way():
    planned, onboard = [WAYPOINT], [replace(WAYPOINT, altitude=61.99, params=(2, 0, 0, 0))]
    for one, other in ((planned, onboard), (onboard, planned)):
        found = compare_either_way(one, other, autopilot="ardupilot", vehicle_type="multicopter")
        assert found.same
        assert len(found.losses) == 3
        (altitude,) = [loss for loss in found.losses if loss.field == "altitude"]
        assert (altitude.sent, altitude.held) == (f"{one[0].altitude:g}", f"{other[0].altitude:g}")


def test_the_scripted_ardupilot_refuses_what_the_rules_say():
    with pytest.raises(Refused):
        kept(replace(WAYPOINT, params=(math.nan, 0, 0, 0)), ArduPilot)
