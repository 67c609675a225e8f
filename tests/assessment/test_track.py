"""Where missions lead: every kind of item, every frame, returns, splines, the ground followed."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from gcs_windplan.assessment import assess
from gcs_windplan.assessment.home import with_home
from gcs_windplan.assessment.track import track_of
from gcs_windplan.errors import InputError
from gcs_windplan.geo.frame import GeoPoint
from gcs_windplan.mission import Command, Home, MissionItem
from gcs_windplan.mission.firmware.px4 import MOTION as PX4
from tests.assessment.cases import (
    AMSL,
    GROUND,
    HOME,
    RELATIVE,
    RETURN,
    TERRAIN,
    at,
    case,
    free,
    judged,
    point,
    ridge,
    takeoff,
)

one_millimetre = 1e-3
one_centimetre = 1e-2


def test_stops_and_legs_go_together():
    review = judged(at(0, 300), at(200, 300, 100), at(200, 300, 0, command=Command.NAV_LAND))
    assert len(review.stops) == len(review.legs) + 1
    assert [stop.label for stop in review.stops] == ["take-off", "waypoint", "land"]
    assert [stop.item for stop in review.stops] == [0, 2, 4]
    assert [leg.item for leg in review.legs] == [2, 3]
    for leg, start, end in zip(review.legs, review.stops, review.stops[1:], strict=False):
        assert leg.distance == pytest.approx(math.hypot(end.east - start.east, end.north - start.north))
        assert leg.climb == pytest.approx(end.altitude - start.altitude)
        assert end.distance - start.distance == pytest.approx(leg.distance)
        assert end.seconds == pytest.approx(start.seconds + start.hold + leg.seconds)


def test_frames():
    review = judged(at(0, 100, 70), at(0, 200, 570, frame=AMSL), at(0, 300, 90, frame=TERRAIN), terrain=ridge())
    assert [stop.altitude for stop in review.stops[1:]] == pytest.approx([570, 570, 590], abs=one_millimetre)
    review = judged(at(1000, 0, 70, frame=TERRAIN), terrain=ridge(60.0))
    assert review.stops[1].altitude == pytest.approx(GROUND + 60 + 70)


def test_jumps_are_flown_as_often_as_they_say():
    review = judged(at(0, 100), at(0, 200), free(Command.DO_JUMP, 2, 2), at(0, 300))
    assert [leg.item for leg in review.legs] == [2, 3, 2, 3, 2, 3, 5]


def test_a_jump_ahead_for_ever_leads_past_items():
    review = judged(free(Command.DO_JUMP, 4, -1), at(0, 100), at(0, 200))
    assert [leg.item for leg in review.legs] == [4]
    assert review.remarks == ()
    review = judged(at(0, 100), free(Command.DO_JUMP, 2, -1), at(0, 200))
    assert "jumps back indefinitely" in review.remarks[0]


def test_a_delay_is_a_hold_at_the_stop_before():
    review = judged(at(0, 300), free(Command.NAV_DELAY, 25), at(0, 600, 80, 7.0))
    assert [stop.hold for stop in review.stops] == pytest.approx([0.0, 25.0, 7.0])
    assert review.sums.seconds == pytest.approx(review.stops[-1].seconds + 7.0)


@pytest.mark.parametrize(("height", "expected"), [(80.0, 80.0), (6.0, 15.0)])
def test_a_return_goes_up_home_and_down(height, expected):
    review = assess(replace(case(at(0, 900, height), RETURN), mission=case(at(0, 900, height), RETURN).mission))
    last = review.stops[-1]
    assert (last.label, last.item) == ("return", 3)
    assert (last.east, last.north) == pytest.approx((0, 0), abs=one_millimetre)
    assert last.altitude == pytest.approx(GROUND + expected)
    assert review.profile.altitude[-1] == pytest.approx(GROUND)
    assert review.legs[-1].distance == pytest.approx(900, abs=one_centimetre)


def test_px4_returns_at_its_own_height():
    review = judged(at(0, 300, 10), RETURN, mission={"autopilot": "px4"}, pace=PX4)
    assert review.stops[-1].altitude == pytest.approx(GROUND + 30)


def test_px4_flies_to_the_place_of_its_takeoff():
    lift = at(30, 40, 20, command=Command.NAV_TAKEOFF)
    flown = case(at(0, 100, 20), mission={"autopilot": "px4"})
    review = assess(replace(flown, mission=replace(flown.mission, items=(lift, *flown.mission.items[1:]))))
    assert review.legs[0].distance == pytest.approx(50, abs=one_centimetre)
    assert len(judged(at(0, 100, 20)).legs) == 1


def test_landing_and_taking_off_again():
    land = MissionItem(RELATIVE, Command.NAV_LAND)
    review = judged(at(0, 500), land, takeoff(50), at(0, 0, 50), RETURN)
    assert len(review.stops) == len(review.legs) + 1
    assert np.count_nonzero(np.abs(review.profile.altitude - GROUND) < one_millimetre) >= 3
    assert (np.diff(review.profile.seconds) >= -1e-9).all()


def test_a_leg_above_terrain_keeps_its_height():
    """80 m above ground over a ridge of 60 m: never nearer, and as high over its top."""
    review = judged(at(400, 0, 80, frame=TERRAIN), at(1600, 0, 80, frame=TERRAIN), terrain=ridge())
    leg = review.legs[1]
    assert leg.clearance == pytest.approx(80, abs=2.0)
    assert leg.height == pytest.approx(80, abs=2.0)
    inside = review.profile.leg == 2
    assert review.profile.altitude[inside].max() == pytest.approx(GROUND + 140, abs=1.0)
    straight = judged(at(400, 0, 80), at(1600, 0, 80), terrain=ridge())
    assert straight.legs[1].clearance == pytest.approx(20, abs=one_centimetre)


def test_heights_between_two_heights_above_terrain_change_evenly():
    review = judged(at(200, 0, 50, frame=TERRAIN), at(1800, 0, 130, frame=TERRAIN), terrain=ridge())
    profile, inside = review.profile, review.profile.leg == 2
    above = profile.altitude[inside] - profile.ground[inside]
    expected = 50 + 80 * (profile.east[inside] - 200) / 1600
    assert above == pytest.approx(expected, abs=2.0)


def test_a_spline_is_ardupilots_hermite_curve():
    """Between stops it is straight; passed, it leaves its end parallel to the next way and its start to the last."""
    spline = at(300, 300, 80, command=Command.NAV_SPLINE_WAYPOINT)
    flown = case(at(0, 300), spline, at(300, 900))
    path = track_of(with_home(flown)).paths[2]
    first, last = path[1] - path[0], path[-1] - path[-2]
    assert first[1] > 5 * abs(first[0]), "leaves northwards, as it came"
    assert last[1] > 5 * abs(last[0]), "arrives northwards, as it goes on"
    p0, p1 = np.array([0.0, 300.0]), np.array([300.0, 300.0])
    v0, v1 = np.array([0.0, 300.0]), np.array([0.0, 600.0])  # the ways before and after, 900 m together
    t = np.linspace(0, 1, 25)[:, None]
    hermite = (
        (2 * t**3 - 3 * t**2 + 1) * p0 + (t**3 - 2 * t**2 + t) * v0 + (3 * t**2 - 2 * t**3) * p1 + (t**3 - t**2) * v1
    )
    assert path[:, :2] == pytest.approx(hermite, abs=one_centimetre)
    stopped = track_of(with_home(case(spline, free(Command.NAV_DELAY, 5), at(300, 900)))).paths[1]
    assert stopped[:, 0] == pytest.approx(stopped[:, 1], abs=1.0)


def test_px4_flies_splines_straight():
    spline = at(300, 300, 80, command=Command.NAV_SPLINE_WAYPOINT)
    review = judged(at(0, 300), spline, at(300, 900), mission={"autopilot": "px4"})
    assert review.legs[1].length == pytest.approx(300, abs=one_centimetre)
    assert any("straight" in remark for remark in review.remarks)


def test_a_fixed_wing_glides_to_its_landing_and_circles():
    items = (
        at(0, 1000, 80),
        at(500, 1000, 80, 3, 0, 50, command=Command.NAV_LOITER_TURNS),
        at(0, 500, 0, command=Command.NAV_LAND),
    )
    review = judged(*items, mission={"vehicle_type": "fixed-wing"})
    assert [stop.label for stop in review.stops] == ["take-off", "waypoint", "loiter", "land"]
    assert review.legs[2].climb == pytest.approx(-80, abs=one_millimetre)
    assert review.stops[2].hold == pytest.approx(3 * 2 * math.pi * 50 / 15.0)
    assert review.legs[0].seconds == pytest.approx(1000 / 15.0, abs=0.01)


def test_a_fixed_wings_speeds():
    items = (free(Command.DO_CHANGE_SPEED, 0, 20), at(0, 1000), free(Command.DO_CHANGE_SPEED, 1, 30), at(0, 3000))
    review = judged(*items, mission={"vehicle_type": "fixed-wing"}, cruise=15.0, pace=replace(PX4, airspeed=25.0))
    assert [leg.ground_speed for leg in review.legs] == pytest.approx([20, 25], abs=0.01)


def test_a_home_that_is_missing_is_under_the_first_place():
    review = judged(at(900, 0, 40), at(900, 500, 40), mission={"home": None}, terrain=ridge(60.0, 900.0))
    assert review.stops[0].altitude == pytest.approx(GROUND + 60 + 80, abs=0.01)
    assert "names no home" in review.remarks[0]
    with pytest.raises(InputError, match="outside of the terrain"):
        judged(at(90_000, 0, 40), mission={"home": None})
    with pytest.raises(InputError, match="neither home nor any place"):
        judged(mission={"home": None})


def test_a_home_at_a_blank_zero_is_on_the_ground():
    review = judged(at(0, 500, 40), mission={"home": Home(HOME.point, 0.0)})
    assert review.stops[1].above_ground == pytest.approx(40)
    assert "blank" in review.remarks[0]


def test_a_mission_that_leads_nowhere_is_refused():
    flown = case()
    with pytest.raises(InputError, match="leads nowhere"):
        assess(replace(flown, mission=replace(flown.mission, items=(free(Command.DO_CHANGE_SPEED, 1, 5),))))


def test_a_mission_of_a_takeoff_alone():
    review = judged()
    assert (len(review.stops), len(review.legs)) == (1, 0)
    assert math.isnan(review.sums.clearance)
    assert [finding.rule for finding in review.findings] == ["ending"]


def test_a_place_of_zeros_means_here():
    review = judged(at(0, 300), MissionItem(RELATIVE, Command.NAV_WAYPOINT, altitude=120.0))
    assert (review.legs[1].distance, review.legs[1].climb) == pytest.approx((0, 40), abs=one_millimetre)


def test_the_profile_holds_every_corner():
    review = judged(at(0, 300), at(200, 300, 100), at(200, 900, 60), RETURN, terrain=ridge())
    profile = review.profile
    for stop in review.stops:
        gap = np.hypot(profile.east - stop.east, profile.north - stop.north) + np.abs(profile.altitude - stop.altitude)
        assert gap.min() < one_millimetre
    assert len(profile.distance) <= 1600
    assert (np.diff(profile.distance) >= -1e-9).all()
    assert (np.diff(profile.seconds) >= -1e-9).all()
    assert profile.leg[0] == 0
    assert set(profile.leg) == set(range(len(review.legs) + 1))
    assert review.ground.heights.shape == (len(review.ground.north), len(review.ground.east))
    assert max(review.ground.heights.shape) <= 300
    latitude, longitude = review.frame.to_geographic(np.array([[profile.east[7], profile.north[7]]]))
    assert (latitude[0], longitude[0]) == pytest.approx((profile.latitude_deg[7], profile.longitude_deg[7]))


def test_places_far_from_the_frames_origin_are_the_missions():
    review = judged(at(0, 300), at(3500, 3500))
    there = point(3500, 3500)
    assert GeoPoint(review.stops[-1].latitude_deg, review.stops[-1].longitude_deg).latitude_deg == pytest.approx(
        there.latitude_deg, abs=1e-9
    )
