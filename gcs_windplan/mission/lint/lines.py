"""Findings in lines for people: those alike on many items are said once."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from gcs_windplan.mission.lint.finding import EFFECTS, Effect, FirmwareFinding

_SHOWN = 2  # numbers of a group


@dataclass(frozen=True, slots=True)
class FindingLine:
    """One line, its effect and rule, and the first item that it strikes."""

    effect: Effect
    line: str
    rule: str
    item: int | None


def finding_lines(findings: Sequence[FirmwareFinding]) -> tuple[FindingLine, ...]:
    """A line for each rule that strikes, worst effects first, in the order of the items."""
    groups: dict[tuple[str, Effect, str, str], list[FirmwareFinding]] = {}
    for finding in findings:
        key = finding.rule, finding.effect, finding.fact, finding.advice
        groups.setdefault(key, []).append(finding)
    lines = [FindingLine(one[0].effect, _line(one), one[0].rule, one[0].item) for one in groups.values()]
    return tuple(sorted(lines, key=lambda line: EFFECTS.index(line.effect)))


def _line(group: Sequence[FirmwareFinding]) -> str:
    first = group[0]
    where = _places([finding.item for finding in group if finding.item is not None])
    numbers = list(dict.fromkeys(finding.number for finding in group if finding.number))
    more = len(numbers) - _SHOWN
    shown = ", ".join(numbers[:_SHOWN]) + (f" and {more} more" if more > 0 else "")
    sentence = f"{first.fact}: {shown}" if shown else first.fact
    return where + (f"{sentence}; {first.advice}" if first.advice else sentence)


def _places(items: Sequence[int]) -> str:
    """`items 3, 5 to 9: `, and nothing for the whole mission."""
    if not items:
        return ""
    rows: list[list[int]] = []
    for item in sorted(set(items)):
        if rows and item == rows[-1][-1] + 1:
            rows[-1].append(item)
        else:
            rows.append([item])
    texts = (str(row[0]) if len(row) == 1 else f"{row[0]} to {row[-1]}" for row in rows)
    plural = len(rows) > 1 or len(rows[0]) > 1
    return f"item{'s' if plural else ''} {', '.join(texts)}: "
