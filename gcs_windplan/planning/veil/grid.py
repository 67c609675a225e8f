"""The uniform veil: a square grid of nodes, laid over the terrain once or in several layers.

Seen from above, a node's neighbours in 8, 16, 32 or 64 directions (one quarter shown, node at o). Each set adds to the
one before it the sums of two steps side by side. The directions then lie at most 45, 27, 18 or 14 degrees apart.

    8:  . .    16: . 2 .   32: . 3 3 .   64: . . 4 4 . .
        1 1        1 1 2       . 2 . 3       . 4 . 4 . .
        o 1        o 1 .       1 1 2 3       . 3 3 . 4 4
                               o 1 . .       . 2 . 3 . 4
                                             1 1 2 3 4 .
                                             o 1 . . . .

To the layers above and below it has the node straight over it and that one's 8 neighbours.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from typing import Any, Final, NamedTuple, TypeAlias

import numpy as np

from gcs_windplan.arrays import BoolArray, FlagArray, FloatArray, IntArray, MaskArray
from gcs_windplan.cores import spread
from gcs_windplan.errors import InputError
from gcs_windplan.progress import UNTRACKED, Tracker
from gcs_windplan.scene.clearance import TOO_WINDY, Clearance
from gcs_windplan.terrain import Extent

_BATCH = 100_000  # legs judged at a time, so that memory stays bounded
NEIGHBOURS: Final = (8, 16, 32, 64)

#: Says of legs, starts and ends (n, 3), which are closed (n,).
Judge: TypeAlias = Callable[[FloatArray, FloatArray], BoolArray]


def grid_steps(neighbours: int, layered: bool) -> IntArray:
    """The moves in (layers, rows, columns), shape (2 m, 3); move k + m undoes move k."""
    if neighbours not in NEIGHBOURS:
        raise InputError(f"{neighbours} neighbours are not offered, choose 8, 16, 32 or 64")
    around = [(0, 1), (1, 0), (0, -1), (-1, 0)]  # rows, columns; step by step around the node
    while len(around) < neighbours:
        after = [*around[1:], around[0]]
        around = [step for (r, c), (s, d) in zip(around, after, strict=True) for step in ((r, c), (r + s, c + d))]
    forward = [(0, r, c) for r, c in sorted(around) if r > 0 or (r == 0 and c > 0)]
    if layered:
        forward += [(1, r, c) for r in (-1, 0, 1) for c in (-1, 0, 1)]
    steps = np.array(forward, dtype=np.int64)
    return np.concatenate([steps, -steps])


@dataclass(frozen=True, slots=True, eq=False)
class GridVeil:
    """Nodes in layers, rows (to the north) and columns (to the east).

    `corner` east and north of the first node, `spacing` [m]; `heights` (layers, rows, columns) above mean sea level
    [m], NaN over unknown ground; `steps` as from `grid_steps`; `legal` (nodes,) bit k set: the leg of step k is
    clear.
    """

    corner: FloatArray
    spacing: float
    heights: FloatArray
    steps: IntArray
    legal: MaskArray
    clearance: Clearance

    @property
    def size(self) -> int:
        """How many nodes there are."""
        return self.heights.size

    @property
    def edge_length(self) -> float:
        """The length of an ordinary edge [m]."""
        return self.spacing

    @property
    def points(self) -> FloatArray:
        """All nodes, shape (n, 3): layers, then rows, then columns."""
        return self.points_of(np.arange(self.size))

    def points_of(self, nodes: IntArray) -> FloatArray:
        """Nodes by number, shape (n, 3)."""
        _, rows, columns = self.heights.shape
        place = nodes % (rows * columns)
        east = self.corner[0] + (place % columns) * self.spacing
        north = self.corner[1] + (place // columns) * self.spacing
        return np.column_stack([east, north, self.heights.ravel()[nodes]])

    def near(self, place: FloatArray, radius: float) -> IntArray:
        """The nodes of all layers within `radius` [m] of a place in plan."""
        layers, rows, columns = self.heights.shape
        column, row = (place[:2] - self.corner) / self.spacing
        reach = radius / self.spacing
        cs = np.arange(max(0, math.ceil(column - reach)), min(columns, math.floor(column + reach) + 1))
        rs = np.arange(max(0, math.ceil(row - reach)), min(rows, math.floor(row + reach) + 1))
        r, c = np.meshgrid(rs, cs, indexing="ij")
        close = np.hypot(r - row, c - column) <= reach
        sheet = (r * columns + c)[close]
        nodes: IntArray = (np.arange(layers)[:, None] * (rows * columns) + sheet[None, :]).ravel()
        return nodes


def lay_grid(
    clearance: Clearance,
    area: Extent,
    spacing: float,
    layers: Sequence[float],
    neighbours: int = 16,
    *,
    tracker: Tracker = UNTRACKED,
) -> GridVeil:
    """Lay a uniform veil over an area, each layer at its height above ground [m], and judge every leg once."""
    columns = 1 + math.floor((area.east - area.west) / spacing + 1e-9)
    rows = 1 + math.floor((area.north - area.south) / spacing + 1e-9)
    corner = np.array(
        [
            0.5 * (area.west + area.east - (columns - 1) * spacing),
            0.5 * (area.south + area.north - (rows - 1) * spacing),
        ]
    )
    east, north = np.meshgrid(corner[0] + np.arange(columns) * spacing, corner[1] + np.arange(rows) * spacing)
    places = np.column_stack([east.ravel(), north.ravel()])
    heights = np.stack([clearance.lifted(places, layer)[:, 2].reshape(rows, columns) for layer in layers])
    steps = grid_steps(neighbours, layered=len(layers) > 1)
    bits = np.uint32 if len(steps) <= 2 * 32 else np.uint64
    legal: MaskArray = np.zeros(heights.shape, dtype=bits)

    def judge(strip: _Strip) -> tuple[_Strip, BoolArray]:
        return strip, clearance.breaches(*_legs(corner, spacing, heights, strip)) == 0

    strips = list(_strips(heights.shape, steps[: len(steps) // 2]))
    for done, (strip, clear) in enumerate(spread(judge, strips)):
        tracker.at("laying the graph", done, len(strips))
        part = legal[strip.layer, strip.rows, strip.columns]
        part |= np.left_shift(clear.reshape(part.shape), strip.number, dtype=bits)
    return GridVeil(corner, spacing, heights, steps, legal.ravel(), clearance)


class _Strip(NamedTuple):
    """The legs of one step, its number given, that start in some rows and columns of a layer."""

    number: int
    step: tuple[int, int, int]
    layer: int
    rows: slice
    columns: slice


def _strips(shape: tuple[int, ...], steps: IntArray) -> Iterator[_Strip]:
    """All legs of all steps, in strips of bounded size."""
    layers, rows, columns = shape
    height = max(1, _BATCH // columns)
    for number, (up, north, east) in enumerate(steps.tolist()):
        end = rows - max(0, north)
        within = slice(max(0, -east), columns - max(0, east))
        if within.stop <= within.start:
            continue
        for layer in range(layers - up):
            for first in range(max(0, -north), end, height):
                yield _Strip(number, (up, north, east), layer, slice(first, min(first + height, end)), within)


def _legs(corner: FloatArray, spacing: float, heights: FloatArray, strip: _Strip) -> tuple[FloatArray, FloatArray]:
    """A strip's legs: their starts and ends, (n, 3) each."""
    up, north, east = strip.step
    rs = np.arange(strip.rows.start, strip.rows.stop)[:, None]
    cs = np.arange(strip.columns.start, strip.columns.stop)
    starts, ends = np.empty((2, len(rs), len(cs), 3))
    starts[..., 0], starts[..., 1] = corner[0] + cs * spacing, corner[1] + rs * spacing
    starts[..., 2] = heights[strip.layer, rs, cs]
    ends[..., 0], ends[..., 1] = starts[..., 0] + east * spacing, starts[..., 1] + north * spacing
    ends[..., 2] = heights[strip.layer + up, rs + north, cs + east]
    return starts.reshape(-1, 3), ends.reshape(-1, 3)


def breaches_around(veil: GridVeil, nodes: IntArray) -> tuple[IntArray, FlagArray]:
    """All legs that leave the given nodes: where they lead and what they break (0 where they are clear)."""
    led, flags = [], []
    for step, away, to in _leaving(veil, nodes):
        broken = veil.clearance.breaches(veil.points_of(away), veil.points_of(to))
        owner, bit = _bit(veil, step, away, to)
        led.append(to)
        flags.append(np.where((broken == 0) & (veil.legal[owner] & bit == 0), TOO_WINDY, broken).astype(np.uint8))
    return np.concatenate(led), np.concatenate(flags)


def without_legs(veil: GridVeil, nodes: IntArray, closed: Judge) -> GridVeil:
    """The veil without those edges of the given nodes that are closed in the direction away from them."""
    legal = veil.legal.copy()
    for step, away, to in _leaving(veil, nodes):
        owner, bit = _bit(veil, step, away, to)
        known = np.flatnonzero(legal[owner] & bit)
        shut = known[closed(veil.points_of(away[known]), veil.points_of(to[known]))]
        legal[owner[shut]] &= ~bit
    return replace(veil, legal=legal)


def _leaving(veil: GridVeil, nodes: IntArray) -> Iterator[tuple[int, IntArray, IntArray]]:
    """For each step its number, the nodes from which it stays within the grid, and where it leads from there."""
    layers, rows, columns = veil.heights.shape
    layer, row, column = nodes // (rows * columns), (nodes // columns) % rows, nodes % columns
    for step, (up, north, east) in enumerate(veil.steps):
        to_layer, to_row, to_column = layer + up, row + north, column + east
        within = (to_layer >= 0) & (to_layer < layers) & (to_row >= 0) & (to_row < rows)
        within &= (to_column >= 0) & (to_column < columns)
        yield step, nodes[within], ((to_layer * rows + to_row) * columns + to_column)[within]


def _bit(veil: GridVeil, step: int, away: IntArray, to: IntArray) -> tuple[IntArray, np.unsignedinteger[Any]]:
    """Which nodes' bit says that a step is an edge, and the bit: the one that undoes it has the other end's."""
    half = len(veil.steps) // 2
    bit: np.unsignedinteger[Any] = veil.legal.dtype.type(1 << (step % half))
    return (away if step < half else to), bit
