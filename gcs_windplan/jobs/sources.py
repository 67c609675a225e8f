"""What a mission was judged by: its files with their digests, and the program."""

from __future__ import annotations

import hashlib
from collections.abc import Iterator
from pathlib import Path

from gcs_windplan.assessment import Source
from gcs_windplan.jobs.mission import Mission
from gcs_windplan.jobs.terrains import TerrainSource, as_terrain
from gcs_windplan.jobs.vehicles import airframe_path
from gcs_windplan.jobs.winds import WindSource, as_wind


def sources_of_mission(mission: Mission, wind: str, role: str | None = "mission") -> Iterator[Source]:
    """The mission file and the files that it names; without a role it gives its world to another mission."""
    if mission.document is not None:
        detail = "planned by gcs-windplan" if role else "its world and limits"
        yield source(role or "limits", mission.document.file, detail)
    terrain = as_terrain(mission.terrain)
    yield from sources_of_terrain(terrain, terrain.name)
    yield from sources_of_wind(as_wind(mission.wind), wind)
    airframe = airframe_path(mission.vehicle)
    if airframe is not None:
        yield source("vehicle", airframe, "")


def sources_of_terrain(terrain: TerrainSource, name: str, detail: str = "") -> Iterator[Source]:
    """The terrain's files, or its name."""
    yield from (source("terrain", path, detail) for path in terrain.files)
    if not terrain.files:
        yield Source("terrain", name, detail=detail if detail != name else "")


def sources_of_wind(wind: WindSource, name: str) -> Iterator[Source]:
    """The wind's files, or its name."""
    yield from (source("wind", path, name) for path in wind.files)
    if not wind.files:
        yield Source("wind", name)


def source(role: str, path: Path, detail: str) -> Source:
    """A file with its digest."""
    return Source(role, path.name, str(path), _digest(path), detail)


def software() -> Source:
    """The program."""
    from importlib.metadata import version

    return Source("software", f"gcs-windplan {version('gcs-windplan')}")


def _digest(path: Path) -> str | None:
    """The file's SHA-256, None where it cannot be read."""
    try:
        with path.open("rb") as stream:
            return hashlib.file_digest(stream, "sha256").hexdigest()
    except OSError:
        return None
