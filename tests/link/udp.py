"""A scripted autopilot on a real UDP socket, in a thread of its own."""

from __future__ import annotations

import select
import socket
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field

from .autopilots import Autopilot
from .simulation import Node, World


@dataclass(slots=True)
class UdpWorld(World):
    """The world of the clock on the wall; its bus is a socket that calls the ground station's port."""

    station: tuple[str, int] = ("127.0.0.1", 0)
    line: socket.socket = field(default_factory=lambda: socket.socket(socket.AF_INET, socket.SOCK_DGRAM))

    def __post_init__(self) -> None:
        World.__post_init__(self)
        self.now = time.monotonic()

    def carry(self, data: bytes, source: Node) -> None:
        self.line.sendto(data, self.station)

    def serve(self, stop: threading.Event) -> None:
        while not stop.is_set():
            self.now = time.monotonic()
            if select.select([self.line], [], [], 0.01)[0]:
                data = self.line.recv(65_535)
                self.now = time.monotonic()
                for node in self.nodes:
                    node.take(data)
            while self.step(time.monotonic()):
                pass


@contextmanager
def calling(port: int, *makers: Callable[[World], Autopilot]) -> Iterator[list[Autopilot]]:
    """Autopilots that call a ground station's port, all on one socket, until the block ends."""
    world = UdpWorld(station=("127.0.0.1", port), beat=0.1)
    vehicles = [maker(world) for maker in makers]
    stop = threading.Event()
    thread = threading.Thread(target=world.serve, args=(stop,), daemon=True)
    thread.start()
    try:
        yield vehicles
    finally:
        stop.set()
        thread.join(5.0)
        world.line.close()
