"""MAVSDK as ground station or autopilot, for tests to talk to on loopback."""

from __future__ import annotations

import functools
import importlib
import socket
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any


@contextmanager
def mavsdk_instances(*kinds: str) -> Iterator[list[Any]]:
    """One MAVSDK a kind (`GROUND_STATION`, `AUTOPILOT`), ended with the block."""
    mavsdk = importlib.import_module("mavsdk.mavsdk")
    component = importlib.import_module("mavsdk.component_type").ComponentType
    _silence()
    configurations = [mavsdk.Configuration.create_with_component_type(component[kind]) for kind in kinds]
    instances = [mavsdk.Mavsdk(configuration) for configuration in configurations]
    try:
        yield instances
    finally:
        for owner in (*instances, *configurations):
            owner.destroy()


@functools.cache
def _silence() -> None:
    importlib.import_module("mavsdk.logging").log_subscribe(lambda *_: True)  # it would print


def free_port() -> int:
    """A UDP port of loopback that nobody has."""
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as probe:
        probe.bind(("127.0.0.1", 0))
        return int(probe.getsockname()[1])
