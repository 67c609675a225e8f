"""A plan as a mission: the route with its planned ground speeds, by the rules of the plan's autopilot."""

from __future__ import annotations

from typing import TYPE_CHECKING

from gcs_windplan.mission.build import RoutePoint, route_mission
from gcs_windplan.mission.items import Home, Mission

if TYPE_CHECKING:
    from gcs_windplan.planner import Plan

_SLOWEST = 0.01  # [m/s] no slower ground speed is commanded
_LEVEL = 1.0  # [m] a leg shorter than this in plan is a climb or descent on the spot


def mission_of(plan: Plan) -> Mission:
    """The mission that flies a plan: home on the ground under its first waypoint, speeds as planned.

    A leg straight up or down commands no ground speed.
    """
    first, last = plan.waypoints[0], plan.waypoints[-1]
    speeds = [
        None,
        *(leg.ground_speed if leg.distance >= _LEVEL and leg.ground_speed >= _SLOWEST else None for leg in plan.legs),
    ]
    route = [
        RoutePoint(waypoint.point, waypoint.altitude, speed)
        for waypoint, speed in zip(plan.waypoints, speeds, strict=True)
    ]
    request = plan.request
    return route_mission(
        Home(first.point, first.altitude - first.above_ground),
        route,
        autopilot=request.vehicle.autopilot,
        vehicle_type=request.vehicle.type,
        finish=request.finish,
        altitude=request.export.altitude,
        speed_changes=request.export.speed_changes,
        cruise_speed=request.vehicle.airspeed,
        landing_altitude=last.altitude - last.above_ground,
    )
