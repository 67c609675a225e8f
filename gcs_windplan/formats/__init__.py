"""Mission files of the ground stations: .waypoints and .plan, read patiently and written strictly."""

from gcs_windplan.formats.any_format import read_items
from gcs_windplan.formats.plan import format_plan, parse_plan, read_plan, write_plan
from gcs_windplan.formats.reading import ReadMission
from gcs_windplan.formats.waypoints import format_waypoints, parse_waypoints, read_waypoints, write_waypoints
from gcs_windplan.formats.writing import check_writable, write_atomically

__all__ = [
    "ReadMission",
    "check_writable",
    "format_plan",
    "format_waypoints",
    "parse_plan",
    "parse_waypoints",
    "read_items",
    "read_plan",
    "read_waypoints",
    "write_atomically",
    "write_plan",
    "write_waypoints",
]
