"""Ground stations of other makers."""

from __future__ import annotations

import importlib
from collections.abc import Callable, Iterator
from types import SimpleNamespace
from typing import Any

import pytest


@pytest.fixture
def mavsdk() -> Iterator[Callable[[str], SimpleNamespace]]:
    """Makes a MAVSDK ground station on an address that has met an autopilot."""
    library = importlib.import_module("mavsdk.mavsdk")
    component = importlib.import_module("mavsdk.component_type").ComponentType
    raw = importlib.import_module("mavsdk.plugins.mission_raw")
    log = importlib.import_module("mavsdk.logging")
    log.log_subscribe(lambda *_: True)  # it would print
    owned: list[Any] = []

    def make(address: str) -> SimpleNamespace:
        configuration = library.Configuration.create_with_component_type(component.GROUND_STATION)
        station = library.Mavsdk(configuration)
        owned.extend((configuration, station))
        assert station.add_any_connection(address) == 0
        system = station.first_autopilot(15.0)
        assert system is not None, "MAVSDK met no autopilot within 15 s"
        plugin = raw.MissionRaw(system)
        owned.append(plugin)
        return SimpleNamespace(system=system, missions=plugin, Item=raw.MissionItem)

    yield make
    for owner in reversed(owned):
        owner.destroy()
    log.log_unsubscribe()
