"""The search beside peers on the same graph: 8 neighbours, seconds of flight in a wavy wind as weights."""

from __future__ import annotations

import pytest

from tests.benchmarks.measuring import Measured, measure

SAME = 1e-9
HEADING = "Search: 1000 x 1000 nodes, 8 neighbours, one core, the same optimum"
SMALL = "Search: 100 x 100 nodes, 8 neighbours, one core, the same optimum"
NOTE = (
    "Query: the best of its repeats. Build: writing the edges out, which peers need; ours works them out on the fly."
    " Memory: the peak of the whole process with its libraries."
)


def _show(table, who: str, way: str, one: Measured, ours: Measured) -> None:
    total, best = one.build + one.seconds, ours.build + ours.seconds
    table.row(
        who=who, way=way, query_s=f"{one.seconds:.3f}", build_s=f"{one.build:.2f}" if one.build > 1e-3 else "-",
        with_build_to_ours=f"{total / best:.1f}", query_to_ours=f"{one.seconds / ours.seconds:.1f}",
        peak_MB=f"{one.peak_mb:.0f}",
    )  # fmt: skip
    table.note = NOTE


@pytest.mark.parametrize("way", ["down", "up"])
def test_a_million_nodes(table, way):
    ours = measure("ours", 1000, 8, way)
    table = table(HEADING)
    _show(table, f"gcs_windplan A*, {ours.answer['expanded']} expanded", f"{way}wind", ours, ours)
    for job, who in (("scipy_dijkstra", "scipy dijkstra"), ("rustworkx_dijkstra", "rustworkx dijkstra")):
        peer = measure(job, 1000, 8, way)
        _show(table, who, f"{way}wind", peer, ours)
        assert peer.answer["cost"] == pytest.approx(ours.answer["cost"], rel=SAME)


@pytest.mark.parametrize("way", ["down", "up"])
def test_small_with_networkx(table, way):
    ours = measure("ours", 100, 8, way)
    table = table(SMALL)
    _show(table, "gcs_windplan A*", f"{way}wind", ours, ours)
    for job in ("scipy_dijkstra", "rustworkx_dijkstra", "networkx_dijkstra"):
        peer = measure(job, 100, 8, way)
        _show(table, job.replace("_", " "), f"{way}wind", peer, ours)
        assert peer.answer["cost"] == pytest.approx(ours.answer["cost"], rel=SAME)


@pytest.mark.parametrize("neighbours", [8, 16])
@pytest.mark.parametrize("n", [100, 316, 1000, 3162])
def test_growth(table, n, neighbours):
    ours = measure("ours", n, neighbours, "up")
    table("Growth: A* upwind, one core").row(
        nodes=f"{n * n:,}", neighbours=neighbours, seconds=f"{ours.seconds:.3f}",
        expanded=f"{ours.answer['expanded']:,.0f}", ns_per_node=f"{ours.seconds / (n * n) * 1e9:.0f}",
        peak_MB=f"{ours.peak_mb:.0f}",
    )  # fmt: skip
    assert ours.peak_mb < 6000


@pytest.mark.parametrize("nodes", ["1e4", "1e5", "1e6", "1e7"])
def test_whole_plan(table, nodes):
    """Veil, exact clearance, wind and search over the Jacksboro fault, by the public way."""
    for neighbours in (8, 16):
        one = measure("plan", nodes, neighbours)
        two = measure("plan", nodes, neighbours, cores=2)
        table("Plan without shaping: Jacksboro fault, gridded wind, exact clearance").row(
            nodes=f"{one.answer['nodes']:,.0f}", neighbours=neighbours, one_core_s=f"{one.seconds:.2f}",
            of_that_search_s=f"{one.answer['search']:.2f}", two_cores_s=f"{two.seconds:.2f}",
            gain=f"{one.seconds / two.seconds:.2f}", peak_MB=f"{one.peak_mb:.0f}",
        )  # fmt: skip
        assert one.answer["expanded"] == two.answer["expanded"]
        assert one.peak_mb < 6000
