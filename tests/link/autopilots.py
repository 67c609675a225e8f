"""Scripted autopilots with ArduPilot's and PX4's mission rules, and faults to be put in by a test.

Written from the tables of rules alone, apart from what the package knows of them, so that the two can disagree.
"""

from __future__ import annotations

import math
import struct
from collections.abc import Callable
from dataclasses import dataclass, field, replace
from typing import Any

from pymavlink.dialects.v20 import ardupilotmega as mavlink

from gcs_windplan.link.codec import Codec

from .simulation import World

MISSION, FENCE, RALLY = 0, 1, 2
ACCEPTED, ERROR, UNSUPPORTED_FRAME, UNSUPPORTED, NO_SPACE = range(5)
INVALID, INVALID_SEQUENCE, DENIED, CANCELLED = 5, 13, 14, 15
PARAMETER = {1: 6, 2: 7, 3: 8, 4: 9, 5: 10, 6: 11, 7: 12}
WAYPOINT, LOITER_TIME, RTL, LAND, TAKEOFF, DELAY, JUMP, SPEED = 16, 19, 20, 21, 22, 93, 177, 178
INCLUSION, EXCLUSION, CIRCLE_IN, CIRCLE_OUT, RALLY_POINT = 5001, 5002, 5003, 5004, 5100
PLACELESS = (RTL, DELAY, JUMP, SPEED)


@dataclass(frozen=True, slots=True)
class Stored:
    """An item as an autopilot keeps it, in MISSION_ITEM_INT's numbers."""

    command: int
    frame: int
    params: tuple[float, ...]
    x: int
    y: int
    z: float
    autocontinue: int = 1


class Refused(Exception):
    """An item that the autopilot does not take, with the code that it answers."""

    def __init__(self, code: int) -> None:
        self.code = code
        super().__init__(code)


def single(number: float) -> float:
    return float(struct.unpack("<f", struct.pack("<f", number))[0])


def stored_of(message: Any) -> Stored:
    params = (message.param1, message.param2, message.param3, message.param4)
    place = (message.x, message.y, message.z)
    return Stored(message.command, message.frame, params, *place, message.autocontinue)


@dataclass(slots=True)
class _Upload:
    partner: tuple[int, int]
    kind: int
    count: int
    seq: int = 0
    heard: float = 0.0
    asked: float = 0.0
    items: list[Stored] = field(default_factory=list)


class Autopilot:
    """What both kinds share: identity, heartbeats, the link, the book of what was held when.

    `ears` and `mouth` are the test's: each sees a message and gives what goes on in its place. `deaf` and `mute`
    drop the next messages of a type.
    """

    kind = mavlink.MAV_AUTOPILOT_GENERIC
    asks_again, gives_up = 1.0, 8.0
    capacity = 700

    def __init__(self, world: World, system: int = 1, component: int = 1, key: bytes | None = None) -> None:
        self.world = world
        self.codec = Codec(system, component, key)
        self.type = mavlink.MAV_TYPE_QUADROTOR
        self.status = mavlink.MAV_STATE_STANDBY
        self.booted = world.now - 50.0
        self.on = True
        self.held: dict[int, list[Stored]] = {MISSION: [], FENCE: [], RALLY: []}
        self.history: list[tuple[float, int, tuple[Stored, ...]]] = []
        self.upload: _Upload | None = None
        self.heard: list[Any] = []
        self.said: list[Any] = []
        self.ears: list[Callable[[Any], list[Any]]] = []
        self.mouth: list[Callable[[Any], list[Any]]] = []
        self.answers = {
            "MISSION_COUNT": self.on_count,
            "MISSION_ITEM_INT": self.on_item,
            "MISSION_REQUEST_LIST": self.on_list,
            "MISSION_REQUEST_INT": self.on_request,
            "MISSION_ACK": self.on_ack,
            "MISSION_CLEAR_ALL": self.on_clear,
        }
        world.nodes.append(self)
        world.every(world.beat, self.beat, first=0.3 * world.beat)
        world.every(0.05, self.look, first=0.01)

    # what a test does to it

    def deaf(self, kind: str, times: int = 1, **fields: Any) -> None:
        self.ears.append(_dropping(kind, times, fields))

    def mute(self, kind: str, times: int = 1, **fields: Any) -> None:
        self.mouth.append(_dropping(kind, times, fields))

    def reboot(self, off: float = 1.0) -> None:
        self.on = False
        self.upload = None
        self.world.at(self.world.now + off, self._boot)

    def _boot(self) -> None:
        self.on = True
        self.booted = self.world.now
        self.status = mavlink.MAV_STATE_BOOT
        self.world.at(self.world.now + 2.0, self._ready)

    def _ready(self) -> None:
        self.status = mavlink.MAV_STATE_STANDBY

    # what it does by itself

    def beat(self) -> None:
        self.send(mavlink.MAVLink_heartbeat_message(self.type, self.kind, 0, 0, self.status, 3))
        age = int((self.world.now - self.booted) * 1000)
        self.send(mavlink.MAVLink_system_time_message(0, age))

    def look(self) -> None:
        upload = self.upload
        if upload is None or not self.on:
            return
        if self.world.now - upload.heard > self.gives_up:
            self.give_up()
        elif self.world.now - upload.asked > self.asks_again:
            self.ask()

    def give_up(self) -> None:
        self.upload = None

    def send(self, message: Any) -> None:
        if not self.on:
            return
        messages = [message]
        for filtering in self.mouth:
            messages = [passed for each in messages for passed in filtering(each)]
        for each in messages:
            self.said.append(each)
            self.world.carry(self.codec.encode(each), self)

    def take(self, data: bytes) -> None:
        if not self.on:
            return
        for message in self.codec.decode(data):
            messages = [message]
            for filtering in self.ears:
                messages = [passed for each in messages for passed in filtering(each)]
            for each in messages:
                self.handle(each)

    def handle(self, message: Any) -> None:
        self.heard.append(message)
        answer = self.answers.get(message.get_type())
        target = (getattr(message, "target_system", 0), getattr(message, "target_component", 0))
        if answer is not None and target[0] == self.codec.system and target[1] in (0, self.codec.component):
            answer(message, (message.get_srcSystem(), message.get_srcComponent()))

    def heard_kinds(self, kind: str) -> list[Any]:
        return [message for message in self.heard if message.get_type() == kind]

    # the protocol, as far as it is common

    def ack(self, to: tuple[int, int], code: int, kind: int = MISSION) -> None:
        self.send(mavlink.MAVLink_mission_ack_message(*to, code, kind))

    def ask(self) -> None:
        assert self.upload is not None
        self.upload.asked = self.world.now
        self.send(self.request(*self.upload.partner, self.upload.seq, self.upload.kind))

    def request(self, *numbers: int) -> Any:
        return mavlink.MAVLink_mission_request_int_message(*numbers)

    def listed(self, kind: int) -> list[Stored]:
        return self.held[kind]

    def keep(self, kind: int, items: list[Stored]) -> None:
        self.held[kind] = items
        self.note(kind)

    def note(self, kind: int) -> None:
        self.history.append((self.world.now, kind, tuple(self.listed(kind))))

    def on_count(self, message: Any, sender: tuple[int, int]) -> None:
        raise NotImplementedError

    def on_item(self, message: Any, sender: tuple[int, int]) -> None:
        raise NotImplementedError

    def on_list(self, message: Any, sender: tuple[int, int]) -> None:
        raise NotImplementedError

    def on_request(self, message: Any, sender: tuple[int, int]) -> None:
        raise NotImplementedError

    def on_clear(self, message: Any, sender: tuple[int, int]) -> None:
        raise NotImplementedError

    def on_ack(self, message: Any, sender: tuple[int, int]) -> None:
        pass

    def item_message(self, to: tuple[int, int], seq: int, kind: int, frame_step: int = 0) -> Any:
        item = self.listed(kind)[seq]
        frame = {0: 5, 3: 6}.get(item.frame, item.frame) if frame_step else item.frame
        numbers = (*item.params, item.x, item.y, item.z)
        return mavlink.MAVLink_mission_item_int_message(
            *to, seq, frame, item.command, 0, item.autocontinue, *numbers, kind
        )


def _dropping(kind: str, times: int, fields: dict[str, Any]) -> Callable[[Any], list[Any]]:
    left = times

    def filtering(message: Any) -> list[Any]:
        nonlocal left
        fits = message.get_type() == kind and all(getattr(message, name) == value for name, value in fields.items())
        if fits and left > 0:
            left -= 1
            return []
        return [message]

    return filtering


class ArduPilot(Autopilot):
    """Not atomic, patient for eight seconds, home at item 0, centimetres, float MISSION_REQUEST."""

    kind = mavlink.MAV_AUTOPILOT_ARDUPILOTMEGA
    home = Stored(WAYPOINT, 0, (0.0, 0.0, 0.0, 0.0), 471234567, 85432109, 489.25)

    def request(self, *numbers: int) -> Any:
        return mavlink.MAVLink_mission_request_message(*numbers)

    def listed(self, kind: int) -> list[Stored]:
        items = self.held[kind]
        return [self.home, *items[1:]] if kind == MISSION and items else items

    def give_up(self) -> None:
        assert self.upload is not None
        partner, kind = self.upload.partner, self.upload.kind
        self.upload = None
        self.ack(partner, CANCELLED, kind)

    def on_count(self, message: Any, sender: tuple[int, int]) -> None:
        kind = message.mission_type
        if self.upload is not None and self.upload.partner != sender:
            return self.ack(sender, DENIED, kind)
        if message.count > self.capacity or self.world.now - self.booted < 2.0:
            return self.ack(sender, NO_SPACE, kind)
        if kind != FENCE:
            self.keep(kind, self.held[kind][: message.count])
        now = self.world.now
        self.upload = _Upload(sender, kind, message.count, heard=now)
        if message.count == 0:
            return self.complete()
        return self.ask()

    def on_item(self, message: Any, sender: tuple[int, int]) -> None:
        kind, upload = message.mission_type, self.upload
        assert message.current < 2, "the vehicle would have flown there at once"
        if upload is None or upload.kind != kind:
            return self.ack(sender, ERROR, kind)
        if message.seq != upload.seq:
            return self.ack(sender, INVALID_SEQUENCE, kind)
        if sender != upload.partner:
            return self.ack(sender, DENIED, kind)
        try:
            self.store(upload, self.kept(stored_of(message), kind, upload))
        except Refused as refused:
            self.upload = None
            return self.ack(sender, refused.code, kind)
        upload.heard = self.world.now
        upload.seq += 1
        return self.complete() if upload.seq == upload.count else self.ask()

    def store(self, upload: _Upload, item: Stored) -> None:
        place = upload.items if upload.kind == FENCE else self.held[upload.kind]
        if upload.seq > len(place):
            raise Refused(ERROR)
        place[upload.seq : upload.seq + 1] = [item]
        self.note(upload.kind)

    def complete(self) -> None:
        assert self.upload is not None
        upload, self.upload = self.upload, None
        if upload.kind == FENCE:
            self.keep(FENCE, upload.items)
        self.ack(upload.partner, ACCEPTED, upload.kind)

    def on_list(self, message: Any, sender: tuple[int, int]) -> None:
        kind = message.mission_type
        if self.upload is not None and self.upload.kind == kind:
            return self.ack(sender, DENIED, kind)
        return self.send(mavlink.MAVLink_mission_count_message(*sender, len(self.listed(kind)), kind))

    def on_request(self, message: Any, sender: tuple[int, int]) -> None:
        kind = message.mission_type
        if self.upload is not None and self.upload.kind == kind:
            return self.ack(sender, DENIED, kind)
        if message.seq >= len(self.listed(kind)):
            return self.ack(sender, INVALID_SEQUENCE, kind)
        return self.send(self.item_message(sender, message.seq, kind))

    def on_clear(self, message: Any, sender: tuple[int, int]) -> None:
        kind = message.mission_type
        if self.upload is not None and self.upload.kind == kind:
            return self.ack(sender, ERROR, kind)
        self.keep(kind, self.held[kind][:1] if kind == MISSION else [])
        return self.ack(sender, ACCEPTED, kind)

    @classmethod
    def kept(cls, item: Stored, kind: int, upload: _Upload | None = None) -> Stored:
        """What it keeps of an item; raises Refused."""
        if kind == FENCE:
            return cls._kept_fence(item)
        if kind == RALLY:
            if item.frame not in (3, 6):
                raise Refused(UNSUPPORTED_FRAME)
            return Stored(item.command, 3, (0.0,) * 4, item.x, item.y, float(int(item.z)))
        if item.command not in (WAYPOINT, LOITER_TIME, LAND, TAKEOFF, *PLACELESS):
            raise Refused(UNSUPPORTED)
        params = cls._kept_params(item, upload)
        if item.command in PLACELESS:
            return Stored(item.command, 0, params, 0, 0, 0.0)
        frame = {0: 0, 2: 0, 5: 0, 3: 3, 6: 3, 10: 10, 11: 10}.get(item.frame)
        if frame is None:
            raise Refused(UNSUPPORTED_FRAME)
        if math.isnan(item.z) or abs(item.z) >= 83000:
            raise Refused(PARAMETER[7])
        centimetres = int(single(single(item.z) * 100.0))
        return Stored(item.command, frame, params, item.x, item.y, single(centimetres / 100.0))

    @staticmethod
    def _kept_params(item: Stored, upload: _Upload | None) -> tuple[float, ...]:
        p1, p2, p3, p4 = item.params
        checked = {WAYPOINT: (1, 2, 3), TAKEOFF: (1, 2, 3), LAND: (1, 2, 3), LOITER_TIME: (1, 2, 3)}
        for number in checked.get(item.command, (1, 2, 3, 4)):
            if math.isnan(item.params[number - 1]):
                raise Refused(PARAMETER[number])
        if item.command == JUMP:
            if p1 == 0 or (upload is not None and p1 >= upload.count):
                raise Refused(ERROR)
            return (float(int(p1)), float(int(p2)), 0.0, 0.0)
        if item.command == SPEED:
            return (float(int(p1)), single(p2), single(p3), 0.0)
        if item.command == DELAY:
            return (single(p1), float(int(p2)), float(int(p3)), float(int(p4)))
        if item.command == LOITER_TIME:
            return (float(int(p1)), 0.0, -1.0 if p3 < 0 else 1.0, float(p4 > 0))
        if item.command == LAND:
            return (float(int(p1) & 0xFFFF), 0.0, 0.0, -1.0 if p4 < 0 else 1.0)
        return (0.0,) * 4 if item.command == RTL else (float(int(p1) & 0xFFFF), 0.0, 0.0, 0.0)

    @staticmethod
    def _kept_fence(item: Stored) -> Stored:
        if item.frame not in (0, 3, 5, 6, 10, 11):
            raise Refused(UNSUPPORTED_FRAME)
        if item.command not in (INCLUSION, EXCLUSION, CIRCLE_IN, CIRCLE_OUT):
            raise Refused(UNSUPPORTED)
        return Stored(item.command, 0, (single(item.params[0]), 0.0, 0.0, 0.0), item.x, item.y, 0.0)


class PX4(Autopilot):
    """Double-buffered, asks every 250 ms, forgets after five seconds, floats of 32 bits, one transfer for all types."""

    kind = mavlink.MAV_AUTOPILOT_PX4
    asks_again, gives_up = 0.25, 5.0

    def __init__(self, *arguments: Any, **options: Any) -> None:
        super().__init__(*arguments, **options)
        self.reader: tuple[int, int] | None = None
        self.reading = MISSION
        self.read_seq = 0
        self.read_heard = 0.0
        self.last_partner: tuple[int, int] | None = None
        self.last_count = 0
        self.last_kind = MISSION

    def look(self) -> None:
        super().look()
        if self.reader is not None and self.world.now - self.read_heard > self.gives_up:
            self.reader = None

    def reboot(self, off: float = 1.0) -> None:
        super().reboot(off)
        self.reader = self.last_partner = None

    def on_count(self, message: Any, sender: tuple[int, int]) -> None:
        kind, now = message.mission_type, self.world.now
        if self.reader is not None:
            return self.ack(sender, ERROR, kind)
        if self.upload is not None:
            self.upload.heard = now
            if sender != self.upload.partner or self.upload.seq > 0:
                return self.ack(sender, ERROR, kind)
            return self.ask()
        if message.count > self.capacity:
            return self.ack(sender, NO_SPACE, kind)
        self.last_partner, self.last_kind, self.last_count = sender, kind, 0
        if message.count == 0:
            self.keep(kind, [])
            return self.ack(sender, ACCEPTED, kind)
        self.upload = _Upload(sender, kind, message.count, heard=now)
        return self.ask()

    def on_item(self, message: Any, sender: tuple[int, int]) -> None:
        kind, upload = message.mission_type, self.upload
        if sender != self.last_partner:
            return None
        if kind != self.last_kind or self.reader is not None:
            return self.ack(sender, ERROR, kind)
        if upload is None:
            return self.ack(sender, ACCEPTED if message.seq == self.last_count - 1 else ERROR, kind)
        upload.heard = self.world.now
        if message.seq != upload.seq:
            return None
        try:
            upload.items.append(self.kept(stored_of(message), kind, upload))
        except Refused as refused:
            self.upload = None
            return self.ack(sender, refused.code, kind)
        upload.seq += 1
        self.last_count = upload.seq
        if upload.seq < upload.count:
            return self.ask()
        self.upload = None
        self.keep(kind, upload.items)
        return self.ack(sender, ACCEPTED, kind)

    def on_list(self, message: Any, sender: tuple[int, int]) -> None:
        kind = message.mission_type
        done = self.reader is not None and self.read_seq == len(self.held[self.reading])
        idle = self.upload is None and (self.reader is None or done)
        if not idle and not (self.reader == sender and self.reading == kind):
            return None
        self.reader, self.reading, self.read_seq, self.read_heard = sender, kind, 0, self.world.now
        self.last_partner, self.last_kind = sender, kind
        return self.send(mavlink.MAVLink_mission_count_message(*sender, len(self.held[kind]), kind))

    def on_request(self, message: Any, sender: tuple[int, int]) -> None:
        kind, seq = message.mission_type, message.seq
        if self.reader != sender or kind != self.reading:
            return None
        self.read_heard = self.world.now
        if seq == self.read_seq and seq < len(self.held[kind]):
            self.read_seq += 1
        elif seq != self.read_seq - 1:
            self.reader = None
            return self.ack(sender, ERROR, kind)
        return self.send(self.item_message(sender, seq, kind, frame_step=1))

    def on_ack(self, message: Any, sender: tuple[int, int]) -> None:
        if self.reader == sender and message.mission_type == self.reading:
            self.reader = None
        if self.upload is not None and self.upload.partner == sender and message.type == CANCELLED:
            self.upload = None

    def on_clear(self, message: Any, sender: tuple[int, int]) -> None:
        if self.upload is None and self.reader is None:
            self.keep(message.mission_type, [])
            self.ack(sender, ACCEPTED, message.mission_type)

    @classmethod
    def kept(cls, item: Stored, kind: int, upload: _Upload | None = None) -> Stored:
        """What it keeps of an item; raises Refused."""
        single_params = tuple(single(param) for param in item.params)
        known = {MISSION: (WAYPOINT, LOITER_TIME, LAND, TAKEOFF), RALLY: (RALLY_POINT,)}
        known[FENCE] = (INCLUSION, EXCLUSION, CIRCLE_IN, CIRCLE_OUT)
        if item.frame == 2 and item.command in PLACELESS:
            return replace(item, params=single_params, z=single(item.z))
        if item.frame not in (0, 3, 5, 6):
            raise Refused(UNSUPPORTED_FRAME)
        if item.command not in known[kind]:
            raise Refused(UNSUPPORTED)
        frame = {5: 0, 6: 3}.get(item.frame, item.frame)
        if kind != MISSION:
            first = single_params[0] if kind == FENCE else 0.0
            return replace(item, frame=frame, params=(first, 0.0, 0.0, 0.0), z=single(item.z))
        return replace(item, frame=frame, params=cls._kept_params(item.command, single_params), z=single(item.z))

    @staticmethod
    def _kept_params(command: int, params: tuple[float, ...]) -> tuple[float, ...]:
        p1, p2, p3, p4 = params
        yaw = p4 if math.isnan(p4) else single(math.degrees(single(math.radians(p4) % math.tau)))
        if command == WAYPOINT:
            return (p1, p2, 0.0, yaw)
        if command == LOITER_TIME:
            return (p1, float(p2 > 0), p3, yaw)
        return (0.0, float(int(p2)) if command == LAND else 0.0, 0.0, yaw)


class OtherStation:
    """A second ground station that uploads a mission of its own, once."""

    def __init__(self, world: World, items: list[Stored], ident: tuple[int, int] = (254, 190)) -> None:
        self.world = world
        self.items = items
        self.codec = Codec(*ident)
        self.acks: list[int] = []
        world.nodes.append(self)

    def start(self) -> None:
        self.world.carry(self.codec.encode(mavlink.MAVLink_mission_count_message(1, 1, len(self.items), 0)), self)

    def take(self, data: bytes) -> None:
        for message in self.codec.decode(data):
            own = (self.codec.system, self.codec.component)
            if (getattr(message, "target_system", 0), getattr(message, "target_component", 0)) != own:
                continue
            if message.get_type() in ("MISSION_REQUEST", "MISSION_REQUEST_INT") and message.seq < len(self.items):
                item = self.items[message.seq]
                numbers = (*item.params, item.x, item.y, item.z)
                answer = mavlink.MAVLink_mission_item_int_message(
                    1, 1, message.seq, item.frame, item.command, 0, item.autocontinue, *numbers, 0
                )
                self.world.carry(self.codec.encode(answer), self)
            elif message.get_type() == "MISSION_ACK":
                self.acks.append(message.type)
