"""A plan as a case: its mission judged by its own request."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Final

from gcs_windplan.assessment.assessment import Assessment, AssessmentLimits, Source
from gcs_windplan.assessment.case import Case
from gcs_windplan.assessment.judge import assess
from gcs_windplan.mission import MissionItems
from gcs_windplan.mission.firmware import firmware_of
from gcs_windplan.planning.export import mission_of
from gcs_windplan.planning.planner import PlannedRoute
from gcs_windplan.planning.request import Request
from gcs_windplan.vehicle import MotionProfile, Vehicle

_FASTEST: Final = 1000.0  # [m/s] no limit


def assess_plan(plan: PlannedRoute, sources: Sequence[Source] = ()) -> Assessment:
    """Judge the mission that flies a plan, by the terrain, wind, vehicle and limits of its request."""
    return assess(replace(case_of(plan.request, mission_of(plan), sources), remarks=plan.notes))


def case_of(request: Request, mission: MissionItems, sources: Sequence[Source] = ()) -> Case:
    """Any mission in a request's world and by its limits; the autopilot and vehicle are the request's."""
    vehicle, airframe = request.vehicle, request.airframe
    mission = replace(mission, autopilot=vehicle.autopilot, vehicle_type=vehicle.type)
    return Case(
        name=request.name,
        mission=mission,
        scene=request.scene,
        autopilot=vehicle.autopilot,
        vehicle_type=vehicle.type,
        pace=pace_for(request),
        cruise=vehicle.airspeed,
        limits=limits_of(request),
        airframe=airframe,
        robust=request.robust,
        sources=tuple(sources),
    )


def pace_for(request: Request) -> MotionProfile:
    """The autopilot's pace with the request's return height, and the airframe's largest airspeed where it is known."""
    fastest = _FASTEST if request.airframe is None else request.airframe.maximum_airspeed
    pace = replace(firmware_of(request.vehicle.autopilot).motion, airspeed=fastest, return_height=request.return_height)
    return pace_with_rates(pace, request.vehicle)


def pace_with_rates(pace: MotionProfile, vehicle: Vehicle) -> MotionProfile:
    """The pace with a fixed-wing's own rates of climb and descent; a multicopter keeps its autopilot's."""
    return pace if vehicle.hovers else replace(pace, climb=vehicle.climb, descent=vehicle.descent)


def limits_of(request: Request) -> AssessmentLimits:
    """The request's limits, and what its vehicle can do."""
    vehicle, airframe = request.vehicle, request.airframe
    return AssessmentLimits(
        clearance=request.clearance,
        max_height=request.max_height,
        wind=request.limits.wind,
        gust=request.limits.gust,
        battery=request.limits.battery,
        reserve_seconds=request.limits.reserve_seconds,
        climb=vehicle.climb,
        descent=vehicle.descent,
        airspeed=None if airframe is None else airframe.maximum_airspeed,
    )
