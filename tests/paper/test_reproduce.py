"""The reproduction of "A spatially wind aware quadcopter (UAV) path planning approach": effects, files, numbers."""

from __future__ import annotations

import re

import numpy as np
import pytest

from gcs_windplan.cli import reproduce as verb
from gcs_windplan.paper import reproduce
from gcs_windplan.paper.cases import CASES, OTHER_READINGS, make_rules, make_terrain, make_vehicle
from gcs_windplan.paper.comparison import key_of, order_holds
from gcs_windplan.paper.flying import SHAPED, fly_case, seconds_of, seconds_on_the_slope, sites_of
from gcs_windplan.paper.frequency import make_pairs, sweep, time_wins
from gcs_windplan.paper.graphs import lay_roadmap, lay_uniform
from gcs_windplan.paper.published import ANGLE, DISTANCE, HYBRID, printed_seconds
from gcs_windplan.paper.sampled import SampledTest
from gcs_windplan.paper.tables import Table

TERRAIN = make_terrain()
EXACT, SAMPLED = make_rules(TERRAIN), make_rules(TERRAIN, SampledTest())
SITES = sites_of(EXACT, CASES)
all_of_it = {"angle": True, "hybrid": True, "time": True}


@pytest.fixture(scope="module")
def quick():
    """Everything, with a short sweep."""
    return reproduce(quick=True)


@pytest.mark.parametrize("model", ["paper", "triangle"])
@pytest.mark.parametrize("rules", [EXACT, SAMPLED], ids=["exact", "sampled"])
@pytest.mark.parametrize("case", CASES, ids=lambda case: case.title)
def test_the_effects_of_tables_1_and_2_show_on_the_uniform_graph(case, rules, model):
    """Angle beats distance in cases 1 and 3, loses in case 2; hybrid 0.1/0.9 beats distance; time beats them all."""
    routes = fly_case(case, lay_uniform(rules, SITES), make_vehicle(model), EXACT)
    assert order_holds(case, routes) == all_of_it


@pytest.mark.parametrize("case", OTHER_READINGS, ids=lambda case: case.title)
def test_the_effects_of_case_1_show_in_the_other_readings_of_equation_14(case):
    routes = fly_case(case, lay_uniform(EXACT, SITES), make_vehicle(), EXACT)
    assert order_holds(case, routes) == all_of_it


@pytest.mark.parametrize("case", CASES, ids=lambda case: case.title)
def test_on_the_roadmap_table_1_keeps_its_order_and_time_wins(case):
    effects = order_holds(case, fly_case(case, lay_roadmap(EXACT, SITES), make_vehicle(), EXACT))
    assert effects["angle"]
    assert effects["time"]


@pytest.mark.parametrize("choice", [DISTANCE, ANGLE], ids=str)
@pytest.mark.parametrize("case", CASES, ids=lambda case: case.title)
def test_prm_expands_fewer_nodes_than_uniform(case, choice):
    """The paper's Tables 3 and 4: PRM is cheaper to search."""
    veils = (lay_uniform(EXACT, SITES), lay_roadmap(EXACT, SITES))
    uniform, roadmap = (fly_case(case, veil, make_vehicle(), choices=[choice])[str(choice)] for veil in veils)
    assert roadmap.expanded < uniform.expanded


def test_the_roadmap_has_three_quarters_of_the_nodes():
    assert lay_uniform(EXACT, SITES).size == 21 * 21
    assert lay_roadmap(EXACT, SITES).size == round(0.75 * 21 * 21)


@pytest.mark.parametrize(("radius", "neighbours"), [(1.5, 8), (2.3, 20), (3.2, 36)])
def test_the_uniform_graph_joins_all_within_the_radius_of_equation_4(radius, neighbours):
    veil = lay_uniform(EXACT, SITES, radius=radius)
    counts = np.bincount(veil.pairs.ravel())  # on steep ground the sphere of (4) holds fewer
    assert counts.max() == neighbours


def test_the_sampled_test_lets_legs_through_that_the_exact_one_stops():
    exact, sampled = lay_uniform(EXACT, SITES), lay_uniform(SAMPLED, SITES)
    assert np.count_nonzero(exact.flags) > np.count_nonzero(sampled.flags)


def test_time_is_never_beaten_in_a_short_sweep():
    trials = sweep(TERRAIN, make_pairs(48), seeds=(3,))
    assert len(trials) >= 100
    assert all(time_wins(trial) for trial in trials if trial.routes)


def test_flight_time_is_equation_13_in_still_and_moving_air():
    """Along the middle of the jet (14), 2 mr/s of airspeed and 1 mr/s of wind: 3 mr/s there, 1 mr/s back."""
    points = np.array([[-1.5, 0.0, 1.0], [0.0, 0.0, 1.0], [1.5, 0.0, 1.0]])
    assert seconds_of(points, CASES[0].wind, make_vehicle()) == pytest.approx(1.0)
    assert seconds_of(points[::-1], CASES[0].wind, make_vehicle()) == pytest.approx(3.0)
    assert seconds_on_the_slope(points, CASES[0].wind, make_vehicle()) == pytest.approx(1.0)


def test_published_numbers_are_those_of_tables_1_and_2():
    """The paper's Tables 1 and 2, by case and cost."""
    assert [printed_seconds("1", choice) for choice in (DISTANCE, ANGLE, HYBRID)] == [3.11, 2.30, 2.15]
    assert [printed_seconds("2", choice) for choice in (DISTANCE, ANGLE, HYBRID)] == [3.06, 3.63, 2.95]
    assert [printed_seconds("3", choice) for choice in (DISTANCE, ANGLE, HYBRID)] == [4.16, 2.51, 2.56]


def test_the_report_sets_the_papers_numbers_beside_ours(quick):
    """Tables 1 (3.11 to 2.51), 2 (3.06 to 2.56), 3 and 4 (510, 150, 1070, 300 ms) of the paper."""
    report = quick.files["report.md"]
    table_1 = report.split("**Table 1.")[1].split("**")[1]
    for row in ("3.11 | 2.30", "3.06 | 3.63", "4.16 | 2.51"):
        assert f"| the paper | {row} |" in table_1
    table_2 = report.split("**Table 2.")[1].split("**")[1]
    rows = [line.split(" | ")[1:4] for line in table_2.splitlines() if re.match(r"\| [123] \|", line)]
    assert rows == [
        ["0.9", "0.1", "3.06"],
        ["0.6", "0.4", "3.02"],
        ["0.4", "0.6", "2.95"],
        ["0.1", "0.9", "2.95"],
        ["0.1", "0.9", "2.15"],
        ["0.1", "0.9", "2.56"],
    ]
    assert "| distance, the paper | – | 510 | – | 150 | 0.29 | – |" in report
    assert "| angle, the paper | – | 1070 | – | 300 | 0.28 | – |" in report


def test_the_report_embeds_every_figure_and_tells_the_choices(quick):
    report = quick.files["report.md"]
    embedded = set(re.findall(r"!\[[^]]+\]\(([^)]+)\)", report))
    assert embedded == {name for name in quick.files if name.endswith(".png")}
    assert len(embedded) == 3
    for case in CASES:
        assert key_of(case) in report
    assert "nan" not in report
    assert SHAPED in report


def test_tables_have_rows_as_long_as_their_headers(quick):
    for table in quick.tables:
        assert table.rows
        assert {len(row) for row in table.rows} == {len(table.header)}


def test_a_table_in_markdown():
    table = Table("T", ("name", "s"), (("a", "1.00"),), "Said.")
    assert table.markdown() == "**T**\n\n| name | s |\n|---|---:|\n| a | 1.00 |\n\nSaid.\n"


def test_the_verb_writes_all_files_and_prints_the_tables(tmp_path, capsys, monkeypatch, quick):
    asked = []
    monkeypatch.setattr("gcs_windplan.paper.reproduce", lambda short: asked.append(short) or quick)
    verb.reproduce(tmp_path / "out" / "paper", quick=True)
    assert asked == [True]
    written = {path.name: path for path in (tmp_path / "out" / "paper").iterdir()}
    assert set(written) == {"report.md", "figure_3.png", "figure_6.png", "figure_7.png"}
    for name, path in written.items():
        assert name == "report.md" or path.read_bytes().startswith(b"\x89PNG")
    printed = capsys.readouterr().out
    assert "Flight time [s]" in printed
    for path in written.values():
        assert f"wrote {path}" in printed
