"""The gallery's missions planned as they stand, once for all workers of a run: plans are values, and pickle."""

from __future__ import annotations

import os
import pickle
from functools import cache
from pathlib import Path

from gcs_windplan.jobs.requests import read_request
from gcs_windplan.planning.planner import PlannedRoute, plan_routes

GALLERY = Path(__file__).resolve().parents[1] / "missions"
FOLDER = "GCS_WINDPLAN_TEST_PLANS"  # of a run, set by `conftest`


@cache
def planned(name: str) -> PlannedRoute:
    """The plan of a mission of the gallery, whether its battery lasts or not."""
    kept = Path(os.environ[FOLDER]) / f"{name}.pickle"
    if kept.exists():
        return pickle.loads(kept.read_bytes())
    request = read_request(GALLERY / f"{name}.yaml")
    plan = plan_routes(request, [request.cost])[0]
    being_written = kept.with_suffix(f".{os.getpid()}")
    being_written.write_bytes(pickle.dumps(plan))
    being_written.replace(kept)
    return plan
