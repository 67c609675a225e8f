"""The whole stand-in on a scripted clock: what it answers, tells, and does when it is told to."""

from __future__ import annotations

import math
import struct
from dataclasses import replace
from datetime import UTC, datetime
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from pymavlink.dialects.v20 import ardupilotmega as mavlink

from gcs_windplan.geo.frame import GeoPoint, LocalFrame
from gcs_windplan.link.codec import Codec
from gcs_windplan.mission import Home
from gcs_windplan.mission.firmware import firmware_of
from gcs_windplan.standin.rules import ServerOptions
from gcs_windplan.standin.standin import StandIn
from gcs_windplan.standin.vehicle import StandInOptions
from gcs_windplan.standin.world import World, simulator_world, world_at

from . import speaking as say
from .scenes import FRAME, HOME, at, home_again, speed, takeoff, wind_from

ACCEPTED, DENIED, UNSUPPORTED, FAILED = 0, 2, 3, 4
COPTER_AUTO, COPTER_GUIDED, COPTER_RTL = 3, 4, 6
PX4_MISSION = 4 << 16 | 4 << 24


class Bench:
    """A stand-in, a clock, and a ground station that writes down what it hears."""

    def __init__(self, autopilot="ardupilot", world: World | None = None, wind=None, **options: Any) -> None:
        self.now = 100.0
        self.log: list[str] = []
        self.heard: list[Any] = []
        world = world if world is not None else world_at(HOME, wind)
        firmware = firmware_of(autopilot, "multicopter")
        profile = replace(firmware.motion, airspeed=15.0)  # leans to 45°
        made = StandInOptions(firmware, profile, world, **options)
        self.vehicle = StandIn(made, self.now, self.log.append, calendar=lambda: 1_700_000_000.0 + self.now)

    def wait(self, seconds: float, step: float = 0.1) -> list[Any]:
        """Let the clock run; what was said meanwhile."""
        until, said = self.now + seconds, []
        while self.now < until - 1e-9:
            self.now = min(until, self.now + step)
            said += self.vehicle.tick(self.now)
        self.heard += said
        return said

    def tell(self, message: Any, by=say.US) -> list[Any]:
        answer = self.vehicle.handle(say.said(message, by), self.now)
        self.heard += answer
        return answer

    def command(self, command: int, *params: float) -> tuple[int, list[Any]]:
        """The result of a COMMAND_LONG, and what came with it."""
        seven = (*params, *([0.0] * (7 - len(params))))
        ack, *rest = self.tell(mavlink.MAVLink_command_long_message(1, 1, command, 0, *seven))
        assert (ack.get_type(), ack.command) == ("COMMAND_ACK", command)
        assert (ack.target_system, ack.target_component) == say.US
        return ack.result, rest

    def upload(self, items: list[Any]) -> None:
        answer = self.vehicle.handle(say.count(len(items)), self.now)
        for seq, item in enumerate(items):
            assert answer[0].get_type().startswith("MISSION_REQUEST"), answer
            message = say.item(seq, item.command, item.params, frame=item.frame, x=item.x, y=item.y, z=item.z)
            answer = self.vehicle.handle(message, self.now)
        self.heard += answer
        assert ("ACK", 0) in say.told(answer)

    def last(self, kind: str) -> Any:
        return next(message for message in reversed(self.heard) if message.get_type() == kind)


def kinds(messages: list[Any]) -> set[str]:
    return {message.get_type() for message in messages}


def home(z: float = 300.0):
    return at(0, 0, z, frame=0)


LINE = [home(), takeoff(40), at(0, 400, 40), at(300, 400, 60), home_again()]


def test_it_calls_itself_a_stand_in():
    bench = Bench()
    answer = bench.tell(mavlink.MAVLink_heartbeat_message(6, 8, 0, 0, 4, 3))
    assert any("stand-in" in words for words in say.texts(answer))
    assert bench.tell(mavlink.MAVLink_heartbeat_message(6, 8, 0, 0, 4, 3)) == []
    _, banner = bench.command(mavlink.MAV_CMD_DO_SEND_BANNER)
    assert any("not a real vehicle" in words for words in say.texts(banner))
    assert bench.log[0] == "255/190 is there; the first that it says is HEARTBEAT"


@pytest.mark.parametrize(("autopilot", "kind"), [("ardupilot", 3), ("px4", 12)])
def test_heartbeats_once_a_second(autopilot, kind):
    bench = Bench(autopilot)
    beats = [message for message in bench.wait(10.0) if message.get_type() == "HEARTBEAT"]
    assert len(beats) in (10, 11)
    assert {beat.autopilot for beat in beats} == {kind}
    assert {beat.type for beat in beats} == {mavlink.MAV_TYPE_QUADROTOR}
    booting = [beat.system_status for beat in beats if beat.system_status < mavlink.MAV_STATE_STANDBY]
    assert len(booting) == (2 if autopilot == "ardupilot" else 0)


def test_what_is_streamed():
    bench = Bench()
    said = bench.wait(10.0, step=0.05)
    counts = {kind: sum(message.get_type() == kind for message in said) for kind in kinds(said)}
    assert counts["GLOBAL_POSITION_INT"] == pytest.approx(40, abs=2)
    assert counts["ATTITUDE"] == pytest.approx(40, abs=2)
    assert counts["MISSION_CURRENT"] == pytest.approx(10, abs=1)
    assert {"VFR_HUD", "SYS_STATUS", "BATTERY_STATUS", "GPS_RAW_INT", "WIND", "SYSTEM_TIME"} <= set(counts)
    assert {"LOCAL_POSITION_NED", "EXTENDED_SYS_STATE", "HOME_POSITION", "NAV_CONTROLLER_OUTPUT"} <= set(counts)
    assert "WIND_COV" not in counts
    assert "WIND_COV" in kinds(Bench("px4").wait(2.0))
    codec = Codec(1, 1)
    for message in said:
        assert codec.decode(codec.encode(message))  # every field fits


def test_intervals_can_be_set():
    bench = Bench()
    attitude, heartbeat = mavlink.MAVLINK_MSG_ID_ATTITUDE, mavlink.MAVLINK_MSG_ID_HEARTBEAT
    assert bench.command(mavlink.MAV_CMD_SET_MESSAGE_INTERVAL, attitude, 100_000)[0] == ACCEPTED
    said = bench.wait(5.0, step=0.05)
    assert sum(message.get_type() == "ATTITUDE" for message in said) == pytest.approx(50, abs=2)
    (told,) = bench.command(mavlink.MAV_CMD_GET_MESSAGE_INTERVAL, attitude)[1]
    assert (told.message_id, told.interval_us) == (attitude, 100_000)
    assert bench.command(mavlink.MAV_CMD_SET_MESSAGE_INTERVAL, attitude, -1)[0] == ACCEPTED
    assert "ATTITUDE" not in kinds(bench.wait(3.0))
    assert bench.command(mavlink.MAV_CMD_SET_MESSAGE_INTERVAL, 31_000, 100_000)[0] == DENIED
    bench.command(mavlink.MAV_CMD_SET_MESSAGE_INTERVAL, heartbeat, -1)
    assert "HEARTBEAT" in kinds(bench.wait(2.0))
    bench.tell(mavlink.MAVLink_request_data_stream_message(1, 1, mavlink.MAV_DATA_STREAM_EXTRA1, 10, 1))
    assert "ATTITUDE" in kinds(bench.wait(1.0))
    bench.tell(mavlink.MAVLink_request_data_stream_message(1, 1, mavlink.MAV_DATA_STREAM_ALL, 0, 0))
    assert kinds(bench.wait(3.0)) == {"HEARTBEAT", "EXTENDED_SYS_STATE", "HOME_POSITION"}  # those of no group


@pytest.mark.parametrize("autopilot", ["ardupilot", "px4"])
def test_what_a_ground_station_asks_when_it_connects(autopilot):
    bench = Bench(autopilot)
    result, (version,) = bench.command(mavlink.MAV_CMD_REQUEST_MESSAGE, mavlink.MAVLINK_MSG_ID_AUTOPILOT_VERSION)
    assert result == ACCEPTED
    for bit in ("MISSION_INT", "MAVLINK2", "MISSION_FENCE", "MISSION_RALLY", "COMMAND_INT"):
        assert version.capabilities & getattr(mavlink, f"MAV_PROTOCOL_CAPABILITY_{bit}")
    assert not version.capabilities & mavlink.MAV_PROTOCOL_CAPABILITY_FTP
    assert bytes(version.flight_custom_version).startswith(b"STANDIN")
    assert kinds(bench.command(mavlink.MAV_CMD_REQUEST_AUTOPILOT_CAPABILITIES, 1)[1]) == {"AUTOPILOT_VERSION"}
    for kind, name in ((242, "HOME_POSITION"), (49, "GPS_GLOBAL_ORIGIN"), (1, "SYS_STATUS"), (244, "MESSAGE_INTERVAL")):
        result, (message,) = bench.command(mavlink.MAV_CMD_REQUEST_MESSAGE, kind)
        assert (result, message.get_type()) == (ACCEPTED, name)
    assert kinds(bench.command(mavlink.MAV_CMD_GET_HOME_POSITION)[1]) == {"HOME_POSITION"}
    # protocol version, component metadata, available modes: none here
    for kind in (300, 397, 395, 435, 436):
        assert bench.command(mavlink.MAV_CMD_REQUEST_MESSAGE, kind) == (UNSUPPORTED, [])
    for command in (519, 521, 2504, 283, 42_000):
        assert bench.command(command)[0] == UNSUPPORTED
    bench.wait(5.0)
    (sync,) = bench.tell(mavlink.MAVLink_timesync_message(0, 123_456))
    assert (sync.ts1, sync.tc1) == (123_456, pytest.approx(5e9, rel=0.01))
    assert bench.tell(mavlink.MAVLink_timesync_message(5, 123_456)) == []
    (ping,) = bench.tell(mavlink.MAVLink_ping_message(9, 4, 0, 0))
    assert (ping.seq, ping.target_system, ping.target_component) == (4, *say.US)


def test_there_are_no_files():
    """MAVProxy asks for its parameters as a file first, and waits ten seconds for an answer."""
    payload = [7, 0, 114, 4, 5, 0, 0, 0, 0, 0, 0, 0, *b"@PARA", *([0] * 234)]
    (nak,) = Bench().tell(mavlink.MAVLink_file_transfer_protocol_message(0, 1, 1, payload))
    assert nak.payload[:6] == [8, 0, 114, 129, 1, 4]
    assert nak.payload[12] == 10
    assert (nak.target_system, nak.target_component) == say.US
    payload[3] = 129
    assert Bench().tell(mavlink.MAVLink_file_transfer_protocol_message(0, 1, 1, payload)) == []


def test_what_is_meant_for_others_is_not_answered():
    bench = Bench()
    arm = mavlink.MAV_CMD_COMPONENT_ARM_DISARM
    assert bench.tell(mavlink.MAVLink_command_long_message(2, 1, arm, 0, 1, 0, 0, 0, 0, 0, 0)) == []
    assert bench.tell(mavlink.MAVLink_command_long_message(1, 154, arm, 0, 1, 0, 0, 0, 0, 0, 0)) == []
    assert bench.tell(mavlink.MAVLink_param_request_list_message(2, 1)) == []
    assert not bench.vehicle.flight.state.armed


def test_arducopters_parameters():
    bench = Bench()
    bench.wait(3.0)
    bench.upload(LINE)
    values = {message.param_id: message for message in bench.tell(mavlink.MAVLink_param_request_list_message(1, 1))}
    assert len(values) == values["WPNAV_SPEED"].param_count
    assert sorted(message.param_index for message in values.values()) == list(range(len(values)))
    assert values["WPNAV_SPEED"].param_value == 1000
    assert values["RTL_ALT"].param_value == 1500
    assert values["MIS_TOTAL"].param_value == 5
    assert values["SYSID_THISMAV"].param_value == 1
    index = values["LAND_SPEED"].param_index
    (by_index,) = bench.tell(mavlink.MAVLink_param_request_read_message(1, 1, b"", index))
    (by_name,) = bench.tell(mavlink.MAVLink_param_request_read_message(1, 1, b"LAND_SPEED", -1))
    assert (by_index.param_id, by_name.param_value, by_name.param_index) == ("LAND_SPEED", 50, index)
    assert bench.tell(mavlink.MAVLink_param_request_read_message(1, 1, b"NO_SUCH", -1)) == []
    assert bench.tell(mavlink.MAVLink_param_request_read_message(1, 1, b"", 999)) == []


def test_setting_a_parameter_changes_how_it_flies():
    bench = Bench()
    (value,) = bench.tell(mavlink.MAVLink_param_set_message(1, 1, b"WPNAV_SPEED", 500, 9))
    assert value.param_value == 500
    assert bench.vehicle.flight.state.profile == replace(firmware_of("ardupilot").motion, airspeed=15.0, speed=5.0)
    for nonsense in (math.nan, math.inf, -1.0):
        (value,) = bench.tell(mavlink.MAVLink_param_set_message(1, 1, b"WPNAV_SPEED", nonsense, 9))
        assert value.param_value == 500
    (value,) = bench.tell(mavlink.MAVLink_param_set_message(1, 1, b"FENCE_ENABLE", 1, 2))
    assert value.param_value == 1
    assert bench.tell(mavlink.MAVLink_param_set_message(1, 1, b"NO_SUCH", 1, 2)) == []


def test_px4s_whole_parameters_travel_as_bytes():
    bench = Bench("px4")
    (value,) = bench.tell(mavlink.MAVLink_param_request_read_message(1, 1, b"SYS_AUTOSTART", -1))
    assert struct.unpack("<i", struct.pack("<f", value.param_value)) == (4001,)
    one = struct.unpack("<f", struct.pack("<i", 1))[0]
    (value,) = bench.tell(mavlink.MAVLink_param_set_message(1, 1, b"GF_ACTION", one, 6))
    assert struct.unpack("<i", struct.pack("<f", value.param_value)) == (1,)
    (value,) = bench.tell(mavlink.MAVLink_param_set_message(1, 1, b"MPC_XY_CRUISE", 7.5, 9))
    assert bench.vehicle.flight.state.profile.speed == 7.5


def test_armed_and_auto_it_flies_the_mission_to_its_end():
    bench = Bench(wind=wind_from(4, 270), speedup=10.0)
    bench.wait(3.0)
    bench.upload(LINE)
    assert bench.last("STATUSTEXT").text.rstrip("\0") == "SimulatedFlight plan received"
    assert bench.command(mavlink.MAV_CMD_DO_SET_MODE, 1, COPTER_AUTO)[0] == ACCEPTED
    bench.wait(2.0)
    assert bench.last("HEARTBEAT").custom_mode == COPTER_AUTO
    assert bench.last("GLOBAL_POSITION_INT").relative_alt == 0
    assert bench.command(mavlink.MAV_CMD_COMPONENT_ARM_DISARM, 1)[0] == ACCEPTED
    bench.wait(30.0)
    said = bench.heard
    assert [m.seq for m in said if m.get_type() == "MISSION_ITEM_REACHED"] == [1, 2, 3, 4]
    currents = [m.seq for m in said if m.get_type() == "MISSION_CURRENT"]
    assert [seq for seq, before in zip(currents[1:], currents, strict=False) if seq != before] == [1, 2, 3, 4, 0]
    armed = [bool(m.base_mode & 128) for m in said if m.get_type() == "HEARTBEAT"]
    assert True in armed
    assert not armed[-1]
    states = [m.landed_state for m in said if m.get_type() == "EXTENDED_SYS_STATE"]
    assert mavlink.MAV_LANDED_STATE_IN_AIR in states
    assert states[-1] == mavlink.MAV_LANDED_STATE_ON_GROUND
    positions = [m for m in said if m.get_type() == "GLOBAL_POSITION_INT"]
    assert max(m.relative_alt for m in positions) == pytest.approx(60_000, abs=20)
    assert (positions[-1].lat, positions[-1].lon) == (365_000_000, -843_000_000)
    assert any("Landed" in words for words in bench.log)


def in_flight(wind, **options) -> Bench:
    """On its way north at 80 m, 10 m/s."""
    bench = Bench(wind=wind, **options)
    bench.wait(3.0)
    bench.upload([home(), takeoff(80), at(0, 5000, 80), at(0, 6000, 80)])
    bench.command(mavlink.MAV_CMD_MISSION_START)
    bench.command(mavlink.MAV_CMD_COMPONENT_ARM_DISARM, 1)
    bench.wait(80.0)
    return bench


def test_telemetry_in_a_cross_wind():
    """6 m/s from the west, 10 m/s over ground to the north: the air is met from 31° to the left."""
    bench = in_flight(wind_from(6, 270))
    hud, position, wind = bench.last("VFR_HUD"), bench.last("GLOBAL_POSITION_INT"), bench.last("WIND")
    crab = math.degrees(math.atan2(-6, 10))
    assert hud.groundspeed == pytest.approx(10.0, abs=0.01)
    assert hud.airspeed == pytest.approx(math.hypot(6, 10), abs=0.01)
    assert hud.heading == round(crab % 360)
    assert hud.alt == pytest.approx(380.0, abs=0.01)
    assert position.hdg == pytest.approx(100 * (crab % 360), abs=5)
    assert (position.vx, position.vy, position.vz) == (1000, pytest.approx(0, abs=1), 0)
    assert position.relative_alt == 80_000
    assert (wind.direction % 360, wind.speed) == (pytest.approx(270, abs=0.1), pytest.approx(6.0))
    assert math.degrees(bench.last("ATTITUDE").yaw) == pytest.approx(crab, abs=0.1)
    local = bench.last("LOCAL_POSITION_NED")
    assert (local.vx, local.y, local.z) == (pytest.approx(10, abs=0.01), pytest.approx(0, abs=0.1), -80)
    east, north = FRAME.to_local(position.lat / 1e7, position.lon / 1e7)[0]
    assert (local.y, local.x) == (pytest.approx(east, abs=0.1), pytest.approx(north, abs=3.0))
    fix = bench.last("GPS_RAW_INT")
    assert (fix.fix_type, fix.vel) == (3, 1000)
    assert fix.cog % 36_000 == pytest.approx(0, abs=5)
    navigation = bench.last("NAV_CONTROLLER_OUTPUT")
    assert (navigation.target_bearing, navigation.wp_dist) == (0, pytest.approx(5000 - north, abs=10))
    assert bench.last("ATTITUDE").pitch < 0


def test_px4s_wind_points_where_it_blows():
    bench = Bench("px4", wind=wind_from(6, 270))
    bench.wait(2.0)
    wind = bench.last("WIND_COV")
    assert (wind.wind_x, wind.wind_y) == (pytest.approx(0, abs=1e-6), pytest.approx(6.0))


def test_hovering_it_turns_its_nose_to_the_wind():
    bench = in_flight(wind_from(6, 270))
    assert bench.command(mavlink.MAV_CMD_NAV_LOITER_UNLIM)[0] == ACCEPTED
    bench.wait(20.0)
    hud = bench.last("VFR_HUD")
    assert (hud.groundspeed, hud.airspeed) == (0.0, pytest.approx(6.0))
    assert bench.last("HEARTBEAT").custom_mode == 5
    assert hud.heading == 270
    assert bench.last("ATTITUDE").pitch == pytest.approx(-math.radians(30) * 6 / 10.16, abs=1e-4)


def test_the_battery_is_linear_over_half_an_hour():
    bench = in_flight(wind_from(0, 0), speedup=1.0)
    before = bench.last("BATTERY_STATUS")
    assert bench.last("SYS_STATUS").battery_remaining == pytest.approx(100 * (1 - 80 / 1800), abs=1)
    bench.wait(180.0)
    after = bench.last("BATTERY_STATUS")
    assert before.time_remaining - after.time_remaining == pytest.approx(180, abs=3)
    assert before.voltages[0] > after.voltages[0]
    bench.command(mavlink.MAV_CMD_COMPONENT_ARM_DISARM, 0, 21196)
    bench.command(mavlink.MAV_CMD_COMPONENT_ARM_DISARM, 1)
    bench.wait(1.1)
    assert bench.last("SYS_STATUS").battery_remaining == 100


def test_speedup_is_flown_and_told_by_the_vehicles_own_clock():
    slow, fast = in_flight(None), Bench(speedup=20.0)
    fast.wait(3.0)
    begin = fast.last("GLOBAL_POSITION_INT").time_boot_ms
    fast.upload([home(), takeoff(80), at(0, 5000, 80), at(0, 6000, 80)])
    fast.command(mavlink.MAV_CMD_MISSION_START)
    fast.command(mavlink.MAV_CMD_COMPONENT_ARM_DISARM, 1)
    fast.wait(4.0)
    assert fast.last("GLOBAL_POSITION_INT").time_boot_ms - begin == pytest.approx(80_000, abs=6_000)
    assert fast.vehicle.flight.state.body.place == pytest.approx(slow.vehicle.flight.state.body.place, abs=0.01)


def test_commands_in_flight():
    bench = in_flight(None)
    assert bench.command(mavlink.MAV_CMD_COMPONENT_ARM_DISARM, 0)[0] == FAILED
    assert bench.command(mavlink.MAV_CMD_DO_CHANGE_SPEED, 1, 4)[0] == ACCEPTED
    bench.wait(10.0)
    assert bench.last("VFR_HUD").groundspeed == pytest.approx(4.0, abs=0.01)
    assert bench.command(mavlink.MAV_CMD_DO_CHANGE_SPEED, 1, 0)[0] == DENIED
    result, (current, *_) = bench.command(mavlink.MAV_CMD_DO_SET_MISSION_CURRENT, 3)
    assert (result, current.seq, current.total) == (ACCEPTED, 3, 3)
    assert bench.command(mavlink.MAV_CMD_DO_SET_MISSION_CURRENT, 9)[0] == DENIED
    assert bench.command(mavlink.MAV_CMD_DO_PAUSE_CONTINUE, 0)[0] == ACCEPTED
    bench.wait(10.0)
    assert bench.last("VFR_HUD").groundspeed == 0
    assert bench.command(mavlink.MAV_CMD_DO_PAUSE_CONTINUE, 1)[0] == ACCEPTED
    bench.wait(10.0)
    assert bench.last("VFR_HUD").groundspeed == pytest.approx(10.0)
    assert bench.command(mavlink.MAV_CMD_NAV_RETURN_TO_LAUNCH)[0] == ACCEPTED
    bench.wait(1.1)
    assert bench.last("HEARTBEAT").custom_mode == COPTER_RTL
    bench.wait(400.0)
    assert not bench.vehicle.flight.state.armed
    assert bench.vehicle.flight.state.body.place == pytest.approx((0, 0, 300), abs=0.01)


def test_guided_flight_by_command():
    bench = Bench()
    bench.wait(3.0)
    takeoff_to_20 = (mavlink.MAV_CMD_NAV_TAKEOFF, 0, 0, 0, 0, 0, 0, 20)
    assert bench.command(*takeoff_to_20)[0] == FAILED
    bench.tell(mavlink.MAVLink_set_mode_message(1, 1, COPTER_GUIDED))
    assert bench.last("COMMAND_ACK").result == ACCEPTED
    assert bench.last("HEARTBEAT").custom_mode == COPTER_GUIDED
    bench.command(mavlink.MAV_CMD_COMPONENT_ARM_DISARM, 1)
    assert bench.command(*takeoff_to_20)[0] == ACCEPTED
    bench.wait(20.0)
    assert bench.last("GLOBAL_POSITION_INT").relative_alt == 20_000
    place = at(100, 50)
    reposition = mavlink.MAVLink_command_int_message(
        1, 1, 3, mavlink.MAV_CMD_DO_REPOSITION, 0, 0, -1, 1, 0, math.nan, place.x, place.y, 35.0
    )
    (ack,) = bench.tell(reposition)
    assert ack.result == ACCEPTED
    bench.wait(40.0)
    assert bench.vehicle.flight.state.body.place == pytest.approx((100, 50, 335), abs=0.1)
    assert bench.command(mavlink.MAV_CMD_DO_REPOSITION, -1, 0, 0, 0, 99, 0, 50)[0] == DENIED
    there = at(0, 0, 30)
    fly_there = mavlink.MAVLink_mission_item_int_message(1, 1, 0, 3, 16, 2, 1, 0, 0, 0, 0, there.x, there.y, 30.0, 0)
    assert say.told(bench.tell(fly_there)) == [("ACK", 0)]
    bench.wait(60.0)
    assert bench.vehicle.flight.state.body.place == pytest.approx((0, 0, 330), abs=0.1)
    assert bench.command(mavlink.MAV_CMD_NAV_LAND)[0] == ACCEPTED
    bench.wait(120.0)
    assert not bench.vehicle.flight.state.armed


def test_why_it_does_not_start_is_told():
    bench = Bench()
    bench.wait(3.0)
    result, rest = bench.command(mavlink.MAV_CMD_MISSION_START)
    assert (result, say.texts(rest)) == (FAILED, ["Refused: there is no mission"])
    bench.upload([home(), at(0, 100)])
    result, rest = bench.command(mavlink.MAV_CMD_DO_SET_MODE, 1, COPTER_AUTO)
    assert (result, say.texts(rest)) == (FAILED, ["Refused: Missing Takeoff Cmd"])
    assert bench.command(mavlink.MAV_CMD_DO_SET_MODE, 1, 99)[0] == DENIED
    bench.tell(mavlink.MAVLink_set_mode_message(1, 1, 99))
    assert bench.last("COMMAND_ACK").result == FAILED
    assert bench.vehicle.mode.name == "STABILIZE"


def test_px4_starts_by_mission_start_alone():
    bench = Bench("px4", speedup=10.0)
    bench.upload([at(0, 0, 20, command=say.TAKEOFF), at(0, 100, 20), home_again()])
    assert bench.command(mavlink.MAV_CMD_MISSION_START)[0] == ACCEPTED
    bench.wait(1.0)
    assert bench.last("HEARTBEAT").custom_mode == PX4_MISSION
    bench.wait(20.0)
    assert [m.seq for m in bench.heard if m.get_type() == "MISSION_ITEM_REACHED"] == [0, 1, 2]
    assert not bench.vehicle.flight.state.armed
    assert bench.command(mavlink.MAV_CMD_DO_SET_MODE, 29, 4, 5)[0] == ACCEPTED
    assert bench.vehicle.mode.name == "Return"


def test_px4_takes_off_when_armed():
    bench = Bench("px4")
    assert bench.command(mavlink.MAV_CMD_NAV_TAKEOFF, 0, 0, 0, math.nan, math.nan, math.nan, 330)[0] == FAILED
    bench.command(mavlink.MAV_CMD_COMPONENT_ARM_DISARM, 1)
    assert bench.command(mavlink.MAV_CMD_NAV_TAKEOFF, 0, 0, 0, math.nan, math.nan, math.nan, 330)[0] == ACCEPTED
    bench.wait(30.0)
    assert bench.vehicle.flight.state.body.altitude == 330.0
    assert bench.vehicle.mode.name == "Takeoff"


def test_fly_starts_by_itself():
    bench = Bench(fly=True)
    bench.wait(3.0)
    bench.upload(LINE)
    assert "armed, flying the mission" in bench.log
    bench.wait(15.0)
    assert bench.last("MISSION_CURRENT").mission_state == mavlink.MISSION_STATE_ACTIVE
    assert not bench.vehicle.flight.state.landed
    unflyable = Bench(fly=True)
    unflyable.wait(3.0)
    unflyable.upload([home(), at(0, 100)])
    assert "it does not fly: Missing Takeoff Cmd" in unflyable.log


@pytest.mark.parametrize("autopilot", ["ardupilot", "px4"])
def test_told_no_place_it_stands_where_the_first_mission_begins(autopilot):
    bench = Bench(autopilot, simulator_world(firmware_of(autopilot, "multicopter")))
    bench.wait(3.0)
    assert abs(bench.last("GLOBAL_POSITION_INT").lat) != 365_000_000
    first = at(0, 0, 20, command=say.TAKEOFF)
    bench.upload([home(417.0), first] if autopilot == "ardupilot" else [first, at(0, 100, 20)])
    bench.wait(1.0)
    position = bench.last("GLOBAL_POSITION_INT")
    assert (position.lat, position.lon) == (365_000_000, -843_000_000)
    assert position.alt == (417_000 if autopilot == "ardupilot" else 0)
    assert any("told no place to stand" in words for words in bench.log)
    bench.upload([at(9000, 0, 300, frame=0), first] if autopilot == "ardupilot" else [at(9000, 0, 20)])
    bench.wait(1.0)
    assert bench.last("GLOBAL_POSITION_INT").lon == -843_000_000  # and stays there


def test_a_reboot():
    bench = Bench()
    bench.wait(5.0)
    bench.upload(LINE)
    assert bench.command(mavlink.MAV_CMD_PREFLIGHT_REBOOT_SHUTDOWN, 1)[0] == ACCEPTED
    bench.wait(1.0)
    assert bench.last("HEARTBEAT").system_status == mavlink.MAV_STATE_BOOT
    assert bench.last("GLOBAL_POSITION_INT").time_boot_ms < 1500
    assert say.told(bench.vehicle.handle(say.count(2), bench.now)) == [("ACK", 4)]
    bench.wait(2.0)
    assert len(bench.vehicle.server.items[0]) == 5
    flying = in_flight(None)
    assert flying.command(mavlink.MAV_CMD_PREFLIGHT_REBOOT_SHUTDOWN, 1)[0] == FAILED


def test_measured_clearing_in_auto_is_refused():
    bench = in_flight(None)
    assert say.told(bench.vehicle.handle(say.clear(), bench.now)) == [("ACK", 1)]
    bench.command(mavlink.MAV_CMD_NAV_LOITER_UNLIM)
    assert say.told(bench.vehicle.handle(say.clear(), bench.now)) == [("ACK", 0)]


def test_setting_home():
    bench = Bench()
    result, (home_now,) = bench.command(mavlink.MAV_CMD_DO_SET_HOME, 0, 0, 0, 0, 36.501, -84.301, 310)
    assert (result, home_now.altitude) == (ACCEPTED, 310_000)
    assert home_now.latitude == pytest.approx(365_010_000, abs=20)  # COMMAND_LONG has floats of 32 bits
    assert bench.command(mavlink.MAV_CMD_DO_SET_HOME, 0, 0, 0, 0, 99, 0, 0)[0] == DENIED
    bench.command(mavlink.MAV_CMD_DO_SET_HOME, 1)
    assert bench.vehicle.flight.state.home == HOME


def test_its_clock_begins_with_the_missions_departure():
    departure = datetime(2026, 5, 1, 12, 0, tzinfo=UTC)
    bench = in_flight(None, world=World(HOME, FRAME, departure=departure))
    told = bench.last("SYSTEM_TIME").time_unix_usec / 1e6
    assert told == pytest.approx(departure.timestamp() + 80, abs=2.0)


def test_away_from_the_frames_origin_directions_are_true():
    """50 km east of the origin at 65° north the local frame's north is off by a degree."""
    frame = LocalFrame(GeoPoint(65.0, 20.0))
    latitude, longitude = frame.to_geographic(np.array([[50_000.0, 0.0]]))
    far = Home(GeoPoint(float(latitude[0]), float(longitude[0])), 100.0)
    bench = Bench(world=World(far, frame, wind_from(5, 0)))
    bench.wait(1.5)
    convergence = math.degrees(float(frame.convergence(np.array([[50_000.0, 0.0]]))[0]))
    assert abs(convergence) > 0.9
    assert math.remainder(bench.last("WIND").direction - convergence, 360) == pytest.approx(0, abs=0.01)


def test_wake_says_when_something_is_due():
    bench = Bench()
    for _ in range(50):
        assert bench.vehicle.wake >= bench.now
        assert bench.vehicle.wake <= bench.now + 0.1 + 1e-9
        bench.now = bench.vehicle.wake
        bench.vehicle.tick(bench.now)


ANYTHING = st.one_of(
    st.floats(width=32, allow_nan=True, allow_infinity=True), st.sampled_from([0.0, 1.0, -1.0, math.nan])
)
COMMANDS = [16, 17, 20, 21, 22, 176, 178, 179, 192, 193, 224, 241, 246, 300, 400, 410, 510, 511, 512, 520, 42_428, 7]
ITEMS = [16, 17, 18, 19, 20, 21, 22, 31, 82, 83, 93, 112, 114, 177, 178, 179, 203, 600, 601, 5001, 5003, 5100, 0, 999]


@st.composite
def messages(draw):
    kind = draw(st.integers(0, 8))
    byte, word = st.integers(0, 255), st.integers(0, 65535)
    place = st.one_of(st.integers(-(2**31), 2**31 - 1), st.sampled_from([365_000_000, -843_000_000, 0]))
    seven = [draw(ANYTHING) for _ in range(7)]
    mission_type, seq = draw(st.sampled_from([0, 0, 0, 1, 2, 255])), draw(st.integers(0, 6))
    if kind == 0:
        return mavlink.MAVLink_command_long_message(1, 1, draw(st.sampled_from(COMMANDS)), 0, *seven)
    if kind == 1:
        return mavlink.MAVLink_command_int_message(
            1, 1, draw(byte), draw(st.sampled_from(COMMANDS)), 0, 0, *seven[:4], draw(place), draw(place), seven[6]
        )
    if kind in (2, 3):
        return mavlink.MAVLink_mission_item_int_message(
            1, 1, seq, draw(st.sampled_from([0, 2, 3, 5, 6, 10, 1, 77])), draw(st.sampled_from(ITEMS)),
            draw(st.sampled_from([0, 0, 0, 1, 2, 3])), 1, *seven[:4], draw(place), draw(place), seven[6], mission_type,
        )  # fmt: skip
    if kind == 4:
        return mavlink.MAVLink_mission_item_message(1, 1, seq, 3, 16, 0, 1, *seven, mission_type)
    if kind == 5:
        return mavlink.MAVLink_mission_count_message(1, 1, draw(st.integers(0, 6)), mission_type)
    if kind == 6:
        return mavlink.MAVLink_param_set_message(
            1, 1, draw(st.sampled_from([b"WPNAV_SPEED", b"GF_ACTION"])), seven[0], 6
        )
    if kind == 7:
        return mavlink.MAVLink_mission_set_current_message(1, 1, draw(word))
    return mavlink.MAVLink_set_mode_message(1, 1, draw(st.sampled_from([0, 3, 4, 6, 9, PX4_MISSION, 99])))


@settings(max_examples=150)
@given(st.sampled_from(["ardupilot", "px4"]), st.lists(st.tuples(messages(), st.floats(0, 40)), max_size=30))
def test_no_message_breaks_it(autopilot, story):
    bench = Bench(autopilot, speedup=5.0)
    bench.now += 3.0
    for message, pause in story:
        bench.tell(message)
        bench.wait(pause, step=pause or 1.0)
    answer = bench.vehicle.handle(say.request_list(), bench.now + 30)
    assert all(Codec(1, 1).encode(message) for message in [*bench.heard, *answer])


def test_a_capacity_of_its_own():
    bench = Bench(server=ServerOptions(capacity=3))
    bench.wait(3.0)
    assert say.told(bench.vehicle.handle(say.count(4), bench.now)) == [("ACK", 4)]


def test_a_speed_command_between_legs_reaches_the_telemetry():
    bench = Bench()
    bench.wait(3.0)
    bench.upload([home(), takeoff(40), speed(6), at(0, 900, 40), at(0, 1000, 40)])
    bench.command(mavlink.MAV_CMD_MISSION_START)
    bench.command(mavlink.MAV_CMD_COMPONENT_ARM_DISARM, 1)
    bench.wait(60.0)
    assert bench.last("VFR_HUD").groundspeed == pytest.approx(6.0, abs=0.01)
