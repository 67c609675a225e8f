"""What is found: each rule broken and kept, its number and place against twins by hand."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from gcs_windplan.assessment import AssessmentLimits, Source, assess
from gcs_windplan.errors import InputError, WindError
from gcs_windplan.geo.frame import GeoPoint
from gcs_windplan.mission import Command, Fence, FenceCircle, FencePolygon, Home, RallyPoint
from gcs_windplan.scene import Airspace, Prism
from gcs_windplan.terrain import Dem, Obstacle, Obstacles
from gcs_windplan.vehicle import Airframe, Battery, FixedWing, Vehicle, air_density
from gcs_windplan.wind import ConstantWind
from gcs_windplan.wind.field import Steady
from tests.assessment.cases import (
    GROUND,
    HOME,
    RETURN,
    SWIFT,
    airframe,
    at,
    case,
    found,
    free,
    judged,
    local,
    point,
    ridge,
)
from tests.oracles.judging import sampled_heights
from tests.worlds import rough_dem

one_millimetre = 1e-3
one_centimetre = 1e-2
one_metre = 1.0


# The ground


def test_clearance_over_a_ridge():
    """80 m above home over a ridge of 60 m: 20 m, right over its top."""
    review = judged(at(2000, 0), terrain=ridge(), limits=AssessmentLimits(clearance=30))
    (finding,) = found(review, "clearance")
    assert (finding.severity, finding.item, finding.leg) == ("danger", 2, 1)
    assert (finding.value, finding.limit, finding.unit) == (pytest.approx(20, abs=one_millimetre), 30, "m")
    assert local(finding) == pytest.approx([1000, 0], abs=one_centimetre)
    assert finding.distance == pytest.approx(1000, abs=one_centimetre)
    assert "raise it there by 10 m" in finding.message
    assert review.totals.clearance == pytest.approx(20, abs=one_millimetre)
    assert found(judged(at(2000, 0), terrain=ridge(), limits=AssessmentLimits(clearance=20)), "clearance") == []


def test_below_the_ground_without_any_limit():
    (finding,) = found(judged(at(2000, 0), terrain=ridge(100)), "clearance")
    assert finding.value == pytest.approx(-20, abs=one_millimetre)
    assert "20.0 m below the ground" in finding.message


@given(st.integers(0, 50), st.floats(-800, 800), st.floats(-800, 800), st.floats(30, 120), st.floats(30, 120))
def test_clearance_and_height_are_those_of_dense_samples(seed, east, north, first, second):
    dem = rough_dem(seed)
    ground = float(dem.heights_at(np.zeros((1, 2)))[0])
    review = judged(
        at(300, 200, first), at(east, north, second), terrain=dem, mission={"home": Home(HOME.point, ground)},
        limits=AssessmentLimits(clearance=1000, max_height=1),
    )  # fmt: skip
    leg, start, end = review.legs[1], review.stops[1], review.stops[2]
    a, b = (np.array([stop.east, stop.north, stop.altitude]) for stop in (start, end))
    low, high = sampled_heights(dem, a, b, 801)
    assert leg.clearance <= low + one_millimetre
    assert leg.height >= high - one_millimetre
    assert leg.clearance == pytest.approx(low, abs=max(0.02 * leg.distance, one_metre))
    for rule, value, ends in (("clearance", leg.clearance, "lowest"), ("height", leg.height, "highest")):
        finding = found(review, rule)[1]
        place = local(finding)
        share = np.hypot(*(place - a[:2])) / leg.distance if leg.distance > 0.1 else 0.0
        above = a[2] + share * (b[2] - a[2]) - float(dem.heights_at(place[None])[0])
        assert above == pytest.approx(value, abs=one_centimetre), ends


@given(st.floats(0, 200))
def test_a_mission_raised_is_as_much_clearer(higher):
    low, high = (
        judged(at(2000, 0, height), at(3000, 500, height), terrain=ridge()).legs[1].clearance
        for height in (80.0, 80.0 + higher)
    )
    assert high == pytest.approx(low + higher, abs=one_millimetre)


def test_height_above_ground():
    review = judged(at(0, 1000, 150), limits=AssessmentLimits(max_height=120))
    (finding,) = found(review, "height")
    assert (finding.value, finding.limit) == pytest.approx((150, 120))
    assert local(finding) == pytest.approx([0, 1000], abs=one_centimetre)


def test_ground_that_is_not_known():
    review = judged(at(0, 3500), at(0, 5500), at(0, 3500))
    leaving, coming = found(review, "terrain")
    assert (leaving.leg, coming.leg) == (2, 3)
    assert local(leaving) == pytest.approx([0, 4000], abs=one_metre)
    assert leaving.value == pytest.approx(1500, abs=one_metre)
    assert "by 1500.0 m" in leaving.message
    assert math.isnan(review.legs[1].clearance)
    assert review.totals.clearance == pytest.approx(80)


def test_a_gap_in_the_ground():
    heights = np.full((41, 41), GROUND)
    heights[15, 20] = np.nan
    hole = Dem.local(heights, -2000, 2000, 100)
    (finding,) = found(judged(at(0, 1500), terrain=hole), "terrain")
    assert "gap" in finding.message
    assert local(finding) == pytest.approx([0, 400], abs=one_metre)


def test_a_fixed_wing_may_come_down_to_land():
    items = (at(0, 1000, 80), at(0, 300, 0, command=Command.NAV_LAND))
    review = judged(*items, mission={"vehicle_type": "fixed-wing"}, limits=AssessmentLimits(clearance=30))
    assert [finding.rule for finding in review.findings] == []


def test_circles():
    """80 m above home, 150 m beside a ridge of 60 m: its circles of 150 m lead over the top."""
    turns = at(850, 0, 80, 3, 0, 150, command=Command.NAV_LOITER_TURNS)
    review = judged(
        turns, terrain=ridge(), mission={"vehicle_type": "fixed-wing"}, limits=AssessmentLimits(clearance=30)
    )
    (finding,) = found(review, "circle")
    assert finding.value == pytest.approx(20, abs=0.1)
    assert "circles of 150 m" in finding.message
    (turning,) = found(judged(turns, terrain=ridge(), limits=AssessmentLimits(clearance=30)), "circle")
    assert turning.value == pytest.approx(20, abs=0.1)
    waits = at(850, 0, 80, 3, 0, 150, command=Command.NAV_LOITER_TIME)
    assert found(judged(waits, terrain=ridge(), limits=AssessmentLimits(clearance=30)), "circle") == []


def test_obstacles():
    corners = np.array([(x, y, z) for x in (490, 510) for y in (-20, 20) for z in (GROUND, GROUND + 75)], dtype=float)
    faces = [(0, 1, 3), (0, 3, 2), (4, 6, 7), (4, 7, 5), (0, 4, 5), (0, 5, 1), (2, 3, 7), (2, 7, 6), (0, 2, 6),
             (0, 6, 4), (1, 5, 7), (1, 7, 3)]  # fmt: skip
    mast = Obstacles([Obstacle("mast", corners, np.array(faces), 10.0)])
    (finding,) = found(judged(at(2000, 0), obstacles=mast), "obstacle")
    assert finding.value == pytest.approx(-5.0, abs=one_centimetre)
    assert abs(local(finding)[0] - 500) < 25
    assert (
        found(judged(at(2000, 0), obstacles=Obstacles([Obstacle("mast", corners, np.array(faces), 4.0)])), "obstacle")
        == []
    )


# Areas


BOX = np.array([[500.0, -200.0], [900.0, -200.0], [900.0, 200.0], [500.0, 200.0]])


@pytest.mark.parametrize(
    ("floor", "ceiling", "first"),
    [
        (-np.inf, np.inf, 500.0),
        (GROUND + 90, np.inf, 625.0),
        (-np.inf, GROUND + 70, None),
        (GROUND, GROUND + 95, 500.0),
    ],
)
def test_where_a_keep_out_is_entered(floor, ceiling, first):
    """From 80 m at the origin up to 100 m at 1250 m east: at 625 m it is 90 m high."""
    review = judged(at(1250, 0, 100), airspace=Airspace((Prism("school", BOX, floor, ceiling),)))
    findings = found(review, "keep-out")
    if first is None:
        assert findings == []
    else:
        assert findings[0].distance == pytest.approx(first, abs=one_centimetre)
        assert "'school'" in findings[0].message


def test_a_leg_along_a_border_only_grazes_it():
    """A planner leads legs along borders; rounding to MAVLink's numbers moves them by less than 2 cm."""
    for inwards, breaks in ((0.01, False), (0.1, True)):
        items = (at(0, 200 - inwards), at(1500, 200 - inwards))
        assert bool(found(judged(*items, airspace=Airspace((Prism("school", BOX),))), "keep-out")) is breaks
    around = Prism("permit", np.array([[-500.0, -500], [700, -500], [700, 500], [-500, 500]]))
    for outwards, breaks in ((0.01, False), (0.1, True)):
        items = (at(700 + outwards, 0), at(700 + outwards, 300))
        assert bool(found(judged(*items, airspace=Airspace((), (around,))), "keep-in")) is breaks


def test_a_takeoff_and_a_landing_inside_of_areas():
    """From home straight up into a keep-out that begins 30 m above it; a keep-in's floor does not bind there."""
    here = np.array([[-50.0, -50.0], [50.0, -50.0], [50.0, 50.0], [-50.0, 50.0]])
    up = Prism("roof", here, GROUND + 30, GROUND + 40)
    room = Prism("room", 100 * here, GROUND + 60, GROUND + 200)
    review = judged(at(0, 300), RETURN, airspace=Airspace((up,), (room,)))
    lifting, landing = found(review, "keep-out")
    assert (lifting.item, lifting.leg, lifting.distance) == (1, None, 0)
    assert "the take-off (item 1) enters" in lifting.message
    assert "the landing (item 3) enters" in landing.message
    assert found(review, "keep-in") == []


def test_where_a_keep_in_is_left():
    around = Prism("permit", np.array([[-500.0, -500], [700, -500], [700, 500], [-500, 500]]))
    review = judged(at(500, 0), at(1000, 0), at(0, 0), airspace=Airspace((), (around,)))
    out, back = found(review, "keep-in")
    assert (out.leg, back.leg) == (2, 3)
    assert local(out) == pytest.approx([700, 0], abs=one_centimetre)
    assert local(back) == pytest.approx([1000, 0], abs=one_centimetre), "it begins outside"
    ceiling = Airspace((), (Prism("low", around.corners, ceiling=GROUND + 90),))
    (high,) = found(judged(at(500, 0, 100), airspace=ceiling), "keep-in")
    assert local(high) == pytest.approx([250, 0], abs=one_centimetre)


def test_the_missions_own_fence():
    square = FencePolygon(tuple(point(e, n) for e, n in [(-100, -100), (1000, -100), (1000, 1000), (-100, 1000)]))
    round_hole = FenceCircle(point(500, 500), 100.0, inclusion=False)
    ring = FenceCircle(point(0, 0), 1200.0)
    fence = Fence((square,), (round_hole, ring))
    review = judged(at(900, 900), at(900, 1100), mission={"fence": fence})
    findings = found(review, "fence")
    assert [finding.leg for finding in findings] == [1, 1, 2, 2]
    hole = next(finding for finding in findings if "enters the mission's own fence circle 1" in finding.message)
    leaving = next(finding for finding in findings if "leaves the mission's own fence circle 2" in finding.message)
    polygon = next(finding for finding in findings if "leaves the mission's own fence polygon 1" in finding.message)
    assert local(polygon) == pytest.approx([900, 1000], abs=0.1)
    assert local(hole) == pytest.approx(np.array([500, 500]) - 100 / math.sqrt(2), abs=0.1)
    assert local(leaving) == pytest.approx(1200 / math.sqrt(2) * np.ones(2), abs=0.2)
    assert {outline.kind for outline in review.outlines} == {"fence-in", "fence-out"}
    assert found(judged(at(300, 0), at(0, 300), mission={"fence": Fence((square,))}), "fence") == []


@given(st.floats(-1500, 1500), st.floats(-1500, 1500), st.floats(-1500, 1500), st.floats(-1500, 1500))
def test_the_first_break_is_that_of_dense_samples(e0, n0, e1, n1):
    review = judged(at(e0, n0), at(e1, n1), airspace=Airspace((Prism("school", BOX),)))
    a, b = np.array([e0, n0]), np.array([e1, n1])
    share = np.linspace(0, 1, 4001)
    places = a + share[:, None] * (b - a)
    inside = (np.abs(places[:, 0] - 700) < 200) & (np.abs(places[:, 1]) < 200)
    finding = next((one for one in found(review, "keep-out") if one.leg == 2), None)
    if inside.any():
        step = np.hypot(*(b - a)) / 4000
        assert finding is not None
        assert np.hypot(*(local(finding) - places[np.argmax(inside)])) <= step + one_centimetre


# The air


def test_wind_and_gusts_beyond_their_limits():
    review = judged(
        at(0, 900), wind=ConstantWind(6, 8), gusts=(ConstantWind(14, 0),), limits=AssessmentLimits(wind=9, gust=12)
    )
    wind, gust = found(review, "wind")[0], found(review, "gust")[0]
    assert (wind.value, gust.value) == pytest.approx((10, 14))
    assert (review.totals.wind, review.totals.gust) == pytest.approx((10, 14))
    still = AssessmentLimits(wind=10, gust=14)
    kept = judged(at(0, 900), RETURN, wind=ConstantWind(6, 8), gusts=(ConstantWind(14, 0),), limits=still)
    assert kept.verdict == "clear"


def test_legs_in_a_row_make_one_finding_where_it_is_worst():
    """Wind from the south of 1 m/s and another for each 100 m to the north: legs 2 to 4 lead beyond 900 m."""
    review = judged(at(0, 600), at(0, 1200), at(0, 1500), at(0, 600), at(0, 0), RETURN, wind=Rising(),
                    limits=AssessmentLimits(wind=10))  # fmt: skip
    (finding,) = found(review, "wind")
    assert finding.leg in (3, 4)
    assert finding.value == pytest.approx(review.totals.wind)
    assert finding.value == pytest.approx(16, abs=0.5)
    assert finding.message.startswith(f"legs 2 to 4 meet, at worst on leg {finding.leg} (to item {finding.leg + 1}),")


def test_members_are_looked_at_one_by_one():
    """A mean of 5 m/s from four members: one blows at 14 m/s, two of them faster than 10, none stops it but at 25."""
    calm = ConstantWind(2.5, 0)

    def windy(*members, robust=0.75):
        fields = tuple(ConstantWind(-speed, 0) for speed in members)
        return judged(at(500, 0), at(900, 0), RETURN, wind=calm, members=fields, robust=robust,
                      limits=AssessmentLimits(wind=10))  # fmt: skip

    one, two = windy(2, 2, 2, 14), windy(2, 2, 12, 14)
    for review, severity, count in ((one, "warning", 1), (two, "danger", 2)):
        (finding,) = found(review, "wind")
        assert (finding.severity, finding.value) == (severity, pytest.approx(14))
        assert f"in the strongest of 4 members, {count} of which" in finding.message
        assert review.totals.wind == pytest.approx(14)
        assert found(review, "flyable") == []
        assert "mean wind of 4 members" in " ".join(review.remarks)
    for members, severity in (((2, 2, 2, 25), "warning"), ((2, 2, 25, 25), "danger")):
        (stopped,) = found(windy(*members), "flyable")
        assert stopped.severity == severity
        assert f"in {members.count(25)} of 4 members" in stopped.message
    (strict,) = found(windy(2, 2, 2, 25, robust=0.9), "flyable")
    assert strict.severity == "danger"
    ten = windy(*[2] * 9, 25, robust=0.9)
    assert found(ten, "flyable")[0].severity == "warning", "one of ten is what nine of ten leave over"


@dataclass(frozen=True)
class Rising(Steady):
    """Wind from the south that grows northwards."""

    name: str = "rising"
    resolution: float = 100.0

    def at(self, points, seconds=0.0):
        return np.column_stack([0 * points[:, 1], 1 + points[:, 1] / 100, 0 * points[:, 1]])


@dataclass(frozen=True)
class Edged(Steady):
    """Wind that is known as far as 1000 m north, and below 600 m above the sea."""

    name: str = "edged"
    resolution: float = 100.0

    def at(self, points, seconds=0.0):
        if (points[:, 1] > 1000).any():
            raise WindError("the wind ends 1.2 km short of there; take a larger file")
        return np.where(points[:, 2:] > 600, np.nan, np.tile([2.0, 0.0, 0.0], (len(points), 1)))


def test_wind_that_is_not_known():
    review = judged(at(0, 800), at(0, 1500), at(0, 200), at(0, 200, 160), wind=Edged())
    north, back, high = found(review, "forecast")
    assert (north.leg, back.leg, high.leg) == (2, 3, 4)
    assert "ends 1.2 km short" in north.message
    assert "above the highest level" in high.message
    assert north.distance == pytest.approx(1000, abs=30)
    assert all(one.severity == "danger" for one in (north, back, high))
    assert math.isfinite(review.totals.seconds)
    known = np.isfinite(review.profile.wind_east)
    assert known.any()
    assert not known.all()


def test_gradients_beyond_the_airframe():
    """The autopilot climbs at 2.5 m/s, the airframe does 2; a fixed-wing arrives lower than it should."""
    slow = AssessmentLimits(climb=2.0, descent=3.0)
    (finding,) = found(judged(at(0, 300, 280), at(0, 600, 80), limits=slow), "gradient")
    assert (finding.leg, finding.severity) == (1, "warning")
    assert finding.value == pytest.approx(2.5, abs=0.15)
    winged = judged(at(0, 300, 180), mission={"vehicle_type": "fixed-wing"}, limits=slow)
    (steep,) = found(winged, "gradient")
    assert steep.severity == "danger"
    assert steep.value == pytest.approx(100 / (math.hypot(300, 100) / 15) * math.hypot(300, 100) / 300, rel=0.06)


# The ends


def test_home_off_the_ground():
    (finding,) = found(judged(at(0, 500), mission={"home": Home(HOME.point, GROUND + 48.2)}), "home")
    assert (finding.severity, finding.item) == ("warning", 0)
    assert finding.value == pytest.approx(48.2)
    assert "48.2 m above the ground" in finding.message
    assert found(judged(at(0, 500), mission={"home": Home(HOME.point, GROUND - 4)}), "home") == []


def test_home_outside_of_the_terrain():
    review = judged(at(0, 3900), mission={"home": Home(point(0, 4700), GROUND)})
    assert "home lies 700.0 m outside" in found(review, "terrain")[0].message


def test_the_first_place_far_from_home():
    review = judged(at(0, 900), at(0, 100), limits=AssessmentLimits(first_leg=500))
    (finding,) = found(review, "first-leg")
    assert (finding.item, finding.severity, finding.value) == (2, "warning", pytest.approx(900, abs=one_centimetre))
    assert found(judged(at(0, 400), at(0, 3000), limits=AssessmentLimits(first_leg=500)), "first-leg") == []


def test_a_landing_at_another_height_than_the_ground():
    review = judged(at(1000, 0), at(1000, 0, 0, command=Command.NAV_LAND), terrain=ridge())
    (finding,) = found(review, "landing")
    assert (finding.item, finding.value) == (3, pytest.approx(-60, abs=one_millimetre))
    assert review.profile.altitude[-1] == pytest.approx(GROUND + 60), "it stands on the ridge"
    level = judged(at(1000, 0), at(1000, 0, 60, command=Command.NAV_LAND), terrain=ridge())
    assert found(level, "landing") == []


def test_a_mission_without_an_end():
    back, unlimited = free(Command.DO_JUMP, 2, -1), at(0, 500, command=Command.NAV_LOITER_UNLIM)
    for last, words in (
        (back, "item 4, DO_JUMP, repeats indefinitely"),
        (unlimited, "item 4, NAV_LOITER_UNLIM, loiters indefinitely"),
    ):
        for kind in ("multicopter", "fixed-wing"):
            review = judged(at(0, 300), at(0, 500), last, mission={"vehicle_type": kind})
            (finding,) = found(review, "endless")
            assert (finding.severity, finding.item, review.verdict) == ("danger", 4, "dangers")
            assert words in finding.message
            assert "until the battery is empty" in finding.message
            assert found(review, "ending") == []


def test_a_mission_that_ends_in_the_air():
    (finding,) = found(judged(at(0, 300), at(0, 500)), "ending")
    assert (finding.severity, finding.item, finding.leg) == ("warning", 3, 2)
    assert "it hovers there until the battery is empty" in finding.message
    assert "add a LAND or RTL" in finding.message
    winged = {"vehicle_type": "fixed-wing"}
    assert "circles over home" in found(judged(at(0, 300), mission=winged), "ending")[0].message
    px4 = {**winged, "autopilot": "px4"}
    assert "it circles there" in found(judged(at(0, 300), mission=px4), "ending")[0].message
    for end in (RETURN, at(0, 500, 0, command=Command.NAV_LAND)):
        assert found(judged(at(0, 300), end), "ending") == []


def test_what_stands_behind_a_landing_is_not_judged():
    land = at(0, 500, 0, command=Command.NAV_LAND)
    far = judged(at(0, 300), land, at(0, 3000), RETURN)
    assert [leg.item for leg in far.legs] == [2, 3]
    assert found(far, "firmware-unreachable")


def test_a_mission_of_another_site():
    there = Home(GeoPoint(36.5, -84.3), 300.0)
    source = Source("mission", "far.plan", "far.plan")
    with pytest.raises(InputError, match=r"far\.plan: home lies \d+ km from the middle .* of its own site"):
        assess(case(at(0, 500), mission={"home": there}, sources=(source,)))
    with pytest.raises(InputError, match=r"far\.plan: item 3 jumps 30000 times"):
        assess(case(at(0, 500), free(Command.DO_JUMP, 2, 30_000), sources=(source,)))


# The battery, and the way back


def test_the_reserve_and_the_limit():
    """The airframe keeps 1 - 0.8 · 0.75 = 40 %."""
    frame = airframe(watts=400, capacity=250_000)
    review = judged(at(0, 1500), at(1500, 1500), at(0, 0), RETURN, airframe=frame, limits=AssessmentLimits(battery=0.5))
    (reserve,), (limit,) = found(review, "reserve"), found(review, "battery")
    assert reserve.value == limit.value == pytest.approx(100 * review.totals.left)
    assert (reserve.limit, limit.limit) == pytest.approx((40, 50))
    assert review.totals.reserve == pytest.approx(0.5)
    assert review.stops[limit.leg].left < 0.5 <= review.stops[limit.leg - 1].left
    large = judged(at(0, 1500), at(1500, 1500), at(0, 0), RETURN, airframe=airframe(capacity=2_500_000))
    assert found(large, "reserve") == []


def test_circles_take_from_the_battery():
    """The test's airframe draws the same at any airspeed; ten circles of 50 m take 397 s at 7.9 m/s."""
    turns = at(0, 500, 80, 10, 0, 50, command=Command.NAV_LOITER_TURNS)
    frame = airframe(capacity=1_000_000)
    turned, passed = (judged(item, RETURN, airframe=frame) for item in (turns, replace(turns, params=(0.0,) * 4)))
    seconds = 10 * 2 * math.pi * 50 / math.sqrt(0.5 * 2.5 * 50)
    assert turned.totals.seconds - passed.totals.seconds == pytest.approx(seconds, abs=0.01)
    watts = float(frame.power.watts(7.9, 0.0, air_density(GROUND + 80)))
    assert turned.totals.energy - passed.totals.energy == pytest.approx(watts * seconds, rel=1e-6)
    assert turned.stops[1].hold == pytest.approx(seconds)


def test_a_hold_that_the_firmware_keeps_as_another():
    """ArduPilot makes 65531 s of -5 s, and no battery lasts that long."""
    review = judged(at(0, 500, 80, -5, command=Command.NAV_LOITER_TIME), RETURN, airframe=airframe())
    assert review.stops[1].hold == 65531
    assert found(review, "reserve")[0].severity == "danger"


def test_a_wing_near_its_stall():
    """12 m/s at sea level; at 600 m above it, where it returns, the air is thinner and the stall faster."""
    power = FixedWing(2.0, 0.5, 10.0, 0.9, 0.03, 0.6, stall_airspeed=12.0)
    vehicle = Vehicle(18.0, 3.0, 2.0, type="fixed-wing")
    frame = Airframe("wing", vehicle, 2.0, Battery(2e6), power, 25.0)
    stall = 12 * math.sqrt(air_density(0.0) / air_density(GROUND + 100))

    def flown(*items, cruise=18.0):
        return judged(*items, RETURN, mission={"vehicle_type": "fixed-wing"}, airframe=frame, cruise=cruise)

    assert found(flown(at(0, 900), cruise=1.21 * stall), "stall") == []
    (near,) = found(flown(at(0, 900), cruise=1.19 * stall), "stall")
    assert (near.severity, near.limit) == ("warning", pytest.approx(1.2 * stall))
    slow = free(Command.DO_CHANGE_SPEED, 0, 1.1 * stall)
    (told,) = found(flown(at(0, 600), slow, at(0, 900), at(0, 600)), "stall")
    assert told.leg >= 2
    assert "legs 2 to 3" in told.message
    below = flown(at(0, 900), cruise=0.95 * stall)
    assert found(below, "stall")[0].severity == "danger"
    assert found(below, "reserve") == []


def test_rates_that_are_the_autopilots():
    rates = judged(at(0, 900), RETURN, airframe=airframe(climb=4.0, descent=3.0)).remarks
    assert any("the autopilot's defaults, 2.5 and 1.5 m/s" in one and "4 and 3 m/s" in one for one in rates)
    assert not any("defaults" in one for one in judged(at(0, 900), RETURN, airframe=airframe()).remarks)


def test_a_reserve_in_time():
    """Ten minutes of level flight at 15 m/s, on top of the fifth that is not usable."""
    frame = airframe(watts=400, capacity=1_000_000)
    review = judged(at(0, 900), airframe=frame, limits=AssessmentLimits(reserve_seconds=600.0))
    watts = float(frame.power.watts(15.0, 0.0, air_density(GROUND + 80)))
    assert review.totals.reserve == pytest.approx(0.2 + 600 * watts / 1_000_000)
    strict = judged(at(0, 900), airframe=frame, limits=AssessmentLimits(reserve_seconds=1900.0))
    (finding,) = found(strict, "reserve-time")
    assert "31.6667 min" in finding.message


def test_a_way_home_through_a_hill():
    review = judged(at(2000, 0), terrain=ridge(150), limits=AssessmentLimits(clearance=30))
    assert found(review, "return")[0].value == pytest.approx(80 - 150, abs=one_millimetre)
    assert "to 180 m" in found(review, "return")[0].message
    assert review.stops[1].return_energy is None


def test_out_of_reach_but_for_a_rally_point():
    frame = airframe(watts=400, capacity=450_000)
    items = (at(0, 2500), at(2500, 2500))
    alone = judged(*items, airframe=frame)
    (finding,) = found(alone, "reach")
    assert finding.severity == "warning"
    assert alone.stops[2].diversion_energy is None
    near = RallyPoint(point(2500, 2400), 40.0)
    rallied = judged(*items, airframe=frame, mission={"rally": (near,)})
    assert found(rallied, "reach") == []
    assert rallied.stops[2].diversion_energy < rallied.stops[2].return_energy
    assert rallied.rally[0] == pytest.approx((near.point.latitude_deg, near.point.longitude_deg))


def test_findings_are_told_dangers_first_and_once_a_leg():
    review = judged(
        at(2000, 0),
        at(0, 0),
        at(0, 900, 150),
        terrain=ridge(),
        limits=AssessmentLimits(clearance=30, max_height=120, first_leg=500),
    )
    severities = [finding.severity for finding in review.findings]
    assert severities == sorted(severities)
    keys = [(finding.rule, finding.leg) for finding in review.findings]
    assert len(keys) == len(set(keys))
    assert review.verdict == "dangers"


def test_findings_from_elsewhere_are_added():
    flown = case(at(0, 300), RETURN)
    (far,) = found(judged(at(0, 900), limits=AssessmentLimits(first_leg=500)), "first-leg")
    assert assess(flown, [far]).findings == (far,)
    assert assess(replace(flown, pace=SWIFT)).verdict == "clear"
    assert free(Command.NAV_RETURN_TO_LAUNCH) == RETURN


# The firmware


def test_what_the_firmware_makes_of_it_is_found_once_for_all_items_alike():
    """A spline is none of PX4's; ArduCopter holds whole seconds, and cuts altitudes by less than matters."""
    spline = at(300, 0, command=Command.NAV_SPLINE_WAYPOINT)
    (refused,) = found(judged(spline, RETURN, autopilot="px4"), "firmware-command-unsupported")
    assert (refused.severity, refused.item) == ("danger", 2)
    assert refused.message.startswith("rejected by PX4 multicopter: item 2: PX4 takes no NAV_SPLINE_WAYPOINT")
    halves = judged(at(300, 0, 80.123456, 2.5), at(600, 0, 80.123456, 2.5), RETURN)
    (rounded,) = [finding for finding in halves.findings if finding.rule.startswith("firmware")]
    assert (rounded.severity, rounded.item) == ("warning", 2)
    assert "items 2 to 3" in rounded.message
