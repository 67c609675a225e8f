"""Each rule of each firmware, where it strikes and where it does not."""

from __future__ import annotations

import math
from dataclasses import replace

import pytest
from pymavlink.dialects.v20 import ardupilotmega as mavlink

from gcs_windplan.geo.frame import GeoPoint
from gcs_windplan.mission import Command, Frame, Home, MissionItem, MissionItems
from gcs_windplan.mission.lint import Firmware, lint, told

NAN = math.nan
LATITUDE, LONGITUDE = 46.8, 9.8
DEGREE = 111_195.0  # [m] of latitude, on the sphere of 6371 km; good to 1 % anywhere
HOME = Home(GeoPoint(LATITUDE, LONGITUDE), 500.0)
COPTER, PLANE = ("ardupilot", "multicopter"), ("ardupilot", "fixed-wing")
PX4, PX4_PLANE = ("px4", "multicopter"), ("px4", "fixed-wing")


def at(command, north=0.0, up=50.0, params=(0.0, 0.0, 0.0, 0.0), frame=3, **more):
    """An item so many metres north of home."""
    return MissionItem(frame, command, params, LATITUDE + north / DEGREE, LONGITUDE, up, **more)


def free(command, *params, frame=2):
    return MissionItem(frame, command, (*params, *[0.0] * (4 - len(params))))


TAKEOFF = at(Command.NAV_TAKEOFF)
WAYPOINT = at(Command.NAV_WAYPOINT, 100.0)
FAR = at(Command.NAV_WAYPOINT, 700.0)
LAND = at(Command.NAV_LAND, 0.0, 0.0)
RETURN = free(Command.NAV_RETURN_TO_LAUNCH)
SOUND = (TAKEOFF, WAYPOINT, FAR, LAND)


def found(items, firmware, home=HOME):
    """The findings' rules with their items."""
    return {(finding.rule, finding.item) for finding in lint(MissionItems(tuple(items), home), *firmware)}


def one(items, firmware, rule, home=HOME):
    """The only finding of a rule."""
    (finding,) = [found for found in lint(MissionItems(tuple(items), home), *firmware) if found.rule == rule]
    return finding


@pytest.mark.parametrize("firmware", [COPTER, PLANE, PX4, PX4_PLANE, ("ardupilot", None), ("px4", None)])
def test_nothing_is_found_in_a_sound_mission(firmware):
    assert found(SOUND, firmware) == set()


@pytest.mark.parametrize(
    ("item", "firmware", "rule", "effect"),
    [
        (at(Command.NAV_SPLINE_WAYPOINT), PX4, "command-unsupported", "rejected"),
        (at(Command.NAV_LOITER_TURNS, params=(2.0, 0, 0, 0)), PX4, "command-unsupported", "rejected"),
        (at(Command.NAV_RALLY_POINT), PX4, "command-unsupported", "rejected"),
        (at(Command.NAV_RALLY_POINT), COPTER, "command-unsupported", "rejected"),
        (free(31010), COPTER, "command-unsupported", "rejected"),
        (free(0), COPTER, "command-unsupported", "rejected"),
        (at(Command.NAV_WAYPOINT, frame=10), PX4, "frame-unsupported", "rejected"),
        (at(Command.NAV_WAYPOINT, frame=11), PX4, "frame-unsupported", "rejected"),
        (at(Command.NAV_WAYPOINT, frame=1), COPTER, "frame-unsupported", "rejected"),
        (free(Command.DO_CHANGE_SPEED, 1, 5, frame=3), PX4, "frame-mission-needed", "rejected"),
        (at(Command.DO_LAND_START, frame=3), PX4, "frame-mission-needed", "rejected"),
        (at(Command.NAV_WAYPOINT, frame=2), PX4, "place-frame-needed", "rejected"),
        (at(Command.NAV_WAYPOINT, frame=2), COPTER, "place-in-mission-frame", "changed"),
        (at(Command.DO_SET_ROI, params=(1.0, 0, 0, 0)), PX4, "interest-kind", "rejected"),
        (free(Command.DO_SET_ROI, 3), PX4, "interest-kind", "rejected"),
        (at(Command.NAV_WAYPOINT, params=(0, NAN, 0, 0)), COPTER, "parameter-nan", "rejected"),
        (at(Command.NAV_LOITER_TIME, params=(5, 0, 0, NAN)), PLANE, "parameter-nan", "rejected"),
        (at(Command.NAV_WAYPOINT, up=83_000.0), COPTER, "altitude-too-large", "rejected"),
        (at(Command.NAV_WAYPOINT, params=(2.5, 0, 0, 0)), COPTER, "parameter-rounded", "rounded"),
        (at(Command.NAV_WAYPOINT, params=(2.0, 0, 0, 0)), PLANE, "parameter-dropped", "dropped"),
        (at(Command.NAV_WAYPOINT, params=(0, 3.0, 0, 0)), COPTER, "parameter-dropped", "dropped"),
        (at(Command.NAV_WAYPOINT, params=(0, 300.0, 0, 0)), PLANE, "parameter-changed", "changed"),
        (at(Command.NAV_WAYPOINT, params=(0, 0, 0, 90.0)), COPTER, "parameter-dropped", "dropped"),
        (at(Command.NAV_WAYPOINT, params=(0, 0, 5.0, 0)), PX4, "parameter-dropped", "dropped"),
        (at(Command.NAV_WAYPOINT, params=(70_000.0, 0, 0, 0)), COPTER, "parameter-changed", "changed"),
        (at(Command.NAV_LOITER_TURNS, params=(2.5, 0, 0, 0)), COPTER, "parameter-rounded", "rounded"),
        (at(Command.NAV_LOITER_TURNS, params=(2, 0, -307.0, 0)), PLANE, "parameter-rounded", "rounded"),
        (at(Command.NAV_LOITER_TIME, params=(9, 0, 80.0, 0)), PLANE, "parameter-changed", "changed"),
        (free(mavlink.MAV_CMD_DO_SET_SERVO, 300, 1500), COPTER, "parameter-changed", "changed"),
        (at(Command.NAV_WAYPOINT, autocontinue=False), COPTER, "autocontinue-dropped", "dropped"),
        (at(Command.NAV_WAYPOINT, up=61.999), COPTER, "altitude-rounded", "rounded"),
        (at(Command.NAV_WAYPOINT, up=0.0), COPTER, "altitude-zero", "changed"),
        (at(Command.NAV_WAYPOINT, up=0.005, frame=0), COPTER, "altitude-zero", "changed"),
        (at(Command.NAV_LOITER_TIME, up=0.0, params=(5, 0, 0, 0)), PLANE, "altitude-zero", "changed"),
        (MissionItem(3, Command.NAV_WAYPOINT, altitude=20.0), COPTER, "place-zero", "changed"),
        (MissionItem(3, Command.NAV_WAYPOINT, altitude=20.0), PX4, "place-zero", "changed"),
        (free(Command.CONDITION_DELAY, 5), PX4, "command-not-flown", "rejected"),
        (at(Command.NAV_VTOL_LAND), PX4, "vtol-only", "rejected"),
        (at(Command.NAV_VTOL_LAND), PLANE, "vtol-only", "ignored"),
        (free(Command.DO_VTOL_TRANSITION, 4), COPTER, "command-ignored", "ignored"),
        (at(Command.NAV_SPLINE_WAYPOINT), PLANE, "command-ignored", "ignored"),
        (free(Command.CONDITION_YAW, 90), PLANE, "command-ignored", "ignored"),
        (at(Command.NAV_WAYPOINT, 100.0, -3.0), PX4, "below-home", "warned"),
    ],
)  # fmt: skip
def test_an_item_that_breaks_a_rule(item, firmware, rule, effect):
    finding = one((TAKEOFF, WAYPOINT, item, FAR, LAND), firmware, rule)
    assert (finding.effect, finding.item) == (effect, 3)
    assert Firmware(*firmware).name in finding.message or "MAVLink" in finding.message


@pytest.mark.parametrize(
    ("item", "firmware"),
    [
        (at(Command.NAV_SPLINE_WAYPOINT, 200.0), COPTER),
        (at(Command.NAV_LOITER_TURNS, 200.0, params=(0.5, 0, 310.0, 0)), COPTER),
        (at(Command.NAV_WAYPOINT, 200.0, frame=10), COPTER),
        (at(Command.NAV_WAYPOINT, 200.0, frame=6), PX4),
        (free(Command.DO_CHANGE_SPEED, 1, 5.5, frame=3), COPTER),
        (free(Command.DO_CHANGE_SPEED, 1, 5.5, -1), PX4),
        (at(Command.DO_SET_ROI, 200.0, params=(3.0, 0, 0, 0)), PX4),
        (at(Command.NAV_WAYPOINT, 200.0, params=(0, 0, 0, NAN)), COPTER),
        (at(Command.NAV_WAYPOINT, 200.0, params=(1.5, 2.5, 0, -90.0)), PX4),
        (at(Command.NAV_WAYPOINT, 200.0, params=(0, 255.0, 255.0, 0)), PLANE),
        (at(Command.NAV_WAYPOINT, 200.0, params=(65535.0, 0, 0, 0)), COPTER),
        (at(Command.NAV_WAYPOINT, 200.0, up=61.99), COPTER),
        (at(Command.NAV_WAYPOINT, 200.0, up=61.999), PX4),
        (at(Command.NAV_WAYPOINT, 200.0, up=0.02), COPTER),
        (at(Command.NAV_WAYPOINT, 200.0, up=0.0), PLANE),
        (at(Command.NAV_WAYPOINT, 200.0, up=0.0), PX4),
        (at(Command.NAV_LOITER_TIME, 200.0, params=(5, 0, 0, 0)), COPTER),
        (free(Command.CONDITION_DELAY, 5), COPTER),
        (free(Command.CONDITION_YAW, 90), COPTER),
    ],
)  # fmt: skip
def test_an_item_that_keeps_all_rules(item, firmware):
    assert found((TAKEOFF, WAYPOINT, item, FAR, LAND), firmware) == set()


def test_of_a_refused_item_nothing_more_is_said():
    item = at(Command.NAV_WAYPOINT, params=(2.5, NAN, 0, 90.0), up=61.999)
    assert found((TAKEOFF, item, LAND), COPTER) == {("parameter-nan", 2)}


def test_a_message_names_the_number_the_rule_and_what_to_do():
    finding = one((TAKEOFF, at(Command.NAV_WAYPOINT, params=(0, 0, 0, 90.0)), LAND), COPTER, "parameter-dropped")
    assert finding.message == (
        "ArduCopter drops parameter 4 of NAV_WAYPOINT (yaw [deg]): 90; "
        "a CONDITION_YAW behind the waypoint turns a copter"
    )


# -- the number of items


@pytest.mark.parametrize(("firmware", "most"), [(COPTER, 717), (PLANE, 723), (PX4, 2000)])
def test_more_items_than_fit(firmware, most):
    def of(count):
        steps = [at(Command.NAV_WAYPOINT, 1.0 + step) for step in range(count - 2)]
        return [TAKEOFF, *steps, replace(LAND, latitude_deg=LATITUDE)]

    assert found(of(most), firmware) == set()
    assert found(of(most + 1), firmware) == {("capacity", None)}


# -- jumps


def jump(target, count=1.0):
    return free(Command.DO_JUMP, target, count)


@pytest.mark.parametrize("firmware", [COPTER, PLANE, PX4])
@pytest.mark.parametrize("target", [0.0, 6.0, -1.0, 0.9])
def test_a_jump_to_nowhere(firmware, target):
    finding = one((TAKEOFF, WAYPOINT, jump(target), FAR, LAND), firmware, "jump-target")
    assert (finding.effect, finding.item) == ("rejected", 3)


def test_a_jump_shifts_on_px4_alone():
    items = (TAKEOFF, WAYPOINT, jump(2.0), FAR, LAND)
    assert found(items, COPTER) == set()
    assert one(items, PX4, "jump-shift").number == "item 2 must be sent as 1"


@pytest.mark.parametrize("firmware", [COPTER, PX4])
def test_a_jump_without_a_count_is_passed_over(firmware):
    assert ("jump-never", 3) in found((TAKEOFF, WAYPOINT, jump(2.0, 0.0), FAR, LAND), firmware)


def test_a_jump_for_ever_leaves_the_rest_out_on_ardupilot_and_has_no_such_count_on_px4():
    items = (TAKEOFF, WAYPOINT, jump(2.0, -1.0), FAR, LAND)
    assert found(items, COPTER) == {("unreachable", 4), ("unreachable", 5)}
    assert found(items, PX4) == {("jump-shift", 3), ("jump-count", 3)}


def test_more_jumps_than_are_tracked():
    items = (TAKEOFF, WAYPOINT, *[jump(2.0)] * 16, LAND)
    assert found(items, COPTER) == {("jump-too-many", 18)}
    assert found((TAKEOFF, WAYPOINT, *[jump(2.0)] * 15, LAND), COPTER) == set()


# -- the way through the mission


@pytest.mark.parametrize("firmware", [COPTER, PLANE, PX4])
def test_a_mission_with_nothing_to_fly(firmware):
    assert ("no-navigation", None) in found((), firmware)
    assert ("no-navigation", None) in found((free(Command.DO_CHANGE_SPEED, 1, 5),), firmware)


def test_a_missing_takeoff():
    items = (WAYPOINT, FAR, LAND)
    assert one(items, COPTER, "takeoff-missing").effect == "rejected"
    assert one(items, PX4, "takeoff-missing").effect == "changed"
    assert found(items, PLANE) == set()
    waits = (free(Command.DO_CHANGE_SPEED, 1, 5), free(Command.NAV_DELAY, 5), *SOUND)
    assert found(waits, COPTER) == set()


@pytest.mark.parametrize("firmware", [PLANE, PX4])
def test_behind_a_return_nothing_is_flown(firmware):
    items = (TAKEOFF, WAYPOINT, RETURN, FAR, free(Command.DO_CHANGE_SPEED, 1, 5))
    assert found(items, firmware) == {("unreachable", 4), ("unreachable", 5)}


def test_behind_a_return_a_copter_needs_a_takeoff():
    assert found((TAKEOFF, WAYPOINT, RETURN, FAR), COPTER) == {("unreachable", 4)}
    assert found((TAKEOFF, WAYPOINT, RETURN, free(Command.NAV_DELAY, 9), TAKEOFF, FAR, LAND), COPTER) == set()


def test_a_landing_sequence_is_entered_from_elsewhere():
    items = (TAKEOFF, WAYPOINT, RETURN, at(Command.DO_LAND_START, frame=0), FAR, LAND)
    assert found(items, PLANE) == set()


def test_behind_an_endless_circle_nothing_is_flown_unless_a_jump_leads_there():
    circle = at(Command.NAV_LOITER_UNLIM, 100.0)
    assert found((TAKEOFF, circle, FAR, LAND), COPTER) == {("unreachable", 3), ("unreachable", 4)}
    assert found((TAKEOFF, jump(4.0), circle, FAR, LAND), COPTER) == set()


# -- places


def test_a_takeoff_to_less_than_a_metre():
    low = (at(Command.NAV_TAKEOFF, up=0.5), WAYPOINT, LAND)
    assert found(low, COPTER) == {("takeoff-raised", 1)}
    assert found(low, PX4) == set()


@pytest.mark.parametrize("firmware", [COPTER, PX4])
def test_places_that_become_one(firmware):
    near = replace(WAYPOINT, latitude_deg=WAYPOINT.latitude_deg + 2e-8)
    apart = replace(WAYPOINT, latitude_deg=WAYPOINT.latitude_deg + 3e-7)
    assert found((TAKEOFF, WAYPOINT, near, LAND), firmware) == {("place-rounded", 3)}
    assert found((TAKEOFF, WAYPOINT, apart, LAND), firmware) == set()
    assert found((TAKEOFF, WAYPOINT, WAYPOINT, LAND), firmware) == set()


# -- what PX4 looks at before it flies


def test_a_takeoff_behind_a_waypoint():
    assert ("takeoff-not-first", 2) in found((WAYPOINT, TAKEOFF, LAND), PX4)
    assert ("takeoff-not-first", 3) in found((TAKEOFF, WAYPOINT, TAKEOFF, LAND), PX4)
    assert found((free(Command.DO_CHANGE_SPEED, 1, 5), *SOUND), PX4) == set()


def test_a_takeoff_that_ends_at_home():
    assert ("takeoff-too-low", 1) in found((at(Command.NAV_TAKEOFF, up=0.0), WAYPOINT, LAND), PX4)
    assert ("takeoff-too-low", 1) in found((at(Command.NAV_TAKEOFF, up=480.0, frame=0), WAYPOINT, LAND), PX4)
    assert found((at(Command.NAV_TAKEOFF, up=520.0, frame=0), WAYPOINT, LAND), PX4) == set()
    assert found((at(Command.NAV_TAKEOFF, up=480.0, frame=0), WAYPOINT, LAND), PX4, home=None) == set()


@pytest.mark.parametrize(("north", "far"), [(890.0, False), (910.0, True)])
def test_a_first_waypoint_farther_than_mis_dist_1wp(north, far):
    items = (at(Command.NAV_WAYPOINT, north), at(Command.NAV_LAND, north, 0.0))
    assert (("first-waypoint-far", 1) in found(items, PX4)) == far
    assert ("first-waypoint-far", 1) not in found(items, PX4, home=None)


def test_a_gate_on_a_waypoint():
    gate = at(mavlink.MAV_CMD_CONDITION_GATE, 100.0)
    assert found((TAKEOFF, WAYPOINT, gate, LAND), PX4) == {("gate-too-close", 3)}
    assert found((TAKEOFF, WAYPOINT, at(mavlink.MAV_CMD_CONDITION_GATE, 101.0), LAND), PX4) == set()


def test_a_mission_that_begins_with_a_landing():
    assert ("landing-first", 1) in found((LAND,), PX4)
    assert ("landing-first", 1) in found((LAND,), PX4_PLANE)


def test_a_plane_on_px4_must_land():
    assert found((TAKEOFF, WAYPOINT, RETURN), PX4_PLANE) == {("landing-missing", None)}
    assert found((TAKEOFF, WAYPOINT, RETURN), PX4) == set()


START = free(Command.DO_LAND_START)


@pytest.mark.parametrize(
    ("items", "rule"),
    [
        ((TAKEOFF, START, START, FAR, LAND), ("land-start-twice", 3)),
        ((TAKEOFF, WAYPOINT, FAR, LAND, START), ("land-start-alone", 5)),
        ((TAKEOFF, START, FAR, LAND, RETURN), ("land-start-before-return", 5)),
        ((TAKEOFF, at(Command.NAV_LOITER_TIME, 700.0), LAND), ("approach-kind", 3)),
        ((TAKEOFF, at(Command.NAV_WAYPOINT, 700.0, 0.0), LAND), ("approach-below", 3)),
        ((TAKEOFF, at(Command.NAV_LOITER_TO_ALT, 100.0, params=(0, 150.0, 0, 0)), LAND), ("approach-circle", 3)),
        ((TAKEOFF, at(Command.NAV_LOITER_TO_ALT, 560.0, params=(0, 80.0, 0, 0)), LAND), ("approach-steep", 3)),
        ((TAKEOFF, at(Command.NAV_WAYPOINT, 550.0), LAND), ("approach-steep", 3)),
    ],
)
def test_landings_that_planes_on_px4_refuse(items, rule):
    assert rule in found(items, PX4_PLANE)
    assert not found(items, PX4) & {rule}


def test_landings_that_planes_on_px4_fly():
    # 50 m in 570 m are 5.01°, which the tenth of a degree lets pass
    assert found((TAKEOFF, START, at(Command.NAV_WAYPOINT, 570.0), LAND), PX4_PLANE) == set()
    circle = at(Command.NAV_LOITER_TO_ALT, 580.0, params=(0, 80.0, 0, 0))
    assert found((TAKEOFF, START, circle, LAND), PX4_PLANE) == set()


# -- without a vehicle type, and in words


def test_without_a_vehicle_type_what_both_have_in_common():
    items = (WAYPOINT, at(Command.NAV_SPLINE_WAYPOINT, params=(0, 0, 0, 90.0)), at(Command.NAV_VTOL_LAND, 300.0))
    assert found(items, ("ardupilot", None)) == {("parameter-dropped", 2)}
    assert "ArduPilot drops" in one(items, ("ardupilot", None), "parameter-dropped").message
    assert found(items, ("px4", None)) == {("command-unsupported", 2)}


def test_alike_findings_are_told_in_one_line():
    hold = [at(Command.NAV_WAYPOINT, 10.0 * step, params=(0, 0, 0, 10.0 * step)) for step in range(1, 6)]
    lines = told(lint(MissionItems((TAKEOFF, *hold, WAYPOINT, hold[0], at(Command.NAV_LOITER_UNLIM)), HOME), *COPTER))
    assert [(line.effect, line.line) for line in lines] == [
        (
            "dropped",
            "items 2 to 6, 8: ArduCopter drops parameter 4 of NAV_WAYPOINT (yaw [deg]): 10, 20 and 3 more; "
            "a CONDITION_YAW behind the waypoint turns a copter",
        )
    ]


def test_worst_effects_come_first_and_the_whole_mission_before_its_items():
    items = (at(Command.NAV_WAYPOINT, up=61.999), at(Command.NAV_WAYPOINT, params=(0, NAN, 0, 0)))
    findings = lint(MissionItems(items, HOME), *COPTER)
    assert [(found.rule, found.item) for found in findings] == [
        ("takeoff-missing", None),
        ("altitude-rounded", 1),
        ("parameter-nan", 2),
    ]
    assert [line.effect for line in told(findings)] == ["rejected", "rejected", "rounded"]


def test_frames_of_items_without_a_place_do_not_matter_to_ardupilot():
    assert found((TAKEOFF, free(Command.DO_CHANGE_SPEED, 1, 5, frame=int(Frame.MISSION)), LAND), COPTER) == set()
