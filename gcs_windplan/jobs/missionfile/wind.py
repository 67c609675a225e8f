"""The wind that a mission file names."""

from __future__ import annotations

from dataclasses import dataclass
from datetime import datetime
from typing import TYPE_CHECKING

from gcs_windplan import wind as air  # its readers are imported when first asked for: netCDF4 is heavy
from gcs_windplan.geo.frame import LocalFrame
from gcs_windplan.jobs.missionfile.parsing import MissionDocument
from gcs_windplan.jobs.missionfile.world import PaperWindModel, ProfileModel

if TYPE_CHECKING:
    from gcs_windplan.terrain import Extent, Terrain
    from gcs_windplan.wind import LogLaw, PowerLaw, WindField


DAY = 24 * 3600.0


@dataclass(frozen=True, slots=True)
class Departure:
    """When the flight begins, and for how long after that wind is read [s]."""

    moment: datetime | None
    lasting: float = DAY


@dataclass(frozen=True, slots=True)
class Winds:
    """The wind to plan in, those of an ensemble's members, of which it is the mean, and the gusts of each."""

    wind: WindField
    members: tuple[WindField, ...] = ()
    gusts: tuple[WindField, ...] = ()


def build_wind(document: MissionDocument, frame: LocalFrame, terrain: Terrain, area: Extent, when: Departure) -> Winds:
    """The wind; raises `WindError`."""
    model = document.model.wind
    if model.forecast is not None:
        return _forecast(document, frame, terrain, area, when)
    field: WindField = air.Calm()
    if model.constant is not None:
        field = air.ConstantWind.from_direction(model.constant.speed, model.constant.from_, frame)
    elif model.paper is not None:
        field = _papers(model.paper)
    if model.profile is None:
        return Winds(field)
    return Winds(air.ProfileWind(field, terrain.heights_at, _law(model.profile), terrain.resolution))


def _forecast(document: MissionDocument, frame: LocalFrame, terrain: Terrain, area: Extent, when: Departure) -> Winds:
    """The winds of the forecast's files."""
    model = document.model.wind
    assert model.forecast is not None
    profile = model.profile
    query = air.ForecastQuery(
        frame=frame,
        ground=terrain.heights_at,
        departure=when.moment,
        lasting=when.lasting,
        area=_overlap(area, terrain.extent),
        extend=model.extend == "nearest",
        members=model.members,
        exponent=None if profile is None else profile.exponent,
        roughness=None if profile is None else profile.roughness,
        carried=profile is not None,
        known_height=None if profile is None else profile.reference_height,
        ground_resolution=terrain.resolution,
    )
    forecast = air.read_forecast([document.beside(name) for name in model.forecast], query)
    return Winds(forecast.mean, forecast.fields if len(forecast.fields) > 1 else (), forecast.gusts)


def _papers(model: PaperWindModel) -> WindField:
    """One of the paper's fields."""
    if model.field == "jet":
        return air.Jet(model.speed, model.scale, model.reading)
    return (air.Diverging if model.field == "diverging" else air.Rotation)(model.speed, model.scale)


def _law(model: ProfileModel) -> PowerLaw | LogLaw:
    """The profile's law; the schema has seen to it that its own field is there."""
    if model.exponent is not None:
        return air.PowerLaw(model.reference_height, model.exponent)
    assert model.roughness is not None
    return air.LogLaw(model.reference_height, model.roughness)


def _overlap(area: Extent, edge: Extent) -> tuple[float, float, float, float]:
    """The part of the area over which there is terrain, as west, south, east, north."""
    return (
        max(area.west, edge.west),
        max(area.south, edge.south),
        min(area.east, edge.east),
        min(area.north, edge.north),
    )
