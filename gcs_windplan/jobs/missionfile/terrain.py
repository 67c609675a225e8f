"""The terrain and the obstacles that a mission file names."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from gcs_windplan import (
    terrain as ground,  # its readers are imported when first asked for: rasterio and trimesh are heavy
)
from gcs_windplan.errors import InputError, Problem, TerrainError
from gcs_windplan.geo.frame import LocalFrame
from gcs_windplan.jobs.missionfile.parsing import MissionDocument
from gcs_windplan.jobs.missionfile.places import place_of
from gcs_windplan.jobs.missionfile.world import ObstacleModel, SurfaceModel

if TYPE_CHECKING:
    from gcs_windplan.terrain import Dem, Extent, Obstacle, Obstacles, Terrain


def build_terrain(document: MissionDocument, frame: LocalFrame, area: Extent) -> Terrain:
    """The ground, as far as the area needs it; raises `TerrainError`."""
    model = document.model.terrain
    altitude = 0.0 if model.origin is None else model.origin.altitude
    datum = model.vertical_datum
    if model.dem is not None:
        paths = [document.beside(name) for name in model.dem]
        return ground.read_dem(paths, frame, area, nodata=model.nodata, vertical_datum=datum)
    if model.mesh is not None:
        vertices, faces = ground.read_mesh(document.beside(model.mesh))
        return ground.MeshTerrain(vertices + np.array([0.0, 0.0, altitude]), faces, model.mesh, datum or "local")
    if model.surface is not None:
        return _analytic(model.surface, altitude, datum or "local")
    return ground.sample_dem(frame, area)


def _analytic(model: SurfaceModel, altitude: float, datum: str) -> Dem:
    """Gaussian hills on flat ground."""
    tops = [ground.Hill(**hill.model_dump()) for hill in model.hills]
    name = f"{len(tops)} analytic hills" if tops else "flat ground"
    return ground.hills(model.size, model.cell, tops, altitude, name, datum)


def build_obstacles(document: MissionDocument, frame: LocalFrame, terrain: Terrain) -> Obstacles | None:
    """All obstacles, None where there are none; raises `TerrainError` with every one that cannot be used."""
    built, problems = [], []
    for i, model in enumerate(document.model.obstacles):
        try:
            built.append(_obstacle(document, model, frame, terrain))
        except InputError as error:
            problems += [Problem(str(problem), f"obstacles.{i}") for problem in error.problems]
    if problems:
        raise TerrainError(problems)
    return ground.Obstacles(built) if built else None


def _obstacle(document: MissionDocument, model: ObstacleModel, frame: LocalFrame, terrain: Terrain) -> Obstacle:
    """One obstacle, moved to its place; it stands on the lowest ground under its lowest corners."""
    vertices, faces = ground.read_mesh(document.beside(model.mesh))
    east, north = (0.0, 0.0) if model.at is None else place_of(model.at, frame)
    placed = vertices + np.array([east, north, 0.0])
    if model.altitude is not None:
        base = model.altitude
    else:
        feet = placed[vertices[:, 2] <= vertices[:, 2].min() + 1e-6]
        base = float(np.min(terrain.heights_at(feet))) - float(vertices[:, 2].min())
        if not np.isfinite(base):
            raise TerrainError(f"{model.name}: it stands where the terrain is not known; give its altitude")
    return ground.Obstacle(model.name, placed + np.array([0.0, 0.0, base]), faces, model.margin)
