"""A mission's items in the order flown: its jumps made as often as they say."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence

from gcs_windplan.errors import InputError
from gcs_windplan.mission.commands import Command
from gcs_windplan.mission.items import MissionItem

_MOST_ITEMS = 20_000  # flown in one mission, its jumps unrolled
_MOST_JUMPS = 255  # AP_Mission.cpp, advance_current_nav_cmd: more in a row lead nowhere
_FOR_EVER = -1


def unrolled(items: Sequence[MissionItem], remark: Callable[[str], None]) -> Iterator[tuple[int, MissionItem]]:
    """The items as they come, each with its number from 1 on; raises `InputError` for more than 20 000."""
    made: dict[int, int] = {}
    index, given, jumps = 0, 0, 0
    while index < len(items) and jumps <= _MOST_JUMPS:
        item = items[index]
        if item.command in (Command.DO_JUMP, Command.DO_JUMP_TAG):
            target, repeats = _target(items, item), item.params[1]
            if repeats == _FOR_EVER and target is not None:
                if target > index:  # past some items, always
                    index, jumps = target, jumps + 1
                    continue
                remark(f"item {index + 1} jumps for ever; the time counts up to its first jump")
                return
            if target is None:
                remark(f"item {index + 1} jumps to nowhere and is passed over")
            elif made.get(index, 0) < repeats:
                made[index] = made.get(index, 0) + 1
                index, jumps = target, jumps + 1
                continue
        else:
            jumps, given = 0, given + 1
            if given > _MOST_ITEMS:
                raise InputError(f"the mission's jumps lead through more than {_MOST_ITEMS} items: repeat them less")
            yield index + 1, item
        index += 1


def _target(items: Sequence[MissionItem], jump: MissionItem) -> int | None:
    """Where a jump leads, None where there is no such item."""
    if jump.command == Command.DO_JUMP:
        return next((i for i in range(len(items)) if i + 1 == jump.params[0]), None)
    tags = (i for i, item in enumerate(items) if item.command == Command.JUMP_TAG and item.params[0] == jump.params[0])
    return next(tags, None)
