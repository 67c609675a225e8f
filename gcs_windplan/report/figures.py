"""A mission's totals as figures to read, against their limits, and the differences of two missions."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Literal

from gcs_windplan.assessment import Assessment
from gcs_windplan.report import words

_SAME = 0.0005  # a difference of which a figure shows nothing

Good = Literal["less", "more", ""]


@dataclass(frozen=True, slots=True)
class KeyFigure:
    """One figure: what it is, its text and unit, what it is measured against, and whether it breaks that.

    `value` and `show_change` are for the difference to another mission's figure; `good` says which way is better.
    """

    label: str
    text: str
    unit: str
    note: str = ""
    broken: bool = False
    value: float | None = None
    good: Good = ""
    show_change: Callable[[float], str] | None = None
    relative: bool = True


@dataclass(frozen=True, slots=True)
class Change:
    """One figure of two missions, side by side, and the second's difference to the first."""

    first: KeyFigure
    second: KeyFigure
    text: str
    percent: str
    judgement: Literal["better", "worse", ""]


def figures(assessment: Assessment) -> list[KeyFigure]:
    """The totals of a mission."""
    totals = assessment.totals
    climb, descent = words.number(totals.climb), words.number(totals.descent)
    listed = [
        KeyFigure(
            "Time", words.clock(totals.seconds), "min",
            f"take-off {words.clock(totals.takeoff_seconds)} and landing {words.clock(totals.landing_seconds)} counted",
            not math.isfinite(totals.seconds), totals.seconds, "less", words.clock_difference,
        ),
        _figure("Length", totals.length / 1000, "km", 2, f"climbs {climb} m, descends {descent} m"),
    ]  # fmt: skip
    return [*listed, *_battery(assessment), *_heights(assessment), *_winds(assessment)]


def _figure(
    label: str, value: float | None, unit: str, digits: int, note: str = "", broken: bool = False, good: Good = ""
) -> KeyFigure:
    def show_change(change: float) -> str:
        return f"{words.number(change, digits, sign=True)} {unit}"

    return KeyFigure(label, words.number(value, digits), unit, note, broken, value, good, show_change)


def _battery(assessment: Assessment) -> list[KeyFigure]:
    """Energy and what is left, where the airframe is known."""
    totals = assessment.totals
    if totals.energy is None:
        return [KeyFigure("Energy", words.NOTHING, "", "no airframe given: battery not judged")]
    energy = _figure("Energy", words.watt_hours(totals.energy), "Wh", 0, "take-off and landing counted", good="less")
    broken = _found(assessment, "reserve", "battery", "reserve-time")
    note = "" if totals.reserve is None else f"reserve {words.percent(totals.reserve)} %"
    left = KeyFigure(
        "Battery left", words.percent(totals.left), "%", note, broken,
        None if totals.left is None else totals.left * 100, "more",
        lambda change: words.number(change, 1, sign=True) + " points", relative=False,
    )  # fmt: skip
    return [energy, left]


def _heights(assessment: Assessment) -> list[KeyFigure]:
    """The smallest and the largest height above ground."""
    totals, limits = assessment.totals, assessment.limits
    low, high = _found(assessment, "clearance", "terrain"), _found(assessment, "height")
    return [
        _figure("Smallest clearance", totals.clearance, "m", 1, _limit("at least", limits.clearance, "m"), low),
        _figure(
            "Largest height", totals.height, "m", 1, _limit("at most", limits.max_height, "m", "above ground"), high
        ),
    ]


def _winds(assessment: Assessment) -> list[KeyFigure]:
    """The strongest wind and gust met."""
    totals, limits = assessment.totals, assessment.limits
    strong = _found(assessment, "wind")
    listed = [_figure("Strongest wind", totals.wind, "m/s", 1, _limit("at most", limits.wind, "m/s"), strong)]
    if totals.gust is not None:
        strong = _found(assessment, "gust")
        listed.append(_figure("Strongest gust", totals.gust, "m/s", 1, _limit("at most", limits.gust, "m/s"), strong))
    return listed


def _found(assessment: Assessment, *rules: str) -> bool:
    """Whether one of the rules is broken: the judge knows what rounding may forgive."""
    return any(finding.rule in rules for finding in assessment.findings)


def _limit(how: str, value: float | None, unit: str, otherwise: str = "no limit given") -> str:
    return otherwise if value is None else f"{how} {words.number(value, 0 if value % 1 == 0 else 1)} {unit}"


def changes(first: Assessment, second: Assessment) -> list[Change]:
    """The figures of two missions side by side."""
    mine, yours = ({figure.label: figure for figure in figures(one)} for one in (first, second))
    labels = [*mine, *(label for label in yours if label not in mine)]
    missing = {label: KeyFigure(label, words.NOTHING, "") for label in labels}
    return [_change(mine.get(label, missing[label]), yours.get(label, missing[label])) for label in labels]


def _change(first: KeyFigure, second: KeyFigure) -> Change:
    a, b = first.value, second.value
    if a is None or b is None or not math.isfinite(a) or not math.isfinite(b) or first.show_change is None:
        return Change(first, second, words.NOTHING, words.NOTHING, "")
    text = first.show_change(b - a)
    changed = text[0] in "+−"
    percent = f"{words.number((b - a) / a * 100, 1, sign=True)} %" if first.relative and a > 0 else ""
    better = (b < a) if first.good == "less" else (b > a)
    judgement: Literal["better", "worse", ""] = ("better" if better else "worse") if first.good and changed else ""
    return Change(first, second, text, percent, judgement)


def gain(first: Assessment, second: Assessment) -> str:
    """What the second mission gains over the first in time and energy, a sentence."""
    parts = []
    a, b = first.totals.seconds, second.totals.seconds
    if math.isfinite(a) and math.isfinite(b) and a > 0:
        parts.append(_gained("time", f"{words.clock(abs(b - a))} min", (b - a) / a))
    a, b = first.totals.energy or math.nan, second.totals.energy or math.nan
    if math.isfinite(a) and math.isfinite(b):
        parts.append(_gained("energy", f"{words.number(words.watt_hours(abs(b - a)), 1)} Wh", (b - a) / a))
    return f"B takes {' and '.join(parts)} {'than' if '%' in parts[-1] else 'as'} A." if parts else ""


def _gained(what: str, amount: str, share: float) -> str:
    if abs(share) < _SAME:
        return f"as much {what}"
    return f"{amount} {'less' if share < 0 else 'more'} ({words.number(share * 100, 1, sign=True)} %)"
