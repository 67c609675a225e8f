"""How missions are flown: times, speeds, wind, energy; against twins by hand and against the measured flights."""

from __future__ import annotations

import json
import math
from dataclasses import dataclass, replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from gcs_windplan.assessment import Assessment, Case, assess
from gcs_windplan.flight.duration import duration_of
from gcs_windplan.geo.frame import GeoPoint, LocalFrame
from gcs_windplan.mission import Command, Home, MissionItem, MissionItems
from gcs_windplan.mission.firmware.px4 import MOTION as PX4
from gcs_windplan.scene import Scene
from gcs_windplan.terrain import flat
from gcs_windplan.vehicle import air_density, return_seconds
from gcs_windplan.wind import Calm, ConstantWind
from gcs_windplan.wind.field import Steady
from tests.assessment.cases import GROUND, HOME, RETURN, SWIFT, airframe, at, case, found, free, judged
from tests.flight.test_duration import _read
from tests.oracles.judging import airspeed_for, energy_of, ground_speed_at
from tests.worlds import ShiftingWind, WavyWind

a_hundredth = 0.01  # [s]
a_microsecond = 1e-6
one_mm_a_second = 1e-3


def speed(value: float, kind: float = 1.0) -> MissionItem:
    return free(Command.DO_CHANGE_SPEED, kind, value, -1.0)


ITEMS = (at(0, 500), at(400, 800, 120, 4.0), speed(7), at(400, 300, 60), at(-200, 300), RETURN)


@pytest.mark.parametrize("autopilot", ["ardupilot", "px4"])
def test_times_are_those_of_the_duration(autopilot):
    pace = replace(PX4 if autopilot == "px4" else SWIFT, airspeed=20.0)
    flown = case(*ITEMS, mission={"autopilot": autopilot}, pace=pace, wind=ConstantWind(3.0, -2.0))
    review = assess(flown)
    expected = duration_of(flown.mission, lambda starts, ends: np.tile([3.0, -2.0, 0.0], (len(starts), 1)), pace)
    assert review.totals.seconds == pytest.approx(expected.total, abs=a_hundredth)
    assert review.totals.takeoff_seconds == pytest.approx(expected.takeoff)
    measured = [leg.seconds - leg.hold for leg in expected.legs]
    assert [leg.seconds for leg in review.legs[: len(measured)]] == pytest.approx(measured, abs=a_hundredth)


def test_twelve_missions_as_a_real_arducopter_flew_them(shared_data):
    """Durations as `duration_of` gives them, which are within 1.1 % of those measured."""
    for flight in json.loads((shared_data / "flights" / "arducopter_4.7.json").read_text()):
        blows, towards = flight["wind"]["speed"], math.radians(flight["wind"]["from_deg"] + 180)
        wind = blows * np.array([math.sin(towards), math.cos(towards), 0.0])
        mission, pace = _read(flight)
        mission = replace(mission, vehicle_type="multicopter")
        expected = duration_of(mission, lambda starts, ends, wind=wind: np.tile(wind, (len(starts), 1)), pace)
        frame = LocalFrame(mission.home.point)
        ground = flat(50_000.0, mission.home.altitude)
        review = assess(
            Case(
                flight["name"], mission, Scene(frame, ground, ConstantWind(*map(float, wind[:2]))), "ardupilot",
                "multicopter", pace, 10.0,
            )
        )  # fmt: skip
        assert review.totals.seconds == pytest.approx(expected.total, abs=a_hundredth), flight["name"]
        en_route = math.fsum(leg.seconds for leg in review.legs if review.stops[leg.number].label != "return")
        holds = math.fsum(stop.hold for stop in review.stops if stop.label != "return")
        assert en_route + holds == pytest.approx(flight["total"], rel=0.011), flight["name"]


@given(st.floats(-9, 9), st.floats(-9, 9), st.floats(0, 360), st.floats(3, 15))
def test_the_airspeed_is_what_the_ground_speed_takes(east, north, direction, commanded):
    wind = ConstantWind(east, north)
    far = (3000 * math.sin(math.radians(direction)), 3000 * math.cos(math.radians(direction)))
    leg = judged(speed(commanded), at(*far), wind=wind).legs[0]
    assert leg.wind_along == pytest.approx(east * far[0] / 3000 + north * far[1] / 3000, abs=one_mm_a_second)
    needed = airspeed_for(commanded, direction, np.array([east, north]))
    if needed <= SWIFT.airspeed:
        assert leg.airspeed == pytest.approx(needed, abs=one_mm_a_second)
        crab = math.radians(leg.heading_deg - direction)
        assert leg.airspeed * math.sin(crab) == pytest.approx(-leg.wind_across, abs=0.01)
    else:
        assert leg.airspeed == pytest.approx(SWIFT.airspeed, abs=one_mm_a_second)


@given(st.floats(-14, 14), st.floats(-14, 14), st.floats(0, 360))
def test_a_fixed_wing_holds_its_airspeed(east, north, direction):
    wind = ConstantWind(east, north)
    far = (3000 * math.sin(math.radians(direction)), 3000 * math.cos(math.radians(direction)))
    leg = judged(at(*far), wind=wind, mission={"vehicle_type": "fixed-wing"}, cruise=15.0).legs[0]
    expected = ground_speed_at(15.0, direction, np.array([east, north]))
    if expected > 0.05:
        assert leg.ground_speed == pytest.approx(expected, abs=one_mm_a_second)
        assert leg.seconds == pytest.approx(3000 / expected, rel=1e-4)


def test_a_head_wind_slows_what_the_airframe_cannot_keep():
    """10 m/s over ground against 14 m/s of wind at 20 m/s through the air: 6 m/s are left."""
    review = judged(at(0, 3000), wind=ConstantWind(0.0, -14.0))
    assert review.legs[0].ground_speed == pytest.approx(6.0, abs=0.1)
    (finding,) = found(review, "airspeed")
    assert (finding.value, finding.limit) == pytest.approx((24.0, 20.0), abs=0.01)
    assert found(judged(at(0, 3000), wind=ConstantWind(0.0, -9.9)), "airspeed") == []


def test_wind_that_stops_it_is_not_flyable():
    review = judged(at(0, 3000), at(500, 3000), wind=ConstantWind(0.0, -21.0))
    (leg, *_) = found(review, "flyable")
    assert (leg.leg, leg.severity) == (1, "danger")
    assert leg.value == pytest.approx(21.0)
    assert review.legs[0].seconds == math.inf
    assert review.totals.seconds == math.inf
    assert math.isfinite(review.profile.seconds[-1])


@dataclass(frozen=True)
class Barrier(Steady):
    """Still air, and a gale from the north in a band of 300 m."""

    name: str = "barrier"
    resolution: float = 50.0

    def at(self, points, seconds=0.0):
        band = np.abs(points[:, 1] - 1500.0) < 150.0
        return np.column_stack([np.zeros(len(points)), np.where(band, -25.0, 0.0), np.zeros(len(points))])


def test_wind_in_one_place_stops_it_there():
    """Its mean over the leg would not."""
    review = judged(at(0, 3000), wind=Barrier())
    (finding,) = found(review, "flyable")
    assert 1350 <= finding.distance <= 1650
    assert finding.value == pytest.approx(25.0)


def test_the_wind_is_that_of_the_time():
    """A wind that turns within the flight: the second leg is flown in what blows then."""
    wind = ShiftingWind(seeds=(1, 2), knots=(0.0, 400.0))
    review = judged(at(0, 800), at(600, 800), at(600, -500), wind=wind, pace=replace(SWIFT, airspeed=30.0))
    for leg, start, end in zip(review.legs, review.stops, review.stops[1:], strict=False):
        share = (np.arange(4000) + 0.5) / 4000
        a, b = np.array([start.east, start.north, 0.0]), np.array([end.east, end.north, 0.0])
        when = start.seconds + start.hold + share * leg.seconds
        blows = wind.at(a + share[:, None] * (b - a), when)
        way = (b - a)[:2] / leg.distance
        assert leg.wind_along == pytest.approx((blows[:, :2] @ way).mean(), abs=0.02)
    assert (np.diff(review.profile.seconds) >= 0).all()


@pytest.mark.parametrize("seed", range(4))
def test_wind_means_are_those_of_dense_samples(seed):
    wind = WavyWind(seed)
    review = judged(at(0, 900), at(700, 300, 40), at(-300, -300), wind=wind)
    for leg, start, end in zip(review.legs, review.stops, review.stops[1:], strict=False):
        share = (np.arange(8000) + 0.5) / 8000
        a, b = np.array([start.east, start.north, 0.0]), np.array([end.east, end.north, 0.0])
        blows = wind.at(a + share[:, None] * (b - a))
        way = (b - a)[:2] / leg.distance
        assert leg.wind_along == pytest.approx((blows[:, :2] @ way).mean(), abs=0.003)
        assert leg.wind_across == pytest.approx((blows[:, 0] * way[1] - blows[:, 1] * way[0]).mean(), abs=0.003)


def test_energy_is_that_of_tiny_steps():
    """On long legs, where speeding up and slowing down are a small part of the time."""
    wind, frame = WavyWind(3, 4.0), airframe()
    review = judged(at(0, 3000), at(2500, 3000, 160), wind=wind, airframe=frame)
    for leg, start, end in zip(review.legs, review.stops, review.stops[1:], strict=False):
        a = np.array([start.east, start.north, start.altitude])
        b = np.array([end.east, end.north, end.altitude])
        expected = energy_of(
            a,
            b,
            leg.seconds,
            0.0,
            lambda place, when: wind.at(place[None])[0],
            lambda speed, climb, height: float(frame.power.watts(speed, climb, air_density(height))),
        )
        assert leg.energy == pytest.approx(expected, rel=0.01)


def test_a_constant_draw_empties_the_battery_evenly():
    """A power that no speed changes: what is drawn is power times time, climbing apart."""
    frame = airframe(watts=400.0)
    review = judged(at(0, 900), at(900, 900, 80, 10.0), at(0, 0), airframe=frame)
    level = math.fsum(leg.seconds for leg in review.legs) + 10.0
    drawn = (review.stops[0].left - (1 - review.totals.energy / frame.battery.capacity)) * frame.battery.capacity
    density = 1.225 / air_density(GROUND + 80)
    assert drawn == pytest.approx(400.0 * level, rel=abs(density - 1) + 0.01)
    assert [stop.left for stop in review.stops] == sorted((stop.left for stop in review.stops), reverse=True)
    assert review.totals.left == pytest.approx(review.stops[-1].left)
    assert review.profile.left[-1] == pytest.approx(review.totals.left)


def test_the_hold_is_drawn_after_the_arrival():
    frame = airframe()
    still, held = (judged(at(0, 900, 80, hold), at(900, 900), airframe=frame) for hold in (0.0, 60.0))
    assert held.stops[1].left == pytest.approx(still.stops[1].left, abs=4e-3)  # but for slowing down
    assert held.stops[2].left < still.stops[2].left - 60 * 350 / frame.battery.capacity


@pytest.mark.parametrize(("east", "north"), [(0.0, 0.0), (6.0, 0.0), (-3.0, 5.0)])
def test_the_way_home_takes_what_the_return_takes(east, north):
    """Energy of the way home is nearly the constant draw times the autopilot's return time."""
    frame = airframe(watts=400.0)
    review = judged(at(0, 900), at(1500, 900), airframe=frame, wind=ConstantWind(east, north))
    density = float(frame.power.watts(10.0, 0.0, air_density(GROUND + 80)))
    for stop in review.stops[1:]:
        seconds = return_seconds((-stop.east, -stop.north), 80.0, replace(SWIFT, airspeed=20.0), (east, north))
        assert stop.return_energy == pytest.approx(density * seconds, rel=0.02)


def test_no_way_home_against_too_much_wind():
    review = judged(at(0, 2000), wind=ConstantWind(0.0, 24.0), airframe=airframe(), pace=replace(SWIFT, airspeed=20.0))
    assert review.stops[1].return_energy == math.inf
    assert any("too strong" in finding.message for finding in found(review, "reach"))


def test_a_mission_over_the_date_line():
    frame = LocalFrame(GeoPoint(-17.0, 179.995))
    latitudes, longitudes = frame.to_geographic(np.array([[0.0, 0.0], [1500.0, 0.0]]))
    assert longitudes[1] < 0
    items = [MissionItem(3, 22, altitude=80.0)]
    items += [
        MissionItem(3, 16, (0, 0, 0, 0), float(a), float(b), 80.0) for a, b in zip(latitudes, longitudes, strict=True)
    ]
    mission = MissionItems(tuple(items), Home(frame.origin, 0.0), "ardupilot", "multicopter")
    review = assess(
        Case(
            "line",
            mission,
            Scene(frame, flat(9000.0), Calm()),
            "ardupilot",
            "multicopter",
            SWIFT,
            10.0,
            home_is_given=True,
        )
    )
    assert review.totals.distance == pytest.approx(1500, abs=0.01)


def test_the_same_case_gives_the_same_assessment():
    flown = case(*ITEMS, wind=WavyWind(2), airframe=airframe())
    one, other = assess(flown), assess(flown)
    assert isinstance(one, Assessment)
    assert one.legs == other.legs
    assert one.findings == other.findings
    assert np.array_equal(one.profile.power, other.profile.power)
    assert HOME.altitude == GROUND
