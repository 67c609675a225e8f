"""The probabilistic roadmap: random nodes at veil height, joined to all within a radius (Kavraki 1996; the paper's
(4))."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from gcs_windplan.arrays import FlagArray, FloatArray, IntArray
from gcs_windplan.planning.veil.grid import Judge
from gcs_windplan.scene.clearance import TOO_WINDY, Clearance
from gcs_windplan.terrain import Extent

#: The paper gives the roadmap three quarters of the uniform grid's nodes.
SHARE_OF_GRID = 0.75


@dataclass(frozen=True, slots=True, eq=False)
class PrmVeil:
    """Nodes `points` (n, 3), the sites first; node i's clear neighbours are neighbours[first[i] : first[i + 1]].

    `pairs` (m, 2) are all pairs within the radius, `flags` (m,) what the leg between them breaks.
    """

    points: FloatArray
    first: IntArray
    neighbours: IntArray
    radius: float
    pairs: IntArray
    flags: FlagArray
    clearance: Clearance

    @property
    def size(self) -> int:
        """How many nodes there are."""
        return len(self.points)

    @property
    def edge_length(self) -> float:
        """The length of an ordinary edge [m]: the mean distance to a neighbour in a disc, two thirds of its radius."""
        return self.radius * 2 / 3


def roadmap_radius(nodes: int, area: Extent) -> float:
    """A radius [m] that joins each of `nodes` random places to about 3 ln n others.

    A random geometric graph becomes connected at ln n of them (Penrose 1997, doi:10.1214/aoap/1034625335); three
    times as many leave room for the legs that are not clear.
    """
    surface = (area.east - area.west) * (area.north - area.south)
    return math.sqrt(3.0 * surface / math.pi * math.log(max(nodes, 2)) / nodes)


def lay_prm(
    clearance: Clearance,
    area: Extent,
    nodes: int,
    seed: int,
    layers: Sequence[float],
    sites: FloatArray,
    radius: float | None = None,
) -> PrmVeil:
    """Scatter `nodes` places over an area, lift each to every layer's height above ground [m], and join them.

    `sites` (k, 3) become the first k nodes. The same seed gives the same roadmap.
    """
    from scipy.spatial import cKDTree  # half a second of import, for roadmaps only

    places = np.random.default_rng(seed).uniform((area.west, area.south), (area.east, area.north), size=(nodes, 2))
    sheets = [clearance.lifted(places, layer) for layer in layers]
    points = np.concatenate([sites, *sheets])
    points = points[np.isfinite(points).all(axis=1)]
    if radius is None:
        radius = roadmap_radius(nodes, area)
    pairs = cKDTree(points).query_pairs(radius, output_type="ndarray").astype(np.int64)
    flags = clearance.breaches(points[pairs[:, 0]], points[pairs[:, 1]])
    first, neighbours = _join(len(points), pairs[flags == 0])
    return PrmVeil(points, first, neighbours, radius, pairs, flags, clearance)


def without_pairs(veil: PrmVeil, nodes: IntArray, closed: Judge) -> PrmVeil:
    """The roadmap without those edges of the given nodes that are closed in either direction."""
    chosen = np.zeros(veil.size, dtype=np.bool_)
    chosen[nodes] = True
    a, b = veil.pairs[:, 0], veil.pairs[:, 1]
    known = np.flatnonzero((veil.flags == 0) & (chosen[a] | chosen[b]))
    there, back = veil.points[a[known]], veil.points[b[known]]
    flags = veil.flags.copy()
    flags[known[closed(there, back) | closed(back, there)]] = TOO_WINDY
    first, neighbours = _join(veil.size, veil.pairs[flags == 0])
    return replace(veil, first=first, neighbours=neighbours, flags=flags)


def _join(size: int, pairs: IntArray) -> tuple[IntArray, IntArray]:
    """Both directions of each pair, sorted by node and neighbour, so that the search is deterministic."""
    both = np.concatenate([pairs, pairs[:, ::-1]])
    both = both[np.lexsort((both[:, 1], both[:, 0]))]
    first = np.zeros(size + 1, dtype=np.int64)
    np.cumsum(np.bincount(both[:, 0], minlength=size), out=first[1:])
    return first, np.ascontiguousarray(both[:, 1])
