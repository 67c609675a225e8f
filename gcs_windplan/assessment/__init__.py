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

__all__ = [
    "Assessment",
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
]
