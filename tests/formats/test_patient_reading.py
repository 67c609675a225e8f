"""Sheets as people and other programs leave them: read, and each repair said with its line."""

from __future__ import annotations

import json
import math
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from gcs_windplan.errors import FormatError
from gcs_windplan.formats import (
    format_plan,
    format_waypoints,
    parse_plan,
    parse_waypoints,
    read_items,
    read_waypoints,
)
from gcs_windplan.mission import Command

from .specimens import BUILT

HOME_ROW = "0\t1\t0\t16\t0\t0\t0\t0\t46.81\t9.84\t1560\t1"
ROW = "1\t0\t3\t16\t0\t0\t0\t0\t46.82\t9.85\t40.5\t1"
CLEAN = f"QGC WPL 110\n{HOME_ROW}\n{ROW}\n"
STRICT = format_waypoints(BUILT["px4-relative-land-speeds"])


def test_a_clean_sheet_needs_no_repair() -> None:
    read = parse_waypoints(CLEAN)
    assert read.repairs == ()
    assert read.mission.home is not None
    assert read.mission.home.altitude == 1560
    (item,) = read.mission.items
    assert (item.latitude_deg, item.longitude_deg, item.altitude) == (46.82, 9.85, 40.5)


@pytest.mark.parametrize(
    ("text", "repair"),
    [
        ("\ufeff" + CLEAN, "line 1: byte order mark dropped"),
        (CLEAN.replace("\n", "\r\n"), "line ends of another system (carriage returns) read as plain ones"),
        (CLEAN.replace("\n", "\r"), "line ends of another system (carriage returns) read as plain ones"),
        (CLEAN.replace("\t", "   "), "lines 2, 3: fields parted by other than single tabs"),
        (CLEAN.replace("\t", ", "), "lines 2, 3: fields parted by other than single tabs"),
        (CLEAN.replace(ROW, ROW + "\t"), "line 3: fields parted by other than single tabs"),
        (CLEAN.replace(HOME_ROW, "# the field\n" + HOME_ROW), "line 2: comment dropped"),
        (CLEAN.replace(ROW, ROW + "  # the ridge"), "line 3: comment dropped"),
        (CLEAN.replace(ROW, "\n" + ROW), "line 3: blank line dropped"),
        (CLEAN + "\n\n", "lines 4, 5: blank line dropped"),
        (CLEAN.replace("\t3\t16", "\t3.0\t16"), "line 3: frame '3.0' read as 3"),
        (CLEAN.replace("\n1\t0", "\n7\t0"), "line 3: numbered out of order; the order in the file counts"),
        (CLEAN.replace("\n1\t0", "\n1\t2"), "line 3: current 2 would mean 'fly there now'; ignored"),
        (CLEAN.replace("46.82\t9.85", "nan\tnan"), "line 3: latitude and longitude 'nan' read as 0"),
    ],
)
def test_repairs_change_nothing_and_are_said(text: str, repair: str) -> None:
    read = parse_waypoints(text)
    assert read.repairs == (repair,)
    clean = parse_waypoints(CLEAN).mission
    assert read.mission.home == clean.home
    if "nan" not in repair:
        assert read.mission.items == clean.items


def test_repairs_of_many_lines_stay_short() -> None:
    text = "\n".join(["QGC WPL 110", HOME_ROW, *[ROW.replace("\t", " ")] * 300])
    spoken = [repair for repair in parse_waypoints(text).repairs if "tabs" in repair]
    assert spoken == ["lines 3, 4, 5, 6, 7 and 295 more: fields parted by other than single tabs"]


@pytest.mark.parametrize(
    ("row", "repair"),
    [
        (HOME_ROW.replace("16", "22"), "line 2: row 0 is home in this format; its NAV_TAKEOFF is not flown"),
        (
            HOME_ROW.replace("\t1\t0\t", "\t1\t3\t"),
            "line 2: home's altitude read as above sea level, though its frame is 3",
        ),
    ],
)
def test_row_0_is_home_whatever_it_says(row: str, repair: str) -> None:
    read = parse_waypoints(CLEAN.replace(HOME_ROW, row))
    assert read.repairs == (repair,)
    assert read.mission.home is not None
    assert len(read.mission.items) == 1


def test_a_blank_home_is_no_home() -> None:
    read = parse_waypoints(CLEAN.replace("46.81\t9.84\t1560", "0\t0\t0"))
    assert read.mission.home is None
    assert read.repairs == ("home is a blank (0, 0); it was left out",)


def test_a_sheet_that_begins_at_1_has_no_home() -> None:
    read = parse_waypoints(f"QGC WPL 110\n{ROW}\n")
    assert read.mission.home is None
    assert len(read.mission.items) == 1
    assert read.repairs == ("line 2: the first row is number 1, so the file has no home",)


def test_version_120_has_no_home_and_counts_jumps_from_0() -> None:
    jump = "2\t0\t2\t177\t1\t3\t0\t0\t0\t0\t0\t1"
    read = parse_waypoints(f"QGC WPL 120\n{HOME_ROW}\n{ROW}\n{jump}\n")
    assert read.mission.home is None
    assert len(read.mission.items) == 3
    assert read.mission.items[2].params[:2] == (2.0, 3.0)
    assert read.repairs == ("version 120 has no home row; every row is an item",)


def test_version_100_is_read_as_mavwp_reads_it(mavwp_load: Any, tmp_path: Path) -> None:
    path = tmp_path / "old.txt"
    path.write_text("QGC WPL 100\n0 0 25 0 0 0 0 1 9.84 46.81 1560 0 1\n1 3 24 1 2 3 4 0 9.85 46.82 40 0 1\n")
    read = read_waypoints(path)
    _, theirs = mavwp_load(path)
    (item,) = read.mission.items
    assert (item.frame, item.command) == (theirs.frame, theirs.command) == (3, Command.NAV_TAKEOFF)
    assert item.params == (theirs.param1, theirs.param2, theirs.param3, theirs.param4) == (3, 4, 1, 2)
    assert (item.latitude_deg, item.longitude_deg, item.altitude) == (theirs.x, theirs.y, theirs.z)
    assert "lines 2, 3: row of version 100 put into the order of 110" in read.repairs


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("", "sheet.txt:1: begins with '', not with 'QGC WPL 110'"),
        ("46.8 9.8\n46.9 9.9\n", "sheet.txt:1: begins with '46.8 9.8', not with 'QGC WPL 110'"),
        ("QGC WPL PB 110\n", "sheet.txt:1: begins with 'QGC WPL PB 110'"),
        ("QGC WPL 200\n", "sheet.txt:1: is version 200 of the format"),
        ("QGC WPL 110\n", "sheet.txt: has no rows after its header"),
        (CLEAN.replace("\t40.5", ""), "sheet.txt:3: has 11 fields, not 12: seq current frame command"),
        (CLEAN.replace("40.5", "high"), "sheet.txt:3: field 11 (altitude) is 'high', not a number"),
        (CLEAN.replace("40.5", "4_0"), "sheet.txt:3: field 11 (altitude) is '4_0', not a number"),
        (CLEAN.replace("40.5", "inf"), "sheet.txt:3: field 11 (altitude) is 'inf', not a number"),
        (CLEAN.replace("\t3\t16", "\t3.5\t16"), "sheet.txt:3: field 3 (frame) is '3.5', not a whole number"),
        (CLEAN.replace("40.5", "nan"), "sheet.txt:3: altitude is 'nan', and NAV_WAYPOINT needs one: write the number"),
        (CLEAN.replace("46.82", "nan"), "sheet.txt:3: latitude is 'nan', and NAV_WAYPOINT needs one: write the number"),
        (CLEAN.replace("\t3\t16", "\tnan\t16"), "sheet.txt:3: field 3 (frame) is 'nan', not a whole number"),
        (CLEAN.replace("\t3\t16", "\t3\t-16"), "sheet.txt:3: command -16 is not between 0 and 65535"),
        (CLEAN.replace("46.82", "146.82"), "sheet.txt:3: latitude 146.82 is not between -90 and 90"),
        (CLEAN.replace("9.84", "189.84"), "sheet.txt:2: home: longitude 189.84 is not between -180 and 180"),
        (
            "QGC WPL 100\n0 0 99 0 0 0 0 1 9.8 46.8 1 0 1\n",
            "sheet.txt:2: command 99 is none of version 100's",
        ),
    ],
)
def test_what_cannot_be_repaired_is_refused_with_its_line(text: str, message: str) -> None:
    with pytest.raises(FormatError) as caught:
        parse_waypoints(text, "sheet.txt")
    assert str(caught.value).startswith(message)


@given(st.text() | st.text(alphabet="QGC WPL1230.\t\n,#-eEnaif_").map(lambda tail: "QGC WPL 110\n" + tail))
def test_any_text_is_read_or_refused(text: str) -> None:
    for parse in (parse_waypoints, parse_plan):
        try:
            parse(text)
        except FormatError as error:
            assert str(error)  # noqa: PT017


@given(st.integers(0, len(STRICT) - 1), st.sampled_from("0\t\n .-x9e"))
def test_a_spoiled_sheet_is_read_or_refused(place: int, char: str) -> None:
    try:
        parse_waypoints(STRICT[:place] + char + STRICT[place + 1 :])
    except FormatError as error:
        assert str(error)  # noqa: PT017


json_values = st.recursive(
    st.none() | st.booleans() | st.integers() | st.floats(allow_nan=False, allow_infinity=False) | st.text(max_size=3),
    lambda inner: st.lists(inner, max_size=3) | st.dictionaries(st.text(max_size=3), inner, max_size=3),
    max_leaves=5,
)
PLACES = [
    (),
    ("version",),
    ("fileType",),
    ("geoFence",),
    ("geoFence", "circles"),
    ("mission",),
    ("mission", "items"),
    *[("mission", key) for key in ("firmwareType", "vehicleType", "cruiseSpeed", "plannedHomePosition", "version")],
    *[("mission", "items", 0, key) for key in ("type", "command", "frame", "params", "autoContinue", "doJumpId")],
    ("mission", "items", 0, "params", 4),
    ("mission", "plannedHomePosition", 2),
]


@given(st.sampled_from(PLACES), json_values)
def test_a_plan_with_anything_anywhere_is_read_or_refused(place: tuple[Any, ...], value: Any) -> None:
    root = json.loads(format_plan(BUILT["ardupilot-amsl-land-one-speed"]))
    if place:
        node = root
        for key in place[:-1]:
            node = node[key]
        node[place[-1]] = value
    else:
        root = value
    try:
        parse_plan(json.dumps(root))
    except FormatError as error:
        assert str(error)  # noqa: PT017


def changed_plan(**changes: Any) -> str:
    root = json.loads(format_plan(BUILT["ardupilot-amsl-land-one-speed"]))
    root["mission"] |= changes
    return json.dumps(root)


def simple_item(command: int, params: list[Any], jump_id: int) -> dict[str, Any]:
    keys = {"type": "SimpleItem", "frame": 3, "autoContinue": True}
    return keys | {"command": command, "params": params, "doJumpId": jump_id}


def test_jumps_of_a_plan_follow_the_jump_ids() -> None:
    waypoint = simple_item(16, [0, 0, 0, None, 46.8, 9.8, 50], 40)
    jump = simple_item(177, [40, 2, 0, 0, 0, 0, 0], 41)
    read = parse_plan(changed_plan(items=[waypoint, jump]))
    assert read.mission.items[1].params[0] == 1
    assert read.repairs == ("mission.items[1]: DO_JUMP to doJumpId 40 became one to item 1",)
    assert math.isnan(read.mission.items[0].params[3])


@pytest.mark.parametrize(
    ("changes", "repair"),
    [
        ({"firmwareType": 0}, "firmwareType 0 is neither ArduPilot nor PX4; the autopilot is unknown"),
        (
            {"vehicleType": 20},
            "vehicleType 20 is neither a multicopter nor fixed-wing; the vehicle is unknown",
        ),
        ({"cruiseSpeed": 0}, "mission.cruiseSpeed 0 is no speed; it was left out"),
        ({"plannedHomePosition": None}, "the file has no planned home"),
        ({"plannedHomePosition": [0, 0, 0]}, "home is a blank (0, 0); it was left out"),
        ({"plannedHomePosition": [46.8, 9.8, None]}, "the planned home has null in it; it was left out"),
        (
            {"items": [simple_item(21, [0, 0, 0, 0, None, None, 0], 1)]},
            "mission.items[0].params: null in the place was read as 0",
        ),
    ],
)
def test_repairs_of_a_plan(changes: dict[str, Any], repair: str) -> None:
    assert parse_plan(changed_plan(**changes)).repairs == (repair,)


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("{", "m.plan:1:2: is not JSON (Expecting property name"),
        ("[]", "m.plan: is not an object"),
        ("{}", "m.plan: is no .plan file (its fileType is not 'Plan'); an older .mission file can be opened"),
        (
            changed_plan(cruiseSpeed=math.nan),
            "m.plan: is not JSON that can be read: NaN is not JSON, write null",
        ),
        ("[" * 100_000, "m.plan: is not JSON that can be read"),
        (
            changed_plan(items=[{"type": "Oddity"}]),
            "m.plan: mission.items[0].type: is neither SimpleItem nor",
        ),
        (
            changed_plan(items=[simple_item(16, [0], 1)]),
            "m.plan: mission.items[0].params: has 1 numbers, not 7",
        ),
        (
            changed_plan(items=[simple_item(16, [0, 0, 0, 0, 95, 0, 0], 1)]),
            "m.plan: mission.items[0]: latitude 95.0 is not between",
        ),
        (changed_plan(version=3), "m.plan: mission.version: is 3, and only 2 is known"),
    ],
    ids=lambda value: value[:30],
)
def test_a_plan_that_cannot_be_read_is_refused_with_the_place(text: str, message: str) -> None:
    with pytest.raises(FormatError) as caught:
        parse_plan(text, "m.plan")
    assert str(caught.value).startswith(message)


def test_files_that_cannot_be_opened_or_are_binary_are_refused(tmp_path: Path) -> None:
    with pytest.raises(FormatError, match=r"gone\.plan: cannot be read \(no such file"):
        read_items(tmp_path / "gone.plan")
    with pytest.raises(FormatError, match="cannot be read"):
        read_waypoints(tmp_path)
    utf16 = tmp_path / "wide.waypoints"
    utf16.write_text(CLEAN, encoding="utf-16")
    with pytest.raises(FormatError, match="zero bytes"):
        read_items(utf16)
    with pytest.raises(FormatError, match=r"ends in none of \.plan, \.waypoints"):
        read_items(tmp_path / "mission.kml")


def test_a_comment_in_latin_1_does_no_harm(tmp_path: Path) -> None:
    path = tmp_path / "swiss.waypoints"
    path.write_bytes(CLEAN.replace(HOME_ROW, "# Jakobshörnli\n" + HOME_ROW).encode("latin-1"))
    read = read_items(path)
    assert read.repairs == ("the file is not UTF-8; it was read as Latin-1", "line 2: comment dropped")
