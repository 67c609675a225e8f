"""push, pull, diff and clear as a user meets them, over UDP on loopback to scripted autopilots."""

from __future__ import annotations

import json
import os
import signal
import socket
import subprocess
import sys
import threading
import time
from dataclasses import replace
from pathlib import Path

import pytest
from pymavlink.dialects.v20 import ardupilotmega as mavlink

from gcs_windplan.formats import read_plan, write_plan, write_waypoints
from gcs_windplan.link.codec import Codec
from gcs_windplan.link.session import OWN
from gcs_windplan.mission import Command, Frame, MissionItem, MissionItems
from tests.link.autopilots import PX4, ArduPilot, Autopilot
from tests.link.bench import survey
from tests.link.udp import calling
from tests.mavsdk_peers import free_port
from tests.verbs import CODE, command, run

from .test_cli import GOOD

AT_ONCE = ("--sysid", 1, "--compid", 1)  # named, so that it need not listen for others
ONCE_IT_BEGINS = CODE.replace("main()", "print('begins', flush=True); main()")


def udpin(port: int) -> str:
    return f"udpin:127.0.0.1:{port}"


@pytest.fixture
def plan(tmp_path: Path) -> Path:
    """A .plan with a fence and rally points."""
    path = tmp_path / "survey.plan"
    write_plan(replace(survey(), autopilot="ardupilot", vehicle_type="multicopter"), path)
    return path


@pytest.fixture
def waypoints(tmp_path: Path) -> Path:
    path = tmp_path / "survey.waypoints"
    write_waypoints(survey().without_fence(), path)
    return path


@pytest.mark.parametrize("kind", [ArduPilot, PX4])
def test_push_sends_all_that_the_file_holds_and_pull_brings_it_back(kind: type[Autopilot], plan: Path):
    port, folder = free_port(), plan.parent
    firmware = "px4" if kind is PX4 else "ardupilot"
    with calling(port, kind) as (vehicle,):
        pushed = run("push", plan, "--to", udpin(port), *AT_ONCE, cwd=folder)
        assert pushed.returncode == 0, pushed.stderr
        home = 0 if kind is PX4 else 1
        assert [len(vehicle.held[number]) for number in (0, 1, 2)] == [6 + home, 5, 2]
        assert pushed.stdout.count(" accepted by ") == 3
        pulled = run("pull", "--from", udpin(port), "-o", "onboard.plan", *AT_ONCE, cwd=folder)
        assert pulled.returncode == 0, pulled.stderr
        assert "wrote onboard.plan" in pulled.stdout
        cleared = run("clear", "--on", udpin(port), "--type", "all", *AT_ONCE, cwd=folder)
        assert cleared.returncode == 0, cleared.stderr
        assert [len(vehicle.held[number]) for number in (0, 1, 2)] == [home, 0, 0]
        nothing = run("pull", "--from", udpin(port), "-o", "nothing.plan", *AT_ONCE, cwd=folder)
    assert nothing.returncode == 3
    assert nothing.stderr == "error: the vehicle holds no mission, no fence, no rally: nothing was written\n"
    assert not (folder / "nothing.plan").exists()
    compared = run("diff", "onboard.plan", plan, "--autopilot", firmware, cwd=folder)
    assert compared.returncode == 0, compared.stdout
    assert compared.stdout.endswith("the same\n")
    exact = run("diff", plan, plan.with_name("survey.plan"), cwd=folder)
    assert (exact.returncode, exact.stdout) == (0, "the same\n")


def test_json(plan: Path):
    port = free_port()
    with calling(port, ArduPilot):
        done = run("push", plan, "--to", udpin(port), "--json", cwd=plan.parent)
    assert done.returncode == 0
    document = json.loads(done.stdout)
    assert (document["outcome"], document["exit_code"]) == ("accepted", 0)
    assert "error" not in document
    assert document["vehicle"] == {
        "system": 1, "component": 1, "autopilot": "ardupilot", "type": "multicopter", "mavlink": 2,
    }  # fmt: skip
    mission, fence, rally = document["parts"]
    assert [part["type"] for part in (mission, fence, rally)] == ["mission", "fence", "rally"]
    assert (mission["outcome"], mission["items"], mission["differences"]) == ("accepted", 7, [])
    assert any("altitude" in loss for loss in mission["losses"])


def test_a_home_elsewhere_is_told_loudly(plan: Path):
    port = free_port()
    with calling(port, ArduPilot):
        done = run("push", plan, "--to", udpin(port), "--json", *AT_ONCE, cwd=plan.parent)
    assert done.returncode == 0
    line = done.stderr.splitlines()[-1]
    assert line.startswith("WARNING: the vehicle's home is 10")
    assert "m away from the file's and 1070.8 m lower: it flies altitudes above home from its own" in line
    home = json.loads(done.stdout)["home"]
    assert home["vehicle"] == {"latitude": 47.1234567, "longitude": 8.5432109, "altitude": 489.25}
    assert (home["file"]["altitude"], home["higher"], home["apart"]) == (1560.0, -1070.75, True)
    assert home["distance"] > 100_000


def test_a_home_where_it_was_planned_is_not_told(plan: Path):
    port = free_port()
    with calling(port, PX4) as (vehicle,):
        vehicle.ears.append(lambda message: [message, *telling_home(vehicle, message)])
        done = run("push", plan, "--to", udpin(port), "--json", *AT_ONCE, cwd=plan.parent)
    assert done.returncode == 0
    assert "WARNING" not in done.stderr
    home = json.loads(done.stdout)["home"]
    assert (home["distance"], home["higher"], home["apart"]) == (0.0, 0.0, False)


def telling_home(vehicle: Autopilot, message) -> list:
    """Answer the wish for HOME_POSITION with the survey's."""
    if message.get_type() == "COMMAND_LONG":
        place = (468134380, 98437720, 1560000, 0, 0, 0, [1, 0, 0, 0], 0, 0, 0)
        vehicle.send(mavlink.MAVLink_home_position_message(*place))
    return []


def test_json_has_an_object_for_every_error(plan: Path):
    folder, nowhere = plan.parent, udpin(free_port())
    (folder / "bad.plan").write_text("{")
    (folder / "blank.key").write_text("  \n")
    failing = (
        (2, "error", ("push", "bad.plan", "--to", nowhere)),
        (2, "error", ("push", plan, "--to", "udp:x")),
        (2, "error", ("push", plan, "--to", nowhere, "--sign", "blank.key")),
        (2, "error", ("pull", "--from", nowhere, "-o", "no/x.plan")),
        (4, "unknown", ("push", plan, "--to", nowhere, "--timeout", 0.3)),
        (4, "unknown", ("pull", "--from", nowhere, "-o", "x.plan", "--timeout", 0.3)),
        (4, "unknown", ("clear", "--on", nowhere, "--timeout", 0.3)),
        (2, "error", ("clear", "--on", "udpin")),
    )
    for code, outcome, arguments in failing:
        done = run(*arguments, "--json", cwd=folder)
        document = json.loads(done.stdout)
        assert (done.returncode, document["exit_code"], document["outcome"]) == (code, code, outcome), arguments
        assert document["verb"] == arguments[0]
        assert done.stderr == f"error: {document['error']}\n"
    port = free_port()
    with calling(port, PX4, lambda world: PX4(world, system=7)):
        done = run("clear", "--on", udpin(port), "--json", cwd=folder)
        assert "2 vehicles share the link" in json.loads(done.stdout)["error"]
        done = run("pull", "--from", udpin(port), "-o", "x.plan", "--json", *AT_ONCE, cwd=folder)
        document = json.loads(done.stdout)
        assert (document["outcome"], document["exit_code"], done.returncode) == ("rejected", 3, 3)
        assert document["error"].startswith("the vehicle holds no mission")


def test_pull_of_all_from_mavlink_1_says_that_nothing_was_written(waypoints: Path):
    port, folder = free_port(), waypoints.parent

    def old(world) -> Autopilot:
        vehicle = PX4(world)
        vehicle.codec.version = 1
        return vehicle

    with calling(port, old):
        assert run("push", waypoints, "--to", udpin(port), *AT_ONCE, cwd=folder).returncode == 0
        done = run("pull", "--from", udpin(port), "-o", "x.plan", "--type", "all", *AT_ONCE, cwd=folder)
        cleared = run("clear", "--on", udpin(port), "--type", "all", *AT_ONCE, cwd=folder)
    assert (done.returncode, done.stdout) == (3, "")
    assert done.stderr.splitlines() == [
        "note: nothing was written to x.plan",
        "note: mission was read: the vehicle holds 6 items",
        "error: fence rejected: the vehicle speaks MAVLink 1 only, which has no fence: nothing was read",
    ]
    assert cleared.stderr.splitlines() == [
        "error: fence rejected: the vehicle speaks MAVLink 1 only, which has no fence: nothing was deleted",
        "error: rally not deleted, because of that",
    ]


def test_pull_sees_first_whether_it_can_write(tmp_path: Path):
    (tmp_path / "folder.plan").mkdir()
    (tmp_path / "file").write_text("")
    for name, words in (
        ("folder.plan", "is a folder"),
        ("no/x.plan", "its folder is not there"),
        ("file/x.plan", "its folder is not there"),
        (f"{'x' * 300}.plan", "file name too long"),
    ):
        done = run("pull", "--from", udpin(free_port()), "-o", name, cwd=tmp_path)
        assert (done.returncode, done.stderr.count("\n")) == (2, 1)
        assert words in done.stderr


@pytest.mark.skipif(sys.platform == "win32" or os.geteuid() == 0, reason="root writes everywhere")
def test_pull_sees_a_folder_that_cannot_be_written(tmp_path: Path):
    tmp_path.chmod(0o500)
    done = run("pull", "--from", udpin(free_port()), "-o", tmp_path / "x.plan", cwd=Path("/"))
    assert (done.returncode, "cannot be written" in done.stderr) == (2, True)


@pytest.mark.skipif(not hasattr(signal, "SIGPIPE"), reason="signals")
def test_a_tcp_vehicle_that_hangs_up(waypoints: Path):
    """It asks for an item many times and is gone: the answers go into a closed connection."""
    server = socket.create_server(("127.0.0.1", 0))
    codec = Codec(1, 1)
    beat = codec.encode(mavlink.MAVLink_heartbeat_message(2, mavlink.MAV_AUTOPILOT_PX4, 0, 0, 3, 3))
    request = mavlink.MAVLink_mission_request_int_message(255, OWN.component, 0, 0)

    def play() -> None:
        line, _ = server.accept()
        line.settimeout(20)
        line.sendall(beat)
        while not any(message.get_type() == "MISSION_COUNT" for message in codec.decode(line.recv(4096))):
            pass
        line.sendall(b"".join(codec.encode(request) for _ in range(50)))
        line.close()

    thread = threading.Thread(target=play, daemon=True)
    thread.start()
    address = f"tcp:127.0.0.1:{server.getsockname()[1]}"
    done = run("push", waypoints, "--to", address, *AT_ONCE, cwd=waypoints.parent)
    thread.join(5)
    server.close()
    assert done.returncode == 4
    assert done.stderr.startswith("error: mission unknown: the connection is lost (")
    assert done.stderr.splitlines()[1] == "note: it is not known which mission the vehicle holds: pull it"


def test_a_mission_file_is_planned_and_pushed(tmp_path: Path):
    (tmp_path / "mission.yaml").write_text(GOOD)
    port = free_port()
    with calling(port, ArduPilot) as (vehicle,):
        done = run("push", "mission.yaml", "--to", udpin(port), *AT_ONCE, cwd=tmp_path)
        assert done.returncode == 0, done.stderr
        assert vehicle.held[0][1].command == Command.NAV_TAKEOFF
        assert vehicle.held[0][-1].command == Command.NAV_LAND
    assert not (tmp_path / "out").exists()


def test_waypoints_leave_fence_and_rally_points_as_they_are_unless_all_is_asked(plan: Path, waypoints: Path):
    port = free_port()
    with calling(port, PX4) as (vehicle,):
        run("push", plan, "--to", udpin(port), *AT_ONCE, cwd=plan.parent)
        assert run("push", waypoints, "--to", udpin(port), *AT_ONCE, cwd=plan.parent).returncode == 0
        assert [len(vehicle.held[number]) for number in (1, 2)] == [5, 2]
        done = run("push", waypoints, "--to", udpin(port), "--type", "all", *AT_ONCE, cwd=plan.parent)
        assert done.returncode == 0, done.stderr
        assert [len(vehicle.held[number]) for number in (0, 1, 2)] == [6, 0, 0]
        done = run("push", plan, "--to", udpin(port), "--type", "fence", *AT_ONCE, cwd=plan.parent)
        assert done.returncode == 0, done.stderr
        assert [len(vehicle.held[number]) for number in (0, 1, 2)] == [6, 5, 0]
        assert "note: the file's rally points will not be sent, as --type fence asks" in done.stderr


def test_rejected(tmp_path: Path):
    bad = MissionItem(Frame.GLOBAL_TERRAIN_ALT, Command.NAV_WAYPOINT, (0, 0, 0, 0), 46.8, 9.8, 50)
    mission = replace(survey(), items=(*survey().items[:3], bad), autopilot="px4")
    write_plan(mission, tmp_path / "bad.plan")
    port = free_port()
    with calling(port, PX4) as (vehicle,):
        done = run("push", "bad.plan", "--to", udpin(port), *AT_ONCE, cwd=tmp_path)
        assert vehicle.held[1] == []  # the fence does not go where the mission could not
    assert done.returncode == 3
    assert done.stdout == ""
    error, note, *rest = done.stderr.splitlines()[-4:]
    assert error == (
        "error: mission rejected: the vehicle refused with UNSUPPORTED_FRAME (2) at item 3 (NAV_WAYPOINT): "
        "frame GLOBAL_TERRAIN_ALT"
    )
    assert note == "note: the vehicle keeps its former mission"
    assert rest == ["error: fence not sent, because of that", "error: rally not sent, because of that"]


def test_10_000_items_end_in_no_space(tmp_path: Path):
    write_waypoints(replace(survey(10_000), fence=None, rally=()), tmp_path / "long.waypoints")
    port = free_port()
    with calling(port, ArduPilot):
        done = run("push", "long.waypoints", "--to", udpin(port), *AT_ONCE, cwd=tmp_path)
    assert done.returncode == 3
    assert done.stderr == (
        "error: mission rejected: the vehicle refused with NO_SPACE (4): the vehicle has no room for so many items\n"
    )


def test_nobody_there(waypoints: Path):
    for address in (udpin(free_port()), f"udpout:127.0.0.1:{free_port()}"):
        done = run("push", waypoints, "--to", address, "--timeout", 0.5, cwd=waypoints.parent)
        assert done.returncode == 4
        assert done.stderr == "error: no vehicle was heard: check the address, and that the vehicle is on\n"
    done = run("push", waypoints, "--to", f"tcp:127.0.0.1:{free_port()}", cwd=waypoints.parent)
    assert done.returncode == 4
    assert done.stderr.count("\n") == 1
    assert "connection refused" in done.stderr


@pytest.mark.parametrize(
    ("address", "words"),
    [
        ("udp:127.0.0.1:14550", "udpin:HOST:PORT"),
        ("udpin:127.0.0.1", "lacks host or port"),
        ("udpin:127.0.0.1:many", "from 1 to 65535"),
        ("udpin:127.0.0.1:70000", "from 1 to 65535"),
        ("udpin:203.0.113.7:14550", "cannot be used"),
        ("udpin:no such host:14550", "is not known"),
        ("/dev/no-such-device:57600", "there is no such device"),
        ("", "cannot be opened"),
    ],
)
def test_wrong_address(waypoints: Path, address: str, words: str):
    done = run("push", waypoints, "--to", address, cwd=waypoints.parent)
    assert done.returncode == 2
    assert done.stderr.startswith("error: ")
    assert done.stderr.count("\n") == 1
    assert words in done.stderr


def test_port_in_use(waypoints: Path):
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as taken:
        taken.bind(("127.0.0.1", 0))
        done = run("push", waypoints, "--to", udpin(taken.getsockname()[1]), cwd=waypoints.parent)
    assert done.returncode == 2
    assert "is in use" in done.stderr
    assert done.stderr.count("\n") == 1


def test_keys(waypoints: Path):
    folder, port = waypoints.parent, free_port()
    (folder / "right.key").write_text("00" * 31 + "01\n")
    (folder / "wrong.key").write_text("a passphrase\n")
    (folder / "no.key").write_text("two\nlines\n")
    with calling(port, lambda world: PX4(world, key=bytes(31) + b"\1")) as (vehicle,):
        done = run("push", waypoints, "--to", udpin(port), "--sign", "right.key", *AT_ONCE, cwd=folder)
        assert done.returncode == 0, done.stderr
        assert len(vehicle.held[0]) == 6
        done = run("push", waypoints, "--to", udpin(port), "--sign", "wrong.key", "--timeout", 2, cwd=folder)
        assert done.returncode == 2
        assert done.stderr == "error: the vehicle signs with another key: give its own with --sign\n"
    for name, words in (("no.key", "is no key file"), ("absent.key", "cannot be read")):
        done = run("push", waypoints, "--to", udpin(port), "--sign", name, cwd=folder)
        assert done.returncode == 2
        assert words in done.stderr


def test_files_that_are_no_missions(tmp_path: Path):
    (tmp_path / "poem.waypoints").write_text("Shall I compare thee\n")
    (tmp_path / "poem.txt.gz").write_text("no")
    (tmp_path / "poem.yaml").write_text("- no\n")
    for name in ("poem.waypoints", "poem.txt.gz", "poem.yaml", "absent.plan"):
        done = run("push", name, "--to", udpin(free_port()), cwd=tmp_path)
        assert done.returncode == 2, name
        assert done.stderr.startswith("error: ")
        assert "Traceback" not in done.stderr
    write_plan(MissionItems((), survey().home), tmp_path / "empty.plan")
    done = run("push", "empty.plan", "--to", udpin(free_port()), cwd=tmp_path)
    assert (done.returncode, "verb clear" in done.stderr) == (2, True)


def test_a_fence_that_cannot_be_read_is_not_dropped(plan: Path):
    document = json.loads(plan.read_text())
    del document["geoFence"]["polygons"][0]["polygon"][:2]
    plan.write_text(json.dumps(document))
    done = run("push", plan, "--to", udpin(free_port()), "--timeout", 0.5, cwd=plan.parent)
    assert done.returncode == 2
    assert "geoFence.polygons" in done.stderr
    assert "--type mission" in done.stderr.splitlines()[-1]
    done = run("push", plan, "--to", udpin(free_port()), "--timeout", 0.5, "--type", "mission", cwd=plan.parent)
    assert done.returncode == 4


def test_several_vehicles(waypoints: Path):
    port = free_port()
    with calling(port, ArduPilot, lambda world: PX4(world, system=7)) as (first, second):
        done = run("push", waypoints, "--to", udpin(port), cwd=waypoints.parent)
        assert done.returncode == 2
        assert done.stderr == (
            "error: 2 vehicles share the link (ArduPilot 1/1, PX4 7/1): choose one with --sysid and --compid\n"
        )
        done = run("push", waypoints, "--to", udpin(port), "--sysid", 7, cwd=waypoints.parent)
        assert done.returncode == 0, done.stderr
        assert (len(first.held[0]), len(second.held[0])) == (0, 6)
        done = run("push", waypoints, "--to", udpin(port), "--sysid", 9, "--timeout", 1.5, cwd=waypoints.parent)
        assert done.returncode == 4
        assert "only ArduPilot 1/1, PX4 7/1" in done.stderr


@pytest.mark.skipif(sys.platform == "win32", reason="signals")
@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
@pytest.mark.parametrize("kind", [ArduPilot, PX4])
def test_ctrl_c(kind: type[Autopilot], number: int, waypoints: Path):
    port = free_port()
    with calling(port, kind) as (vehicle,):
        vehicle.deaf("MISSION_ITEM_INT", 1000, seq=3)
        arguments = command("push", waypoints, "--to", udpin(port), *AT_ONCE)
        process = subprocess.Popen(arguments, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        until = time.monotonic() + 20
        while (vehicle.upload is None or vehicle.upload.seq < 3) and time.monotonic() < until:
            time.sleep(0.02)
        process.send_signal(number)
        time.sleep(0.02)
        process.send_signal(number)  # the second one of an impatient user
        out, err = process.communicate(timeout=20)
        until = time.monotonic() + 5
        while not vehicle.heard_kinds("MISSION_ACK") and time.monotonic() < until:
            time.sleep(0.02)
        assert [ack.type for ack in vehicle.heard_kinds("MISSION_ACK")] == [15]
    assert process.returncode == 4
    assert out == ""
    assert err.splitlines()[0] == "error: mission unknown: it was interrupted, and the vehicle was told so"
    assert "Traceback" not in err


@pytest.mark.skipif(sys.platform == "win32", reason="signals")
@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
@pytest.mark.parametrize("delay", [0.0, 0.15, 0.4, 0.8])
def test_an_early_ctrl_c_ends_in_one_line(waypoints: Path, delay: float, number: int):
    """While modules are loaded, and while a vehicle is waited for."""
    arguments = ["push", str(waypoints), "--to", udpin(free_port()), "--json"]
    process = subprocess.Popen(
        [sys.executable, "-c", ONCE_IT_BEGINS, *arguments], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True
    )
    assert process.stdout is not None
    assert process.stdout.readline() == "begins\n"
    time.sleep(delay + 0.02)
    process.send_signal(number)
    time.sleep(0.02)
    process.send_signal(number)
    out, err = process.communicate(timeout=20)
    assert process.returncode == 4
    assert err.count("\n") == 1
    assert "interrupted" in err
    document = json.loads(out)
    assert (document["verb"], document["outcome"], document["exit_code"]) == ("push", "unknown", 4)


@pytest.mark.skipif(sys.platform == "win32", reason="signals")
@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
@pytest.mark.parametrize("delay", [0.05, 1.5])
def test_a_vehicle_that_is_ended(delay: float, number: int):
    process = subprocess.Popen(
        [sys.executable, "-c", ONCE_IT_BEGINS, "vehicle", "--listen", udpin(free_port())],
        stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
    )  # fmt: skip
    assert process.stdout is not None
    assert process.stdout.readline() == "begins\n"
    time.sleep(delay)
    process.send_signal(number)
    out, err = process.communicate(timeout=20)
    assert process.returncode == 0
    assert "Traceback" not in err
    assert (out + err).splitlines()[-1] in ("ended", "interrupted")


def test_not_verified_is_believed(waypoints: Path):
    port = free_port()
    with calling(port, ArduPilot) as (vehicle,):
        done = run("push", waypoints, "--to", udpin(port), "--no-verify", *AT_ONCE, cwd=waypoints.parent)
        assert vehicle.heard_kinds("MISSION_REQUEST_LIST") == []
    assert done.returncode == 0
    assert "the vehicle accepted 7 items" in done.stdout


def test_pull_into_waypoints_and_wrong_names(waypoints: Path):
    port, folder = free_port(), waypoints.parent
    with calling(port, ArduPilot):
        run("push", waypoints, "--to", udpin(port), *AT_ONCE, cwd=folder)
        done = run("pull", "--from", udpin(port), "-o", "back.waypoints", *AT_ONCE, cwd=folder)
        assert done.returncode == 0, done.stderr
    assert run("diff", waypoints, "back.waypoints", "--autopilot", "ardupilot", cwd=folder).returncode == 0
    exact = run("diff", waypoints, "back.waypoints", cwd=folder)
    assert exact.returncode == 1
    assert "mission: home " in exact.stdout
    for name, words in (("x.kml", ".plan nor in .waypoints"), ("no/x.plan", "folder")):
        done = run("pull", "--from", udpin(port), "-o", name, cwd=folder)
        assert done.returncode == 2
        assert words in done.stderr
    done = run("pull", "--from", udpin(port), "-o", "x.waypoints", "--type", "fence", cwd=folder)
    assert done.returncode == 2


def test_a_pull_without_a_home_says_what_it_made_up(waypoints: Path):
    port, folder = free_port(), waypoints.parent
    with calling(port, PX4):
        run("push", waypoints, "--to", udpin(port), *AT_ONCE, cwd=folder)
        done = run("pull", "--from", udpin(port), "-o", "onboard.plan", *AT_ONCE, cwd=folder)
    assert done.returncode == 0
    assert "note: the vehicle told no home" in done.stderr
    home = read_plan(folder / "onboard.plan").mission.home
    assert home is not None
    assert (home.point.latitude_deg, home.altitude) == (46.813438, 0.0)


def test_an_interrupted_pull_leaves_the_old_file(waypoints: Path):
    port, folder = free_port(), waypoints.parent
    (folder / "onboard.plan").write_text("old")
    with calling(port, ArduPilot) as (vehicle,):
        run("push", waypoints, "--to", udpin(port), *AT_ONCE, cwd=folder)
        vehicle.mute("MISSION_ITEM_INT", 1000, seq=4)
        done = run("pull", "--from", udpin(port), "-o", "onboard.plan", "--timeout", 3, *AT_ONCE, cwd=folder)
    assert done.returncode == 4
    assert "error: mission unknown: timed out after 3 s" in done.stderr
    assert (folder / "onboard.plan").read_text() == "old"


def test_diff_names_what_differs(plan: Path):
    mission = read_plan(plan).mission
    moved = replace(mission.items[2], altitude=mission.items[2].altitude + 1, latitude_deg=46.9)
    items = (*mission.items[:2], moved, *mission.items[3:])
    rally = (replace(mission.rally[0], altitude=99.0), *mission.rally[1:])
    write_plan(replace(mission, items=items, rally=rally), plan.parent / "other.plan")
    done = run("diff", plan, "other.plan", cwd=plan.parent)
    assert done.returncode == 1
    lines = done.stdout.splitlines()
    assert lines[0].startswith("mission: item 3: latitude 46.8012346 became 46.9000000")
    assert lines[1].startswith("mission: item 3: altitude 60.14")
    assert lines[2] == "rally: item 1: altitude 60 became 99"
    document = json.loads(run("diff", plan, "other.plan", "--json", cwd=plan.parent).stdout)
    assert document["same"] is False
    assert len(document["parts"]["mission"]["differences"]) == 2
    write_plan(replace(mission, fence=None), plan.parent / "open.plan")
    done = run("diff", plan, "open.plan", cwd=plan.parent)
    assert (done.returncode, done.stdout) == (1, "fence: the number of items 5 became 0\n")


def test_diff_of_files_that_cannot_both_have_fences(plan: Path, waypoints: Path):
    done = run("diff", plan, waypoints, cwd=plan.parent)
    assert done.returncode == 0
    assert "fence and rally points were not compared" in done.stderr


def test_help_documents_the_exit_codes(tmp_path: Path):
    for verb in ("push", "pull", "clear"):
        text = " ".join(run(verb, "--help", cwd=tmp_path).stdout.split())
        assert "0 accepted" in text
        assert "3 rejected" in text
        assert "4 unknown" in text


def test_push_of_a_file_imports_no_kernels(waypoints: Path):
    port = free_port()
    code = (
        "import sys; from gcs_windplan.cli import main\n"
        "try: main()\n"
        "finally: print([m for m in ('numba', 'scipy', 'rasterio', 'pymavlink.mavutil') if m in sys.modules])"
    )
    with calling(port, ArduPilot):
        arguments = [sys.executable, "-c", code, "push", str(waypoints), "--to", udpin(port), "--sysid", "1"]
        done = subprocess.run(arguments, capture_output=True, text=True, timeout=60, check=False)
    assert done.returncode == 0, done.stderr
    assert done.stdout.endswith("[]\n")
