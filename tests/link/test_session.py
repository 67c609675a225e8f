"""Meeting a vehicle, keeping the heartbeat going, and asking for home."""

from __future__ import annotations

from dataclasses import replace

import pytest
from pymavlink.dialects.v20 import ardupilotmega as mavlink

from gcs_windplan.errors import InputError, LinkError
from gcs_windplan.geo.frame import GeoPoint
from gcs_windplan.link.codec import Codec
from gcs_windplan.link.discovery import LISTENING
from gcs_windplan.link.firmware import outgoing_items
from gcs_windplan.link.home import Homes
from gcs_windplan.link.session import OWN, Session
from gcs_windplan.link.verified import clear_items, pull_items, push_items
from gcs_windplan.mission import Home
from gcs_windplan.progress import CancelToken

from .autopilots import PX4, ArduPilot, Autopilot
from .bench import bench, survey
from .simulation import SimulatedTransport, World


def session_of(world: World, **options) -> Session:
    return Session(SimulatedTransport(world), clock=world.clock, **options)


@pytest.mark.parametrize(("kind", "autopilot"), [(ArduPilot, "ardupilot"), (PX4, "px4"), (Autopilot, None)])
def test_the_heartbeat_tells_the_autopilot(kind, autopilot):
    world = World()
    vehicle = kind(world)
    vehicle.type = mavlink.MAV_TYPE_FIXED_WING
    peer = session_of(world).meet()
    assert (peer.ident, peer.autopilot, peer.vehicle_type, peer.version) == ((1, 1), autopilot, "fixed-wing", 2)


def test_a_heartbeat_a_second_while_it_waits_and_while_it_sends():
    stand = bench("px4", count=20)
    stand.vehicle.deaf("MISSION_ITEM_INT", 12, seq=4)
    stand.push()
    beats = stand.sent("HEARTBEAT")
    elapsed = stand.world.now - 100.0
    assert abs(len(beats) - elapsed) <= 2
    assert {(beat.type, beat.autopilot) for beat in beats} == {(mavlink.MAV_TYPE_GCS, mavlink.MAV_AUTOPILOT_INVALID)}
    assert {(beat.get_srcSystem(), beat.get_srcComponent()) for beat in beats} == {tuple(OWN)}


def test_a_token_ends_a_transfer_and_the_vehicle_is_told():
    world, token = World(), CancelToken()
    transport = SimulatedTransport(world)
    PX4(world)
    session = Session(transport, clock=world.clock, cancel=token)
    peer = session.meet()
    items = outgoing_items(survey(20), "mission", peer.firmware)
    part = push_items(session, peer, "mission", items, watch=lambda done, total: token.cancel() if done >= 5 else None)
    assert (part.outcome.verdict, part.outcome.reason) == ("unknown", "interrupted")
    assert session.interrupted
    codec = Codec(1, 1)
    sent = [message for _, data in transport.sent for message in codec.decode(data)]
    assert sent[-1].get_type() == "MISSION_ACK"
    assert sent[-1].type == mavlink.MAV_MISSION_OPERATION_CANCELLED


def test_nobody():
    world = World()
    with pytest.raises(LinkError, match="no vehicle was heard"):
        session_of(world).meet()
    assert world.now == pytest.approx(110.0, abs=0.1)
    with pytest.raises(LinkError, match="no vehicle was heard"):
        session_of(world, timeout=2.0).meet()
    assert world.now == pytest.approx(112.0, abs=0.1)


@pytest.mark.parametrize("kind", [mavlink.MAV_TYPE_GCS, mavlink.MAV_TYPE_GIMBAL, mavlink.MAV_TYPE_CAMERA])
def test_stations_gimbals_and_cameras_are_no_vehicles(kind):
    world = World()
    Autopilot(world, 1, 154).type = kind
    with pytest.raises(LinkError):
        session_of(world).meet()


def test_it_listens_for_others_unless_one_is_named():
    world = World()
    ArduPilot(world)
    start = world.now
    session_of(world).meet()
    assert world.now - start >= LISTENING
    start = world.now
    session_of(world).meet(1, 1)
    assert world.now - start <= 1.1


def test_several_vehicles():
    world = World()
    ArduPilot(world, 1)
    PX4(world, 2)
    PX4(world, 2, 2)
    with pytest.raises(InputError, match=r"3 vehicles share the link \(ArduPilot 1/1, PX4 2/1, PX4 2/2\)"):
        session_of(world).meet()
    assert session_of(world).meet(1).autopilot == "ardupilot"
    assert session_of(world).meet(2, 2).ident == (2, 2)
    with pytest.raises(InputError, match="2 vehicles share"):
        session_of(world).meet(2)
    with pytest.raises(LinkError, match=r"only ArduPilot 1/1, PX4 2/1, PX4 2/2: check --sysid"):
        session_of(world).meet(9)


def test_ardupilot_is_waited_for_until_it_is_ready():
    """It answers NO_SPACE in its first two seconds (measured on ArduCopter 4.7)."""
    world = World()
    vehicle = ArduPilot(world)
    vehicle.reboot(0.5)
    session = session_of(world)
    session.meet(1, 1)
    assert world.now - vehicle.booted >= 2.0
    vehicle.status = mavlink.MAV_STATE_BOOT
    start = world.now
    session_of(world).meet(1, 1)  # it never says so: then it is tried all the same
    assert 4.9 <= world.now - start <= 7


def test_home_of_a_vehicle_that_tells_it():
    world = World()
    vehicle = PX4(world)
    session = session_of(world)
    peer = session.meet()
    assert session.ask_home(peer) is None

    def answer(message):
        if message.get_type() == "COMMAND_LONG" and message.param1 == mavlink.MAVLINK_MSG_ID_HOME_POSITION:
            place = (468134380, 98437720, 1560250, 0, 0, 0, [1, 0, 0, 0], 0, 0, 0)
            vehicle.send(mavlink.MAVLink_home_position_message(*place))
        return [message]

    vehicle.ears.append(answer)
    home = session.ask_home(peer)
    assert home is not None
    assert (home.point.latitude_deg, home.point.longitude_deg, home.altitude) == (46.813438, 9.843772, 1560.25)


def test_a_home_at_0_0_is_none():
    world = World()
    vehicle = PX4(world)
    session = session_of(world)
    peer = session.meet()

    def answer(message):
        if message.get_type() == "COMMAND_LONG":
            vehicle.send(mavlink.MAVLink_home_position_message(0, 0, 0, 0, 0, 0, [1, 0, 0, 0], 0, 0, 0))
        return [message]

    vehicle.ears.append(answer)
    assert session.ask_home(peer) is None


@pytest.mark.parametrize(
    ("latitude", "altitude", "apart"),
    [(46.8, 1560.0, False), (46.80026, 1564.9, False), (46.80028, 1560.0, True), (46.8, 1554.9, True)],
)
def test_homes_apart(latitude, altitude, apart):
    homes = Homes(Home(GeoPoint(46.8, 9.8), 1560.0), Home(GeoPoint(latitude, 9.8), altitude))
    assert homes.apart is apart
    assert homes.described()["apart"] is apart
    assert homes.distance == pytest.approx((latitude - 46.8) * 111_170, abs=0.1)


def test_a_broken_push_says_no_more_than_is_known():
    """A vehicle that accepts before it asked: another station deleted its mission meanwhile."""
    for profile in ("ardupilot", "px4"):
        stand = bench(profile)
        count = stand.vehicle.on_count
        stand.vehicle.answers["MISSION_COUNT"] = lambda message, sender, v=stand.vehicle: v.ack(sender, 0)
        outcome = stand.push().outcome
        assert (outcome.verdict, outcome.reason) == ("unknown", "protocol")
        assert outcome.notes == ("it is not known which mission the vehicle holds: pull it",)
        stand.vehicle.answers["MISSION_COUNT"] = count
        stand.vehicle.deaf("MISSION_COUNT", 1000)
        outcome = stand.push().outcome
        assert (outcome.verdict, outcome.reason) == ("unknown", "no-answer")
        assert outcome.notes == ("it is not known which mission the vehicle holds: pull it",)


def test_a_clear_that_is_not_answered_says_so():
    stand = bench("px4")
    stand.vehicle.deaf("MISSION_CLEAR_ALL", 1000)
    part = clear_items(stand.session, stand.peer, "rally")
    assert part.outcome.verdict == "unknown"
    assert part.outcome.notes == ("it is not known which rally points the vehicle holds: pull them",)


def test_reading_back_shows_ardupilots_home():
    part = bench("ardupilot").push()
    assert part.home == Home(GeoPoint(47.1234567, 8.5432109), 489.25)
    assert bench("px4").push().home is None


@pytest.mark.parametrize(
    ("deed", "words"), [(push_items, "nothing was sent"), (clear_items, "nothing was deleted"), (pull_items, "read")]
)
def test_mavlink_1_is_told_in_the_verbs_own_words(deed, words):
    stand = bench("px4")
    items = (stand.items("fence"),) if deed is push_items else ()
    outcome = deed(stand.session, replace(stand.peer, version=1), "fence", *items).outcome
    assert (outcome.verdict, outcome.reason) == ("rejected", "mavlink1")
    assert outcome.message.endswith(words)


def test_the_transport_is_closed():
    world = World()
    transport = SimulatedTransport(world)
    with Session(transport, clock=world.clock):
        pass
    assert transport.closed


def test_signed_sessions_sign_everything():
    world = World()
    key = bytes(range(32))
    PX4(world, key=key)
    session = session_of(world, key=key)
    session.meet()
    assert all(data[2] & 1 for _, data in session._transport.sent)
    assert Codec(1, 1).decode(session._transport.sent[0][1])[0].get_type() == "HEARTBEAT"
