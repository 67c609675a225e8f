"""The veil: nodes laid over the terrain, and the legs between them that are clear."""

from gcs_windplan.planning.veil.grid import GridVeil, Judge, breaches_around, grid_steps, lay_grid, without_legs
from gcs_windplan.planning.veil.prm import SHARE_OF_GRID, PrmVeil, lay_prm, roadmap_radius, without_pairs

__all__ = [
    "SHARE_OF_GRID",
    "GridVeil",
    "Judge",
    "PrmVeil",
    "breaches_around",
    "grid_steps",
    "lay_grid",
    "lay_prm",
    "roadmap_radius",
    "without_legs",
    "without_pairs",
]
