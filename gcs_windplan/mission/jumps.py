"""A mission's items in the order flown: as the firmware keeps them, its jumps made as often as they say."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace

from gcs_windplan.errors import InputError
from gcs_windplan.mission.commands import Command, Frame
from gcs_windplan.mission.items import MissionItem, MissionItems

_MOST_ITEMS = 20_000  # flown in one mission, its jumps unrolled
_MOST_JUMPS = 255  # AP_Mission.cpp, advance_current_nav_cmd: more in a row lead nowhere
_FOR_EVER = -1
_AS_WRITTEN = "fhl"  # letters of `mission.kept` that change too little to matter, or a yaw only
_SIGN_ONLY = "s"  # of a radius that the firmware does not keep: its own counts, as for 0


def kept_items(mission: MissionItems) -> tuple[MissionItem, ...]:
    """The items with the numbers that the mission's firmware keeps of their four parameters.

    A hold of -5 s becomes 65531 s on ArduPilot. As written where the mission names no autopilot.
    """
    if mission.autopilot is None:
        return mission.items
    return tuple(_kept(item, mission) for item in mission.items)


def _kept(item: MissionItem, mission: MissionItems) -> MissionItem:
    from gcs_windplan.mission.kept import parameter_letters  # here: these bring all of MAVLink with them
    from gcs_windplan.mission.lint.parameters import held_value

    if mission.autopilot == "px4" and item.frame == Frame.MISSION and item.command != Command.DO_JUMP:
        return item  # PX4 keeps all numbers of an item without a place
    letters = parameter_letters(item.command, mission.autopilot, mission.vehicle_type)
    params = list(item.params)
    for i, letter in enumerate(letters[: len(params)]):
        if letter in _SIGN_ONLY:
            params[i] = 0.0
        elif letter not in _AS_WRITTEN:
            held = held_value(letter, params[i])
            params[i] = params[i] if held is None else held
    return replace(item, params=(params[0], params[1], params[2], params[3]))


def unrolled(
    items: Sequence[MissionItem], remark: Callable[[str], None], endless: Callable[[int, int], None]
) -> Iterator[tuple[int, MissionItem]]:
    """The items as they come, each with its number from 1 on.

    They end at a jump back for ever, of which `endless` is told its number and where it leads. Raises `InputError` for
    more than 20 000.
    """
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
                endless(index + 1, target + 1)
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
