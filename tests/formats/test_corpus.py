"""Every mission file found in the wild is read, or refused with a reason, and read as the peers read it."""

from __future__ import annotations

import math
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from gcs_windplan.errors import FormatError
from gcs_windplan.formats import (
    format_plan,
    format_waypoints,
    parse_plan,
    parse_waypoints,
    read_items,
    read_plan,
    read_waypoints,
)
from gcs_windplan.geo.frame import GeoPoint
from gcs_windplan.mission import MissionItem, MissionItems

from .conftest import MISSIONS, same_number
from .specimens import content

FILES = sorted(path for path in MISSIONS.rglob("*") if path.is_file()) if MISSIONS.is_dir() else []
SHEETS = [path for path in FILES if path.suffix in (".txt", ".waypoints")]
PLANS = [path for path in FILES if path.suffix == ".plan"]
pytestmark = pytest.mark.skipif(not FILES, reason="the shared corpus of missions is not here")

REFUSED = {
    "ArduCopter_Tests__AC_Avoidance_Fence__copter-avoidance-fence.txt": "not with 'QGC WPL 110'",
    "ArduCopter_Tests__HorizontalFence__fence-in-middle-of-nowhere.txt": "not with 'QGC WPL 110'",
    "ArduPlane_Tests__FenceRTL__CMAC-fence.txt": "not with 'QGC WPL 110'",
    "qgroundcontrol_sample_with_structured_scan.plan": r"items\[1\]: is a complex item \(StructureScan",
    "qgroundcontrol_sample_with_survey_missing_items.plan": r"items\[1\]: is a complex item \(survey",
    "qgroundcontrol_sample_wrong_mission_version.plan": "mission.version: is 7, and only 2 is known",
    "qgroundcontrol_sample_wrong_overall_version.plan": "version: is 42, and only 1 is known",
    "qgroundcontrol_sample_without_mission.plan": "mission: is missing",
}
# what MAVSDK 4.1 refuses and we read: an unknown survey that carries its items, four params with the
# coordinate beside them, rally points of version 1
MAVSDK_REFUSES = {
    "qgroundcontrol_sample_with_survey_wrong_version.plan",
    "SectionTest.plan",
    "ce_geofence_rd_2.plan",
}


def name(path: Path) -> str:
    return path.name


@pytest.mark.parametrize("path", FILES, ids=name)
@pytest.mark.parametrize("reader", [read_items, read_plan, read_waypoints])
def test_every_reader_reads_or_refuses_every_file(path: Path, reader: Callable[[Path], Any]) -> None:
    try:
        assert isinstance(reader(path).mission, MissionItems)
    except FormatError as error:
        assert str(path) in str(error)  # noqa: PT017
        assert len(error.problems[0].message) > 20  # noqa: PT017


@pytest.mark.parametrize("path", SHEETS + PLANS, ids=name)
def test_only_what_cannot_be_read_is_refused(path: Path) -> None:
    reason = REFUSED.get(path.name)
    if reason is None:
        assert read_items(path).mission.items or "geofence" in path.name
    else:
        with pytest.raises(FormatError, match=reason):
            read_items(path)


@pytest.mark.parametrize("path", [path for path in SHEETS if path.name not in REFUSED], ids=name)
def test_sheets_are_read_as_mavwp_reads_them(path: Path, mavwp_load: Callable[[Path], list[Any]]) -> None:
    theirs = mavwp_load(path)
    mission = read_waypoints(path).mission
    if theirs[0].x == theirs[0].y == 0:
        assert mission.home is None
    else:
        assert mission.home is not None
        assert mission.home.altitude == theirs[0].z
        assert mission.home.point == GeoPoint(theirs[0].x, theirs[0].y)
    assert_equal(mission.items, theirs[1:])
    for item, other in zip(mission.items, theirs[1:], strict=True):
        assert (item.latitude_deg, item.longitude_deg) == (other.x, other.y)


@pytest.mark.parametrize("path", [path for path in PLANS if path.name not in REFUSED], ids=name)
def test_plans_are_read_as_mavsdk_reads_them(path: Path, mission_raw: Any) -> None:
    mission = read_plan(path).mission
    if path.name in MAVSDK_REFUSES:
        with pytest.raises(Exception, match="FAILED_TO_PARSE_QGC_PLAN"):
            mission_raw.import_qgroundcontrol_mission(str(path))
        return
    imported = mission_raw.import_qgroundcontrol_mission(str(path)).mission_items
    assert_equal(mission.items, imported)
    for item, other in zip(mission.items, imported, strict=True):
        assert abs(item.x - other.x) <= 1  # C++ rounds halves up, Python to even
        assert abs(item.y - other.y) <= 1


def assert_equal(items: tuple[MissionItem, ...], theirs: list[Any]) -> None:
    for item, other in zip(items, theirs, strict=True):
        assert (item.frame, item.command) == (other.frame, other.command)
        assert same_number(item.altitude, 0.0 if math.isnan(other.z) else other.z, 1e-4)
        params = (other.param1, other.param2, other.param3, other.param4)
        assert all(same_number(a, b, 1e-4) for a, b in zip(item.params, params, strict=True))


@pytest.mark.parametrize("path", [path for path in SHEETS + PLANS if path.name not in REFUSED], ids=name)
def test_what_was_read_can_be_written_and_read_again(path: Path) -> None:
    mission = read_items(path).mission
    if mission.home is None:
        with pytest.raises(FormatError, match="has none"):
            format_plan(mission)
        return
    items = [content(item) for item in mission.items]
    sheet = format_waypoints(mission.without_fence())
    assert [content(item) for item in parse_waypoints(sheet).mission.items] == items
    assert [content(item) for item in parse_plan(format_plan(mission)).mission.items] == items


def test_a_survey_is_read_through_the_items_it_carries() -> None:
    read = read_plan(MISSIONS / "mavsdk" / "qgroundcontrol_sample_with_survey.plan")
    assert len(read.mission.items) == 13
    assert read.repairs == ("mission.items[1] (survey, version 5) was replaced by the simple items it carries",)
