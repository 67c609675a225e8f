"""Judging a mission: fly it on paper, then hold every rule against it."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import replace
from pathlib import Path

from gcs_windplan.assessment.assessment import Assessment, Finding
from gcs_windplan.assessment.case import Case
from gcs_windplan.assessment.figures import assessed_mission, totals_of
from gcs_windplan.assessment.flown import fly_track
from gcs_windplan.assessment.heights import heights_of
from gcs_windplan.assessment.home import check_places, with_home
from gcs_windplan.assessment.outlines import outlines_of
from gcs_windplan.assessment.profile import ground_map_of, profile_of
from gcs_windplan.assessment.rules import RULES
from gcs_windplan.assessment.rules.battery import reserve_of
from gcs_windplan.assessment.rules.places import located
from gcs_windplan.assessment.rules.wind import strongest_gust, strongest_wind
from gcs_windplan.assessment.track import Track, track_of
from gcs_windplan.assessment.wording import message_of
from gcs_windplan.errors import InputError


def assess(case: Case, more: Iterable[Finding] = ()) -> Assessment:
    """Judge a mission.

    `more` are findings that were made elsewhere, such as those of the firmware's own rules. Raises `InputError`, which
    names the mission's file, for a mission that leads nowhere, lies elsewhere, or repeats more than 20 000 items.
    """
    case, track = _tracked(case)
    flown = fly_track(track, case)
    mission = assessed_mission(flown, heights_of(track, case.scene.terrain), case)
    findings = [*more, *located([found for rule in RULES for found in rule(mission)], case)]
    findings = [replace(one, message=one.message or message_of(one)) for one in findings]
    return Assessment(
        name=case.name,
        autopilot=case.autopilot,
        vehicle_type=case.vehicle_type,
        frame=case.scene.frame,
        vertical_datum=case.scene.terrain.vertical_datum,
        departure=case.scene.departure,
        stops=mission.stops,
        legs=mission.legs,
        profile=profile_of(mission),
        totals=totals_of(mission, strongest_wind(mission), strongest_gust(mission), reserve_of(mission)),
        limits=case.limits,
        findings=tuple(sorted(findings, key=_order)),
        ground=ground_map_of(mission),
        outlines=outlines_of(case),
        rally=tuple((point.point.latitude_deg, point.point.longitude_deg) for point in case.mission.rally),
        sources=case.sources,
        remarks=(*case.remarks, *_assumed(case), *track.remarks),
    )


def _tracked(case: Case) -> tuple[Case, Track]:
    """The case with a home, and its track."""
    file = next((Path(one.file) for one in case.sources if one.role == "mission" and one.file is not None), None)
    try:
        check_places(case)
        case = with_home(case)
        return case, track_of(case)
    except InputError as error:
        raise InputError([one if one.file else replace(one, file=file) for one in error.problems]) from None


def _assumed(case: Case) -> Iterator[str]:
    """What the judgement takes for granted."""
    members = len(case.scene.members)
    if members:
        yield (
            f"time and battery are those in the mean wind of {members} members; the strongest wind, gusts and"
            " which legs can be flown are looked at in each"
        )
    if case.airframe is None or not case.hovers:
        return
    vehicle, pace = case.airframe.vehicle, case.pace
    if (vehicle.climb, vehicle.descent) != (pace.climb, pace.descent):
        yield (
            f"it climbs and descends at the autopilot's defaults, {pace.climb:g} and {pace.descent:g} m/s, where the"
            f" mission commands nothing else; the airframe's are {vehicle.climb:g} and {vehicle.descent:g} m/s"
        )


def _order(finding: Finding) -> tuple[bool, int, str]:
    """Dangers first, then along the way."""
    return finding.severity != "danger", finding.leg or 0, finding.rule
