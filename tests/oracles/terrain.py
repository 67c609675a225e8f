"""Naive twins of the terrain kernels: slow, short, and made of other people's geometry where there is some."""

from __future__ import annotations

import numpy as np
import shapely
import trimesh

from gcs_windplan.arrays import FloatArray


def plane_height(triangle: FloatArray, x: float, y: float) -> float:
    """The height of a triangle's plane over (x, y), from its normal."""
    normal = np.cross(triangle[1] - triangle[0], triangle[2] - triangle[0])
    return float(triangle[0, 2] - (normal[0] * (x - triangle[0, 0]) + normal[1] * (y - triangle[0, 1])) / normal[2])


def grid_height(heights: FloatArray, column: float, row: float) -> float:
    """The height over a cell cut from (row, column) to (row + 1, column + 1)."""
    j = min(int(np.floor(column)), heights.shape[1] - 2)
    i = min(int(np.floor(row)), heights.shape[0] - 2)
    corners = [(j, i), (j + 1, i + 1), (j + 1, i) if column - j > row - i else (j, i + 1)]
    return plane_height(np.array([(x, y, heights[y, x]) for x, y in corners], dtype=float), column, row)


def leg_heights(triangles: FloatArray, start: FloatArray, end: FloatArray) -> tuple[float, float]:
    """The extreme heights of a leg over triangles that do not overlap in plan, by shapely; NaN where it leaves them."""
    track = shapely.LineString([start[:2], end[:2]])
    length, over, covered = track.length, [], 0.0
    for triangle in triangles:
        common = shapely.intersection(track, shapely.Polygon(triangle[:, :2]))
        covered += common.length
        for x, y in shapely.get_coordinates(common):
            t = np.hypot(x - start[0], y - start[1]) / length
            over.append(start[2] + t * (end[2] - start[2]) - plane_height(triangle, x, y))
    if covered < length - 1e-6:
        return np.nan, np.nan
    return min(over), max(over)


def ray_heights(mesh: trimesh.Trimesh, places: FloatArray) -> FloatArray:
    """The highest surface by rays from above (embree), NaN where they meet nothing."""
    top = mesh.bounds[1, 2] + 10.0
    origins = np.column_stack([places[:, :2], np.full(len(places), top)])
    down = np.tile([0.0, 0.0, -1.0], (len(places), 1))
    points, rays, _ = mesh.ray.intersects_location(origins, down, multiple_hits=True)
    heights = np.full(len(places), -np.inf)
    np.maximum.at(heights, rays, points[:, 2])
    return np.where(np.isfinite(heights), heights, np.nan)


def along(start: FloatArray, end: FloatArray, count: int) -> FloatArray:
    """`count` points of a leg, both ends included."""
    return start + np.linspace(0.0, 1.0, count)[:, None] * (end - start)


def sampled_distance(mesh: trimesh.Trimesh, start: FloatArray, end: FloatArray, count: int) -> float:
    """The least distance of `count` points of a leg to a mesh: never less than the leg's, at most half a step more."""
    _, distances, _ = trimesh.proximity.closest_point(mesh, along(start, end, count))
    return float(distances.min())


def disc_top(mesh: trimesh.Trimesh, x: float, y: float, radius: float, count: int = 40_000) -> float:
    """The highest of many points spread over a mesh that lie within a horizontal distance; never too high."""
    points, _ = trimesh.sample.sample_surface(mesh, count, seed=1)
    near = np.hypot(points[:, 0] - x, points[:, 1] - y) <= radius
    return float(points[near, 2].max()) if near.any() else -np.inf


def areas_meet(triangle: FloatArray, point: FloatArray, tolerance: float) -> bool:
    """The paper's equation (8)."""

    def area(*corners: FloatArray) -> float:
        return float(0.5 * np.linalg.norm(np.cross(corners[1] - corners[0], corners[2] - corners[0])))

    one, two, three = triangle
    parts = area(point, one, two) + area(point, one, three) + area(point, two, three)
    return parts - area(*triangle) <= tolerance * area(*triangle)
