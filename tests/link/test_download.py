"""Downloads that are broken off, refused, and changed under the reader's eyes."""

from __future__ import annotations

import math

import pytest
from pymavlink.dialects.v20 import ardupilotmega as mavlink

from gcs_windplan.link.download import Download
from gcs_windplan.link.exchange import Ends
from gcs_windplan.link.session import OWN
from gcs_windplan.link.verified import clear_items, pull_items

from .autopilots import DENIED, ERROR, UNSUPPORTED
from .bench import PROFILES, bench
from .simulation import Faults
from .test_checklist import ack, from_vehicle

both = pytest.mark.parametrize("profile", PROFILES)


def held(profile: str, count: int = 12, **options):
    """A bench whose vehicle holds a mission; then the link gets its faults."""
    faults = options.pop("faults", None)
    stand = bench(profile, count=count, **options)
    assert stand.push().outcome.verdict == "accepted"
    if faults is not None:
        stand.world.faults = faults
    return stand


@both
@pytest.mark.parametrize("loss", [0.0, 0.3, 0.4])
def test_loss_is_borne(profile, loss):
    stand = held(profile, faults=Faults(loss=loss), seed=1)
    part = pull_items(stand.session, stand.peer, "mission")
    assert part.outcome.verdict == "accepted", part.outcome
    assert len(part.items) == len(stand.items())


@both
def test_the_vehicle_is_told_that_all_arrived(profile):
    stand = held(profile)
    stand.world.run(0.1)
    stand.vehicle.heard.clear()
    pull_items(stand.session, stand.peer, "mission")
    stand.world.run(0.1)
    assert [message.type for message in stand.vehicle.heard_kinds("MISSION_ACK")] == [0]


@both
def test_a_slow_link_is_not_asked_twice_for_everything(profile):
    stand = held(profile, faults=Faults(delay=0.3))
    stand.vehicle.heard.clear()
    part = pull_items(stand.session, stand.peer, "mission")
    assert part.outcome.verdict == "accepted"
    assert len(stand.vehicle.heard_kinds("MISSION_REQUEST_INT")) <= len(part.items) + 3


@both
def test_everything_twice(profile):
    stand = held(profile, faults=Faults(duplication=1.0))
    part = pull_items(stand.session, stand.peer, "mission")
    assert part.outcome.verdict == "accepted"
    assert [item.x for item in part.items[1:]] == [item.x for item in stand.items()[1:]]


def test_px4_breaks_off_on_an_old_request_and_the_list_is_read_again():
    stand = held("px4")
    old = []

    def repeat_the_first_request(message):
        if message.get_type() == "MISSION_REQUEST_INT":
            old.append(message)
            if len(old) == 6:
                return [old[0], message]
        return [message]

    stand.vehicle.ears.append(repeat_the_first_request)
    part = pull_items(stand.session, stand.peer, "mission")
    assert part.outcome.verdict == "accepted"
    assert len(part.items) == 12
    assert part.seconds < 2  # at once, not after a silence
    assert len([m for m in stand.vehicle.said if m.get_type() == "MISSION_ACK" and m.type == ERROR]) == 1


@both
def test_silence_half_way_ends(profile):
    stand = held(profile)
    stand.vehicle.mute("MISSION_ITEM_INT", 10**6, seq=5)
    part = pull_items(stand.session, stand.peer, "mission")
    assert (part.outcome.verdict, part.outcome.reason) == ("unknown", "stalled")
    assert "5 of" in part.outcome.message
    assert part.seconds < 60
    stand.world.run(0.1)
    assert stand.vehicle.heard_kinds("MISSION_ACK")[-1].type == 15


@both
def test_a_vehicle_that_dies(profile):
    stand = held(profile)
    stand.vehicle.on = False
    part = pull_items(stand.session, stand.peer, "mission")
    assert (part.outcome.verdict, part.outcome.reason) == ("unknown", "lost")
    assert part.seconds < 12


@pytest.mark.parametrize(("code", "seconds"), [(DENIED, 13), (ERROR, 13), (UNSUPPORTED, 0.5)])
def test_refused(code, seconds):
    stand = held("ardupilot")
    stand.vehicle.answers["MISSION_REQUEST_LIST"] = lambda message, sender: stand.vehicle.ack(sender, code)
    part = pull_items(stand.session, stand.peer, "mission")
    assert (part.outcome.verdict, part.outcome.code) == ("rejected", code)
    assert part.seconds < seconds


def test_a_refusal_that_passes():
    """ArduPilot denies downloads while somebody uploads, at most until it gives the upload up."""
    stand = held("ardupilot")
    stand.vehicle.on_count(mavlink.MAVLink_mission_count_message(1, 1, 99, 0), (254, 190))
    part = pull_items(stand.session, stand.peer, "mission")
    assert part.outcome.verdict == "accepted"
    assert part.seconds > 5


def test_changed_while_it_is_read():
    stand = bench("px4")
    download = Download(Ends(OWN, stand.peer))
    download.begin(0.0)
    count = mavlink.MAVLink_mission_count_message
    (answer,) = download.handle(from_vehicle(count(*OWN, 3, 0)), 0.1)
    assert (answer.get_type(), answer.seq) == ("MISSION_REQUEST_INT", 0)
    download.handle(from_vehicle(count(*OWN, 3, 0)), 0.2)
    assert not download.done
    download.handle(from_vehicle(count(*OWN, 4, 0)), 0.3)
    assert (download.outcome.verdict, download.outcome.reason) == ("unknown", "changed")


def test_an_item_that_cannot_be():
    stand = bench("px4")
    download = Download(Ends(OWN, stand.peer))
    download.begin(0.0)
    download.handle(from_vehicle(mavlink.MAVLink_mission_count_message(*OWN, 1, 0)), 0.1)
    item = mavlink.MAVLink_mission_item_int_message(*OWN, 0, 3, 16, 0, 1, 0, 0, 0, 0, 0, 0, math.inf, 0)
    download.handle(from_vehicle(item), 0.2)
    assert (download.outcome.verdict, download.outcome.reason) == ("unknown", "unreadable")
    assert "item 0" in download.outcome.message


def test_it_ends_whatever_the_vehicle_says():
    """A vehicle that refuses every item and lists again and again."""
    stand = bench("px4")
    download = Download(Ends(OWN, stand.peer))
    now = 0.0
    download.begin(now)
    for _ in range(1000):
        if download.done:
            break
        now += 0.5
        download.handle(from_vehicle(mavlink.MAVLink_mission_count_message(*OWN, 3, 0)), now)
        download.handle(from_vehicle(ack(ERROR)), now)
        download.tick(now)
    assert download.done
    assert now < 120
    assert download.outcome.verdict == "unknown"


@both
def test_clear(profile):
    stand = held(profile)
    assert clear_items(stand.session, stand.peer, "mission").outcome.verdict == "accepted"
    assert len(stand.vehicle.held[0]) == (1 if profile == "ardupilot" else 0)


def test_clear_refused():
    """ArduPilot refuses while it flies the mission (measured)."""
    stand = held("ardupilot")
    stand.vehicle.answers["MISSION_CLEAR_ALL"] = lambda message, sender: stand.vehicle.ack(sender, ERROR)
    part = clear_items(stand.session, stand.peer, "mission")
    assert (part.outcome.verdict, part.outcome.code) == ("rejected", ERROR)


@both
def test_clear_that_is_only_said(profile):
    stand = held(profile)
    stand.vehicle.answers["MISSION_CLEAR_ALL"] = lambda message, sender: stand.vehicle.ack(sender, 0)
    part = clear_items(stand.session, stand.peer, "mission")
    assert (part.outcome.verdict, part.outcome.reason) == ("rejected", "differs")


@both
def test_clear_lost(profile):
    stand = held(profile)
    stand.vehicle.deaf("MISSION_CLEAR_ALL", 3)
    assert clear_items(stand.session, stand.peer, "mission").outcome.verdict == "accepted"
    stand.vehicle.deaf("MISSION_CLEAR_ALL", 100)
    part = clear_items(stand.session, stand.peer, "mission")
    assert (part.outcome.verdict, part.outcome.reason) == ("unknown", "no-answer")
    assert part.seconds < 12
