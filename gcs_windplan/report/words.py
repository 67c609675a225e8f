"""Figures in words, as the page prints them."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from gcs_windplan.arrays import FloatArray
from gcs_windplan.assessment import Assessment, Finding, Verdict
from gcs_windplan.flight import flight

NOTHING = "–"  # where something is not known
_JOULES = 3600.0  # in a Wh
_HUGE = 1e9  # from here on numbers are written with a power of ten
_RAISED = str.maketrans("0123456789", "⁰¹²³⁴⁵⁶⁷⁸⁹")

VERDICTS: dict[Verdict, str] = {
    "clear": "Clear: nothing found",
    "warnings": "Warnings: look at them before flying",
    "dangers": "Dangers: do not fly it like this",
}


def number(value: float | None, digits: int = 0, sign: bool = False) -> str:
    """A number with a real minus; a dash where there is none."""
    if value is None or math.isnan(value):
        return NOTHING
    if math.isinf(value):
        return "∞" if value > 0 else "−∞"
    if abs(value) >= _HUGE:
        return ("+" if sign and value > 0 else "") + _scientific(value)
    text = f"{value:{'+' if sign else ''}.{digits}f}"
    if float(text) == 0:
        text = text.lstrip("+-")
    return text.replace("-", "−")


def _scientific(value: float) -> str:
    """`1×10³⁰`, with a decimal where it has one."""
    head, power = f"{value:.1e}".split("e")
    return f"{float(head):g}×10{str(int(power)).translate(_RAISED)}".replace("-", "−")


def clock(seconds: float | None) -> str:
    """A duration as minutes and seconds: 18:05; `never` where it does not end."""
    if seconds is None or math.isnan(seconds):
        return NOTHING
    if math.isinf(seconds):
        return "never"
    return flight.clock(seconds) if abs(seconds) < _HUGE else number(seconds / 60)


def clock_difference(seconds: float) -> str:
    """A difference of durations: +1:05."""
    if not math.isfinite(seconds):
        return NOTHING
    sign = "+" if round(seconds) > 0 else "−" if round(seconds) < 0 else ""
    return sign + clock(abs(seconds))


def watt_hours(joules: float | None) -> float | None:
    """An energy [J] in Wh."""
    return None if joules is None else joules / _JOULES


def percent(share: float | None, digits: int = 0, sign: bool = False) -> str:
    """A share as a percentage, without its sign `%`."""
    return number(None if share is None else share * 100, digits, sign)


def bearing(degrees: float | None) -> str:
    """A direction in three figures: 007."""
    if degrees is None or not math.isfinite(degrees):
        return NOTHING
    return f"{round(degrees) % 360:03d}"


def against_limit(finding: Finding) -> str:
    """A finding's number against its limit: `18.2 m, limit 30 m`."""
    if finding.value is None:
        return ""
    unit = f" {finding.unit}" if finding.unit else ""
    text = f"{_short(finding.value)}{unit}"
    return text if finding.limit is None else f"{text}, limit {_short(finding.limit)}{unit}"


def _short(value: float) -> str:
    """Enough figures to tell a number from its limit."""
    if not math.isfinite(value):
        return NOTHING
    return number(value, 0 if abs(value) >= 1000 or value == round(value) else 1 if abs(value) >= 10 else 2)


def counts(findings: Sequence[Finding]) -> str:
    """`2 dangers, 1 warning`; empty where there is none."""
    counted = [(sum(f.severity == severity for f in findings), severity) for severity in ("danger", "warning")]
    return ", ".join(f"{n} {severity}{'' if n == 1 else 's'}" for n, severity in counted if n)


def summary(assessment: Assessment) -> dict[str, str]:
    """Each chart in a sentence, for those who do not see it; empty where there is nothing to show."""
    profile, totals, name = assessment.profile, assessment.totals, assessment.name
    power, left = profile.power, profile.left
    return {
        "heights": f"{name}: over {number(totals.distance / 1000, 2)} km, altitude {_span(profile.altitude, 0)} m above"
        f" mean sea level, {number(totals.clearance, 1)} to {number(totals.height, 1)} m above ground.",
        "wind": f"{name}: along the route {_span(profile.wind_along, 1)} m/s, positive from behind; across"
        f" {_span(profile.wind_across, 1)} m/s, positive to the right.",
        "speed": f"{name}: ground speed {_span(profile.ground_speed, 1)} m/s,"
        f" airspeed {_span(profile.airspeed, 1)} m/s.",
        "power": "" if power is None else f"{name}: power {_span(power, 0)} W.",
        "battery": "" if left is None else f"{name}: battery {_span(100 * left, 0)} % left.",
    }


def _span(values: FloatArray, digits: int) -> str:
    """`3 to 12`, unknown values left out."""
    known = values[np.isfinite(values)]
    if not len(known):
        return "unknown"
    return f"{number(float(known.min()), digits)} to {number(float(known.max()), digits)}"
