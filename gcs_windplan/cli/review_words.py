"""What `gcs-windplan review` prints of a judged mission."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import TYPE_CHECKING

from gcs_windplan.flight import clock

if TYPE_CHECKING:
    from gcs_windplan.assessment import Assessment, Finding

_VERDICTS = {
    "clear": "nothing found",
    "warnings": "look at it before flying",
    "dangers": "do not fly it like this",
}


def lines(assessment: Assessment) -> Iterator[str]:
    """The mission in numbers, what is wrong with it, what was assumed, and the verdict."""
    yield _head(assessment)
    yield _air(assessment)
    for finding in assessment.findings:
        yield f"{finding.severity.upper() if finding.severity == 'danger' else finding.severity}: {_said(finding)}"
    for remark in assessment.remarks:
        yield f"note: {remark}"
    counts = [(severity, sum(one.severity == severity for one in assessment.findings)) for severity in
              ("danger", "warning")]  # fmt: skip
    told = ", ".join(f"{n} {severity}{'s' * (n > 1)}" for severity, n in counts if n)
    yield f"{assessment.name}: {told + ': ' if told else ''}{_VERDICTS[assessment.verdict]}"


def _head(assessment: Assessment) -> str:
    from gcs_windplan.mission.firmware import firmware_of

    sums = assessment.sums
    who = firmware_of(assessment.autopilot, assessment.vehicle_type).full_name
    time = f"{clock(sums.seconds)} min in all" if math.isfinite(sums.seconds) else "cannot be flown to its end"
    return (
        f"{assessment.name} ({who}): {len(assessment.legs)} legs, {sums.length / 1000:.2f} km, {time}; above ground"
        f" {_number(sums.clearance)} to {_number(sums.height)} m ({assessment.vertical_datum})"
    )


def _air(assessment: Assessment) -> str:
    sums = assessment.sums
    parts = [f"wind up to {sums.wind:.1f} m/s"]
    if sums.gust is not None:
        parts.append(f"gusts up to {sums.gust:.1f} m/s")
    if sums.energy is not None and sums.left is not None:
        kept = "" if sums.reserve is None else f" ({100 * sums.reserve:.0f} % must be)"
        parts.append(f"{sums.energy / 3600:.1f} Wh, {100 * sums.left:.0f} % of the battery left{kept}")
    return "; ".join(parts)


def _said(finding: Finding) -> str:
    where = "" if finding.latitude_deg is None else f" [{finding.latitude_deg:.6f}, {finding.longitude_deg:.6f}"
    where += f", {finding.distance / 1000:.2f} km along" if where and finding.distance is not None else ""
    return f"{finding.message}{where + ']' if where else ''}"


def _number(value: float) -> str:
    return "?" if math.isnan(value) else f"{value:.1f}"
