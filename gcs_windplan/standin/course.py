"""The way through a mission: which item comes next, jumps and their counts, and what is done in between."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field

from pymavlink.dialects.v20 import ardupilotmega as mavlink

from gcs_windplan.mission import Command
from gcs_windplan.standin.items import StoredItem

_MOST_JUMPS = 255  # AP_Mission.cpp, advance_current_nav_cmd: more in a row lead nowhere
_FOR_EVER = -1


@dataclass(frozen=True, slots=True)
class Step:
    """The next item that is flown, None behind the last, and the items that are done as it begins."""

    seq: int | None
    before: tuple[int, ...] = ()


@dataclass(slots=True)
class Course:
    """Counts the jumps already made, by the number of their item."""

    jumps: dict[int, int] = field(default_factory=dict)

    def step(self, items: Sequence[StoredItem], start: int) -> Step:
        """The step from item `start` on; jumps on the way are made and counted."""
        before: list[int] = []
        seq, jumps = start, 0
        while 0 <= seq < len(items) and jumps <= _MOST_JUMPS:
            item = items[seq]
            target = self._jump(items, seq)
            if target is not None:
                seq, jumps = target, jumps + 1
                continue
            if is_flown(item):
                return Step(seq, tuple(before))
            if item.command not in (Command.DO_JUMP, Command.DO_JUMP_TAG, Command.JUMP_TAG):
                before.append(seq)
            seq += 1
        return Step(None, tuple(before))

    def ahead(self, items: Sequence[StoredItem], start: int) -> Iterator[Step]:
        """The steps to come from item `start` on, without making them."""
        foreseen = Course(dict(self.jumps))
        step = foreseen.step(items, start)
        while step.seq is not None:
            yield step
            step = foreseen.step(items, step.seq + 1)

    def _jump(self, items: Sequence[StoredItem], seq: int) -> int | None:
        """Where the jump at an item leads, and counts it; None where there is none or it is used up."""
        item = items[seq]
        if item.command == Command.DO_JUMP:
            target: int | None = int(item.params[0])
        elif item.command == Command.DO_JUMP_TAG:
            target = _tagged(items, item.params[0])
        else:
            return None
        made, repeats = self.jumps.get(seq, 0), int(item.params[1])
        if target is None or not 0 <= target < len(items) or (repeats != _FOR_EVER and made >= repeats):
            return None
        self.jumps[seq] = made + 1
        return target


def is_flown(item: StoredItem) -> bool:
    """Whether the item takes its time, as AP_Mission::is_nav_cmd has it; others are done on the way."""
    return bool(item.command <= mavlink.MAV_CMD_NAV_LAST or item.command == mavlink.MAV_CMD_NAV_SET_YAW_SPEED)


def _tagged(items: Sequence[StoredItem], tag: float) -> int | None:
    for seq, item in enumerate(items):
        if item.command == Command.JUMP_TAG and item.params[0] == tag:
            return seq
    return None
