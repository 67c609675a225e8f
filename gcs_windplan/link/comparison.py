"""Whether a vehicle holds what was sent to it, by what its firmware keeps.

Each firmware stores less than it is sent: ArduPilot keeps centimetres, cut, and of many items some parameters only;
PX4 keeps floats of 32 bits. What it is known not to keep is a loss and no difference; what it keeps must come back,
and so must everything of which nobody knows.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

from gcs_windplan.link.wire import MissionType
from gcs_windplan.mission import (
    Frame,
    MissionItem,
    command_name,
    degrees_e7,
    frame_name,
    plain_frame,
    scales_place,
    takes_place,
)
from gcs_windplan.mission.kept import (
    CENTIMETRE,
    Fate,
    cut_rule,
    float_text,
    is_listed,
    keeps_altitude,
    parameter_rules,
    same_float,
)
from gcs_windplan.vehicle import Autopilot, VehicleType

_METRE = 1.0  # [m] ArduPilot's rally points before 4.6


@dataclass(frozen=True, slots=True)
class Difference:
    """One number that is not as it was sent; `seq` counts from 0, None for the number of items.

    A `trifle` is a loss that changes nothing: less than a centimetre, or a frame that no number refers to.
    """

    seq: int | None
    field: str
    sent: str
    held: str
    trifle: bool = False

    def __str__(self) -> str:
        place = "" if self.seq is None else f"item {self.seq}: "
        return f"{place}{self.field} {self.sent} became {self.held}"


@dataclass(frozen=True, slots=True)
class Comparison:
    """What differs, and what the firmware was known not to keep."""

    differences: tuple[Difference, ...] = ()
    losses: tuple[Difference, ...] = ()

    @property
    def same(self) -> bool:
        """Whether the vehicle holds what was sent, as far as its firmware can."""
        return not self.differences


def compare_items(
    sent: Sequence[MissionItem],
    held: Sequence[MissionItem],
    *,
    mission_type: MissionType = "mission",
    autopilot: Autopilot | None = None,
    vehicle_type: VehicleType | None = None,
    first: int = 0,
) -> Comparison:
    """Compare what was sent with what the vehicle holds, neither with home; `first` is the first item's number.

    For an autopilot of None every number must be the same as a float of 32 bits.
    """
    rules = _Rules(mission_type, autopilot, vehicle_type)
    differences: list[Difference] = []
    losses: list[Difference] = []
    if len(sent) != len(held):
        differences.append(Difference(None, "the number of items", str(len(sent)), str(len(held))))
    for seq, (ours, theirs) in enumerate(zip(sent, held, strict=False), start=first):
        for field, value, kept, fate in rules.fates(ours, theirs):
            if fate != "same":
                found = Difference(seq, field, value, kept, trifle=fate == "trifle")
                (differences if fate == "differs" else losses).append(found)
    return Comparison(tuple(differences), tuple(losses))


def compare_either_way(
    one: Sequence[MissionItem],
    other: Sequence[MissionItem],
    *,
    mission_type: MissionType = "mission",
    autopilot: Autopilot | None = None,
    vehicle_type: VehicleType | None = None,
    first: int = 1,
) -> Comparison:
    """Compare two lists of which either may be what a vehicle made of the other; the closer reading counts."""

    def compare(sent: Sequence[MissionItem], held: Sequence[MissionItem]) -> Comparison:
        return compare_items(
            sent, held, mission_type=mission_type, autopilot=autopilot, vehicle_type=vehicle_type, first=first
        )

    there, back = compare(one, other), _turned(compare(other, one))
    return min(there, back, key=_weight)


def _weight(comparison: Comparison) -> tuple[int, int, list[tuple[int, str]]]:
    """How far a comparison is from sameness; two of equal weight name the same numbers."""
    named = [(-1 if found.seq is None else found.seq, found.field) for found in comparison.differences]
    return len(comparison.differences), len(comparison.losses), sorted(named)


def _turned(comparison: Comparison) -> Comparison:
    def turn(found: Difference) -> Difference:
        return replace(found, sent=found.held, held=found.sent)

    return Comparison(tuple(map(turn, comparison.differences)), tuple(map(turn, comparison.losses)))


def loss_lines(losses: Sequence[Difference], autopilot: Autopilot | None) -> tuple[str, ...]:
    """The losses in words: trifles counted, all others said, those alike in one line."""
    firmware = {"ardupilot": "ArduPilot", "px4": "PX4", None: "the firmware"}[autopilot]
    trifles = [loss for loss in losses if loss.trifle]
    frames = sum(loss.field == "frame" for loss in trifles)
    heights = len(trifles) - frames
    lines = []
    if heights:
        lines.append(
            f"{_counted(heights, 'altitude differs', 'altitudes differ')} by less than {firmware}'s centimetre"
        )
    if frames:
        lines.append(f"{_counted(frames, 'frame differs', 'frames differ')} that no altitude refers to")
    alike: dict[tuple[str, str, str], list[int]] = {}
    for loss in losses:
        if not loss.trifle:
            alike.setdefault((loss.field, loss.sent, loss.held), []).append(-1 if loss.seq is None else loss.seq)
    for (field, sent, held), seqs in alike.items():
        lines.append(f"not kept by {firmware}: {field} {sent} became {held} ({_numbered(seqs)})")
    return tuple(lines)


def _counted(number: int, one: str, many: str) -> str:
    return f"{number} {one if number == 1 else many}"


def _numbered(seqs: Sequence[int]) -> str:
    """Item numbers in rising order, those in a row as a range."""
    rows: list[list[int]] = []
    for seq in seqs:
        if rows and seq == rows[-1][-1] + 1:
            rows[-1].append(seq)
        else:
            rows.append([seq])
    texts = (str(row[0]) if len(row) == 1 else f"{row[0]} to {row[-1]}" for row in rows)
    return f"item{'' if len(seqs) == 1 else 's'} {', '.join(texts)}"


@dataclass(frozen=True, slots=True)
class _Rules:
    """What becomes of an item's numbers, by mission type and firmware."""

    mission_type: MissionType
    autopilot: Autopilot | None
    vehicle_type: VehicleType | None

    def fates(self, sent: MissionItem, held: MissionItem) -> Iterator[tuple[str, str, str, Fate]]:
        """Each field with its value sent, its value held, and its fate."""
        if sent.command != held.command:
            yield "command", command_name(sent.command), command_name(held.command), "differs"
            return
        yield "frame", frame_name(sent.frame), frame_name(held.frame), self._frame(sent, held)
        rules = parameter_rules(sent.command, self.autopilot, self.vehicle_type)
        count = 4 if self._is_place(sent, held) else 7
        numbers = zip(rules, _parameters(sent), _parameters(held), strict=True)
        for number, (rule, ours, theirs) in enumerate(numbers, start=1):
            if number <= count:
                yield f"parameter {number}", float_text(ours), float_text(theirs), rule(ours, theirs)
        if count == 4:
            yield from self._place(sent, held)
        if self.mission_type == "mission":
            fate: Fate = "lost" if self.autopilot == "ardupilot" else "differs"
            same = sent.autocontinue == held.autocontinue
            yield "autocontinue", str(sent.autocontinue), str(held.autocontinue), "same" if same else fate

    def _is_place(self, sent: MissionItem, held: MissionItem) -> bool:
        """Whether parameters 5 to 7 are a place, or travel as one and nobody knows better."""
        if takes_place(sent.command):
            return True
        travels = scales_place(sent.command, sent.frame) or scales_place(held.command, held.frame)
        return travels and not is_listed(sent.command, self.autopilot)

    def _frame(self, sent: MissionItem, held: MissionItem) -> Fate:
        ours, theirs = plain_frame(sent.frame), plain_frame(held.frame)
        if ours == theirs or self.mission_type == "fence":
            return "same"  # a fence has no heights
        if not takes_place(sent.command):
            refers = self._is_place(sent, held) or keeps_altitude(sent.command, self.autopilot)
            if not refers or not any((*_parameters(sent)[4:], *_parameters(held)[4:])):
                return "same"  # without a place there is nothing to refer to
        if self.autopilot == "ardupilot" and (ours, theirs) == (Frame.MISSION, Frame.GLOBAL) and sent.altitude == 0:
            return "trifle"
        return "differs"

    def _place(self, sent: MissionItem, held: MissionItem) -> Iterator[tuple[str, str, str, Fate]]:
        for name, a, b in (
            ("latitude", sent.latitude_deg, held.latitude_deg),
            ("longitude", sent.longitude_deg, held.longitude_deg),
        ):
            yield name, f"{a:.7f}", f"{b:.7f}", "same" if degrees_e7(a) == degrees_e7(b) else "differs"
        yield (
            "altitude",
            float_text(sent.altitude),
            float_text(held.altitude),
            self._altitude(sent.altitude, held.altitude),
        )

    def _altitude(self, sent: float, held: float) -> Fate:
        if same_float(sent, held):
            return "same"
        if self.mission_type == "fence":
            return "lost" if held == 0 else "differs"
        if self.autopilot != "ardupilot":
            return "differs"
        if cut_rule(CENTIMETRE)(sent, held) == "lost":
            return "trifle"
        return cut_rule(_METRE)(sent, held) if self.mission_type == "rally" else "differs"


def _parameters(item: MissionItem) -> tuple[float, ...]:
    return (*item.params, item.latitude_deg, item.longitude_deg, item.altitude)
