"""Reading a mission in whichever of the formats its file's name says."""

from __future__ import annotations

import os
from pathlib import Path

from gcs_windplan.errors import FormatError, Problem
from gcs_windplan.formats.plan import read_plan
from gcs_windplan.formats.reading import ReadMission
from gcs_windplan.formats.waypoints import read_waypoints

_READERS = {
    ".plan": read_plan,
    ".waypoints": read_waypoints,
    ".txt": read_waypoints,
    ".wp": read_waypoints,
}


def read_items(path: str | os.PathLike[str]) -> ReadMission:
    """Read a mission file by the ending of its name; raises FormatError for an ending unknown here.

    >>> import gcs_windplan as gw
    >>> mission = gw.Mission(
    ...     start=(36.55, -84.30), goal=(36.56, -84.28), vehicle=gw.Vehicle(12.0), terrain="flat:300",
    ... )
    >>> file = gw.write(gw.plan(mission), "drawn.plan")
    >>> gw.read_items(file).mission.autopilot
    'ardupilot'
    """
    file = Path(path)
    reader = _READERS.get(file.suffix.lower())
    if reader is None:
        known = ", ".join(_READERS)
        message = f"ends in none of {known}: rename it, or save it as one of them"
        raise FormatError(Problem(message, file=file))
    return reader(file)
