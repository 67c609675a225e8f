"""Missions as each firmware wants them on the wire."""

from __future__ import annotations

from dataclasses import replace

import pytest

from gcs_windplan.errors import InputError
from gcs_windplan.link.firmware import incoming_mission, outgoing_items, with_fence, with_rally
from gcs_windplan.mission import Command, Frame, MissionItem, MissionItems, fence_items, rally_items

from .bench import FENCE, HOME, RALLY, survey

JUMP = MissionItem(Frame.GLOBAL, Command.DO_JUMP, (2, 3, 0, 0))
MISSION = replace(survey(4), items=(*survey(4).items, JUMP))


def test_ardupilot_has_home_first():
    items = outgoing_items(MISSION, "mission", "ardupilot")
    assert len(items) == 6
    assert (items[0].command, items[0].frame) == (Command.NAV_WAYPOINT, Frame.GLOBAL)
    assert (items[0].latitude_deg, items[0].altitude) == (HOME.point.latitude_deg, HOME.altitude)
    assert items[1:] == MISSION.items
    assert items[5].params[0] == 2  # as in files


def test_ardupilot_gets_a_blank_for_an_unknown_home():
    blank = outgoing_items(replace(MISSION, home=None), "mission", "ardupilot")[0]
    assert (blank.x, blank.y, blank.altitude) == (0, 0, 0.0)


def test_px4_has_no_home_jumps_counted_from_0_and_frame_mission():
    items = outgoing_items(MISSION, "mission", "px4")
    assert len(items) == 5
    assert items[4].params == (1, 3, 0, 0)
    assert [item.frame for item in items] == [3, 3, 3, Frame.MISSION, Frame.MISSION]
    unknown = outgoing_items(MISSION, "mission", None)
    assert [item.frame for item in unknown] == [3, 3, 3, 0, 0]
    assert unknown[4].params[0] == 1


def test_a_jump_to_home_is_refused_where_home_is_no_item():
    mission = MissionItems((replace(JUMP, params=(0, 1, 0, 0)),), HOME)
    with pytest.raises(InputError, match="aim at an item from 1 on"):
        outgoing_items(mission, "mission", "px4")


@pytest.mark.parametrize("autopilot", ["ardupilot", "px4", None])
def test_there_and_back(autopilot):
    items = outgoing_items(MISSION, "mission", autopilot)
    back = incoming_mission(items, autopilot, "multicopter", HOME)
    assert [replace(item, frame=0) for item in back.items] == [replace(item, frame=0) for item in MISSION.items]
    assert (back.home, back.autopilot) == (HOME, autopilot)


def test_a_home_of_ardupilot_that_is_not_set_is_none():
    items = outgoing_items(replace(MISSION, home=None), "mission", "ardupilot")
    assert incoming_mission(items, "ardupilot").home is None
    assert incoming_mission((), "ardupilot").items == ()


def test_fence_and_rally_points_are_the_same_for_all():
    for autopilot in ("ardupilot", "px4", None):
        assert outgoing_items(MISSION, "fence", autopilot) == fence_items(FENCE)
        assert outgoing_items(MISSION, "rally", autopilot) == rally_items(RALLY)
    bare = MissionItems(MISSION.items, HOME)
    assert outgoing_items(bare, "fence", "px4") == outgoing_items(bare, "rally", "px4") == ()
    assert with_rally(with_fence(bare, fence_items(FENCE)), rally_items(RALLY)) == replace(
        bare, fence=FENCE, rally=RALLY
    )


def test_an_empty_mission_sends_nothing():
    assert outgoing_items(MissionItems((), HOME), "mission", "ardupilot") == ()
