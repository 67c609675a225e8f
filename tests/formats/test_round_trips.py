"""What is written is read again: the same items, coordinates to 1e-7 degrees, altitudes to a millimetre."""

from __future__ import annotations

import json
import math
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from gcs_windplan.errors import FormatError
from gcs_windplan.formats import (
    ReadMission,
    format_plan,
    format_waypoints,
    parse_plan,
    parse_waypoints,
    read_items,
    write_plan,
    write_waypoints,
)
from gcs_windplan.formats.digits import degrees_text, metres_text, number_text
from gcs_windplan.mission import Command, Frame, Home, MissionItem, MissionItems

from .specimens import BUILT, HOME, altitudes, content, home_content, missions

one_millimetre = 1e-3  # [m]


def assert_same(read: ReadMission, mission: MissionItems) -> None:
    assert [content(item) for item in read.mission.items] == [content(item) for item in mission.items]
    assert home_content(read.mission.home) == home_content(mission.home)
    assert altitudes(read.mission) == pytest.approx(altitudes(mission), rel=0, abs=one_millimetre)


@given(missions)
def test_waypoints_come_back(mission: MissionItems) -> None:
    read = parse_waypoints(format_waypoints(mission))
    assert_same(read, mission)
    assert read.repairs == ()


@given(missions)
def test_plans_come_back_with_their_vehicle(mission: MissionItems) -> None:
    read = parse_plan(format_plan(mission))
    assert_same(read, mission)
    back = read.mission
    assert (back.autopilot, back.vehicle_type) == (mission.autopilot, mission.vehicle_type)
    assert (back.cruise_speed, back.hover_speed) == (mission.cruise_speed, mission.hover_speed)


@pytest.mark.parametrize("mission", BUILT.values(), ids=BUILT)
@pytest.mark.parametrize(("write", "ending"), [(write_waypoints, "waypoints"), (write_plan, "plan")])
def test_files_are_stable_when_read_and_written_again(mission, write, ending, tmp_path: Path) -> None:  # type: ignore[no-untyped-def]
    first, second = tmp_path / f"first.{ending}", tmp_path / f"second.{ending}"
    write(mission, first)
    read = read_items(first)
    write(read.mission, second)
    assert read.repairs == ()
    assert first.read_bytes() == second.read_bytes()


@given(st.integers(-1_800_000_000, 1_800_000_000))
def test_rounding_and_truncating_readers_get_the_same_integer(units: int) -> None:
    text = degrees_text(units / 1e7)
    assert int(float(text) * 1e7) == round(float(text) * 1e7) == units
    assert len(text.partition(".")[2]) == 8


@given(st.floats(-180, 180))
def test_coordinates_between_integers_are_rounded(degrees: float) -> None:
    assert int(float(degrees_text(degrees)) * 1e7) == round(degrees * 1e7)


@given(st.floats(-1e12, 1e12))
def test_parameters_keep_their_exact_value(value: float) -> None:
    text = number_text(value)
    assert float(text) == value
    assert "e" not in text


def test_small_negative_numbers_do_not_leave_a_lone_minus() -> None:
    assert degrees_text(-1e-9) == "0.00000000"
    assert metres_text(-0.0004) == "0.000"
    assert number_text(-0.0) == "0"
    assert number_text(math.nan) == "nan"


@given(missions)
def test_waypoints_text_is_strict(mission: MissionItems) -> None:
    text = format_waypoints(mission)
    header, *rows, last = text.split("\n")
    assert (header, last) == ("QGC WPL 110", "")
    assert "\r" not in text
    assert len(rows) == len(mission.items) + 1
    for seq, row in enumerate(rows):
        fields = row.split("\t")
        assert len(fields) == 12
        assert fields[0] == str(seq)
        assert fields[1] == ("1" if seq == 0 else "0")
        assert all(fields[place].isdecimal() for place in (0, 1, 2, 3, 11))
        assert all(len(fields[place].partition(".")[2]) == 8 for place in (8, 9))


@given(missions)
def test_plan_has_what_its_readers_demand(mission: MissionItems) -> None:
    def refuse(name: str) -> None:
        raise AssertionError(f"{name} is not JSON")

    root = json.loads(format_plan(mission), parse_constant=refuse)
    assert (root["fileType"], root["version"]) == ("Plan", 1)
    assert root["geoFence"] == {"circles": [], "polygons": [], "version": 2}
    assert root["rallyPoints"] == {"points": [], "version": 2}
    assert len(root["mission"]["plannedHomePosition"]) == 3
    for number, item in enumerate(root["mission"]["items"], start=1):
        assert item["type"] == "SimpleItem"
        assert item["doJumpId"] == number
        assert len(item["params"]) == 7
        assert type(item["autoContinue"]) is bool
        assert len({"Altitude", "AltitudeMode", "AMSLAltAboveTerrain"} & item.keys()) in (0, 3)


@pytest.mark.parametrize(
    ("frame", "mode"), [(0, 2), (5, 2), (3, 1), (6, 1), (10, 4), (11, 4)], ids=lambda value: str(value)
)
def test_altitude_modes_of_qgroundcontrol(frame: int, mode: int) -> None:
    item = MissionItem(frame, Command.NAV_WAYPOINT, (0, 0, 0, math.nan), 46.8, 9.8, 50.0)
    root = json.loads(format_plan(MissionItems((item,), HOME)))
    written = root["mission"]["items"][0]
    assert written["AltitudeMode"] == root["mission"]["globalPlanAltitudeMode"] == mode
    assert written["frame"] in (Frame.GLOBAL, Frame.GLOBAL_RELATIVE_ALT, Frame.GLOBAL_TERRAIN_ALT)
    assert written["params"] == [0, 0, 0, None, 46.8, 9.8, 50]


@pytest.mark.parametrize("format_mission", [format_plan, format_waypoints])
def test_without_home_nothing_is_written(format_mission) -> None:  # type: ignore[no-untyped-def]
    with pytest.raises(FormatError, match="has none: give it one"):
        format_mission(MissionItems((), None))


def test_jumps_count_items_from_one_in_both_formats() -> None:
    first = MissionItem(Frame.GLOBAL, Command.NAV_WAYPOINT, (0, 0, 0, 0), 46.8, 9.8, 1700.0)
    jump = MissionItem(Frame.MISSION, Command.DO_JUMP, (1, 3, 0, 0))
    mission = MissionItems((first, jump), Home(HOME.point, 1500.0))
    assert parse_plan(format_plan(mission)).mission.items[1] == jump
    assert parse_waypoints(format_waypoints(mission)).mission.items[1] == jump
