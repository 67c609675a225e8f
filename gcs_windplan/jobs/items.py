"""The items that a vehicle flies, from whatever says them: a mission to be planned, a plan, a ground station's file."""

from __future__ import annotations

import os
from pathlib import Path
from typing import TYPE_CHECKING, Final, TypeAlias

from gcs_windplan.formats import ReadMission, read_items
from gcs_windplan.mission import MissionItems
from gcs_windplan.progress import CancelToken, ProgressCallback

if TYPE_CHECKING:
    from gcs_windplan.jobs.mission import Mission
    from gcs_windplan.planning.planner import PlannedRoute
    from gcs_windplan.planning.request import Request

MISSION_FILES: Final = (".yaml", ".yml")

#: A ground station's file (.plan, .waypoints), a mission file (.yaml), a mission, a plan, or the items themselves.
ItemsWords: TypeAlias = "str | os.PathLike[str] | Mission | Request | PlannedRoute | MissionItems"


def is_mission_file(path: str | os.PathLike[str]) -> bool:
    """Whether a file's name is that of a mission file, which is planned."""
    return Path(path).suffix.lower() in MISSION_FILES


def items_of(
    words: ItemsWords, *, progress: ProgressCallback | None = None, cancel: CancelToken | None = None
) -> ReadMission:
    """The items, and what was repaired of a file; what is to be planned is planned first. Raises as `plan` does."""
    if isinstance(words, MissionItems):
        return ReadMission(words)
    if isinstance(words, str | os.PathLike) and not is_mission_file(words):
        return read_items(words)
    from gcs_windplan.jobs.plans import plan
    from gcs_windplan.planning.export import mission_of
    from gcs_windplan.planning.planner import PlannedRoute

    if isinstance(words, PlannedRoute):
        return ReadMission(mission_of(words))
    return ReadMission(mission_of(plan(words, progress=progress, cancel=cancel)))


def file_of(words: ItemsWords) -> Path | None:
    """The file that the words name."""
    return Path(words) if isinstance(words, str | os.PathLike) else None
