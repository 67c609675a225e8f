"""What the firmware will reject, drop or change of the mission, by its own rules."""

from __future__ import annotations

from collections.abc import Iterator

from gcs_windplan.assessment.assessment import Finding, Severity
from gcs_windplan.assessment.figures import AssessedMission
from gcs_windplan.assessment.rules.places import Found
from gcs_windplan.mission.lint import FINER_THAN_FLOWN, Firmware, lint, told


def firmware(mission: AssessedMission) -> Iterator[Found]:
    """What it rejects is a danger, what it takes otherwise than written a warning; items alike are told once."""
    case = mission.case
    name = Firmware(case.autopilot, case.vehicle_type).full_name
    found = lint(case.mission, case.autopilot, case.vehicle_type)
    for one in told([finding for finding in found if finding.rule not in FINER_THAN_FLOWN]):
        severity: Severity = "danger" if one.effect == "rejected" else "warning"
        facts = {"effect": one.effect, "firmware": name, "line": one.line}
        yield Finding(f"firmware-{one.rule}", severity, item=one.item, facts=facts), None
