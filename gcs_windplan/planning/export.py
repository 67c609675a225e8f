"""A plan as a mission: the route with its planned ground speeds, by the rules of the plan's autopilot."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator
from dataclasses import replace
from typing import TYPE_CHECKING

from gcs_windplan.flight.duration import MissionDuration, duration_of
from gcs_windplan.geo.frame import GeoPoint
from gcs_windplan.mission.fence import Fence, FenceCircle, FencePolygon, RallyPoint, ReturnPoint
from gcs_windplan.mission.firmware import firmware_of
from gcs_windplan.mission.firmware.storage import FLOAT
from gcs_windplan.mission.items import Home
from gcs_windplan.mission.mission_items import MissionItems
from gcs_windplan.planning.route_items import RoutePoint, route_mission
from gcs_windplan.planning.sites import choose_layers, site_points

if TYPE_CHECKING:
    from gcs_windplan.arrays import FloatArray
    from gcs_windplan.geo.frame import LocalFrame
    from gcs_windplan.planning.planner import PlannedRoute
    from gcs_windplan.planning.request import Request, Site

_SLOWEST = 0.01  # [m/s] no slower ground speed is commanded
_HAIR = 1e-6  # [m] what rounding may have added to a whole number
_FASTEST = 1000.0  # [m/s] no limit
_LEVEL = 1.0  # [m] a leg shorter than this in plan is a climb or descent on the spot


def flown_duration(plan: PlannedRoute) -> MissionDuration | None:
    """How long the autopilot takes for a plan, corners and acceleration counted; None for a fixed-wing.

    The plan's ground speeds are commanded, so that its wind is in them already; no lean angle holds the vehicle back.
    """
    if not plan.request.vehicle.hovers:
        return None
    pace = replace(firmware_of(plan.request.vehicle.autopilot).motion, airspeed=_FASTEST)
    return duration_of(mission_of(plan), pace=pace)


def mission_of(plan: PlannedRoute) -> MissionItems:
    """The mission that flies a plan: home on the ground under its first waypoint, speeds as planned.

    A leg straight up or down commands no speed; a fixed-wing is told airspeeds. Fence and rally points of the request
    come with it; rally points are given above home, which every version of every autopilot takes.
    """
    first, last = plan.waypoints[0], plan.waypoints[-1]
    request = plan.request
    route = [RoutePoint(first.point, first.altitude)]
    for leg, waypoint in zip(plan.legs, plan.waypoints[1:], strict=True):
        moves = leg.distance >= _LEVEL and leg.ground_speed >= _SLOWEST
        airspeed = None if request.vehicle.hovers else leg.airspeed
        route.append(RoutePoint(waypoint.point, waypoint.altitude, leg.ground_speed if moves else None, airspeed))
    home = Home(first.point, first.altitude - first.above_ground)
    mission = route_mission(
        home,
        route,
        autopilot=request.vehicle.autopilot,
        vehicle_type=request.vehicle.type,
        finish=request.finish,
        altitude=request.export.altitude,
        speed_changes=request.export.speed_changes,
        cruise_speed=request.vehicle.airspeed,
        landing_altitude=last.altitude - last.above_ground,
    )
    return replace(mission, fence=_fence(request, home), rally=tuple(_rally(request, home)))


def _fence(request: Request, home: Home) -> Fence | None:
    """The request's fence, from the local frame to the Earth."""
    if not request.fence:
        return None
    polygons = [
        FencePolygon(tuple(_points(area.places, request.scene.frame)), area.inclusion)
        for area in request.fence
        if area.radius is None
    ]
    circles = [
        FenceCircle(next(_points(area.places, request.scene.frame)), area.radius, area.inclusion)
        for area in request.fence
        if area.radius is not None
    ]
    back = [] if request.fence_return is None else [request.fence_return]
    points = [ReturnPoint(point, height) for point, height in _above_home(back, request, home)]
    return Fence(tuple(polygons), tuple(circles), points[0] if points else None)


def _rally(request: Request, home: Home) -> Iterator[RallyPoint]:
    for point, height in _above_home(request.rally, request, home):
        # never below what was planned, where whole metres are stored
        whole = math.ceil(height - _HAIR)
        exact = firmware_of(request.vehicle.autopilot).rally == FLOAT
        yield RallyPoint(point, height if exact else whole)


def _above_home(sites: Iterable[Site], request: Request, home: Home) -> Iterator[tuple[GeoPoint, float]]:
    """Where sites are, and their heights above home [m]."""
    places = site_points(request, list(sites), choose_layers(request))
    for point, altitude in zip(_points(places, request.scene.frame), places[:, 2], strict=True):
        yield point, float(altitude) - home.altitude


def _points(places: FloatArray, frame: LocalFrame) -> Iterator[GeoPoint]:
    for latitude, longitude in zip(*frame.to_geographic(places), strict=True):
        yield GeoPoint(float(latitude), float(longitude))
