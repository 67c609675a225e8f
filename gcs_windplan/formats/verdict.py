"""What judging missions came to as JSON, for scripts."""

from __future__ import annotations

import json
from collections.abc import Sequence
from dataclasses import asdict
from pathlib import Path
from typing import TYPE_CHECKING, Any

from gcs_windplan.formats.geojson import plain

if TYPE_CHECKING:
    from gcs_windplan.assessment import Assessment


def format_verdict(assessments: Sequence[Assessment], written: Sequence[Path] = (), code: int = 0) -> str:
    """One object: a verdict for each mission with its findings, sums, stops and legs; SI units, angles in degrees.

    null for what is not known, or infinite: a time or an energy of what cannot be flown.
    """
    document = {
        "verb": "review",
        "exit_code": code,
        "missions": [_mission(assessment) for assessment in assessments],
        "written": [str(path) for path in written],
    }
    return json.dumps(document, indent=1, ensure_ascii=False, allow_nan=False)


def _mission(assessment: Assessment) -> dict[str, Any]:
    return {
        "name": assessment.name,
        "verdict": assessment.verdict,
        "autopilot": assessment.autopilot,
        "vehicle_type": assessment.vehicle_type,
        "vertical_datum": assessment.vertical_datum,
        "departure": None if assessment.departure is None else assessment.departure.isoformat(),
        "findings": [_row(finding) for finding in assessment.findings],
        "limits": _row(assessment.limits),
        "sums": _row(assessment.sums),
        "stops": [_row(stop) for stop in assessment.stops],
        "legs": [_row(leg) for leg in assessment.legs],
        "sources": [_row(source) for source in assessment.sources],
        "remarks": list(assessment.remarks),
    }


def _row(part: Any) -> dict[str, Any]:
    return {name: plain(value) for name, value in asdict(part).items()}
