"""What stands on the ground: closed meshes with a margin to keep from each."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from gcs_windplan.arrays import FloatArray, IntArray
from gcs_windplan.errors import TerrainError
from gcs_windplan.kernels import solids
from gcs_windplan.terrain.boxtree import BoxTree
from gcs_windplan.terrain.dem import as_kernel_points
from gcs_windplan.terrain.mesh import PlanBins, mesh_triangles


@dataclass(frozen=True, slots=True, eq=False)
class Obstacle:
    """A building, a mast, a line of trees: a closed mesh in the local frame, heights AMSL [m].

    `margin` is the distance to keep from it [m], in every direction. Raises TerrainError if the mesh is not
    closed (its inside would be unknown) or the margin is negative. Nothing is repaired.
    """

    name: str
    vertices: FloatArray
    faces: IntArray
    margin: float

    def __post_init__(self) -> None:
        from gcs_windplan.terrain.meshfile import open_sides

        mesh_triangles(self.vertices, self.faces, self.name)
        if not (self.margin >= 0 and math.isfinite(self.margin)):
            raise TerrainError(f"{self.name}: a margin of {self.margin} m; it must be 0 or more")
        gaps = open_sides(self.vertices, self.faces)
        if gaps:
            raise TerrainError(
                f"{self.name}: the mesh is not closed, {gaps} of its edges do not join two faces; "
                "close it where it was made (Blender: 3D Print Toolbox, Make Manifold)"
            )

    @classmethod
    def read(cls, path: str | Path, margin: float, name: str | None = None) -> Obstacle:
        """The obstacle in an STL, OBJ, PLY or GLB file, in metres of the local frame, z up.

        Raises TerrainError if it cannot be read or is not closed.
        """
        from gcs_windplan.terrain.meshfile import read_mesh

        return cls(Path(path).name if name is None else name, *read_mesh(path), margin)


@dataclass(frozen=True, slots=True, eq=False)
class Obstacles:
    """All obstacles of a mission. There may be none."""

    items: tuple[Obstacle, ...]
    triangles: FloatArray = field(init=False, repr=False)
    _owners: IntArray = field(init=False, repr=False)
    _margins: FloatArray = field(init=False, repr=False)
    _bins: PlanBins = field(init=False, repr=False)
    _tree: BoxTree = field(init=False, repr=False)

    def __init__(self, items: Sequence[Obstacle] = ()) -> None:
        object.__setattr__(self, "items", tuple(items))
        if self.items:
            self._index()

    def _index(self) -> None:
        parts = [mesh_triangles(item.vertices, item.faces, item.name) for item in self.items]
        triangles = np.concatenate(parts)
        counts = [len(part) for part in parts]
        margins = np.repeat(np.array([item.margin for item in self.items], dtype=np.float64), counts)
        boxes = np.ascontiguousarray(np.hstack([triangles.min(axis=1), triangles.max(axis=1)]))
        object.__setattr__(self, "triangles", triangles)
        object.__setattr__(self, "_owners", np.repeat(np.arange(len(parts)), counts))
        object.__setattr__(self, "_margins", margins)
        object.__setattr__(self, "_bins", PlanBins.over(triangles, margins))
        object.__setattr__(self, "_tree", BoxTree.over(boxes, margins))

    def __len__(self) -> int:
        return len(self.items)

    def tops_at(self, places: FloatArray) -> FloatArray:
        """The highest obstacle surface around places (n, 2 or more) [m], shape (n,); -inf where none is near.

        Near is at most the obstacle's margin away in plan, so a place beside a wall has the wall's top.
        """
        return self._tops(places, np.zeros(len(self.items)))

    def clear_heights_at(self, places: FloatArray, minimum: float = 0.0) -> FloatArray:
        """The height from which on places are clear of obstacles [m], shape (n,); -inf where none is near.

        Above each surface of `tops_at` by the obstacle's margin or by `minimum` [m], whichever is more.
        """
        return self._tops(places, np.array([max(item.margin, minimum) for item in self.items]))

    def _tops(self, places: FloatArray, lifts: FloatArray) -> FloatArray:
        places = as_kernel_points(places)
        if not self.items:
            return np.full(len(places), -np.inf)
        bins = self._bins
        return solids.solid_tops(
            self.triangles, self._margins, lifts[self._owners], bins.grid, bins.heads, bins.members, places
        )

    def leg_margins(self, starts: FloatArray, ends: FloatArray) -> FloatArray:
        """The least distance of legs (n, 3) from any obstacle, less that obstacle's margin [m], shape (n,).

        Exact, in three dimensions. Negative where a leg comes closer than the margin. A leg that touches,
        pierces or runs inside of an obstacle counts as 1 mm inside, so that it is negative with no margin
        too. +inf without obstacles.
        """
        starts, ends = as_kernel_points(starts), as_kernel_points(ends)
        if not self.items:
            return np.full(len(starts), np.inf)
        bins, tree = self._bins, self._tree
        return solids.solid_leg_margins(
            self.triangles,
            self._owners,
            self._margins,
            bins.grid,
            bins.heads,
            bins.members,
            tree.bounds,
            tree.links,
            tree.order,
            starts,
            ends,
        )
