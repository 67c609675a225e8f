"""Whether two missions are the same, as far as a firmware keeps them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

from gcs_windplan.formats import ReadMission
from gcs_windplan.jobs.items import ItemsWords, file_of, is_mission_file, items_of
from gcs_windplan.link.comparison import Comparison, Difference, compare_either_way
from gcs_windplan.link.wire import MissionType
from gcs_windplan.mission import MissionItem, MissionItems, fence_items, rally_items
from gcs_windplan.vehicle import Autopilot, VehicleType


@dataclass(frozen=True, slots=True)
class MissionDiff:
    """What differs between two missions: a comparison each of `mission`, `fence` and `rally`, as far as both have them.

    `autopilot` is the one whose rules counted, None where every number did. `notes` say what was repaired of the files
    and what was not compared.

    >>> import gcs_windplan as gw
    >>> gw.diff(gw.MissionItems(()), gw.MissionItems(())).same
    True
    """

    parts: dict[MissionType, Comparison]
    autopilot: Autopilot | None
    notes: tuple[str, ...] = ()

    @property
    def same(self) -> bool:
        """Whether nothing differs that the firmware keeps."""
        return all(part.same for part in self.parts.values())


def diff(one: ItemsWords, other: ItemsWords, *, autopilot: Autopilot | None = None) -> MissionDiff:
    """Compare two missions: what was planned and what a vehicle gave back, in either order.

    What the firmware is known not to keep (ArduPilot: parts of a centimetre, some parameters, frames, its own home) is
    no difference. The firmware is what the missions say, unless `autopilot` does; where nobody says, or they name two,
    every number counts. Raises `InputError` for a file that cannot be used, and as `plan` does.

    >>> import gcs_windplan as gw
    >>> plan = gw.plan(gw.Mission(
    ...     start=(36.55, -84.30), goal=(36.56, -84.28), vehicle=gw.Vehicle(12.0), terrain="flat:300",
    ... ))
    >>> gw.diff(plan, plan.items).same
    True
    """
    read = items_of(one), items_of(other)
    first, second = read[0].mission, read[1].mission
    notes = [note for words, found in zip((one, other), read, strict=True) for note in _repairs(words, found)]
    firmware = autopilot or first.autopilot or second.autopilot
    if autopilot is None and None not in (first.autopilot, second.autopilot) and first.autopilot != second.autopilot:
        notes.append("the files name different autopilots: every number counts")
        firmware = None
    parts: dict[MissionType, Comparison] = {"mission": _items_compared(first, second, firmware)}
    if _has_fences(one) and _has_fences(other):
        fences = fence_items(first.fence), fence_items(second.fence)
        parts["fence"] = _compared(*fences, "fence", firmware)
        parts["rally"] = _compared(rally_items(first.rally), rally_items(second.rally), "rally", firmware)
    elif any(mission.fence is not None or mission.rally for mission in (first, second)):
        notes.append("fence and rally points were not compared: a .waypoints file has none")
    return MissionDiff(parts, firmware, tuple(notes))


def _items_compared(first: MissionItems, second: MissionItems, firmware: Autopilot | None) -> Comparison:
    """The items; of two kinds of vehicles by the stricter rules, and with home where no firmware is named."""
    kinds = {mission.vehicle_type for mission in (first, second)} - {None} or {None}
    found = max(
        (_compared(first.items, second.items, "mission", firmware, kind) for kind in sorted(kinds, key=str)),
        key=lambda comparison: len(comparison.differences),
    )
    return found if firmware is not None else _with_home(found, first, second)


def _compared(
    ours: Sequence[MissionItem],
    theirs: Sequence[MissionItem],
    kind: MissionType,
    autopilot: Autopilot | None,
    vehicle_type: VehicleType | None = None,
) -> Comparison:
    return compare_either_way(ours, theirs, mission_type=kind, autopilot=autopilot, vehicle_type=vehicle_type)


def _with_home(comparison: Comparison, first: MissionItems, second: MissionItems) -> Comparison:
    """The comparison with home, which no firmware takes from a mission, and which counts where none is named."""
    if first.home == second.home:
        return comparison
    ours, theirs = (
        "unknown" if mission.home is None else f"{mission.home.point}, {mission.home.altitude:.3f} m"
        for mission in (first, second)
    )
    return replace(comparison, differences=(Difference(None, "home", ours, theirs), *comparison.differences))


def _has_fences(words: ItemsWords) -> bool:
    """Whether what says a mission can say a fence too."""
    file = file_of(words)
    return file is None or file.suffix.lower() == ".plan" or is_mission_file(file)


def _repairs(words: ItemsWords, read: ReadMission) -> list[str]:
    return [f"{file_of(words)}: {repair}" for repair in read.repairs]
