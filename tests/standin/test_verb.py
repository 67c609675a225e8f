"""`gcs-windplan vehicle` as a user runs it, on loopback."""

from __future__ import annotations

import importlib
import signal
import socket
import time
from collections.abc import Callable, Iterator
from contextlib import ExitStack
from pathlib import Path
from types import SimpleNamespace

import pytest

from gcs_windplan.link.session import open_session
from gcs_windplan.link.verified import push_items
from gcs_windplan.mission import Command, Frame, MissionItem
from tests.verbs import Verb, run, started

from .loopback import LINE, PATIENCE, free_port, raw_items, until
from .scenes import HILL


@pytest.fixture
def verb() -> Iterator[Callable[..., Verb]]:
    """Starts `gcs-windplan vehicle`; in a `fresh` interpreter as a user does."""
    with ExitStack() as stack:
        yield lambda *options, fresh=False: stack.enter_context(
            started("vehicle", *options, cwd=Path.cwd(), fresh=fresh)
        )


def test_it_calls_itself_a_stand_in(tmp_path) -> None:
    done = run("vehicle", "--help", cwd=tmp_path)
    assert done.returncode == 0
    words = " ".join(done.stdout.split())
    assert "a stand-in, not a simulator" in words
    assert "a plain linear battery" in words


def test_the_verb_with_mavsdk_and_ctrl_c(verb, mavsdk) -> None:
    port = free_port()
    running = verb(
        "--listen", f"udpin:127.0.0.1:{port}", "--home", "36.5,-84.3,300", "--fly", "--speedup", "20", fresh=True
    )
    until(lambda: "a stand-in, no real vehicle" in running.stdout, "its first line")
    station = mavsdk(f"udpout://127.0.0.1:{port}")
    until(lambda: "is there" in running.stdout, "a greeting")
    until(lambda: _uploaded(station), "an upload")
    until(lambda: "item 3 is the current one: NAV_WAYPOINT" in running.stdout, "a flight")
    running.send_signal(signal.SIGINT)
    assert running.wait(10.0) == 0
    assert running.stderr == ""
    assert until(lambda: running.stdout.endswith("ended\n"), "its last line")
    assert "upload of mission by" in running.stdout


def _uploaded(station: SimpleNamespace) -> bool:
    """Whether an upload is taken; while it boots the vehicle says NO_SPACE."""
    errors = importlib.import_module("mavsdk.plugins.mission_raw").MissionRawError
    try:
        station.missions.upload_mission(raw_items(station, LINE))
    except errors:
        return False
    return True


def test_700_items_in_two_seconds(verb) -> None:
    port = free_port()
    running = verb("--listen", f"udpin:127.0.0.1:{port}")
    until(lambda: "a stand-in" in running.stdout, "its first line")
    with open_session(f"udpout:127.0.0.1:{port}", timeout=20.0) as session:
        peer = session.meet()
        for count in range(1, 6):  # a busy machine may stop us in one of them
            begin = time.monotonic()
            part = push_items(session, peer, "mission", [PLACE] * 700)
            assert time.monotonic() - begin < PATIENCE
            assert part.outcome.verdict == "accepted", part.outcome
            until(lambda count=count: running.stdout.count("accepted: 700 items in") == count, "the log")
            seconds = float(running.stdout.rpartition("700 items in ")[2].split()[0])
            if seconds < 2.0:
                break
    assert seconds < 2.0


PLACE = MissionItem(Frame.GLOBAL_RELATIVE_ALT, Command.NAV_WAYPOINT, (0, 0, 0, 0), 36.5, -84.3, 50.0)


def test_a_tcp_server_waits_for_the_next_caller(verb) -> None:
    port = free_port()
    running = verb("--listen", f"tcpin:127.0.0.1:{port}", "--autopilot", "px4")
    until(lambda: "a stand-in" in running.stdout, "its first line")
    for _ in range(2):
        with open_session(f"tcp:127.0.0.1:{port}", timeout=20.0) as session:
            part = push_items(session, session.meet(), "mission", [PLACE] * 3)
        assert part.outcome.verdict == "accepted", part.outcome
    until(lambda: running.stdout.count("it waits for the next one") == 2, "two goodbyes")


def test_signed(verb, tmp_path) -> None:
    port = free_port()
    (tmp_path / "key").write_text("sesame")
    running = verb("--listen", f"udpin:127.0.0.1:{port}", "--autopilot", "px4", "--sign", str(tmp_path / "key"))
    until(lambda: "a stand-in" in running.stdout, "its first line")
    with open_session(f"udpout:127.0.0.1:{port}", key_file=tmp_path / "key", timeout=20.0) as session:
        part = push_items(session, session.meet(), "mission", [PLACE] * 3)
    assert part.outcome.verdict == "accepted", part.outcome
    with open_session(f"udpout:127.0.0.1:{port}", timeout=2.5) as session:  # hears, and is not heard
        part = push_items(session, session.meet(), "mission", [PLACE] * 5)
    assert part.outcome.verdict == "unknown", part.outcome
    assert "5 items" not in running.stdout


def test_mavlink_1(verb) -> None:
    port = free_port()
    running = verb("--listen", f"udpin:127.0.0.1:{port}", "--mavlink1", "--sysid", "7", "--capacity", "4")
    until(lambda: "a stand-in" in running.stdout, "its first line")
    with open_session(f"udpout:127.0.0.1:{port}", timeout=20.0) as session:
        peer = session.meet()
        assert (peer.ident.system, peer.version, peer.autopilot) == (7, 1, "ardupilot")
        assert push_items(session, peer, "mission", [PLACE] * 3).outcome.verdict == "accepted"
        refused = push_items(session, peer, "mission", [PLACE] * 5).outcome
        assert (refused.verdict, "NO_SPACE" in str(refused)) == ("rejected", True)


def test_the_world_of_a_mission_file(verb, tmp_path) -> None:
    path = tmp_path / "hill.yaml"
    path.write_text(HILL.format(autopilot="px4").replace("airspeed", "type: fixed-wing, airspeed"))
    running = verb("--listen", f"udpin:127.0.0.1:{free_port()}", "--mission", str(path), "--wind", "4@90")
    until(lambda: "it stands at" in running.stdout, "its second line")
    note, first, second = running.stdout.splitlines()[:3]
    assert "the stand-in flies as a multicopter" in note
    assert "PX4's mission rules" in first
    assert "it stands at 46.79999" in second
    assert "constant wind, 4.0 m/s from 090°" in second


@pytest.mark.parametrize(
    ("options", "said"),
    [
        (["--listen", "nowhere"], "nowhere"),
        (["--listen", "udpin:127.0.0.1:99999"], "99999"),
        (["--listen", "udpin:no.such.host.invalid:14550"], "no.such.host.invalid"),
        (["--autopilot", "betaflight"], "'betaflight' is none of ardupilot, px4"),
        (["--wind", "5"], "--wind: '5' says no direction: write '5 from 270'"),
        (["--wind", "-5@270"], "--wind: must be at least 0 m/s"),
        (["--wind", "5@west"], "--wind"),
        (["--home", "46.8,9.8"], "--home: '46.8,9.8' has no altitude"),
        (["--wind", "somewhere.nc"], "--wind: a forecast needs --mission"),
        (["--home", "here"], "--home: 'here' is no place; write LAT,LON"),
        (["--home", "99,0,0"], "--home: latitude: must be between -90 and 90 deg"),
        (["--airspeed", "fast"], "--airspeed"),
        (["--mission", "none.yaml"], "none.yaml"),
        (["--sign", "none.key"], "none.key"),
        (["--speedup", "0"], "--speedup"),
        (["--capacity", "-1"], "--capacity"),
    ],
)
def test_what_cannot_be_used_is_one_clear_line(options, said, tmp_path) -> None:
    done = run("vehicle", *options, cwd=tmp_path)
    assert done.returncode == 2
    errors = done.stderr
    assert said in errors
    assert "Traceback" not in errors
    if not errors.startswith("Usage"):
        assert len(errors.splitlines()) == 1
        assert errors.startswith("error: ")


def test_a_port_in_use(tmp_path) -> None:
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as taken:
        taken.bind(("127.0.0.1", 0))
        done = run("vehicle", "--listen", f"udpin:127.0.0.1:{taken.getsockname()[1]}", cwd=tmp_path)
    assert done.returncode == 2
    assert "in use" in done.stderr
