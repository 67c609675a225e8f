"""Terrain from a triangle mesh: a photogrammetric survey, a town model, a CAD drawing."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from gcs_windplan.arrays import FloatArray, IntArray
from gcs_windplan.errors import TerrainError
from gcs_windplan.kernels import meshes, plan_bins
from gcs_windplan.terrain.dem import as_kernel_points
from gcs_windplan.terrain.surface import Extent


@dataclass(frozen=True, slots=True, eq=False)
class PlanBins:
    """Squares over the plan and the boxes that overlap each; see `kernels.plan_bins`."""

    grid: FloatArray
    heads: IntArray
    members: IntArray

    @classmethod
    def over(cls, triangles: FloatArray, margins: FloatArray | float = 0.0) -> PlanBins:
        """Bins for triangles (m, 3, 3) whose boxes are widened by margins (m,) [m]."""
        reach = np.broadcast_to(np.asarray(margins, dtype=np.float64), len(triangles))[:, None] + 1e-6
        low, high = triangles[:, :, :2].min(axis=1) - reach, triangles[:, :, :2].max(axis=1) + reach
        boxes = np.ascontiguousarray(np.hstack([low, high]))
        grid = _bin_grid(boxes)
        return cls(grid, *plan_bins.fill_bins(boxes, grid))


@dataclass(frozen=True, slots=True, eq=False)
class MeshTerrain:
    """A mesh of triangles, a `Terrain`: the ground is its highest surface.

    `vertices` (v, 3) are east, north and height in the local frame [m], `faces` (f, 3) index them. What lies
    beneath a roof or an overhang counts as below the ground. Walls are part of it: a leg across a wall has
    its height over the wall's top.

    Raises TerrainError without faces, for coordinates that are not finite and for faces that name no vertex.
    """

    vertices: FloatArray
    faces: IntArray
    name: str = "mesh"
    vertical_datum: str = "local"
    triangles: FloatArray = field(init=False, repr=False)
    _bins: PlanBins = field(init=False, repr=False)

    def __post_init__(self) -> None:
        triangles = mesh_triangles(self.vertices, self.faces, self.name)
        object.__setattr__(self, "triangles", triangles)
        object.__setattr__(self, "_bins", PlanBins.over(triangles))

    @classmethod
    def read(cls, path: str | Path, vertical_datum: str = "local") -> MeshTerrain:
        """The terrain in an STL, OBJ, PLY or GLB file, in metres of the local frame, z up.

        Raises TerrainError if it cannot be read.
        """
        from gcs_windplan.terrain.meshfile import read_mesh

        return cls(*read_mesh(path), name=Path(path).name, vertical_datum=vertical_datum)

    @property
    def resolution(self) -> float:
        """The side of a square as large as two triangles of the usual size in plan [m]."""
        side, other = (self.triangles[:, k, :2] - self.triangles[:, 0, :2] for k in (1, 2))
        areas = np.abs(side[:, 0] * other[:, 1] - side[:, 1] * other[:, 0])
        lying = areas[areas > 0]
        return math.sqrt(float(np.median(lying))) if len(lying) else 0.0

    @property
    def extent(self) -> Extent:
        """The box around all triangles [m]."""
        low, high = self.triangles.min(axis=(0, 1)), self.triangles.max(axis=(0, 1))
        return Extent(float(low[0]), float(low[1]), float(high[0]), float(high[1]))

    def heights_at(self, places: FloatArray) -> FloatArray:
        """The highest surface at local places (n, 2 or more) [m], shape (n,); NaN where there is none."""
        bins = self._bins
        return meshes.surface_heights(self.triangles, bins.grid, bins.heads, bins.members, as_kernel_points(places))

    def leg_heights(self, starts: FloatArray, ends: FloatArray) -> FloatArray:
        """The smallest and the largest height of legs (n, 3) over the ground, exact, shape (n, 2) [m].

        NaN where a leg leaves the triangles. Negative where it runs below the highest surface, as under a
        bridge. Legs may be vertical or of no length.
        """
        bins = self._bins
        return meshes.surface_leg_heights(
            self.triangles, bins.grid, bins.heads, bins.members, as_kernel_points(starts), as_kernel_points(ends)
        )


def _bin_grid(boxes: FloatArray) -> FloatArray:
    """West, south, side [m], columns, rows: about one bin a box, none much smaller than the usual box."""
    corner, sizes = boxes[:, :2].min(axis=0), boxes[:, 2:] - boxes[:, :2]
    spread = boxes[:, 2:].max(axis=0) - corner
    side = max(math.sqrt(spread[0] * spread[1] / len(boxes)), float(sizes.mean()), spread.max() / 4096)
    return np.array([*corner, side, *(np.floor(spread / side) + 1)])


def mesh_triangles(vertices: FloatArray, faces: IntArray, name: str) -> FloatArray:
    """The corners of faces among vertices, shape (f, 3, 3); TerrainError if they make no mesh."""
    vertices, faces = np.asarray(vertices, dtype=np.float64), np.asarray(faces, dtype=np.int64)
    if vertices.ndim != 2 or vertices.shape[1] != 3 or faces.ndim != 2 or faces.shape[1] != 3:
        shapes = f"{vertices.shape} and {faces.shape}"
        raise TerrainError(f"{name}: a mesh has vertices (v, 3) and faces (f, 3), not {shapes}")
    if len(faces) == 0:
        raise TerrainError(f"{name}: a mesh without faces")
    if faces.min() < 0 or faces.max() >= len(vertices):
        raise TerrainError(f"{name}: faces name vertices {faces.min()} to {faces.max()} of {len(vertices)}")
    triangles = np.ascontiguousarray(vertices[faces])
    if not np.isfinite(triangles).all():
        raise TerrainError(f"{name}: a vertex whose coordinates are not finite numbers")
    return triangles
