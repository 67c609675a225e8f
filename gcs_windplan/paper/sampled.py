"""The paper's test for collisions: equations (5) to (8), points along the leg against triangles.

Equation (5) as printed selects triangles inside of the box of the two nodes, and so assumes that the first
node has the smaller coordinates and misses triangles larger than the box. Here the boxes need to overlap.
Equation (8) compares areas: a point lies in a triangle if the three triangles that it makes with the sides
add up to the whole.

The areas are equal only for a point exactly in the triangle, and a leg's samples hardly ever are. The
tolerance on (8) is therefore part of the method: the sum may exceed the area by the fraction `tolerance`.
Near the middle of a triangle with sides L that reaches about 0.4 L sqrt(tolerance) to both sides of it, so a
leg with a step longer than twice that may pass through unseen. `Terrain.leg_heights` sees every one; this method is
kept for comparison with the paper.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, cast

import numpy as np

from gcs_windplan.arrays import BoolArray, FloatArray
from gcs_windplan.errors import InputError
from gcs_windplan.kernels import area_test
from gcs_windplan.terrain.dem import Dem, as_kernel_points
from gcs_windplan.terrain.mesh import MeshTerrain, PlanBins

if TYPE_CHECKING:
    from gcs_windplan.terrain import Terrain


@dataclass(frozen=True, slots=True)
class SampledTest:
    """The paper's test as a `CollisionTest`: a leg is too low where it touches a triangle of the ground at a sample.

    `samples` of a leg on the length of a terrain's cell. It lets legs through thin ridges: for comparison.
    """

    samples: int = 4

    @property
    def note(self) -> str:
        """What a pilot must know of it."""
        return "the collision test `paper` samples: a leg may pass through a thin ridge. Fly with `exact`."

    def too_low(self, terrain: Terrain, starts: FloatArray, ends: FloatArray) -> BoolArray:
        """Which legs (n, 3) touch the ground, shape (n,)."""
        return sampled_collisions(cast("Dem | MeshTerrain", terrain), starts, ends, terrain.resolution / self.samples)


def sampled_collisions(
    ground: Dem | MeshTerrain | FloatArray,
    starts: FloatArray,
    ends: FloatArray,
    step: float,
    tolerance: float = 1e-3,
) -> BoolArray:
    """Which legs (n, 3) meet the ground at one of their samples, shape (n,).

    `ground` is a terrain or its triangles (m, 3, 3) [m]. Samples lie `step` [m] apart from the start on, and
    at the end. `tolerance` is the relative excess of the sum of areas that still counts as equal. A leg that
    runs wholly below the ground meets nothing. Raises InputError for a step that is not positive or a
    negative tolerance.
    """
    if not step > 0 or not tolerance >= 0:
        raise InputError(f"step {step} m must be positive, tolerance {tolerance} must not be negative")
    triangles = _triangles(ground)
    bins = PlanBins.over(triangles)
    return area_test.sampled_collisions(
        triangles,
        bins.grid,
        bins.heads,
        bins.members,
        as_kernel_points(starts),
        as_kernel_points(ends),
        step,
        tolerance,
    )


def _triangles(ground: Dem | MeshTerrain | FloatArray) -> FloatArray:
    if isinstance(ground, Dem):
        return ground.triangles()
    if isinstance(ground, MeshTerrain):
        return ground.triangles
    triangles = np.ascontiguousarray(ground, dtype=np.float64)
    if triangles.ndim != 3 or triangles.shape[1:] != (3, 3) or len(triangles) == 0:
        raise InputError(f"triangles come as (m, 3, 3) with m of 1 or more, not {triangles.shape}")
    return triangles
