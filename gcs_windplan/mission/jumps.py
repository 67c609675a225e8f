"""A mission's items in the order flown: as the firmware stores them, its jumps made as often as they say."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace

from gcs_windplan.errors import InputError
from gcs_windplan.mission.commands import Command
from gcs_windplan.mission.firmware import Firmware, Jumps, known_firmware
from gcs_windplan.mission.items import MissionItem
from gcs_windplan.mission.mission_items import MissionItems

_MOST_ITEMS = 20_000  # flown in one mission, its jumps unrolled


def stored_items(mission: MissionItems) -> tuple[MissionItem, ...]:
    """The items with the numbers that the mission's firmware flies them by.

    A hold of -5 s becomes 65531 s on ArduPilot. As written where the mission names no autopilot.
    """
    firmware = known_firmware(mission.autopilot, mission.vehicle_type)
    return mission.items if firmware is None else tuple(_stored(item, firmware) for item in mission.items)


def _stored(item: MissionItem, firmware: Firmware) -> MissionItem:
    rule = firmware.rule(item.command, item.frame) or firmware.rule(item.command)
    if rule is None:
        return item
    p1, p2, p3, p4 = (way.flown(param) for way, param in zip(rule.params, item.params, strict=False))
    return replace(item, params=(p1, p2, p3, p4))


def unrolled(
    items: Sequence[MissionItem], counts: Jumps, remark: Callable[[str], None], endless: Callable[[int, int], None]
) -> Iterator[tuple[int, MissionItem]]:
    """The items as they come, each with its number from 1 on.

    They end at an endless jump back, of which `endless` gets its number and where it leads. Raises `InputError` for
    more than 20 000.
    """
    made: dict[int, int] = {}
    index, given, jumps = 0, 0, 0
    while index < len(items) and jumps <= counts.in_a_row:
        item = items[index]
        if item.command in (Command.DO_JUMP, Command.DO_JUMP_TAG):
            target, repeats = _target(items, item), item.params[1]
            if repeats == counts.forever and target is not None:
                if target > index:  # past some items, always
                    index, jumps = target, jumps + 1
                    continue
                remark(f"item {index + 1} jumps back indefinitely; the time counts up to its first jump")
                endless(index + 1, target + 1)
                return
            if target is None:
                remark(f"item {index + 1} jumps to nowhere and is ignored")
            elif made.get(index, 0) < repeats:
                made[index] = made.get(index, 0) + 1
                index, jumps = target, jumps + 1
                continue
        else:
            jumps, given = 0, given + 1
            if given > _MOST_ITEMS:
                raise InputError(_too_many(items, made))
            yield index + 1, item
        index += 1


def _too_many(items: Sequence[MissionItem], made: dict[int, int]) -> str:
    """What is said of jumps that lead through too many items; the one made most often is named."""
    most = max(made, key=lambda index: made[index], default=None)
    if most is None:
        return f"more than {_MOST_ITEMS} items are flown: split the mission"
    times = items[most].params[1]
    return (
        f"item {most + 1} jumps {times:g} times, and that leads through more than {_MOST_ITEMS} items: repeat it less"
    )


def _target(items: Sequence[MissionItem], jump: MissionItem) -> int | None:
    """Where a jump leads, None where there is no such item."""
    if jump.command == Command.DO_JUMP:
        return next((i for i in range(len(items)) if i + 1 == jump.params[0]), None)
    tags = (i for i, item in enumerate(items) if item.command == Command.JUMP_TAG and item.params[0] == jump.params[0])
    return next(tags, None)
