"""The jobs: `python -m tests.benchmarks.jobs CORES JOB ARGUMENT...` prints what one took, as JSON.

Each returns its work and how to prepare it; kernels are warm (compiled, and run once on a small world) before the clock
starts. Peers are imported in the job that needs them, so that nobody carries another's memory.
"""

from __future__ import annotations

import json
import sys
from collections.abc import Callable
from dataclasses import asdict, replace
from pathlib import Path

import numpy as np

from tests.benchmarks.forecast_jobs import FORECAST_JOBS
from tests.benchmarks.measuring import Measured, pin, timed
from tests.benchmarks.worlds import SPACING, VEHICLE, Square, explicit_edges, legs_over, real_ground, square

MISSION = Path(__file__).resolve().parents[2] / "missions" / "jacksboro.yaml"
LEGS = {14: 1_000_000, 500: 100_000}  # how many of a length [m]


def imports(_: str) -> Measured:
    """What a process holds once our kernels and their libraries are loaded."""
    _search(square(30), 8, "up")
    return timed(dict, list, 1)


def ours(n: str, neighbours: str, way: str) -> Measured:
    """A* on the implicit grid, edges worked out on the fly."""
    _search(square(30), 8, "up")
    world = square(int(n))
    return timed(lambda: _search(world, int(neighbours), way), list, 5 if int(n) < 2000 else 1)


def bounded(n: str, neighbours: str, way: str, bound: str) -> Measured:
    """The same with another lower bound: none (Dijkstra), h1 or h2."""
    _search(square(30), 8, "up", bound)
    world = square(int(n))
    return timed(lambda: _search(world, int(neighbours), way, bound), list, 1)


def _search(world: Square, neighbours: int, way: str, bound: str = "h2") -> dict[str, float]:
    from gcs_windplan.kernels.best_first import search_grid
    from gcs_windplan.planning.cost import CostChoice, SectionCost
    from gcs_windplan.planning.veil.grid import grid_steps
    from gcs_windplan.wind import Calm

    start, goal = world.ends(way)
    cost = SectionCost(CostChoice("time"), Calm(), VEHICLE, SPACING, 1.0)  # the nodes carry their winds
    setting = cost.setting(
        np.array([*np.array(divmod(goal, world.n))[::-1] * SPACING, world.heights[goal]]), world.winds
    )
    if bound == "h1":
        strongest = float(np.hypot(world.winds[:, 0], world.winds[:, 1]).max())
        setting = setting._replace(ball_e=0.0, ball_n=0.0, ball_radius=strongest)
    estimates = np.zeros(world.n**2) if bound == "none" else np.empty(0)
    legal = np.full(world.n**2, 0xFFFFFFFF, dtype=np.uint32)
    path, seconds, expanded, _ = search_grid(
        np.array([1, world.n, world.n]), np.zeros(2), SPACING, grid_steps(neighbours, layered=False), world.heights,
        legal, world.winds, estimates, cost.performance(), setting, None,
        np.array([start]), np.zeros(1), np.zeros(1), np.zeros(1), np.array([goal]), world.winds[goal : goal + 1],
        None, 0, None, np.zeros(2, dtype=np.int64),
    )  # fmt: skip
    return {"cost": seconds, "expanded": expanded, "nodes": len(path)}


def scipy_dijkstra(n: str, neighbours: str, way: str) -> Measured:
    from scipy.sparse import csr_array
    from scipy.sparse.csgraph import dijkstra

    world, graph = square(int(n)), []
    start, goal = world.ends(way)

    def build() -> None:
        a, b, seconds = explicit_edges(world, int(neighbours))
        graph.append(csr_array((seconds, (a, b)), shape=(world.n**2, world.n**2)))

    def work() -> dict[str, float]:
        return {"cost": float(dijkstra(graph[0], indices=start, return_predecessors=True)[0][goal])}

    return timed(work, build, 3)


def rustworkx_dijkstra(n: str, neighbours: str, way: str) -> Measured:
    import rustworkx

    world, graph = square(int(n)), rustworkx.PyDiGraph(multigraph=False)
    start, goal = world.ends(way)

    def build() -> None:
        edges = explicit_edges(world, int(neighbours))
        graph.add_nodes_from(range(world.n**2))
        graph.add_edges_from(list(zip(*(part.tolist() for part in edges), strict=True)))

    def work() -> dict[str, float]:
        return {"cost": rustworkx.dijkstra_shortest_path_lengths(graph, start, float, goal=goal)[goal]}

    return timed(work, build, 1)


def networkx_dijkstra(n: str, neighbours: str, way: str) -> Measured:
    import networkx

    world, graph = square(int(n)), networkx.DiGraph()
    start, goal = world.ends(way)

    def build() -> None:
        edges = explicit_edges(world, int(neighbours))
        graph.add_weighted_edges_from(zip(*(part.tolist() for part in edges), strict=True))

    def work() -> dict[str, float]:
        return {"cost": networkx.single_source_dijkstra(graph, start, goal)[0]}

    return timed(work, build, 1)


def plan(nodes: str, neighbours: str) -> Measured:
    """All of planning but shaping, over real ground in a gridded wind: veil with exact clearance, winds, search."""
    from gcs_windplan.jobs.requests import read_request
    from gcs_windplan.planning.planner import plan_route
    from gcs_windplan.planning.request import Uniform

    request = read_request(MISSION)
    box = request.scene.terrain.extent
    spacing = ((box.east - box.west) * (box.north - box.south) / float(nodes)) ** 0.5
    coarse = replace(request, layers=(50.0,), margin=40_000.0, graph=Uniform(150.0, int(neighbours)))
    fine = replace(coarse, graph=Uniform(spacing, int(neighbours)))
    plan_route(coarse)
    best = min((plan_route(fine) for _ in range(3)), key=lambda it: it.effort.veil_seconds + it.effort.search_seconds)
    effort = best.effort
    answer = {"nodes": effort.nodes, "expanded": effort.expanded, "search": effort.search_seconds}
    return replace(timed(dict, list, 1), seconds=effort.veil_seconds + effort.search_seconds, answer=answer)


def our_legs(length: str) -> Measured:
    """Smallest and largest height of each leg over the ground, exact."""
    dem = real_ground()
    starts, ends = legs_over(dem, LEGS[int(length)], float(length))
    dem.leg_heights(starts[:100], ends[:100])

    def work() -> dict[str, float]:
        heights = dem.leg_heights(starts, ends)
        return {"hits": int(((heights[:, 0] < 0) & (heights[:, 1] > 0)).sum()), "triangles": len(dem.triangles())}

    return timed(work, list, 5)


def embree_legs(length: str) -> Measured:
    """trimesh with embreex: hit or not."""
    import trimesh
    from trimesh.ray.ray_pyembree import RayMeshIntersector

    dem = real_ground()
    starts, ends = legs_over(dem, LEGS[int(length)], float(length))
    scene = []

    def build() -> None:
        mesh = trimesh.Trimesh(**trimesh.triangles.to_kwargs(dem.triangles()))
        scene.append(RayMeshIntersector(mesh, scale_to_box=False)._scene)  # its own methods know no end of a ray

    def work() -> dict[str, float]:
        vectors = ends - starts
        lengths = np.linalg.norm(vectors, axis=1)
        rays = (vectors / lengths[:, None]).astype(np.float32)
        first = scene[0].run(starts.astype(np.float32), rays, dists=lengths.astype(np.float32))
        return {"hits": int((first >= 0).sum())}

    return timed(work, build, 3)


JOBS: dict[str, Callable[..., Measured]] = {
    job.__name__: job
    for job in (
        imports,
        ours,
        bounded,
        scipy_dijkstra,
        rustworkx_dijkstra,
        networkx_dijkstra,
        plan,
        our_legs,
        embree_legs,
    )
} | FORECAST_JOBS

if __name__ == "__main__":
    pin(int(sys.argv[1]))
    print(json.dumps(asdict(JOBS[sys.argv[2]](*sys.argv[3:]))))
