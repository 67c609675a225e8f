"""How many nodes the lower bounds save: PLANNING's case, 1000 x 1000 nodes, 16 neighbours, V = 12, wind (6, 2) +- 2."""

from __future__ import annotations

import pytest

from tests.benchmarks.measuring import measure

MILLION = 1000


@pytest.mark.parametrize("way", ["up", "down", "across"])
def test_expansions(table, way):
    found = {bound: measure("bounded", MILLION, 16, way, bound) for bound in ("none", "h1", "h2")}
    table("Lower bounds: nodes expanded of 1000 x 1000, 16 neighbours, one core").row(
        way=f"{way}wind" if way != "across" else "across the wind",
        **{
            name: f"{found[bound].answer['expanded']:,.0f} in {found[bound].seconds:.2f} s"
            for name, bound in (("Dijkstra", "none"), ("h1", "h1"), ("h2", "h2"))
        },
    )
    for bound in ("h1", "h2"):
        assert found[bound].answer["cost"] == pytest.approx(found["none"].answer["cost"], rel=1e-9)
    assert found["h2"].answer["expanded"] <= found["h1"].answer["expanded"] <= found["none"].answer["expanded"]
