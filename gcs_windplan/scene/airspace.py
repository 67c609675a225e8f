"""Keep-out and keep-in areas: polygons with a floor and a ceiling."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from gcs_windplan.arrays import BoolArray, FloatArray
from gcs_windplan.errors import InputError
from gcs_windplan.kernels.airspace import legs_leaving, legs_through


@dataclass(frozen=True, slots=True, eq=False)
class Prism:
    """A polygon in the local frame, corners (k, 2) [m], between floor and ceiling [m above mean sea level]."""

    name: str
    corners: FloatArray
    floor: float = -np.inf
    ceiling: float = np.inf

    def __post_init__(self) -> None:
        if self.corners.ndim != 2 or self.corners.shape[1] != 2 or len(self.corners) < 3:
            raise InputError(f"area '{self.name}' needs at least 3 corners")
        if not np.isfinite(self.corners).all():
            raise InputError(f"area '{self.name}' has a corner that is no number")
        if not self.floor < self.ceiling:
            raise InputError(f"area '{self.name}' has its ceiling at or below its floor")
        from shapely.geometry import Polygon  # half a second of import, for missions with areas only
        from shapely.validation import explain_validity

        shape = Polygon(self.corners)
        if not shape.is_valid or shape.area == 0:
            raise InputError(f"area '{self.name}' is no simple polygon ({explain_validity(shape)})")

    def __str__(self) -> str:
        return self.name

    def widened(self, margin: float) -> Prism:
        """The prism with its border moved outwards by `margin` [m], inwards where that is negative."""
        if margin == 0:
            return self
        from shapely.geometry import Polygon

        moved = Polygon(self.corners).buffer(margin, join_style="mitre")
        if moved.is_empty or moved.geom_type != "Polygon":
            raise InputError(f"area '{self.name}' is too narrow for a margin of {abs(margin):g} m: lower it")
        return Prism(self.name, np.array(moved.exterior.coords)[:-1, :2], self.floor, self.ceiling)


@dataclass(frozen=True, slots=True)
class Airspace:
    """Where legs may not be: inside any keep-out, or outside any keep-in (each keep-in binds)."""

    keep_out: tuple[Prism, ...] = field(default=())
    keep_in: tuple[Prism, ...] = field(default=())

    def breaches(self, starts: FloatArray, ends: FloatArray) -> BoolArray:
        """Which legs (n, 3) enter a keep-out or leave a keep-in, shape (n,)."""
        broken = np.zeros(len(starts), dtype=np.bool_)
        for prism in self.keep_out:
            broken |= legs_through(prism.corners, prism.floor, prism.ceiling, starts, ends)
        for prism in self.keep_in:
            broken |= legs_leaving(prism.corners, prism.floor, prism.ceiling, starts, ends)
        return broken

    def broken_by(self, start: FloatArray, end: FloatArray) -> tuple[str, ...]:
        """The names of the areas that one leg, (3,) to (3,), breaks."""
        a, b = start[None], end[None]
        out = [p.name for p in self.keep_out if legs_through(p.corners, p.floor, p.ceiling, a, b)[0]]
        left = [p.name for p in self.keep_in if legs_leaving(p.corners, p.floor, p.ceiling, a, b)[0]]
        return tuple(out + left)
