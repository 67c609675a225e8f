"""`gcs-windplan compare`: every cost side by side on one veil."""

from __future__ import annotations

from gcs_windplan.cli.choices import Airspeed, Folder, MissionFile, output_folder, read_request

HELP = "Plan by every cost; print time, energy, length and search time side by side; write compare.png."


def compare(mission: MissionFile, airspeed: Airspeed = None, output: Folder = None) -> None:
    """Plan by each cost and print a table."""
    request = read_request(mission, airspeed)

    from gcs_windplan.cli.plan import report, write
    from gcs_windplan.cli.tables import print_comparison
    from gcs_windplan.planning.cost import COSTS, CostChoice
    from gcs_windplan.planning.planner import plan_routes
    from gcs_windplan.report import draw_map

    hybrid = request.cost if request.cost.name == "hybrid" else CostChoice("hybrid")
    names = [name for name, cost in COSTS.items() if request.airframe is not None or not cost.needs_power]
    choices = [hybrid if name == "hybrid" else CostChoice(name) for name in names]
    plans = plan_routes(request, choices)
    picture = draw_map(plans)
    folder = output_folder(output, request)
    written = write({"compare.png": picture}, folder)
    print_comparison(plans)
    report(written)
