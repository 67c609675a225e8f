"""Peers of other makers, on loopback."""

from __future__ import annotations

import importlib
from collections.abc import Iterator
from types import SimpleNamespace

import pytest

from tests.mavsdk_peers import free_port, mavsdk_instances


@pytest.fixture
def mavsdk_autopilot() -> Iterator[SimpleNamespace]:
    """MAVSDK as an autopilot that calls `address`; `arrived` collects what its MissionRawServer was sent."""
    component = importlib.import_module("mavsdk.component_type").ComponentType
    servers = importlib.import_module("mavsdk.plugins.mission_raw_server")
    with mavsdk_instances("AUTOPILOT") as (autopilot,):
        port = free_port()
        assert autopilot.add_any_connection(f"udpout://127.0.0.1:{port}") == 0
        server = servers.MissionRawServer(autopilot.server_component_by_type(component.AUTOPILOT))
        arrived: list[tuple[object, list[object]]] = []
        server.subscribe_incoming_mission(lambda result, plan, _: arrived.append((result, plan.mission_items)))
        yield SimpleNamespace(address=f"udpin:127.0.0.1:{port}", arrived=arrived)
