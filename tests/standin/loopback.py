"""Waiting with an end, free ports, and missions as MAVSDK takes them."""

from __future__ import annotations

import socket
import time
from collections.abc import Callable
from types import SimpleNamespace
from typing import Any

from gcs_windplan.standin.items import MISSION, StoredItem

from .scenes import at, home_again, speed, takeoff

PATIENCE = 90.0  # [s] for everything that a test waits for
LINE = [at(0, 0, 300.0, frame=0), takeoff(61.999), speed(7.5), at(0, 200, 61.999), at(150, 200, 70), home_again()]


def free_port() -> int:
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as probe:
        probe.bind(("127.0.0.1", 0))
        return int(probe.getsockname()[1])


def until(true: Callable[[], Any], what: str, patience: float = PATIENCE) -> Any:
    """Wait until something is true; at most `patience` seconds."""
    end = time.monotonic() + patience
    while time.monotonic() < end:
        found = true()
        if found:
            return found
        time.sleep(0.02)
    raise AssertionError(f"not within {patience} s: {what}")


def raw_items(station: SimpleNamespace, items: list[StoredItem], kind: int = MISSION) -> list[Any]:
    return [
        station.Item(seq, item.frame, item.command, int(seq == 0), 1, *item.params, item.x, item.y, item.z, kind)
        for seq, item in enumerate(items)
    ]
