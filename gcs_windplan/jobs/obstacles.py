"""Obstacles: closed meshes in files, set on the terrain."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from gcs_windplan import terrain as ground  # its readers are imported when first asked for: trimesh is heavy
from gcs_windplan.errors import InputError, Problem, TerrainError
from gcs_windplan.geo.frame import LocalFrame
from gcs_windplan.jobs.places import PlaceWords, as_place

if TYPE_CHECKING:
    from gcs_windplan.terrain import Obstacle, Obstacles, Terrain


@dataclass(frozen=True, slots=True)
class ObstacleFile:
    """A closed mesh (.stl, .obj, .ply, .glb; metres, z up) that stands on the terrain.

    The mesh's origin is `at` a place, or at the local origin; its z = 0 at `altitude` above mean sea level [m], without
    one it stands on the lowest ground under its lowest corners. Legs keep `margin` [m] from it.

    >>> import gcs_windplan as gw
    >>> gw.ObstacleFile("tower", "tower.glb", at=(46.81, 9.84)).margin
    5.0
    """

    name: str
    path: Path | str
    at: PlaceWords | None = None
    altitude: float | None = None
    margin: float = 5.0


def load_obstacles(files: Sequence[ObstacleFile], frame: LocalFrame, terrain: Terrain) -> Obstacles | None:
    """All obstacles, None where there are none; raises `TerrainError` with every one that cannot be used."""
    built, problems = [], []
    for i, file in enumerate(files):
        try:
            built.append(_load(file, frame, terrain))
        except InputError as error:
            problems += [Problem(str(problem), f"obstacles.{i}") for problem in error.problems]
    if problems:
        raise TerrainError(problems)
    return ground.Obstacles(built) if built else None


def _load(file: ObstacleFile, frame: LocalFrame, terrain: Terrain) -> Obstacle:
    """One obstacle, moved to its place."""
    vertices, faces = ground.read_mesh(Path(file.path))
    east, north = (0.0, 0.0) if file.at is None else as_place(file.at).east_north(frame)
    placed = vertices + np.array([east, north, 0.0])
    if file.altitude is not None:
        base = file.altitude
    else:
        feet = placed[vertices[:, 2] <= vertices[:, 2].min() + 1e-6]
        base = float(np.min(terrain.heights_at(feet))) - float(vertices[:, 2].min())
        if not np.isfinite(base):
            raise TerrainError(f"{file.name}: it stands where the terrain is not known; give its altitude")
    return ground.Obstacle(file.name, placed + np.array([0.0, 0.0, base]), faces, file.margin)
