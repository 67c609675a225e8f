"""What is flown: the paper's three cases in the paper's own units, over a terrain of our choice.

The paper publishes the plane (x and y in [-2, 2]), the airspeed of 2, the wind of 1 and its formulas. Terrain, starts,
goals, the number of nodes and the radius of neighbours it does not publish; all of those here are chosen. Lengths are
in the paper's mesh resolutions (mr), speeds in mr/s.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np

from gcs_windplan.arrays import FloatArray
from gcs_windplan.paper.fields import Diverging, Jet, Rotation
from gcs_windplan.scene import Clearance, CollisionTest
from gcs_windplan.terrain import Dem, Extent
from gcs_windplan.terrain.analytic import Hill, hills
from gcs_windplan.vehicle import SpeedModel, Vehicle
from gcs_windplan.wind.field import WindField

AREA: Final = Extent(-2.0, -2.0, 2.0, 2.0)
AIRSPEED: Final = 2.0  # paper, section 4
VEIL_HEIGHT: Final = 0.05  # above the ground
CELL: Final = 0.05  # of the terrain

#: Four broad hills and four crags, the latter steep enough to cut legs of the veil.
HILLS: Final = (
    Hill(-0.6, 0.6, 0.30, 0.50),
    Hill(0.9, -0.5, 0.35, 0.45),
    Hill(0.2, 1.3, 0.25, 0.35),
    Hill(-1.3, -0.3, 0.20, 0.40),
    Hill(0.1, -0.15, 0.45, 0.20),
    Hill(-0.9, -1.3, 0.40, 0.18),
    Hill(1.3, 0.7, 0.40, 0.18),
    Hill(-0.5, 1.7, 0.35, 0.18),
)

PlanePoint = tuple[float, float]


@dataclass(frozen=True, slots=True)
class PaperCase:
    """One of the paper's cases: its `number` there, what the wind is read as, the field, and a start and a goal."""

    number: str
    reading: str
    wind: WindField
    start: PlanePoint
    goal: PlanePoint

    @property
    def title(self) -> str:
        """The case's name: `case 1 (unit)`."""
        return f"case {self.number}" + (f" ({self.reading})" if self.reading else "")


_TAIL: Final = ((-1.8, 0.2), (1.8, 1.6))  # begins in the jet, ends beside it, always eastward

#: The main choices. Case 1 is the first of its three readings; the starts and goals of cases 2 and 3 come from a sweep.
CASES: Final = (
    PaperCase("1", "unit", Jet(), *_TAIL),
    PaperCase("2", "", Diverging(), (-1.8, 0.8), (1.6, -0.2)),
    PaperCase("3", "", Rotation(), (0.8, -2.0), (-2.0, 2.0)),
)

#: Case 1 in the two other readings of (14), from the same start to the same goal.
OTHER_READINGS: Final = (
    PaperCase("1", "magnitude", Jet(reading="magnitude"), *_TAIL),
    PaperCase("1", "literal", Jet(reading="literal"), *_TAIL),
)

#: Case 1 where a sweep came nearest to the printed digits: against the jet, or with (14) taken literally.
NEAR_THE_DIGITS: Final = (
    PaperCase("1", "unit", Jet(), (1.6, 0.2), (-1.4, 0.8)),
    PaperCase("1", "literal", Jet(reading="literal"), (-2.0, -0.2), (1.8, -2.0)),
)


def make_terrain() -> Dem:
    """The simulated terrain."""
    return hills(4.0, CELL, HILLS, name="four hills and four crags")


def make_rules(terrain: Dem, test: CollisionTest | None = None) -> Clearance:
    """Legs must not touch the ground, by one test or the other."""
    return Clearance(terrain, 0.0, test=test)


def make_vehicle(model: SpeedModel = "paper") -> Vehicle:
    """The paper's quadcopter: it climbs and sinks no faster than its airspeed."""
    return Vehicle(AIRSPEED, AIRSPEED, AIRSPEED, speed_model=model)


def lift_to_veil(rules: Clearance, places: FloatArray) -> FloatArray:
    """Places (n, 2) lifted to the veil, (n, 3)."""
    return rules.lifted(np.asarray(places, dtype=np.float64), VEIL_HEIGHT)
