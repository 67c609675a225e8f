"""One thing that a firmware does to a mission, and the firmware that does it."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Literal, TypeAlias

from gcs_windplan.mission.commands import Command, command_name
from gcs_windplan.mission.items import MissionItem, MissionItems
from gcs_windplan.vehicle import Autopilot, VehicleType

Effect: TypeAlias = Literal["rejected", "dropped", "rounded", "changed", "ignored", "warned"]
"""Rejected: the upload is refused, or the mission is taken and not flown. Dropped, rounded, changed: a number or its
meaning. Ignored: an item that is held and never carried out. Warned: flown, with a warning by the vehicle."""

EFFECTS: tuple[Effect, ...] = ("rejected", "dropped", "rounded", "changed", "ignored", "warned")

#: Rules whose numbers change by less than a centimetre, which no vehicle flies: to be told, and nothing to mend.
FINER_THAN_FLOWN = frozenset(("altitude-rounded", "place-rounded"))

_NAMES: dict[tuple[Autopilot, VehicleType | None], str] = {
    ("ardupilot", "multicopter"): "ArduCopter",
    ("ardupilot", "fixed-wing"): "ArduPlane",
    ("ardupilot", None): "ArduPilot",
}


@dataclass(frozen=True, slots=True)
class Firmware:
    """An autopilot and what it flies, None where that is not known."""

    autopilot: Autopilot
    vehicle_type: VehicleType | None = None

    @property
    def name(self) -> str:
        """How the firmware is called in a sentence: ArduCopter, ArduPlane, ArduPilot or PX4."""
        return _NAMES.get((self.autopilot, self.vehicle_type), "PX4")

    @property
    def full_name(self) -> str:
        """The name with the kind of vehicle."""
        if self.autopilot == "ardupilot":
            return self.name
        return "PX4" if self.vehicle_type is None else f"PX4 {self.vehicle_type.replace('-', ' ')}"


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
        told = f"{self.fact}: {self.number}" if self.number else self.fact
        return f"{told}; {self.advice}" if self.advice else told


Findings: TypeAlias = Iterator[FirmwareFinding]


def numbered(mission: MissionItems) -> Iterator[tuple[int, MissionItem]]:
    """The items with their numbers."""
    return enumerate(mission.items, start=1)


def is_navigation(command: int) -> bool:
    """Whether the vehicle flies an item of this command rather than doing something on its way.

    AP_Mission.cpp, is_nav_cmd: numbers up to MAV_CMD_NAV_LAST and three more.
    """
    return 0 < command <= _NAV_LAST or command in _MORE_NAVIGATION


def any_of(items: Sequence[MissionItem], commands: frozenset[int]) -> bool:
    """Whether one of the commands is among the items."""
    return any(item.command in commands for item in items)


def named(item: MissionItem) -> str:
    """The item's command by name."""
    return command_name(item.command)


_NAV_LAST = 95  # MAVLink common.xml, MAV_CMD_NAV_LAST
_MORE_NAVIGATION = frozenset((213, 42702, 42703))  # NAV_SET_YAW_SPEED, NAV_SCRIPT_TIME, NAV_ATTITUDE_TIME

TAKEOFFS = frozenset((Command.NAV_TAKEOFF, Command.NAV_VTOL_TAKEOFF))
LANDINGS = frozenset((Command.NAV_LAND, Command.NAV_VTOL_LAND))
