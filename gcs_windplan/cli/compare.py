"""`gcs-windplan compare`: every cost side by side on one veil."""

from __future__ import annotations

from gcs_windplan.cli.choices import Airspeed, Folder, MissionFile, asked_mission, output_folder

HELP = "Plan by every cost; print time, energy, length and search time side by side; write compare.png."


def compare(mission: MissionFile, airspeed: Airspeed = None, output: Folder = None) -> None:
    """Plan by each cost and print a table."""
    asked = asked_mission(mission, airspeed)

    from gcs_windplan.cli.plan import report
    from gcs_windplan.cli.tables import print_comparison
    from gcs_windplan.jobs.outputs import write_files
    from gcs_windplan.jobs.plans import compare as compare_costs
    from gcs_windplan.report import draw_map

    plans = compare_costs(asked)
    picture = draw_map(plans)
    folder = output_folder(output, asked.name)
    written = write_files({"compare.png": picture}, folder)
    print_comparison(plans)
    report(written)
