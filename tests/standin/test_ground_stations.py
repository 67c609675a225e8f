"""Ground stations of other makers against the stand-in, over real UDP on loopback."""

from __future__ import annotations

import importlib
import math
import os
import subprocess
import sys
import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest

from gcs_windplan.formats import parse_waypoints, write_waypoints
from gcs_windplan.geo.frame import GeoPoint
from gcs_windplan.link.codec import Codec
from gcs_windplan.link.transport import open_transport
from gcs_windplan.mission import Command, Frame, Home, MissionItem, MissionItems, degrees_e7, plain_frame
from gcs_windplan.mission.firmware import firmware_of
from gcs_windplan.standin.items import FENCE, MISSION, RALLY
from gcs_windplan.standin.service import serve
from gcs_windplan.standin.standin import StandIn
from gcs_windplan.standin.vehicle import StandInOptions
from gcs_windplan.standin.world import world_at

from .loopback import LINE, PATIENCE, free_port, raw_items, until
from .scenes import HOME, at, home_again

MAVPROXY = Path(sys.executable).with_name("mavproxy.py")


@contextmanager
def standing_in(address: str, autopilot: str = "ardupilot", **options: Any) -> Iterator[SimpleNamespace]:
    """A stand-in on a line, in a thread, until the block ends."""
    transport = open_transport(address)
    log: list[str] = []
    firmware = firmware_of(autopilot, "multicopter")
    made = StandInOptions(firmware, firmware.motion, world_at(HOME), **options)
    vehicle = StandIn(made, time.monotonic(), log.append)
    stop = threading.Event()
    thread = threading.Thread(
        target=serve, args=(vehicle, Codec(1, 1), transport, time.monotonic, lambda: not stop.is_set()), daemon=True
    )
    thread.start()
    try:
        yield SimpleNamespace(vehicle=vehicle, log=log)
    finally:
        stop.set()
        thread.join(5.0)
        transport.close()


def numbers(item: Any) -> tuple[Any, ...]:
    params = tuple(None if math.isnan(p) else p for p in (item.param1, item.param2, item.param3, item.param4))
    return plain_frame(item.frame), item.command, params, item.x, item.y, item.z


@pytest.mark.parametrize("autopilot", ["ardupilot", "px4"])
def test_mavsdk_uploads_downloads_and_clears(autopilot, mavsdk) -> None:
    """MAVSDK listens, and the stand-in calls, as simulators do."""
    port = free_port()
    with standing_in(f"udpout:127.0.0.1:{port}", autopilot) as there:
        station = mavsdk(f"udpin://127.0.0.1:{port}")
        until(lambda: not there.vehicle.snapshot(time.monotonic()).booting, "the end of the boot")
        items = LINE if autopilot == "ardupilot" else [at(0, 0, 20, command=Command.NAV_TAKEOFF), *LINE[2:]]
        station.missions.upload_mission(raw_items(station, items))
        assert len(there.vehicle.server.items[MISSION]) == len(items)
        back = station.missions.download_mission()
        assert [item.seq for item in back] == list(range(len(items)))
        assert [(item.command, item.x, item.y) for item in back] == [(item.command, item.x, item.y) for item in items]
        kept = 61.99 if autopilot == "ardupilot" else 61.999
        waypoint = next(item for item in back if item.command == Command.NAV_WAYPOINT and item.z < 300)
        assert waypoint.z == pytest.approx(kept, abs=1e-5)
        station.missions.set_current_mission_item(2)
        assert there.vehicle.flight.current == 2
        station.missions.clear_mission()
        # MAVSDK clears ArduPilot by uploading home alone
        assert len(there.vehicle.server.items[MISSION]) == (1 if autopilot == "ardupilot" else 0)


def test_mavsdk_uploads_fence_and_rally_points(mavsdk) -> None:
    """The stand-in listens, and MAVSDK calls."""
    port = free_port()
    with standing_in(f"udpin:127.0.0.1:{port}", "px4") as there:
        station = mavsdk(f"udpout://127.0.0.1:{port}")
        corners = [(0, 0), (300, 0), (300, 300)]
        fence = [at(*place, 0, command=5001, params=(3, 0, 0, 0)) for place in corners]
        station.missions.upload_geofence(raw_items(station, fence, FENCE))
        rally = [at(50, 50, 40, command=5100)]
        station.missions.upload_rally_points(raw_items(station, rally, RALLY))
        assert {kind: len(items) for kind, items in there.vehicle.server.items.items()} == {0: 0, 1: 3, 2: 1}
        assert [numbers(item)[1:5] for item in station.missions.download_geofence()] == [
            (5001, (3.0, 0.0, 0.0, 0.0), item.x, item.y) for item in fence
        ]
        assert [item.z for item in station.missions.download_rallypoints()] == [40.0]


def test_mavsdk_sees_it_fly(mavsdk) -> None:
    telemetry = importlib.import_module("mavsdk.plugins.telemetry")
    actions = importlib.import_module("mavsdk.plugins.action")
    port = free_port()
    with standing_in(f"udpout:127.0.0.1:{port}", "px4", speedup=40.0) as there:
        station = mavsdk(f"udpin://127.0.0.1:{port}")
        seen, action = telemetry.Telemetry(station.system), actions.Action(station.system)
        try:
            items = [at(0, 0, 20, command=Command.NAV_TAKEOFF), at(0, 120, 25), home_again()]
            station.missions.upload_mission(raw_items(station, items))
            until(seen.health_all_ok, "a vehicle that is ready")
            action.arm()
            station.missions.start_mission()
            until(seen.in_air, "a vehicle in the air")
            until(lambda: seen.position().relative_altitude_m > 24.0, "25 m above home")
            until(lambda: not seen.armed(), "the end of the flight")
            assert "Landed" in there.log
            assert seen.position().latitude_deg == pytest.approx(36.5, abs=1e-6)
        finally:
            action.destroy()
            seen.destroy()


@contextmanager
def mavproxy(port: int, folder: Path) -> Iterator[SimpleNamespace]:
    """MAVProxy without a screen, listening on a port: `type` a command, `text` is what it has printed."""
    environment = {**os.environ, "HOME": str(folder), "PYTHONWARNINGS": "ignore"}
    process = subprocess.Popen(
        [
            sys.executable, str(MAVPROXY), f"--master=udpin:127.0.0.1:{port}", f"--state-basedir={folder}",
            "--default-modules=wp,cmdlong,mode,arm", "--source-system=255",
        ],
        stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, cwd=folder, env=environment,
    )  # fmt: skip
    printed: list[str] = []

    def read() -> None:
        for line in process.stdout:
            printed.append(line)

    thread = threading.Thread(target=read, daemon=True)
    thread.start()

    def write(command: str) -> None:
        process.stdin.write(command + "\n")
        process.stdin.flush()

    try:
        yield SimpleNamespace(type=write, text=lambda: "".join(printed))
    finally:
        process.kill()
        process.wait(5.0)
        thread.join(5.0)
        process.stdin.close()
        process.stdout.close()


def mission_file(folder: Path) -> tuple[Path, MissionItems]:
    items = (
        MissionItem(Frame.GLOBAL_RELATIVE_ALT, Command.NAV_TAKEOFF, altitude=30.0),
        MissionItem(Frame.GLOBAL, Command.DO_CHANGE_SPEED, (1.0, 7.5, -1.0, 0.0)),
        MissionItem(Frame.GLOBAL_RELATIVE_ALT, Command.NAV_WAYPOINT, (0, 0, 0, 0), 36.5018, -84.3, 61.99),
        MissionItem(Frame.GLOBAL_RELATIVE_ALT, Command.NAV_WAYPOINT, (3, 0, 0, 0), 36.5018, -84.2983, 70.0),
        MissionItem(Frame.GLOBAL, Command.NAV_RETURN_TO_LAUNCH),
    )
    mission = MissionItems(items, Home(GeoPoint(36.4, -84.2), 250.0), "ardupilot", "multicopter")
    path = folder / "line.waypoints"
    write_waypoints(mission, path)
    return path, mission


def insist(station, command: str, done) -> None:
    """Type a command until it is done: what MAVProxy is told while it loads its modules on a busy machine is lost."""
    for _ in range(6):
        station.type(command)
        with suppress(AssertionError):
            until(done, command, patience=PATIENCE / 6)
            return
    raise AssertionError(f"not done: {command}")


def test_mavproxy_loads_lists_saves_and_flies(tmp_path) -> None:
    port = free_port()
    path, mission = mission_file(tmp_path)
    with mavproxy(port, tmp_path) as station, standing_in(f"udpout:127.0.0.1:{port}", speedup=20.0) as there:
        until(lambda: "Received" in station.text() or "heartbeat" in station.text().lower(), "a heartbeat")
        until(lambda: not there.vehicle.snapshot(time.monotonic()).booting, "the end of the boot")
        insist(station, f"wp load {path}", lambda: len(there.vehicle.server.items[MISSION]) == 6)
        until(lambda: "Loaded 6 waypoint" in station.text(), "MAVProxy's word")
        station.type("wp list")
        until(lambda: "61.99" in station.text(), "the list")
        station.type(f"wp save {tmp_path / 'back.txt'}")
        saved = until(lambda: (tmp_path / "back.txt").is_file() and (tmp_path / "back.txt").read_text(), "the file")
        back = parse_waypoints(saved).mission
        assert [item.command for item in back.items] == [item.command for item in mission.items]
        heights = [item.altitude for item in mission.items]
        assert [item.altitude for item in back.items] == pytest.approx(heights, abs=1e-5)  # MAVProxy writes floats
        assert degrees_e7(back.home.point.latitude_deg) == 365_000_000  # its own, not the file's
        station.type("mode auto")
        until(lambda: there.vehicle.mode.name == "AUTO", "AUTO")
        station.type("arm throttle")
        until(lambda: not there.vehicle.flight.state.landed, "a vehicle in the air")
        until(lambda: there.vehicle.flight.current == 5, "the way home")
        until(lambda: not there.vehicle.flight.state.armed, "the end of the flight")
        station.type("wp clear")
        until(lambda: there.vehicle.server.items[MISSION] == [], "an empty vehicle")
