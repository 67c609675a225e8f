"""push, pull, diff and clear as a user meets them, over UDP on loopback to scripted autopilots."""

from __future__ import annotations

import json
import signal
import socket
import subprocess
import sys
import time
from dataclasses import replace
from pathlib import Path

import pytest

from gcs_windplan.formats import read_plan, write_plan, write_waypoints
from gcs_windplan.mission import Command, Frame, Mission, MissionItem
from tests.link.autopilots import PX4, ArduPilot, Autopilot
from tests.link.bench import survey
from tests.link.udp import calling
from tests.mavsdk_peers import free_port

from .test_cli import GOOD

AT_ONCE = ("--sysid", 1, "--compid", 1)  # named, so that it need not listen for others
CODE = "import sys; from gcs_windplan.cli import main; sys.argv[0] = 'gcs-windplan'; main()"


def command(*arguments) -> list[str]:
    return [sys.executable, "-W", "error", "-c", CODE, *map(str, arguments)]


def run(*arguments, cwd: Path) -> subprocess.CompletedProcess[str]:
    return subprocess.run(command(*arguments), cwd=cwd, capture_output=True, text=True, timeout=120, check=False)


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
    assert (done.returncode, done.stderr) == (0, "")
    document = json.loads(done.stdout)
    assert (document["outcome"], document["exit_code"]) == ("accepted", 0)
    assert document["vehicle"] == {
        "system": 1, "component": 1, "autopilot": "ardupilot", "type": "multicopter", "mavlink": 2,
    }  # fmt: skip
    mission, fence, rally = document["parts"]
    assert [part["type"] for part in (mission, fence, rally)] == ["mission", "fence", "rally"]
    assert (mission["outcome"], mission["items"], mission["differences"]) == ("accepted", 7, [])
    assert any("altitude" in loss for loss in mission["losses"])


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
    write_plan(Mission((), survey().home), tmp_path / "empty.plan")
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
@pytest.mark.parametrize("kind", [ArduPilot, PX4])
def test_ctrl_c(kind: type[Autopilot], waypoints: Path):
    port = free_port()
    with calling(port, kind) as (vehicle,):
        vehicle.deaf("MISSION_ITEM_INT", 1000, seq=3)
        arguments = command("push", waypoints, "--to", udpin(port), *AT_ONCE)
        process = subprocess.Popen(arguments, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        until = time.monotonic() + 20
        while (vehicle.upload is None or vehicle.upload.seq < 3) and time.monotonic() < until:
            time.sleep(0.02)
        process.send_signal(signal.SIGINT)
        out, err = process.communicate(timeout=20)
        until = time.monotonic() + 5
        while not vehicle.heard_kinds("MISSION_ACK") and time.monotonic() < until:
            time.sleep(0.02)
        assert [ack.type for ack in vehicle.heard_kinds("MISSION_ACK")] == [15]
    assert process.returncode == 4
    assert out == ""
    assert err.splitlines()[0] == "error: mission unknown: it was interrupted, and the vehicle was told so"
    assert "Traceback" not in err


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
    assert "error: mission unknown: the 3 s given for everything are over" in done.stderr
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
