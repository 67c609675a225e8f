"""Parameters that a firmware does not store as they are sent."""

from __future__ import annotations

import math

from gcs_windplan.mission.commands import Command, takes_place
from gcs_windplan.mission.firmware import Firmware, Storage
from gcs_windplan.mission.firmware.floats import float_text
from gcs_windplan.mission.firmware.storage import NONE, UNREAD
from gcs_windplan.mission.items import MissionItem
from gcs_windplan.mission.lint.finding import Effect, Findings, FirmwareFinding, named, numbered
from gcs_windplan.mission.lint.meaning import meaning
from gcs_windplan.mission.mission_items import MissionItems


def parameters(mission: MissionItems, firmware: Firmware) -> Findings:
    """Parameters that are dropped, rounded or changed, and `autocontinue`."""
    for number, item in numbered(mission):
        for position, storage, sent in _parts(item, firmware):
            yield from _parameter(number, item, position, storage, sent, firmware.name)
        if not firmware.stores_autocontinue and not item.autocontinue:
            fact = f"{firmware.name} goes on by itself and drops the order to wait (autocontinue 0)"
            advice = "use NAV_LOITER_UNLIM to wait"
            yield FirmwareFinding("autocontinue-dropped", "dropped", number, fact, "", advice)


def _parts(item: MissionItem, firmware: Firmware) -> list[tuple[int, Storage, float]]:
    """Number, storage and value of the parameters that are set and no place, without a jump's endless count."""
    rule = firmware.rule(item.command, item.frame) or firmware.rule(item.command)
    if rule is None:
        return []
    values: tuple[float, ...] = item.params
    if not takes_place(item.command):
        values = (*item.params, item.latitude_deg, item.longitude_deg, *(() if rule.place else (item.altitude,)))
    parts = enumerate(zip(rule.params, values, strict=False), start=1)
    parts_set = [(i, way, sent) for i, (way, sent) in parts if sent != 0 and not math.isnan(sent)]
    return [part for part in parts_set if not _is_endless(item, part, firmware)]


def _is_endless(item: MissionItem, part: tuple[int, Storage, float], firmware: Firmware) -> bool:
    """Whether a number is a jump's count below 0 where there is no such count; `jumps` looks at that."""
    return item.command == Command.DO_JUMP and firmware.jumps.forever is None and part[0] == 2 and part[2] < 0


def _parameter(number: int, item: MissionItem, position: int, storage: Storage, sent: float, firmware: str) -> Findings:
    held = storage.held(sent)
    if storage == UNREAD or storage.retention(sent, held) == "same":
        return
    name = f"parameter {position} of {named(item)}{meaning(item.command, position)}"
    if storage == NONE:
        fact, advice = f"{firmware} drops {name}", _advice(item, position)
        yield FirmwareFinding("parameter-dropped", "dropped", number, fact, float_text(sent), advice)
        return
    change = f"{float_text(sent)} becomes {float_text(held)}"
    kind: Effect = "rounded" if storage.rounds(sent, held) else "changed"
    advice = "" if kind == "rounded" else "mind the range"
    yield FirmwareFinding(f"parameter-{kind}", kind, number, f"{firmware} keeps {name} {storage.words}", change, advice)


def _advice(item: MissionItem, position: int) -> str:
    if item.command == Command.NAV_WAYPOINT and position == 4:
        return "a CONDITION_YAW behind the waypoint turns a copter"
    return "write 0, or do not count on it"
