"""Whether a vehicle holds what was sent to it, by what its firmware keeps.

Each firmware stores less than it is sent: ArduPilot keeps centimetres, cut, and of many items some parameters only;
PX4 keeps floats of 32 bits. What it is known not to keep is a loss and no difference; what it keeps must come back,
and so must everything of which nobody knows.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

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
from gcs_windplan.mission.firmware import CommandRule, Firmware, MissionType, Retention, stores
from gcs_windplan.mission.firmware.floats import float_text, same_float
from gcs_windplan.mission.firmware.storage import FLOAT

_NOTHING = stores()  # of a rally point's parameters


@dataclass(frozen=True, slots=True)
class Difference:
    """One number that is not as it was sent; `seq` counts from 0, None for the number of items.

    One that is `rounded` is a loss that changes nothing: less than a centimetre, or a frame that no number refers to.
    """

    seq: int | None
    field: str
    sent: str
    held: str
    rounded: bool = False

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
    firmware: Firmware | None = None,
    first: int = 0,
) -> Comparison:
    """Compare what was sent with what the vehicle holds, neither with home; `first` is the first item's number.

    Without a firmware every number must be the same as a float of 32 bits.
    """
    rules = _Rules(mission_type, firmware)
    differences: list[Difference] = []
    losses: list[Difference] = []
    if len(sent) != len(held):
        differences.append(Difference(None, "the number of items", str(len(sent)), str(len(held))))
    for seq, (ours, theirs) in enumerate(zip(sent, held, strict=False), start=first):
        for field, value, back, retention in rules.fields(ours, theirs):
            if retention != "same":
                found = Difference(seq, field, value, back, rounded=retention == "rounded")
                (differences if retention == "differs" else losses).append(found)
    return Comparison(tuple(differences), tuple(losses))


def compare_either_way(
    one: Sequence[MissionItem],
    other: Sequence[MissionItem],
    *,
    mission_type: MissionType = "mission",
    firmware: Firmware | None = None,
    first: int = 1,
) -> Comparison:
    """Compare two lists of which either may be what a vehicle made of the other; the closer reading counts."""

    def compare(sent: Sequence[MissionItem], held: Sequence[MissionItem]) -> Comparison:
        return compare_items(sent, held, mission_type=mission_type, firmware=firmware, first=first)

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


def loss_lines(losses: Sequence[Difference], firmware: Firmware | None) -> tuple[str, ...]:
    """The losses in words: what was rounded counted, all others said, those alike in one line."""
    name = "the firmware" if firmware is None else firmware.family
    rounded = [loss for loss in losses if loss.rounded]
    frames = sum(loss.field == "frame" for loss in rounded)
    heights = len(rounded) - frames
    lines = []
    if heights:
        lines.append(f"{_counted(heights, 'altitude differs', 'altitudes differ')} by less than {name}'s centimetre")
    if frames:
        lines.append(f"{_counted(frames, 'frame differs', 'frames differ')} that no altitude refers to")
    alike: dict[tuple[str, str, str], list[int]] = {}
    for loss in losses:
        if not loss.rounded:
            alike.setdefault((loss.field, loss.sent, loss.held), []).append(-1 if loss.seq is None else loss.seq)
    for (field, sent, held), seqs in alike.items():
        lines.append(f"not kept by {name}: {field} {sent} became {held} ({_numbered(seqs)})")
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
    firmware: Firmware | None

    def fields(self, sent: MissionItem, held: MissionItem) -> Iterator[tuple[str, str, str, Retention]]:
        """Each field with its value sent, its value held, and what became of it."""
        if sent.command != held.command:
            yield "command", command_name(sent.command), command_name(held.command), "differs"
            return
        yield "frame", frame_name(sent.frame), frame_name(held.frame), self._frame(sent, held)
        rule = self._rule(sent)
        ways = (FLOAT,) * 7 if rule is None else rule.params
        count = 4 if self._is_place(sent, held) else 7
        numbers = zip(ways, _parameters(sent), _parameters(held), strict=True)
        for number, (way, ours, theirs) in enumerate(numbers, start=1):
            if number <= count:
                yield f"parameter {number}", float_text(ours), float_text(theirs), way.retention(ours, theirs)
        if count == 4:
            yield from self._place(sent, held)
        if self.mission_type == "mission":
            stored = self.firmware is None or self.firmware.stores_autocontinue
            same = sent.autocontinue == held.autocontinue
            retention: Retention = "same" if same else "differs" if stored else "lost"
            yield "autocontinue", str(sent.autocontinue), str(held.autocontinue), retention

    def _rule(self, item: MissionItem) -> CommandRule | None:
        """The rule of an item; None for a firmware or a command that nothing is known of."""
        if self.firmware is None:
            return None
        if self.mission_type == "mission":
            return self.firmware.rule(item.command, item.frame) or self.firmware.rule(item.command)
        return self.firmware.fence.get(item.command, _NOTHING if self.mission_type == "rally" else None)

    def _is_place(self, sent: MissionItem, held: MissionItem) -> bool:
        """Whether parameters 5 to 7 are a place, or travel as one and nobody knows better."""
        if takes_place(sent.command):
            return True
        travels = scales_place(sent.command, sent.frame) or scales_place(held.command, held.frame)
        return travels and self._rule(sent) is None

    def _frame(self, sent: MissionItem, held: MissionItem) -> Retention:
        ours, theirs = plain_frame(sent.frame), plain_frame(held.frame)
        if ours == theirs or self.mission_type == "fence":
            return "same"  # a fence has no heights
        if not takes_place(sent.command):
            rule = self._rule(sent)
            refers = self._is_place(sent, held) or (rule is not None and rule.place)
            if not refers or not any((*_parameters(sent)[4:], *_parameters(held)[4:])):
                return "same"  # without a place there is nothing to refer to
        taken_as_global = self.firmware is not None and self.firmware.placeless is None
        if taken_as_global and (ours, theirs) == (Frame.MISSION, Frame.GLOBAL) and sent.altitude == 0:
            return "rounded"
        return "differs"

    def _place(self, sent: MissionItem, held: MissionItem) -> Iterator[tuple[str, str, str, Retention]]:
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

    def _altitude(self, sent: float, held: float) -> Retention:
        if same_float(sent, held):
            return "same"
        if self.mission_type == "fence":
            return "lost" if held == 0 else "differs"
        if self.firmware is None:
            return "differs"
        stored = self.firmware.altitude.retention(sent, held)
        if stored == "differs" and self.mission_type == "rally":
            return self.firmware.rally.retention(sent, held)  # newer ones have the missions' precision
        return stored


def _parameters(item: MissionItem) -> tuple[float, ...]:
    return (*item.params, item.latitude_deg, item.longitude_deg, item.altitude)
