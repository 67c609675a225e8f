"""Our files as other programs read them: pymavlink's mavwp and MAVSDK's two importers.

MAVSDK 4.1, measured: `import_mission_planner_mission` keeps home as item 0 for every autopilot and marks it
current; `import_qgroundcontrol_mission` gives the items without home and marks the first. Both read our NaN.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from gcs_windplan.formats import write_plan, write_waypoints
from gcs_windplan.mission import Command, Frame, MissionItem, MissionItems

from .conftest import same_number
from .specimens import BUILT, HOME

single_precision_of_a_kilometre = 1e-4  # [m] altitudes travel as 32-bit floats
one_millimetre = 1e-3  # [m]

ODD = MissionItems(
    (
        MissionItem(Frame.GLOBAL_RELATIVE_ALT, Command.NAV_TAKEOFF, (15.5, 0, 0, 0), 0, 0, 30.0),
        MissionItem(Frame.GLOBAL_TERRAIN_ALT, Command.NAV_SPLINE_WAYPOINT, (2.25, 0, 0, 0), -46.8, -9.8, 50.0),
        MissionItem(Frame.GLOBAL_RELATIVE_ALT, Command.NAV_WAYPOINT, (0, 0, 0, 0), 90, -180, -12.5, False),
        MissionItem(Frame.GLOBAL, Command.NAV_DELAY, (-1, 12, 30, 0)),
    ),
    HOME,
    "ardupilot",
    "fixed-wing",
)
UNKNOWN = MissionItems(ODD.items, HOME)  # neither autopilot nor vehicle named
MISSIONS = {**BUILT, "odd": ODD, "unknown": UNKNOWN}
home_item = MissionItem(
    Frame.GLOBAL,
    Command.NAV_WAYPOINT,
    (0, 0, 0, 0),
    HOME.point.latitude_deg,
    HOME.point.longitude_deg,
    HOME.altitude,
)
every_mission = pytest.mark.parametrize("mission", MISSIONS.values(), ids=MISSIONS)


@every_mission
def test_mavwp_reads_waypoints(mission: MissionItems, mavwp_load: Callable[[Path], list[Any]], tmp_path: Path) -> None:
    path = tmp_path / "mission.waypoints"
    write_waypoints(mission, path)
    theirs = mavwp_load(path)
    for seq, (item, other) in enumerate(zip((home_item, *mission.items), theirs, strict=True)):
        assert (other.seq, other.current) == (seq, int(seq == 0))
        assert (other.frame, other.command) == (item.frame, item.command)
        assert other.autocontinue == item.autocontinue
        params = (other.param1, other.param2, other.param3, other.param4)
        assert all(same_number(a, b, 0) for a, b in zip(item.params, params, strict=True))
        assert (int(other.x * 1e7), int(other.y * 1e7)) == (
            item.lat_e7,
            item.lon_e7,
        )  # as mavwp's users truncate
        assert other.z == pytest.approx(item.altitude, abs=one_millimetre)


def assert_imported(items: list[MissionItem], theirs: list[Any]) -> None:
    for seq, (item, other) in enumerate(zip(items, theirs, strict=True)):
        assert (other.seq, other.current, other.mission_type) == (seq, int(seq == 0), 0)
        assert (other.frame, other.command) == (item.frame, item.command)
        assert other.autocontinue == item.autocontinue
        assert (other.x, other.y) == (item.lat_e7, item.lon_e7)
        assert other.z == pytest.approx(item.altitude, abs=one_millimetre + single_precision_of_a_kilometre)
        params = (other.param1, other.param2, other.param3, other.param4)
        assert all(same_number(a, b, 1e-5) for a, b in zip(item.params, params, strict=True))


@every_mission
def test_mavsdk_imports_waypoints_with_home(mission: MissionItems, mission_raw: Any, tmp_path: Path) -> None:
    path = tmp_path / "mission.waypoints"
    write_waypoints(mission, path)
    imported = mission_raw.import_mission_planner_mission(str(path))
    assert_imported([home_item, *mission.items], imported.mission_items)


@every_mission
def test_mavsdk_imports_plan_without_home(mission: MissionItems, mission_raw: Any, tmp_path: Path) -> None:
    path = tmp_path / "mission.plan"
    write_plan(mission, path)
    imported = mission_raw.import_qgroundcontrol_mission(str(path))
    assert_imported(list(mission.items), imported.mission_items)
    assert imported.geofence_items == imported.rally_items == []


def test_nan_reaches_every_peer(mavwp_load: Callable[[Path], list[Any]], mission_raw: Any, tmp_path: Path) -> None:
    mission = BUILT["px4-relative-land-speeds"]
    path = tmp_path / "mission.waypoints"
    write_waypoints(mission, path)
    assert path.read_text().split("\n")[2].split("\t")[7] == "nan"
    assert math.isnan(mavwp_load(path)[1].param4)
    assert math.isnan(mission_raw.import_mission_planner_mission(str(path)).mission_items[1].param4)
