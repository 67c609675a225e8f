"""Makes the meshes of `village.yaml`: a sloping terrain and its buildings, metres about the local origin, z up.

    python missions/meshes/village.py

Run by hand when the village changes; the files that it writes stand beside it.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np
import trimesh

HERE = Path(__file__).parent
SIZE, CELL = 640.0, 20.0  # [m]
HOUSES = [
    (-120, -40),
    (-80, -60),
    (-40, -30),
    (0, -70),
    (40, -40),
    (80, -60),
    (-100, 20),
    (-60, 40),
    (60, 30),
    (100, 10),
]


def ground(east: np.ndarray, north: np.ndarray) -> np.ndarray:
    """A slope to the north with a knoll behind the village."""
    knoll = 55.0 * np.exp(-((east - 60) ** 2 + (north - 190) ** 2) / 80.0**2)
    return 0.06 * (north + SIZE / 2) + 6.0 * np.sin(east / 90.0) + knoll


def terrain() -> trimesh.Trimesh:
    """The ground as a mesh of two triangles a cell."""
    ticks = np.arange(-SIZE / 2, SIZE / 2 + 1, CELL)
    east, north = np.meshgrid(ticks, ticks)
    vertices = np.column_stack([east.ravel(), north.ravel(), ground(east, north).ravel()])
    n = len(ticks)
    corner = (np.arange(n - 1)[:, None] * n + np.arange(n - 1)).ravel()
    faces = np.concatenate(
        [
            np.column_stack([corner, corner + 1, corner + n + 1]),
            np.column_stack([corner, corner + n + 1, corner + n]),
        ]
    )
    return trimesh.Trimesh(vertices, faces, process=False)


def block(east: float, north: float, width: float, depth: float, height: float) -> trimesh.Trimesh:
    """A closed box that stands on the ground, its foot sunk by 3 m."""
    base = float(ground(np.array(east), np.array(north))) - 3.0
    box = trimesh.creation.box((width, depth, height + 3.0))
    box.apply_translation((east, north, base + (height + 3.0) / 2))
    return box


def church() -> trimesh.Trimesh:
    """A nave, and a tower with a pyramid on it."""
    nave = block(0, 10, 34, 14, 16)
    tower = block(-24, 10, 12, 12, 42)
    spire = trimesh.creation.cone(radius=8, height=22, sections=4)
    spire.apply_translation((-24, 10, tower.bounds[1, 2]))
    return trimesh.util.concatenate([nave, tower, spire])


def main() -> None:
    """Write the three files."""
    terrain().export(HERE / "village_terrain.ply")
    houses = trimesh.util.concatenate([block(e, n, 16, 12, 9) for e, n in HOUSES])
    houses.export(HERE / "village_houses.stl")
    church().export(HERE / "village_church.glb")


if __name__ == "__main__":
    main()
