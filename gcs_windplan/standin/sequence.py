"""The way through a mission: which item comes next, jumps and their counts, and what is done in between."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field

from gcs_windplan.mission import Command
from gcs_windplan.mission.firmware import Firmware
from gcs_windplan.standin.items import StoredItem


@dataclass(frozen=True, slots=True)
class Step:
    """The next item that is flown, None behind the last, and the items that are done as it begins."""

    seq: int | None
    before: tuple[int, ...] = ()


@dataclass(slots=True)
class ItemSequence:
    """Counts the jumps already made, by the number of their item."""

    firmware: Firmware
    jumps: dict[int, int] = field(default_factory=dict)

    def step(self, items: Sequence[StoredItem], start: int) -> Step:
        """The step from item `start` on; jumps on the way are made and counted."""
        before: list[int] = []
        seq, jumps = start, 0
        while 0 <= seq < len(items) and jumps <= self.firmware.jumps.in_a_row:
            item = items[seq]
            target = self._jump(items, seq)
            if target is not None:
                seq, jumps = target, jumps + 1
                continue
            if item.command in self.firmware.navigation:
                return Step(seq, tuple(before))
            if item.command not in (Command.DO_JUMP, Command.DO_JUMP_TAG, Command.JUMP_TAG):
                before.append(seq)
            seq += 1
        return Step(None, tuple(before))

    def ahead(self, items: Sequence[StoredItem], start: int) -> Iterator[Step]:
        """The steps to come from item `start` on, without making them."""
        foreseen = ItemSequence(self.firmware, dict(self.jumps))
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
        if (
            target is None
            or not 0 <= target < len(items)
            or (repeats != self.firmware.jumps.forever and made >= repeats)
        ):
            return None
        self.jumps[seq] = made + 1
        return target


def _tagged(items: Sequence[StoredItem], tag: float) -> int | None:
    for seq, item in enumerate(items):
        if item.command == Command.JUMP_TAG and item.params[0] == tag:
            return seq
    return None
