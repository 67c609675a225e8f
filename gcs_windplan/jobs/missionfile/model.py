"""The mission file's schema: vehicle, sites, limits, cost, graph and the mission itself."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import ClassVar, Literal

from pydantic import Field

from gcs_windplan.jobs.missionfile.areas import FenceModel
from gcs_windplan.jobs.missionfile.limits import LimitsModel
from gcs_windplan.jobs.missionfile.rules import DEFAULT_CLEARANCE, mission_contradictions
from gcs_windplan.jobs.missionfile.section import Fields, SchemaProblem, Section, at_most_one, suggestion
from gcs_windplan.jobs.missionfile.values import (
    WEIGHT,
    AirspeedOrFree,
    FileName,
    FileStem,
    Flag,
    Height,
    NodeCount,
    PositiveLength,
    PositiveSpeed,
    Quantile,
    Seed,
    UtcTime,
    Weight,
)
from gcs_windplan.jobs.missionfile.world import ObstacleModel, SiteModel, TerrainModel, WindModel
from gcs_windplan.jobs.words import AutopilotName, VehicleKind


class VehicleModel(Section):
    """The vehicle and its autopilot; what is not written here is the airframe's, where one is named."""

    airframe: FileName | None = Field(
        default=None, description="a file with its speeds, mass, battery and power; relative to this file"
    )
    type: VehicleKind = Field(default="multicopter", description="kind of airframe")
    autopilot: AutopilotName = Field(default="ardupilot", description="firmware the mission is for")
    airspeed: AirspeedOrFree | None = Field(
        default=None,
        description="cruise speed through the air; needed without an `airframe`. `free`: each leg at its own, between"
        " the airframe's of least power and its largest, whatever serves the cost best",
        examples=["12 m/s"],
    )
    climb: PositiveSpeed = Field(default=2.5, description="largest speed upwards")
    descent: PositiveSpeed = Field(default=1.5, description="largest speed downwards")
    speed_model: Literal["triangle", "paper"] = Field(
        default="triangle",
        description="ground speed in wind: the exact wind triangle, or the paper's equation (12)",
    )

    @classmethod
    def contradictions(cls, fields: Fields) -> Iterator[SchemaProblem]:
        """No speed from anywhere; a misspelt one is told anyway."""
        known = list(cls.model_fields)
        meant = {name if name in known else suggestion(name, known) for name in fields}
        if not meant & {"airspeed", "airframe"}:
            yield SchemaProblem(("airspeed",), "is missing; add it, for example 'airspeed: 12 m/s'", at_key=True)
        if fields.get("airspeed") == "free" and "airframe" not in meant:
            yield SchemaProblem(("airspeed",), "to be free to choose asks for the vehicle's power; name its `airframe`")


class CostModel(Section):
    """What the search adds up."""

    expects: ClassVar[str] = "distance, angle, hybrid, time or energy, or {name: hybrid, distance: 0.1, angle: 0.9},"
    alone: ClassVar[str] = "name"

    name: Literal["distance", "angle", "hybrid", "time", "energy"] = Field(
        description="the cost; `cost: time` is short for `cost: {name: time}`. `energy` asks for an `airframe`",
        examples=["time"],
    )
    distance: Weight = Field(default=0.1, description="weight of the distance; only with hybrid")
    angle: Weight = Field(default=0.9, description="weight of the angle to the wind; only with hybrid")

    @classmethod
    def expanded(cls, data: object) -> object:
        """A name alone is a cost without weights."""
        return {"name": data} if isinstance(data, str) else data

    @classmethod
    def contradictions(cls, fields: Fields) -> Iterator[SchemaProblem]:
        """Weights of a cost that has none, or only zeros."""
        weights = [name for name in ("distance", "angle") if name in fields]
        if fields.get("name") in ("distance", "angle", "time", "energy"):
            for weight in weights:
                yield SchemaProblem((weight,), "a weight belongs only to the hybrid cost; leave it out", at_key=True)
        elif len(weights) == 2 and all(WEIGHT.read_or_none(fields[name]) == 0 for name in weights):
            yield SchemaProblem(("angle",), "distance and angle cannot both weigh 0; give one of them a weight")


class UniformModel(Section):
    """A regular grid of nodes."""

    spacing: PositiveLength | None = Field(
        default=None, description="between nodes; default: chosen from the distance to fly"
    )
    neighbours: Literal[8, 16, 32, 64] = Field(default=16, description="how many neighbours a node has")


class PrmModel(Section):
    """A probabilistic road map: nodes at random places."""

    nodes: NodeCount | None = Field(default=None, description="how many; default: three quarters of a uniform grid's")
    seed: Seed = Field(default=1, description="the same seed gives the same nodes")
    radius: PositiveLength | None = Field(
        default=None, description="how far neighbours lie apart at most; default: chosen"
    )


class GraphModel(Section):
    """The veil: nodes above the terrain, and how they are joined. Without `prm` it is uniform."""

    uniform: UniformModel | None = Field(default=None, description="a regular grid; the default")
    prm: PrmModel | None = Field(default=None, description="random nodes; beside it no `uniform`")
    layers: tuple[PositiveLength, ...] | None = Field(
        default=None,
        min_length=1,
        description="heights above ground of the sheets of nodes, upwards; default: chosen",
    )
    margin: Height | None = Field(
        default=None, description="how far the veil reaches beyond the sites; default: chosen"
    )

    @classmethod
    def expanded(cls, data: object) -> object:
        """Without a road map the graph is uniform."""
        if isinstance(data, dict) and not ("prm" in data or "uniform" in data):
            return {**data, "uniform": {}}
        return data

    @classmethod
    def contradictions(cls, fields: Fields) -> Iterator[SchemaProblem]:
        """Both kinds of graph."""
        yield from at_most_one(fields, "uniform", "prm")


class ExportModel(Section):
    """What is written, and how."""

    speed_changes: Flag = Field(default=True, description="set the speed at each leg")
    altitude: Literal["relative", "amsl"] = Field(
        default="relative", description="altitudes of mission items: above home, or above mean sea level"
    )
    waypoints: Flag = Field(default=True, description="write a .waypoints file")
    plan: Flag = Field(default=True, description="write a .plan file")


_PLACE = "{latitude: 38.1, longitude: 23.7}"


class MissionModel(Section):
    """A mission file."""

    elsewhere: ClassVar[Mapping[str, str]] = {
        name: "into `limits:`" for name in LimitsModel.model_fields if name != "wind"
    }

    name: FileStem = Field(description="of the mission and of the files written", examples=["ridge-crossing"])
    vehicle: VehicleModel = Field(description="what flies", examples=["{airspeed: 12 m/s}"])
    terrain: TerrainModel = Field(
        description="the ground; exactly one of dem, sample, mesh, surface, flat", examples=["{dem: tile.tif}"]
    )
    obstacles: tuple[ObstacleModel, ...] = Field(default=(), description="closed meshes that stand on the terrain")
    wind: WindModel = Field(description="exactly one of calm, constant, paper, forecast", examples=["{calm: true}"])
    start: SiteModel = Field(description="where the route begins", examples=[_PLACE])
    goal: SiteModel = Field(description="where the route ends", examples=[_PLACE])
    via: tuple[SiteModel, ...] = Field(default=(), description="places to pass on the way")
    order: Literal["given", "free"] = Field(
        default="given",
        description="in which order `via` is passed: as it stands, or as costs least (12 places at most)",
    )
    clearance: PositiveLength = Field(
        default=DEFAULT_CLEARANCE, description="smallest vertical distance of any leg to the ground"
    )
    collision_test: Literal["exact", "paper"] = Field(
        default="exact",
        description="whether a leg clears the ground: exactly, by the clearance, or by the paper's sampled test",
    )
    cost: CostModel = Field(default=CostModel(name="time"), description="what the route is to be the best in")
    graph: GraphModel = Field(default=GraphModel(uniform=UniformModel()), description="the nodes that are searched")
    limits: LimitsModel = Field(default=LimitsModel(), description="what the route must keep")
    fence: FenceModel = Field(default=FenceModel(), description="the autopilot's own fence; see `limits.keep_out`")
    rally: tuple[SiteModel, ...] = Field(
        default=(), description="rally points: where the vehicle may return to in place of home"
    )
    robust: Quantile | None = Field(
        default=None,
        description="plan for this quantile of the cost over the members of an ensemble, such as 0.9; default 0.5; only"
        " with `wind.members`",
    )
    departure: UtcTime | None = Field(default=None, description="the time of take-off; kept in UTC")
    finish: Literal["land", "return", "hold"] = Field(default="land", description="what to do at the goal")
    return_height: Height = Field(
        default=15.0, description="above home, what the vehicle's return altitude is set to; only for `finish: return`"
    )
    export: ExportModel = Field(default=ExportModel(), description="what is written")

    @classmethod
    def contradictions(cls, fields: Fields) -> Iterator[SchemaProblem]:
        """What sections say against each other."""
        return mission_contradictions(fields)
