"""Tables 3 and 4: how long the search takes on the uniform graph and on the PRM graph."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

import numpy as np

from gcs_windplan.paper.cases import CASES, make_rules, make_vehicle
from gcs_windplan.paper.flying import find_route, sites_of
from gcs_windplan.paper.graphs import ROADMAP, SEED, SPACING, lay_roadmap, lay_uniform
from gcs_windplan.paper.published import ANGLE, DISTANCE, HYBRID, TABLES_3_4, TIME
from gcs_windplan.paper.tables import Table
from gcs_windplan.planning.cost import CostChoice
from gcs_windplan.planning.search import sample_wind
from gcs_windplan.planning.veil import PrmVeil
from gcs_windplan.terrain import Dem

SPACINGS: Final = (SPACING, SPACING / 2, SPACING / 4)
_COSTS: Final = (DISTANCE, ANGLE, HYBRID, TIME)


def processing_table(terrain: Dem, spacings: Sequence[float] = SPACINGS, repeats: int = 15) -> Table:
    """Search times [ms], medians of warm runs, the mean of the three cases; nodes and expansions beside them."""
    rows: list[tuple[str, ...]] = []
    for choice in (DISTANCE, ANGLE):
        uniform, roadmap = TABLES_3_4[choice.name]
        rows.append((f"{choice}, the paper", "–", f"{1000 * uniform:.0f}", "–", f"{1000 * roadmap:.0f}",
                     f"{roadmap / uniform:.2f}", "–"))  # fmt: skip
    rules = make_rules(terrain)
    sites = sites_of(rules, CASES)
    for spacing in spacings:
        veils = (
            lay_uniform(rules, sites, spacing),
            lay_uniform(rules, sites, spacing, ROADMAP),
            lay_roadmap(rules, sites, SEED, spacing),
        )
        nodes = " / ".join(str(veil.size) for veil in veils[1:])
        for choice in _COSTS:
            each = _search(veils, choice, repeats)
            ms = [seconds * 1000 for seconds, _ in each]
            expanded = " / ".join(f"{count:.0f}" for _, count in each)
            rows.append((str(choice), nodes, *(f"{value:.2f}" for value in ms), f"{ms[2] / ms[1]:.2f}", expanded))
    return Table(
        "Tables 3 and 4. Processing time of the search [ms], mean of the three cases",
        (
            "cost",
            "nodes",
            "uniform, 8 neighbours",
            "uniform, the PRM's radius",
            "PRM",
            "PRM against uniform",
            "expanded",
        ),
        tuple(rows),
        "The paper's numbers are MATLAB's on one core of 3.5 GHz, for an unknown number of nodes; these are compiled"
        " code on the machine that ran this report: only the ratios compare. Medians of warm runs, expansions in the"
        " order of the columns. The ratio compares the two graphs with the same radius of neighbours.",
    )


def _search(veils: Sequence[PrmVeil], choice: CostChoice, repeats: int) -> list[tuple[float, float]]:
    """For each veil the mean over the cases of the median search time [s], and of the nodes expanded.

    The veils take turns, so that a busy moment of the machine hits them alike.
    """
    times = np.empty((len(CASES), repeats + 1, len(veils)))
    counts = np.empty((len(CASES), len(veils)))
    for i, case in enumerate(CASES):
        graphs = [sample_wind(veil, case.wind) for veil in veils]
        for k in range(repeats + 1):
            for j, graph in enumerate(graphs):
                route = find_route(graph, choice, case, make_vehicle())
                times[i, k, j], counts[i, j] = route.search_seconds, route.expanded
    medians = np.median(times[:, 1:], axis=1).mean(axis=0)
    return [(float(seconds), float(count)) for seconds, count in zip(medians, counts.mean(axis=0), strict=True)]
