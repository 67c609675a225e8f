"""Our uploader against MAVSDK's MissionRawServer, over real UDP on loopback.

MAVSDK's server is permissive: it stores what it is sent, floats of 32 bits, and knows no home.
"""

from __future__ import annotations

import math
import time
from types import SimpleNamespace

import pytest

from gcs_windplan.link.firmware import incoming_mission, outgoing_items
from gcs_windplan.link.session import open_session
from gcs_windplan.link.verified import clear_items, pull_items, push_items
from gcs_windplan.mission import Command, Frame, MissionItem, MissionItems

from .bench import HOME, survey

two_seconds = 2.0  # the bound set for 700 items


@pytest.mark.parametrize("kind", ["mission", "fence", "rally"])
def test_push_and_pull(mavsdk_autopilot: SimpleNamespace, kind) -> None:
    with open_session(mavsdk_autopilot.address, timeout=20.0) as session:
        peer = session.meet()
        assert (peer.ident, peer.version) == ((1, 1), 2)
        items = outgoing_items(survey(), kind, peer.autopilot)
        part = push_items(session, peer, kind, items)
        assert part.outcome.verdict == "accepted", part.outcome
        assert part.comparison is not None
        assert part.comparison.losses == ()
        pulled = pull_items(session, peer, kind)
        assert pulled.outcome.verdict == "accepted"
        assert len(pulled.items) == len(items)
        assert clear_items(session, peer, kind).outcome.verdict == "accepted"
        assert pull_items(session, peer, kind).items == ()


def test_what_mavsdk_says_it_was_sent(mavsdk_autopilot: SimpleNamespace) -> None:
    odd = MissionItem(Frame.GLOBAL, Command.NAV_WAYPOINT, (1.5, 2.25, 0, math.nan), -46.8134387, 179.9999999, -12.75)
    jump = MissionItem(Frame.MISSION, Command.DO_JUMP, (2, 3, 0, 0))
    mission = MissionItems((*survey(3).items, odd, jump), HOME)
    with open_session(mavsdk_autopilot.address, timeout=20.0) as session:
        peer = session.meet()
        part = push_items(session, peer, "mission", outgoing_items(mission, "mission", peer.autopilot))
        assert part.outcome.verdict == "accepted", part.outcome
        back = incoming_mission(pull_items(session, peer, "mission").items, peer.autopilot)
    _, theirs = mavsdk_autopilot.arrived[-1]
    assert [item.seq for item in theirs] == list(range(5))
    assert [item.current for item in theirs] == [1, 0, 0, 0, 0]
    assert (theirs[3].x, theirs[3].y, theirs[3].z) == (-468134387, 1799999999, -12.75)
    assert (theirs[3].param1, theirs[3].param2) == (1.5, 2.25)
    assert math.isnan(theirs[3].param4)
    assert (theirs[4].command, theirs[4].param1) == (Command.DO_JUMP, 1)  # counted from 0, as there is no home
    assert back.items[3:] == (odd, jump)


def test_700_items_in_under_two_seconds(mavsdk_autopilot: SimpleNamespace) -> None:
    with open_session(mavsdk_autopilot.address, timeout=30.0) as session:
        peer = session.meet()
        start = time.perf_counter()
        part = push_items(session, peer, "mission", survey(700).items)
        took = time.perf_counter() - start
    assert part.outcome.verdict == "accepted", part.outcome
    assert took < two_seconds
    assert len(mavsdk_autopilot.arrived[-1][1]) == 700
