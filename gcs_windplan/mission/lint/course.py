"""The way through a mission: where it begins, and what is unreachable."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from pymavlink.dialects.v20 import ardupilotmega as mavlink

from gcs_windplan.mission.commands import LANDINGS, TAKEOFFS, Command
from gcs_windplan.mission.firmware import Firmware
from gcs_windplan.mission.items import MissionItem
from gcs_windplan.mission.lint.finding import Findings, FirmwareFinding, any_of, named, numbered
from gcs_windplan.mission.lint.jumps import is_never_taken, repeats_forever, target_of
from gcs_windplan.mission.mission_items import MissionItems

_LOOKED_AT = 16  # AP_Mission.cpp, is_takeoff_next: items looked at for a take-off
_GROUND = frozenset((Command.NAV_DELAY, mavlink.MAV_CMD_NAV_SCRIPT_TIME, *TAKEOFFS))
_ENDS = LANDINGS | {Command.NAV_RETURN_TO_LAUNCH}
# items at which a mission is entered from elsewhere: by RTL, a failsafe, DO_JUMP_TAG or a switch
_ENTRIES = frozenset((Command.DO_LAND_START, Command.JUMP_TAG, mavlink.MAV_CMD_DO_RETURN_PATH_START))


def course(mission: MissionItems, firmware: Firmware) -> Findings:
    """Missions without anything to fly, without a take-off, and items that are unreachable."""
    if not any(item.command in firmware.navigation for item in mission.items):
        fact = f"{firmware.name} ends a mission at once that has no item to fly"
        number = f"{len(mission.items)} items" if mission.items else "no items"
        yield FirmwareFinding("no-navigation", "ignored", None, fact, number, "add a take-off and waypoints")
        return
    yield from _takeoff_missing(mission, firmware)
    yield from _unreached(mission, firmware)


def _takeoff_missing(mission: MissionItems, firmware: Firmware) -> Findings:
    flown = [item for item in mission.items if item.command in firmware.navigation][:_LOOKED_AT]
    first = next((item for item in flown if item.command != Command.NAV_DELAY), None)
    if firmware.takeoff == "optional" or (first is not None and first.command == Command.NAV_TAKEOFF):
        return
    begins = "no take-off" if first is None else f"it begins with {named(first)}"
    if firmware.takeoff == "required":
        fact = f"{firmware.name} on the ground flies no mission that does not begin with NAV_TAKEOFF"
        yield FirmwareFinding("takeoff-missing", "rejected", None, fact, begins, "begin with NAV_TAKEOFF")
    elif not any_of(mission.items, TAKEOFFS):
        fact = f"{firmware.name} on the ground first climbs to MIS_TAKEOFF_ALT where a mission has no take-off"
        yield FirmwareFinding("takeoff-missing", "changed", None, fact, begins, "begin with NAV_TAKEOFF")


def _unreached(mission: MissionItems, firmware: Firmware) -> Findings:
    way = _Way(mission.items, firmware)
    reached = way.reached()
    for number, item in numbered(mission):
        if number not in reached:
            end, why = way.end_before(number, reached)
            fact = f"on {firmware.name} items after {end} are unreachable: it is {why}"
            yield FirmwareFinding("unreachable", "ignored", number, fact, named(item), "remove it, or move it forward")


@dataclass(frozen=True, slots=True)
class _Way:
    """Which items follow on which; a state is an item's number and whether the vehicle stands on the ground."""

    items: tuple[MissionItem, ...]
    firmware: Firmware

    def reached(self) -> set[int]:
        """The numbers of all items that are come to, from the first or an entry."""
        entries = [number for number, item in enumerate(self.items, start=1) if item.command in _ENTRIES]
        waiting = [(number, False) for number in (1, *entries)]
        seen: set[tuple[int, bool]] = set()
        while waiting:
            state = waiting.pop()
            if state in seen or not self._is_begun(*state):
                continue
            seen.add(state)
            waiting += self._after(*state)
        return {number for number, _ in seen}

    def _is_begun(self, number: int, landed: bool) -> bool:
        if not 1 <= number <= len(self.items):
            return False
        command = self.items[number - 1].command
        return not landed or command not in self.firmware.navigation or command in _GROUND

    def _after(self, number: int, landed: bool) -> Iterator[tuple[int, bool]]:
        item = self.items[number - 1]
        if item.command == Command.DO_JUMP:
            if not is_never_taken(item):
                yield target_of(item), landed
            if not repeats_forever(item, self.firmware):
                yield number + 1, landed
        elif item.command in _ENDS:
            if self.firmware.lands_and_goes_on:
                yield number + 1, True
        elif item.command != Command.NAV_LOITER_UNLIM:
            yield number + 1, landed and item.command not in TAKEOFFS

    def end_before(self, number: int, reached: set[int]) -> tuple[int, str]:
        """The item at which the way to this one ends, and why."""
        last = max((other for other in reached if other < number), default=1)
        item = self.items[last - 1]
        if item.command == Command.NAV_LOITER_UNLIM:
            return last, "a NAV_LOITER_UNLIM, which has no end"
        if item.command == Command.DO_JUMP and repeats_forever(item, self.firmware):
            return last, "a DO_JUMP that is always taken"
        end = next((other for other in range(last, 0, -1) if self.items[other - 1].command in _ENDS), last)
        name = named(self.items[end - 1])
        return end, f"{name}, without a new take-off" if self.firmware.lands_and_goes_on else name
