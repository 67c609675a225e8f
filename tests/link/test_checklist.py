"""What a trustworthy uploader must do, row by row, on scripted autopilots with ArduPilot's and PX4's rules."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any

import pytest
from pymavlink.dialects.v20 import ardupilotmega as mavlink

from gcs_windplan.errors import InputError, LinkError
from gcs_windplan.link.codec import Codec
from gcs_windplan.link.download import Download
from gcs_windplan.link.exchange import Ends
from gcs_windplan.link.outcome import Outcome
from gcs_windplan.link.session import OWN, Session
from gcs_windplan.link.upload import Upload
from gcs_windplan.link.verified import clear_items, pull_items
from gcs_windplan.link.wire import item_to_message
from gcs_windplan.mission import Command, Frame, MissionItem, MissionItems

from .autopilots import CANCELLED, DENIED, ERROR, INVALID_SEQUENCE, NO_SPACE, ArduPilot, OtherStation, Stored
from .bench import HOME, PROFILES, Bench, bench
from .simulation import Faults, SimulatedTransport, World

both = pytest.mark.parametrize("profile", PROFILES)
every_type = pytest.mark.parametrize("kind", ["mission", "fence", "rally"])

OTHER_ITEMS = [Stored(16, 3, (0.0, 0.0, 0.0, 0.0), 470000000 + 1000 * seq, 80000000, 30.0 + seq) for seq in range(5)]


def assert_accepted(stand: Bench, outcome: Outcome, kind: Any = "mission") -> None:
    assert outcome.verdict == "accepted", outcome
    assert outcome.reason == "done"
    assert stand.holds_it(kind)


def cancels(stand: Bench) -> int:
    return sum(ack.type == CANCELLED for ack in stand.sent("MISSION_ACK"))


def uploading(stand: Bench) -> Upload:
    """An upload to be driven by hand, begun."""
    upload = Upload(Ends(OWN, stand.peer), stand.items())
    upload.begin(0.0)
    return upload


def from_vehicle(message: Any, system: int = 1, component: int = 1) -> Any:
    """The message as our side decodes it."""
    return Codec(OWN.system, OWN.component).decode(Codec(system, component).encode(message))[0]


def request(seq: int, **changes: Any) -> Any:
    numbers = {"target_system": OWN.system, "target_component": OWN.component, "seq": seq, "mission_type": 0}
    return mavlink.MAVLink_mission_request_int_message(**{**numbers, **changes})


def ack(code: int, **changes: Any) -> Any:
    numbers = {"target_system": OWN.system, "target_component": OWN.component, "type": code, "mission_type": 0}
    return mavlink.MAVLink_mission_ack_message(**{**numbers, **changes})


@both
@every_type
def test_nothing_goes_wrong(profile, kind):
    stand = bench(profile)
    part = stand.push(kind)
    assert_accepted(stand, part.outcome, kind)
    assert part.comparison is not None
    assert part.comparison.same
    assert cancels(stand) == 0
    assert part.outcome.notes == ()


@both
@pytest.mark.parametrize("lost", [1, 5])
def test_row_01_count_lost_is_sent_again(profile, lost):
    stand = bench(profile)
    stand.vehicle.deaf("MISSION_COUNT", lost)
    assert_accepted(stand, stand.push().outcome)
    assert len(stand.sent("MISSION_COUNT")) == lost + 1


@both
def test_row_01_first_request_lost(profile):
    stand = bench(profile)
    stand.vehicle.mute(stand.vehicle.request(1, 1, 0, 0).get_type(), 8)
    assert_accepted(stand, stand.push().outcome)


@both
def test_row_01_time_out_after_five_repetitions(profile):
    stand = bench(profile)
    stand.vehicle.deaf("MISSION_COUNT", 100)
    part = stand.push()
    assert (part.outcome.verdict, part.outcome.reason) == ("unknown", "no-answer")
    assert len(stand.sent("MISSION_COUNT")) == 6
    assert 7.5 <= part.seconds <= 10
    assert cancels(stand) == 1


@both
@pytest.mark.parametrize("seq", [0, 3])
def test_row_02_item_lost(profile, seq):
    stand = bench(profile)
    stand.vehicle.deaf("MISSION_ITEM_INT", 1, seq=seq)
    assert_accepted(stand, stand.push().outcome)
    assert len([item for item in stand.sent("MISSION_ITEM_INT") if item.seq == seq]) == 2


@both
def test_row_02_three_seconds_of_silence(profile):
    stand = bench(profile)
    kind, asks_again = stand.vehicle.request(1, 1, 0, 0).get_type(), stand.vehicle.asks_again
    stand.vehicle.mute(kind, math.ceil(3 / asks_again), seq=3)
    part = stand.push()
    assert_accepted(stand, part.outcome)
    assert part.sending > 3
    assert len(stand.sent("MISSION_COUNT")) == 1


@both
def test_row_03_last_item_lost(profile):
    stand = bench(profile)
    last = len(stand.items()) - 1
    stand.vehicle.deaf("MISSION_ITEM_INT", 2, seq=last)
    assert_accepted(stand, stand.push().outcome)


@both
def test_row_04_final_ack_lost(profile):
    stand = bench(profile)
    stand.vehicle.mute("MISSION_ACK", 1)
    part = stand.push()
    assert_accepted(stand, part.outcome)
    last = len(stand.items()) - 1
    repeated = len([item for item in stand.sent("MISSION_ITEM_INT") if item.seq == last]) - 1
    assert repeated == (1 if profile == "px4" else 0)  # ArduPilot would answer an error


@both
def test_row_04_every_ack_lost_without_reading_back_is_unknown(profile):
    stand = bench(profile)
    stand.vehicle.mute("MISSION_ACK", 100)
    outcome = stand.push(verify=False).outcome
    assert (outcome.verdict, outcome.reason) == ("unknown", "unconfirmed")


@both
def test_row_04_last_item_never_arrives(profile):
    stand = bench(profile)
    last = len(stand.items()) - 1
    stand.vehicle.deaf("MISSION_ITEM_INT", 1000, seq=last)
    outcome = stand.push().outcome
    assert outcome.verdict != "accepted"
    assert not stand.holds_it()


@both
def test_row_04_refusal_of_the_last_item_lost(profile):
    stand = bench(profile)
    stand.mission = replace(stand.mission, items=(*stand.mission.items, MissionItem(0, 2999)))
    stand.vehicle.mute("MISSION_ACK", 1)
    outcome = stand.push().outcome
    assert (outcome.verdict, outcome.reason) == ("rejected", "differs")


def test_row_04_accepted_after_an_error_is_not_believed():
    """PX4 accepts a repeated last item even when storing the mission failed."""
    upload = uploading(bench("px4"))
    for seq in range(6):
        upload.hear(from_vehicle(request(seq)), 1.0)
    assert upload.hear(from_vehicle(ack(ERROR)), 1.1) == []
    assert not upload.done
    upload.hear(from_vehicle(ack(0)), 1.2)
    assert (upload.outcome.verdict, upload.outcome.reason) == ("unknown", "unconfirmed")
    assert "ERROR (1) and then ACCEPTED" in upload.outcome.message


def test_row_05_requests_are_answered_by_their_number():
    stand = bench("px4")
    upload = uploading(stand)
    for seq in (0, 0, 1, 2, 1, 3, 0, 3):
        answer = upload.hear(from_vehicle(request(seq)), 1.0)
        assert [item.seq for item in answer] == [seq]
    assert upload.progress == (4, 6)
    assert upload.notes == []


@both
def test_row_05_everything_twice_and_late(profile):
    stand = bench(profile, faults=Faults(duplication=1.0, late=0.2, lateness=0.5), seed=3)
    outcome = stand.push().outcome
    assert outcome.verdict == "accepted", outcome
    assert stand.holds_it()


def test_row_06_request_ahead_is_answered_and_noted():
    stand = bench("px4")
    upload = uploading(stand)
    assert [item.seq for item in upload.hear(from_vehicle(request(0)), 1.0)] == [0]
    assert [item.seq for item in upload.hear(from_vehicle(request(4)), 1.1)] == [4]
    assert upload.notes == ["item 4 was asked for before item 1"]
    assert not upload.done


@pytest.mark.parametrize("seq", [6, 65535])
def test_row_07_request_past_the_end_cancels(seq):
    stand = bench("px4")
    upload = uploading(stand)
    upload.hear(from_vehicle(request(0)), 1.0)
    (answer,) = upload.hear(from_vehicle(request(seq)), 1.1)
    assert (answer.get_type(), answer.type) == ("MISSION_ACK", CANCELLED)
    assert (upload.outcome.verdict, upload.outcome.reason) == ("unknown", "protocol")
    assert f"item {seq} of 6" in upload.outcome.message


@pytest.mark.parametrize("message", ["mission_request", "mission_request_int"])
def test_row_08_both_requests_get_mission_item_int(message):
    upload = uploading(bench("px4"))
    make = getattr(mavlink, f"MAVLink_{message}_message")
    (answer,) = upload.hear(from_vehicle(make(*OWN, 0, 0)), 1.0)
    assert answer.get_type() == "MISSION_ITEM_INT"


@pytest.mark.parametrize(
    ("changes", "source"),
    [
        ({"mission_type": 1}, (1, 1)),
        ({"mission_type": 2}, (1, 1)),
        ({"mission_type": 255}, (1, 1)),
        ({"target_system": 254}, (1, 1)),
        ({"target_system": 0}, (1, 1)),
        ({"target_component": 190}, (1, 1)),
        ({}, (2, 1)),
        ({}, (1, 154)),
    ],
)
def test_row_09_messages_of_others_are_ignored(changes, source):
    upload = uploading(bench("px4"))
    upload.hear(from_vehicle(request(0)), 1.0)
    for message in (request(1, **changes), request(99, **changes), ack(0, **changes), ack(4, **changes)):
        assert upload.hear(from_vehicle(message, *source), 1.0) == []
    assert not upload.done
    assert upload.progress == (1, 6)


def test_row_09_a_component_of_zero_means_all():
    upload = uploading(bench("px4"))
    assert len(upload.hear(from_vehicle(request(0, target_component=0)), 1.0)) == 1


def test_row_09_other_vehicles_do_not_end_a_download():
    stand = bench("px4")
    download = Download(Ends(OWN, stand.peer))
    download.begin(0.0)
    count = mavlink.MAVLink_mission_count_message
    assert download.hear(from_vehicle(count(*OWN, 0, 1)), 0.1) == []
    assert download.hear(from_vehicle(count(*OWN, 0, 0), 2), 0.1) == []
    assert not download.done


@both
def test_row_10_accepted_too_early(profile):
    stand = bench(profile)
    upload = uploading(stand)
    upload.hear(from_vehicle(request(0)), 1.0)
    (answer,) = upload.hear(from_vehicle(ack(0)), 1.1)
    assert (answer.get_type(), answer.type) == ("MISSION_ACK", CANCELLED)
    assert (upload.outcome.verdict, upload.outcome.reason) == ("unknown", "protocol")
    assert "1 of" in upload.outcome.message


def test_row_10_accepted_instead_of_the_first_request():
    upload = uploading(bench("px4"))
    upload.hear(from_vehicle(ack(0)), 0.1)
    assert (upload.outcome.verdict, upload.outcome.reason) == ("unknown", "protocol")


def test_row_11_wrong_sequence_is_no_end_on_ardupilot():
    stand = bench("ardupilot")
    stand.vehicle.ears.append(lambda m: [m, m] if m.get_type() == "MISSION_ITEM_INT" else [m])
    part = stand.push()
    said = [m.type for m in stand.vehicle.said if m.get_type() == "MISSION_ACK"]
    assert said.count(INVALID_SEQUENCE) == len(stand.items()) - 1
    assert_accepted(stand, part.outcome)


def test_row_11_wrong_sequence_ends_it_on_others():
    upload = uploading(bench("px4"))
    upload.hear(from_vehicle(request(0)), 1.0)
    upload.hear(from_vehicle(ack(INVALID_SEQUENCE)), 1.1)
    assert (upload.outcome.verdict, upload.outcome.code) == ("rejected", INVALID_SEQUENCE)


def test_row_12_duplicate_count_on_px4_rests_and_starts_once_more():
    stand = bench("px4")
    late = []

    def repeat_count_after_an_item(message):
        if message.get_type() == "MISSION_COUNT" and not late:
            late.append(message)
        elif message.get_type() == "MISSION_ITEM_INT" and message.seq == 2 and len(late) == 1:
            late.append(message)
            return [message, late[0]]
        return [message]

    stand.vehicle.ears.append(repeat_count_after_an_item)
    part = stand.push()
    assert_accepted(stand, part.outcome)
    assert part.seconds > 5
    assert len(stand.sent("MISSION_COUNT")) == 2
    assert cancels(stand) == 1
    assert any("busy" in note for note in part.outcome.notes)


def test_row_12_busy_with_a_broken_transfer_of_before():
    stand = bench("px4")
    Session(SimulatedTransport(stand.world), clock=stand.world.clock)
    stand.world.carry(Codec(254, 190).encode(mavlink.MAVLink_mission_count_message(1, 1, 9, 0)), stand.transport)
    stand.world.run(0.1)
    assert stand.vehicle.upload is not None
    part = stand.push()
    assert_accepted(stand, part.outcome)
    assert part.seconds > 5


@both
def test_row_12_busy_for_ever(profile):
    stand = bench(profile)
    stand.vehicle.answers["MISSION_COUNT"] = lambda message, sender: stand.vehicle.ack(sender, ERROR)
    part = stand.push()
    assert (part.outcome.verdict, part.outcome.reason, part.outcome.code) == ("rejected", "busy", ERROR)
    assert len(stand.sent("MISSION_COUNT")) == 2
    assert part.seconds < 10


@pytest.mark.parametrize("code", [2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, DENIED, 16, 200])
@both
def test_row_13_refusals_name_code_item_and_parameter(profile, code):
    stand = bench(profile)
    upload = uploading(stand)
    for seq in range(3):
        upload.hear(from_vehicle(request(seq)), 1.0)
    upload.hear(from_vehicle(ack(code)), 1.1)
    outcome = upload.outcome
    assert (outcome.verdict, outcome.reason, outcome.code, outcome.seq) == ("rejected", "refused", code, 2)
    entry = mavlink.enums["MAV_MISSION_RESULT"].get(code)
    name = f"unknown code {code}" if entry is None else entry.name.removeprefix("MAV_MISSION_")
    assert name in outcome.message
    assert "item 2 (NAV_WAYPOINT)" in outcome.message
    if 6 <= code <= 12:
        assert outcome.parameter is not None
        assert outcome.parameter.startswith(f"parameter {code - 5} is ")
    elif code == 2:
        assert outcome.parameter == "frame GLOBAL_RELATIVE_ALT"
    elif code == 3:
        assert outcome.parameter == "command NAV_WAYPOINT"


@both
def test_row_13_generic_error_at_an_item(profile):
    """PX4 might mean a second announcement, so it gets a second chance; then the item is named."""
    stand = bench(profile)

    def error_at_item_two(message, sender):
        if message.seq == 2:
            stand.vehicle.upload = None
            return stand.vehicle.ack(sender, ERROR)
        return type(stand.vehicle).on_item(stand.vehicle, message, sender)

    stand.vehicle.answers["MISSION_ITEM_INT"] = error_at_item_two
    part = stand.push()
    assert (part.outcome.verdict, part.outcome.code, part.outcome.seq) == ("rejected", ERROR, 2)
    assert len(stand.sent("MISSION_COUNT")) == (1 if profile == "ardupilot" else 2)


@both
def test_row_13_nan_that_the_vehicle_refuses(profile):
    stand = bench(profile)
    bad = MissionItem(Frame.GLOBAL_RELATIVE_ALT, Command.NAV_WAYPOINT, (0, math.nan, 0, 0), 46.8, 9.8, 50)
    if profile == "px4":
        bad = replace(bad, frame=Frame.GLOBAL_TERRAIN_ALT)
    stand.mission = MissionItems((*stand.mission.items[:3], bad), HOME)
    outcome = stand.push().outcome
    assert outcome.verdict == "rejected"
    expected = (7, "parameter 2 is nan") if profile == "ardupilot" else (2, "frame GLOBAL_TERRAIN_ALT")
    assert (outcome.code, outcome.parameter) == expected
    assert outcome.seq == stand.items().index(bad)
    mixture = [note for note in outcome.notes if "mixture" in note]
    assert len(mixture) == (1 if profile == "ardupilot" else 0)


@both
def test_row_14_the_vehicle_cancels(profile):
    stand = bench(profile)
    upload = uploading(stand)
    upload.hear(from_vehicle(request(0)), 1.0)
    upload.hear(from_vehicle(ack(CANCELLED)), 1.1)
    assert (upload.outcome.verdict, upload.outcome.code) == ("rejected", CANCELLED)
    assert "broke the transfer off" in upload.outcome.message


def test_row_14_ardupilot_gives_up_after_eight_seconds():
    stand = bench("ardupilot")
    stand.vehicle.deaf("MISSION_ITEM_INT", 1000, seq=3)
    part = stand.push()
    assert (part.outcome.verdict, part.outcome.code) == ("rejected", CANCELLED)
    assert part.seconds < 10


@both
@pytest.mark.parametrize("seq", [0, 3, 5])
@pytest.mark.parametrize("off", [0.2, 4.0, 30.0])
def test_row_15_reboot_while_sending(profile, seq, off):
    stand = bench(profile)
    stand.vehicle.keep(0, [ArduPilot.home, *OTHER_ITEMS])

    def reboot_at(message):
        if message.get_type() == "MISSION_ITEM_INT" and message.seq == seq:
            stand.vehicle.reboot(off)
            return []
        return [message]

    stand.vehicle.ears.append(reboot_at)
    part = stand.push()
    assert part.outcome.verdict != "accepted"
    assert not stand.holds_it()
    assert part.seconds < 40
    if off < 5:
        assert part.outcome.reason == "restarted"
        assert "restarted" in part.outcome.message


@both
def test_row_15_an_older_message_is_no_reboot(profile):
    upload = uploading(bench(profile))
    for age in (50_000, 51_000, 49_500, 52_000):
        upload.hear(from_vehicle(mavlink.MAVLink_system_time_message(0, age)), 1.0)
    assert not upload.done
    upload.hear(from_vehicle(mavlink.MAVLink_system_time_message(0, 2_000)), 1.0)
    assert upload.outcome.reason == "restarted"


def test_row_15_reboot_shown_by_heartbeats_alone():
    upload = uploading(bench("px4"))
    for status in (mavlink.MAV_STATE_STANDBY, mavlink.MAV_STATE_ACTIVE, mavlink.MAV_STATE_BOOT):
        upload.hear(from_vehicle(mavlink.MAVLink_heartbeat_message(2, 12, 0, 0, status, 3)), 1.0)
    assert upload.outcome.reason == "restarted"


@both
def test_row_15_reboot_after_everything_was_accepted_is_seen_by_reading_back(profile):
    stand = bench(profile)

    def forget(message):
        if message.get_type() == "MISSION_ACK" and message.type == 0:
            stand.vehicle.keep(0, [])
        return [message]

    stand.vehicle.mouth.append(forget)
    outcome = stand.push().outcome
    assert (outcome.verdict, outcome.reason) == ("rejected", "differs")
    assert "the number of items" in outcome.message


@both
def test_row_16_heartbeat_lost(profile):
    stand = bench(profile)

    def die(message):
        stand.vehicle.on = message.get_type() != "MISSION_ITEM_INT" or message.seq < 3
        return [message]

    stand.vehicle.ears.append(die)
    part = stand.push()
    assert (part.outcome.verdict, part.outcome.reason) == ("unknown", "lost")
    assert part.seconds < 15


@both
def test_row_16_vehicle_is_there_but_stops_asking(profile):
    stand = bench(profile)
    stand.vehicle.give_up = lambda: None  # type: ignore[method-assign]
    stand.vehicle.mute(stand.vehicle.request(1, 1, 0, 0).get_type(), 1000, seq=4)
    part = stand.push()
    assert (part.outcome.verdict, part.outcome.reason) == ("unknown", "stalled")
    assert "4 of" in part.outcome.message
    assert part.seconds < 15


@both
def test_row_16_vehicle_asks_for_ever(profile):
    stand = bench(profile)
    stand.vehicle.deaf("MISSION_ITEM_INT", 10**9, seq=3)
    stand.vehicle.gives_up = math.inf
    part = stand.push()
    assert (part.outcome.verdict, part.outcome.reason) == ("unknown", "stalled")
    assert "again and again" in part.outcome.message
    assert part.seconds < 40


def test_row_16_a_vehicle_that_takes_its_time_for_each_item():
    stand = bench("px4", count=60)
    upload = Upload(Ends(OWN, stand.peer), stand.items())
    upload.begin(0.0)
    now = 0.0
    while not upload.done:
        now += 9.0
        upload.hear(from_vehicle(request(upload.progress[0])), now)
    assert (upload.outcome.verdict, upload.outcome.reason) == ("unknown", "stalled")
    assert now < 300
    assert "did not end within 270 s" in upload.outcome.message


@both
def test_row_16_count_of_zero(profile):
    stand = bench(profile)
    part = pull_items(stand.session, stand.peer, "mission")
    assert (part.outcome.verdict, part.items) == ("accepted", ())
    stand.push()
    assert clear_items(stand.session, stand.peer, "mission").outcome.verdict == "accepted"
    assert stand.vehicle.held[0] == ([] if profile == "px4" else stand.vehicle.held[0][:1])
    upload = Upload(Ends(OWN, stand.peer), ())
    upload.begin(0.0)
    upload.hear(from_vehicle(ack(0)), 0.1)
    assert upload.outcome.verdict == "accepted"


@both
def test_row_16_no_space(profile):
    stand = bench(profile, count=800)
    part = stand.push()
    assert (part.outcome.verdict, part.outcome.code, part.outcome.seq) == ("rejected", NO_SPACE, None)
    assert "no room" in part.outcome.message
    assert part.seconds < 1
    assert part.outcome.notes == ()  # nothing was overwritten


def test_row_16_more_items_than_mavlink_can_announce():
    stand = bench("px4")
    with pytest.raises(InputError, match="66000 items are more than the 65535"):
        Upload(Ends(OWN, stand.peer), stand.items() * 11_000)


@both
def test_row_17_second_station_is_first(profile):
    stand = bench(profile)
    other = OtherStation(stand.world, OTHER_ITEMS)
    stand.vehicle.deaf("MISSION_ITEM_INT", 1, seq=1)
    other.start()
    stand.world.run(0.03)
    assert stand.vehicle.upload is not None
    part = stand.push()
    if profile == "ardupilot":
        assert (part.outcome.verdict, part.outcome.code) == ("rejected", DENIED)
        assert "another ground station" in part.outcome.message
    else:
        assert_accepted(stand, part.outcome)  # PX4 says busy, and the upload is begun again
        assert part.seconds > 5
    stand.world.run(5.0)
    assert 0 in other.acks


@both
def test_row_17_second_station_overwrites_before_the_reading_back(profile):
    stand = bench(profile)
    other = OtherStation(stand.world, OTHER_ITEMS)

    def overwrite(message):
        if message.get_type() == "MISSION_ACK" and message.type == 0 and message.target_system == OWN.system:
            stand.vehicle.keep(0, list(OTHER_ITEMS))
        return [message]

    stand.vehicle.mouth.append(overwrite)
    part = stand.push()
    assert other.acks == []
    assert (part.outcome.verdict, part.outcome.reason) == ("rejected", "differs")
    assert part.comparison is not None
    assert not part.comparison.same


@both
def test_row_17_second_station_uploads_while_reading_back(profile):
    stand = bench(profile, count=40)
    other = OtherStation(stand.world, OTHER_ITEMS)
    asked = []

    def interfere(message):
        if message.get_type() == "MISSION_REQUEST_INT" and message.seq == 20 and not asked:
            asked.append(message)
            stand.vehicle.reader = None  # type: ignore[attr-defined]
            other.start()
        return [message]

    stand.vehicle.ears.append(interfere)
    outcome = stand.push().outcome
    assert outcome.verdict != "accepted"
    assert 0 in other.acks


@both
def test_row_17_overheard_uploads_of_others_are_noted(profile):
    upload = uploading(bench(profile))
    upload.hear(from_vehicle(request(0, target_system=254, target_component=190)), 1.0)
    assert upload.overheard == {(254, 190)}
    assert "254/190" in upload.notes[0]


@both
@pytest.mark.parametrize(("times", "verdict"), [(1, "accepted"), (100, "unknown")])
def test_row_17_reading_back_while_another_sends_proves_nothing(profile, times, verdict):
    stand = bench(profile)
    left = [times]

    def ask_another(message):
        if message.get_type() == "MISSION_REQUEST_INT" and message.seq == 2 and left[0] > 0:
            left[0] -= 1
            stand.vehicle.send(request(3, target_system=254, target_component=190))
        return [message]

    stand.vehicle.ears.append(ask_another)
    outcome = stand.push().outcome
    assert outcome.verdict == verdict
    assert len(stand.sent("MISSION_REQUEST_LIST")) == 2
    assert any("254/190" in note for note in outcome.notes)


def old_vehicle(profile: str) -> Bench:
    """A vehicle that speaks MAVLink 1 and does not even hear MAVLink 2."""
    world = World()
    vehicle = PROFILES[profile](world)
    vehicle.codec.version = 1
    hear = vehicle.take
    vehicle.take = lambda data: hear(data) if data[0] == mavlink.PROTOCOL_MARKER_V1 else None  # type: ignore[method-assign]
    transport = SimulatedTransport(world)
    session = Session(transport, clock=world.clock)
    return Bench(world, vehicle, transport, session, session.meet())


@both
def test_row_18_mavlink_1_carries_missions_only(profile):
    stand = old_vehicle(profile)
    assert stand.peer.version == 1
    assert_accepted(stand, stand.push().outcome)
    before = len(stand.transport.sent)
    for kind in ("fence", "rally"):
        for part in (
            stand.push(kind),
            pull_items(stand.session, stand.peer, kind),
            clear_items(stand.session, stand.peer, kind),
        ):
            assert (part.outcome.verdict, part.outcome.reason) == ("rejected", "mavlink1")
            assert kind in part.outcome.message
    assert len(stand.transport.sent) == before
    assert stand.holds_it()


def test_row_18_a_vehicle_that_switches_to_mavlink_2_gets_it():
    world = World()
    vehicle = PROFILES["px4"](world)
    vehicle.codec.version = 1

    def switch(message):
        vehicle.codec.version = 2
        return [message]

    vehicle.deaf("HEARTBEAT", 1)
    vehicle.ears.append(switch)
    session = Session(SimulatedTransport(world), clock=world.clock)
    assert session.meet(1, 1).version == 2


KEY, WRONG_KEY = bytes(range(32)), bytes(32)


def signed(vehicle_key: bytes | None, our_key: bytes | None) -> tuple[World, Any, Session]:
    world = World()
    vehicle = PROFILES["px4"](world, key=vehicle_key)
    return world, vehicle, Session(SimulatedTransport(world), clock=world.clock, key=our_key)


def test_row_19_signed():
    world, vehicle, session = signed(KEY, KEY)
    stand = Bench(world, vehicle, session._transport, session, session.meet())
    assert_accepted(stand, stand.push().outcome)
    assert session.codec.signatures.good > 10


def test_row_19_wrong_key():
    _, _, session = signed(KEY, WRONG_KEY)
    with pytest.raises(InputError, match="signs with another key"):
        session.meet()


def test_row_19_the_vehicle_does_not_sign():
    _, _, session = signed(None, KEY)
    with pytest.raises(InputError, match="does not sign"):
        session.meet()


def test_row_19_only_the_vehicle_signs():
    world, vehicle, session = signed(KEY, None)
    stand = Bench(world, vehicle, session._transport, session, session.meet())
    outcome = stand.push().outcome
    assert (outcome.verdict, outcome.reason) == ("unknown", "no-answer")
    assert "--sign" in outcome.message
    assert not stand.holds_it()


HARSH = {
    "corrupt": Faults(corruption=0.3),
    "garbage": Faults(garbage=1.0),
    "all twice": Faults(duplication=1.0),
    "reordered": Faults(late=0.5, lateness=1.0),
    "30 % lost": Faults(loss=0.3),
    "all of it": Faults(loss=0.2, corruption=0.1, garbage=0.2, duplication=0.5, late=0.2, lateness=1.0),
}


@both
@pytest.mark.parametrize("faults", HARSH.values(), ids=HARSH)
@pytest.mark.parametrize("seed", range(5))
def test_row_20_bad_links_end_and_never_lie(profile, faults, seed):
    stand = bench(profile, faults=replace(faults), seed=seed, count=12)
    part = stand.push()
    assert part.seconds < 400
    if part.outcome.verdict == "accepted":
        assert stand.holds_it()


@pytest.mark.parametrize("name", ["garbage", "all twice", "30 % lost"])
@both
def test_row_20_what_can_be_borne_is_borne(profile, name):
    stands = [bench(profile, faults=replace(HARSH[name]), seed=seed, count=12) for seed in range(8)]
    verdicts = [stand.push().outcome.verdict for stand in stands]
    assert verdicts.count("accepted") >= 7


@both
def test_row_21_ctrl_c_cancels(profile):
    stand = bench(profile, count=40)
    stand.transport.interrupt_at = stand.world.now + 0.2
    part = stand.push()
    assert (part.outcome.verdict, part.outcome.reason) == ("unknown", "interrupted")
    assert cancels(stand) == 1
    assert stand.session.interrupted
    stand.world.run(0.1)
    assert stand.vehicle.upload is None or profile == "ardupilot"  # ArduPilot does not understand a cancel
    stand.world.run(10.0)
    assert stand.vehicle.upload is None
    mixture = [note for note in part.outcome.notes if "mixture" in note]
    assert len(mixture) == (1 if profile == "ardupilot" else 0)


@both
def test_row_21_ctrl_c_while_reading_back(profile):
    stand = bench(profile, count=40)
    stand.vehicle.ears.append(lambda m: _interrupt(stand) if m.get_type() == "MISSION_REQUEST_LIST" else [m])
    part = stand.push()
    assert part.outcome.verdict == "unknown"
    assert "accepted 4" in part.outcome.message
    assert "interrupted" in part.outcome.message


def _interrupt(stand: Bench) -> list[Any]:
    stand.transport.interrupt_at = stand.world.now
    return []


@both
@every_type
def test_row_22_current_is_never_a_command(profile, kind):
    stand = bench(profile)
    assert_accepted(stand, stand.push(kind).outcome, kind)
    currents = [item.current for item in stand.sent("MISSION_ITEM_INT")]
    assert currents == [int(kind == "mission"), *[0] * (len(currents) - 1)]


@pytest.mark.parametrize("current", [2, 3, -1])
def test_row_22_such_an_item_cannot_even_be_made(current):
    with pytest.raises(ValueError, match="would command the vehicle"):
        item_to_message(MissionItem(3, 16), 0, 1, 1, 0, current)


@both
@pytest.mark.parametrize("delay", [0.6, 2.0, 3.5])
def test_row_23_late_ack(profile, delay):
    stand = bench(profile)

    def late(message):
        if message.get_type() == "MISSION_ACK" and not held:
            held.append(message)
            stand.world.at(stand.world.now + delay, lambda: stand.vehicle.send(message))
            return []
        return [message]

    held: list[Any] = []
    stand.vehicle.mouth.append(late)
    part = stand.push(verify=False)
    assert part.outcome.verdict == "accepted"
    assert stand.holds_it()


@both
@every_type
def test_row_24_read_back_bears_what_the_firmware_does_and_nothing_else(profile, kind):
    stand = bench(profile)
    assert_accepted(stand, stand.push(kind).outcome, kind)
    number = {"mission": 0, "fence": 1, "rally": 2}[kind]
    items = stand.vehicle.held[number]
    spoilt = replace(items[-2], x=items[-2].x + 1)

    def spoil(message):
        if message.get_type() == "MISSION_ACK" and message.type == 0 and message.mission_type == number:
            stand.vehicle.held[number][-2] = spoilt
        return [message]

    stand.vehicle.mouth.append(spoil)
    part = stand.push(kind)
    assert (part.outcome.verdict, part.outcome.reason) == ("rejected", "differs")
    assert part.comparison is not None
    (difference,) = part.comparison.differences
    assert (difference.seq, difference.field) == (len(items) - 2, "latitude")


def test_the_link_dies():
    stand = bench("px4")
    sent = 0

    def fail(data):
        nonlocal sent
        sent += 1
        if sent > 3:
            raise LinkError("the connection is lost (broken pipe)")
        stand.world.carry(data, stand.transport)

    stand.transport.send = fail  # type: ignore[method-assign]
    outcome = stand.push().outcome
    assert (outcome.verdict, outcome.reason) == ("unknown", "lost")
    assert "broken pipe" in outcome.message


def test_the_time_given_is_kept():
    world = World()
    vehicle = PROFILES["px4"](world)
    transport = SimulatedTransport(world)
    session = Session(transport, clock=world.clock, timeout=4.0)
    stand = Bench(world, vehicle, transport, session, session.meet())
    vehicle.deaf("MISSION_ITEM_INT", 1000, seq=2)
    start = world.now
    outcome = stand.push().outcome
    assert (outcome.verdict, outcome.reason) == ("unknown", "time-out")
    assert world.now - start < 4.1
    assert cancels(stand) == 1
