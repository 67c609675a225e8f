"""What a leg must keep clear of; the one judge that veil, shaping and flight share."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Final, Protocol

import numpy as np

from gcs_windplan.arrays import BoolArray, FlagArray, FloatArray
from gcs_windplan.scene.airspace import Airspace

if TYPE_CHECKING:
    from gcs_windplan.terrain import Extent, Obstacles, Terrain

TOO_LOW: Final = 1
UNKNOWN_GROUND: Final = 2
TOO_HIGH: Final = 4
OBSTACLE: Final = 8
AIRSPACE: Final = 16
OUTSIDE: Final = 32
TOO_WINDY: Final = 64  # of edges that a search found closed: none of the rules below knows of wind

BREACHES: Final = {
    TOO_LOW: "terrain (closer to the ground than the clearance)",
    UNKNOWN_GROUND: "unknown ground (no data in the terrain, or outside of it)",
    TOO_HIGH: "height limit (higher above ground than limits.max_height)",
    OBSTACLE: "obstacle (closer than its margin)",
    AIRSPACE: "keep-out or keep-in area",
    OUTSIDE: "edge of the area (the sites' box with graph.margin)",
    TOO_WINDY: "wind limit",
}

_SLACK = 1e-6  # [m] a node laid at exactly the clearance is clear


class CollisionTest(Protocol):
    """Another way than the exact one to find the legs that are too low, with a note for whoever flies by it."""

    @property
    def note(self) -> str:
        """What a pilot must know of it."""
        ...

    def too_low(self, terrain: Terrain, starts: FloatArray, ends: FloatArray) -> BoolArray:
        """Which legs (n, 3) are too low, shape (n,)."""
        ...


@dataclass(frozen=True, slots=True)
class Clearance:
    """The rules for a leg over one terrain.

    `minimum` is the smallest, `maximum` the largest vertical distance to the ground [m] anywhere along the leg;
    obstacles keep their own margins. All tests are exact: nothing is sampled. Legs stay inside `area`, if there is one:
    beyond it neither wind nor ground need be known.

    With a `test` of its own a leg is too low only where that says so; `minimum` then only lifts nodes above obstacles.
    """

    terrain: Terrain
    minimum: float
    maximum: float = np.inf
    obstacles: Obstacles | None = None
    airspace: Airspace = field(default_factory=Airspace)
    test: CollisionTest | None = None
    area: Extent | None = None

    def breaches(self, starts: FloatArray, ends: FloatArray) -> FlagArray:
        """What legs (n, 3) break, shape (n,): 0, or a sum of the flags in `BREACHES`."""
        starts = np.ascontiguousarray(starts, dtype=np.float64)
        ends = np.ascontiguousarray(ends, dtype=np.float64)
        heights = self.terrain.leg_heights(starts, ends)
        low, high = heights[:, 0], heights[:, 1]
        flags = np.zeros(len(starts), dtype=np.uint8)
        flags |= np.where(np.isnan(low), UNKNOWN_GROUND, 0).astype(np.uint8)
        flags |= np.where(self._too_low(starts, ends, low), TOO_LOW, 0).astype(np.uint8)
        flags |= np.where(high > self.maximum + _SLACK, TOO_HIGH, 0).astype(np.uint8)
        if self.obstacles is not None:
            margins = self.obstacles.leg_margins(starts, ends)
            flags |= np.where(margins < -_SLACK, OBSTACLE, 0).astype(np.uint8)
        if self.airspace.keep_out or self.airspace.keep_in:
            flags |= np.where(self.airspace.breaches(starts, ends), AIRSPACE, 0).astype(np.uint8)
        if self.area is not None:
            flags |= np.where(_beyond(self.area, starts) | _beyond(self.area, ends), OUTSIDE, 0).astype(np.uint8)
        return flags

    def _too_low(self, starts: FloatArray, ends: FloatArray, low: FloatArray) -> BoolArray:
        """Which legs (n, 3), whose smallest heights are `low` (n,), come too close to the ground."""
        if self.test is None:
            return low < self.minimum - _SLACK
        return self.test.too_low(self.terrain, starts, ends)

    def lifted(self, places: FloatArray, height: float) -> FloatArray:
        """Points (n, 3) at a height over the ground [m], lifted above obstacles where they would be inside one."""
        ground = self.terrain.heights_at(places)
        z = ground + height
        if self.obstacles is not None:
            z = np.maximum(z, self.obstacles.clear_heights_at(places, self.minimum))
        return np.column_stack([places[:, :2], z])


def _beyond(area: Extent, points: FloatArray) -> BoolArray:
    """Which points (n, 3) lie outside of a box."""
    east, north = points[:, 0], points[:, 1]
    outside: BoolArray = (east < area.west - _SLACK) | (east > area.east + _SLACK)
    return outside | (north < area.south - _SLACK) | (north > area.north + _SLACK)
