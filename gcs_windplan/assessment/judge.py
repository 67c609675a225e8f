"""Judging a mission: fly it on paper, then hold every rule against it."""

from __future__ import annotations

from collections.abc import Iterable

from gcs_windplan.assessment.assessment import Assessment, Finding
from gcs_windplan.assessment.case import Case
from gcs_windplan.assessment.figures import judged, sums_of
from gcs_windplan.assessment.flown import fly_track
from gcs_windplan.assessment.heights import heights_of
from gcs_windplan.assessment.home import with_home
from gcs_windplan.assessment.outlines import outlines_of
from gcs_windplan.assessment.profile import ground_map_of, profile_of
from gcs_windplan.assessment.rules import RULES
from gcs_windplan.assessment.rules.battery import reserve_of
from gcs_windplan.assessment.rules.saying import located
from gcs_windplan.assessment.rules.wind import strongest_gust
from gcs_windplan.assessment.track import track_of


def assess(case: Case, more: Iterable[Finding] = ()) -> Assessment:
    """Judge a mission.

    `more` are findings that were made elsewhere, such as those of the firmware's own rules. Raises `InputError` for a
    mission that leads nowhere or repeats more than 20 000 items.
    """
    case = with_home(case)
    track = track_of(case)
    flown = fly_track(track, case)
    mission = judged(flown, heights_of(track, case.terrain), case)
    findings = [*more, *located([found for rule in RULES for found in rule(mission)], case)]
    return Assessment(
        name=case.name,
        autopilot=case.autopilot,
        vehicle_type=case.vehicle_type,
        frame=case.frame,
        vertical_datum=case.terrain.vertical_datum,
        departure=case.departure,
        stops=mission.stops,
        legs=mission.legs,
        profile=profile_of(mission),
        sums=sums_of(mission, strongest_gust(mission), reserve_of(mission)),
        limits=case.limits,
        findings=tuple(sorted(findings, key=_order)),
        ground=ground_map_of(mission),
        outlines=outlines_of(case),
        rally=tuple((point.point.latitude_deg, point.point.longitude_deg) for point in case.mission.rally),
        sources=case.sources,
        remarks=(*case.remarks, *track.remarks),
    )


def _order(finding: Finding) -> tuple[bool, int, str]:
    """Dangers first, then along the way."""
    return finding.severity != "danger", finding.leg or 0, finding.rule
