"""A link with faults and a clock of its own: nothing waits, and time is what the events say."""

from __future__ import annotations

import heapq
import itertools
import random
from collections import deque
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Protocol


@dataclass(slots=True)
class Faults:
    """What happens to each datagram on its way; probabilities, and seconds."""

    loss: float = 0.0
    duplication: float = 0.0
    corruption: float = 0.0
    garbage: float = 0.0
    delay: float = 0.01
    jitter: float = 0.0
    late: float = 0.0  # probability of being late by up to `lateness`: overtaken by others
    lateness: float = 2.0


class Node(Protocol):
    """Somebody on the link."""

    def take(self, data: bytes) -> None: ...


@dataclass(slots=True)
class World:
    """The clock, what is to happen, and the bus that everybody hears."""

    seed: int = 0
    faults: Faults = field(default_factory=Faults)
    now: float = 100.0
    beat: float = 1.0  # [s] between heartbeats
    carried: int = 0
    nodes: list[Node] = field(default_factory=list)
    rng: random.Random = field(init=False)
    _events: list[tuple[float, int, Callable[[], None]]] = field(default_factory=list)
    _numbers: itertools.count[int] = field(default_factory=itertools.count)

    def __post_init__(self) -> None:
        self.rng = random.Random(self.seed)

    def clock(self) -> float:
        return self.now

    def at(self, time: float, action: Callable[[], None]) -> None:
        heapq.heappush(self._events, (time, next(self._numbers), action))

    def every(self, period: float, action: Callable[[], None], first: float = 0.0) -> None:
        def again() -> None:
            action()
            self.at(self.now + period, again)

        self.at(self.now + first, again)

    def step(self, until: float) -> bool:
        """Let the next event happen if it is due before `until`; else only time passes."""
        if not self._events or self._events[0][0] > until:
            self.now = max(self.now, until)
            return False
        time, _, action = heapq.heappop(self._events)
        self.now = max(self.now, time)
        action()
        return True

    def run(self, seconds: float) -> None:
        until = self.now + seconds
        while self.step(until):
            pass

    def carry(self, data: bytes, source: Node) -> None:
        for node in self.nodes:
            if node is not source:
                self._carry_to(data, node)

    def _carry_to(self, data: bytes, node: Node) -> None:
        rng, faults = self.rng, self.faults
        self.carried += 1
        for _ in range(1 + (rng.random() < faults.duplication)):
            if rng.random() < faults.loss:
                continue
            delay = faults.delay + faults.jitter * rng.random()
            if rng.random() < faults.late:
                delay += faults.lateness * rng.random()
            copy = self._spoilt(data)
            self.at(self.now + delay, lambda copy=copy: node.take(copy))  # type: ignore[misc]

    def _spoilt(self, data: bytes) -> bytes:
        rng, faults = self.rng, self.faults
        if rng.random() < faults.corruption:
            spoilt = bytearray(data)
            for _ in range(rng.randint(1, 3)):
                spoilt[rng.randrange(len(spoilt))] = rng.randrange(256)
            data = bytes(spoilt)
        if rng.random() < faults.garbage:
            data = rng.randbytes(rng.randint(1, 12)) + data
        return data


class SimulatedTransport:
    """Our end of the link; waiting lets the world go on."""

    def __init__(self, world: World) -> None:
        self.world = world
        self.closed = False
        self.interrupt_at: float | None = None
        self.sent: list[tuple[float, bytes]] = []
        self._inbox: deque[bytes] = deque()
        world.nodes.append(self)

    def send(self, data: bytes) -> None:
        self.sent.append((self.world.now, data))
        self.world.carry(data, self)

    def receive(self, timeout: float) -> bytes:
        until = self.world.now + timeout
        while not self._inbox:
            if self.interrupt_at is not None and self.world.now >= self.interrupt_at:
                self.interrupt_at = None
                raise KeyboardInterrupt
            if not self.world.step(until):
                return b""
        return self._inbox.popleft()

    def take(self, data: bytes) -> None:
        self._inbox.append(data)

    def close(self) -> None:
        self.closed = True
