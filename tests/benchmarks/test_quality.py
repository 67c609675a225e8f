"""How good the routes are: beside limits that are known, and over real ground beside a very fine graph."""

from __future__ import annotations

import math
import time
from dataclasses import replace
from pathlib import Path
from statistics import median

import numpy as np
import pytest

from gcs_windplan.jobs.requests import read_request
from gcs_windplan.planning.planner import plan_route
from gcs_windplan.planning.request import Request, Roadmap, Uniform
from gcs_windplan.planning.sites import choose_area, choose_layers, choose_nodes, choose_spacing
from gcs_windplan.planning.veil import SHARE_OF_GRID
from tests.oracles.limits import OTHERS, PAPER, Limit
from tests.test_real_worlds import BUTTE, DAVOS

one_percent = 1.01
FINE = "Quality over real ground: our plan beside a graph of a quarter of its spacing, 64 neighbours, not shaped"
FINE_NOTE = (
    "Layers x 1: the fine graph has the mission's layers, x 4: a quarter as far apart. Ratio: our time over that of the"
    " fine graph's path; last column: over that of this path shaped as well. Our seconds are for the whole plan."
)
ALL_NOTE = "Percent above the limit: the graph's path, and shaped. Seconds for veil, search and shaping."


def above(limit: Limit, nodes: int, neighbours: int) -> tuple[float, float, int, float]:
    """The graph's path and the shaped one above the limit [%], its waypoints, the seconds that it all took."""
    begin = time.perf_counter()
    cost, path, shaped = limit.route(nodes, neighbours)
    took = time.perf_counter() - begin
    graph, best = (100 * (cost.of_polyline(points) / limit.seconds - 1) for points in (path, shaped))
    return graph, best, len(shaped), took


@pytest.mark.parametrize("limit", PAPER + OTHERS, ids=str)
def test_above_the_limit(table, limit):
    graph, best, waypoints, took = above(limit, 101, 16)
    rows = table("Quality: time above what physics allows, 101 x 101 nodes, 16 neighbours")
    rows.row(
        case=limit.case, way=limit.way, model=limit.model, limit_s=f"{limit.seconds:g}", graph=f"{graph:.2f}",
        shaped=f"{best:.3f}", waypoints=waypoints, seconds=f"{took:.2f}",
    )  # fmt: skip
    rows.note = ALL_NOTE
    assert best <= 0.1


@pytest.mark.parametrize("nodes", [41, 101])
@pytest.mark.parametrize("neighbours", [8, 16, 32, 64])
def test_grids(table, nodes, neighbours):
    """The spacing hardly matters, and after shaping the neighbourhood neither."""
    graphs, shaped, _, took = zip(*(above(limit, nodes, neighbours) for limit in PAPER + OTHERS), strict=True)
    table("Quality on other grids: all those cases, time above the limit [%], middle and worst").row(
        nodes=f"{nodes} x {nodes}", neighbours=neighbours, graph=f"{median(graphs):.2f}, {max(graphs):.2f}",
        shaped=f"{median(shaped):.3f}, {max(shaped):.3f}", seconds_a_case=f"{median(took):.2f}",
    )  # fmt: skip
    assert max(shaped) <= (0.2 if neighbours == 8 else 0.1)


def finely(request: Request, by: int) -> Request:
    """The request on a graph with a quarter of the spacing, 64 neighbours, and layers `by` times as close."""
    area = choose_area(request, np.array([(site.east, site.north) for site in request.sites]))
    if isinstance(request.graph, Roadmap):
        cells = choose_nodes(request, area) / SHARE_OF_GRID
        spacing = math.sqrt((area.east - area.west) * (area.north - area.south) / cells)
    else:
        spacing = choose_spacing(request, area)
    layers = choose_layers(request)
    places = np.arange(by * (len(layers) - 1) + 1) / by
    closer = tuple(float(height) for height in np.interp(places, np.arange(len(layers)), layers))
    return replace(request, graph=Uniform(spacing / 4, 64), layers=closer)


@pytest.mark.parametrize(
    ("name", "by"),
    [("jacksboro", 1), ("jacksboro", 4), ("inspection", 1), ("village", 1), ("davos", 1), ("davos", 4), ("butte", 1)],
)
def test_over_real_ground(table, name, by, request, tmp_path):
    """Jacksboro's fault twice, on a grid and a roadmap; a mesh with houses; Davos (10 m) and Big Butte (30 m)."""
    path = Path("missions") / f"{name}.yaml"
    if text := {"davos": DAVOS, "butte": BUTTE}.get(name):
        path = tmp_path / f"{name}.yaml"
        shared = request.getfixturevalue("shared_data")
        path.write_text(text.format(data=shared, departure="2020-02-22T12:00Z"))
    mission = read_request(path)
    plan_route(mission)  # warm
    begin = time.perf_counter()
    ours = plan_route(mission)
    took = time.perf_counter() - begin
    fine = plan_route(finely(mission, by))
    rows = table(FINE)
    rows.row(
        mission=name, ours_s=f"{ours.cost:.1f}", waypoints=len(ours.waypoints), planned_in_s=f"{took:.1f}",
        layers=f"x {by}", fine_nodes=f"{fine.effort.nodes:,}", fine_s=f"{fine.graph_cost:.1f}",
        searched_in_s=f"{fine.effort.veil_seconds + fine.effort.search_seconds:.1f}",
        ratio=f"{ours.cost / fine.graph_cost:.4f}", to_it_shaped=f"{ours.cost / fine.cost:.4f}",
    )  # fmt: skip
    rows.note = FINE_NOTE
    assert ours.cost <= fine.graph_cost
    assert ours.cost <= one_percent * fine.cost
