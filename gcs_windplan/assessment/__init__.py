"""Judging a mission: what flying it takes in terrain and wind, and what it breaks."""

from gcs_windplan.assessment.assessment import (
    AssessedLeg,
    Assessment,
    AssessmentLimits,
    Finding,
    GroundMap,
    MissionTotals,
    Outline,
    Profile,
    Severity,
    Source,
    Stop,
    Verdict,
)
from gcs_windplan.assessment.case import Case
from gcs_windplan.assessment.judge import assess
from gcs_windplan.assessment.planned import assess_plan, case_of

__all__ = [
    "AssessedLeg",
    "Assessment",
    "AssessmentLimits",
    "Case",
    "Finding",
    "GroundMap",
    "MissionTotals",
    "Outline",
    "Profile",
    "Severity",
    "Source",
    "Stop",
    "Verdict",
    "assess",
    "assess_plan",
    "case_of",
]
