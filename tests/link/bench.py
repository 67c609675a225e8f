"""A vehicle, a link and our session on it, all in simulated time; and missions to send."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import Any

from gcs_windplan.geo.frame import GeoPoint
from gcs_windplan.link.firmware import outgoing_items
from gcs_windplan.link.peer import Peer
from gcs_windplan.link.session import Session
from gcs_windplan.link.verified import Part, push_items
from gcs_windplan.link.wire import MISSION_TYPES, MissionType
from gcs_windplan.mission import (
    Command,
    Fence,
    FenceCircle,
    FencePolygon,
    Frame,
    Home,
    MissionItem,
    MissionItems,
    RallyPoint,
)

from .autopilots import PX4, ArduPilot, Autopilot, Stored
from .simulation import Faults, SimulatedTransport, World

PROFILES: dict[str, type[Autopilot]] = {"ardupilot": ArduPilot, "px4": PX4}
HOME = Home(GeoPoint(46.8134380, 9.8437720), 1560.0)
SQUARE = tuple(GeoPoint(46.80 + a, 9.80 + b) for a, b in ((0, 0), (0, 0.1), (0.1, 0.1), (0.1, 0)))
FENCE = Fence((FencePolygon(SQUARE),), (FenceCircle(GeoPoint(46.85, 9.85), 120.5, inclusion=False),))
RALLY = (RallyPoint(GeoPoint(46.82, 9.83), 60.0), RallyPoint(GeoPoint(46.84, 9.86), 75.0))


def survey(count: int = 6) -> MissionItems:
    """A mission of `count` items: take-off, waypoints whose altitudes are no whole centimetres, return."""
    relative = Frame.GLOBAL_RELATIVE_ALT
    start = MissionItem(relative, Command.NAV_TAKEOFF, (15.0, 0, 0, 0), 46.813438, 9.843772, 40.0)
    points = [
        MissionItem(relative, Command.NAV_WAYPOINT, (seq % 4, 0, 0, 0), 46.8 + seq * 1.234567e-3, 9.8, 60.0 + seq / 7)
        for seq in range(count - 2)
    ]
    end = MissionItem(Frame.GLOBAL, Command.NAV_RETURN_TO_LAUNCH)
    return MissionItems((start, *points, end)[:count] if count > 1 else (start,), HOME, fence=FENCE, rally=RALLY)


@dataclass(slots=True)
class Bench:
    """`vehicle` on the link with `session`, which has met it as `peer`."""

    world: World
    vehicle: Autopilot
    transport: SimulatedTransport
    session: Session
    peer: Peer
    mission: MissionItems = field(default_factory=survey)

    def push(self, kind: MissionType = "mission", **options: Any) -> Part:
        return push_items(self.session, self.peer, kind, self.items(kind), **options)

    def items(self, kind: MissionType = "mission") -> tuple[MissionItem, ...]:
        return outgoing_items(self.mission, kind, self.peer.autopilot)

    def wanted(self, kind: MissionType = "mission") -> list[Stored]:
        """What the vehicle must hold in the end."""
        return expected(type(self.vehicle), self.items(kind), MISSION_TYPES[kind])

    def holds_it(self, kind: MissionType = "mission") -> bool:
        return same(self.vehicle.listed(MISSION_TYPES[kind]), self.wanted(kind))

    def sent(self, kind: str) -> list[Any]:
        """What our side sent of a type, as the vehicle would decode it."""
        from gcs_windplan.link.codec import Codec

        codec = Codec(1, 1)
        messages = [message for _, data in self.transport.sent for message in codec.decode(data)]
        return [message for message in messages if message.get_type() == kind]


def bench(profile: str = "ardupilot", *, faults: Faults | None = None, seed: int = 0, count: int = 6) -> Bench:
    """A bench whose session has met the vehicle on a link without faults; then the faults begin."""
    world = World(seed)
    vehicle = PROFILES[profile](world)
    transport = SimulatedTransport(world)
    session = Session(transport, clock=world.clock)
    peer = session.meet()
    if faults is not None:
        world.faults = faults
    return Bench(world, vehicle, transport, session, peer, survey(count))


def expected(profile: type[Autopilot], items: tuple[MissionItem, ...], kind: int) -> list[Stored]:
    """What a vehicle keeps of items, by the test's own rules."""
    sent = [
        Stored(item.command, item.frame, item.params, item.x, item.y, item.altitude, int(item.autocontinue))
        for item in items
    ]
    if profile is ArduPilot and kind == 0 and sent:
        return [ArduPilot.home, *(ArduPilot.kept(item, kind) for item in sent[1:])]
    return [profile.kept(item, kind) for item in sent]  # type: ignore[attr-defined]


def same(held: list[Stored], wanted: list[Stored]) -> bool:
    """Equal number by number; NaN equals NaN."""
    return [_numbers(item) for item in held] == [_numbers(item) for item in wanted]


def _numbers(item: Stored) -> tuple[Any, ...]:
    floats = tuple("nan" if math.isnan(number) else number for number in (*item.params, item.z))
    return (item.command, item.frame, item.x, item.y, item.autocontinue, *floats)
