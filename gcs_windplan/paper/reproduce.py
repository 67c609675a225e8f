"""All of the reproduction at once: tables for people, files for a folder."""

from __future__ import annotations

from dataclasses import dataclass

from gcs_windplan.paper.cases import make_terrain
from gcs_windplan.paper.comparison import fly_setups, table_1, table_1_other, table_2
from gcs_windplan.paper.effort import SPACINGS, processing_table
from gcs_windplan.paper.frequency import SEEDS, expansion_table, frequency_table, make_pairs, seed_table, sweep
from gcs_windplan.paper.landscape import draw_landscape
from gcs_windplan.paper.maps import draw_cases, draw_hybrid
from gcs_windplan.paper.report import FIGURES, write_report
from gcs_windplan.paper.tables import Table


@dataclass(frozen=True, slots=True, eq=False)
class Reproduction:
    """The tables in their order, and the files' content by name."""

    tables: tuple[Table, ...]
    files: dict[str, str | bytes]


def reproduce(quick: bool = False) -> Reproduction:
    """Fly everything, in less than two minutes.

    `quick` flies every 32nd pair of the sweep, and times fewer graphs.
    """
    terrain = make_terrain()
    setups = fly_setups(terrain)
    trials = sweep(terrain, make_pairs(32 if quick else 1), SEEDS[:1] if quick else SEEDS)
    tables = {
        "table_1": table_1(setups),
        "table_1_other": table_1_other(setups[0]),
        "table_2": table_2(setups),
        "processing": processing_table(terrain, SPACINGS[:1] if quick else SPACINGS, 3 if quick else 15),
        "frequency": frequency_table(trials),
        "seeds": seed_table(terrain, range(1, 4 if quick else 41)),
        "expansion": expansion_table(trials),
    }
    pictures = (draw_landscape(terrain), draw_cases(terrain, setups[0]), draw_hybrid(terrain, setups[0]))
    files: dict[str, str | bytes] = {"report.md": write_report(terrain, setups, tables, trials)}
    files.update(zip(FIGURES, pictures, strict=True))
    return Reproduction(tuple(tables.values()), files)
