"""A plan from above and from the side, as PNG."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from gcs_windplan.arrays import FloatArray
from gcs_windplan.assessment.outlines import outline_of
from gcs_windplan.flight import clock
from gcs_windplan.planning.planner import PlannedRoute
from gcs_windplan.planning.sites import choose_area
from gcs_windplan.report import map as maps
from gcs_windplan.report import profile as profiles
from gcs_windplan.report.map import MapPlace, MapRoute, MapView, WindArrows
from gcs_windplan.report.profile import ProfileView
from gcs_windplan.report.relief import Ground
from gcs_windplan.terrain import Extent

_PIXELS = 500  # of relief along the longer side
_ARROWS = 18  # along the longer side
_SAMPLES = 1200  # of the ground under a route
_SAME_PLACE = 0.1  # [m]
_MARKERS = {"start": "^", "goal": "s"}


def draw_map(plans: Sequence[PlannedRoute], dpi: int = 120) -> bytes:
    """One or several routes of one request on a map, as PNG.

    A single route is coloured by its ground speed; several are told apart by colour and dash.
    """
    plan, request = plans[0], plans[0].request
    routes = [_route(one) for one in plans]
    extent = maps.frame_of([route.line for route in routes], request.scene.terrain.extent)
    airspace = request.scene.airspace
    seen = () if request.scene.obstacles is None else tuple(request.scene.obstacles.triangles[:, :, :2])
    areas = [outline_of(prism, "keep-out") for prism in airspace.keep_out]
    areas += [outline_of(prism, "keep-in") for prism in airspace.keep_in]
    places = [MapPlace(_name(s.field), s.east, s.north, _MARKERS.get(s.field, "D")) for s in request.sites]
    if len(plans) == 1:
        places += _stops(plan)
    view = MapView(
        _title(plans), extent, _ground(plan, extent), _wind(plan, extent), routes, areas=areas, solids=seen,
        places=places,
    )  # fmt: skip
    return maps.draw_view(view, dpi)


def draw_profile(plan: PlannedRoute, dpi: int = 120) -> bytes:
    """Ground, clearance, height limit and route over the distance flown; below it ground speed and wind, as PNG."""
    request, totals = plan.request, plan.totals
    flown = np.concatenate([[0.0], np.cumsum([leg.distance for leg in plan.legs])])
    along = np.unique(np.concatenate([np.linspace(0, flown[-1], _SAMPLES), flown]))
    corners = np.array([(w.east, w.north, w.altitude) for w in plan.waypoints])
    under = np.column_stack([np.interp(along, flown, corners[:, i]) for i in range(2)])
    speeds = np.array([(leg.ground_speed, leg.airspeed, leg.wind_along) for leg in plan.legs])
    ground_speed, airspeed, wind_along = np.repeat(speeds, 2, axis=0).T  # at both ends of each leg
    view = ProfileView(
        f"{request.name}: at least {totals.clearance:.1f} m and at most {totals.height:.1f} m above ground",
        along=along, ground=request.scene.terrain.heights_at(under), flown=flown, altitude=corners[:, 2],
        clearance=request.clearance, max_height=request.max_height, vertical_datum=request.scene.terrain.vertical_datum,
        speeds_at=np.repeat(flown, 2)[1:-1], ground_speed=ground_speed, airspeed=airspeed, wind_along=wind_along,
    )  # fmt: skip
    return profiles.draw_view(view, dpi)


def _route(plan: PlannedRoute) -> MapRoute:
    line = np.array([(w.east, w.north) for w in plan.waypoints])
    name = f"{plan.choice}: {clock(plan.totals.seconds)} min"
    return MapRoute(name, line, np.array([leg.ground_speed for leg in plan.legs]))


def _stops(plan: PlannedRoute) -> list[MapPlace]:
    """The waypoints with their numbers, but for those at the sites, which have names."""
    sites = np.array([(site.east, site.north) for site in plan.request.sites])
    return [
        MapPlace(str(w.number), w.east, w.north)
        for w in plan.waypoints
        if np.hypot(*(sites - (w.east, w.north)).T).min() > _SAME_PLACE
    ]


def _ground(plan: PlannedRoute, extent: Extent) -> Ground:
    """The terrain in an extent."""
    x, y = maps.grid(extent, _PIXELS)
    heights = plan.request.scene.terrain.heights_at(np.column_stack([x.ravel(), y.ravel()])).reshape(x.shape)
    return Ground(extent.west, extent.south, extent.east, extent.north, heights)


def _wind(plan: PlannedRoute, extent: Extent) -> WindArrows:
    """The wind at the route's mean height above ground, where it need be known."""
    request = plan.request
    places = _arrow_places(plan, extent)
    ground = request.scene.terrain.heights_at(places)
    above = float(np.mean([w.above_ground for w in plan.waypoints]))
    points = np.column_stack([places, ground + above])[np.isfinite(ground)]
    wind = request.scene.wind.at(points)
    known = np.isfinite(wind[:, 0])
    where = f"{above:.0f} m above ground"
    if len(request.scene.wind.times) > 1:
        where += ", at the departure"
    if request.scene.members:
        where += ", mean of all members"
    return WindArrows(points[known, :2], wind[known, :2], where, _ARROWS)


def _arrow_places(plan: PlannedRoute, extent: Extent) -> FloatArray:
    """Places (n, 2) inside of the map and of the area planned in: the wind need not be known beyond it."""
    sites = np.array([(site.east, site.north) for site in plan.request.sites])
    planned = choose_area(plan.request, sites)
    inset = 0.5 / _ARROWS * max(extent.east - extent.west, extent.north - extent.south)
    inner = Extent(
        max(extent.west + inset, planned.west),
        max(extent.south + inset, planned.south),
        min(extent.east - inset, planned.east),
        min(extent.north - inset, planned.north),
    )
    x, y = maps.grid(inner, _ARROWS)
    return np.column_stack([x.ravel(), y.ravel()])


def _name(field: str) -> str:
    """A site's name on the map."""
    return field.replace("via.", "via ")


def _title(plans: Sequence[PlannedRoute]) -> str:
    plan = plans[0]
    what = f"least {plan.choice}, {plan.totals.length / 1000:.2f} km in {clock(plan.totals.seconds)} min"
    head = what if len(plans) == 1 else "routes of least " + ", ".join(p.choice.name for p in plans)
    return f"{plan.request.name}: {head}"
