"""Plans, missions and assessments as files, in the format that the file's name says."""

from __future__ import annotations

import os
from collections.abc import Callable
from pathlib import Path
from typing import Any, Final, TypeAlias

from gcs_windplan.assessment import Assessment
from gcs_windplan.errors import FormatError, Problem
from gcs_windplan.formats import check_writable, format_plan, format_waypoints, write_atomically
from gcs_windplan.jobs.items import items_of
from gcs_windplan.mission import MissionItems
from gcs_windplan.planning.planner import PlannedRoute

#: What can be written.
Written: TypeAlias = PlannedRoute | MissionItems | Assessment


def write(what: Written, path: str | os.PathLike[str]) -> Path:
    """Write a plan, a mission's items or an assessment into a file, whole or not at all; gives its path.

    The name's ending says how: .plan and .waypoints (a plan, or items), .json (a plan's figures, or an assessment's),
    .geojson, .kml, .csv (legs) and .html (the page) of an assessment, for which a plan is judged.

    Raises `FormatError` for another ending, or what cannot be written so.

    >>> import gcs_windplan as gw
    >>> plan = gw.plan(gw.Mission(
    ...     start=(36.55, -84.30), goal=(36.56, -84.28), vehicle=gw.Vehicle(12.0), terrain="flat:300",
    ... ))
    >>> gw.write(plan, "out.plan").name
    'out.plan'
    >>> gw.diff(plan, "out.plan").same
    True
    """
    file = Path(path)
    ending = file.suffix.lower()
    if ending in _OF_ITEMS:
        if isinstance(what, Assessment):
            raise FormatError(
                Problem(f"an assessment is no mission: write it as {', '.join(_OF_ASSESSMENTS)}", file=file)
            )
        text = _OF_ITEMS[ending](items_of(what).mission)
    elif ending in _OF_ASSESSMENTS:
        text = _OF_ASSESSMENTS[ending](what)
    else:
        known = ", ".join([*_OF_ITEMS, *_OF_ASSESSMENTS])
        raise FormatError(Problem(f"ends in none of {known}: rename it", file=file))
    check_writable(file)
    write_atomically(file, text)
    return file


def _judged(what: Written) -> Assessment:
    """The assessment of a plan; raises `FormatError` for items, which say no world."""
    if isinstance(what, Assessment):
        return what
    if not isinstance(what, PlannedRoute):
        raise FormatError("items alone are not judged: review them first, and write the assessment")
    from gcs_windplan.assessment import assess_plan

    return assess_plan(what)


def _json(what: Written) -> str:
    if isinstance(what, PlannedRoute):
        from gcs_windplan.formats.summary import format_summary

        return format_summary(what)
    from gcs_windplan.formats.verdict import format_verdict

    return format_verdict([_judged(what)]) + "\n"


def _geojson(what: Written) -> str:
    from gcs_windplan.formats.geojson import format_geojson

    return format_geojson(_judged(what))


def _kml(what: Written) -> str:
    from gcs_windplan.formats.kml import format_kml

    return format_kml(_judged(what))


def _csv(what: Written) -> str:
    from gcs_windplan.formats.legs_csv import format_legs_csv

    return format_legs_csv(_judged(what))


def _html(what: Written) -> str:
    from gcs_windplan.report import render_page

    return render_page([_judged(what)])


_OF_ITEMS: Final[dict[str, Callable[[MissionItems], str]]] = {
    ".plan": format_plan,
    ".waypoints": lambda items: format_waypoints(items.without_fence()),
}
_OF_ASSESSMENTS: Final[dict[str, Callable[[Any], str]]] = {
    ".json": _json,
    ".geojson": _geojson,
    ".kml": _kml,
    ".csv": _csv,
    ".html": _html,
}
