"""Triangle meshes from files: STL, OBJ, PLY and GLB, through trimesh.

Coordinates are taken as they stand in the file, as metres east, north and up of the local frame. The glTF
specification has y up; a GLB that follows it lies on its side here, so export meshes of the ground with z up.
"""

from __future__ import annotations

import logging
from pathlib import Path

import numpy as np
import trimesh

from gcs_windplan.arrays import FloatArray, IntArray
from gcs_windplan.errors import Problem, TerrainError

SUFFIXES = (".stl", ".obj", ".ply", ".glb")

# trimesh tells the whole program about files that it cannot read; here that becomes a TerrainError
logging.getLogger("trimesh").addHandler(logging.NullHandler())


def read_mesh(path: str | Path) -> tuple[FloatArray, IntArray]:
    """Vertices (v, 3) [m] and faces (f, 3) of a mesh file, equal vertices merged, parts put together.

    Raises TerrainError, with the file, if it is missing, unreadable, without faces or with a vertex that is
    no number.
    """
    path = Path(path)
    if not path.is_file():
        raise _file_error(path, "there is no such file")
    if path.suffix.lower() not in SUFFIXES:
        raise _file_error(path, f"meshes are read from files named {', '.join(SUFFIXES)}")
    try:
        mesh = trimesh.load_scene(path, process=False).to_mesh()  # process drops faces that are not finite
    except Exception as error:  # trimesh's readers raise whatever their parsers raise
        raise _file_error(path, f"not a mesh that trimesh can read ({error})") from error
    if len(mesh.faces) == 0:
        raise _file_error(path, "no faces in it; a point cloud has to be triangulated first")
    if not np.isfinite(mesh.vertices[mesh.faces]).all():
        raise _file_error(path, "a vertex whose coordinates are not finite numbers")
    mesh.merge_vertices(merge_tex=True, merge_norm=True)
    return np.asarray(mesh.vertices, dtype=np.float64), np.asarray(mesh.faces, dtype=np.int64)


def open_sides(vertices: FloatArray, faces: IntArray) -> int:
    """How many sides of triangles do not join exactly two faces: 0 for a closed (watertight) mesh."""
    mesh = trimesh.Trimesh(vertices, faces, process=False, validate=False)
    mesh.merge_vertices()
    if mesh.is_watertight:
        return 0
    _, counts = np.unique(mesh.edges_sorted, axis=0, return_counts=True)
    return max(int((counts != 2).sum()), 1)


def _file_error(path: Path, message: str) -> TerrainError:
    return TerrainError(Problem(message, file=path))
