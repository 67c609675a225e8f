"""What the planner is asked: terrain, wind, vehicle, sites, limits, cost."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field, replace
from typing import Literal, TypeAlias

from gcs_windplan.arrays import FloatArray
from gcs_windplan.errors import Problem
from gcs_windplan.planning.cost import CostChoice
from gcs_windplan.scene import CollisionTest, Scene
from gcs_windplan.vehicle import Airframe, PowerModel, Vehicle

Finish: TypeAlias = Literal["land", "return", "hold"]
AltitudeReference: TypeAlias = Literal["relative", "amsl"]
Order: TypeAlias = Literal["given", "free"]


@dataclass(frozen=True, slots=True)
class Site:
    """A place that the route must pass (start, via, goal), or one beside it (a rally point, the fence's return point).

    `east` and `north` in the local frame [m]. Its height is `above_ground`, or `altitude` above mean sea level [m];
    with neither, the lowest layer of the veil. `field` names it in the mission file.
    """

    field: str
    east: float
    north: float
    above_ground: float | None = None
    altitude: float | None = None


@dataclass(frozen=True, slots=True, eq=False)
class FenceArea:
    """An area of the fence that the autopilot keeps by itself: in plan only, as fences have no heights.

    `places` (n, 2) [m] are a polygon's corners in the local frame; with a `radius` [m] there is one, a circle's
    centre. The route keeps to it because the airspace holds it too, with a margin. `heights_lost` where it has a
    floor or a ceiling there.
    """

    name: str
    places: FloatArray
    radius: float | None = None
    inclusion: bool = True
    heights_lost: bool = False


@dataclass(frozen=True, slots=True)
class Uniform:
    """A uniform grid; without a spacing [m] a 120th of the area's longer side.

    >>> import gcs_windplan as gw
    >>> gw.Uniform(spacing=50.0).neighbours
    16
    """

    spacing: float | None = None
    neighbours: int = 16


@dataclass(frozen=True, slots=True)
class Roadmap:
    """A probabilistic roadmap; without a number of nodes three quarters of the uniform grid's.

    >>> import gcs_windplan as gw
    >>> gw.Roadmap(nodes=2000).seed
    1
    """

    nodes: int | None = None
    seed: int = 1
    radius: float | None = None


@dataclass(frozen=True, slots=True)
class Export:
    """How the route becomes mission items: speed commands, altitudes above home or above sea level, which files.

    >>> import gcs_windplan as gw
    >>> gw.Export(altitude="amsl").speed_changes
    True
    """

    speed_changes: bool = True
    altitude: AltitudeReference = "relative"
    waypoints: bool = True
    plan: bool = True


@dataclass(frozen=True, slots=True)
class Limits:
    """What wind and battery the route must keep to; None where there is no limit.

    `wind` and `gust` [m/s] are the largest anywhere along the route. On landing must be left `battery`, a share of the
    capacity, and `reserve_seconds` of level flight at the vehicle's airspeed. `way_home`: whether home or a rally point
    must be within the battery's reach from every waypoint; None: only where the vehicle returns at the end.

    >>> import gcs_windplan as gw
    >>> gw.Limits(wind=10.0, battery=0.3).gust is None
    True
    """

    wind: float | None = None
    gust: float | None = None
    battery: float | None = None
    reserve_seconds: float | None = None
    way_home: bool | None = None

    @property
    def of_wind(self) -> bool:
        """Whether wind or gusts are limited."""
        return self.wind is not None or self.gust is not None


def _unlocated(problem: Problem) -> Problem:
    """The problem as it is: a request made in Python stands in no file."""
    return problem


@dataclass(frozen=True, slots=True, eq=False)
class Request:
    """One planning job.

    With a free `order` the vias, 12 at most, are passed in the order that costs least, not as they stand in `via`.

    `clearance`, `max_height` [m above ground] and `limits` hold for every leg along its whole length. `layers` are
    heights above ground [m], empty for an automatic choice; `margin` [m] is how far the veil reaches beyond the sites.
    A vehicle that returns at the end flies home at `return_height` above home [m], or higher if it is; or to the
    nearest `rally` point. `fence`, `fence_return` (where a vehicle that broke the fence flies to) and `rally` go into
    the mission beside the route. Where the scene's wind is an ensemble's, the route is planned for the `robust`
    quantile of its legs' cost over the members. With an `airframe` the energy is known, and each leg's airspeed may
    be chosen (`free_airspeed`). `locate` puts file and line to a problem that names a field.
    """

    name: str
    scene: Scene
    vehicle: Vehicle
    start: Site
    goal: Site
    via: tuple[Site, ...] = ()
    order: Order = "given"
    clearance: float = 30.0
    max_height: float | None = None
    limits: Limits = field(default_factory=Limits)
    cost: CostChoice = field(default_factory=CostChoice)
    graph: Uniform | Roadmap = field(default_factory=Uniform)
    layers: tuple[float, ...] = ()
    margin: float | None = None
    collision_test: CollisionTest | None = None
    finish: Finish = "land"
    return_height: float = 15.0
    export: Export = field(default_factory=Export)
    fence: tuple[FenceArea, ...] = ()
    fence_return: Site | None = None
    rally: tuple[Site, ...] = ()
    robust: float = 0.5
    airframe: Airframe | None = None
    free_airspeed: bool = False
    locate: Callable[[Problem], Problem] = _unlocated

    @property
    def sites(self) -> tuple[Site, ...]:
        """Start, vias and goal, in the order they are passed."""
        return (self.start, *self.via, self.goal)

    @property
    def power(self) -> PowerModel | None:
        """What the vehicle draws, where its airframe is known."""
        return None if self.airframe is None else self.airframe.power

    @property
    def places_beside(self) -> tuple[Site, ...]:
        """Rally points and the fence's return point: where the vehicle may go instead of along the route."""
        return self.rally if self.fence_return is None else (*self.rally, self.fence_return)

    def in_the_mean(self) -> Request:
        """The same without the members of an ensemble: only their mean blows."""
        return replace(self, scene=replace(self.scene, members=()))

    def __repr__(self) -> str:
        return f"Request({self.name!r}: {self.cost} over {self.scene.terrain.name} in {self.scene.wind.name})"
