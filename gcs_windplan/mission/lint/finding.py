"""One thing that a firmware does to a mission."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Literal, TypeAlias

from gcs_windplan.mission.commands import command_name
from gcs_windplan.mission.items import MissionItem
from gcs_windplan.mission.mission_items import MissionItems

Effect: TypeAlias = Literal["rejected", "dropped", "rounded", "changed", "ignored", "warned"]
"""Rejected: the upload is refused, or the mission is taken and not flown. Dropped, rounded, changed: a number or its
meaning. Ignored: an item that is held and never carried out. Warned: flown, with a warning by the vehicle."""

EFFECTS: tuple[Effect, ...] = ("rejected", "dropped", "rounded", "changed", "ignored", "warned")

#: Rules whose numbers change by less than a centimetre, which no vehicle flies: to be told, and nothing to mend.
FINER_THAN_FLOWN = frozenset(("altitude-rounded", "place-rounded"))


@dataclass(frozen=True, slots=True)
class FirmwareFinding:
    """What a firmware does to one item, or to the whole mission (`item` None).

    `rule` is a slug that stays the same from release to release. `item` counts from 1, home being 0. `fact` is the
    rule and the same for all items that it strikes alike, `number` what it strikes here, `advice` what to do.
    """

    rule: str
    effect: Effect
    item: int | None
    fact: str
    number: str = ""
    advice: str = ""

    @property
    def message(self) -> str:
        """All of it in one sentence."""
        sentence = f"{self.fact}: {self.number}" if self.number else self.fact
        return f"{sentence}; {self.advice}" if self.advice else sentence


Findings: TypeAlias = Iterator[FirmwareFinding]


def numbered(mission: MissionItems) -> Iterator[tuple[int, MissionItem]]:
    """The items with their numbers."""
    return enumerate(mission.items, start=1)


def any_of(items: Sequence[MissionItem], commands: frozenset[int]) -> bool:
    """Whether one of the commands is among the items."""
    return any(item.command in commands for item in items)


def named(item: MissionItem) -> str:
    """The item's command by name."""
    return command_name(item.command)
