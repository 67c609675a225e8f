"""Judging a mission: what flying it takes in terrain and wind, and what it breaks."""

from gcs_windplan.assessment.assessment import (
    Assessment,
    Finding,
    GroundMap,
    JudgedLeg,
    Limits,
    Outline,
    Profile,
    Severity,
    Source,
    Stop,
    Sums,
    Verdict,
)
from gcs_windplan.assessment.case import Case
from gcs_windplan.assessment.judge import assess
from gcs_windplan.assessment.planned import assess_plan, case_of

__all__ = [
    "Assessment",
    "Case",
    "Finding",
    "GroundMap",
    "JudgedLeg",
    "Limits",
    "Outline",
    "Profile",
    "Severity",
    "Source",
    "Stop",
    "Sums",
    "Verdict",
    "assess",
    "assess_plan",
    "case_of",
]
