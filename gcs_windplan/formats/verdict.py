"""What judging missions came to as JSON, for scripts."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from gcs_windplan.json_text import json_text

if TYPE_CHECKING:
    from gcs_windplan.assessment import Assessment


def format_verdict(assessments: Sequence[Assessment], written: Sequence[Path] = (), code: int = 0) -> str:
    """One object: a verdict for each mission with its findings, totals (`sums`), stops and legs.

    SI units, angles in degrees, null for what is not known, or infinite: a time or an energy of what cannot be flown.
    """
    document = {
        "verb": "review",
        "exit_code": code,
        "missions": [_mission(assessment) for assessment in assessments],
        "written": written,
    }
    return json_text(document)


def _mission(assessment: Assessment) -> dict[str, Any]:
    names = (
        "name", "verdict", "autopilot", "vehicle_type", "vertical_datum", "departure", "findings", "limits", "stops",
        "legs", "sources", "remarks",
    )  # fmt: skip
    return {**{name: getattr(assessment, name) for name in names}, "sums": assessment.totals}
