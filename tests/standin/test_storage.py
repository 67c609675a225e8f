"""What the autopilots keep of an item, and what they refuse."""

from __future__ import annotations

import math

import pytest

from gcs_windplan.mission.firmware import firmware_of
from gcs_windplan.mission.firmware.floats import single
from gcs_windplan.standin import storage
from gcs_windplan.standin.items import MISSION, RALLY, Refusal, StoredItem

from .speaking import DELAY, JUMP, LAND, LATITUDE, LOITER_TIME, LONGITUDE, RALLY_POINT, RTL, SPEED, TAKEOFF, WAYPOINT

NAN, INF = math.nan, math.inf
PARAM1, PARAM2, PARAM3, PARAM4, PARAM5, PARAM6, PARAM7 = range(6, 13)
ERROR, UNSUPPORTED_FRAME, UNSUPPORTED, INVALID = 1, 2, 3, 5
COPTER, PX4 = firmware_of("ardupilot", "multicopter"), firmware_of("px4", "multicopter")


def keep(firmware, sent, mission_type):
    return storage.store(sent, mission_type, firmware)


def placed(command=WAYPOINT, params=(0.0, 0.0, 0.0, 0.0), frame=3, z=50.0, x=LATITUDE, y=LONGITUDE):
    return StoredItem(frame, command, params, x, y, z)


def free(command, params, frame=2, x=0, y=0, z=0.0):
    return StoredItem(frame, command, params, x, y, z)


@pytest.mark.parametrize(
    ("sent", "held"),
    [
        (placed(z=61.999), placed(z=single(61.99))),
        (placed(z=-61.999), placed(z=single(-61.99))),
        (placed(frame=6), placed(frame=3)),
        (placed(frame=5), placed(frame=0)),
        (placed(frame=11), placed(frame=10)),
        (placed(frame=2), placed(frame=0)),
        (placed(params=(-1.0, 0, 0, 0)), placed(params=(65535.0, 0, 0, 0))),
        (placed(params=(3.9, 5, 6, 7)), placed(params=(3.0, 0, 0, 0))),
        (placed(params=(0, 0, 0, NAN)), placed()),
        (placed(TAKEOFF, (15.5, 0, 0, NAN)), placed(TAKEOFF, (15.0, 0, 0, 0))),
        (placed(LOITER_TIME, (30.7, 1, -80, 0.5)), placed(LOITER_TIME, (30.0, 0, -1, 1))),
        (free(SPEED, (1.0, 12.34, -1, 5), frame=3), free(SPEED, (1.0, single(12.34), -1, 0), frame=0)),
        (free(RTL, (1, 2, 3, 4), frame=3, x=7, y=8, z=9.0), free(RTL, (0.0, 0, 0, 0), frame=0)),
        (free(JUMP, (3.7, -1, 2, 3)), free(JUMP, (3.0, -1, 0, 0), frame=0)),
        (free(DELAY, (2.5, -1, -1, -1)), free(DELAY, (2.5, -1, -1, -1), frame=0)),
        (free(203, (0, 0, 0, 0), frame=0, x=1), free(203, (0.0, 0, 0, 0), frame=0, x=1)),
    ],
)  # fmt: skip
def test_measured_what_arducopter_keeps(sent, held):
    kept = keep(COPTER, sent, MISSION)
    assert isinstance(kept, StoredItem)
    assert (kept.frame, kept.command, kept.x, kept.y, kept.z) == (held.frame, held.command, held.x, held.y, held.z)
    assert kept.params == tuple(map(float, held.params))
    assert kept.autocontinue
    assert kept.current == 0


def test_arducopter_keeps_places_to_the_last_digit_and_autocontinue_always():
    kept = keep(COPTER, StoredItem(3, WAYPOINT, x=-899_999_999, y=1_799_999_999, autocontinue=False), MISSION)
    assert (kept.x, kept.y, kept.autocontinue) == (-899_999_999, 1_799_999_999, True)


@pytest.mark.parametrize(
    ("sent", "code"),
    [
        (placed(params=(NAN, 0, 0, 0)), PARAM1),
        (placed(params=(0, NAN, 0, 0)), PARAM2),
        (placed(params=(0, 0, NAN, 0)), PARAM3),
        (placed(params=(0, 0, 0, INF)), PARAM4),
        (placed(TAKEOFF, (NAN, 0, 0, 0)), PARAM1),
        (free(SPEED, (NAN, 5, 0, 0)), PARAM1),
        (free(SPEED, (1, 5, 0, NAN)), PARAM4),
        (placed(z=NAN), PARAM7),
        (placed(z=83_000.0), PARAM7),
        (placed(z=-83_000.0), PARAM7),
        (placed(x=900_000_001), PARAM5),
        (placed(y=-1_800_000_001), PARAM6),
        (placed(frame=1), UNSUPPORTED_FRAME),
        (placed(frame=4), UNSUPPORTED_FRAME),
        (placed(frame=8), UNSUPPORTED_FRAME),
        (placed(frame=12), UNSUPPORTED_FRAME),
        (free(0, (0, 0, 0, 0)), INVALID),
        (free(31_000, (0, 0, 0, 0)), UNSUPPORTED),
    ],
)
def test_measured_what_arducopter_refuses(sent, code):
    refusal = keep(COPTER, sent, MISSION)
    assert isinstance(refusal, Refusal)
    assert refusal.code == code
    assert refusal.reason


def test_arducopter_takes_what_lies_just_inside():
    for sent in (placed(z=82_999.0), placed(x=900_000_000), placed(y=-1_800_000_000), free(SPEED, (1, 0, 0, 0), 12)):
        assert isinstance(keep(COPTER, sent, MISSION), StoredItem)


def test_arducopter_keeps_what_it_kept():
    for sent in (placed(z=61.999, params=(3.9, 1, 1, 1)), placed(LOITER_TIME, (30.7, 1, -80, 0.5)), placed(LAND)):
        once = keep(COPTER, sent, MISSION)
        assert keep(COPTER, once, MISSION) == once


def test_arducopters_rally_points_are_above_home():
    point = placed(RALLY_POINT, frame=0)
    assert keep(COPTER, point, RALLY).code == UNSUPPORTED_FRAME
    assert keep(COPTER, placed(RALLY_POINT, z=99.9), RALLY).z == 99.0


@pytest.mark.parametrize(
    ("sent", "held"),
    [
        (placed(z=61.999), placed(z=single(61.999), frame=6)),
        (placed(frame=0), placed(frame=5)),
        (placed(params=(1.5, 2.5, 3.5, -90)), placed(params=(1.5, 2.5, 0, 270.0), frame=6)),
        (placed(TAKEOFF, (15, 1, 1, 45)), placed(TAKEOFF, (0, 0, 0, 45), frame=6)),
        (free(SPEED, (1, 12.34, -1, 0)), free(SPEED, (1, single(12.34), -1, 0))),
        (free(RTL, (0, 0, 0, 0)), free(RTL, (0, 0, 0, 0))),
        (free(JUMP, (1, 3, 0, 0)), free(JUMP, (1, 3, 0, 0))),
        (placed(LAND, (5, 1, 3, 0)), placed(LAND, (0, 1, 0, 0), frame=6)),
    ],
)
def test_what_px4_keeps(sent, held):
    kept = keep(PX4, sent, MISSION)
    assert isinstance(kept, StoredItem)
    assert (kept.frame, kept.command, kept.x, kept.y, kept.z) == (held.frame, held.command, held.x, held.y, held.z)
    assert kept.params == pytest.approx(tuple(map(float, held.params)))


def test_px4_takes_nan_for_no_yaw():
    kept = keep(PX4, placed(params=(0, 0, 0, NAN)), MISSION)
    assert math.isnan(kept.params[3])


@pytest.mark.parametrize(
    ("sent", "code"),
    [
        (placed(frame=10), UNSUPPORTED_FRAME),
        (placed(frame=11), UNSUPPORTED_FRAME),
        (placed(frame=1), UNSUPPORTED_FRAME),
        (placed(82), UNSUPPORTED),  # spline
        (placed(SPEED, (1, 5, 0, 0), frame=3), UNSUPPORTED),  # speed, return and delay only in frame MISSION
        (placed(RTL, frame=0), UNSUPPORTED),
        (placed(DELAY, frame=0), UNSUPPORTED),
        (placed(WAYPOINT, frame=2), UNSUPPORTED),
    ],
)
def test_what_px4_refuses(sent, code):
    refusal = keep(PX4, sent, MISSION)
    assert isinstance(refusal, Refusal)
    assert refusal.code == code


@pytest.mark.parametrize(
    ("items", "fault"),
    [
        ([placed(TAKEOFF), placed()], None),
        ([free(SPEED, (1, 5, 0, 0)), placed(TAKEOFF), placed()], None),
        ([placed(), placed()], None),
        ([placed(), placed(TAKEOFF)], "takeoff is not the first"),
        ([placed(TAKEOFF), free(JUMP, (2, 1, 0, 0))], "there is none"),
        ([placed(TAKEOFF), placed(z=NAN)], "no altitude"),
    ],
)
def test_what_px4_takes_and_does_not_fly(items, fault):
    found = storage.infeasible(items, PX4)
    assert found is None if fault is None else fault in found
