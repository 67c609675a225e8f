"""All rules of a firmware on one mission."""

from __future__ import annotations

from collections.abc import Callable
from typing import TypeAlias

from gcs_windplan.mission.firmware import Firmware
from gcs_windplan.mission.lint.course import course
from gcs_windplan.mission.lint.feasibility import feasibility
from gcs_windplan.mission.lint.finding import EFFECTS, Findings, FirmwareFinding
from gcs_windplan.mission.lint.ignored_commands import ignored_commands
from gcs_windplan.mission.lint.jumps import jumps
from gcs_windplan.mission.lint.landing import landing
from gcs_windplan.mission.lint.parameters import parameters
from gcs_windplan.mission.lint.places import places
from gcs_windplan.mission.lint.upload import upload
from gcs_windplan.mission.mission_items import MissionItems

_Rules: TypeAlias = Callable[[MissionItems, Firmware], Findings]
_AT_UPLOAD: tuple[_Rules, ...] = (upload, jumps)
_AFTERWARDS: tuple[_Rules, ...] = (parameters, places, ignored_commands, course, feasibility, landing)
_NUMBERS = ("dropped", "rounded", "changed")
_MENDED = "frame-mission-needed"  # what is sent with the right frame, as `push` does, is kept


def lint(mission: MissionItems, firmware: Firmware) -> tuple[FirmwareFinding, ...]:
    """What a firmware does to a mission, in the order of its items, the whole mission first.

    Of a firmware for several kinds of vehicles only what all of them do. Of an item whose upload is refused nothing is
    said about numbers, as none is stored. The rules are those of the firmware with its default parameters.
    """
    found = _found(mission, firmware)
    if not firmware.variants:
        return found
    common = set.intersection(*({_key(one) for one in _found(mission, kind)} for kind in firmware.variants))
    return tuple(one for one in found if _key(one) in common)


def _found(mission: MissionItems, firmware: Firmware) -> tuple[FirmwareFinding, ...]:
    found = [finding for rules in _AT_UPLOAD for finding in rules(mission, firmware)]
    refused = {one.item for one in found if one.effect == "rejected" and one.rule != _MENDED} - {None}
    found += [finding for rules in _AFTERWARDS for finding in rules(mission, firmware)]
    kept = (finding for finding in found if finding.item not in refused or finding.effect not in _NUMBERS)
    return tuple(sorted(kept, key=lambda finding: (finding.item or 0, EFFECTS.index(finding.effect))))


def _key(finding: FirmwareFinding) -> tuple[str, str, int | None]:
    return finding.rule, finding.effect, finding.item
