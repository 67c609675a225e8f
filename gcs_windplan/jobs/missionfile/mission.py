"""From a checked mission file to the mission that it says; nothing that it names is read yet."""

from __future__ import annotations

import os
from collections.abc import Sequence
from pathlib import Path

from gcs_windplan import wind as air
from gcs_windplan.geo.frame import GeoPoint
from gcs_windplan.jobs.areas import Area
from gcs_windplan.jobs.mission import Mission
from gcs_windplan.jobs.missionfile.areas import AreaModel
from gcs_windplan.jobs.missionfile.model import GraphModel
from gcs_windplan.jobs.missionfile.parsing import MissionDocument, read_document
from gcs_windplan.jobs.missionfile.values import FREE
from gcs_windplan.jobs.missionfile.world import PaperWindModel, PlaceModel, SiteModel
from gcs_windplan.jobs.obstacles import ObstacleFile
from gcs_windplan.jobs.places import LocalPoint, Place
from gcs_windplan.jobs.terrains import DemFiles, FlatGround, Hills, MeshFile, SampleDem, TerrainSource
from gcs_windplan.jobs.vehicles import AirframeFile
from gcs_windplan.jobs.winds import ForecastFiles, GivenWind, SameWind, WindProfile, WindSource
from gcs_windplan.paper.fields import Diverging, Jet, Rotation
from gcs_windplan.paper.sampled import SampledTest
from gcs_windplan.planning.cost import CostChoice
from gcs_windplan.planning.request import Export, Limits, Roadmap, Uniform
from gcs_windplan.terrain import Hill
from gcs_windplan.vehicle import Vehicle
from gcs_windplan.wind import WindField


def read_mission(path: str | os.PathLike[str]) -> Mission:
    """The mission in a mission file (.yaml), to be planned.

    Raises `MissionFileError` with every problem of the file, by line and column. The files that it names are read when
    it is planned.

    >>> import gcs_windplan as gw
    >>> gw.read_mission("missions/jacksboro.yaml")
    Mission('jacksboro': 2 sites, least time)
    """
    return mission_of_document(read_document(Path(path)))


def mission_of_document(document: MissionDocument) -> Mission:
    """The mission that a mission file's document says."""
    model = document.model
    limits, origin = model.limits, model.terrain.origin
    return Mission(
        name=model.name,
        start=_site(model.start),
        goal=_site(model.goal),
        via=tuple(map(_site, model.via)),
        rally=tuple(map(_site, model.rally)),
        fence_return=None if model.fence.return_point is None else _site(model.fence.return_point),
        vehicle=_vehicle(document),
        airspeed=FREE if model.vehicle.airspeed == FREE else None,
        terrain=_terrain(document),
        origin=None if origin is None else GeoPoint(origin.latitude, origin.longitude),
        obstacles=tuple(_obstacles(document)),
        wind=_wind(document),
        profile=_profile(document),
        departure=model.departure,
        order=model.order,
        clearance=model.clearance,
        max_height=limits.max_height,
        limits=Limits(limits.wind, limits.gust, limits.battery, limits.reserve, limits.way_home),
        keep_out=tuple(map(area_of, limits.keep_out)),
        keep_in=tuple(map(area_of, limits.keep_in)),
        cost=CostChoice(**model.cost.model_dump()),
        graph=_graph(model.graph),
        layers=model.graph.layers or (),
        margin=model.graph.margin,
        collision_test=SampledTest() if model.collision_test == "paper" else None,
        finish=model.finish,
        return_height=model.return_height,
        export=Export(**model.export.model_dump()),
        robust=0.5 if model.robust is None else model.robust,
        document=document,
    )


def _point(model: PlaceModel) -> GeoPoint | LocalPoint:
    if model.latitude is not None and model.longitude is not None:
        return GeoPoint(model.latitude, model.longitude)
    assert model.east is not None
    assert model.north is not None
    return LocalPoint(model.east, model.north)


def _site(model: SiteModel) -> Place:
    return Place(_point(model), model.height, model.altitude)


def _vehicle(document: MissionDocument) -> Vehicle | AirframeFile:
    """The vehicle: the airframe's, but for what the mission file itself says."""
    model = document.model.vehicle
    written = model.model_dump(exclude={"airframe"})
    if model.airframe is None:
        return Vehicle(**written)
    own = {name: written[name] for name in model.model_fields_set if name in written}
    if own.get("airspeed") == FREE:
        del own["airspeed"]
    return AirframeFile(document.beside(model.airframe), own)


def _terrain(document: MissionDocument) -> TerrainSource:
    """Where the terrain is from; the schema has seen to it that it is one of them."""
    model = document.model.terrain
    altitude = 0.0 if model.origin is None else model.origin.altitude
    datum = model.vertical_datum
    if model.dem is not None:
        return DemFiles(tuple(map(document.beside, model.dem)), model.nodata, datum)
    if model.mesh is not None:
        return MeshFile(document.beside(model.mesh), altitude, datum, model.mesh)
    if model.surface is not None:
        hills = tuple(Hill(**hill.model_dump()) for hill in model.surface.hills)
        return Hills(model.surface.size, model.surface.cell, hills, altitude, datum)
    return SampleDem() if model.flat is None else FlatGround(model.flat)


def _obstacles(document: MissionDocument) -> list[ObstacleFile]:
    return [
        ObstacleFile(
            model.name,
            document.beside(model.mesh),
            None if model.at is None else Place(_point(model.at)),
            model.altitude,
            model.margin,
        )
        for model in document.model.obstacles
    ]


def _wind(document: MissionDocument) -> WindSource:
    """Where the wind is from."""
    model = document.model.wind
    if model.forecast is not None:
        return ForecastFiles(tuple(map(document.beside, model.forecast)), model.members, model.extend == "nearest")
    if model.constant is not None:
        return SameWind(model.constant.speed, model.constant.from_)
    return GivenWind(air.Calm() if model.paper is None else _paper(model.paper))


def _paper(model: PaperWindModel) -> WindField:
    """One of the paper's fields."""
    if model.field == "jet":
        return Jet(model.speed, model.scale, model.reading)
    return (Diverging if model.field == "diverging" else Rotation)(model.speed, model.scale)


def _profile(document: MissionDocument) -> WindProfile | None:
    """The profile's law; the schema has seen to it that its own figure is there."""
    model = document.model.wind.profile
    if model is None:
        return None
    figure = model.exponent if model.law == "power" else model.roughness
    assert figure is not None
    return WindProfile(model.law, figure, model.reference_height)


def area_of(model: AreaModel) -> Area:
    """An area of a mission file."""
    corners: Sequence[GeoPoint | LocalPoint]
    radius = None
    if model.circle is not None:
        corners, radius = [_point(model.circle)], model.circle.radius
    else:
        assert model.polygon is not None
        if model.polygon.east_north is not None:
            corners = [LocalPoint(*corner) for corner in model.polygon.east_north]
        else:
            corners = [GeoPoint(*corner) for corner in model.polygon.latitude_longitude or ()]
    return Area(model.name, corners, radius, model.floor, model.ceiling, model.margin, model.fence)


def _graph(model: GraphModel) -> Uniform | Roadmap:
    """The kind of graph; the schema has seen to it that there is exactly one."""
    if model.prm is not None:
        return Roadmap(**model.prm.model_dump())
    assert model.uniform is not None
    return Uniform(**model.uniform.model_dump())
