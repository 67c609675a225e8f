"""Where the sites stand, and the veil's area, layers and spacing where the request leaves them open."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import NoReturn

import numpy as np

from gcs_windplan.arrays import FloatArray
from gcs_windplan.errors import Problem, RequestError
from gcs_windplan.planning.contradictions import height_problems, limits_without_airframe, too_many_to_order
from gcs_windplan.planning.request import Request, Roadmap, Site, Uniform
from gcs_windplan.planning.veil import SHARE_OF_GRID, roadmap_radius
from gcs_windplan.scene import Airspace, Clearance
from gcs_windplan.terrain import Extent, Terrain

_USUAL_ROOM = 90.0  # [m] from the clearance up, where no height limit is given: 30 m and 120 m are the usual pair
_LAYERS = (0.2, 0.5, 0.8)  # of the room between clearance and height limit
_NODES_ALONG = 120  # of the area's longer side
_MARGIN = 0.25  # of the longest section between two sites
_MOST_NODES = 20_000_000  # of a grid: 5 GB
_MOST_EDGES = 1e7  # of a roadmap: 3 GB
_SLACK = 1e-6  # [m]
_SAME = 0.01  # [m]


def choose_layers(request: Request) -> tuple[float, ...]:
    """The request's layers, or three between clearance and height limit [m above ground]."""
    if request.layers:
        return request.layers
    limit = request.max_height if request.max_height is not None else request.clearance + _USUAL_ROOM
    return tuple(request.clearance + share * (limit - request.clearance) for share in _LAYERS)


def choose_area(request: Request, sites: FloatArray) -> Extent:
    """The box of all sites with the margin around it, as far as there is terrain."""
    margin = choose_margin(sites, request.margin)
    west, south = sites[:, :2].min(axis=0) - margin
    east, north = sites[:, :2].max(axis=0) + margin
    edge = request.scene.terrain.extent
    return Extent(max(west, edge.west), max(south, edge.south), min(east, edge.east), min(north, edge.north))


def choose_margin(sites: FloatArray, margin: float | None) -> float:
    """How far the veil reaches beyond the sites (n, 2 or more) [m]: the given margin, or a quarter of the way."""
    if margin is not None:
        return margin
    return _MARGIN * float(np.max(np.linalg.norm(np.diff(sites[:, :2], axis=0), axis=1)))


def choose_spacing(request: Request, area: Extent) -> float:
    """The uniform grid's spacing [m]: the request's, or so that the area's longer side has 120 nodes."""
    if isinstance(request.graph, Uniform) and request.graph.spacing is not None:
        return request.graph.spacing
    return max(area.east - area.west, area.north - area.south) / _NODES_ALONG


def choose_nodes(request: Request, area: Extent) -> int:
    """The roadmap's places: the request's, or three quarters of what a uniform grid would have."""
    if isinstance(request.graph, Roadmap) and request.graph.nodes is not None:
        return request.graph.nodes
    cells = (area.east - area.west) * (area.north - area.south) / choose_spacing(request, area) ** 2
    return max(2, round(SHARE_OF_GRID * cells))


def check_graph_size(request: Request, area: Extent, layers: Sequence[float]) -> None:
    """Raise `RequestError` for a veil without any node, or with more nodes or edges than fit into memory."""
    width, depth = area.east - area.west, area.north - area.south
    if isinstance(request.graph, Roadmap):
        places = choose_nodes(request, area)
        radius = request.graph.radius or roadmap_radius(places, area)
        edges = (places * len(layers)) ** 2 / 2 * min(1.0, math.pi * radius**2 / (width * depth))
        if edges > _MOST_EDGES:
            text = (
                f"{places} nodes in {len(layers)} layers within {radius:.0f} m make about {edges:.2g} edges, more than"
            )
            _refuse(request, f"{text} {_MOST_EDGES:.0g}: fewer nodes, layers or a smaller radius", "graph.prm")
        return
    spacing = choose_spacing(request, area)
    nodes = (width / spacing + 1) * (depth / spacing + 1) * len(layers)
    if nodes > _MOST_NODES:
        text = f"{spacing:g} m over {width:.0f} x {depth:.0f} m in {len(layers)} layers makes {nodes:.2g}"
        coarser = spacing * math.sqrt(nodes / _MOST_NODES)
        _refuse(request, f"{text} nodes, more than {_MOST_NODES:.2g}: {coarser:.2g} m or more", "graph.uniform.spacing")
    if spacing > max(width, depth):
        text = f"{spacing:g} m is more than the area of {width:.0f} x {depth:.0f} m: refine it"
        _refuse(request, f"{text}, or widen graph.margin", "graph.uniform.spacing")


def _refuse(request: Request, text: str, field: str) -> NoReturn:
    raise RequestError(request.locate(Problem(text, field)))


def site_points(request: Request, sites: Sequence[Site], layers: Sequence[float]) -> FloatArray:
    """Sites as points (n, 3) [m]; a height over unknown terrain is NaN where it counts from the ground."""
    points = np.empty((len(sites), 3))
    for i, site in enumerate(sites):
        ground = _ground(request.scene.terrain, site.east, site.north)
        points[i] = site.east, site.north, _height(site, ground, layers[0])
    return points


def place_sites(request: Request, rules: Clearance, layers: Sequence[float]) -> tuple[FloatArray, list[Problem]]:
    """Start, vias and goal as points (n, 3) [m], and everything that is wrong with them and with places beside."""
    problems = _limits(request, layers)
    points = site_points(request, request.sites, layers)
    beside = site_points(request, request.places_beside, layers)
    landing = {"start", "goal"} if request.finish == "land" else {"start"}
    if request.vehicle.type == "multicopter":
        landing |= {site.field for site in request.rally}  # where it lands; a fixed-wing circles there
    everything = [*zip(request.sites, points, strict=True), *zip(request.places_beside, beside, strict=True)]
    for site, point in everything:
        problem = _misplaced(site, point, request, rules)
        if problem is None and site.field in landing:
            problem = _column_blocked(point, rules)
        if problem is not None:
            problems.append(Problem(problem, site.field))
    if not problems and request.finish == "return":
        problems += _returns_blocked(request, points, beside, rules)
    return points, problems


def _ground(terrain: Terrain, east: float, north: float) -> float:
    """The terrain's height at a place [m above mean sea level], NaN where it is not known."""
    return float(terrain.heights_at(np.array([[east, north]]))[0])


def _column_blocked(point: FloatArray, rules: Clearance) -> str | None:
    """What stands in the way straight up from the ground to a point, or down to it."""
    foot = point.copy()
    foot[2] = _ground(rules.terrain, point[0], point[1])
    obstacles, keep_out = rules.obstacles, Airspace(rules.airspace.keep_out)
    if broken := keep_out.broken_by(foot, point):
        return f"the way straight up from the ground there crosses '{broken[0]}': move the site or correct the area"
    if obstacles is not None and obstacles.leg_margins(foot[None], point[None])[0] < -_SLACK:
        return "the way straight up from the ground there comes too close to an obstacle: move the site"
    return None


def _returns_blocked(request: Request, points: FloatArray, beside: FloatArray, rules: Clearance) -> list[Problem]:
    """What the straight flight back breaks: the one home, and those to the rally points, which may be nearer."""
    home = _ground(rules.terrain, points[0, 0], points[0, 1])
    height = max(float(points[-1, 2]), home + request.return_height)
    problems = _return_blocked("finish", "home", points[-1], points[0], (home, height), rules)
    for site, point in zip(request.rally, beside[: len(request.rally)], strict=True):
        levels = home, max(height, float(point[2]))
        problems += _return_blocked(site.field, "from the goal to it", points[-1], point, levels, rules)
    return problems


def _return_blocked(
    field: str, way: str, goal: FloatArray, target: FloatArray, levels: tuple[float, float], rules: Clearance
) -> list[Problem]:
    """What is wrong with the straight flight from the goal over a target; `levels` are home's and the flight's."""
    away, back = goal.copy(), target.copy()
    away[2] = back[2] = levels[1]
    heights = rules.terrain.leg_heights(away[None], back[None])[0]
    problems = []
    if not heights[0] >= rules.minimum - _SLACK:
        problems.append(Problem(_low_return(way, levels, heights[0], rules.minimum), field))
    elif heights[1] > rules.maximum + _SLACK:
        text = f"the straight flight {way} at {levels[1]:.0f} m above sea level is {heights[1]:.1f} m above ground"
        problems.append(Problem(f"{text}, more than limits.max_height: lower the goal, or land there", field))
    if broken := rules.airspace.broken_by(away, back):
        problems.append(Problem(f"the straight flight {way} breaks '{broken[0]}': land at the goal instead", field))
    obstacles = rules.obstacles
    if obstacles is not None and obstacles.leg_margins(away[None], back[None])[0] < -_SLACK:
        problems.append(Problem(f"the straight flight {way} comes too close to an obstacle: land at the goal", field))
    return problems


def _limits(request: Request, layers: Sequence[float]) -> list[Problem]:
    """Limits that contradict each other."""
    problems = []
    airframe = request.airframe
    if airframe is not None and request.vehicle.airspeed > airframe.maximum_airspeed:
        text = (
            f"{request.vehicle.airspeed:g} m/s is more than the airframe's maximum, {airframe.maximum_airspeed:g} m/s"
        )
        problems.append(Problem(f"{text}: lower it", "vehicle.airspeed"))
    if airframe is not None and request.vehicle.type != airframe.vehicle.type:
        text = f"the airframe ({airframe.name}) is a {airframe.vehicle.type}: leave `type` out"
        problems.append(Problem(text, "vehicle.type"))
    limits = request.limits
    return [
        *problems,
        *height_problems(request.clearance, request.max_height, layers),
        *limits_without_airframe(
            battery=limits.battery is not None,
            reserve=limits.reserve_seconds is not None,
            airframe=airframe is not None,
        ),
    ]


def _height(site: Site, ground: float, lowest_layer: float) -> float:
    """A site's height above mean sea level [m]."""
    if site.altitude is not None:
        return site.altitude
    return ground + (lowest_layer if site.above_ground is None else site.above_ground)


def _misplaced(site: Site, point: FloatArray, request: Request, rules: Clearance) -> str | None:
    """What is wrong with a site's place or height, if anything."""
    ground = _ground(rules.terrain, site.east, site.north)
    outside = rules.terrain.extent.misses(site.east, site.north)
    if outside > 0:
        return f"lies {outside / 1000:.2f} km outside of the terrain ({rules.terrain.name}): move it or add a tile"
    if math.isnan(ground):
        return f"the terrain ({rules.terrain.name}) has no data there: move it or use another DEM"
    above = point[2] - ground
    if above < 0:
        return f"lies {-above:.1f} m below the ground ({ground:.1f} m above sea level there): raise it"
    if above < rules.minimum - _SLACK:
        return f"is {above:.1f} m above ground, less than the clearance of {rules.minimum:g} m: raise it or lower that"
    if above > rules.maximum + _SLACK:
        return f"is {above:.1f} m above ground, above limits.max_height, {rules.maximum:g} m: lower it or raise that"
    broken = rules.airspace.broken_by(point, point)
    if broken:
        return f"lies where '{broken[0]}' forbids it: move the site, or correct the area or its floor and ceiling"
    if rules.obstacles is not None and rules.obstacles.leg_margins(point[None], point[None])[0] < -_SLACK:
        return "lies inside an obstacle or closer to it than its margin: move or raise it"
    return None


def _low_return(way: str, levels: tuple[float, float], lowest: float, clearance: float) -> str:
    """What to say of a flight back whose smallest height over the ground is `lowest` [m]."""
    home, height = levels
    if math.isnan(lowest):
        return f"the straight flight {way} leads over unknown ground: land at the goal"
    passes = f"within {lowest:.0f} m of" if lowest >= 0 else f"{-lowest:.0f} m below"
    needed = math.ceil(height - home + clearance - lowest)
    return (
        f"the straight flight {way} at {height:.0f} m above sea level passes {passes} the ground: land at the goal, or"
        f" set the vehicle's return altitude and `return_height` to {needed} m"
    )


def windless_sites(request: Request, points: FloatArray) -> list[Problem]:
    """The sites (n, 3) at which the wind is not known."""
    unknown = np.isnan(request.scene.wind.at(points)[:, 0])
    text = (
        "lies above the highest level of the wind ({}): lower it, take a file with higher levels, or carry it up with"
        " `profile`"
    )
    return [
        Problem(text.format(request.scene.wind.name), site.field)
        for site, gone in zip(request.sites, unknown, strict=True)
        if gone
    ]


def too_many_or_equal(request: Request, sites: FloatArray) -> list[Problem]:
    """What is wrong with vias that are to be put in order: more than 12, or two places (n, 3) that are one."""
    if request.order == "given":
        return []
    problems = list(too_many_to_order(len(request.via)))
    if problems:
        return problems
    for i in range(1, len(sites) - 1):
        apart = np.linalg.norm(sites - sites[i], axis=1)
        same = next((j for j in (*range(i), len(sites) - 1) if apart[j] < _SAME), None)
        if same is not None:
            text = f"is the same place as {request.sites[same].field}: leave one of the two out"
            problems.append(Problem(text, request.sites[i].field))
    return problems
