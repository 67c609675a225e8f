"""What the firmware will reject, drop or change of the mission, by its own rules."""

from __future__ import annotations

from collections.abc import Iterator

from gcs_windplan.assessment.assessment import Finding, Severity
from gcs_windplan.assessment.figures import Judged
from gcs_windplan.assessment.rules.saying import Found
from gcs_windplan.mission.firmware import firmware_of
from gcs_windplan.mission.lint import FINER_THAN_FLOWN, finding_lines, lint


def firmware(mission: Judged) -> Iterator[Found]:
    """What it rejects is a danger, what it takes otherwise than written a warning; items alike are said once."""
    case = mission.case
    own = firmware_of(case.autopilot, case.vehicle_type)
    found = lint(case.mission, own)
    for one in finding_lines([finding for finding in found if finding.rule not in FINER_THAN_FLOWN]):
        severity: Severity = "danger" if one.effect == "rejected" else "warning"
        yield Finding(f"firmware-{one.rule}", severity, f"{one.effect} by {own.full_name}: {one.line}", one.item), None
