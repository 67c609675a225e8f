"""Peers that read our files, and missions for them to read."""

from __future__ import annotations

import importlib
import math
import os
import warnings
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest

from tests.mavsdk_peers import free_port, mavsdk_instances

MISSIONS = Path(__file__).resolve().parents[2].parent / "shared" / "data" / "missions"


@pytest.fixture(scope="session")
def mavwp_load() -> Callable[[Path], list[Any]]:
    """pymavlink's reader of .waypoints; its import changes the environment, which is put back."""
    with _environment_kept(), warnings.catch_warnings():
        warnings.simplefilter("ignore")
        os.environ["MAVLINK20"] = "1"
        mavwp = importlib.import_module("pymavlink.mavwp")

    def load(path: Path) -> list[Any]:
        with _environment_kept():
            os.environ["MAVLINK20"] = "1"
            loader = mavwp.MAVWPLoader()
            loader.load(str(path))
        return list(loader.wpoints)

    return load


@contextmanager
def _environment_kept() -> Iterator[None]:
    before = dict(os.environ)
    try:
        yield
    finally:
        os.environ.clear()
        os.environ.update(before)


@pytest.fixture(scope="session")
def mavsdk_pair() -> Iterator[SimpleNamespace]:
    """A MAVSDK ground station (`gcs`) that has met a MAVSDK `autopilot`, as `system`, over loopback."""
    component = importlib.import_module("mavsdk.component_type").ComponentType
    with mavsdk_instances("GROUND_STATION", "AUTOPILOT") as (gcs, autopilot):
        port = free_port()
        assert gcs.add_any_connection(f"udpin://127.0.0.1:{port}") == 0
        assert autopilot.add_any_connection(f"udpout://127.0.0.1:{port}") == 0
        autopilot.server_component_by_type(component.AUTOPILOT)
        system = gcs.first_autopilot(10.0)
        assert system is not None, "the two MAVSDK instances did not meet within 10 s"
        yield SimpleNamespace(gcs=gcs, autopilot=autopilot, system=system)


@pytest.fixture(scope="session")
def mission_raw(mavsdk_pair: SimpleNamespace) -> Iterator[Any]:
    """MAVSDK's MissionRaw plugin, whose importers read both formats."""
    plugin = importlib.import_module("mavsdk.plugins.mission_raw").MissionRaw(mavsdk_pair.system)
    yield plugin
    plugin.destroy()


def same_number(ours: float, theirs: float, tolerance: float) -> bool:
    """Equal within the tolerance, or both NaN."""
    return (math.isnan(ours) and math.isnan(theirs)) or abs(ours - theirs) <= tolerance
