"""The paper's two graphs: nodes on a square grid or at random, joined to all within a radius r_s, (4)."""

from __future__ import annotations

from typing import Final

import numpy as np

from gcs_windplan.arrays import FloatArray
from gcs_windplan.paper.cases import AREA, VEIL_HEIGHT, lift_to_veil
from gcs_windplan.planning.veil import SHARE_OF_GRID, PrmVeil, lay_prm
from gcs_windplan.scene import Clearance

SPACING: Final = 0.2  # of the uniform graph: 21 x 21 nodes

# radii in spacings of the uniform graph
EIGHT: Final = 1.5  # joins the 8 nodes around
TWENTY: Final = 2.3  # the 20 nearest
THIRTY_SIX: Final = 3.2  # the 36 nearest
ROADMAP: Final = 2.25  # about 12 random nodes in the mean: random places need more to be connected

SEED: Final = 52  # of the main roadmap


def lay_uniform(rules: Clearance, sites: FloatArray, spacing: float = SPACING, radius: float = EIGHT) -> PrmVeil:
    """The uniform graph with all neighbours within `radius` spacings; the sites (n, 3) replace nodes at their places.

    Unlike `lay_grid`, which keeps one neighbour in each direction, it has all that (4) asks for: along a straight
    line the next node and the one after it. The angle (10) is counted once an edge, so that matters to it.
    """
    side = np.linspace(AREA.west, AREA.east, 1 + round((AREA.east - AREA.west) / spacing))
    places = np.stack(np.meshgrid(side, side), axis=-1).reshape(-1, 2)
    apart = np.linalg.norm(places[:, None] - sites[None, :, :2], axis=2).min(axis=1)
    nodes = np.concatenate([sites, lift_to_veil(rules, places[apart > 1e-6 * spacing])])
    return lay_prm(rules, AREA, 0, 0, (VEIL_HEIGHT,), nodes, radius * spacing)


def lay_roadmap(
    rules: Clearance, sites: FloatArray, seed: int = SEED, spacing: float = SPACING, radius: float = ROADMAP
) -> PrmVeil:
    """The PRM graph: three quarters of the uniform graph's nodes, the sites among them."""
    side = 1 + round((AREA.east - AREA.west) / spacing)
    nodes = round(SHARE_OF_GRID * side * side) - len(sites)
    return lay_prm(rules, AREA, nodes, seed, (VEIL_HEIGHT,), sites, radius * spacing)
