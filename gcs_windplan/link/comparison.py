"""Whether a vehicle holds what was sent to it, by what its firmware keeps.

Each firmware stores less than it is sent: ArduPilot keeps centimetres, cut, and of many items some parameters only;
PX4 keeps floats of 32 bits. What it is known not to keep is a loss and no difference; what it keeps must come back.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from gcs_windplan.link.kept import Fate, float_rule, parameter_rules, same_float, unlisted_rule
from gcs_windplan.link.wire import MissionType
from gcs_windplan.mission import Frame, MissionItem, command_name, degrees_e7, frame_name, plain_frame, takes_place
from gcs_windplan.vehicle import Autopilot, VehicleType

_CENTIMETRE = 0.01  # [m] ArduPilot's altitudes
_METRE = 1.0  # [m] ArduPilot's rally points before 4.6


@dataclass(frozen=True, slots=True)
class Difference:
    """One number that is not as it was sent; `seq` counts from 0, None for the number of items."""

    seq: int | None
    field: str
    sent: str
    held: str

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
                (differences if fate == "differs" else losses).append(Difference(seq, field, value, kept))
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

    there, back = compare(one, other), compare(other, one)
    if len(there.differences) <= len(back.differences):
        return there
    return Comparison(tuple(map(_turned, back.differences)), tuple(map(_turned, back.losses)))


def _turned(difference: Difference) -> Difference:
    return Difference(difference.seq, difference.field, difference.held, difference.sent)


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
        for number, (rule, ours, theirs) in enumerate(zip(rules, sent.params, held.params, strict=True), start=1):
            yield f"parameter {number}", _text(ours), _text(theirs), rule(ours, theirs)
        yield from self._place(sent, held)
        if self.mission_type == "mission":
            fate: Fate = "lost" if self.autopilot == "ardupilot" else "differs"
            same = sent.autocontinue == held.autocontinue
            yield "autocontinue", str(sent.autocontinue), str(held.autocontinue), "same" if same else fate

    def _frame(self, sent: MissionItem, held: MissionItem) -> Fate:
        ours, theirs = plain_frame(sent.frame), plain_frame(held.frame)
        if ours == theirs or self.mission_type == "fence" or not takes_place(sent.command):
            return "same"  # a fence has no heights, and without a place there is nothing to refer to
        if self.autopilot == "ardupilot" and (ours, theirs) == (Frame.MISSION, Frame.GLOBAL):
            return "lost"
        return "differs"

    def _place(self, sent: MissionItem, held: MissionItem) -> Iterator[tuple[str, str, str, Fate]]:
        if not takes_place(sent.command):
            rule = unlisted_rule if self.autopilot == "ardupilot" else float_rule
            ours, theirs = (sent.x, sent.y, sent.altitude), (held.x, held.y, held.altitude)
            for number, (a, b) in enumerate(zip(ours, theirs, strict=True), start=5):
                yield f"parameter {number}", _text(a), _text(b), rule(a, b)
            return
        for name, a, b in (
            ("latitude", sent.latitude_deg, held.latitude_deg),
            ("longitude", sent.longitude_deg, held.longitude_deg),
        ):
            yield name, f"{a:.7f}", f"{b:.7f}", "same" if degrees_e7(a) == degrees_e7(b) else "differs"
        yield "altitude", _text(sent.altitude), _text(held.altitude), self._altitude(sent.altitude, held.altitude)

    def _altitude(self, sent: float, held: float) -> Fate:
        if same_float(sent, held):
            return "same"
        if self.mission_type == "fence":
            return "lost" if held == 0 else "differs"
        if self.autopilot != "ardupilot":
            return "differs"
        step = _METRE if self.mission_type == "rally" else _CENTIMETRE
        # cut towards zero; the float on the wire may lie just below the step
        return "lost" if abs(sent - held) < step + _float_step(sent) else "differs"


def _float_step(number: float) -> float:
    """Twice the distance of the floats of 32 bits around a number."""
    return math.ulp(number) * 2.0**30


def _text(number: float) -> str:
    """The shortest decimal that is the same float of 32 bits."""
    texts = (f"{number:.{digits}g}" for digits in range(6, 10))
    return next((text for text in texts if same_float(float(text), number)), f"{number:.9g}")
