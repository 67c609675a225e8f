"""Messages as a vehicle hears them: encoded and decoded by the codec, with the sender's numbers."""

from __future__ import annotations

from typing import Any

from pymavlink.dialects.v20 import ardupilotmega as mavlink

from gcs_windplan.link.codec import Codec
from gcs_windplan.standin.items import StoredItem
from gcs_windplan.standin.rules import MissionServer

MISSION, FENCE, RALLY, ALL = 0, 1, 2, 255
WAYPOINT, LOITER_TIME, RTL, LAND, TAKEOFF, DELAY, JUMP, SPEED = 16, 19, 20, 21, 22, 93, 177, 178
INCLUSION, EXCLUSION, CIRCLE_IN, CIRCLE_OUT, RALLY_POINT = 5001, 5002, 5003, 5004, 5100
US, OTHERS = (255, 190), (254, 190)
LATITUDE, LONGITUDE = 365_000_000, -843_000_000


def said(message: Any, by: tuple[int, int] = US) -> Any:
    """The message as it arrives from a ground station."""
    (heard,) = Codec(1, 1).decode(Codec(*by).encode(message))
    return heard


def count(n: int, kind: int = MISSION, by: tuple[int, int] = US, to: tuple[int, int] = (1, 1)) -> Any:
    return said(mavlink.MAVLink_mission_count_message(*to, n, kind), by)


def item(
    seq: int,
    command: int = WAYPOINT,
    params: tuple[float, ...] = (0, 0, 0, 0),
    *,
    frame: int = 3,
    x: int = LATITUDE,
    y: int = LONGITUDE,
    z: float = 50.0,
    kind: int = MISSION,
    by: tuple[int, int] = US,
    current: int = 0,
) -> Any:
    return said(
        mavlink.MAVLink_mission_item_int_message(1, 1, seq, frame, command, current, 1, *params, x, y, z, kind), by
    )


def request(seq: int, kind: int = MISSION, by: tuple[int, int] = US, as_int: bool = True) -> Any:
    make = mavlink.MAVLink_mission_request_int_message if as_int else mavlink.MAVLink_mission_request_message
    return said(make(1, 1, seq, kind), by)


def request_list(kind: int = MISSION, by: tuple[int, int] = US) -> Any:
    return said(mavlink.MAVLink_mission_request_list_message(1, 1, kind), by)


def clear(kind: int = MISSION, by: tuple[int, int] = US) -> Any:
    return said(mavlink.MAVLink_mission_clear_all_message(1, 1, kind), by)


def ack(code: int, kind: int = MISSION, by: tuple[int, int] = US) -> Any:
    return said(mavlink.MAVLink_mission_ack_message(1, 1, code, kind), by)


def set_current(seq: int) -> Any:
    return said(mavlink.MAVLink_mission_set_current_message(1, 1, seq))


def told(messages: list[Any]) -> list[tuple[Any, ...]]:
    """What a vehicle said, short: (ACK, code), (REQUEST, seq), (REQUEST_INT, seq), (COUNT, n); texts are left out."""
    short = []
    for message in messages:
        kind = message.get_type().removeprefix("MISSION_")
        if kind == "ACK":
            short.append((kind, message.type))
        elif kind in ("REQUEST", "REQUEST_INT", "ITEM", "ITEM_INT", "CURRENT"):
            short.append((kind, message.seq))
        elif kind == "COUNT":
            short.append((kind, message.count))
    return short


def texts(messages: list[Any]) -> list[str]:
    return [message.text.rstrip("\0") for message in messages if message.get_type() == "STATUSTEXT"]


def upload(server: MissionServer, items: list[Any], now: float, kind: int = MISSION) -> list[tuple[Any, ...]]:
    """Upload items (made by `item`, in their order); what the last answer was."""
    answer = told(server.handle(count(len(items), kind), now))
    for message in items:
        assert answer[-1][0].startswith("REQUEST"), answer
        assert answer[-1][1] == message.seq
        answer = told(server.handle(message, now))
    return answer


def download(server: MissionServer, now: float, kind: int = MISSION, as_int: bool = True) -> list[Any]:
    """Download what a vehicle holds, as messages."""
    ((_, n),) = told(server.handle(request_list(kind), now))
    items = []
    for seq in range(n):
        (message,) = server.handle(request(seq, kind, as_int=as_int), now)
        assert message.seq == seq
        items.append(message)
    server.handle(ack(0, kind), now)
    return items


def numbers(message: Any) -> StoredItem:
    """A message's item without its number."""
    params = (message.param1, message.param2, message.param3, message.param4)
    return StoredItem(message.frame, message.command, params, message.x, message.y, message.z)
