"""The veil: nodes laid over the terrain, and the legs between them that are clear."""

from gcs_windplan.veil.airspace import Airspace, Prism
from gcs_windplan.veil.clearance import BREACHES, Clearance, CollisionTest
from gcs_windplan.veil.grid import GridVeil, Judge, breaches_around, grid_steps, lay_grid, without_legs
from gcs_windplan.veil.prm import SHARE_OF_GRID, PrmVeil, lay_prm, roadmap_radius, without_pairs

__all__ = [
    "BREACHES",
    "SHARE_OF_GRID",
    "Airspace",
    "Clearance",
    "CollisionTest",
    "GridVeil",
    "Judge",
    "Prism",
    "PrmVeil",
    "breaches_around",
    "grid_steps",
    "lay_grid",
    "lay_prm",
    "roadmap_radius",
    "without_legs",
    "without_pairs",
]
