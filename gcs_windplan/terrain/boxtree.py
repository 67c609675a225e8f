"""A tree of boxes around triangles, for the nearest of many."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from gcs_windplan.arrays import FloatArray, IntArray

LEAF = 8  # triangles in a leaf; 4 to 16 are equally fast


@dataclass(frozen=True, slots=True, eq=False)
class BoxTree:
    """Nodes (k,), the first the root, as the kernels take them.

    `bounds` (k, 7): low corner, high corner and greatest margin [m] of all that a node holds. `links` (k, 2):
    its two children, or (-1 - first, count) for a leaf, which holds order[first : first + count]. `order`
    (m,) numbers the boxes.
    """

    bounds: FloatArray
    links: IntArray
    order: IntArray

    @classmethod
    def over(cls, boxes: FloatArray, margins: FloatArray) -> BoxTree:
        """The tree over boxes (m, 6) of low and high corners, margins (m,); halved along the longest side."""
        order = np.arange(len(boxes))
        bounds: list[FloatArray] = []
        links: list[tuple[int, int]] = [(0, 0)]
        todo = [(0, len(boxes))]  # grows while it is read: the node numbered k is todo[k]
        for node, (first, last) in enumerate(todo):
            own = order[first:last]
            low, high = boxes[own, :3].min(axis=0), boxes[own, 3:].max(axis=0)
            bounds.append(np.array([*low, *high, margins[own].max()]))
            if last - first <= LEAF:
                links[node] = (-1 - first, last - first)
                continue
            axis = int(np.argmax(high - low))
            order[first:last] = own[np.argsort(boxes[own, axis] + boxes[own, 3 + axis], kind="stable")]
            middle = (first + last) // 2
            links[node] = (len(todo), len(todo) + 1)
            links += [(0, 0), (0, 0)]
            todo += [(first, middle), (middle, last)]
        return cls(np.array(bounds), np.array(links, dtype=np.int64), order)
