"""Cases whose least time is known to 4 digits or more: what a perfect planner would reach.

The fields:

    1, 1b, 1c, 2, 3   the paper's fields (14)-(16), from (-1.8, -1.8) to (1.8, 1.8) and back at V = 2
    rotation          Techy 2011: ω = -0.9, along the unit circle from 30° to 90° at V = 1
    vortices          Ferraro 2021: four eddies, from (0, 0) to (6, 2) at V = 1
    shear             wind (y, 0), from (0, 0) to (1, 0) at V = 1
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from gcs_windplan.arrays import FloatArray
from gcs_windplan.paper.fields import Diverging, Jet, Rotation
from gcs_windplan.planning.cost import CostChoice, SectionCost
from gcs_windplan.planning.search import find_path, sample_wind
from gcs_windplan.planning.shaping import shape
from gcs_windplan.planning.veil import lay_grid
from gcs_windplan.scene import Clearance
from gcs_windplan.terrain import Dem, Extent
from gcs_windplan.vehicle import SpeedModel, Vehicle
from gcs_windplan.wind.field import Steady, WindField
from tests.oracles.zermelo import PlaneWind

_GROUND = Clearance(Dem.local(np.full((21, 21), -10.0), -10.0, 10.0, 1.0), 1.0)  # flat, and far below
_LAYER = 10.0  # above it: at 0, as start and goal are


@dataclass(frozen=True)
class PlaneField(Steady):
    """A wind given by a formula for the plane."""

    formula: PlaneWind
    name: str
    resolution: float = 0.05

    def at(self, points: FloatArray, seconds: float | FloatArray = 0.0) -> FloatArray:
        east, north = self.formula(points[:, 0], points[:, 1])
        return np.stack([east, north, np.zeros_like(east)], axis=-1)


@dataclass(frozen=True)
class Limit:
    """A case with its least time [s].

    `formula` is the wind written down once more, where it is smooth; `area` is what a grid must cover.
    """

    case: str
    way: str
    model: SpeedModel
    seconds: float
    wind: WindField
    formula: PlaneWind | None
    start: tuple[float, float]
    goal: tuple[float, float]
    airspeed: float
    area: Extent

    def __str__(self) -> str:
        return f"{self.case}-{self.way}-{self.model}"

    def route(self, nodes: int = 101, neighbours: int = 16) -> tuple[SectionCost, FloatArray, FloatArray]:
        """The cost, the path through a square grid with so many nodes a side, and that path shaped."""
        spacing = (self.area.east - self.area.west) / (nodes - 1)
        veil = lay_grid(_GROUND, self.area, spacing, (_LAYER,), neighbours)
        start, goal = (np.array([*place, 0.0]) for place in (self.start, self.goal))
        vehicle = Vehicle(self.airspeed, 9.0, 9.0, speed_model=self.model)
        cost = SectionCost(CostChoice("time"), self.wind, vehicle, veil.edge_length, math.dist(self.start, self.goal))
        path = find_path(sample_wind(veil, self.wind), cost, start, goal).points
        return cost, path, shape(path, cost, _GROUND)


def _vortices(x: FloatArray, y: FloatArray) -> tuple[FloatArray, FloatArray]:
    u, v = np.zeros_like(x), np.zeros_like(x)
    for sense, a, b in ((-1, 2, 2), (-1, 4, 4), (-1, 2, 5), (1, 5, 1)):
        share = 1.7 * sense / (3 * ((x - a) ** 2 + (y - b) ** 2) + 1)
        u, v = u - share * (y - b), v + share * (x - a)
    return u, v


def _published() -> list[Limit]:
    """Every case of every field, both ways, both speed models."""
    # wind, its formula; triangle there and back, paper's model (12) there and back
    rows = {
        "1": (Jet(), None, 2.15586, 3.10560, 2.11635, 2.91730),
        "1b": (
            Jet(reading="magnitude"), lambda x, y: (np.maximum(1 - y**2, 0), np.zeros_like(x)),
            2.25918, 2.90493, 2.23790, 2.81118,
        ),
        "1c": (Jet(reading="literal"), None, 2.38284, 2.52390, 2.23220, 2.34957),
        "2": (
            Diverging(), lambda x, y: ((x - 2) / np.hypot(x - 2, x + 1), (x + 1) / np.hypot(x - 2, x + 1)),
            3.35001, 2.50569, 3.05530, 2.26620,
        ),
        "3": (
            Rotation(), lambda x, y: (-y / np.hypot(x, y), x / np.hypot(x, y)),
            2.07016, 2.07016, 1.99611, 1.99611,
        ),
    }  # fmt: skip
    corner, square = (1.8, 1.8), Extent(-2, -2, 2, 2)
    opposite = (-corner[0], -corner[1])
    limits = []
    for case, (wind, formula, *seconds) in rows.items():
        for model, there, back in (("triangle", *seconds[:2]), ("paper", *seconds[2:])):
            limits.append(Limit(case, "fwd", model, there, wind, formula, opposite, corner, 2.0, square))
            limits.append(Limit(case, "rev", model, back, wind, formula, corner, opposite, 2.0, square))
    return limits


def _other() -> list[Limit]:
    """Instances from elsewhere."""
    thirty = (math.cos(math.pi / 6), math.sin(math.pi / 6))
    rows = [
        ("rotation", 1.974938, lambda x, y: (0.9 * y, -0.9 * x), thirty, (0.0, 1.0), Extent(-1.1, -1.1, 1.1, 1.1)),
        ("vortices", 8.950, _vortices, (0.0, 0.0), (6.0, 2.0), Extent(-1, -1, 7, 7)),
        ("shear", 0.9639, lambda x, y: (y, np.zeros_like(x)), (0.0, 0.0), (1.0, 0.0), Extent(-0.5, -1, 1.5, 1)),
    ]
    return [
        Limit(case, "fwd", "triangle", seconds, PlaneField(formula, case), formula, start, goal, 1.0, area)
        for case, seconds, formula, start, goal, area in rows
    ]


PAPER = _published()
OTHERS = _other()
