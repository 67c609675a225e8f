"""What `gcs-windplan review` prints of a judged mission."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import TYPE_CHECKING

from gcs_windplan.flight import clock
from gcs_windplan.report import words

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
        yield f"{finding.severity.upper() if finding.severity == 'danger' else finding.severity}: {_text(finding)}"
    for remark in assessment.remarks:
        yield f"note: {remark}"
    counts = words.counts(assessment.findings)
    yield f"{assessment.name}: {counts + ': ' if counts else ''}{_VERDICTS[assessment.verdict]}"


def _head(assessment: Assessment) -> str:
    from gcs_windplan.mission.firmware import firmware_of

    totals = assessment.totals
    who = firmware_of(assessment.autopilot, assessment.vehicle_type).full_name
    time = f"{clock(totals.seconds)} min in all" if math.isfinite(totals.seconds) else "cannot be flown to its end"
    return (
        f"{assessment.name} ({who}): {len(assessment.legs)} legs, {totals.length / 1000:.2f} km, {time}; above ground"
        f" {_number(totals.clearance)} to {_number(totals.height)} m ({assessment.vertical_datum})"
    )


def _air(assessment: Assessment) -> str:
    totals = assessment.totals
    parts = [f"wind up to {totals.wind:.1f} m/s"]
    if totals.gust is not None:
        parts.append(f"gusts up to {totals.gust:.1f} m/s")
    if totals.energy is not None and totals.left is not None:
        kept = "" if totals.reserve is None else f" ({100 * totals.reserve:.0f} % must be)"
        parts.append(f"{totals.energy / 3600:.1f} Wh, {100 * totals.left:.0f} % of the battery left{kept}")
    return "; ".join(parts)


def _text(finding: Finding) -> str:
    where = "" if finding.latitude_deg is None else f" [{finding.latitude_deg:.6f}, {finding.longitude_deg:.6f}"
    where += f", {finding.distance / 1000:.2f} km along" if where and finding.distance is not None else ""
    return f"{finding.message}{where + ']' if where else ''}"


def _number(value: float) -> str:
    return "?" if math.isnan(value) else f"{value:.1f}"
